// SPDX-License-Identifier: BSD-3-Clause
//
// The sizes of real files against those foretold, and the rule by which work is refused.
#include "scene_gen/resource_needs.h"

#include "image/output_images.h"
#include "image/preview.h"
#include "support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace aphotic::needs_test {
namespace {

namespace fs = std::filesystem;

constexpr ImageSize kSize{.width_px = 320, .height_px = 200, .wavelengths = 4};

// Of what was foretold, noise takes nearly all: only signs and exponents compress.
constexpr double kLeastShareOfNoise = 0.7;

// Random in all digits.
std::vector<float> noise(std::size_t samples) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> between(0.0F, 1.0F);
    std::vector<float> values(samples);
    for (float& value : values) value = between(random);
    return values;
}

// image.exr, spectral.exr and preview.png of noise.
void write_images_of_noise(const fs::path& folder) {
    std::vector<double> lambda_nm;
    for (std::size_t j = 0; j < kSize.wavelengths; ++j)
        lambda_nm.push_back(500.0 + 10.0 * static_cast<double>(j));
    OutputImages images(folder, kSize.width_px, kSize.height_px, lambda_nm, {});
    const std::size_t pixels = static_cast<std::size_t>(kSize.width_px) * kSize.height_px;
    images.write_rows(kSize.height_px, noise(pixels * (kChannels + kSize.wavelengths)));
    write_preview(images.finish(), {1.0, 1.0, 1.0}, {}, folder / "preview.png");
}

void expect_just_under(std::uintmax_t found_bytes, std::uint64_t foretold_bytes, const char* file) {
    EXPECT_LE(found_bytes, foretold_bytes) << file;
    EXPECT_GE(static_cast<double>(found_bytes),
              kLeastShareOfNoise * static_cast<double>(foretold_bytes))
        << file;
}

TEST(LargestFiles, AreThoseOfNoise) {
    const TempFolder folder;
    write_images_of_noise(folder.path());
    const FileSizes files = largest_files(kSize);
    expect_just_under(fs::file_size(folder.path() / "image.exr"), files.image_bytes, "image.exr");
    expect_just_under(
        fs::file_size(folder.path() / "spectral.exr"), files.spectral_bytes, "spectral.exr");
    expect_just_under(
        fs::file_size(folder.path() / "preview.png"), files.preview_bytes, "preview.png");
}

// Headers count in the least of images.
TEST(LargestFiles, HoldForOnePixel) {
    constexpr ImageSize kOne{.width_px = 1, .height_px = 1, .wavelengths = 48};
    const TempFolder folder;
    OutputImages images(folder.path(), 1, 1, std::vector<double>(1, 550.0), {});
    images.write_rows(1, {1.0F, 1.0F, 1.0F, 1.0F});
    (void)images.finish();
    EXPECT_LE(fs::file_size(folder.path() / "spectral.exr"), largest_files(kOne).spectral_bytes);
    EXPECT_LE(fs::file_size(folder.path() / "image.exr"), largest_files(kOne).image_bytes);
}

// --- What a render takes together
// -----------------------------------------------------------------

constexpr ImageSize kLargest{.width_px = 16384, .height_px = 16384, .wavelengths = 3};
constexpr std::uint64_t kPixelsOfLargest = 1ULL << 28U;
// Headers, logs, and the 0.1 % of PNG.
constexpr double kOverhead = 0.01;

// One frame, 6 bytes a pixel; then 12 of image.exr, 24 of spectral.exr and 3 of the preview, which
// is more than the 21 of POV-Ray's notes.
TEST(RenderNeeds, OfTheLargestImageAreByHand) {
    const ResourceNeeds needs =
        render_needs({.size = kLargest, .frames = 1, .scenes_bytes = 0, .jobs = 2});
    const double bytes = (6.0 + 12.0 + 24.0 + 3.0) * static_cast<double>(kPixelsOfLargest);
    EXPECT_NEAR(static_cast<double>(needs.folder_bytes), bytes, kOverhead * bytes);
    EXPECT_NEAR(
        static_cast<double>(needs.temporary_bytes), 20.0 * kPixelsOfLargest, kOverhead * bytes);
}

TEST(RenderNeeds, GrowWithTheProcessesThatRun) {
    RenderWork work{.size = kLargest, .frames = 12, .scenes_bytes = 0, .jobs = 1};
    const ResourceNeeds one = render_needs(work);
    work.jobs = 6;
    const ResourceNeeds six = render_needs(work);
    EXPECT_EQ(six.temporary_bytes, 6 * one.temporary_bytes);
    EXPECT_GT(six.folder_bytes, one.folder_bytes);
    work.frames = 1;  // there is no work for the others
    EXPECT_EQ(render_needs(work).temporary_bytes, one.temporary_bytes);
}

// 20 bytes a pixel of the image, unless these go to /tmp, and 8 of the frame.
TEST(RenderNeeds, OfMemoryGrowWithTheJobs) {
    constexpr ImageSize kSmall{.width_px = 1000, .height_px = 1000, .wavelengths = 3};
    RenderWork work{.size = kSmall, .frames = 8, .parsed_bytes = 1'000'000, .jobs = 4};
    const ResourceNeeds needs = render_needs(work);
    const double expected = 24e6 + 6e6 + (20.0 + 8.0) * 1e6;
    EXPECT_NEAR(static_cast<double>(needs.job_memory_bytes), expected, kOverhead * expected);
    EXPECT_EQ(needs.memory_bytes, 4 * needs.job_memory_bytes);
    EXPECT_EQ(jobs_with_memory(needs, 3 * needs.job_memory_bytes + 1, 4), 3);
    EXPECT_EQ(jobs_with_memory(needs, 1000 * needs.job_memory_bytes, 4), 4);
    EXPECT_EQ(jobs_with_memory(needs, 1, 4), 1);
    work.size = kLargest;
    const double at_disk = 24e6 + 6e6 + 8.0 * kPixelsOfLargest;
    EXPECT_NEAR(static_cast<double>(render_needs(work).job_memory_bytes), at_disk, 1.0);
}

TEST(RenderNeeds, OfKeptFramesAreTheImagesAlone) {
    const FileSizes files = largest_files(kSize);
    const ResourceNeeds needs =
        render_needs({.size = kSize, .frames = 0, .scenes_bytes = 99, .jobs = 4});
    EXPECT_EQ(needs.folder_bytes,
              99 + files.image_bytes + files.spectral_bytes + files.preview_bytes);
    EXPECT_EQ(needs.temporary_bytes, 0U);
}

TEST(ImagesNeeds, AreThoseOfKeptFrames) {
    const ResourceNeeds kept =
        render_needs({.size = kSize, .frames = 0, .scenes_bytes = 0, .jobs = 4});
    const ResourceNeeds needs = images_needs(kSize);
    EXPECT_EQ(needs.folder_bytes, kept.folder_bytes);
    EXPECT_EQ(needs.temporary_bytes, 0U);
}

// Three floats a pixel and part, and as many of the sum.
TEST(LightmapNeeds, OfTheLargestImageAreByHand) {
    LightmapWork work{.width_px = 16384, .height_px = 16384, .parts = 0};
    const auto near_px = [](std::uint64_t bytes, double bytes_of_pixel) {
        EXPECT_NEAR(static_cast<double>(bytes),
                    bytes_of_pixel * kPixelsOfLargest,
                    kOverhead * bytes_of_pixel * kPixelsOfLargest);
    };
    near_px(lightmap_needs(work).folder_bytes, 12.0);
    work.parts = 4;
    near_px(lightmap_needs(work).folder_bytes, 5.0 * 12.0);
    work.has_preview = true;
    near_px(lightmap_needs(work).folder_bytes, 5.0 * 12.0 + 3.0);
    EXPECT_EQ(lightmap_needs(work).temporary_bytes, 0U);
}

// --- The rule
// -------------------------------------------------------------------------------------

constexpr std::uint64_t kGB = 1'000'000'000;
const ResourceNeeds kNeeds{.folder_bytes = 12 * kGB + 300'000'000, .temporary_bytes = 5 * kGB};

FreeDisk free_of(double folder_gb, double temporary_gb, bool is_one_disk) {
    const auto bytes = [](double amount_gb) { return static_cast<std::uint64_t>(1e9 * amount_gb); };
    return {.folder_bytes = bytes(folder_gb),
            .temporary_bytes = bytes(temporary_gb),
            .is_one_disk = is_one_disk};
}

TEST(Shortage, IsNoneWhereThereIsJustEnough) {
    EXPECT_EQ(shortage(kNeeds, free_of(12.3, 5.0, false), "out"), "");
    EXPECT_EQ(shortage(kNeeds, free_of(17.3, 0.0, true), "out"), "");
}

TEST(Shortage, OfTheFolderSaysWhatIsNeededAndFree) {
    EXPECT_EQ(shortage(kNeeds, free_of(4.1, 9.0, false), "out"),
              "needs up to 12.3 GB in out, 4.1 GB free");
}

TEST(Shortage, OfOneDiskIsOfBothTogether) {
    EXPECT_EQ(shortage(kNeeds, free_of(13.0, 13.0, true), "out"),
              "needs up to 17.3 GB in out and /tmp, 13 GB free");
}

TEST(Shortage, OfTheTemporaryFolderNamesIt) {
    EXPECT_EQ(shortage(kNeeds, free_of(99.0, 4.9, false), "out"),
              "needs up to 5 GB in /tmp, 4.9 GB free");
}

TEST(BytesInWords, HaveThreeDigits) {
    EXPECT_EQ(bytes_in_words(0), "0 bytes");
    EXPECT_EQ(bytes_in_words(999), "999 bytes");
    EXPECT_EQ(bytes_in_words(1000), "1 kB");
    EXPECT_EQ(bytes_in_words(999'600), "1 MB");
    EXPECT_EQ(bytes_in_words(12'345'678'901), "12.3 GB");
    EXPECT_EQ(bytes_in_words(18'000'000'000'000'000'000U), "18 EB");
}

}  // namespace
}  // namespace aphotic::needs_test
