// SPDX-License-Identifier: BSD-3-Clause
//
// Images in the formats that OpenImageIO reads whole or not at all, those that it writes, and its
// filters.
//
// OpenImageIO brings some two hundred libraries with it, which take 0.3 s and 100 MB to load: a
// part of the command by itself, aphotic_any_image.so, loads it when such an image is asked for.
#pragma once

#include "image/image_tags.h"

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

struct AnyImage {
    int width_px = 0;
    int height_px = 0;
    std::vector<std::string> channels;
    // The samples of one channel, rows from the top, as stored, integers scaled to 0..1.
    std::function<std::vector<float>(std::size_t channel)> samples;
    // All of them, one channel after another, from one pass through the file.
    std::function<std::vector<float>()> planes;
    // What the integer stood for that is 1 here: 255, 4095, 65535. 0 of floats.
    double full_scale = 0.0;
    std::string description;  // the file's own words; empty when it has none
    std::string date_time;    // when it was taken, "YYYY:MM:DD hh:mm:ss", or empty
};

// For messages: no more than the first few by name.
[[nodiscard]] std::string names_of(const std::vector<std::string>& channels);

// An image that cannot be read, is cut short, or is of a format of which that cannot be told, is an
// InputError, also when its samples are asked for; a program installed without the part, a
// RunError.
[[nodiscard]] AnyImage open_any_image(const std::filesystem::path& file);

// What the file says of itself, by the names that OpenImageIO has for it, such as
// "Exif:DateTimeOriginal". Of the file its header alone is read. An InputError when it has none.
[[nodiscard]] std::map<std::string, std::string> header_of_image(const std::filesystem::path& file);

// Planes as an image, in the format that the file's extension names, whole or not there. Integers
// are 0 to 1 over their range, rounded and clipped. What cannot be written is a RunError.
enum class SampleType { Bits8, Bits16 };
// All of them lossless, but for JPEG: deflate at its fastest level and at the level that most
// programs take.
enum class Compression { None, Fast, Small };
struct WrittenImage {
    int width_px = 0;
    int height_px = 0;
    std::vector<std::string> channels;
    std::span<const float> planes;
    SampleType type = SampleType::Bits16;
    Compression compression = Compression::Fast;
    std::string description{};
    std::string date_time{};  // empty: not known. Never now: the same image is the same file
    SharedTags tags{};        // of the file that it was made of; of TIFF, PNG and JPEG
    bool is_srgb = false;     // the samples are encoded as sRGB, which the file says
    int jpeg_quality = 95;    // 1 to 100; colours are kept at every pixel
};
void write_any_image(const std::filesystem::path& file, const WrittenImage& image);

// One plane of from_width x from_height samples at another size, the image's edges in place, by one
// of OpenImageIO's filters, such as "lanczos3". An unknown filter is an InputError.
struct PlaneSize {
    int width_px = 0;
    int height_px = 0;
};
[[nodiscard]] std::vector<float> resized(std::vector<float> plane,
                                         PlaneSize from,
                                         PlaneSize to,
                                         const std::string& filter);

}  // namespace aphotic
