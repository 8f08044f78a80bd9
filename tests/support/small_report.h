// SPDX-License-Identifier: BSD-3-Clause
//
// A report of known content, without a renderer: a small image whose signals are the pixel's
// numbers, and errors that are set by hand.
#pragma once

#include "rig/file/rig_reader.h"
#include "validation/report.h"

#include <cstddef>
#include <limits>
#include <string>

namespace aphotic {

inline constexpr int kReportWidth_px = 40;
inline constexpr int kReportHeight_px = 30;

inline Comparison comparison_of(const std::string& name, double max_error, double bound) {
    return {.name = name,
            .max_error = max_error,
            .column = 7,
            .row = 5,
            .percentile_999 = 0.9 * max_error,
            .rms_error = 0.3 * max_error,
            .mean_error = -0.01 * max_error,
            .compared = 1190,
            .on_edges = 10,
            .max_error_on_edges = 0.25,
            .not_finite = 0,
            .bound = bound};
}

inline std::size_t report_sample(int channel, int column, int row) {
    const std::ptrdiff_t line = std::ptrdiff_t{channel} * kReportHeight_px + row;
    return static_cast<std::size_t>(line * kReportWidth_px + column);
}

// Holds; closest to its bound is 550 nm. The reference's signal is column / 40 in R, row / 30 in
// G, 1 in B; POV-Ray's is 2e-4 more, relative.
inline ValidationReport small_report() {
    Rig rig = read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
    rig.camera.width_px = kReportWidth_px;
    rig.camera.height_px = kReportHeight_px;
    ValidationReport report{.rig = rig};
    report.aphotic_version = "1.2.3";
    report.povray_version = "3.7.0.10";
    report.lambda_nm = {454.0, 550.0, 622.0};
    report.wavelengths = {comparison_of("454 nm", 3e-4, 6e-4),
                          comparison_of("550 nm", 4.8e-4, 6e-4),
                          comparison_of("622 nm", 4e-4, 6e-4)};
    report.channels = {comparison_of("R", 5e-4, 7e-4),
                       comparison_of("G", 2e-4, 7e-4),
                       comparison_of("B", 1e-4, 7e-4)};
    for (auto* image : {&report.rendered, &report.traced})
        *image = {.width_px = kReportWidth_px, .height_px = kReportHeight_px, .samples = {}};
    for (int c = 0; c < kChannels; ++c) {
        for (int row = 0; row < kReportHeight_px; ++row) {
            for (int column = 0; column < kReportWidth_px; ++column) {
                const double signal = c == 0   ? static_cast<double>(column) / kReportWidth_px
                                      : c == 1 ? static_cast<double>(row) / kReportHeight_px
                                               : 1.0;
                report.traced.samples.push_back(static_cast<float>(signal));
                report.rendered.samples.push_back(static_cast<float>(signal * (1.0 + 2e-4)));
                report.channel_errors.push_back(2e-4F);
            }
        }
    }
    report.channel_errors[report_sample(0, 3, 4)] = std::numeric_limits<float>::quiet_NaN();
    report.lamp_signal = {8.0, 9.0, 7.0};
    report.frames = 1;
    report.grid_size = 398;
    report.jobs = 2;
    report.render_s = 12.25;
    report.integrate_s = 0.5;
    report.trace_s = 8.75;
    return report;
}

}  // namespace aphotic
