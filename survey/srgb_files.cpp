// SPDX-License-Identifier: BSD-3-Clause
#include "survey/srgb_files.h"

#include "base/atomic_file.h"
#include "image/any_image.h"
#include "image/preview.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

// The transfer curve by steps so fine that a line between them is within 6e-7, at the bend: a power
// for each sample would take as long as the whole correction.
class SrgbCurve {
  public:
    SrgbCurve() {
        for (std::size_t i = 0; i < table_.size(); ++i) {
            table_[i] = static_cast<float>(srgb_encoded(static_cast<double>(i) / kSteps));
        }
    }

    [[nodiscard]] float at(float linear) const {
        const float place = (linear > 0.0F ? std::min(linear, 1.0F) : 0.0F) * kSteps;
        const auto step = std::min(static_cast<std::size_t>(place), std::size_t{kSteps - 1});
        const float share = place - static_cast<float>(step);
        return table_[step] + share * (table_[step + 1] - table_[step]);
    }

  private:
    static constexpr int kSteps = 65536;
    std::array<float, kSteps + 1> table_{};
};

}  // namespace

Json to_json(const SrgbFormat& format) {
    Json json{{"to", "srgb"}, {"format", format.format}, {"stops", format.stops}};
    if (format.format == "jpeg") {
        json["quality"] = format.quality;
    } else {
        json["bits"] = format.bits;
    }
    return json;
}

Eigen::Matrix3d SrgbEncoding::matrix() const {
    const Eigen::Matrix3d colours = camera ? camera->matrix : Eigen::Matrix3d::Identity();
    return exposure * colours * Eigen::Vector3d(balance.data()).asDiagonal();
}

Json to_json(const SrgbEncoding& encoding) {
    Json json{{"exposure", encoding.exposure}, {"balance", encoding.balance}, {"matrix", nullptr}};
    if (!encoding.camera) return json;
    for (int row = 0; row < kChannels; ++row) {
        const auto numbers = encoding.camera->matrix.row(row);
        json["matrix"].push_back({numbers[0], numbers[1], numbers[2]});
    }
    json["mean_delta_e"] = encoding.camera->mean_delta_e();
    json["largest_delta_e"] = encoding.camera->worst().delta_e;
    json["worst"] = encoding.camera->worst().name;
    return json;
}

SrgbEncoding srgb_encoding(std::optional<CameraToSrgb> camera,
                           const std::optional<PerChannel>& middle,
                           double stops) {
    SrgbEncoding encoding{.camera = std::move(camera)};
    if (middle) {
        const Eigen::Vector3d shown = encoding.matrix() * Eigen::Vector3d(middle->data());
        const double luminance = shown.dot(Eigen::Vector3d(0.2126, 0.7152, 0.0722));
        if (luminance > 0.0) encoding.exposure = kMiddleGrey / luminance;
    }
    encoding.exposure *= std::exp2(stops);
    return encoding;
}

std::vector<std::string> shown_channels(const RawImage& image) {
    if (image.mosaic == Mosaic::Mono) return {"Y"};
    return {kChannelNames.begin(), kChannelNames.end()};
}

std::vector<float> srgb_planes(const RawImage& image, const Eigen::Matrix3d& matrix) {
    static const SrgbCurve kCurve;
    const std::size_t pixels = image.pixels();
    const Eigen::Matrix3f m = matrix.cast<float>();
    std::vector<float> planes(image.samples.size());
    if (image.mosaic == Mosaic::Mono) {
        const float grey = m.row(1).sum();
        std::ranges::transform(
            image.samples, planes.begin(), [&](float sample) { return kCurve.at(grey * sample); });
        return planes;
    }
    for (std::size_t i = 0; i < pixels; ++i) {
        const Eigen::Vector3f shown =
            m * Eigen::Vector3f(
                    image.samples[i], image.samples[pixels + i], image.samples[2 * pixels + i]);
        for (std::size_t c = 0; c < kChannels; ++c) {
            planes[c * pixels + i] = kCurve.at(shown[static_cast<Eigen::Index>(c)]);
        }
    }
    return planes;
}

fs::path srgb_file_of(const ImageFile& file, const SrgbFormat& format) {
    const char* extension = format.format == "jpeg" ? ".jpg" : ".tif";
    if (format.format == "png") extension = ".png";
    return fs::path(kSrgbFolder) / (file.name.string() + extension);
}

void write_srgb(const fs::path& folder,
                const ImageFile& file,
                const CorrectedImage& result,
                const SurveyImage& source,
                const SrgbEncoding& encoding,
                const SrgbFormat& format) {
    const std::vector<float> planes = srgb_planes(
        is_bayer(result.image.mosaic) ? demosaiced(result).image : result.image, encoding.matrix());
    const fs::path image = folder / srgb_file_of(file, format);
    make_folder(image.parent_path());
    write_any_image(image,
                    {.width_px = result.image.width_px,
                     .height_px = result.image.height_px,
                     .channels = shown_channels(result.image),
                     .planes = planes,
                     .type = format.bits == 8 ? SampleType::Bits8 : SampleType::Bits16,
                     .description = source.description,
                     .date_time = source.date_time,
                     .tags = source.tags,
                     .is_srgb = true,
                     .jpeg_quality = format.quality});
}

}  // namespace aphotic
