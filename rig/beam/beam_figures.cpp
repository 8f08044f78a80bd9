// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/beam_figures.h"

#include "base/degrees.h"
#include "rig/beam/round_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aphotic {

namespace {

using Eigen::Vector3d;

const BeamFrame kLamp{Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitY()};
constexpr double kFine_deg = 0.1;

// By bisection, between an angle above half and one below.
double edge_of_half(const Beam& beam, BeamPlane plane, double bright, double dim, double half) {
    constexpr double kClose_rad = 1e-9;
    while (std::abs(dim - bright) > kClose_rad) {
        const double middle = 0.5 * (bright + dim);
        (intensity_in_plane(beam, plane, middle) >= half ? bright : dim) = middle;
    }
    return bright;
}

double fwhm_rad(const Beam& beam, BeamPlane plane) {
    constexpr int kSteps = static_cast<int>(180.0 / kFine_deg);
    const auto angle = [](int i) { return i * kFine_deg * kRadiansPerDegree; };
    double largest = 0.0;
    for (int i = -kSteps; i <= kSteps; ++i) {
        largest = std::max(largest, intensity_in_plane(beam, plane, angle(i)));
    }
    const double half = 0.5 * largest;
    const auto outermost = [&](int side) {
        for (int i = kSteps; i > -kSteps; --i) {
            if (intensity_in_plane(beam, plane, angle(side * i)) < half) continue;
            return i == kSteps
                       ? angle(side * i)
                       : edge_of_half(beam, plane, angle(side * i), angle(side * (i + 1)), half);
        }
        return angle(-side * kSteps);
    };
    return largest > 0.0 ? outermost(1) - outermost(-1) : 0.0;
}

// On a grid of a tenth of a degree.
void find_extremes(const Beam& beam, BeamFigures& figures) {
    constexpr int kSteps = static_cast<int>(180.0 / kFine_deg);
    for (int i = 0; i <= kSteps; ++i) {
        const double theta_rad = i * kFine_deg * kRadiansPerDegree;
        for (double phi_deg = 0.0; phi_deg < 360.0; phi_deg += kExportTurn_deg) {
            const GoniometerAngles at{theta_rad, phi_deg * kRadiansPerDegree};
            const double intensity =
                intensity_towards(beam, kLamp, direction_at(TableAngles::TypeC, at));
            figures.largest_per_sr = std::max(figures.largest_per_sr, intensity);
            if (intensity > 0.0) figures.widest_rad = theta_rad;
        }
    }
}

std::vector<double> steps_rad(double last_deg, double step_deg) {
    std::vector<double> steps;
    const auto count = static_cast<int>(std::lround(last_deg / step_deg));
    for (int i = 0; i <= count; ++i) steps.push_back(i * step_deg * kRadiansPerDegree);
    return steps;
}

BeamTable sampled(const Beam& beam, const BeamFigures& figures) {
    constexpr double kRightAngle_deg = 90.0;
    constexpr double kWholeTurn_deg = 360.0;
    BeamTable table{
        .angles = TableAngles::TypeC,
        .vertical_rad = steps_rad(figures.widest_rad > kRightAngle_deg * kRadiansPerDegree
                                      ? 2.0 * kRightAngle_deg
                                      : kRightAngle_deg,
                                  kExportStep_deg),
        .horizontal_rad =
            is_round(beam) ? std::vector<double>{0.0} : steps_rad(kWholeTurn_deg, kExportTurn_deg),
        .intensity = {}};
    for (std::size_t h = 0; h < table.horizontal_rad.size(); ++h) {
        // The last plane equals the first exactly.
        const bool is_last = h > 0 && h + 1 == table.horizontal_rad.size();
        const double phi_rad = is_last ? 0.0 : table.horizontal_rad[h];
        for (const double theta_rad : table.vertical_rad) {
            table.intensity.push_back(
                intensity_towards(beam, kLamp, direction_at(table.angles, {theta_rad, phi_rad})));
        }
    }
    return table;
}

double error_between_nodes(const Beam& beam, const BeamTable& table, double largest_per_sr) {
    double worst = 0.0;
    for (std::size_t h = 0; h < table.horizontal_rad.size(); ++h) {
        const double next =
            table.horizontal_rad.size() == 1
                ? table.horizontal_rad[h]
                : table.horizontal_rad[std::min(h + 1, table.horizontal_rad.size() - 1)];
        for (std::size_t v = 0; v + 1 < table.vertical_rad.size(); ++v) {
            const Vector3d middle =
                direction_at(table.angles,
                             {0.5 * (table.vertical_rad[v] + table.vertical_rad[v + 1]),
                              0.5 * (table.horizontal_rad[h] + next)});
            worst = std::max(
                worst,
                std::abs(table_intensity(table, middle) - intensity_towards(beam, kLamp, middle)));
        }
    }
    return worst / largest_per_sr;
}

}  // namespace

double intensity_in_plane(const Beam& beam, BeamPlane plane, double theta_rad) {
    const double aside = std::sin(theta_rad);
    const Vector3d towards = plane == BeamPlane::Along ? Vector3d(aside, 0.0, std::cos(theta_rad))
                                                       : Vector3d(0.0, aside, std::cos(theta_rad));
    return intensity_towards(beam, kLamp, towards);
}

BeamFigures figures_of(const Beam& beam) {
    BeamFigures figures{.flux = flux_of(beam),
                        .fwhm_along_rad = fwhm_rad(beam, BeamPlane::Along),
                        .fwhm_across_rad = fwhm_rad(beam, BeamPlane::Across)};
    find_extremes(beam, figures);
    return figures;
}

ExportedBeam exported(const Beam& beam, double luminous_flux_lm) {
    ExportedBeam result;
    const auto* table = std::get_if<BeamTable>(&beam.pattern);
    double scale = luminous_flux_lm;
    if (table != nullptr && !beam.window && beam.turn_rad == 0.0) {
        result.file.table = *table;
        scale *= beam.per_flux;
    } else {
        BeamFigures figures;
        find_extremes(beam, figures);
        result.file.table = sampled(beam, figures);
        result.error = error_between_nodes(beam, result.file.table, figures.largest_per_sr);
    }
    for (double& intensity : result.file.table.intensity) intensity *= scale;
    result.file.luminous_flux_lm = luminous_flux_lm;
    return result;
}

}  // namespace aphotic
