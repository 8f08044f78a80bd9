// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/lamp_flux.h"

#include "base/error.h"
#include "spectral/curve_loader.h"

#include <array>
#include <functional>

namespace aphotic {

namespace {

// Integrates a function that is at most quadratic between the curves' knots, by Simpson's rule.
double integral(std::span<const Spectrum* const> curves,
                WavelengthRange range,
                const std::function<double(double)>& value) {
    if (range.first_nm >= range.last_nm) return 0.0;
    const std::vector<double> knots_nm = union_of_knots(curves, range);
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < knots_nm.size(); ++i) {
        const double a = knots_nm[i];
        const double b = knots_nm[i + 1];
        sum += (b - a) / 6.0 * (value(a) + 4.0 * value(0.5 * (a + b)) + value(b));
    }
    return sum;
}

}  // namespace

double radiant_flux_w(const Spectrum& lamp) {
    const std::array<const Spectrum*, 1> curves{&lamp};
    return integral(curves, lamp.range(), [&](double nm) { return lamp.at(nm); });
}

double luminous_flux_lm(const Spectrum& lamp) {
    const std::vector<Spectrum> observer = load_curves("cie-1931", CurveRole::ColourMatching, {});
    const Spectrum& V = observer.at(1);
    const std::array<const Spectrum*, 2> curves{&lamp, &V};
    const WavelengthRange common = common_range(curves);
    const auto efficiency = [&](double nm) { return V.at(nm); };
    const double unseen = 1.0 - integral(curves, common, efficiency) /
                                    integral({&curves[1], 1}, V.range(), efficiency);
    if (unseen > kMostUnseen) {
        throw InputError(
            "{}: found a range of {:g} to {:g} nm, which leaves out {:.1f} % of the luminous flux; "
            "allowed: up to {:.1f} %",
            lamp.name(),
            lamp.range().first_nm,
            lamp.range().last_nm,
            100.0 * unseen,
            100.0 * kMostUnseen);
    }
    return kLumensPerWatt *
           integral(curves, common, [&](double nm) { return lamp.at(nm) * V.at(nm); });
}

}  // namespace aphotic
