// SPDX-License-Identifier: BSD-3-Clause
//
// The part of the command that links OpenImageIO; see any_image.h.
#include "cli/any_image.h"
#include "spectral/error.h"

#include <OpenImageIO/imagebufalgo.h>
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

extern "C" void aphotic_resize(std::vector<float>& plane,
                               aphotic::cli::PlaneSize from,
                               aphotic::cli::PlaneSize to,
                               const std::string& filter) {
    const OIIO::ImageBuf image(
        OIIO::ImageSpec(from.width_px, from.height_px, 1, OIIO::TypeDesc::FLOAT), plane.data());
    // A width of 0 lets the filter choose its own.
    const OIIO::ImageBuf result = OIIO::ImageBufAlgo::resize(
        image, filter, 0.0F, OIIO::ROI(0, to.width_px, 0, to.height_px, 0, 1, 0, 1));
    std::vector<float> samples(result.spec().image_pixels());
    if (result.has_error() ||
        !result.get_pixels(result.roi(), OIIO::TypeDesc::FLOAT, samples.data())) {
        throw aphotic::InputError(fmt::format("resizing: {}", result.geterror()));
    }
    plane = std::move(samples);
}
