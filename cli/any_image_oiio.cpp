// SPDX-License-Identifier: BSD-3-Clause
//
// The part of the command that links OpenImageIO; see any_image.h.
#include "cli/any_image.h"
#include "spectral/error.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

extern "C" void aphotic_open_any_image(const std::filesystem::path& file,
                                       aphotic::cli::AnyImage& image) {
    // Opened directly: an image cache could hand back the pixels of a file that was since replaced.
    const std::shared_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file.string());
    if (!input) {
        throw aphotic::InputError(
            fmt::format("{}: cannot be read: {}", file.string(), OIIO::geterror()));
    }
    const OIIO::ImageSpec spec = input->spec();
    image.width_px = spec.width;
    image.height_px = spec.height;
    image.channels = spec.channelnames;
    image.samples = [input, spec, file](std::size_t channel) {
        const auto c = static_cast<int>(channel);
        std::vector<float> samples(spec.image_pixels());
        if (!input->read_image(0, 0, c, c + 1, OIIO::TypeDesc::FLOAT, samples.data())) {
            throw aphotic::InputError(
                fmt::format("{}: cannot be read: {}", file.string(), input->geterror()));
        }
        return samples;
    };
}
