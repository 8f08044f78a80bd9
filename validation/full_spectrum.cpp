// SPDX-License-Identifier: BSD-3-Clause
#include "validation/full_spectrum.h"

#include "base/gauss_rule.h"
#include "validation/traced_water.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace aphotic {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;

// From no point, sufficient where no light is left, to ten; the last rule is the standard for the
// others.
constexpr std::array<unsigned, 8> kRulePoints{0, 1, 2, 3, 4, 5, 7, 10};

ArrayXd paths_between(double shortest_m, double longest_m) {
    if (!(shortest_m > 0.0)) return ArrayXd::Constant(1, longest_m);
    return ArrayXd::LinSpaced(kPaths, std::log(shortest_m), std::log(longest_m)).exp();
}

// Lights with the same paths.
struct Group {
    const std::vector<std::vector<Spectrum>>* sources;
    ArrayXd paths_m;
    double longest_path_m;
};

std::vector<Group> groups_of(const LightFamily& lights, const VeilLights& veil) {
    std::vector<Group> groups{
        {.sources = &lights.sources,
         .paths_m = paths_between(lights.shortest_path_m, lights.longest_path_m),
         .longest_path_m = lights.longest_path_m}};
    if (!veil.sources.empty()) {
        groups.push_back({.sources = &veil.sources,
                          .paths_m = paths_between(veil.shortest_path_m, veil.longest_path_m),
                          .longest_path_m = veil.longest_path_m});
    }
    return groups;
}

// The contribution of some wavelengths to the signals: channels by lights, relative to the least
// loss at the longest path, so that no double underflows.
class Signals {
  public:
    Signals(const Sensor& sensor,
            const TracedWater& water,
            double least_loss_per_m,
            const std::vector<Group>& groups)
        : sensor_(sensor), water_(water), least_loss_per_m_(least_loss_per_m), groups_(groups) {
        for (const Group& group : groups_)
            lights_ += static_cast<Index>(group.sources->size()) * group.paths_m.size();
    }

    [[nodiscard]] MatrixXd of(std::span<const WeightedWavelength> wavelengths) const {
        MatrixXd signals = MatrixXd::Zero(kChannels, lights_);
        for (const WeightedWavelength& w : wavelengths) {
            const Eigen::Map<const Eigen::Vector3d> weight(w.weight.data());
            const double loss_per_m = water_.loss_per_m(w.lambda_nm) - least_loss_per_m_;
            Index column = 0;
            for (const Group& group : groups_) {
                const Eigen::RowVectorXd left = (-loss_per_m * group.paths_m).exp();
                for (const auto& source : *group.sources) {
                    double light = 1.0;
                    for (const Spectrum& factor : source) light *= factor.at(w.lambda_nm);
                    signals.middleCols(column, left.size()) += light * weight * left;
                    column += left.size();
                }
            }
        }
        return signals;
    }

    [[nodiscard]] std::vector<WeightedWavelength> on(const WavelengthRange& panel,
                                                     unsigned points) const {
        const double width_nm = panel.last_nm - panel.first_nm;
        std::vector<WeightedWavelength> wavelengths;
        for (const GaussNode& node : gauss_rule(points)) {
            WeightedWavelength w{.lambda_nm = panel.first_nm + width_nm * node.at, .weight = {}};
            for (std::size_t c = 0; c < kChannels; ++c) {
                w.weight[c] =
                    width_nm * node.weight * sensor_.response(static_cast<int>(c), w.lambda_nm);
            }
            wavelengths.push_back(w);
        }
        return wavelengths;
    }

  private:
    const Sensor& sensor_;
    const TracedWater& water_;
    double least_loss_per_m_;
    const std::vector<Group>& groups_;
    Index lights_ = 0;
};

// Between neighbouring knots of all tables, cut where the longest path's light falls by kPanelFall.
std::vector<WavelengthRange> panels_of(const Sensor& sensor,
                                       const TracedWater& water,
                                       std::span<const Spectrum* const> of_water,
                                       const std::vector<Group>& groups,
                                       WavelengthRange range) {
    constexpr double kPanelFall = 4.0;
    std::vector<const Spectrum*> tables = sensor.curves();
    for (const Group& group : groups) {
        for (const auto& source : *group.sources) {
            for (const Spectrum& factor : source) tables.push_back(&factor);
        }
    }
    std::ranges::copy(of_water, std::back_inserter(tables));
    const std::vector<double> knots_nm = union_of_knots(tables, range);
    const double longest_path_m =
        std::ranges::max_element(groups, {}, &Group::longest_path_m)->longest_path_m;
    std::vector<WavelengthRange> panels;
    for (std::size_t i = 0; i + 1 < knots_nm.size(); ++i) {
        const double rise_per_m = water.loss_per_m(knots_nm[i + 1]) - water.loss_per_m(knots_nm[i]);
        const double fall = std::abs(rise_per_m) * longest_path_m;
        const int pieces = std::max(1, static_cast<int>(std::ceil(fall / kPanelFall)));
        const auto cut_nm = [&](int k) {
            return std::lerp(knots_nm[i], knots_nm[i + 1], static_cast<double>(k) / pieces);
        };
        for (int k = 0; k < pieces; ++k) panels.push_back({cut_nm(k), cut_nm(k + 1)});
    }
    return panels;
}

}  // namespace

std::vector<WeightedWavelength> full_spectrum(const Sensor& sensor,
                                              const LightFamily& lights,
                                              WavelengthRange range,
                                              double error,
                                              const VeilLights& veil) {
    const TracedWater water(lights.water);
    const std::vector<Group> groups = groups_of(lights, veil);
    const std::vector<WavelengthRange> panels =
        panels_of(sensor, water, lights.water.curves(), groups, range);
    double least_loss_per_m = water.loss_per_m(range.last_nm);
    for (const WavelengthRange& panel : panels)
        least_loss_per_m = std::min(least_loss_per_m, water.loss_per_m(panel.first_nm));
    const Signals signals(sensor, water, least_loss_per_m, groups);
    std::vector<MatrixXd> exact;
    for (const WavelengthRange& panel : panels) {
        exact.push_back(signals.of(signals.on(panel, kRulePoints.back())));
    }
    MatrixXd total = MatrixXd::Zero(exact.front().rows(), exact.front().cols());
    for (const MatrixXd& of_panel : exact) total += of_panel;

    const MatrixXd allowed = error / static_cast<double>(panels.size()) * total;
    std::vector<WeightedWavelength> spectrum;
    for (std::size_t i = 0; i < panels.size(); ++i) {
        std::vector<WeightedWavelength> wavelengths;
        for (const unsigned points : kRulePoints) {
            wavelengths = signals.on(panels[i], points);
            const MatrixXd off = (signals.of(wavelengths) - exact[i]).cwiseAbs();
            if ((off.array() <= allowed.array()).all()) break;
        }
        spectrum.insert(spectrum.end(), wavelengths.begin(), wavelengths.end());
    }
    if (spectrum.empty()) return signals.on(panels.front(), 1);  // no light at all
    return spectrum;
}

}  // namespace aphotic
