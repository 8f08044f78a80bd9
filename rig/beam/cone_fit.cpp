// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/cone_fit.h"

#include "base/degrees.h"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace aphotic {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kWidest_rad = 0.5 * std::numbers::pi;
constexpr int kRings = 1800;  // midpoints, ten to a step
constexpr int kTurns = 72;

// The beam on rings about its axis: its mean, which cones can match, and its total.
struct Rings {
    VectorXd theta_rad;
    VectorXd solid_angle_sr;
    VectorXd mean;
    double square = 0.0;  // integral of I^2
};

Rings rings_of(const Beam& beam) {
    const BeamFrame frame = frame_about(Eigen::Vector3d::UnitZ());
    Rings rings{.theta_rad = VectorXd(kRings),
                .solid_angle_sr = VectorXd(kRings),
                .mean = VectorXd::Zero(kRings)};
    for (Eigen::Index i = 0; i < kRings; ++i) {
        const double theta_rad = kWidest_rad * (static_cast<double>(i) + 0.5) / kRings;
        rings.theta_rad(i) = theta_rad;
        rings.solid_angle_sr(i) =
            2.0 * std::numbers::pi * std::sin(theta_rad) * kWidest_rad / kRings;
        for (int j = 0; j < kTurns; ++j) {
            const double phi_rad = 2.0 * std::numbers::pi * j / kTurns;
            const Eigen::Vector3d towards =
                std::cos(theta_rad) * frame.axis +
                std::sin(theta_rad) *
                    (std::cos(phi_rad) * frame.along + std::sin(phi_rad) * frame.across);
            const double intensity = intensity_towards(beam, frame, towards);
            rings.mean(i) += intensity / kTurns;
            rings.square += rings.solid_angle_sr(i) * intensity * intensity / kTurns;
        }
    }
    return rings;
}

double half_angle_rad(int step) {
    return step * kFitStep_deg * kRadiansPerDegree;
}

// Normal equations of all possible cones: G, the products of cones, and b, those with the beam.
struct Equations {
    MatrixXd G;
    VectorXd b;
};

Equations equations_of(const Rings& rings) {
    const int steps = static_cast<int>(std::lround(90.0 / kFitStep_deg));
    // Step k at row k - 1.
    MatrixXd cones(kRings, steps);
    for (int k = 1; k <= steps; ++k) {
        const double sine = std::sin(half_angle_rad(k));
        const double axial = 1.0 / (std::numbers::pi * sine * sine);
        cones.col(k - 1) = (rings.theta_rad.array() <= half_angle_rad(k))
                               .select(axial * rings.theta_rad.array().cos(), 0.0);
    }
    const MatrixXd weighted = rings.solid_angle_sr.asDiagonal() * cones;
    return {.G = cones.transpose() * weighted, .b = weighted.transpose() * rings.mean};
}

struct Shares {
    VectorXd alpha;
    double gain = 0.0;  // reduction of the integral
};

// No gain for a share of 0, which is a smaller set, or less, which is no cone.
Shares shares_of(const Equations& all, const std::set<int>& steps) {
    if (steps.empty()) return {};
    std::vector<Eigen::Index> chosen;
    for (const int step : steps) chosen.push_back(step - 1);
    const MatrixXd G = all.G(chosen, chosen);
    const VectorXd b = all.b(chosen);
    const VectorXd alpha = G.ldlt().solve(b);
    return {.alpha = alpha, .gain = alpha.minCoeff() > 0.0 ? b.dot(alpha) : 0.0};
}

// The best set that differs from this one only in `moving`, by up to `reach` steps.
std::set<int> best_move(const Equations& all, const std::set<int>& from, int moving, int reach) {
    const auto steps = static_cast<int>(all.b.size());
    std::set<int> best = from;
    double gain = shares_of(all, from).gain;
    for (int k = std::max(1, moving - reach); k <= std::min(steps, moving + reach); ++k) {
        if (from.contains(k)) continue;
        std::set<int> other = from;
        other.erase(moving);
        other.insert(k);
        const double found = shares_of(all, other).gain;
        if (found > gain) {
            gain = found;
            best = other;
        }
    }
    return best;
}

}  // namespace

ConeFit fit_cones(const Beam& beam, int count) {
    constexpr int kReach = 6;
    constexpr int kMostRounds = 30;
    const Rings rings = rings_of(beam);
    const Equations all = equations_of(rings);
    const auto steps = static_cast<int>(all.b.size());
    std::set<int> chosen;
    while (std::ssize(chosen) < count) {
        const int none = 0;  // a cone that does not exist yet may be anywhere
        std::set<int> grown = best_move(all, chosen, none, steps);
        if (grown == chosen) break;
        for (int round = 0; round < kMostRounds; ++round) {
            const std::set<int> before = grown;
            for (const int step : before) grown = best_move(all, grown, step, kReach);
            if (grown == before) break;
        }
        chosen = grown;
    }
    const Shares shares = shares_of(all, chosen);
    ConeFit fit{.cones = {},
                .error = std::sqrt(std::max(0.0, rings.square - shares.gain) / rings.square)};
    Eigen::Index i = 0;
    for (const int step : chosen) {
        fit.cones.push_back({.part = fmt::format("cone{}", fit.cones.size() + 1),
                             .half_angle_rad = half_angle_rad(step),
                             .weight = shares.alpha(i++)});
    }
    return fit;
}

}  // namespace aphotic
