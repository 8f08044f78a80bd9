// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/phase_function.h"

#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace aphotic {
namespace {

using std::numbers::pi;

double square(double x) {
    return x * x;
}

double per_sr(const HenyeyGreenstein& phase, double psi_rad) {
    // 1 + g^2 - 2 g cos(psi), without cancellation.
    const double base = square(1.0 - phase.g) + 4.0 * phase.g * square(std::sin(0.5 * psi_rad));
    return (1.0 - phase.g * phase.g) / (4.0 * pi * base * std::sqrt(base));
}

double share(const HenyeyGreenstein& phase, double psi_rad) {
    const double g = phase.g;
    const double s2 = square(std::sin(0.5 * psi_rad));
    const double root = std::sqrt(square(1.0 - g) + 4.0 * g * s2);
    // (1 - g^2)/(2 g) (1/(1 - g) - 1/root), with root^2 - (1 - g)^2 = 4 g s2 divided out.
    return 2.0 * (1.0 + g) * s2 / (root * (root + 1.0 - g));
}

// The terms shared by both formulas of Fournier and Forand.
struct ForandTerms {
    double nu;
    double s2;         // sin^2(psi/2)
    double excess;     // d - 1
    double d_to_nu;    // d^nu
    double far_share;  // (1 - D^nu) / ((D - 1) D^nu)
};

ForandTerms terms_of(const FournierForand& phase, double psi_rad) {
    const double nu = 0.5 * (3.0 - phase.slope);
    const double s2 = square(std::sin(0.5 * psi_rad));
    const double per_s2 = 4.0 / (3.0 * square(phase.index - 1.0));
    const double far_to_nu = std::pow(per_s2, nu);
    return {.nu = nu,
            .s2 = s2,
            .excess = per_s2 * s2 - 1.0,
            .d_to_nu = std::pow(per_s2 * s2, nu),
            .far_share = (1.0 - far_to_nu) / ((per_s2 - 1.0) * far_to_nu)};
}

// The two brackets of p, over (1 - d)^2. At d = 1 both are 0/0: near it, by the binomial series of
// d^nu in the excess.
std::pair<double, double> forand_brackets(const ForandTerms& t) {
    constexpr double kNear = 0.02;  // whose tenth power is below rounding
    constexpr int kTerms = 10;
    if (std::abs(t.excess) > kNear) {
        const double lacks = 1.0 - t.d_to_nu;
        const double over = square(t.excess);
        return {(-t.nu * t.excess - lacks) / over,
                ((1.0 + t.excess) * lacks + t.nu * t.excess) / over};
    }
    double first = 0.0;
    double second = 0.0;
    double power = 1.0;
    double before = t.nu;  // binomial coefficients of nu: over 1, then over k
    for (int k = 2; k <= kTerms; ++k) {
        const double binomial = before * (t.nu - k + 1.0) / k;
        first += binomial * power;
        second -= (before + binomial) * power;
        power *= t.excess;
        before = binomial;
    }
    return {first, second};
}

double per_sr(const FournierForand& phase, double psi_rad) {
    const ForandTerms t = terms_of(phase, psi_rad);
    const auto [first, second] = forand_brackets(t);
    return (first + second / t.s2) / (4.0 * pi * t.d_to_nu) +
           t.far_share * (3.0 * square(std::cos(psi_rad)) - 1.0) / (16.0 * pi);
}

double share(const FournierForand& phase, double psi_rad) {
    if (psi_rad <= 0.0) return 0.0;
    const ForandTerms t = terms_of(phase, psi_rad);
    // (1 - d^x)/(1 - d), which is x at d = 1.
    const auto ratio = [&](double x) {
        return t.excess == 0.0 ? x : std::expm1(x * std::log1p(t.excess)) / t.excess;
    };
    return (ratio(t.nu + 1.0) - ratio(t.nu) * t.s2) / t.d_to_nu +
           0.125 * t.far_share * std::cos(psi_rad) * square(std::sin(psi_rad));
}

double anisotropy(const MolecularScattering& phase) {
    return (1.0 - phase.depolarisation) / (1.0 + phase.depolarisation);
}

double per_sr(const MolecularScattering& phase, double psi_rad) {
    const double P = anisotropy(phase);
    return 3.0 * (1.0 + P * square(std::cos(psi_rad))) / (4.0 * pi * (3.0 + P));
}

double share(const MolecularScattering& phase, double psi_rad) {
    const double P = anisotropy(phase);
    const double lost = 2.0 * square(std::sin(0.5 * psi_rad));  // 1 - cos
    const double cosine = 1.0 - lost;
    return 1.5 * lost * (1.0 + P * (1.0 + cosine + cosine * cosine) / 3.0) / (3.0 + P);
}

// The law between rows i and i + 1.
double between_rows(const PhaseTable& table, std::size_t i, double psi_rad) {
    const double a = table.angle_rad[i];
    const double b = table.angle_rad[i + 1];
    const double p_a = table.per_sr[i];
    const double p_b = table.per_sr[i + 1];
    if (a > 0.0 && p_a > 0.0 && p_b > 0.0)
        return p_a * std::pow(psi_rad / a, std::log(p_b / p_a) / std::log(b / a));
    return p_a + (p_b - p_a) * (psi_rad - a) / (b - a);
}

// 2 pi int p sin over a part of that interval, in the logarithm of the angle unless it is 0.
double share_between(const PhaseTable& table, std::size_t i, double from_rad, double to_rad) {
    using Gauss = boost::math::quadrature::gauss<double, 15>;
    const auto light = [&](double psi) {
        return 2.0 * pi * between_rows(table, i, psi) * std::sin(psi);
    };
    if (from_rad <= 0.0) return Gauss::integrate(light, from_rad, to_rad);
    const auto by_log = [&](double log_psi) {
        const double psi = std::exp(log_psi);
        return psi * light(psi);
    };
    return Gauss::integrate(by_log, std::log(from_rad), std::log(to_rad));
}

// The share within an angle up to the first row's, by the law of the first two rows, with sin(psi)
// to its second term.
double share_below(const PhaseTable& table, double psi_rad) {
    if (psi_rad <= 0.0) return 0.0;
    const double a = table.angle_rad[0];
    double slope = 0.0;
    if (table.per_sr[0] > 0.0 && table.per_sr[1] > 0.0)
        slope = std::log(table.per_sr[1] / table.per_sr[0]) / std::log(table.angle_rad[1] / a);
    const double at = table.per_sr[0] * std::pow(psi_rad / a, slope);
    return 2.0 * pi * at * square(psi_rad) *
           (1.0 / (2.0 + slope) - square(psi_rad) / (6.0 * (4.0 + slope)));
}

// The row before the angle, which is at least the first.
std::size_t row_before(const PhaseTable& table, double psi_rad) {
    const auto next = std::ranges::upper_bound(table.angle_rad, psi_rad);
    const auto i = static_cast<std::size_t>(next - table.angle_rad.begin());
    return std::min(i, table.angle_rad.size() - 1) - 1;
}

double per_sr(const PhaseTable& table, double psi_rad) {
    const std::size_t i = psi_rad < table.angle_rad[0] ? 0 : row_before(table, psi_rad);
    return between_rows(table, i, psi_rad);
}

double share(const PhaseTable& table, double psi_rad) {
    if (psi_rad < table.angle_rad[0]) return share_below(table, psi_rad);
    if (psi_rad >= table.angle_rad.back()) return 1.0;
    const std::size_t i = row_before(table, psi_rad);
    return table.share[i] + share_between(table, i, table.angle_rad[i], psi_rad);
}

}  // namespace

double PhaseFunction::at(double psi_rad) const {
    return std::visit([&](const auto& phase) { return per_sr(phase, psi_rad); }, kind);
}

double PhaseFunction::share_within(double psi_rad) const {
    return std::visit([&](const auto& phase) { return share(phase, psi_rad); }, kind);
}

double PhaseFunction::backscatter_ratio() const {
    return 1.0 - share_within(0.5 * pi);
}

PhaseFunction fournier_forand(double backscatter_ratio) {
    const auto of_slope = [](double slope) {
        return FournierForand{.index = 1.01 + 0.1542 * (slope - 3.0), .slope = slope};
    };
    double low = 3.01;  // scatters less backward
    double high = 5.0;
    constexpr int kHalvings = 60;
    for (int i = 0; i < kHalvings; ++i) {
        const double slope = 0.5 * (low + high);
        const bool is_less = 1.0 - share(of_slope(slope), 0.5 * pi) < backscatter_ratio;
        (is_less ? low : high) = slope;
    }
    return {.name = "fournier-forand", .kind = of_slope(0.5 * (low + high))};
}

PhaseFunction phase_table(std::string name,
                          std::vector<double> angle_rad,
                          std::vector<double> values) {
    PhaseTable table{.angle_rad = std::move(angle_rad), .per_sr = std::move(values), .share = {}};
    double sum = share_below(table, table.angle_rad[0]);
    for (std::size_t i = 0; i < table.angle_rad.size(); ++i) {
        if (i > 0) sum += share_between(table, i - 1, table.angle_rad[i - 1], table.angle_rad[i]);
        table.share.push_back(sum);
    }
    for (double& p : table.per_sr) p /= sum;
    for (double& F : table.share) F /= sum;
    return {.name = std::move(name), .kind = std::move(table)};
}

}  // namespace aphotic
