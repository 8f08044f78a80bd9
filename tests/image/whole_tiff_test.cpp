// SPDX-License-Identifier: BSD-3-Clause
//
// Directories of TIFF files that promise fewer pixels than the image has, or more than any file.
#include "image/whole_tiff.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/refusal.h"
#include "support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::whole_tiff_test {
namespace {

constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kMost32 = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint64_t kPixelsAt = 1000;

using Directory = std::map<std::uint16_t, std::vector<std::uint64_t>>;

// Little-endian BigTIFF: the directory at 16, what does not fit into an entry behind it, pixels
// from kPixelsAt to the end at 2000.
std::string file_of(const Directory& directory) {
    constexpr std::size_t kEntry = 20;
    std::string more;
    const auto put = [](std::string& bytes, std::uint64_t number, unsigned size) {
        for (unsigned i = 0; i < size; ++i) bytes += static_cast<char>(number >> 8 * i & 0xFFU);
    };
    std::string bytes = "II";
    put(bytes, 43, 2);
    put(bytes, 8, 4);
    put(bytes, 16, 8);
    put(bytes, directory.size(), 8);
    const std::size_t more_at = bytes.size() + directory.size() * kEntry + 8;
    for (const auto& [tag, values] : directory) {
        put(bytes, tag, 2);
        put(bytes, 16, 2);
        put(bytes, values.size(), 8);
        put(bytes, values.size() == 1 ? values[0] : more_at + more.size(), 8);
        if (values.size() == 1) continue;
        for (const std::uint64_t value : values) put(more, value, 8);
    }
    put(bytes, 0, 8);
    bytes += more;
    EXPECT_LE(bytes.size(), kPixelsAt);
    bytes.resize(2 * kPixelsAt, '\1');
    return bytes;
}

std::string fault_of(const Directory& directory) {
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "a.tif";
    write_file(file, file_of(directory));
    return refusal_of([&] { require_whole_tiff(file); });
}

Directory with(Directory directory, const Directory& others) {
    for (const auto& [tag, values] : others) directory[tag] = values;
    return directory;
}

Directory without(Directory directory, std::uint16_t tag) {
    directory.erase(tag);
    return directory;
}

std::vector<std::uint64_t> times(std::size_t count, std::uint64_t value) {
    return std::vector<std::uint64_t>(count, value);
}

// 8 rows of 10 pixels, two a strip.
const Directory kStrips{
    {256, {10}}, {257, {8}}, {273, times(4, kPixelsAt)}, {278, {2}}, {279, times(4, 20)}};
// The same in tiles of 4 x 3: 3 across, 3 down.
const Directory kTiles{{256, {10}},
                       {257, {8}},
                       {322, {4}},
                       {323, {3}},
                       {324, times(9, kPixelsAt)},
                       {325, times(9, 12)}};

std::string empty(int part, int parts) {
    return fmt::format("it is incomplete: strip or tile {} of {} is empty", part, parts);
}

TEST(WholeTiff, HasAsManyStripsAndTilesAsThePixelsNeed) {
    EXPECT_EQ(fault_of(kStrips), kAccepted);
    EXPECT_EQ(fault_of(kTiles), kAccepted);
    EXPECT_EQ(fault_of(with(kStrips, {{278, {8}}, {273, {kPixelsAt}}, {279, {80}}})), kAccepted);
    EXPECT_EQ(fault_of(without(with(kStrips, {{273, {kPixelsAt}}, {279, {80}}}), 278)), kAccepted);
    EXPECT_EQ(fault_of(with(kStrips, {{278, {1}}})), empty(5, 8));
    EXPECT_EQ(fault_of(with(kStrips, {{257, {9}}})), empty(5, 5));
    EXPECT_EQ(fault_of(with(kStrips, {{277, {3}}, {284, {2}}})), empty(5, 12));
    EXPECT_EQ(fault_of(with(kStrips, {{277, {3}}, {284, {1}}})), kAccepted) << "side by side";
    EXPECT_EQ(fault_of(with(kTiles, {{324, times(4, kPixelsAt)}, {325, times(4, 12)}})),
              empty(5, 9));
    EXPECT_EQ(fault_of(with(kTiles, {{277, {3}}, {284, {2}}})), empty(10, 27));
    EXPECT_EQ(fault_of(with(kStrips, {{279, times(3, 20)}})), empty(4, 4));
    EXPECT_EQ(fault_of(with(kStrips, {{279, {20, 20, 0, 20}}})), empty(3, 4));
}

// libtiff says why, and nothing on the terminal.
TEST(WholeTiff, WhatIsNotToldIsNotWhole) {
    const auto is_not_whole = [](const Directory& directory) {
        return fault_of(directory).starts_with("it is incomplete: ");
    };
    testing::internal::CaptureStderr();
    for (const auto& [directory, tags] :
         {std::pair{kStrips, std::vector<std::uint16_t>{257, 273, 279}},
          std::pair{kTiles, std::vector<std::uint16_t>{256, 257, 322, 323, 324, 325}}}) {
        for (const std::uint16_t tag : tags)
            EXPECT_TRUE(is_not_whole(without(directory, tag))) << tag;
    }
    for (const std::uint16_t tag : std::vector<std::uint16_t>{257, 278})
        EXPECT_TRUE(is_not_whole(with(kStrips, {{tag, {0}}}))) << tag;
    for (const std::uint16_t tag : std::vector<std::uint16_t>{322, 323})
        EXPECT_TRUE(is_not_whole(with(kTiles, {{tag, {0}}}))) << tag;
    EXPECT_TRUE(is_not_whole(with(kStrips, {{258, {}}})));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// Of the only strip libtiff makes up what it holds to be false: 16 bytes are 8 rows of 10 bits.
TEST(WholeTiff, AStripOfFewerBytesThanItsPixelsIsNotWhole) {
    const Directory one = with(kStrips, {{278, {8}}, {273, {kPixelsAt}}, {279, {16}}});
    EXPECT_EQ(fault_of(one), kAccepted);
    const std::string fault = "it is incomplete: its strip has too few bytes";
    EXPECT_EQ(fault_of(with(one, {{279, {15}}})), fault);
    EXPECT_EQ(fault_of(with(one, {{279, {0}}})), fault);
    EXPECT_EQ(fault_of(without(one, 279)), fault);
    EXPECT_EQ(fault_of(with(one, {{273, {1985}}})),
              "it is truncated: found 2000 bytes of at least 2001");
}

// Numbers whose sums and products 64 bits do not hold.
TEST(WholeTiff, NumbersNear2To64AreNoWayRound) {
    EXPECT_EQ(fault_of(with(kStrips, {{273, times(4, kMost - 10)}})), "it points past its end");
    EXPECT_EQ(fault_of(with(kStrips, {{279, times(4, kMost)}})), "it points past its end");
    EXPECT_EQ(fault_of(with(kStrips, {{279, {20, 20, 20, 1001}}})),
              "it is truncated: found 2000 bytes of at least 2001");
    // 2^32 x 2^32 tiles are 2^64, and as 64 bits have it, 0.
    EXPECT_NE(fault_of(with(kTiles,
                            {{256, {kMost32 + 1}}, {257, {kMost32 + 1}}, {322, {1}}, {323, {1}}})),
              kAccepted);
    EXPECT_EQ(fault_of(with(kTiles, {{256, {32769}}})),
              "found 32769 x 8 pixels; allowed: 1 to 32768 each way");
    EXPECT_NE(fault_of(with(kStrips, {{257, {kMost}}, {278, {1}}, {277, {kMost}}, {284, {2}}})),
              kAccepted);
    EXPECT_NE(fault_of(with(kStrips, {{277, {kMost}}, {284, {2}}})), kAccepted);
    EXPECT_NE(fault_of(with(kStrips, {{258, {kMost}}, {277, {kMost}}})), kAccepted);
}

// Strips of one byte that 64 KiB and more lie in.
TEST(WholeTiff, OfSizesThatNoImageHasIsRefused) {
    const std::string tiles = fault_of(with(
        kTiles, {{258, {16}}, {322, {1U << 20U}}, {323, {1U << 20U}}, {324, {1000}}, {325, {9}}}));
    EXPECT_EQ(tiles, "found tiles of 1048576 x 1048576 pixels for an image of 10 x 8");
    EXPECT_EQ(fault_of(with(kStrips, {{32997, {5}}})), "found a depth of 5 pixels; allowed: 1");
    EXPECT_NE(fault_of(with(kStrips, {{256, {32768}}, {257, {32768}}, {258, {64}}})), kAccepted);
    // Of a tile each way that is far larger than the image, as small images have them.
    EXPECT_EQ(fault_of(with(kTiles,
                            {{258, {16}}, {322, {512}}, {323, {512}}, {324, {1000}}, {325, {9}}})),
              kAccepted);
}

// "abcdefgh" ten times, by zlib, and what becomes of it.
TEST(WholeTiff, AnyBitOfADeflatedStripIsLookedAt) {
    std::string row;
    for (int i = 0; i < 10; ++i) row += "abcdefgh";
    std::string packed(200, '\0');
    uLongf size = packed.size();
    ASSERT_EQ(::compress(reinterpret_cast<Bytef*>(packed.data()),
                         &size,
                         reinterpret_cast<const Bytef*>(row.data()),
                         row.size()),
              Z_OK);
    packed.resize(size);
    const auto unpacked = [](const std::string& bytes) {
        std::string text(200, '\0');
        uLongf length = text.size();
        ::uncompress(reinterpret_cast<Bytef*>(text.data()),
                     &length,
                     reinterpret_cast<const Bytef*>(bytes.data()),
                     bytes.size());
        return text.substr(0, length);
    };
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "a.tif";
    const auto fault = [&](const std::string& pixels, std::uint64_t rows) -> std::string {
        std::string bytes = file_of({{256, {10}},
                                     {257, {rows}},
                                     {258, {8}},
                                     {259, {8}},
                                     {273, {kPixelsAt}},
                                     {279, {pixels.size()}}});
        bytes.replace(kPixelsAt, pixels.size(), pixels);
        write_file(file, bytes);
        return refusal_of([&] {
            require_whole_tiff(file);
            require_sound_streams(file);
        });
    };
    EXPECT_EQ(fault(packed, 8), kAccepted);
    EXPECT_EQ(fault(packed + "more", 8), kAccepted) << "what fills a strip up";
    EXPECT_EQ(fault(packed, 3), "strip or tile 1 of 1 is damaged: it holds more than its 60 bytes");
    EXPECT_EQ(fault(packed.substr(0, packed.size() - 1), 8),
              "strip or tile 1 of 1 is damaged: its end is missing");
    for (std::size_t bit = 0; bit < 8 * packed.size(); ++bit) {
        std::string flipped = packed;
        flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ static_cast<char>(1U << bit % 8));
        // A few bits before the checksum fill up a byte and mean nothing.
        EXPECT_TRUE(fault(flipped, 8) != kAccepted || unpacked(flipped) == row) << bit;
    }
}

}  // namespace
}  // namespace aphotic::whole_tiff_test
