// SPDX-License-Identifier: BSD-3-Clause
//
// A study of known content, without a renderer: every setting of HabCam with emitters on two
// cores, with times and errors of the size that they have.
#pragma once

#include "rig/rig_reader.h"
#include "validation/study.h"

#include <cmath>
#include <string>
#include <tuple>

namespace aphotic {

inline StudyMeasure measure_of(const StudySetting& setting, double time_s, double max_error) {
    StudyMeasure measure{.setting = setting,
                         .wavelengths = static_cast<std::size_t>(setting.fitted + setting.bands),
                         .frames = 1,
                         .promise = 1.5 * max_error,
                         .render_s = 0.75 * time_s,
                         .integrate_s = 0.25 * time_s,
                         .channels = {}};
    // G is the worst.
    constexpr std::array<double, 3> kShares{0.5, 1.0, 0.75};
    for (std::size_t c = 0; c < kShares.size(); ++c) {
        measure.channels[c] = {.name = std::string(kChannelNames[c]),
                               .max_error = kShares[c] * max_error,
                               .column = 7,
                               .row = 5,
                               .percentile_999 = 0.9 * kShares[c] * max_error,
                               .rms_error = 0.3 * kShares[c] * max_error,
                               .mean_error = -0.01 * kShares[c] * max_error,
                               .compared = 1190,
                               .on_edges = 10,
                               .max_error_on_edges = 0.25,
                               .not_finite = 0,
                               .bound = 0.0};
    }
    return measure;
}

inline double likely_error(const StudySetting& setting) {
    constexpr double kHalfFloat = 4.8e-4;
    const double rule = setting.bands > 0 ? 2.1 / setting.bands / setting.bands : 3e-5;
    if (setting.shrink > 1) {
        const double filter = setting.filter == "triangle" ? 1.6 : 1.0;
        return filter * (setting.shrink == 2 ? 0.011 : 0.037) +
               (setting.filter == "lanczos3" ? 6e-4 : 0.0);
    }
    if (setting.one_soft_lamp) return 0.0031;
    if (setting.antialias) return 5.1e-4;
    return setting.png ? 2.7e-4 : kHalfFloat + rule;
}

inline double likely_time_s(const StudySetting& setting) {
    const int wavelengths = setting.fitted + setting.bands;
    const double frames = std::ceil(wavelengths / static_cast<double>(setting.per_frame));
    double time_s = 0.4 + 3.4 * frames + 0.02 * wavelengths;
    if (setting.per_frame == 1) time_s *= 0.8;
    if (setting.jobs == 1) time_s *= 1.2;
    if (setting.one_soft_lamp) time_s *= 0.3;
    if (setting.antialias) time_s *= 2.4;
    if (setting.png) time_s += 0.3;
    if (setting.filter == "lanczos3") time_s += 0.2;
    return setting.shrink > 1 ? 0.25 + time_s / (setting.shrink * setting.shrink) : time_s;
}

inline Study small_study() {
    Study study{.rig_title = "HabCam, strobes of finite size",
                .rig_sha256 = std::string(64, 'a'),
                .width_px = 1360,
                .height_px = 1024,
                .aphotic_version = "1.2.3",
                .povray_version = "3.7.0.10",
                .cores = 2,
                .tolerance = 1e-3,
                .grid_size = 398,
                .trace_s = 54.25};
    const Rig rig = read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam-emitters.toml");
    for (const StudySetting& setting : study_settings(rig, false, study.cores)) {
        StudyMeasure measure = measure_of(setting, likely_time_s(setting), likely_error(setting));
        measure.frames = (measure.wavelengths + static_cast<std::size_t>(setting.per_frame) - 1) /
                         static_cast<std::size_t>(setting.per_frame);
        study.measures.push_back(measure);
    }
    return study;
}

// What is rendered, whatever it is called.
inline auto content_of(const StudySetting& s) {
    return std::tuple(s.fitted,
                      s.bands,
                      s.per_frame,
                      s.shrink,
                      s.filter,
                      s.one_soft_lamp,
                      s.png,
                      s.antialias,
                      s.jobs);
}

}  // namespace aphotic
