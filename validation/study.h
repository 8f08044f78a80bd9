// SPDX-License-Identifier: BSD-3-Clause
//
// Accuracy against time, measured: renders with several choices of wavelengths, the wall time of
// each on this machine, and the difference from the reference.
//
//   error  = (a - b) / max(|b|, black)       a a pixel's signal, b the reference's over the full
//                                            spectrum, channel by channel (comparison.h)
//   time   = POV-Ray's + integration's
//
// The Pareto front consists of the settings that no other beats in both time and largest error.
//
// A measure is that of its worst channel, off the edges unless said otherwise. One with a sample
// that is not finite, or with none off the edges, has an infinite error, and is not on the front.
//
// Measures are kept in the folder, so that an interrupted study can continue:
//
//   reference/image.exr     the reference, with the time of its trace
//   study.json              the measures; settings/NAME/ exists during a measurement
//
// Nothing here runs POV-Ray: the caller supplies the function that renders a setting.
#pragma once

#include "image/output_images.h"
#include "rig/rig.h"
#include "spectral/manifest.h"

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct StudySetting {
    std::string name{};   // unique, of letters, digits, - and ., such as "fitted-3"; also a folder
    std::string words{};  // for people: "3 fitted wavelengths"
    bool equal_bands = false;
};

struct StudyMeasure {
    StudySetting setting{};
    std::size_t wavelengths = 0;
    std::size_t frames = 0;
    double promise = 0.0;  // of the plan's worst channel
    double render_s = 0.0;
    double integrate_s = 0.0;
    double max_error = 0.0;
    double percentile_999 = 0.0;
    double rms_error = 0.0;
    double max_error_on_edges = 0.0;

    [[nodiscard]] double total_s() const { return render_s + integrate_s; }
};

struct Study {
    std::string rig_title{};
    std::string rig_sha256{};
    int width_px = 0;
    int height_px = 0;
    std::string aphotic_version{};
    std::string povray_version{};
    int cores = 1;
    std::size_t grid_size = 0;  // wavelengths of the reference
    double trace_s = 0.0;
    std::vector<StudyMeasure> measures{};  // in the order of their settings
};

// The rig with an image small enough that a few settings take under two minutes; unchanged if its
// image is. Both sizes are divided by the same whole number, by which the pixels grow. Remainders
// are dropped: the field of view is then smaller by under a pixel.
[[nodiscard]] Rig quick_rig(Rig rig);

// The errors of a measure, from the image and the reference of the same size, planes R, G, B of
// each; black is kBlackShare (validation.h) of the channel's brightest. on_edge: 1 for pixels on
// edges; may be empty.
void measure_errors(const CameraImage& image,
                    const CameraImage& reference,
                    std::span<const unsigned char> on_edge,
                    StudyMeasure& measure);

// Whether each measure is on the front.
[[nodiscard]] std::vector<bool> pareto_front(std::span<const StudyMeasure> measures);

struct StudyFrames {
    Manifest manifest{};  // of the frames in the folder
    double promise = 0.0;
    double render_s = 0.0;
};

struct StudyHands {
    // Renders the frames of the setting with that index into the folder; not called for settings
    // measured before.
    std::function<StudyFrames(std::size_t setting, const std::filesystem::path& folder)> render;
    std::function<void(std::string_view what, double share)> progress = [](auto, auto) {};
};

// Fills in the reference and the measures of a study whose rig, versions and cores are set. The
// folder must exist, and must not be in use.
void run_study(Study& study,
               const Rig& rig,
               const std::vector<StudySetting>& settings,
               const std::filesystem::path& folder,
               const StudyHands& hands);

// study.json: the whole study. A number that is not finite is null.
[[nodiscard]] std::string study_json(const Study& study);

// The measures of the same study in such a text; empty if it is another study's, or was not written
// by us.
[[nodiscard]] std::vector<StudyMeasure> measures_in(std::string_view json, const Study& study);

// study.csv, one row per measure; study.json; study.html, a page with a table and a plot.
void write_study(const Study& study, const std::filesystem::path& folder);

}  // namespace aphotic
