// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/natural_water.h"

#include "spectral/curve_loader.h"
#include "spectral/refractive_index.h"
#include "spectral/seawater_scattering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace aphotic {
namespace {

constexpr double kStep_nm = 5.0;  // a straight line between them errs by 1e-4 of b_sw

constexpr WavelengthRange kPhytoplankton_nm{400.0, 700.0};
constexpr double kPhytoplanktonStep_nm = 10.0;
constexpr std::array kPhytoplankton{0.687, 0.828, 0.913, 0.973, 1.000, 0.944, 0.917, 0.870,
                                    0.798, 0.750, 0.668, 0.618, 0.528, 0.474, 0.416, 0.357,
                                    0.294, 0.276, 0.291, 0.282, 0.236, 0.252, 0.276, 0.317,
                                    0.334, 0.356, 0.441, 0.595, 0.502, 0.329, 0.215};

Spectrum pure_water() {
    return load_curve("pure-2016", CurveRole::WaterAbsorption, {});
}

Spectrum phytoplankton() {
    std::vector<double> lambda_nm;
    for (std::size_t i = 0; i < kPhytoplankton.size(); ++i) {
        lambda_nm.push_back(kPhytoplankton_nm.first_nm +
                            kPhytoplanktonStep_nm * static_cast<double>(i));
    }
    return {"absorption of phytoplankton",
            std::move(lambda_nm),
            {kPhytoplankton.begin(), kPhytoplankton.end()}};
}

Spectrum sampled(const std::string& name,
                 std::vector<double> lambda_nm,
                 const std::function<double(double)>& value) {
    std::vector<double> values;
    for (const double nm : lambda_nm) values.push_back(value(nm));
    return {name, std::move(lambda_nm), std::move(values)};
}

std::vector<double> even_steps(WavelengthRange range) {
    std::vector<double> lambda_nm;
    for (double nm = range.first_nm; nm < range.last_nm; nm += kStep_nm) lambda_nm.push_back(nm);
    lambda_nm.push_back(range.last_nm);
    return lambda_nm;
}

// The constituents of a water type besides water, at the type's own wavelengths.
Spectrum besides(const Spectrum& all, const std::function<double(double)>& water) {
    return sampled(all.name(), {all.lambda_nm().begin(), all.lambda_nm().end()}, [&](double nm) {
        return std::max(0.0, all.at(nm) - water(nm));
    });
}

constexpr double kPeak_nm = 440.0;

double of_plankton_per_m(double chlorophyll_mg_m3) {
    return 0.06 * std::pow(chlorophyll_mg_m3, 0.65);
}

}  // namespace

double case_1_cdom_440_per_m(double chlorophyll_mg_m3) {
    return 0.2 * (pure_water().at(kPeak_nm) + of_plankton_per_m(chlorophyll_mg_m3));
}

Scatterer seawater_scatterer(double salinity_psu, double temperature_c) {
    return {sampled("scattering of sea water",
                    even_steps(kSeawaterIndexRange),
                    [&](double nm) {
                        return seawater_scattering_per_m(nm, salinity_psu, temperature_c);
                    }),
            {.name = "sea water", .kind = MolecularScattering{}}};
}

void take_type(const Spectrum& absorption,
               const Spectrum& scattering,
               const PhaseFunction& particles,
               Water& water) {
    const Spectrum pure = pure_water();
    const Spectrum dissolved = besides(absorption, [&](double nm) { return pure.at(nm); });
    const std::array<const Spectrum*, 2> both{&pure, &absorption};
    const std::vector<double> knots_nm = union_of_knots(both, common_range(both));
    water.absorption_per_m = sampled(
        absorption.name(), knots_nm, [&](double nm) { return pure.at(nm) + dissolved.at(nm); });
    water.scatterers.push_back(seawater_scatterer(water.salinity_psu, water.temperature_c));
    const Spectrum& molecules = water.scatterers.back().scattering_per_m;
    water.scatterers.push_back(
        {besides(scattering, [&](double nm) { return molecules.at(nm); }), particles});
}

void take_constituents(const Constituents& constituents, Water& water) {
    constexpr double kParticles_nm = 550.0;
    constexpr double kClear = 2.0;  // Chl from which b_p is flat over wavelength
    const double chl = constituents.chlorophyll_mg_m3;
    const double log_chl = std::log10(chl);
    const Spectrum pure = pure_water();
    const Spectrum shape = phytoplankton();
    const double of_plankton = of_plankton_per_m(chl);
    const double a_440 = constituents.cdom_440_per_m.value_or(case_1_cdom_440_per_m(chl));
    const std::array<const Spectrum*, 2> both{&pure, &shape};
    water.absorption_per_m = sampled(
        "absorption of case-1 water", union_of_knots(both, kPhytoplankton_nm), [&](double nm) {
            return pure.at(nm) + of_plankton * shape.at(nm) +
                   a_440 * std::exp(-0.014 * (nm - kPeak_nm));
        });
    water.scatterers.push_back(seawater_scatterer(water.salinity_psu, water.temperature_c));
    const double slope = chl < kClear ? 0.5 * (log_chl - 0.3) : 0.0;
    const double at_550 = constituents.particles * 0.416 * std::pow(chl, 0.766);
    water.scatterers.push_back(
        {sampled("scattering of case-1 particles",
                 even_steps(kPhytoplankton_nm),
                 [&](double nm) { return at_550 * std::pow(nm / kParticles_nm, slope); }),
         fournier_forand(0.002 + 0.01 * (0.5 - 0.25 * log_chl))});
}

}  // namespace aphotic
