// SPDX-License-Identifier: BSD-3-Clause
//
// What a render, a trace, a validation or a study will take of disk and of memory, at most, before
// any of it is begun; and whether there is so much.
//
// Files: as if nothing could be compressed, P pixels, n wavelengths,
//
//   frame         6 P             three half floats a pixel; and its log
//   image.exr     12 P            three floats a pixel
//   spectral.exr  (12 + 4 n) P    one float a wavelength more
//   preview.png   3 P             three bytes a pixel
//
// Smooth images take a twentieth of it, noise nearly all. Files are written beside those of the
// same name that they replace, so these give no room. While POV-Ray renders, each of its processes
// keeps beside the frame what it would need to go on, 21 P, and where its image exceeds 128 MiB
// that image too in /tmp, 20 P.
//
// Memory, as measured (docs/planning.md):
//
//   POV-Ray       28 P a process, of which 8 P where the image is in /tmp, and kProgram_bytes
//   integration   12 P of signals, and the blocks of rows under way: two of ours, and two a thread
//                 of OpenEXR's (image/row_blocks.h); then the preview, at which 25 P are held
//                 together
//   lightmap      the same as of an integration to three channels more for each part of the light,
//                 and 12 P for each map that is held beside
//   trace         that of an integration, with 16 MiB of rows, or a row for each thread
//   validation    whole planes: 70 P, and 12 P for each wavelength of up to six at a time
//   study         64 P, and 128 MiB of OpenImageIO: the reference, a setting's image, and what
//                 compares them
//   atlas         16 P of a map and its mosaic, and OpenEXR's rows; of a fit over altitude, 32 rows
//                 of all altitudes
//
// What a user's own scene adds to POV-Ray's memory is not known, and not in it.
#pragma once

#include "spectral/integrator.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace aphotic {

// A program with its libraries, a scene of ours, and its threads' stacks.
inline constexpr std::uint64_t kProgram_bytes = 24ULL << 20U;

// Of one image.
struct ImageSize {
    int width_px = 0;
    int height_px = 0;
    std::size_t wavelengths = 0;
};

struct FileSizes {
    std::uint64_t frame_bytes = 0;  // of each
    std::uint64_t image_bytes = 0;
    std::uint64_t spectral_bytes = 0;
    std::uint64_t preview_bytes = 0;
};
[[nodiscard]] FileSizes largest_files(const ImageSize& size);

// Of POV-Ray, by process.
struct ProcessNeeds {
    std::uint64_t memory_bytes = 0;
    std::uint64_t folder_bytes = 0;     // beside the frame, until it is done
    std::uint64_t temporary_bytes = 0;  // in /tmp
};
[[nodiscard]] ProcessNeeds povray_needs(const ImageSize& size);

// threads: that compress.
[[nodiscard]] std::uint64_t integration_memory_bytes(const ImageSize& size, int threads);
[[nodiscard]] std::uint64_t trace_memory_bytes(const ImageSize& size, int threads);
[[nodiscard]] std::uint64_t validation_memory_bytes(const ImageSize& size, int threads);
[[nodiscard]] std::uint64_t study_memory_bytes(const ImageSize& size, int threads);

struct Needs {
    std::uint64_t folder_bytes = 0;     // at the fullest moment, beside what is there already
    std::uint64_t temporary_bytes = 0;  // in /tmp
    std::uint64_t memory_bytes = 0;     // all processes together
};

// The larger of each: one after another.
[[nodiscard]] Needs larger_of(const Needs& a, const Needs& b);

// What a render writes and runs.
struct RenderWork {
    ImageSize size;
    std::size_t frames = 0;  // that are to be rendered; those that are kept take no more room
    std::uint64_t scenes_bytes = 0;
    int jobs = 1;
};
[[nodiscard]] Needs render_needs(const RenderWork& work);
// Of frames that are there.
[[nodiscard]] Needs integration_needs(const ImageSize& size, int threads);
[[nodiscard]] Needs trace_needs(const ImageSize& size, int threads);
// Beside those of its render.
[[nodiscard]] Needs validation_needs(const ImageSize& size, int threads);
// frames: of the setting that has most.
[[nodiscard]] Needs study_needs(const ImageSize& size, std::size_t frames, int jobs);

// A lightmap in one file (lightmap/lightmap.h), with those of parts of its light.
struct LightmapWork {
    int width_px = 0;
    int height_px = 0;
    std::size_t parts = 0;
    bool has_preview = false;
    int threads = 1;
};
[[nodiscard]] Needs lightmap_needs(const LightmapWork& work);

// An atlas of lightmaps (lightmap/atlas.h), and what is exported beside it.
struct AtlasWork {
    ImageSize size;
    std::size_t bins = 0;  // that are to be written; those that are kept take no more room
    std::size_t altitudes = 0;
    bool has_mosaics = false;  // one an altitude
    bool has_fits = false;     // over all of them
    int threads = 1;
};
[[nodiscard]] Needs atlas_needs(const AtlasWork& work);

// Where the work is to be done.
struct FreeRoom {
    std::uint64_t folder_bytes = 0;
    std::uint64_t temporary_bytes = 0;
    bool is_one_disk = false;  // folder and /tmp share it
    std::uint64_t memory_bytes = 0;
};

// What is lacking, in words: "needs up to 12.3 GB in out, 4.1 GB are free". Empty when nothing is.
[[nodiscard]] std::string shortage(const Needs& needs,
                                   const FreeRoom& room,
                                   const std::string& folder);

// 4.1 GB, 512 MB, 17 kB.
[[nodiscard]] std::string bytes_in_words(std::uint64_t bytes);

}  // namespace aphotic
