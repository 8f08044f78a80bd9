// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/resource_estimate.h"

#include "image/row_blocks.h"
#include "spectral/sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

constexpr std::uint64_t kFloat_bytes = sizeof(float);
constexpr std::uint64_t kDouble_bytes = sizeof(double);
constexpr std::uint64_t kHalf_bytes = 2;

constexpr std::uint64_t kHeader_bytes = 4096;       // of an image; and what a short log holds
constexpr std::uint64_t kChannelHeader_bytes = 64;  // its name and type
constexpr std::uint64_t kBlockHeader_bytes = 16;    // OpenEXR notes where it is and how long
constexpr std::uint64_t kPixelsOfLogByte = 20;      // POV-Ray says every 0.1 s how far it is
constexpr std::uint64_t kPovrayPixel_bytes = 20;    // five floats
constexpr std::uint64_t kPovrayState_bytes = 21;  // these, and a header for each square of 32 x 32
constexpr std::uint64_t kPovrayOutput_bytes = 8;  // four half floats, on the way to the file
constexpr std::uint64_t kPovrayBuffer_bytes = 129ULL << 20U;  // from there on an image goes to /tmp
constexpr std::uint64_t kPreview_bytes = 25;  // signals, pixels, Cairo's own, the PNG as it grows
constexpr std::uint64_t kValidation_bytes = 70;
constexpr std::uint64_t kValidationPlane_bytes = kDouble_bytes + kFloat_bytes;
constexpr std::uint64_t kValidationPlanes = 6;                // held at a time (validation.cpp)
constexpr std::uint64_t kImageLibrary_bytes = 128ULL << 20U;  // OpenImageIO and what it brings
constexpr std::uint64_t kStudy_bytes = 64;
constexpr std::uint64_t kStudyReference_bytes = 13;  // its signals, and what lies on edges
constexpr std::uint64_t kAtlas_bytes = 16;           // a map of floats, and its mosaic
constexpr std::uint64_t kBinNote_bytes = 1024;       // in atlas.json, and while it is written
constexpr std::uint64_t kFittedRows = 32;            // at a time (lightmap/atlas_export.cpp)
constexpr std::uint64_t kFittedChannels = 12;        // a, b, c and residual of three

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

// OpenEXR's own rows: two blocks a thread, each as it is and packed, and a bit.
std::uint64_t file_memory_bytes(const ImageSize& size, std::uint64_t channels, int threads) {
    const std::uint64_t blocks =
        std::min(2 * static_cast<std::uint64_t>(threads), blocks_of(size, channels));
    const auto block_px =
        static_cast<std::uint64_t>(rows_compressed_together(size.width_px, channels)) *
        static_cast<std::uint64_t>(size.width_px);
    return 5 * blocks * block_px * kFloat_bytes * channels / 2;
}

// Of image.exr and spectral.exr.
std::uint64_t compression_bytes(const ImageSize& size, int threads) {
    return file_memory_bytes(size, kChannels, threads) +
           file_memory_bytes(size, channels_of(size), threads);
}

// Rows in work, sample_bytes for each channel of a pixel, beside the whole signals; then the
// preview.
std::uint64_t streamed_bytes(const ImageSize& size,
                             int rows,
                             std::uint64_t pixel_bytes,
                             int threads) {
    const auto block_px = static_cast<std::uint64_t>(std::min(rows, size.height_px)) *
                          static_cast<std::uint64_t>(size.width_px);
    const std::uint64_t in_work = kChannels * kFloat_bytes * pixels_of(size) +
                                  block_px * pixel_bytes + compression_bytes(size, threads);
    return kProgram_bytes + std::max(in_work, kPreview_bytes * pixels_of(size));
}

std::uint64_t images_bytes(const ImageSize& size) {
    const FileSizes files = largest_files(size);
    return files.image_bytes + files.spectral_bytes + files.preview_bytes;
}

}  // namespace

FileSizes largest_files(const ImageSize& size) {
    const std::uint64_t pixels = pixels_of(size);
    return {.frame_bytes =
                exr_bytes(size, kChannels, kHalf_bytes) + kHeader_bytes + pixels / kPixelsOfLogByte,
            .image_bytes = exr_bytes(size, kChannels, kFloat_bytes),
            .spectral_bytes = exr_bytes(size, channels_of(size), kFloat_bytes),
            // PNG's own overhead: a byte a row, and under a thousandth.
            .preview_bytes = kHeader_bytes + static_cast<std::uint64_t>(size.height_px) +
                             3 * pixels + 3 * pixels / 1000};
}

ProcessNeeds povray_needs(const ImageSize& size) {
    const std::uint64_t pixels = pixels_of(size);
    const std::uint64_t image_bytes = kPovrayPixel_bytes * pixels;
    const bool goes_to_disk = image_bytes >= kPovrayBuffer_bytes;
    return {.memory_bytes =
                kProgram_bytes + kPovrayOutput_bytes * pixels + (goes_to_disk ? 0 : image_bytes),
            .folder_bytes = kHeader_bytes + kPovrayState_bytes * pixels,
            .temporary_bytes = goes_to_disk ? kHeader_bytes + image_bytes : 0};
}

// A block is being written while the next is read and summed, a channel at a time.
std::uint64_t integration_memory_bytes(const ImageSize& size, int threads) {
    const std::uint64_t pixel_bytes =
        2 * kFloat_bytes * channels_of(size) + kChannels * kFloat_bytes + kDouble_bytes;
    return streamed_bytes(
        size, rows_per_block(size.width_px, size.wavelengths), pixel_bytes, threads);
}

std::uint64_t trace_memory_bytes(const ImageSize& size, int threads) {
    const std::uint64_t pixel_bytes = (kDouble_bytes + 2 * kFloat_bytes) * channels_of(size);
    return streamed_bytes(
        size, traced_rows(size.width_px, channels_of(size), threads), pixel_bytes, threads);
}

std::uint64_t validation_memory_bytes(const ImageSize& size, int threads) {
    const std::uint64_t planes = std::min<std::uint64_t>(size.wavelengths, kValidationPlanes);
    return std::max(
        integration_memory_bytes(size, threads),
        kProgram_bytes + (kValidation_bytes + kValidationPlane_bytes * planes) * pixels_of(size));
}

std::uint64_t study_memory_bytes(const ImageSize& size, int threads) {
    return std::max(integration_memory_bytes(size, threads),
                    kProgram_bytes + kImageLibrary_bytes + kStudy_bytes * pixels_of(size));
}

Needs larger_of(const Needs& a, const Needs& b) {
    return {.folder_bytes = std::max(a.folder_bytes, b.folder_bytes),
            .temporary_bytes = std::max(a.temporary_bytes, b.temporary_bytes),
            .memory_bytes = std::max(a.memory_bytes, b.memory_bytes)};
}

Needs render_needs(const RenderWork& work) {
    const ProcessNeeds process = povray_needs(work.size);
    const auto processes = std::min(work.frames, static_cast<std::size_t>(work.jobs));
    const std::uint64_t frames_bytes = work.frames * largest_files(work.size).frame_bytes;
    const std::uint64_t while_rendering = kProgram_bytes + processes * process.memory_bytes;
    return {.folder_bytes = work.scenes_bytes + frames_bytes +
                            std::max(processes * process.folder_bytes, images_bytes(work.size)),
            .temporary_bytes = processes * process.temporary_bytes,
            .memory_bytes = std::max(processes > 0 ? while_rendering : 0,
                                     integration_memory_bytes(work.size, work.jobs))};
}

Needs integration_needs(const ImageSize& size, int threads) {
    return {.folder_bytes = images_bytes(size),
            .temporary_bytes = 0,
            .memory_bytes = integration_memory_bytes(size, threads)};
}

Needs trace_needs(const ImageSize& size, int threads) {
    return {.folder_bytes = images_bytes(size),
            .temporary_bytes = 0,
            .memory_bytes = trace_memory_bytes(size, threads)};
}

Needs validation_needs(const ImageSize& size, int threads) {
    return {.folder_bytes = 0,
            .temporary_bytes = 0,
            .memory_bytes = validation_memory_bytes(size, threads)};
}

// One setting at a time, whose folder is taken away before the next; the reference stays.
Needs study_needs(const ImageSize& size, std::size_t frames, int jobs) {
    Needs needs = render_needs({.size = size, .frames = frames, .scenes_bytes = 0, .jobs = jobs});
    needs.folder_bytes += largest_files(size).image_bytes;
    needs.memory_bytes =
        std::max(needs.memory_bytes + kImageLibrary_bytes + kStudyReference_bytes * pixels_of(size),
                 study_memory_bytes(size, jobs));
    return needs;
}

// Held beside the planes of the file: a part's map before it is one of them, and the preview's own.
Needs lightmap_needs(const LightmapWork& work) {
    const ImageSize size{.width_px = work.width_px,
                         .height_px = work.height_px,
                         .wavelengths = kChannels * work.parts};
    const FileSizes files = largest_files(size);
    ImageSize held = size;
    held.wavelengths = std::max<std::size_t>(1, size.wavelengths);  // none is no integration
    const std::uint64_t maps =
        1 + work.parts + (work.parts > 0 ? 1 : 0) + (work.has_preview ? 1 : 0);
    return {.folder_bytes = files.spectral_bytes + (work.has_preview ? files.preview_bytes : 0),
            .temporary_bytes = 0,
            .memory_bytes = integration_memory_bytes(held, work.threads) +
                            maps * kChannels * kFloat_bytes * pixels_of(size)};
}

Needs atlas_needs(const AtlasWork& work) {
    const ImageSize image{.width_px = work.size.width_px, .height_px = work.size.height_px};
    Needs needs{.folder_bytes = work.bins * (kBinNote_bytes + largest_files(image).image_bytes),
                .temporary_bytes = 0,
                .memory_bytes = kProgram_bytes + kBinNote_bytes * work.bins +
                                kAtlas_bytes * pixels_of(image) +
                                compression_bytes(image, work.threads)};
    if (work.has_mosaics) {
        needs.folder_bytes += work.altitudes * exr_bytes(image, 1, kFloat_bytes);
    }
    if (work.has_fits) {
        const std::uint64_t block_px = kFittedRows * static_cast<std::uint64_t>(work.size.width_px);
        needs.folder_bytes += exr_bytes(image, kFittedChannels, kFloat_bytes);
        needs.memory_bytes +=
            block_px * kFloat_bytes * (kChannels * work.altitudes + 2 * kFittedChannels);
    }
    return needs;
}

std::string shortage(const Needs& needs, const FreeRoom& room, const std::string& folder) {
    struct Demand {
        std::uint64_t needed;
        std::uint64_t free;
        std::string where;
    };
    std::vector<Demand> demands{
        {needs.folder_bytes + (room.is_one_disk ? needs.temporary_bytes : 0),
         room.folder_bytes,
         room.is_one_disk && needs.temporary_bytes > 0 ? fmt::format("in {} and /tmp", folder)
                                                       : fmt::format("in {}", folder)},
        {needs.memory_bytes, room.memory_bytes, "of memory"}};
    if (!room.is_one_disk)
        demands.push_back({needs.temporary_bytes, room.temporary_bytes, "in /tmp"});
    for (const Demand& demand : demands) {
        if (demand.needed <= demand.free) continue;
        return fmt::format("needs up to {} {}, {} are free",
                           bytes_in_words(demand.needed),
                           demand.where,
                           bytes_in_words(demand.free));
    }
    return "";
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
