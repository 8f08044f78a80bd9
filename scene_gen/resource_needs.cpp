// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/resource_needs.h"

#include "image/row_blocks.h"
#include "spectral/sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace aphotic {
namespace {

constexpr std::uint64_t kFloat_bytes = sizeof(float);
constexpr std::uint64_t kHalf_bytes = 2;

constexpr std::uint64_t kHeader_bytes = 4096;       // of an image; or the size of a short log
constexpr std::uint64_t kChannelHeader_bytes = 64;  // its name and type
constexpr std::uint64_t kBlockHeader_bytes = 16;    // OpenEXR's record of its place and length
constexpr std::uint64_t kPixelsOfLogByte = 20;      // POV-Ray reports progress every 0.1 s
constexpr std::uint64_t kPovrayPixel_bytes = 20;    // five floats
constexpr std::uint64_t kPovrayState_bytes = 21;  // these, and a header for each square of 32 x 32
constexpr std::uint64_t kPovrayBuffer_bytes = 129ULL << 20U;  // larger images go to /tmp

constexpr std::uint64_t kPovray_bytes = 24'000'000;
constexpr std::uint64_t kParsed = 6;             // times the size of the text
constexpr std::uint64_t kPovrayFrame_bytes = 8;  // per pixel, while it writes the frame
constexpr std::uint64_t kIntegratedPixel_bytes = 25;
constexpr std::uint64_t kIntegrate_bytes = 192'000'000;  // two blocks of rows (image/row_blocks.h)

std::uint64_t pixels_of(const ImageSize& size) {
    return static_cast<std::uint64_t>(size.width_px) * static_cast<std::uint64_t>(size.height_px);
}

std::uint64_t channels_of(const ImageSize& size) {
    return kChannels + size.wavelengths;
}

std::uint64_t blocks_of(const ImageSize& size, std::uint64_t channels) {
    const int rows = rows_compressed_together(size.width_px, channels);
    return static_cast<std::uint64_t>(size.height_px / rows) + 1;
}

std::uint64_t exr_bytes(const ImageSize& size, std::uint64_t channels, std::uint64_t sample_bytes) {
    return kHeader_bytes + channels * (kChannelHeader_bytes + sample_bytes * pixels_of(size)) +
           kBlockHeader_bytes * blocks_of(size, channels);
}

std::uint64_t images_bytes(const FileSizes& files) {
    return files.image_bytes + files.spectral_bytes + files.preview_bytes;
}

}  // namespace

FileSizes largest_files(const ImageSize& size) {
    const std::uint64_t pixels = pixels_of(size);
    const std::uint64_t sample_bytes = size.frames == FrameFormat::Exr ? kHalf_bytes : kFloat_bytes;
    return {.frame_bytes = exr_bytes(size, kChannels, sample_bytes) + kHeader_bytes +
                           pixels / kPixelsOfLogByte,
            .image_bytes = exr_bytes(size, kChannels, kFloat_bytes),
            .spectral_bytes = exr_bytes(size, channels_of(size), kFloat_bytes),
            // PNG's own overhead: a byte per row, and below a thousandth.
            .preview_bytes = kHeader_bytes + static_cast<std::uint64_t>(size.height_px) +
                             3 * pixels + 3 * pixels / 1000};
}

ResourceNeeds render_needs(const RenderWork& work) {
    const FileSizes files = largest_files(work.size);
    const auto processes = std::min(work.frames, static_cast<std::size_t>(work.jobs));
    const std::uint64_t pixels = pixels_of(work.size);
    const std::uint64_t povray_bytes = kHeader_bytes + kPovrayState_bytes * pixels;
    const std::uint64_t picture_bytes = kPovrayPixel_bytes * pixels;
    const bool goes_to_disk = picture_bytes >= kPovrayBuffer_bytes;
    const std::uint64_t job_memory_bytes = kPovray_bytes + kParsed * work.parsed_bytes +
                                           (goes_to_disk ? 0 : picture_bytes) +
                                           kPovrayFrame_bytes * pixels;
    return {.folder_bytes = work.scenes_bytes + work.frames * files.frame_bytes +
                            std::max(processes * povray_bytes, images_bytes(files)),
            .temporary_bytes = goes_to_disk ? processes * (kHeader_bytes + picture_bytes) : 0,
            .job_memory_bytes = job_memory_bytes,
            .memory_bytes = std::max(processes * job_memory_bytes,
                                     kIntegrate_bytes + kIntegratedPixel_bytes * pixels)};
}

ResourceNeeds images_needs(const ImageSize& size) {
    return {.folder_bytes = images_bytes(largest_files(size))};
}

// One setting at a time, whose folder is removed before the next; the reference is kept.
ResourceNeeds study_needs(const ImageSize& size, std::size_t frames, int jobs) {
    ResourceNeeds needs =
        render_needs({.size = size, .frames = frames, .scenes_bytes = 0, .jobs = jobs});
    needs.folder_bytes += largest_files(size).image_bytes;
    return needs;
}

ResourceNeeds lightmap_needs(const LightmapWork& work) {
    const FileSizes files = largest_files({.width_px = work.width_px,
                                           .height_px = work.height_px,
                                           .wavelengths = kChannels * work.parts});
    return {.folder_bytes =
                work.maps * (files.spectral_bytes + (work.has_preview ? files.preview_bytes : 0))};
}

ResourceNeeds oplab_needs(int width_px, int height_px) {
    constexpr std::uint64_t kArrays = 6;  // a, b, c, gain, mean, deviation
    constexpr std::uint64_t kHeaders_bytes = 4096;
    return {.folder_bytes =
                kHeaders_bytes + kArrays * kChannels * kFloat_bytes *
                                     pixels_of({.width_px = width_px, .height_px = height_px})};
}

int jobs_with_memory(const ResourceNeeds& needs, std::uint64_t free_bytes, int jobs) {
    if (needs.job_memory_bytes == 0) return jobs;
    const std::uint64_t room = free_bytes / needs.job_memory_bytes;
    return static_cast<int>(std::clamp<std::uint64_t>(room, 1, static_cast<std::uint64_t>(jobs)));
}

std::string shortage(const ResourceNeeds& needs, const FreeDisk& free, const std::string& folder) {
    const auto lack = [](std::uint64_t needed_bytes, std::uint64_t free_bytes, const auto& where) {
        if (needed_bytes <= free_bytes) return std::string();
        return fmt::format("needs up to {} in {}, {} free",
                           bytes_in_words(needed_bytes),
                           where,
                           bytes_in_words(free_bytes));
    };
    if (free.is_one_disk && needs.temporary_bytes > 0) {
        return lack(needs.folder_bytes + needs.temporary_bytes,
                    free.folder_bytes,
                    fmt::format("{} and /tmp", folder));
    }
    const std::string of_folder = lack(needs.folder_bytes, free.folder_bytes, folder);
    return of_folder.empty() ? lack(needs.temporary_bytes, free.temporary_bytes, "/tmp")
                             : of_folder;
}

std::string bytes_in_words(std::uint64_t bytes) {
    constexpr std::array kUnits{"bytes", "kB", "MB", "GB", "TB", "PB", "EB"};
    constexpr double kStep = 1000.0;
    auto value = static_cast<double>(bytes);
    std::size_t unit = 0;
    // 999.5 would be shown as 1e+03.
    for (; value >= kStep - 0.5 && unit + 1 < kUnits.size(); ++unit) value /= kStep;
    return fmt::format("{:.3g} {}", value, kUnits[unit]);
}

}  // namespace aphotic
