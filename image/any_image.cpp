// SPDX-License-Identifier: BSD-3-Clause
#include "image/any_image.h"

#include "base/atomic_file.h"
#include "base/error.h"

#include "image/any_image_part.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace aphotic {
namespace {

// OpenImageIO cuts a path at its question mark and reads the rest as options.
void require_plain_path(const std::filesystem::path& file) {
    if (file.string().find('?') == std::string::npos) return;
    throw InputError(
        "{}: found a question mark in the path; allowed: none, since OpenImageIO reads what "
        "follows it as options",
        file.string());
}

}  // namespace

std::string names_of(const std::vector<std::string>& channels) {
    constexpr std::size_t kFew = 20;
    if (channels.size() <= kFew) return fmt::format("{}", fmt::join(channels, ", "));
    return fmt::format(
        "{} and {} more", fmt::join(std::span(channels).first(kFew), ", "), channels.size() - kFew);
}

AnyImage open_any_image(const std::filesystem::path& file) {
    using Open = void (*)(const std::filesystem::path&, AnyImage&);
    AnyImage image;
    require_plain_path(file);
    from_part<Open>("aphotic_open_any_image")(file, image);
    return image;
}

std::map<std::string, std::string> header_of_image(const std::filesystem::path& file) {
    using Read = void (*)(const std::filesystem::path&, std::map<std::string, std::string>&);
    std::map<std::string, std::string> tags;
    require_plain_path(file);
    from_part<Read>("aphotic_header_of_image")(file, tags);
    return tags;
}

void write_any_image(const std::filesystem::path& file, const WrittenImage& image) {
    using Encode = void (*)(const std::filesystem::path&,
                            const WrittenImage&,
                            std::vector<unsigned char>&,
                            std::string&);
    require_plain_path(file);
    std::vector<unsigned char> bytes;
    std::string fault;
    from_part<Encode>("aphotic_encode_any_image")(file, image, bytes, fault);
    if (!fault.empty()) throw RunError("{}: cannot be written: {}", file.string(), fault);
    // OpenImageIO marks sRGB only in PNG and JPEG (any_image_oiio.cpp).
    const bool is_unmarked = image.is_srgb && file.extension().string().starts_with(".tif");
    if (image.tags || is_unmarked) add_image_tags(file, bytes, image.tags, is_unmarked);
    write_text_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::vector<float> resized(std::vector<float> plane,
                           PlaneSize from,
                           PlaneSize to,
                           const std::string& filter) {
    using Resize = void (*)(std::vector<float>&, PlaneSize, PlaneSize, const std::string&);
    from_part<Resize>("aphotic_resize")(plane, from, to, filter);
    return plane;
}

}  // namespace aphotic
