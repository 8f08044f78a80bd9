// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/seawater_scattering.h"

#include "spectral/phase_function.h"
#include "spectral/refractive_index.h"

#include <cmath>
#include <initializer_list>
#include <numbers>

namespace aphotic {
namespace {

// c0 + c1 x + c2 x^2 + ...
double polynomial(double x, std::initializer_list<double> coefficients) {
    double sum = 0.0;
    double power = 1.0;
    for (const double c : coefficients) {
        sum += c * power;
        power *= x;
    }
    return sum;
}

double air_index(double lambda_nm) {
    const double per_um2 = 1e6 / (lambda_nm * lambda_nm);
    return 1.0 + (5792105.0 / (238.0185 - per_um2) + 167917.0 / (57.362 - per_um2)) * 1e-8;
}

// [1/Pa]
double compressibility(double S, double T) {
    const double water = polynomial(T, {19652.21, 148.4206, -2.327105, 1.360477e-2, -5.155288e-5});
    const double salt = polynomial(T, {54.6746, -0.603459, 1.09987e-2, -6.167e-5});
    const double mixed = polynomial(T, {7.944e-2, 1.6483e-2, -5.3009e-4});
    constexpr double kPascalPerBar = 1e5;
    return 1.0 / (kPascalPerBar * (water + salt * S + mixed * std::pow(S, 1.5)));
}

// [kg/m^3]
double density(double S, double T) {
    return polynomial(
               T, {999.842594, 6.793952e-2, -9.09529e-3, 1.001685e-4, -1.120083e-6, 6.536332e-9}) +
           polynomial(T, {8.24493e-1, -4.0899e-3, 7.6438e-5, -8.2467e-7, 5.3875e-9}) * S +
           polynomial(T, {-5.72466e-3, 1.0227e-4, -1.6546e-6}) * std::pow(S, 1.5) +
           4.8314e-4 * S * S;
}

double activity_slope(double S, double T) {
    return polynomial(T, {-5.58651e-4, 2.40452e-7, -3.12165e-9, 2.40808e-11}) +
           1.5 * polynomial(T, {1.79613e-5, -9.9422e-8, 2.08919e-9, -1.39872e-11}) * std::sqrt(S) +
           2.0 * polynomial(T, {-2.31065e-6, -1.37674e-9, -1.93316e-11}) * S;
}

}  // namespace

double seawater_scattering_per_m(double lambda_nm, double salinity_psu, double temperature_c) {
    using std::numbers::pi;
    constexpr double kBoltzmann = 1.3806503e-23;   // [J/K], the authors' value
    constexpr double kAvogadro = 6.0221417930e23;  // [1/mol]
    constexpr double kWater_kg_per_mol = 0.018;
    constexpr double kZero_k = 273.15;
    const double delta = MolecularScattering{}.depolarisation;

    const double S = salinity_psu;
    const double T = temperature_c;
    const double air = air_index(lambda_nm);
    const double n = air * seawater_index(lambda_nm, S, T);
    // The index is linear in S.
    const double per_psu =
        air * (seawater_index(lambda_nm, 1.0, T) - seawater_index(lambda_nm, 0.0, T));
    const double n2 = n * n;
    const double density_slope =
        (n2 - 1.0) * (1.0 + 2.0 / 3.0 * (n2 + 2.0) * std::pow(n / 3.0 - 1.0 / (3.0 * n), 2));
    const double per_l4 = std::pow(lambda_nm * 1e-9, -4);
    const double f = (6.0 + 6.0 * delta) / (6.0 - 7.0 * delta);
    const double by_density = 0.5 * pi * pi * per_l4 * density_slope * density_slope * kBoltzmann *
                              (T + kZero_k) * compressibility(S, T) * f;
    const double by_salt = 2.0 * pi * pi * per_l4 * n2 * per_psu * per_psu * S * kWater_kg_per_mol /
                           (density(S, T) * kAvogadro * -activity_slope(S, T)) * f;
    return 8.0 * pi / 3.0 * (by_density + by_salt) * (2.0 + delta) / (1.0 + delta);
}

}  // namespace aphotic
