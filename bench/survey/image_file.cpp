// SPDX-License-Identifier: BSD-3-Clause
#include "bench/survey/image_file.h"

#include "spectral/atomic_file.h"
#include "spectral/error.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>

namespace aphotic::survey {

void write_tiff(const std::filesystem::path& file,
                int width_px,
                int height_px,
                std::span<const std::uint16_t> samples) {
    AtomicFile destination(file);
    OIIO::ImageSpec spec(width_px, height_px, 1, OIIO::TypeDesc::UINT16);
    spec.attribute("compression", "zip");
    const auto output = OIIO::ImageOutput::create("tiff");
    if (!output || !output->open(destination.temporary().string(), spec) ||
        !output->write_image(OIIO::TypeDesc::UINT16, samples.data()) || !output->close()) {
        throw RunError(fmt::format("{}: cannot be written: {}",
                                   file.string(),
                                   output ? output->geterror() : OIIO::geterror()));
    }
    destination.commit();
}

CameraImage read_image(const std::filesystem::path& file) {
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input) {
        throw InputError(fmt::format("{}: cannot be read: {}", file.string(), OIIO::geterror()));
    }
    const OIIO::ImageSpec spec = input->spec();
    if (spec.nchannels < static_cast<int>(kChannels)) {
        throw InputError(fmt::format(
            "{}: found {} channels; allowed: R, G and B", file.string(), spec.nchannels));
    }
    const std::size_t pixels = spec.image_pixels();
    CameraImage image{.width_px = spec.width,
                      .height_px = spec.height,
                      .samples = std::vector<float>(kChannels * pixels)};
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto channel = static_cast<int>(c);
        if (!input->read_image(
                0, 0, channel, channel + 1, OIIO::TypeDesc::FLOAT, &image.samples[c * pixels])) {
            throw InputError(
                fmt::format("{}: cannot be read: {}", file.string(), input->geterror()));
        }
    }
    return image;
}

}  // namespace aphotic::survey
