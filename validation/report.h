// SPDX-License-Identifier: BSD-3-Clause
//
// The results of a validation, for programs (validation.json) and for people (report.html, one page
// without other files, scripts or network).
#pragma once

#include "rig/rig.h"
#include "spectral/integrator.h"
#include "spectral/veil_share.h"
#include "validation/comparison.h"
#include "validation/model_check.h"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace aphotic {

// The largest of each over all comparisons.
struct EdgeSummary {
    double share = 0.0;  // of pixels on edges, without a bound
    double max_error = 0.0;
    double share_in_penumbrae = 0.0;  // of pixels compared with the render's own lamps
    double max_error_of_penumbrae = 0.0;
};

struct ValidationReport {
    Rig rig;
    std::string scene_file{};  // the user's, rendered by POV-Ray but not traced by the reference
    std::string aphotic_version{};
    std::string povray_version{};
    std::vector<Comparison> wavelengths{};  // radiance, POV-Ray's against the reference's
    std::vector<double> lambda_nm{};        // of `wavelengths`, one each, increasing
    std::vector<Comparison> channels{};     // signals R, G, B, all three
    CameraImage rendered{};                 // signals, through POV-Ray
    CameraImage traced{};                   // signals, by the reference over the full spectrum
    std::array<double, kChannels> lamp_signal{};  // white in both previews
    // Signed relative errors of the signals, R, G, B planes; NaN on edges and where a sample is not
    // finite.
    std::vector<float> channel_errors{};
    VeilShare veil_share{};  // in the reference; 0 if the water does not scatter
    // The reference against light of all orders, in water that scatters, if requested.
    ModelCheck model{};
    std::size_t frames = 0;
    std::size_t grid_size = 0;  // wavelengths of the reference
    int jobs = 1;
    double render_s = 0.0;
    double integrate_s = 0.0;
    double trace_s = 0.0;

    [[nodiscard]] bool has_veil() const { return rig.water.scatters(); }
    // Wavelengths, then channels.
    [[nodiscard]] std::vector<const Comparison*> all() const;
    // Every comparison holds, and there is at least one.
    [[nodiscard]] bool holds() const;
    // The worst comparison relative to its bound; the first in a tie.
    [[nodiscard]] const Comparison& worst() const;
    [[nodiscard]] std::size_t worst_channel() const;
    [[nodiscard]] EdgeSummary edges() const;
};

// max_error / bound; 0 if both are 0, infinite if a sample is not finite.
[[nodiscard]] double share_of_bound(const Comparison& comparison);

// {holds, worst, rig, rule, wavelengths, channels, versions, ...}: every number above except the
// pixels. A number that is not finite is null.
[[nodiscard]] std::string validation_json(const ValidationReport& report);
void write_validation_json(const ValidationReport& report, const std::filesystem::path& file);
// The same report gives the same page, byte for byte.
void write_validation_html(const ValidationReport& report, const std::filesystem::path& file);

}  // namespace aphotic
