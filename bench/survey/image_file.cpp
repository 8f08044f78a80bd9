// SPDX-License-Identifier: BSD-3-Clause
#include "bench/survey/image_file.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "image/any_image.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <string>

// Linked here, not loaded when it is asked for.
extern "C" void aphotic_open_any_image(const std::filesystem::path& file, aphotic::AnyImage& image);

namespace aphotic::survey {

void write_tiff(const std::filesystem::path& file,
                int width_px,
                int height_px,
                std::span<const std::uint16_t> samples) {
    OIIO::ImageSpec spec(width_px, height_px, 1, OIIO::TypeDesc::UINT16);
    spec.attribute("compression", "zip");
    AtomicFile destination(file);
    const auto output = OIIO::ImageOutput::create("tiff");
    if (!output || !output->open(destination.temporary().string(), spec) ||
        !output->write_image(spec.format, samples.data()) || !output->close()) {
        throw RunError(fmt::format("{}: cannot be written: {}",
                                   file.string(),
                                   output ? output->geterror() : OIIO::geterror()));
    }
    destination.commit();
}

CameraImage read_image(const std::filesystem::path& file) {
    AnyImage any;
    aphotic_open_any_image(file, any);
    if (any.channels.size() < kChannels) {
        throw InputError(fmt::format(
            "{}: found {} channels; allowed: R, G and B", file.string(), any.channels.size()));
    }
    CameraImage image{
        .width_px = any.width_px, .height_px = any.height_px, .samples = any.planes()};
    image.samples.resize(kChannels * image.samples.size() / any.channels.size());
    return image;
}

}  // namespace aphotic::survey
