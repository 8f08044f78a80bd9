// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/light_family.h"

#include "base/gauss_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace aphotic {
namespace {

using Signals = std::array<double, kChannels>;

// One member of the family: a source and a path.
struct Member {
    const std::vector<Spectrum>* source;
    double path_m;
};

std::vector<Member> members_of(const LightFamily& family, int paths) {
    std::vector<Member> members;
    for (const auto& source : family.sources) {
        for (int i = 0; i < paths; ++i) {
            const double share = paths == 1 ? 0.0 : static_cast<double>(i) / (paths - 1);
            // In even ratios, since paths range from metres to the horizon.
            const double path_m =
                family.shortest_path_m > 0.0
                    ? family.shortest_path_m *
                          std::pow(family.longest_path_m / family.shortest_path_m, share)
                    : share * family.longest_path_m;
            members.push_back({.source = &source, .path_m = path_m});
        }
    }
    return members;
}

// The light is scaled by exp(K_0 l), K_0 the least loss among the knots, so that even a long path
// does not underflow a double. Errors are relative to a member's own signal.
double light(const LightFamily& family,
             const Member& member,
             double least_loss_per_m,
             double lambda_nm) {
    // One sign is enough, since the number of points depends on the tilt's magnitude.
    const double tilt = family.tilt ? family.tilt->at(lambda_nm) : 0.0;
    return product_at(*member.source, lambda_nm) *
           std::exp((least_loss_per_m - family.water.attenuation_per_m(lambda_nm)) * member.path_m +
                    tilt);
}

Signals signals_of(const LightFamily& family,
                   const Member& member,
                   double least_loss_per_m,
                   std::span<const WeightedWavelength> rule) {
    Signals signals{};
    for (const WeightedWavelength& w : rule) {
        const double f = light(family, member, least_loss_per_m, w.lambda_nm);
        for (std::size_t c = 0; c < kChannels; ++c) signals[c] += w.weight[c] * f;
    }
    return signals;
}

std::vector<WeightedWavelength> nodes_between(const Sensor& sensor,
                                              double first_nm,
                                              double last_nm,
                                              unsigned points) {
    std::vector<WeightedWavelength> nodes;
    const double width_nm = last_nm - first_nm;
    for (const GaussNode& node : gauss_rule(points)) {
        WeightedWavelength w{.lambda_nm = first_nm + node.at * width_nm};
        for (std::size_t c = 0; c < kChannels; ++c) {
            w.weight[c] =
                node.weight * width_nm * sensor.response(static_cast<int>(c), w.lambda_nm);
        }
        nodes.push_back(w);
    }
    return nodes;
}

std::vector<double> knots_of(const Sensor& sensor,
                             const LightFamily& family,
                             WavelengthRange range) {
    std::vector<const Spectrum*> curves = sensor.curves();
    for (const auto& source : family.sources) {
        for (const Spectrum& curve : source) curves.push_back(&curve);
    }
    std::ranges::copy(family.water.curves(), std::back_inserter(curves));
    if (family.tilt) curves.push_back(&*family.tilt);
    std::vector<double> knots = union_of_knots(curves, range);
    // kExactPoints are exact if light falls by at most exp(-8). If it falls further between two
    // knots, the brighter end is halved until it does not; the rest is darker in proportion as it
    // is steeper.
    constexpr double kMostFall = 8.0;
    const std::size_t tables_knots = knots.size();
    for (std::size_t i = 0; i + 1 < tables_knots; ++i) {
        double bright_nm = knots[i];
        double dark_nm = knots[i + 1];
        const auto K_per_m = [&](double nm) { return family.water.attenuation_per_m(nm); };
        if (K_per_m(dark_nm) < K_per_m(bright_nm)) std::swap(bright_nm, dark_nm);
        while ((K_per_m(dark_nm) - K_per_m(bright_nm)) * family.longest_path_m > kMostFall) {
            dark_nm = 0.5 * (bright_nm + dark_nm);
            knots.push_back(dark_nm);
        }
    }
    std::ranges::sort(knots);
    return knots;
}

}  // namespace

std::vector<WeightedWavelength> reference_grid(const Sensor& sensor,
                                               const LightFamily& family,
                                               WavelengthRange range,
                                               double error) {
    const std::vector<double> knots = knots_of(sensor, family, range);
    const std::vector<Member> members = members_of(family, kExactPaths);
    const std::size_t intervals = knots.size() - 1;
    double least_loss_per_m = std::numeric_limits<double>::infinity();
    for (const double nm : knots) {
        least_loss_per_m = std::min(least_loss_per_m, family.water.attenuation_per_m(nm));
    }

    std::vector<std::vector<Signals>> exact(intervals);  // by interval and member
    std::vector<Signals> total(members.size(), Signals{});
    for (std::size_t i = 0; i < intervals; ++i) {
        const auto nodes = nodes_between(sensor, knots[i], knots[i + 1], kExactPoints);
        for (std::size_t m = 0; m < members.size(); ++m) {
            exact[i].push_back(signals_of(family, members[m], least_loss_per_m, nodes));
            for (std::size_t c = 0; c < kChannels; ++c) total[m][c] += exact[i][m][c];
        }
    }

    const double share = error / static_cast<double>(intervals);
    std::vector<WeightedWavelength> grid;
    for (std::size_t i = 0; i < intervals; ++i) {
        std::vector<WeightedWavelength> nodes;
        for (unsigned points = 1; points <= kExactPoints; ++points) {
            nodes = nodes_between(sensor, knots[i], knots[i + 1], points);
            bool is_enough = true;
            for (std::size_t m = 0; m < members.size() && is_enough; ++m) {
                const Signals found = signals_of(family, members[m], least_loss_per_m, nodes);
                for (std::size_t c = 0; c < kChannels; ++c) {
                    is_enough &= std::abs(found[c] - exact[i][m][c]) <= share * total[m][c];
                }
            }
            if (is_enough) break;
        }
        grid.insert(grid.end(), nodes.begin(), nodes.end());
    }
    return grid;
}

}  // namespace aphotic
