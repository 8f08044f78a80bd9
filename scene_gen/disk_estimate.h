// SPDX-License-Identifier: BSD-3-Clause
//
// How much disk a render, a trace, a study or lightmaps take at most, before any of it
// is begun; and whether there is so much.
//
// As if nothing could be compressed, P pixels, n wavelengths,
//
//   frame         6 P             three half floats a pixel; and its log. 12 P from a PNG: floats
//   image.exr     12 P            three floats a pixel
//   spectral.exr  (12 + 4 n) P    one float a wavelength more
//   preview.png   3 P             three bytes a pixel
//
// Smooth images take a twentieth of it, noise nearly all. Files are written beside those of the
// same name that they replace, so these give no room. While POV-Ray renders, each of its processes
// keeps beside the frame what it would need to go on, 21 P, and where its image exceeds 128 MiB
// that image too in /tmp, 20 P.
#pragma once

#include "image/frame_format.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace aphotic {

// Of one image.
struct ImageSize {
    int width_px = 0;
    int height_px = 0;
    std::size_t wavelengths = 0;
    FrameFormat frames = FrameFormat::Exr;
};

struct FileSizes {
    std::uint64_t frame_bytes = 0;  // of each
    std::uint64_t image_bytes = 0;
    std::uint64_t spectral_bytes = 0;
    std::uint64_t preview_bytes = 0;
};
[[nodiscard]] FileSizes largest_files(const ImageSize& size);

struct DiskNeeds {
    std::uint64_t folder_bytes = 0;     // at the fullest moment, beside what is there already
    std::uint64_t temporary_bytes = 0;  // in /tmp
};

// What a render writes and runs.
struct RenderWork {
    ImageSize size;
    std::size_t frames = 0;  // that are to be rendered; those that are kept take no more room
    std::uint64_t scenes_bytes = 0;
    int jobs = 1;
};
[[nodiscard]] DiskNeeds render_needs(const RenderWork& work);
// Of frames that are there, integrated; and of a trace.
[[nodiscard]] DiskNeeds images_needs(const ImageSize& size);
// frames: of the setting that has most.
[[nodiscard]] DiskNeeds study_needs(const ImageSize& size, std::size_t frames, int jobs);

// Lightmaps in a file each (lightmap/lightmap_file.h), with those of parts of their light.
struct LightmapWork {
    std::size_t maps = 1;
    int width_px = 0;
    int height_px = 0;
    std::size_t parts = 0;
    bool has_preview = false;
};
[[nodiscard]] DiskNeeds lightmap_needs(const LightmapWork& work);

// Of lightmap/oplab_export.h, whatever its altitudes.
[[nodiscard]] DiskNeeds oplab_needs(int width_px, int height_px);

// Where the work is to be done.
struct FreeDisk {
    std::uint64_t folder_bytes = 0;
    std::uint64_t temporary_bytes = 0;
    bool is_one_disk = false;  // folder and /tmp share it
};

// What is lacking, in words: "needs up to 12.3 GB in out, 4.1 GB are free". Empty when nothing is.
[[nodiscard]] std::string shortage(const DiskNeeds& needs,
                                   const FreeDisk& free,
                                   const std::string& folder);

// 4.1 GB, 512 MB, 17 kB.
[[nodiscard]] std::string bytes_in_words(std::uint64_t bytes);

}  // namespace aphotic
