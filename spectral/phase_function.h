// SPDX-License-Identifier: BSD-3-Clause
//
// The directions of scattered light.
//
//   p(psi)   share of the scattered light per solid angle at the scattering angle psi     [1/sr]
//   F(psi)   share within psi:   F(psi) = 2 pi int_0^psi p(psi') sin(psi') dpsi',   F(pi) = 1
//
// Henyey and Greenstein's, with the mean cosine g:
//
//   p = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos(psi))^1.5)
//
// Fournier and Forand (1994, in the form of Fournier and Jonasz 1999), for particles of relative
// index n whose sizes follow a power law of slope mu:
//
//   p = ( nu (1 - d) - (1 - d^nu) + (d (1 - d^nu) - nu (1 - d)) / s^2 ) / (4 pi (1 - d)^2 d^nu)
//       + (1 - D^nu) (3 cos^2(psi) - 1) / (16 pi (D - 1) D^nu)
//
// with nu = (3 - mu)/2, s = sin(psi/2), d = 4 s^2 / (3 (n - 1)^2), and D = d at psi = pi. F is
// known in closed form. fournier_forand() has one parameter, the backscattered share, along the
// line n = 1.01 + 0.1542 (mu - 3) (Mobley, Sundman and Boss 2002).
//
// Molecular, by sea water itself, with the depolarisation ratio delta (0.039, Zhang, Hu and He
// 2009):
//
//   p = 3 (1 + P cos^2(psi)) / (4 pi (3 + P)),      P = (1 - delta)/(1 + delta)
//
// Table: a power law of the angle between neighbouring rows, extended from the first two rows below
// the first; linear where a row has angle or value 0. It is scaled to F(pi) = 1.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace aphotic {

struct HenyeyGreenstein {
    double g = 0.0;  // -1 to 1, both excluded
};

struct FournierForand {
    double index = 1.1;   // n, above 1
    double slope = 3.58;  // mu, above 3
};

struct MolecularScattering {
    double depolarisation = 0.039;
};

struct PhaseTable {
    std::vector<double> angle_rad;  // increasing, the last is pi
    std::vector<double> per_sr;     // scaled
    std::vector<double> share;      // F at each angle
};

struct PhaseFunction {
    std::string name;  // as in the rig file
    std::variant<HenyeyGreenstein, FournierForand, MolecularScattering, PhaseTable> kind{};

    [[nodiscard]] double at(double psi_rad) const;
    [[nodiscard]] double share_within(double psi_rad) const;

    // b_b/b: the share scattered by more than 90 degrees.
    [[nodiscard]] double backscatter_ratio() const;
};

// The function on the line above; the ratio lies within kLeastBackscatter and kMostBackscatter.
[[nodiscard]] PhaseFunction fournier_forand(double backscatter_ratio);
inline constexpr double kLeastBackscatter = 0.0005;
inline constexpr double kMostBackscatter = 0.4;

// Angles from 0 or more up to pi, increasing; values not negative, of any scale, not all 0.
[[nodiscard]] PhaseFunction phase_table(std::string name,
                                        std::vector<double> angle_rad,
                                        std::vector<double> values);

}  // namespace aphotic
