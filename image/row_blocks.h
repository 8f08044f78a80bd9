// SPDX-License-Identifier: BSD-3-Clause
//
// The number of rows in memory of an image with many planes, so that memory does not grow with
// their number: as many as a number of samples over all planes allows, and at most kMostRows, which
// are enough to share among threads.
#pragma once

#include <algorithm>
#include <cstddef>

namespace aphotic {

inline constexpr int kMostRows = 64;

[[nodiscard]] inline int rows_holding(std::size_t samples, int width_px, std::size_t planes) {
    const std::size_t row = static_cast<std::size_t>(width_px) * planes;
    return static_cast<int>(std::min<std::size_t>(samples / row, kMostRows));
}

// Rows that OpenEXR compresses together: 16 with ZIP, one with ZIPS. Deflate looks back 32 KiB, and
// OpenEXR splits the bytes of floats into two halves, one after the other. Beyond 64 KiB a row
// therefore cannot see the row before: compressing rows together saves nothing and takes 16 times
// the memory.
inline constexpr int kRowsOfZip = 16;

[[nodiscard]] inline int rows_compressed_together(int width_px, std::size_t channels) {
    constexpr std::size_t kLongRow_bytes = std::size_t{64} << 10U;
    const std::size_t row_bytes = static_cast<std::size_t>(width_px) * channels * sizeof(float);
    return row_bytes > kLongRow_bytes ? 1 : kRowsOfZip;
}

// Rows traced at a time: radiance as doubles, as floats, and as floats queued for the file take 16
// MiB together, or one row per thread if that is more. The number is a multiple of the threads, so
// that all are busy to the end of the block.
[[nodiscard]] inline int traced_rows(int width_px, std::size_t planes, int threads) {
    constexpr std::size_t kTracedSamples = std::size_t{1} << 20U;
    const int rows = rows_holding(kTracedSamples, width_px, planes);
    return std::max(1, rows / threads) * threads;
}

}  // namespace aphotic
