// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/panel_quadrature.h"

#include "base/gauss_rule.h"

#include <algorithm>
#include <cmath>

namespace aphotic {
namespace {

constexpr unsigned kPanelPoints = 10;
constexpr double kPanelFall = 4.0;
constexpr double kSpent = 50.0;

// Adds an interval over which the longest path's light falls by `fall`, and the shortest's by
// `least_fall`.
void add_interval(double bright_nm,
                  double dark_nm,
                  double fall,
                  double least_fall,
                  std::vector<WavelengthRange>& panels) {
    double from = 0.0;  // a share of the interval
    while (from < 1.0 && least_fall * from < kSpent) {
        const double step = kPanelFall * std::max(1.0, fall * from / kSpent) / fall;
        const double to = std::min(1.0, from + step);
        const double a_nm = std::lerp(bright_nm, dark_nm, from);
        const double b_nm = std::lerp(bright_nm, dark_nm, to);
        panels.push_back({std::min(a_nm, b_nm), std::max(a_nm, b_nm)});
        from = to;
    }
}

}  // namespace

std::vector<WavelengthRange> light_panels(std::span<const Spectrum* const> tables,
                                          const Water& water,
                                          double shortest_path_m,
                                          double longest_path_m,
                                          const Spectrum* tilt,
                                          WavelengthRange range) {
    std::vector<const Spectrum*> all(tables.begin(), tables.end());
    std::ranges::copy(water.curves(), std::back_inserter(all));
    if (tilt != nullptr) all.push_back(tilt);
    const std::vector<double> knots_nm = union_of_knots(all, range);
    std::vector<WavelengthRange> panels;
    for (std::size_t i = 0; i + 1 < knots_nm.size(); ++i) {
        const double a_nm = knots_nm[i];
        const double b_nm = knots_nm[i + 1];
        const double rise_per_m = water.attenuation_per_m(b_nm) - water.attenuation_per_m(a_nm);
        const double least_fall = std::abs(rise_per_m) * shortest_path_m;
        double fall = std::abs(rise_per_m) * longest_path_m;
        if (tilt != nullptr) fall += std::abs(tilt->at(b_nm) - tilt->at(a_nm));
        if (rise_per_m >= 0.0) {
            add_interval(a_nm, b_nm, fall, least_fall, panels);
        } else {
            add_interval(b_nm, a_nm, fall, least_fall, panels);
        }
    }
    return panels;
}

std::vector<QuadratureNode> panel_quadrature(std::span<const WavelengthRange> panels) {
    std::vector<QuadratureNode> nodes;
    for (const WavelengthRange& panel : panels) {
        const double width_nm = panel.last_nm - panel.first_nm;
        for (const GaussNode& node : gauss_rule(kPanelPoints)) {
            nodes.push_back({.lambda_nm = panel.first_nm + width_nm * node.at,
                             .width_nm = width_nm * node.weight});
        }
    }
    return nodes;
}

}  // namespace aphotic
