// SPDX-License-Identifier: BSD-3-Clause
//
// Upper bounds of the disk space for a render, a trace, a study or lightmaps, and of a render's
// memory, before it starts; and the check whether they suffice.
//
// Without compression, with P pixels and n wavelengths,
//
//   frame         6 P             three half floats a pixel; and its log. 12 P from a PNG: floats
//   image.exr     12 P            three floats a pixel
//   spectral.exr  (12 + 4 n) P    one float a wavelength more
//   preview.png   3 P             three bytes a pixel
//
// Smooth images need a twentieth of it, noise nearly all. Files are written next to those that they
// replace, so these free no space. While POV-Ray renders, each of its processes keeps, besides the
// frame, its state for resuming, 21 P, and if its image exceeds 128 MiB, that image in /tmp, 20 P.
//
// A POV-Ray process takes 24 MB of memory, 6 times the text of its scene, its image unless that
// goes to /tmp, and 8 P for the frame that it writes: slightly more than measured with POV-Ray
// 3.7.0.10 (18 MB, 3.5 times, 27 P; 217 MB at 24 megapixels). A user's includes are not counted.
// Integrating takes 25 P and 192 MB.
#pragma once

#include "image/frame_format.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace aphotic {

// The size of one image.
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

struct ResourceNeeds {
    std::uint64_t folder_bytes = 0;      // at the peak, in addition to existing files
    std::uint64_t temporary_bytes = 0;   // in /tmp
    std::uint64_t job_memory_bytes = 0;  // of each POV-Ray process
    std::uint64_t memory_bytes = 0;      // of all processes, or of integrating
};

// The work of a render.
struct RenderWork {
    ImageSize size;
    std::size_t frames = 0;          // to be rendered; kept ones need no more space
    std::uint64_t scenes_bytes = 0;  // on disk, all of them
    std::uint64_t parsed_bytes = 0;  // by one POV-Ray: the longest scene and our includes
    int jobs = 1;
};
[[nodiscard]] ResourceNeeds render_needs(const RenderWork& work);
// For integrating existing frames, and for a trace.
[[nodiscard]] ResourceNeeds images_needs(const ImageSize& size);
// frames: of the setting with most frames.
[[nodiscard]] ResourceNeeds study_needs(const ImageSize& size, std::size_t frames, int jobs);

// Lightmaps in one file each (lightmap/lightmap_file.h), and maps of parts of their light.
struct LightmapWork {
    std::size_t maps = 1;
    int width_px = 0;
    int height_px = 0;
    std::size_t parts = 0;
    bool has_preview = false;
};
[[nodiscard]] ResourceNeeds lightmap_needs(const LightmapWork& work);

// Of lightmap/oplab_export.h, whatever its altitudes.
[[nodiscard]] ResourceNeeds oplab_needs(int width_px, int height_px);

// The free disk space.
struct FreeDisk {
    std::uint64_t folder_bytes = 0;
    std::uint64_t temporary_bytes = 0;
    bool is_one_disk = false;  // folder and /tmp share it
};

// The number of jobs that fit at a time, at least 1.
[[nodiscard]] int jobs_with_memory(const ResourceNeeds& needs, std::uint64_t free_bytes, int jobs);

// The shortage, as text: "needs up to 12.3 GB in out, 4.1 GB free". Empty if there is none.
[[nodiscard]] std::string shortage(const ResourceNeeds& needs,
                                   const FreeDisk& free,
                                   const std::string& folder);

// 4.1 GB, 512 MB, 17 kB.
[[nodiscard]] std::string bytes_in_words(std::uint64_t bytes);

}  // namespace aphotic
