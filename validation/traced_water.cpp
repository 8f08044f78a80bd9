// SPDX-License-Identifier: BSD-3-Clause
#include "validation/traced_water.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <cmath>
#include <numbers>
#include <variant>

namespace aphotic {
namespace {

using std::numbers::pi;

double value_of(const HenyeyGreenstein& phase, double psi_rad) {
    const double g = phase.g;
    return (1.0 - g * g) / (4.0 * pi * std::pow(1.0 + g * g - 2.0 * g * std::cos(psi_rad), 1.5));
}

double value_of(const MolecularScattering& phase, double psi_rad) {
    // (1 + delta) + (1 - delta) cos^2, over its integral 4 pi (4 + 2 delta) / 3.
    const double delta = phase.depolarisation;
    const double cosine = std::cos(psi_rad);
    return 3.0 * (1.0 + delta + (1.0 - delta) * cosine * cosine) / (8.0 * pi * (2.0 + delta));
}

// The first term of the formula as printed, with d and s^2 = d (n - 1)^2 3/4.
template <typename Real>
Real forand_peak(Real d, Real nu, Real s2) {
    const Real to_nu = std::pow(d, nu);
    const Real rest = 1 - d;
    return (nu * rest - (1 - to_nu) + (d * (1 - to_nu) - nu * rest) / s2) /
           (4 * std::numbers::pi_v<Real> * rest * rest * to_nu);
}

double value_of(const FournierForand& phase, double psi_rad) {
    using Wide = long double;
    constexpr double kFarFromOne = 0.1;  // where doubles suffice
    const double nu = 0.5 * (3.0 - phase.slope);
    const double back = 4.0 / (3.0 * (phase.index - 1.0) * (phase.index - 1.0));
    const double half_sine = std::sin(0.5 * psi_rad);
    const double d = back * half_sine * half_sine;
    const auto wide = [&](Wide at) { return forand_peak<Wide>(at, nu, at / back); };
    double peak = 0.0;
    if (std::abs(d - 1.0) > kFarFromOne) {
        peak = forand_peak<double>(d, nu, half_sine * half_sine);
    } else if (std::abs(d - 1.0) > kForandNear) {
        peak = static_cast<double>(wide(d));
    } else {
        constexpr Wide kForandStep = 0.01L;
        const auto both = [&](int k) {
            return wide(d + k * kForandStep) + wide(d - k * kForandStep);
        };
        peak = static_cast<double>((15.0L * both(1) - 6.0L * both(2) + both(3)) / 20.0L);
    }
    const double back_to_nu = std::pow(back, nu);
    const double cosine = std::cos(psi_rad);
    return peak + (1.0 - back_to_nu) / (16.0 * pi * (back - 1.0) * back_to_nu) *
                      (3.0 * cosine * cosine - 1.0);
}

// As measured, not scaled: linear in log-log if possible, otherwise linear.
double value_of(const PhaseTable& table, double psi_rad) {
    const auto& angles = table.angle_rad;
    std::size_t i = 0;
    while (i + 2 < angles.size() && psi_rad >= angles[i + 1]) ++i;
    const double below = table.per_sr[i];
    const double above = table.per_sr[i + 1];
    if (angles[i] > 0.0 && below > 0.0 && above > 0.0) {
        const double along = (std::log(psi_rad) - std::log(angles[i])) /
                             (std::log(angles[i + 1]) - std::log(angles[i]));
        return std::exp(std::lerp(std::log(below), std::log(above), along));
    }
    return std::lerp(below, above, (psi_rad - angles[i]) / (angles[i + 1] - angles[i]));
}

double unscaled(const PhaseFunction& phase, double psi_rad) {
    return std::visit([&](const auto& kind) { return value_of(kind, psi_rad); }, phase.kind);
}

// 2 pi int p sin dpsi, over the logarithm of the angle, since forward peaks are power laws.
double share_between(const PhaseFunction& phase, double from_rad, double to_rad) {
    using Adaptive = boost::math::quadrature::gauss_kronrod<double, 31>;
    constexpr unsigned kDepth = 12;
    constexpr double kError = 1e-13;
    return Adaptive::integrate(
        [&](double log_psi) {
            const double psi = std::exp(log_psi);
            return 2.0 * pi * psi * std::sin(psi) * unscaled(phase, psi);
        },
        std::log(from_rad),
        std::log(to_rad),
        kDepth,
        kError);
}

}  // namespace

double light_left(double depth) {
    return depth < kBlackDepth ? std::exp(-depth) : 0.0;
}

Eigen::ArrayXd light_left(const Eigen::ArrayXd& depth) {
    return (depth < kBlackDepth).select((-depth).exp(), 0.0);
}

TracedPhase::TracedPhase(const PhaseFunction& phase) : phase_(phase) {
    if (const auto* table = std::get_if<PhaseTable>(&phase.kind)) {
        kinks_rad_ = table->angle_rad;
        constexpr double kNoAngle = 1e-30;  // within which a table has negligible light
        scale_ = 1.0 / share_beyond(kNoAngle);
    }
}

double TracedPhase::at(double psi_rad) const {
    return scale_ * unscaled(phase_, psi_rad);
}

double TracedPhase::share_beyond(double psi_rad) const {
    double sum = 0.0;
    double from_rad = psi_rad;
    for (const double kink_rad : kinks_rad_) {
        if (kink_rad <= from_rad || kink_rad >= pi) continue;
        sum += share_between(phase_, from_rad, kink_rad);
        from_rad = kink_rad;
    }
    return from_rad < pi ? scale_ * (sum + share_between(phase_, from_rad, pi)) : 0.0;
}

TracedWater::TracedWater(const Water& water) : water_(water) {
    if (water.multiple == 0.0) return;
    for (const Scatterer& scatterer : water.scatterers) {
        phases_.emplace_back(scatterer.phase);
        lost_.push_back(phases_.back().share_beyond(kLossCut));
    }
}

double TracedWater::loss_per_m(double lambda_nm) const {
    if (water_.multiple == 0.0) return water_.uniform_loss_per_m;
    double loss = water_.absorption_per_m.at(lambda_nm);
    for (std::size_t i = 0; i < lost_.size(); ++i)
        loss += lost_[i] * water_.scatterers[i].scattering_per_m.at(lambda_nm);
    return water_.multiple * loss + water_.uniform_loss_per_m;
}

double TracedWater::scattering_per_m(std::size_t scatterer, double lambda_nm) const {
    return water_.multiple * water_.scatterers[scatterer].scattering_per_m.at(lambda_nm);
}

}  // namespace aphotic
