// SPDX-License-Identifier: BSD-3-Clause
#include "image/output_images.h"

#include <fmt/format.h>

#include <algorithm>

namespace aphotic {
namespace {

const std::vector<std::string> kSignalChannels(kChannelNames.begin(), kChannelNames.end());

}  // namespace

CameraImage read_signals(const std::filesystem::path& file) {
    ExrReader reader(file);
    return {.width_px = reader.width_px(),
            .height_px = reader.height_px(),
            .samples = reader.planes(kSignalChannels)};
}

std::string spectral_channel(double lambda_nm) {
    std::string number = fmt::format("{:.6f}", lambda_nm);
    std::replace(number.begin(), number.end(), '.', ',');
    return fmt::format("S0.{}nm", number);
}

OutputImages::OutputImages(const std::filesystem::path& folder,
                           int width_px,
                           int height_px,
                           std::span<const double> lambda_nm,
                           const ExrAttributes& attributes)
    : image_{.width_px = width_px, .height_px = height_px},
      image_file_(folder / "image.exr", width_px, height_px, kSignalChannels, attributes) {
    image_.samples.resize(kChannels * static_cast<std::size_t>(width_px) *
                          static_cast<std::size_t>(height_px));
    if (lambda_nm.empty()) return;
    std::vector<std::string> channels = kSignalChannels;
    for (const double l : lambda_nm) channels.push_back(spectral_channel(l));
    ExrAttributes all = attributes;
    all.emplace_back("spectralLayoutVersion", "1.0");
    all.emplace_back("emissiveUnits", "W.m^-2.sr^-1");
    spectral_file_.emplace(folder / "spectral.exr", width_px, height_px, channels, all);
}

void OutputImages::write_rows(int rows, std::vector<float> samples) {
    const auto width = static_cast<std::size_t>(image_.width_px);
    const std::size_t plane = width * static_cast<std::size_t>(rows);
    const std::size_t image_plane = image_.samples.size() / kChannels;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto from = std::span(samples).subspan(c * plane, plane);
        const std::size_t first = c * image_plane + static_cast<std::size_t>(next_row_) * width;
        std::ranges::copy(from, image_.samples.begin() + static_cast<std::ptrdiff_t>(first));
    }
    next_row_ += rows;
    if (writing_.valid()) writing_.get();
    writing_ = std::async(std::launch::async, [this, rows, plane, block = std::move(samples)] {
        image_file_.write_rows(rows, std::span(block).first(kChannels * plane));
        if (spectral_file_) spectral_file_->write_rows(rows, block);
    });
}

CameraImage OutputImages::finish() {
    if (writing_.valid()) writing_.get();
    image_file_.finish();
    if (spectral_file_) spectral_file_->finish();
    return std::move(image_);
}

}  // namespace aphotic
