// SPDX-License-Identifier: BSD-3-Clause
#include "image/exr.h"

#include "base/error.h"
#include "support/absurd_images.h"
#include "support/file_limit.h"
#include "support/has.h"
#include "support/refusal.h"
#include "tests/support/temp_folder.h"

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iterator>

namespace aphotic::exr_test {
namespace {

namespace fs = std::filesystem;

// A value that tells channel, row and column apart, and that no half float could hold.
float sample_at(int channel, int row, int column) {
    return static_cast<float>(channel * 1'000'000 + row * 1000 + column) + 0.25F;
}

// Rows first to first + rows of all channels, planar.
std::vector<float> rows_of(int channels, int first_row, int rows, int width_px) {
    std::vector<float> samples;
    for (int c = 0; c < channels; ++c) {
        for (int row = first_row; row < first_row + rows; ++row) {
            for (int x = 0; x < width_px; ++x) samples.push_back(sample_at(c, row, x));
        }
    }
    return samples;
}

constexpr int kWidth = 7;
constexpr int kHeight = 37;  // two of ZIP's blocks of 16 rows, and a part of one

// Room for that many rows of both channels.
std::vector<float> room_for(int rows) {
    return std::vector<float>(std::size_t{2} * kWidth * static_cast<std::size_t>(rows));
}

void write_image(const fs::path& file, const std::vector<int>& blocks) {
    ExrWriter out(file, kWidth, kHeight, {"A", "B"}, {{"aphotic:note", "text"}, {"empty", ""}});
    int row = 0;
    for (const int rows : blocks) {
        out.write_rows(rows, rows_of(2, row, rows, kWidth));
        row += rows;
    }
    out.finish();
}

std::size_t files_in(const TempFolder& folder) {
    const fs::directory_iterator files(folder.path());
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

TEST(Exr, ComesBackFloatForFloat) {
    const TempFolder folder;
    const fs::path file = folder.path() / "image.exr";
    write_image(file, {kHeight});
    ExrReader in(file);
    EXPECT_EQ(in.width_px(), kWidth);
    EXPECT_EQ(in.height_px(), kHeight);
    EXPECT_EQ(in.channels(), (std::vector<std::string>{"A", "B"}));
    std::vector<float> samples = room_for(kHeight);
    in.read_rows(0, kHeight, in.channels(), samples);
    EXPECT_EQ(samples, rows_of(2, 0, kHeight, kWidth));
}

TEST(Exr, DoesNotDependOnTheBlocksItWasWrittenOrReadIn) {
    const TempFolder folder;
    const fs::path file = folder.path() / "image.exr";
    write_image(file, {1, 16, 5, 15});
    ExrReader in(file);
    for (const int rows : {1, 3, 16, 20, kHeight}) {
        for (int first = 0; first + rows <= kHeight; first += rows) {
            std::vector<float> samples = room_for(rows);
            in.read_rows(first, rows, in.channels(), samples);
            EXPECT_EQ(samples, rows_of(2, first, rows, kWidth))
                << rows << " rows from row " << first;
        }
    }
}

TEST(Exr, ReadsTheChannelsThatAreNamedInTheirOrder) {
    const TempFolder folder;
    const fs::path file = folder.path() / "image.exr";
    write_image(file, {kHeight});
    ExrReader in(file);
    const std::vector<std::string> names{"B", "A"};
    std::vector<float> samples = room_for(1);
    in.read_rows(4, 1, names, samples);
    EXPECT_EQ(samples.front(), sample_at(1, 4, 0));
    EXPECT_EQ(samples.back(), sample_at(0, 4, kWidth - 1));
}

// By OpenEXR: primaries where there are colours, and who wrote it.
TEST(Exr, SaysWhatItsNumbersMean) {
    const TempFolder folder;
    const auto header_of = [&](const std::vector<std::string>& channels) {
        const fs::path file = folder.path() / (channels.front() + ".exr");
        ExrWriter out(file, 1, 1, channels, {});
        out.write_rows(1, std::vector<float>(channels.size(), 0.5F));
        out.finish();
        return Imf::InputFile(file.c_str()).header();
    };
    const Imf::Header colours = header_of({"R", "G", "B"});
    ASSERT_TRUE(Imf::hasChromaticities(colours));
    EXPECT_EQ(Imf::chromaticities(colours).red, Imath::V2f(0.64F, 0.33F));  // Rec. 709
    EXPECT_EQ(colours.typedAttribute<Imf::StringAttribute>("software").value().substr(0, 8),
              "Aphotic ");
    EXPECT_FALSE(Imf::hasChromaticities(header_of({"Y"})));
}

TEST(Exr, KeepsTextAttributes) {
    const TempFolder folder;
    const fs::path file = folder.path() / "image.exr";
    write_image(file, {kHeight});
    const ExrReader in(file);
    EXPECT_EQ(in.attribute("aphotic:note"), "text");
    EXPECT_EQ(in.attribute("empty"), "");
    EXPECT_EQ(in.attribute("none"), "");
    EXPECT_EQ(in.attribute("compression"), "") << "an attribute that is no text";
}

// What OpenEXR itself says of the file: 32-bit floats, ZIP.
TEST(Exr, IsWrittenAsZippedFloats) {
    const TempFolder folder;
    const fs::path file = folder.path() / "image.exr";
    write_image(file, {kHeight});
    const Imf::InputFile in(file.c_str());
    EXPECT_EQ(in.header().compression(), Imf::ZIP_COMPRESSION);
    EXPECT_EQ(in.header().channels()["A"].type, Imf::FLOAT);
    EXPECT_EQ(in.header().channels()["B"].type, Imf::FLOAT);
}

TEST(Exr, LeavesNothingBehindUnlessFinished) {
    const TempFolder folder;
    {
        ExrWriter out(folder.path() / "image.exr", kWidth, kHeight, {"A", "B"}, {});
        out.write_rows(16, rows_of(2, 0, 16, kWidth));
    }
    EXPECT_EQ(files_in(folder), 0U);
    write_image(folder.path() / "image.exr", {kHeight});
    EXPECT_EQ(files_in(folder), 1U);
}

TEST(Exr, ThatCannotBeReadIsARunErrorThatNamesIt) {
    const TempFolder folder;
    const fs::path file = folder.path() / "image.exr";
    write_file(file, "PNG");
    EXPECT_TRUE(run_error_of([&] {
                    const ExrReader in(file);
                }).starts_with(file.string() + ": not a readable OpenEXR image: "));
}

TEST(Exr, ThatIsNotThereIsARunErrorThatNamesIt) {
    const TempFolder folder;
    const fs::path file = folder.path() / "image.exr";
    const std::string why = file.string() + ": cannot be read: No such file or directory";
    EXPECT_EQ(run_error_of([&] { const ExrReader in(file); }), why);
    // Whoever names it has mistyped it.
    const std::string said = refusal_of(
        [&] { from_named_exr(file, [](ExrReader& reader) { return reader.width_px(); }); });
    EXPECT_EQ(said, why);
}

// A part of the image, or more than it, as compositors write them.
TEST(Exr, WhoseWindowsDifferIsRefusedWithBoth) {
    const TempFolder folder;
    const fs::path file = folder.path() / "image.exr";
    const auto fault = [&](const ExrSides& data, const ExrSides& display) {
        write_file(file, exr_of_windows(data, display));
        return run_error_of([&] { const ExrReader in(file); });
    };
    const std::string begin = file.string() + ": not a readable OpenEXR image: its data window, ";
    EXPECT_EQ(fault({2, 1, 4, 3}, {0, 0, 8, 6}),
              begin +
                  "4 x 3 from 2, 1, differs from its display window, 8 x 6 from 0, 0; allowed: "
                  "equal");
    EXPECT_EQ(fault({-1, -1, 4, 3}, {0, 0, 2, 1}),
              begin +
                  "4 x 3 from -1, -1, differs from its display window, 2 x 1 from 0, 0; allowed: "
                  "equal");
    EXPECT_EQ(fault({1, 0, 4, 3}, {0, 0, 4, 3}),
              begin +
                  "4 x 3 from 1, 0, differs from its display window, 4 x 3 from 0, 0; allowed: "
                  "equal");
}

TEST(Exr, OfAbsurdSizeIsRefusedByItsHeader) {
    const TempFolder folder;
    const fs::path file = folder.path() / "image.exr";
    for (const auto& [name, bytes] : absurd_images(kWidth, kHeight)) {
        if (!name.ends_with(".exr")) continue;
        write_file(file, bytes);
        const std::string why = run_error_of([&] { const ExrReader in(file); });
        EXPECT_TRUE(why.starts_with(file.string() + ": ")) << name << ": " << why;
        for (const char* words : {"alloc", "memory", "vector"})
            EXPECT_FALSE(has(why, words)) << name;
    }
}

// The limit of a process stands for the disk's; both fail a write.
TEST(Exr, ThatDoesNotFitOnTheDiskIsSaidByItsOwnName) {
    const TempFolder folder;
    const fs::path file = folder.path() / "image.exr";
    write_image(file, {kHeight});
    const std::uintmax_t all_bytes = fs::file_size(file);
    fs::remove(file);
    for (const std::uintmax_t most_bytes : {std::uintmax_t{0}, all_bytes / 2, all_bytes - 1}) {
        const FileLimit limit(most_bytes);
        EXPECT_EQ(run_error_of([&] {
                      write_image(file, {16, 16, kHeight - 32});
                  }),
                  file.string() + ": cannot be written: File too large")
            << most_bytes;
    }
    EXPECT_EQ(files_in(folder), 0U);
}

TEST(Exr, WithoutTheChannelIsARunErrorThatNamesBoth) {
    const TempFolder folder;
    const fs::path file = folder.path() / "image.exr";
    write_image(file, {kHeight});
    ExrReader in(file);
    const std::vector<std::string> names{"A", "Z"};
    std::vector<float> samples = room_for(1);
    EXPECT_EQ(run_error_of([&] { in.read_rows(0, 1, names, samples); }),
              file.string() + ": has no channel Z");
}

TEST(Exr, ThatCannotBeWrittenIsARunErrorThatNamesIt) {
    const TempFolder folder;
    const fs::path file = folder.path() / "missing" / "image.exr";
    const std::string message =
        run_error_of([&] { const ExrWriter out(file, kWidth, kHeight, {"A"}, {}); });
    EXPECT_TRUE(message.starts_with(file.string() + ": cannot be written: ")) << message;
}

}  // namespace
}  // namespace aphotic::exr_test
