// SPDX-License-Identifier: BSD-3-Clause
#include "image/row_blocks.h"

#include "image/exr.h"
#include "support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace aphotic::row_blocks_test {
namespace {

constexpr int kWidth_px = 1360;
constexpr std::size_t kTraced_bytes = std::size_t{16} << 20U;  // as the header says
constexpr std::size_t kSample_bytes = 8 + 4 + 4;               // double, float, float

TEST(TracedRows, OccupyEveryThreadAlike) {
    for (const std::size_t planes : {3U, 6U, 33U, 303U, 100000U}) {
        for (const int threads : {1, 2, 3, 7, 64, 1000}) {
            const int rows = traced_rows(kWidth_px, planes, threads);
            EXPECT_GE(rows, threads) << planes;
            EXPECT_EQ(rows % threads, 0) << planes << " planes, " << threads << " threads";
        }
    }
}

TEST(TracedRows, HoldNoMoreThanTheirBytesOrARowForEachThread) {
    for (const std::size_t planes : {3U, 6U, 33U, 303U, 100000U}) {
        for (const int threads : {1, 2, 7}) {
            const int rows = traced_rows(kWidth_px, planes, threads);
            EXPECT_TRUE(rows == threads ||
                        static_cast<std::size_t>(rows) * kWidth_px * planes * kSample_bytes <=
                            kTraced_bytes)
                << rows << " rows of " << planes << " planes";
        }
    }
    EXPECT_EQ(traced_rows(kWidth_px, 6, 2), kMostRows) << "HabCam by default";
}

// The claim by which long rows are compressed one by one: 16 together are hardly smaller. Rows that
// repeat each other are the best case for it: were they in view, 16 would take the bytes of one.
TEST(RowsCompressedTogether, AreOneWhereZipSeesNoFurther) {
    static constexpr int kRows = 32;
    const auto bytes_of = [](int width_px) {
        const TempFolder folder;
        ExrWriter exr(folder.path() / "a.exr", width_px, kRows, {"A"}, {});
        std::vector<float> samples;
        unsigned state = 1;
        std::vector<float> row;
        for (int x = 0; x < width_px; ++x) {
            state = state * 1664525U + 1013904223U;
            row.push_back(static_cast<float>(state));
        }
        for (int r = 0; r < kRows; ++r) samples.insert(samples.end(), row.begin(), row.end());
        exr.write_rows(kRows, samples);
        exr.finish();
        const ExrReader reader(folder.path() / "a.exr");
        EXPECT_EQ(reader.height_px(), kRows);
        return static_cast<double>(std::filesystem::file_size(folder.path() / "a.exr")) /
               (static_cast<double>(width_px) * kRows * sizeof(float));
    };
    EXPECT_EQ(rows_compressed_together(4000, 1), kRowsOfZip);
    EXPECT_LT(bytes_of(4000), 0.2) << "in view: a sixteenth, and a bit";
    EXPECT_EQ(rows_compressed_together(20000, 1), 1);
    EXPECT_GT(bytes_of(20000), 0.8);
}

}  // namespace
}  // namespace aphotic::row_blocks_test
