// SPDX-License-Identifier: BSD-3-Clause
//
// The part of the command that links OpenImageIO; see any_image.h.
#include "base/csv.h"
#include "base/error.h"
#include "image/any_image.h"
#include "image/colour_profile.h"
#include "image/decoded_size.h"
#include "image/exr_header.h"
#include "image/png_pixels.h"
#include "image/whole_tiff.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

namespace {

// A 12-bit camera's numbers are scaled to the 16 bits that hold them if the file says so.
double full_scale_of(const OIIO::ImageSpec& spec) {
    if (spec.format.is_floating_point()) return 0.0;
    const int bits =
        spec.get_int_attribute("oiio:BitsPerSample", static_cast<int>(8 * spec.format.size()));
    return std::exp2(bits) - 1.0;
}

// Pixels with interleaved channels.
std::vector<float> planes_of(std::vector<float> pixels, std::size_t channels) {
    if (channels == 1) return pixels;
    const std::size_t count = pixels.size() / channels;
    std::vector<float> planes(pixels.size());
    for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t i = 0; i < count; ++i) planes[c * count + i] = pixels[i * channels + c];
    }
    return planes;
}

// Rounds half away from 0, as the library does; NaN becomes 0.
template <typename Integer>
Integer rounded(float sample) {
    constexpr auto kMost = static_cast<float>(std::numeric_limits<Integer>::max());
    constexpr float kHalf = 0.5F;
    float number = sample * kMost;
    number = number > 0.0F ? number : 0.0F;
    number = number < kMost ? number : kMost;
    const int whole = static_cast<int>(number);
    return static_cast<Integer>(whole + (number - static_cast<float>(whole) >= kHalf ? 1 : 0));
}

// Channels interleaved as in the file: the library would first allocate as many floats.
template <typename Integer>
bool write_as(OIIO::ImageOutput& output, const aphotic::WrittenImage& image) {
    const std::size_t channels = image.channels.size();
    const std::size_t count = image.planes.size() / channels;
    std::vector<Integer> pixels(image.planes.size());
    for (std::size_t c = 0; c < channels; ++c) {
        const float* const plane = image.planes.data() + c * count;
        Integer* const to = pixels.data() + c;
        for (std::size_t i = 0; i < count; ++i) to[i * channels] = rounded<Integer>(plane[i]);
    }
    return output.write_image(output.spec().format, pixels.data());
}

void compress(OIIO::ImageSpec& spec, aphotic::Compression compression) {
    using aphotic::Compression;
    constexpr int kFastest = 1;
    constexpr int kUsual = 6;
    const bool is_packed = compression != Compression::None;
    const int level = compression == Compression::Small ? kUsual : kFastest;
    spec.attribute("compression", is_packed ? "zip" : "none");
    spec.attribute("tiff:zipquality", level);
    spec.attribute("png:compressionLevel", is_packed ? level : 0);
}

// Formats whose truncated files are detected: the tests truncate each of them.
constexpr std::string_view kFormats =
    "bmp, dpx, fits, hdr, jpeg, jpeg2000, openexr, png, pnm, sgi, targa, tiff, webp";

// The first of several lines gives the cause.
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& reasons) {
    const std::string why = reasons.substr(0, reasons.find('\n'));
    throw aphotic::InputError("{}: cannot be read: {}", file.string(), why);
}

// The result of read(). Any exception of the libraries becomes an error about the file.
template <typename Read>
auto reading(const std::filesystem::path& file, const Read& read) {
    try {
        return read();
    } catch (const std::bad_alloc&) {
        refuse(file, "out of memory");
    } catch (const std::exception& error) {
        refuse(file, error.what());
    }
}

// Checks before any library opens the file.
void require_sound_header(const std::filesystem::path& file) {
    std::error_code none;
    if (!std::filesystem::is_regular_file(file, none)) {
        throw aphotic::InputError(std::filesystem::exists(file, none)
                                      ? "found a pipe, device or folder; allowed: a file"
                                      : "No such file or directory");
    }
    if (aphotic::is_exr(file)) aphotic::require_sound_exr_header(file);
    if (aphotic::is_png(file)) aphotic::require_sound_png_header(file);
}

// Checks after a library has read the header, in every format.
void require_sound_spec(const OIIO::ImageSpec& spec, const std::filesystem::path& file) {
    aphotic::require_sides(spec.width, spec.height);
    if (spec.deep || spec.depth > 1) throw aphotic::InputError("found deep pixels or a volume");
    const std::uint64_t samples = spec.image_pixels() * static_cast<std::uint64_t>(spec.nchannels);
    aphotic::require_file_size(std::filesystem::file_size(file), spec.image_bytes(true), samples);
    // A position on a page is not an offset within a larger image.
    if (spec.full_width == spec.width && spec.full_height == spec.height) return;
    throw aphotic::InputError("found {} x {} of {} x {} pixels; allowed: the whole image",
                              spec.width,
                              spec.height,
                              spec.full_width,
                              spec.full_height);
}

std::shared_ptr<OIIO::ImageInput> opened(const std::filesystem::path& file) {
    require_sound_header(file);
    OIIO::ImageSpec as_stored;
    as_stored.attribute("oiio:UnassociatedAlpha", 1);
    std::shared_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file.string(), &as_stored);
    if (!input) throw aphotic::InputError(OIIO::geterror());
    const std::string_view format = input->format_name();
    if (std::ranges::count(aphotic::comma_fields(kFormats), format) == 0)
        throw aphotic::InputError("found the format {}; allowed: {}", format, kFormats);
    if (format == "tiff") aphotic::require_whole_tiff(file);
    require_sound_spec(input->spec(), file);
    return input;
}

// If a TIFF's strips are declared higher than the image, OpenImageIO 2.4 counts rows and bytes past
// its integers' range and never ends.
bool is_read_by_rows(const OIIO::ImageSpec& spec, std::string_view format) {
    const int rows = spec.get_int_attribute("tiff:RowsPerStrip", 0);
    return format == "tiff" && spec.tile_width == 0 && (rows <= 0 || rows > spec.height);
}

bool read_by_rows(OIIO::ImageInput& input, int first, int end, float* to) {
    const OIIO::ImageSpec& spec = input.spec();
    const auto channels = static_cast<std::size_t>(spec.nchannels);
    std::vector<float> row(channels * static_cast<std::size_t>(spec.width));
    for (int y = 0; y < spec.height; ++y) {
        if (!input.read_scanline(spec.y + y, 0, OIIO::TypeDesc::FLOAT, row.data())) return false;
        for (auto pixel = row.begin(); pixel != row.end(); pixel += spec.nchannels) {
            to = std::copy(pixel + first, pixel + end, to);
        }
    }
    return true;
}

// The channels from `first` up to but not including `end`. OpenImageIO reads what it can from a
// damaged file and sets an error.
std::vector<float> pixels_in(OIIO::ImageInput& input,
                             const std::filesystem::path& file,
                             int first,
                             int end) {
    const OIIO::ImageSpec& spec = input.spec();
    const std::string_view format = input.format_name();
    if (format == "png") {
        return aphotic::png_pixels(file, {spec.width, spec.height, spec.nchannels, first, end});
    }
    if (format == "tiff") aphotic::require_sound_streams(file);
    std::vector<float> pixels(spec.image_pixels() * static_cast<std::size_t>(end - first));
    const bool is_read =
        is_read_by_rows(spec, format)
            ? read_by_rows(input, first, end, pixels.data())
            : input.read_image(0, 0, first, end, OIIO::TypeDesc::FLOAT, pixels.data());
    const std::string fault = input.geterror();
    if (!is_read || !fault.empty()) throw aphotic::InputError(fault);
    return pixels;
}

}  // namespace

extern "C" void aphotic_open_any_image(const std::filesystem::path& file,
                                       aphotic::AnyImage& image) {
    // Opened directly: an image cache could return the pixels of a file that has been replaced.
    const auto input = reading(file, [&] { return opened(file); });
    const OIIO::ImageSpec& spec = input->spec();
    image.width_px = spec.width;
    image.height_px = spec.height;
    image.channels = spec.channelnames;
    image.samples = [input, file](std::size_t channel) {
        const auto c = static_cast<int>(channel);
        return reading(file, [&] { return pixels_in(*input, file, c, c + 1); });
    };
    image.planes = [input, file] {
        const int channels = input->spec().nchannels;
        return reading(file, [&] {
            return planes_of(pixels_in(*input, file, 0, channels),
                             static_cast<std::size_t>(channels));
        });
    };
    image.full_scale = full_scale_of(spec);
    image.description = spec.get_string_attribute("ImageDescription");
    image.date_time = spec.get_string_attribute("DateTime");
}

extern "C" void aphotic_header_of_image(const std::filesystem::path& file,
                                        std::map<std::string, std::string>& tags) {
    reading(file, [&] {
        require_sound_header(file);
        if (std::filesystem::file_size(file) > aphotic::kMostOfNotes_bytes) {
            throw aphotic::InputError("found more than {0} MiB; allowed: {0} MiB or less",
                                      aphotic::kMostOfNotes_bytes / aphotic::kMebi);
        }
        const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file.string());
        if (!input) throw aphotic::InputError(OIIO::geterror());
        for (const OIIO::ParamValue& tag : input->spec().extra_attribs) {
            tags[tag.name().string()] = tag.get_string();
        }
    });
}

static aphotic::ColourProfile profile_of(const aphotic::WrittenImage& image) {
    if (image.channels.size() == 1) return aphotic::ColourProfile::LinearGrey;
    return image.is_srgb ? aphotic::ColourProfile::Srgb : aphotic::ColourProfile::Linear;
}

// The reason why it could not be encoded, or empty.
static std::string encoded(const std::filesystem::path& file,
                           const aphotic::WrittenImage& image,
                           std::vector<unsigned char>& bytes) {
    OIIO::Filesystem::IOVecOutput made(bytes);
    const std::unique_ptr<OIIO::ImageOutput> output =
        OIIO::ImageOutput::create(file.string(), &made);
    if (!output) return OIIO::geterror();
    const bool is_bytes = image.type == aphotic::SampleType::Bits8;
    OIIO::ImageSpec spec(image.width_px,
                         image.height_px,
                         static_cast<int>(image.channels.size()),
                         is_bytes ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16);
    compress(spec, image.compression);
    if (std::string_view(output->format_name()) == "jpeg") {
        spec.attribute("compression", fmt::format("jpeg:{}", image.jpeg_quality));
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    spec.attribute("oiio:ColorSpace", image.is_srgb ? "sRGB" : "Linear");
    spec.attribute("Software", "Aphotic " APHOTIC_VERSION);
    const std::vector<std::uint8_t> profile = aphotic::icc_profile(profile_of(image));
    spec.attribute("ICCProfile",
                   OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(profile.size())),
                   profile.data());
    spec.channelnames = image.channels;
    if (!image.description.empty()) spec.attribute("ImageDescription", image.description);
    const bool is_tiff = std::string_view(output->format_name()) == "tiff";
    if (!image.date_time.empty()) {
        spec.attribute("DateTime", image.date_time);
    } else if (is_tiff) {
        // Without a value, TIFF receives the time of writing; a number is not a time, and is
        // omitted.
        spec.attribute("DateTime", 0);
    }
    if (is_tiff) spec.attribute("tiff:write_exif", 0);  // it reads what it wrote, and cannot here
    output->threads(1);  // images are spread over threads, not their rows
    const bool is_whole = output->open(file.string(), spec) &&
                          (is_bytes ? write_as<std::uint8_t>(*output, image)
                                    : write_as<std::uint16_t>(*output, image)) &&
                          output->close();
    std::string fault = output->geterror();
    if (is_whole) return "";
    return fault.empty() ? "the library gives no reason" : fault;
}

extern "C" void aphotic_encode_any_image(const std::filesystem::path& file,
                                         const aphotic::WrittenImage& image,
                                         std::vector<unsigned char>& bytes,
                                         std::string& fault) {
    fault = encoded(file, image, bytes);
}

extern "C" void aphotic_resize(std::vector<float>& plane,
                               aphotic::PlaneSize from,
                               aphotic::PlaneSize to,
                               const std::string& filter) {
    const OIIO::ImageBuf image(
        OIIO::ImageSpec(from.width_px, from.height_px, 1, OIIO::TypeDesc::FLOAT), plane.data());
    // A width of 0 lets the filter choose its own.
    const OIIO::ImageBuf result = OIIO::ImageBufAlgo::resize(
        image, filter, 0.0F, OIIO::ROI(0, to.width_px, 0, to.height_px, 0, 1, 0, 1));
    std::vector<float> samples(result.spec().image_pixels());
    if (result.has_error() ||
        !result.get_pixels(result.roi(), OIIO::TypeDesc::FLOAT, samples.data())) {
        throw aphotic::InputError("resizing: {}", result.geterror());
    }
    plane = std::move(samples);
}
