// SPDX-License-Identifier: BSD-3-Clause
//
// Files that lost their end, as on a full disk or an interrupted copy, in every format that is
// read: nobody takes the rows that are gone for black ones.
#include "image/any_image.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/absurd_images.h"
#include "support/effort.h"
#include "support/file_limit.h"
#include "support/has.h"
#include "support/refusal.h"
#include "support/temp_folder.h"
#include "support/tiff_writer.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

extern "C" void aphotic_open_any_image(const std::filesystem::path& file, aphotic::AnyImage& image);

namespace aphotic::any_image_test {
namespace {

constexpr int kWidth = 48;
constexpr int kHeight = 40;

struct Format {
    std::string file;
    int channels = 3;
    OIIO::TypeDesc type = OIIO::TypeDesc::UINT8;
    std::map<std::string, std::string> words = {};
    bool is_tiled = false;
    bool is_bigtiff = false;

    [[nodiscard]] std::string name() const {
        std::string name = file;
        for (const auto& [key, value] : words) name += "/" + value;
        return name + (is_tiled ? "/tiled" : "") + (is_bigtiff ? "/big" : "");
    }
};

std::vector<Format> all_formats() {
    const auto k8 = OIIO::TypeDesc::UINT8;
    const auto k16 = OIIO::TypeDesc::UINT16;
    const auto kFloat = OIIO::TypeDesc::FLOAT;
    std::vector<Format> formats{{.file = "a.jpg"},
                                {.file = "a.png"},
                                {.file = "mosaic.png", .channels = 1, .type = k16},
                                {.file = "a.bmp"},
                                {.file = "a.tga"},
                                {.file = "rle.tga", .words = {{"compression", "rle"}}},
                                {.file = "a.ppm"},
                                {.file = "a.pgm", .channels = 1, .type = k16},
                                {.file = "a.dpx", .type = k16},
                                {.file = "a.hdr", .type = kFloat},
                                {.file = "a.sgi"},
                                {.file = "a.fits", .channels = 1, .type = kFloat},
                                {.file = "a.webp"},
                                {.file = "a.jp2"}};
    for (const char* compression : {"none", "zip", "lzw", "packbits", "jpeg"}) {
        for (const bool is_tiled : {false, true}) {
            for (const bool is_bigtiff : {false, true}) {
                const bool is_jpeg = std::string(compression) == "jpeg";
                if (is_jpeg && is_tiled) continue;  // OpenImageIO reads none
                formats.push_back({.file = "a.tif",
                                   .channels = is_jpeg ? 3 : 1,
                                   .type = is_jpeg ? k8 : k16,
                                   .words = {{"compression", compression}},
                                   .is_tiled = is_tiled,
                                   .is_bigtiff = is_bigtiff});
            }
        }
    }
    for (const char* compression : {"none", "zip", "lzw", "packbits"}) {
        formats.push_back({.file = "planes.tif",
                           .type = k16,
                           .words = {{"compression", compression}, {"planarconfig", "separate"}}});
    }
    for (const char* compression :
         {"none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"}) {
        formats.push_back(
            {.file = "a.exr", .type = kFloat, .words = {{"compression", compression}}});
    }
    formats.push_back({.file = "tiles.exr", .type = kFloat, .is_tiled = true});
    return formats;
}

// Light that falls to the right, with grain in steps that deflate makes smaller: OpenEXR stores
// what does not get smaller as it is.
std::vector<float> some_pixels(int channels) {
    std::vector<float> pixels;
    std::uint32_t grain = 1;
    for (int i = 0; i < kWidth * kHeight * channels; ++i) {
        grain = grain * 1664525U + 1013904223U;
        const float fall = 1.0F - static_cast<float>(i / channels % kWidth) / kWidth;
        const float number =
            0.2F + 0.5F * fall + 0.2F * static_cast<float>(grain >> 16U) / 65536.0F;
        constexpr float kSteps = 1024.0F;
        pixels.push_back(std::round(number * kSteps) / kSteps);
    }
    return pixels;
}

// The bytes of a file of that format. By one thread, libtiff writes the directory before the
// pixels, so that a file that is cut still has it.
std::string bytes_of(const Format& format, const std::filesystem::path& folder) {
    OIIO::ImageSpec spec(kWidth, kHeight, format.channels, format.type);
    for (const auto& [key, value] : format.words) spec.attribute(key, value);
    if (format.is_tiled) spec.tile_width = spec.tile_height = 16;
    if (format.is_bigtiff) spec.attribute("tiff:bigtiff", 1);
    const std::filesystem::path file = folder / format.file;
    const auto output = OIIO::ImageOutput::create(file.string());
    if (!output) return "";
    output->threads(1);
    const std::vector<float> pixels = some_pixels(format.channels);
    const bool is_written = output->open(file.string(), spec) &&
                            output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) &&
                            output->close();
    return is_written ? read_text_file(file) : "";
}

std::vector<float> planes_in(const std::filesystem::path& file) {
    AnyImage image;
    aphotic_open_any_image(file, image);
    return image.planes();
}

std::string fault_in(const std::filesystem::path& file) {
    return refusal_of([&] { return planes_in(file); });
}

// Written by OpenImageIO itself.
void write_image(const std::filesystem::path& file,
                 const OIIO::ImageSpec& spec,
                 const std::vector<float>& pixels) {
    const auto output = OIIO::ImageOutput::create(file.string());
    ASSERT_TRUE(output && output->open(file.string(), spec) &&
                output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && output->close());
}

// One plane after another, as `compare` reads them.
std::vector<float> planes_by_channel(const std::filesystem::path& file) {
    AnyImage image;
    aphotic_open_any_image(file, image);
    std::vector<float> planes;
    for (std::size_t c = 0; c < image.channels.size(); ++c) {
        const std::vector<float> plane = image.samples(c);
        planes.insert(planes.end(), plane.begin(), plane.end());
    }
    return planes;
}

TEST(AnyImage, WhatIsCutAnywhereIsRefusedOrHasAllItsPixels) {
    constexpr std::size_t kCuts = std::max(cases(100), 20);
    constexpr std::size_t kByChannelEvery = 5;  // the same file, and half of the time
    const TempFolder folder;
    OIIO::attribute("threads", 1);
    for (const Format& format : all_formats()) {
        const std::string bytes = bytes_of(format, folder.path());
        ASSERT_FALSE(bytes.empty()) << format.name();
        const std::filesystem::path file = folder.path() / ("cut-" + format.file);
        write_file(file, bytes);
        const std::vector<float> whole = planes_in(file);
        ASSERT_EQ(whole.size(), static_cast<std::size_t>(kWidth * kHeight * format.channels));
        EXPECT_EQ(planes_by_channel(file), whole) << format.name();
        std::size_t refused = 0;
        for (std::size_t cut = 0; cut < kCuts; ++cut) {
            const std::size_t size = (bytes.size() - 1) * (kCuts - 1 - cut) / (kCuts - 1);
            std::filesystem::resize_file(file, size);
            for (const auto& read : {planes_in, planes_by_channel}) {
                if (read == planes_by_channel && cut % kByChannelEvery != 0) continue;
                try {
                    EXPECT_EQ(read(file), whole)
                        << format.name() << ": " << size << " of " << bytes.size() << " bytes";
                } catch (const InputError& error) {
                    const std::string words = error.what();
                    EXPECT_TRUE(words.starts_with(file.string() + ": cannot be read: ")) << words;
                    EXPECT_EQ(words.find('\n'), std::string::npos) << words;
                    ++refused;
                }
            }
        }
        EXPECT_GT(refused, (kCuts + kCuts / kByChannelEvery) / 2) << format.name();
    }
}

// A disk that filled up can leave zeros in place of the rest, in a file of its full size. Where
// numbers stand as they are, zeros are black pixels, and nobody can tell.
TEST(AnyImage, ZerosInPlaceOfTheRestAreRefusedWhereTheyAreNoPixels) {
    const TempFolder folder;
    const auto is_refused = [&](const Format& format) {
        std::string bytes = bytes_of(format, folder.path());
        const std::size_t half = bytes.size() / 2;
        bytes.replace(half, bytes.size() - half, bytes.size() - half, '\0');
        write_file(folder.path() / format.file, bytes);
        return fault_in(folder.path() / format.file) != kAccepted;
    };
    const auto tiff = [](const std::string& compression) {
        const bool is_jpeg = compression == "jpeg";
        return Format{.file = "a.tif",
                      .channels = is_jpeg ? 3 : 1,
                      .type = is_jpeg ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16,
                      .words = {{"compression", compression}}};
    };
    for (const char* compression : {"zip", "lzw", "packbits"}) {
        EXPECT_TRUE(is_refused(tiff(compression))) << compression;
    }
    EXPECT_TRUE(is_refused({.file = "a.png"}));
    // Zeros are a code of JPEG's, too; docs/guides/correct.md says so.
    for (const char* compression : {"none", "jpeg"}) {
        EXPECT_FALSE(is_refused(tiff(compression))) << compression;
    }
    EXPECT_FALSE(is_refused({.file = "a.jpg"}));
}

// 8 bits, 3 x 2, without compression; numbers of the most significant byte first.
std::string big_endian_tiff(std::uint32_t strip_bytes) {
    TiffWriter tiff(true);
    for (const auto& [tag, value] : std::map<std::uint16_t, std::uint32_t>{
             {256, 3}, {257, 2}, {258, 8}, {259, 1}, {262, 1}, {277, 1}, {278, 2}})
        tiff.shorts(tag, {value});
    tiff.longs(279, {strip_bytes});
    return tiff.file("\1\2\3\4\5\6", TiffOrder::DirectoryValuesPixels);
}

TEST(AnyImage, ATiffIsHeldAgainstItsOwnDirectoryInEitherOrderOfBytes) {
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "a.tif";
    const auto fault = [&](const std::string& bytes) {
        write_file(file, bytes);
        return fault_in(file);
    };
    const std::string whole = big_endian_tiff(6);
    EXPECT_EQ(fault(whole), kAccepted);
    EXPECT_EQ(fault(whole.substr(0, whole.size() - 1)),
              file.string() +
                  fmt::format(": cannot be read: it is truncated: found {} bytes of at least {}",
                              whole.size() - 1,
                              whole.size()));
    EXPECT_EQ(fault(big_endian_tiff(0)),
              file.string() + ": cannot be read: it is incomplete: its strip has too few bytes");
}

// Whether a byte that flips is noticed. Where the format has a checksum of its pixels, always: PNG
// anywhere, deflated TIFF and EXR in their strips, tiles or chunks. The rest has none
// (docs/develop/faults.md); there, whatever is found is said in one line.
enum class Checksum { None, OfPixels, OfAll };

Checksum checksum_of(const Format& format) {
    if (format.file.ends_with(".png")) return Checksum::OfAll;
    const auto compression = format.words.find("compression");
    const std::string words = compression == format.words.end() ? "" : compression->second;
    const bool is_deflated = words == "zip" || words == "zips" || words == "pxr24";
    return is_deflated ? Checksum::OfPixels : Checksum::None;
}

TEST(AnyImage, AFlippedByteIsNoticedWhereTheFormatHasAChecksum) {
    constexpr int kFlips = std::max(cases(8), 3);
    const TempFolder folder;
    OIIO::attribute("threads", 1);
    std::minstd_rand dice(1);
    for (const Format& format : all_formats()) {
        const std::string bytes = bytes_of(format, folder.path());
        const std::filesystem::path file = folder.path() / ("flipped-" + format.file);
        write_file(file, bytes);
        const std::vector<float> whole = planes_in(file);
        const Checksum checksum = checksum_of(format);
        // The first half has the header, which TIFF and EXR have no checksum of.
        const std::size_t first = checksum == Checksum::OfPixels ? bytes.size() / 2 : 0;
        for (int i = 0; i < kFlips; ++i) {
            std::string flipped = bytes;
            const std::size_t at = first + dice() % (bytes.size() - first);
            flipped[at] = static_cast<char>(flipped[at] ^ static_cast<char>(1 + dice() % 255));
            write_file(file, flipped);
            testing::internal::CaptureStderr();
            std::string why;
            bool is_other = false;
            try {
                is_other = planes_in(file) != whole;
            } catch (const InputError& error) {
                why = error.what();
            }
            EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << format.name();
            EXPECT_FALSE(is_other && checksum != Checksum::None)
                << format.name() << ": byte " << at << " of " << bytes.size();
            if (why.empty()) continue;
            EXPECT_TRUE(why.starts_with(file.string() + ": cannot be read: ")) << why;
            EXPECT_EQ(why.find('\n'), std::string::npos) << why;
        }
    }
}

// Of one strip that is said to be higher than the image, as many programs write it.
TEST(AnyImage, AStripThatIsSaidToBeHigherThanTheImageIsRead) {
    const TempFolder folder;
    for (const char* compression : {"none", "zip"}) {
        const Format format{.file = "a.tif",
                            .channels = 1,
                            .type = OIIO::TypeDesc::UINT16,
                            .words = {{"compression", compression},
                                      {"tiff:RowsPerStrip", fmt::format("{}", kHeight)}}};
        std::string bytes = bytes_of(format, folder.path());
        const std::vector<float> whole = planes_in(folder.path() / "a.tif");
        const std::size_t entry = bytes.find(std::string("\x16\1\3\0\1\0\0\0", 8));
        ASSERT_NE(entry, std::string::npos);
        for (const std::string& rows : {std::string("\4\0\1\0\0\0\xFF\xFF\xFF\xFF", 10),
                                        std::string("\4\0\1\0\0\0\xFF\xFF\xFF\x7F", 10),
                                        std::string("\4\0\1\0\0\0\0\0\1\0", 10)}) {
            bytes.replace(entry + 2, rows.size(), rows);
            write_file(folder.path() / "b.tif", bytes);
            EXPECT_EQ(planes_in(folder.path() / "b.tif"), whole) << compression;
        }
    }
}

TEST(AnyImage, OfAbsurdSizeIsRefusedByItsHeaderOrByItsFirstBytes) {
    const TempFolder folder;
    for (const auto& [name, bytes] : absurd_images(kWidth, kHeight)) {
        // A size that an image may have: who knows what it should have refuses it.
        if (name == "tiff-large.tif") continue;
        const std::filesystem::path file = folder.path() / name;
        write_file(file, bytes);
        const std::string why = refusal_of([&] {
            AnyImage image;
            aphotic_open_any_image(file, image);
        });
        EXPECT_TRUE(why.starts_with(file.string() + ": cannot be read: ")) << name << ": " << why;
        for (const char* words : {"alloc", "memory", "vector"})
            EXPECT_FALSE(has(why, words)) << name;
    }
}

// Notes that unpack to more than all else: 65 chunks of text.
TEST(AnyImage, APngOfNotesWithoutEndIsRefused) {
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "a.png";
    std::string bytes = bytes_of({.file = "a.png"}, folder.path());
    std::string notes;
    for (int i = 0; i < 65; ++i) notes += png_chunk("tEXt", std::string("a\0b", 3));
    constexpr std::size_t kBehindIhdr = 8 + 25;
    bytes.insert(kBehindIhdr, notes);
    write_file(file, bytes);
    EXPECT_THROW(static_cast<void>(planes_in(file)), InputError);
}

TEST(AnyImage, WhoseWindowsDifferIsRefusedWithBoth) {
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "a.exr";
    write_file(file, exr_of_windows({2, 1, 4, 3}, {0, 0, 8, 6}));
    const std::string said = refusal_of([&] {
        AnyImage image;
        aphotic_open_any_image(file, image);
    });
    EXPECT_EQ(said,
              file.string() +
                  ": cannot be read: its data window, 4 x 3 from 2, 1, differs from its display "
                  "window, 8 x 6 from 0, 0; allowed: equal");
}

// Where both windows begin elsewhere than at 0, 0, the image is the same.
TEST(AnyImage, WhoseWindowsBeginElsewhereIsTheSame) {
    const TempFolder folder;
    std::vector<std::vector<float>> read;
    for (const bool is_moved : {false, true}) {
        OIIO::ImageSpec spec(kWidth, kHeight, 3, OIIO::TypeDesc::FLOAT);
        spec.x = spec.full_x = is_moved ? -7 : 0;
        spec.y = spec.full_y = is_moved ? 5 : 0;
        const std::filesystem::path file = folder.path() / "a.exr";
        write_image(file, spec, some_pixels(3));
        read.push_back(planes_in(file));
    }
    EXPECT_EQ(read[1], read[0]);
}

// Alpha is no share of a camera's numbers.
TEST(AnyImage, SamplesBesideAlphaAreAsStored) {
    const TempFolder folder;
    for (const std::string name : {"a.png", "a.tif"}) {
        const std::filesystem::path file = folder.path() / name;
        const std::string bytes = bytes_of({.file = name, .channels = 3}, folder.path());
        const std::vector<float> three = planes_in(file);
        OIIO::ImageSpec spec(kWidth, kHeight, 4, OIIO::TypeDesc::UINT8);
        spec.attribute("oiio:UnassociatedAlpha", 1);
        std::vector<float> pixels;
        const std::size_t count = std::size_t{kWidth} * kHeight;
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t c = 0; c < 3; ++c) pixels.push_back(three[c * count + i]);
            pixels.push_back(0.4F);
        }
        write_image(file, spec, pixels);
        std::vector<float> found = planes_in(file);
        ASSERT_EQ(found.size(), 4 * count);
        found.resize(3 * count);
        EXPECT_EQ(found, three) << name;
    }
}

// As OpenImageIO reads it: what other programs make of the numbers, who wrote them, and no time
// where none is known.
TEST(AnyImage, SaysWhatItsNumbersMean) {
    const TempFolder folder;
    const std::vector<float> planes(std::size_t{3} * kWidth * kHeight, 0.5F);
    for (const char* name : {"a.tif", "a.png", "a.jpg"}) {
        for (const bool is_srgb : {false, true}) {
            const std::filesystem::path file = folder.path() / name;
            write_any_image(file,
                            {.width_px = kWidth,
                             .height_px = kHeight,
                             .channels = {"R", "G", "B"},
                             .planes = planes,
                             .type = SampleType::Bits8,
                             .is_srgb = is_srgb});
            auto header = header_of_image(file);
            EXPECT_EQ(header["ICCProfile:profile_description"],
                      is_srgb ? "sRGB" : "Linear RGB, Rec. 709 primaries")
                << name;
            EXPECT_FALSE(header.contains("DateTime")) << name;
            const bool is_signed = header["Software"].starts_with("Aphotic ");
            EXPECT_TRUE(is_signed || file.extension() == ".jpg") << name;
        }
    }
    const std::filesystem::path grey = folder.path() / "grey.tif";
    write_any_image(
        grey, {.width_px = kWidth, .height_px = 3 * kHeight, .channels = {"Y"}, .planes = planes});
    EXPECT_EQ(header_of_image(grey)["ICCProfile:profile_description"], "Linear grey");
}

// The limit of a process stands for the disk's; both fail a write.
TEST(AnyImage, ThatDoesNotFitOnTheDiskIsSaidByItsOwnName) {
    const TempFolder folder;
    const std::vector<float> planes(std::size_t{3} * kWidth * kHeight, 0.5F);
    const SharedTags tags = tags_of({.iso = 100.0});
    for (const char* name : {"a.tif", "a.png", "a.jpg"}) {
        for (const SharedTags& with : {SharedTags(), tags}) {
            const std::filesystem::path file = folder.path() / name;
            const auto fault = [&](::rlim_t most_bytes) -> std::string {
                const FileLimit limit(most_bytes);
                return run_error_of([&] {
                    write_any_image(file,
                                    {.width_px = kWidth,
                                     .height_px = kHeight,
                                     .channels = {"R", "G", "B"},
                                     .planes = planes,
                                     .type = SampleType::Bits8,
                                     .compression = Compression::None,
                                     .tags = with});
                });
            };
            for (const ::rlim_t most_bytes : {0U, 10U, 300U}) {
                const std::string why = fault(most_bytes);
                EXPECT_TRUE(why.starts_with(file.string() + ": ")) << why;
                EXPECT_TRUE(why.ends_with("cannot be written: File too large")) << why;
            }
            EXPECT_EQ(fault(std::size_t{1} << 20U), kAccepted);
            EXPECT_EQ(planes_in(file).size(), planes.size());
            const SharedTags found = read_image_tags(file);
            EXPECT_EQ(found ? exposure_of(*found).iso.value_or(0.0) : 0.0, with ? 100.0 : 0.0);
            std::filesystem::remove(file);
        }
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Some cameras fill their JPEG files up before the end marker.
TEST(AnyImage, BytesAfterTheLastPixelOfAJpegAreNoFault) {
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "a.jpg";
    std::string bytes = bytes_of({.file = "a.jpg"}, folder.path());
    const std::vector<float> whole = planes_in(file);
    bytes.insert(bytes.size() - 2, "padding");
    write_file(file, bytes);
    EXPECT_EQ(planes_in(file), whole);
}

// The decoder of a progressive JPEG that lost its place has bytes left before the end marker, and
// these are no camera's padding: whatever they are taken for, pixels differ.
TEST(AnyImage, BytesThatADamagedJpegLeavesAreAFault) {
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "a.jpg";
    const std::string bytes =
        bytes_of({.file = "a.jpg", .words = {{"jpeg:progressive", "1"}}}, folder.path());
    ASSERT_TRUE(has(bytes, "\xFF\xC2")) << "it is not progressive";
    EXPECT_NO_THROW(static_cast<void>(planes_in(file)));
    const auto is_refused = [&](const std::string& damaged) {
        write_file(file, damaged);
        return fault_in(file) != kAccepted;
    };
    for (const std::size_t left : {7U, 16U, 200U}) {
        std::string longer = bytes;
        longer.insert(bytes.size() - 2, left, 'x');
        EXPECT_TRUE(is_refused(longer)) << left;
    }
    constexpr std::size_t kSpan = 50;
    std::string shorter = bytes;
    shorter.erase(bytes.size() - 3 * kSpan, kSpan);
    EXPECT_TRUE(is_refused(shorter)) << "a span in the middle of the last scan is gone";
    std::string flipped = bytes;
    std::size_t refused = 0;
    for (std::size_t at = bytes.size() / 2; at < bytes.size() - 3 * kSpan; at += kSpan) {
        flipped[at] = static_cast<char>(~flipped[at]);
        if (is_refused(flipped)) ++refused;
        flipped[at] = bytes[at];
    }
    EXPECT_GT(refused, 0U);
}

// Stripes of a pixel each, red and blue by turns: chroma of half the resolution would mix them.
TEST(AnyImage, AJpegHasItsColoursAtEveryPixelAndItsQuality) {
    constexpr float kDark = 0.3F;
    constexpr float kBright = 0.7F;
    constexpr double kQuality95 = 0.04;  // what its coarsest steps leave of such stripes
    const TempFolder folder;
    const std::size_t pixels = std::size_t{kWidth} * kHeight;
    std::vector<float> planes(3 * pixels, kDark);
    for (std::size_t i = 0; i < pixels; ++i) planes[i % 2 * 2 * pixels + i] = kBright;
    const auto written = [&](int quality) {
        const std::filesystem::path file = folder.path() / fmt::format("{}.jpg", quality);
        write_any_image(file,
                        {.width_px = kWidth,
                         .height_px = kHeight,
                         .channels = {"R", "G", "B"},
                         .planes = planes,
                         .type = SampleType::Bits8,
                         .jpeg_quality = quality});
        return file;
    };
    const std::vector<float> found = planes_in(written(95));
    ASSERT_EQ(found.size(), planes.size());
    for (std::size_t i = 0; i < planes.size(); ++i) EXPECT_NEAR(found[i], planes[i], kQuality95);
    EXPECT_LT(std::filesystem::file_size(written(20)), std::filesystem::file_size(written(95)));
}

// Whether a file of these is whole, nobody can tell.
TEST(AnyImage, OtherFormatsAreRefusedByName) {
    const TempFolder folder;
    const Format format{.file = "a.zfile", .channels = 1, .type = OIIO::TypeDesc::FLOAT};
    ASSERT_NE(bytes_of(format, folder.path()), "");
    const std::string said = refusal_of([&] { return planes_in(folder.path() / "a.zfile"); });
    EXPECT_TRUE(has(said, "found the format zfile; allowed: bmp, dpx,"));
}

}  // namespace
}  // namespace aphotic::any_image_test
