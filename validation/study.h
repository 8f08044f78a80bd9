// SPDX-License-Identifier: BSD-3-Clause
//
// The trade of accuracy for time, measured: settings of a render, the wall time that each takes
// here, and how far each is from the reference.
//
//   error  = (a - b) / max(|b|, black)       a a pixel's signal, b the reference's over the full
//                                            spectrum, channel by channel (comparison.h)
//   time   = POV-Ray's + integration's, enlarging included
//
// The Pareto front is made of the settings that no other beats in both: none is as fast and as
// right, and better in one. The recommended setting for a tolerance is the fastest whose largest
// error is within it.
//
// A measure is given by its worst channel. One with a sample that is not finite, or with none off
// the edges, has an infinite error: it is neither on the front nor recommended.
//
// Reduced images stand for the same field of view with fewer pixels; where the size does not
// divide, that setting is left out.
#pragma once

#include "image/output_images.h"
#include "rig/rig.h"
#include "validation/comparison.h"

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// The settings that others are held against, by name.
inline constexpr std::string_view kBaseline = "fitted-3";
inline constexpr std::string_view kCustomary = "bands-36";
inline constexpr std::string_view kCustomaryMono = "bands-36-mono";  // one wavelength a frame

// What is tried, and against what else.
struct StudySetting {
    std::string name{};     // unique and plain, such as "fitted-3": a folder's name
    std::string subject{};  // what it is about: "wavelengths", "packing", "resolution", ...
    std::string words{};    // for people: "3 fitted wavelengths"
    int fitted = 0;         // so many fitted wavelengths, or
    int bands = 0;          // so many equal bands
    int per_frame = 3;
    int shrink = 1;              // resolution divided by this each way, and enlarged again
    std::string filter{};        // with which it is enlarged, OpenImageIO's name
    bool one_soft_lamp = false;  // for an emitter: one lamp with softened edges
    bool png = false;            // 16-bit linear PNG frames instead of half-float EXR
    bool antialias = false;
    int jobs = 1;
};

// The settings for a rig, the baseline first. quick: the few that decide. What would repeat
// another setting is left out: one lamp for an emitter where none is, one job on one core.
[[nodiscard]] std::vector<StudySetting> study_settings(const Rig& rig, bool quick, int cores);

// The rig with an image so small that a quick study takes under two minutes; itself when it is.
// Both sizes are divided by the same whole number, by which the pixels grow. Where they do not
// divide, the last pixels are left off: the field of view then is smaller by under a pixel.
[[nodiscard]] Rig quick_rig(Rig rig);

struct StudyMeasure {
    StudySetting setting{};
    std::size_t wavelengths = 0;
    std::size_t frames = 0;
    double promise = 0.0;  // of the plan's worst channel; see promise_applies()
    double render_s = 0.0;
    double integrate_s = 0.0;
    std::array<Comparison, 3> channels{};  // R, G, B

    [[nodiscard]] double total_s() const { return render_s + integrate_s; }
    // A plan knows of wavelengths and half-float frames, not of what else may be changed.
    [[nodiscard]] bool promise_applies() const;
    // Edges come out blurred: then they count in the largest error.
    [[nodiscard]] bool blurs_edges() const;

    // The worst channel's; off the edges, where these are not blurred.
    [[nodiscard]] double max_error() const;
    [[nodiscard]] double worst(double Comparison::*error) const;
    [[nodiscard]] double max_error_off_edges() const { return worst(&Comparison::max_error); }
    [[nodiscard]] double percentile_999() const { return worst(&Comparison::percentile_999); }
    [[nodiscard]] double rms_error() const { return worst(&Comparison::rms_error); }
    [[nodiscard]] double max_error_on_edges() const {
        return worst(&Comparison::max_error_on_edges);
    }
};

struct Study {
    std::string rig_title{};
    std::string rig_sha256{};
    int width_px = 0;
    int height_px = 0;
    std::string aphotic_version{};
    std::string povray_version{};
    int cores = 1;
    bool quick = false;
    double tolerance = 1e-3;
    std::size_t grid_size = 0;  // wavelengths of the reference
    double trace_s = 0.0;
    std::vector<StudyMeasure> measures{};
};

// The image against the reference of the same size, planes R, G, B of each; black is kBlackShare
// (validation.h) of the channel's brightest, and there is no bound. on_edge: 1 for pixels on edges;
// may be empty.
[[nodiscard]] std::array<Comparison, 3> compare_signals(const CameraImage& image,
                                                        const CameraImage& reference,
                                                        std::span<const unsigned char> on_edge);

// By measure: whether it is on the front.
[[nodiscard]] std::vector<bool> pareto_front(std::span<const StudyMeasure> measures);

// The index of the fastest whose largest error is within the tolerance.
[[nodiscard]] std::optional<std::size_t> recommended(std::span<const StudyMeasure> measures,
                                                     double tolerance);

// By its name; nullptr when it was not measured.
[[nodiscard]] const StudyMeasure* find_measure(std::span<const StudyMeasure> measures,
                                               std::string_view name);

// How many times as long one takes as the other; nothing when either was not measured, or took no
// time.
[[nodiscard]] std::optional<double> time_ratio(std::span<const StudyMeasure> measures,
                                               std::string_view name,
                                               std::string_view other);

// A study for people: the recommendation, the plot of error against time, a table, and how to read
// them. The same study gives the same page, byte for byte.
[[nodiscard]] std::string study_page(const Study& study);

// study.csv, one row a measure; study.json, all of the study; study.html, the page. A number that
// is not finite is null in JSON and inf in CSV; a promise that does not apply is null and empty.
void write_study(const Study& study, const std::filesystem::path& folder);

}  // namespace aphotic
