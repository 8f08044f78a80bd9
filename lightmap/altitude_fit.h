// SPDX-License-Identifier: BSD-3-Clause
//
// The light of one pixel over altitude, in the form that survey correctors use:
//
//   S(h) ~ a exp(b h) + c
//
// h  altitude [m]      a, c  in the unit of S      b  1/m
//
// by least squares with a >= 0, b <= 0, 0 <= c <= the least S, since a corrector divides by the
// fit, which must not cross zero. For a given b the problem is a straight line over exp(b h): c is
// clipped to its range and a follows, which is exact, since the squares are convex. So only b is
// searched: first over kRates rates, in even ratios from kSlowest to kFastest over the span of
// altitudes, but no faster than kMostExponent over the last altitude, beyond which a and exp(b h)
// would no longer be floats; then by golden section between the neighbours of the best. The result
// is the best of all rates, unless the residual has several minima between two rates. Light that
// increases with altitude is fitted by its mean, at b = 0.
//
// residual  rms of the residuals over the mean of S
#pragma once

#include <array>
#include <span>
#include <vector>

namespace aphotic {

struct AltitudeFit {
    double a = 0.0;
    double b_per_m = 0.0;
    double c = 0.0;
    double residual = 0.0;
};

class AltitudeFitter {
  public:
    // At least four altitudes, increasing, spanning at least a share of kSlowest / kMostExponent of
    // the last.
    explicit AltitudeFitter(std::vector<double> altitude_m);

    [[nodiscard]] AltitudeFit fit(std::span<const double> signal) const;

    static constexpr int kRates = 24;
    static constexpr double kSlowest = 0.1;
    static constexpr double kFastest = 30.0;
    static constexpr double kMostExponent = 80.0;

  private:
    // exp(b (h - the first h)) = mean + length shape, with shape of mean 0 and length 1.
    struct Rate {
        double b_per_m;
        double mean = 0.0;
        double length = 0.0;
        std::vector<double> shape{};
    };
    [[nodiscard]] Rate rate(double b_per_m) const;
    void state_residual(AltitudeFit& fit, std::span<const double> signal) const;

    std::vector<double> altitude_m_;
    std::vector<Rate> rates_;  // in the order of b
};

}  // namespace aphotic
