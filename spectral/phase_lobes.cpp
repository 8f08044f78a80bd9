// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/phase_lobes.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace aphotic {
namespace {

constexpr int kAngles = 241;
// Beyond these, a lobe is a spike, or nearly equal to the next.
constexpr double kMostForward = 0.98;
constexpr double kMostBackward = -0.85;
// The penalty on a lobe's size, against the error at an angle.
constexpr double kSizeCosts = 1e-3;

PhaseFunction rayleigh() {
    return {.name = "rayleigh", .kind = MolecularScattering{.depolarisation = 0.0}};
}

PhaseFunction henyey_greenstein(double g) {
    return {.name = fmt::format("henyey-greenstein {:.3f}", g), .kind = HenyeyGreenstein{.g = g}};
}

bool is_rayleigh(const PhaseFunction& lobe) {
    return std::holds_alternative<MolecularScattering>(lobe.kind);
}

double eccentricity(const PhaseFunction& lobe) {
    return std::get<HenyeyGreenstein>(lobe.kind).g;
}

std::size_t place_of(const PhaseFunction& lobe, std::vector<PhaseFunction>& lobes) {
    const auto is_it = [&](const PhaseFunction& other) {
        if (is_rayleigh(lobe) || is_rayleigh(other)) return is_rayleigh(lobe) == is_rayleigh(other);
        return eccentricity(lobe) == eccentricity(other);
    };
    const auto found = std::ranges::find_if(lobes, is_it);
    const auto place = static_cast<std::size_t>(found - lobes.begin());
    if (found == lobes.end()) lobes.push_back(lobe);
    return place;
}

struct Share {
    std::size_t lobe;
    double share;
};

// Empty for a function that is not exactly a sum of a few lobes.
std::vector<Share> exact_shares(const PhaseFunction& phase, std::vector<PhaseFunction>& lobes) {
    if (const auto* hg = std::get_if<HenyeyGreenstein>(&phase.kind)) {
        return {{.lobe = place_of(henyey_greenstein(hg->g), lobes), .share = 1.0}};
    }
    if (const auto* sea = std::get_if<MolecularScattering>(&phase.kind)) {
        // (1 + P c^2)/(1 + P/3) = s (1 + c^2)/(1 + 1/3) + (1 - s)
        const double P = (1.0 - sea->depolarisation) / (1.0 + sea->depolarisation);
        const double s = 4.0 * P / (3.0 + P);
        return {{.lobe = place_of(rayleigh(), lobes), .share = s},
                {.lobe = place_of(henyey_greenstein(0.0), lobes), .share = 1.0 - s}};
    }
    return {};
}

// The fit of one phase function: least squares of sum_m share_m q_m / p - 1.
class Fit {
  public:
    Fit(const PhaseFunction& phase, const Eigen::ArrayXd& angle_rad)
        : angle_rad_(angle_rad), over_(angle_rad.size()) {
        constexpr double kLeast = 1e-6;  // of the largest, since a table may have zeros
        for (Eigen::Index i = 0; i < over_.size(); ++i) over_[i] = phase.at(angle_rad[i]);
        over_ = over_.max(kLeast * over_.maxCoeff()).inverse().eval();
    }

    struct Found {
        Eigen::VectorXd share;
        double cost;
        double error;
        double amplification;
    };
    [[nodiscard]] Found with(std::span<const PhaseFunction> lobes) const {
        const auto count = static_cast<Eigen::Index>(lobes.size());
        Eigen::MatrixXd columns(angle_rad_.size(), count);
        for (Eigen::Index m = 0; m < count; ++m) {
            for (Eigen::Index i = 0; i < angle_rad_.size(); ++i)
                columns(i, m) = lobes[static_cast<std::size_t>(m)].at(angle_rad_[i]) * over_[i];
        }
        const Eigen::VectorXd scale = columns.colwise().norm().transpose();
        const Eigen::MatrixXd unit = columns * scale.cwiseInverse().asDiagonal();
        Eigen::MatrixXd normal = unit.transpose() * unit;
        normal.diagonal().array() += kSizeCosts * kSizeCosts;
        const Eigen::VectorXd size =
            normal.ldlt().solve(unit.transpose() * Eigen::VectorXd::Ones(angle_rad_.size()));
        const Eigen::ArrayXd off = (unit * size).array() - 1.0;
        return {.share = size.cwiseQuotient(scale),
                .cost = off.square().sum() + kSizeCosts * kSizeCosts * size.squaredNorm(),
                .error = off.abs().maxCoeff(),
                .amplification = (unit.cwiseAbs() * size.cwiseAbs()).maxCoeff()};
    }

  private:
    const Eigen::ArrayXd& angle_rad_;
    Eigen::ArrayXd over_;
};

double cost_of(std::span<const Fit> fits, std::span<const PhaseFunction> lobes) {
    double cost = 0.0;
    for (const Fit& fit : fits) cost += fit.with(lobes).cost;
    return cost;
}

double error_of(std::span<const Fit> fits, std::span<const PhaseFunction> lobes) {
    double error = 0.0;
    for (const Fit& fit : fits) error = std::max(error, fit.with(lobes).error);
    return error;
}

// The best lobe of a coarse grid.
std::optional<PhaseFunction> next_lobe(std::span<const Fit> fits,
                                       std::vector<PhaseFunction> lobes) {
    constexpr double kStep = 0.05;
    std::vector<PhaseFunction> choice{rayleigh()};
    for (double g = kMostBackward; g < kMostForward; g += kStep)
        choice.push_back(henyey_greenstein(g));
    std::optional<PhaseFunction> best;
    double least = std::numeric_limits<double>::infinity();
    for (const PhaseFunction& candidate : choice) {
        const auto is_near = [&](const PhaseFunction& lobe) {
            if (is_rayleigh(lobe) || is_rayleigh(candidate))
                return is_rayleigh(lobe) == is_rayleigh(candidate);
            return std::abs(eccentricity(lobe) - eccentricity(candidate)) < 0.5 * kStep;
        };
        if (std::ranges::any_of(lobes, is_near)) continue;
        lobes.push_back(candidate);
        const double cost = cost_of(fits, lobes);
        lobes.pop_back();
        if (cost >= least) continue;
        least = cost;
        best = candidate;
    }
    return best;
}

// Moves lobes, beginning with `first`, one at a time, by steps that halve.
void refine(std::span<const Fit> fits, std::size_t first, std::vector<PhaseFunction>& lobes) {
    constexpr double kFirstStep = 0.04;
    constexpr double kLastStep = 1e-3;
    constexpr double kGain = 1e-6;
    constexpr int kMostRounds = 60;
    double least = cost_of(fits, lobes);
    double step = kFirstStep;
    for (int round = 0; round < kMostRounds && step >= kLastStep; ++round) {
        bool moved = false;
        for (std::size_t m = first; m < lobes.size(); ++m) {
            if (is_rayleigh(lobes[m])) continue;
            for (const double by : {step, -step}) {
                const PhaseFunction before = lobes[m];
                const double g = eccentricity(before) + by;
                if (g > kMostForward || g < kMostBackward) continue;
                lobes[m] = henyey_greenstein(g);
                const double cost = cost_of(fits, lobes);
                if (cost < (1.0 - kGain) * least) {
                    least = cost;
                    moved = true;
                } else {
                    lobes[m] = before;
                }
            }
        }
        if (!moved) step *= 0.5;
    }
}

}  // namespace

PhaseLobes lobes_of(std::span<const PhaseFunction> phases, double from_rad, double to_rad) {
    const Eigen::ArrayXd angle_rad = Eigen::ArrayXd::LinSpaced(kAngles, from_rad, to_rad);
    PhaseLobes found;
    std::vector<std::vector<Share>> exact;
    std::vector<Fit> fits;
    for (const PhaseFunction& phase : phases) {
        exact.push_back(exact_shares(phase, found.lobes));
        if (exact.back().empty()) fits.emplace_back(phase, angle_rad);
    }
    const std::size_t given = found.lobes.size();
    while (!fits.empty() && found.lobes.size() < kMostLobes &&
           (found.lobes.empty() || error_of(fits, found.lobes) > kLobesSuffice)) {
        const auto lobe = next_lobe(fits, found.lobes);
        if (!lobe) break;
        found.lobes.push_back(*lobe);
        refine(fits, given, found.lobes);
    }
    auto fit = fits.begin();
    for (std::vector<Share>& shares : exact) {
        std::vector<double> by_lobe(found.lobes.size());
        for (const Share& share : shares) by_lobe[share.lobe] += share.share;
        if (shares.empty()) {
            const Fit::Found of_phase = (fit++)->with(found.lobes);
            std::ranges::copy(of_phase.share, by_lobe.begin());
            found.error = std::max(found.error, of_phase.error);
            found.amplification = std::max(found.amplification, of_phase.amplification);
        }
        found.share.push_back(std::move(by_lobe));
    }
    return found;
}

}  // namespace aphotic
