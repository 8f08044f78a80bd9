// SPDX-License-Identifier: BSD-3-Clause
//
// The part of the command that links OpenImageIO; see any_image.h.
#include "cli/any_image.h"
#include "spectral/error.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

// A struct with C++ members crosses: the command and this part are built together.
#pragma GCC diagnostic ignored "-Wreturn-type-c-linkage"

extern "C" aphotic::cli::AnyImage aphotic_open_any_image(const std::filesystem::path& file) {
    // Opened directly: an image cache could hand back the pixels of a file that was since replaced.
    const std::shared_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file.string());
    if (!input) {
        throw aphotic::InputError(
            fmt::format("{}: cannot be read: {}", file.string(), OIIO::geterror()));
    }
    const OIIO::ImageSpec spec = input->spec();
    aphotic::cli::AnyImage image{.width_px = spec.width,
                                 .height_px = spec.height,
                                 .channels = spec.channelnames,
                                 .samples = {}};
    image.samples = [input, spec, file](std::size_t channel) {
        const auto c = static_cast<int>(channel);
        std::vector<float> samples(spec.image_pixels());
        if (!input->read_image(0, 0, c, c + 1, OIIO::TypeDesc::FLOAT, samples.data())) {
            throw aphotic::InputError(
                fmt::format("{}: cannot be read: {}", file.string(), input->geterror()));
        }
        return samples;
    };
    return image;
}
