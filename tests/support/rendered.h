// SPDX-License-Identifier: BSD-3-Clause
//
// Real renders for tests: a rig through POV-Ray into a folder, and what its frames hold against
// the closed form, per pixel and per wavelength.
#pragma once

#include "base/atomic_file.h"
#include "image/exr.h"
#include "plugin/render.h"
#include "scene_gen/exposure.h"
#include "scene_gen/include_library.h"
#include "scene_gen/scene_set.h"
#include "spectral/curve_loader.h"
#include "support/closed_form.h"
#include "support/scene_rig.h"
#include "support/scene_text.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace aphotic {

// A half float rounds to 2^-11 = 4.9e-4 of the value; the fade law and POV-Ray's own single
// precision colours add under 1e-5 to it.
inline constexpr double kHalfFloatError = 6e-4;
// Smallest normal half float: below, the relative step grows.
inline constexpr double kSmallestNormalHalf = 6.103515625e-5;
// A pixel's centre so close to a cone's edge may fall on either side of it by rounding. It is
// some 1e-9 of a pixel wide in these images.
inline constexpr double kNearEdgeRad = 1e-9;

// scenes/habcam.toml, with fewer and larger pixels over the same field of view.
inline Rig small_habcam(int width_px = 68, int height_px = 51) {
    return habcam(width_px, height_px);
}

inline SceneSet scenes_of(const Rig& rig,
                          const std::vector<double>& lambda_nm,
                          const SceneOptions& options = {.pixel_shift = 0.0, .emitter_lamps = {}}) {
    PlanRequest request;
    request.wavelengths_nm = lambda_nm;
    request.scene = options;
    return make_scene_set(rig, plan_render(rig, request));
}

// The scene as POV-Ray reads it, with aphotic.inc in its place, for tests that change it.
inline std::string with_library(const std::string& sdl) {
    return replaced(sdl, "#include \"aphotic.inc\"\n", std::string(include_library().front().text));
}

struct Difference {
    double worst_of_lit = 0.0;  // relative, over those that are to be lit, however dark
    double worst = 0.0;         // relative, over all wavelengths and pixels off the edges
    double worst_nm = 0.0;      // its wavelength
    int column = 0, row = 0;    // its pixel
    int on_edges = 0;           // pixels left out
    int compared = 0;
    double brightest_sample = 0.0;  // of all frames
    double darkest_sample = 0.0;    // of those that are to be lit
};

// Renders the set, and compares.
inline Difference against_closed_form(const Rig& rig,
                                      const SceneSet& set,
                                      int across = 1,
                                      int along = 1) {
    const TempFolder folder;
    const RenderResult result =
        render(find_povray(""), folder.path(), set, {.jobs = 2, .report = {}});
    Difference difference;
    difference.darkest_sample = std::numeric_limits<double>::infinity();
    const auto pixels = static_cast<std::size_t>(rig.camera.width_px) *
                        static_cast<std::size_t>(rig.camera.height_px);
    for (const PlannedWavelength& w : result.manifest.wavelengths) {
        ExrReader frame(image_path(folder.path(), result.manifest.frames[w.frame]));
        std::vector<float> samples(pixels);
        const std::string channel(kChannelNames[w.channel]);
        frame.read_rows(0, rig.camera.height_px, std::span(&channel, 1), samples);
        for (std::size_t i = 0; i < pixels; ++i) {
            const int column = static_cast<int>(i) % rig.camera.width_px;
            const int row = static_cast<int>(i) / rig.camera.width_px;
            const closed_form::Answer answer =
                closed_form::radiance(rig, column, row, w.lambda_nm, across, along);
            if (answer.edge_rad < kNearEdgeRad) {
                ++difference.on_edges;
                continue;
            }
            ++difference.compared;
            const double sample = samples[i];
            const double expected = std::ldexp(answer.radiance, w.exposure_log2);
            difference.brightest_sample = std::max(difference.brightest_sample, sample);
            if (expected > 0.0) {
                difference.darkest_sample = std::min(difference.darkest_sample, sample);
                difference.worst_of_lit =
                    std::max(difference.worst_of_lit, std::abs(sample - expected) / expected);
            }
            // Where nothing shines both must be black; the floor below which half floats grow
            // coarse only keeps this from dividing by zero there.
            const double error =
                std::abs(sample - expected) / std::max(expected, kSmallestNormalHalf);
            if (error > difference.worst) {
                difference.worst = error;
                difference.worst_nm = w.lambda_nm;
                difference.column = column;
                difference.row = row;
            }
        }
    }
    return difference;
}

inline void PrintTo(const Difference& d, std::ostream* out) {
    *out << "worst relative error " << d.worst << " at " << d.worst_nm << " nm, column " << d.column
         << ", row " << d.row << "; " << d.compared << " samples compared, " << d.on_edges
         << " on cone edges";
}

}  // namespace aphotic
