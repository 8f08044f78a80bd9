// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/result_files.h"

#include "base/atomic_file.h"
#include "image/preview.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;

namespace {

// The transfer curve in steps so fine that linear interpolation is within 6e-7, at the bend: a
// power for each sample would take as long as the whole correction.
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

namespace {

fs::path image_of(const ImageFile& file, const ResultFormat& format) {
    return file.name.string() + (format.format == "tiff" ? ".tif" : "." + format.format);
}

fs::path mask_of(const ImageFile& file) {
    return file.name.string() + ".mask.png";
}

// Samples that the format cannot hold are marked; the writer clips them.
void mark_clipped(CorrectedImage& result) {
    const std::size_t pixels = result.doubts.size();
    for (std::size_t first = 0; first < result.image.samples.size(); first += pixels) {
        for (std::size_t i = 0; i < pixels; ++i) {
            const float sample = result.image.samples[first + i];
            const bool is_clipped = sample < 0.0F || sample > 1.0F;
            result.doubts[i] |= is_clipped ? kClipped : std::uint8_t{0};
        }
    }
}

Counts doubts_in(const std::vector<std::uint8_t>& doubts) {
    Counts counts;
    for (const auto& [name, bit, words] : kDoubts) {
        counts[std::string(name)] = static_cast<double>(
            std::ranges::count_if(doubts, [bit = bit](std::uint8_t d) { return (d & bit) != 0; }));
    }
    return counts;
}

std::vector<std::string> channel_names(const RawImage& image) {
    if (image.mosaic != Mosaic::None) return {"Y"};
    return {kChannelNames.begin(), kChannelNames.end()};
}

int zip_level(Compression compression) {
    constexpr int kUsual = 6;
    if (compression == Compression::None) return 0;
    return compression == Compression::Small ? kUsual : ExrWriter::kFastestZip;
}

void write_linear(const fs::path& file,
                  const RawImage& image,
                  const SurveyImage& source,
                  Compression compression,
                  ExrAttributes attributes) {
    attributes.emplace_back("aphotic:version", APHOTIC_VERSION);
    if (!source.description.empty()) attributes.emplace_back("comments", source.description);
    if (!source.date_time.empty()) attributes.emplace_back("capDate", source.date_time);
    if (source.tags) std::ranges::copy(words_of(*source.tags), std::back_inserter(attributes));
    write_exr(file,
              image.width_px,
              image.height_px,
              channel_names(image),
              image.samples,
              attributes,
              zip_level(compression));
}

void write_mask(const fs::path& file, const CorrectedImage& result, Compression compression) {
    constexpr float kByte = 255.0F;
    std::vector<float> plane(result.doubts.size());
    std::ranges::transform(result.doubts, plane.begin(), [](std::uint8_t doubt) {
        return static_cast<float>(doubt) / kByte;
    });
    write_any_image(file,
                    {.width_px = result.image.width_px,
                     .height_px = result.image.height_px,
                     .channels = {"Y"},
                     .planes = plane,
                     .type = SampleType::Bits8,
                     .compression = compression});
}

}  // namespace

std::vector<fs::path> results_of(const ImageFile& file, const ResultFormat& format) {
    std::vector<fs::path> files{image_of(file, format)};
    if (format.mask) files.push_back(mask_of(file));
    if (format.srgb) files.push_back(srgb_file_of(file, *format.srgb));
    return files;
}

Counts write_results(const fs::path& folder,
                     const ImageFile& file,
                     CorrectedImage result,
                     const SurveyImage& source,
                     const ResultFormat& format,
                     const ExrAttributes& more) {
    const fs::path image = folder / image_of(file, format);
    if (format.clips()) mark_clipped(result);
    make_folder(image.parent_path());
    if (format.mask) write_mask(folder / mask_of(file), result, format.compression);
    if (format.format == "exr") {
        write_linear(image, result.image, source, format.compression, more);
    } else {
        write_any_image(image,
                        {.width_px = result.image.width_px,
                         .height_px = result.image.height_px,
                         .channels = channel_names(result.image),
                         .planes = result.image.samples,
                         .type = SampleType::Bits16,
                         .compression = format.compression,
                         .description = source.description,
                         .date_time = source.date_time,
                         .tags = source.tags});
    }
    return doubts_in(result.doubts);
}

}  // namespace aphotic
