// SPDX-License-Identifier: BSD-3-Clause
//
// Images in other formats: OpenImageIO's readers that detect truncated files, its writers, and its
// filters.
//
// OpenImageIO brings some two hundred libraries with it, which take 0.3 s and 100 MB to load, so a
// separate part of the command, aphotic_any_image.so, loads it on first use.
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
    // The samples of one channel, rows from the top, as stored; integers are scaled to 0..1.
    std::function<std::vector<float>(std::size_t channel)> samples;
    // All channels, one after another, in one pass through the file.
    std::function<std::vector<float>()> planes;
    // The integer that is scaled to 1: 255, 4095, 65535. 0 for floats.
    double full_scale = 0.0;
    std::string description;  // the file's own description; empty without one
    std::string date_time;    // when it was taken, "YYYY:MM:DD hh:mm:ss", or empty
};

// For messages: only the first few by name.
[[nodiscard]] std::string names_of(const std::vector<std::string>& channels);

// An image that cannot be read, is truncated, or has a format in which truncation cannot be
// detected is an InputError, also when its samples are requested; a program installed without the
// part is a RunError.
[[nodiscard]] AnyImage open_any_image(const std::filesystem::path& file);

// The file's metadata by OpenImageIO's names, such as "Exif:DateTimeOriginal". Only the header is
// read. An InputError if there is none.
[[nodiscard]] std::map<std::string, std::string> header_of_image(const std::filesystem::path& file);

// Writes planes as an image in the format of the file's extension, complete or not at all. It is
// encoded in memory, since libraries do not report a full disk. Integers map 0 to 1 to their range,
// rounded and clipped. A failure to write is a RunError.
enum class SampleType { Bits8, Bits16 };
// All are lossless except JPEG: deflate at its fastest level, and at the default level of most
// programs.
enum class Compression { None, Fast, Small };
struct WrittenImage {
    int width_px = 0;
    int height_px = 0;
    std::vector<std::string> channels;
    std::span<const float> planes;
    SampleType type = SampleType::Bits16;
    Compression compression = Compression::Fast;
    std::string description{};
    std::string
        date_time{};    // empty: unknown. Never the current time: equal images make identical files
    SharedTags tags{};  // the source file's; for TIFF, PNG and JPEG
    bool is_srgb = false;   // the samples are encoded as sRGB, as stated in the file
    int jpeg_quality = 95;  // 1 to 100; chroma is not subsampled
};
void write_any_image(const std::filesystem::path& file, const WrittenImage& image);

// Resizes a plane of from_width x from_height samples, keeping the image's edges in place, with one
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
