// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/altitude_fit.h"

#include "base/error.h"

#include <fmt/format.h>
#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace aphotic {
namespace {

double mean_of(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double product(std::span<const double> a, std::span<const double> b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

}  // namespace

AltitudeFitter::AltitudeFitter(std::vector<double> altitude_m)
    : altitude_m_(std::move(altitude_m)) {
    constexpr std::size_t kLeast = 4;
    if (altitude_m_.size() < kLeast) {
        throw InputError("a fit over altitude: found {} altitudes; allowed: {} or more",
                         altitude_m_.size(),
                         kLeast);
    }
    const double span_m = altitude_m_.back() - altitude_m_.front();
    const double slowest_per_m = kSlowest / span_m;
    const double fastest_per_m = std::min(kFastest / span_m, kMostExponent / altitude_m_.back());
    if (fastest_per_m <= slowest_per_m) {
        throw InputError(
            "a fit over altitude: found altitudes from {:.6g} to {:.6g} m; allowed: a span of "
            "{:.3g} m or more",
            altitude_m_.front(),
            altitude_m_.back(),
            kSlowest / kMostExponent * altitude_m_.back());
    }
    for (int i = kRates; i-- > 0;) {
        const double size =
            slowest_per_m * std::pow(fastest_per_m / slowest_per_m, i / (kRates - 1.0));
        rates_.push_back(rate(-size));
    }
}

AltitudeFitter::Rate AltitudeFitter::rate(double b_per_m) const {
    Rate rate{.b_per_m = b_per_m};
    for (const double h_m : altitude_m_)
        rate.shape.push_back(std::exp(b_per_m * (h_m - altitude_m_.front())));
    rate.mean = mean_of(rate.shape);
    for (double& value : rate.shape) value -= rate.mean;
    rate.length = std::sqrt(product(rate.shape, rate.shape));
    for (double& value : rate.shape) value /= rate.length;
    return rate;
}

void AltitudeFitter::state_residual(AltitudeFit& fit, std::span<const double> signal) const {
    double squares = 0.0;
    for (std::size_t i = 0; i < signal.size(); ++i) {
        const double left = signal[i] - (fit.a * std::exp(fit.b_per_m * altitude_m_[i]) + fit.c);
        squares += left * left;
    }
    fit.residual = std::sqrt(squares / static_cast<double>(signal.size())) / mean_of(signal);
}

AltitudeFit AltitudeFitter::fit(std::span<const double> signal) const {
    const double mean = mean_of(signal);
    if (!(mean > 0.0)) return {};
    const auto n = static_cast<double>(signal.size());
    const double most_c = std::max(0.0, *std::ranges::min_element(signal));
    struct Line {
        double a;  // of exp(b (h - at))
        double c;
        double squares;  // squared residuals, less the squares of the signal
    };
    const auto line_over = [&](const Rate& rate) {
        const double part = product(rate.shape, signal);
        const double basis = n * rate.mean;
        const double basis_squares = basis * rate.mean + rate.length * rate.length;
        const double common = basis * mean + rate.length * part;
        const double c = std::clamp(mean - part / rate.length * rate.mean, 0.0, most_c);
        const double a = std::max(0.0, (common - c * basis) / basis_squares);
        const double squares = a * a * basis_squares + n * c * c + 2.0 * a * c * basis -
                               2.0 * (a * common + c * n * mean);
        return Line{.a = a, .c = c, .squares = squares};
    };
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < rates_.size(); ++i) {
        const double found = line_over(rates_[i]).squares;
        if (found < least) best = i, least = found;
    }
    constexpr int kBits = 16;
    const double b_per_m =
        boost::math::tools::brent_find_minima([&](double b) { return line_over(rate(b)).squares; },
                                              rates_[best > 0 ? best - 1 : best].b_per_m,
                                              rates_[std::min(best + 1, rates_.size() - 1)].b_per_m,
                                              kBits)
            .first;
    const Rate found = rate(b_per_m);
    const Line line = line_over(found);
    AltitudeFit fit{.a = mean};
    if (line.squares < -n * mean * mean) {
        fit = {.a = line.a * std::exp(-b_per_m * altitude_m_.front()),
               .b_per_m = b_per_m,
               .c = line.c};
    }
    state_residual(fit, signal);
    return fit;
}

}  // namespace aphotic
