// SPDX-License-Identifier: BSD-3-Clause
//
// The part of the command that links OpenImageIO; see any_image.h.
#include "cli/any_image.h"
#include "spectral/error.h"

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace {

// A 12-bit camera's numbers come scaled to the 16 bits that hold them, when the file says so.
double full_scale_of(const OIIO::ImageSpec& spec) {
    if (spec.format.is_floating_point()) return 0.0;
    const int bits =
        spec.get_int_attribute("oiio:BitsPerSample", static_cast<int>(8 * spec.format.size()));
    return std::exp2(bits) - 1.0;
}

// Pixels with their channels side by side, as planes; and the way back.
std::vector<float> planes_of(const std::vector<float>& pixels, std::size_t channels) {
    const std::size_t count = pixels.size() / channels;
    std::vector<float> planes(pixels.size());
    for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t i = 0; i < count; ++i) planes[c * count + i] = pixels[i * channels + c];
    }
    return planes;
}

std::vector<float> pixels_of(const std::vector<float>& planes, std::size_t channels) {
    return planes_of(planes, planes.size() / channels);
}

OIIO::TypeDesc type_of(aphotic::cli::SampleType type) {
    switch (type) {
        case aphotic::cli::SampleType::Bits8:
            return OIIO::TypeDesc::UINT8;
        case aphotic::cli::SampleType::Bits16:
            return OIIO::TypeDesc::UINT16;
        case aphotic::cli::SampleType::Float:
            return OIIO::TypeDesc::FLOAT;
    }
    return OIIO::TypeDesc::UNKNOWN;
}

// Of a file without compression that is cut short, libtiff reads the missing rows as zeros.
void require_whole(const std::filesystem::path& file, const OIIO::ImageSpec& spec) {
    if (spec.get_string_attribute("compression") != "none") return;
    constexpr std::size_t kBitsInByte = 8;
    const auto bits = static_cast<std::size_t>(spec.get_int_attribute(
        "oiio:BitsPerSample", static_cast<int>(spec.format.size() * kBitsInByte)));
    const std::size_t bytes =
        spec.image_pixels() * static_cast<std::size_t>(spec.nchannels) * bits / kBitsInByte;
    const std::uintmax_t found = std::filesystem::file_size(file);
    if (found >= bytes) return;
    throw aphotic::InputError(
        fmt::format("{}: cannot be read: it is cut short: found {} bytes of {} and more",
                    file.string(),
                    found,
                    bytes));
}

}  // namespace

extern "C" void aphotic_open_any_image(const std::filesystem::path& file,
                                       aphotic::cli::AnyImage& image) {
    // Opened directly: an image cache could hand back the pixels of a file that was since replaced.
    const std::shared_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file.string());
    if (!input) {
        throw aphotic::InputError(
            fmt::format("{}: cannot be read: {}", file.string(), OIIO::geterror()));
    }
    const OIIO::ImageSpec spec = input->spec();
    require_whole(file, spec);
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
    image.planes = [input, spec, file] {
        std::vector<float> pixels(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
        if (!input->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, pixels.data())) {
            throw aphotic::InputError(
                fmt::format("{}: cannot be read: {}", file.string(), input->geterror()));
        }
        return planes_of(pixels, static_cast<std::size_t>(spec.nchannels));
    };
    image.full_scale = full_scale_of(spec);
    image.description = spec.get_string_attribute("ImageDescription");
    image.date_time = spec.get_string_attribute("DateTime");
}

extern "C" void aphotic_write_any_image(const std::filesystem::path& file,
                                        const aphotic::cli::WrittenImage& image) {
    const auto fail = [&](const std::string& why) {
        throw aphotic::RunError(fmt::format("{}: cannot be written: {}", file.string(), why));
    };
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(file.string());
    if (!output) fail(OIIO::geterror());
    OIIO::ImageSpec spec(image.width_px,
                         image.height_px,
                         static_cast<int>(image.channels.size()),
                         type_of(image.type));
    spec.channelnames = image.channels;
    if (!image.description.empty()) spec.attribute("ImageDescription", image.description);
    // Exif's words for a time that is not known; without any, TIFF gets the time of writing.
    constexpr const char* kUnknown = "    :  :     :  :  ";
    const bool is_dated = !image.date_time.empty();
    if (is_dated || std::string_view(output->format_name()) == "tiff") {
        spec.attribute("DateTime", is_dated ? image.date_time : kUnknown);
    }
    const std::vector<float> pixels = pixels_of(image.planes, image.channels.size());
    const bool is_whole = output->open(file.string(), spec) &&
                          output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) &&
                          output->close();
    if (!is_whole) fail(output->geterror());
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
