// SPDX-License-Identifier: BSD-3-Clause
//
// Scattering by sea water itself, without particles, by fluctuations of density and salinity.
//
//   b = (8 pi / 3) beta_90 (2 + delta)/(1 + delta),      beta_90 = beta_density + beta_salt
//   beta_density = pi^2/2 l^-4 (rho dn^2/drho)^2 k T beta_T f
//   beta_salt    = 2 pi^2 l^-4 n^2 (dn/dS)^2 S M_w / (rho N_A (-dln a_w/dS)) f
//
// b        scattering coefficient [1/m]     l     wavelength in vacuo [m]
// n        refractive index in vacuo        rho   density [kg/m^3]
// beta_T   isothermal compressibility       a_w   activity of the water
// delta    depolarisation ratio, 0.039      f     (6 + 6 delta)/(6 - 7 delta)
//
// Half of it is backscattered; its phase function is MolecularScattering. Stated accuracy: 2 % of
// the available measurements, for 0-40 psu and 0-30 C at atmospheric pressure; the index and its
// range are those of refractive_index.h.
//
// X. Zhang, L. Hu, M.-X. He, "Scattering by pure seawater: effect of salinity", Optics Express 17,
// 5698 (2009), with X. Zhang and L. Hu, ibid., 1671; compressibility: Millero 1980, density: UNESCO
// 1981, activity: Millero and Leung 1976, d(n^2)/drho: Proutiere et al. 1992, air: Ciddor 1996.
#pragma once

namespace aphotic {

[[nodiscard]] double seawater_scattering_per_m(double lambda_nm,
                                               double salinity_psu,
                                               double temperature_c);

}  // namespace aphotic
