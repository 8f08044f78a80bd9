// SPDX-License-Identifier: BSD-3-Clause
//
// What of a lamp's light arrives over a path in water, and how that changes with the water:
//
//   T_c(l)  = int Phi rho e^(q1 u + q2 u^2) Q_c exp(-K l) dlambda    by way of the floor
//   V_ic(l) = int Phi b_i Q_c exp(-K l) dlambda                      by way of scatterer i
//
// rho    the rig's floor       q1, q2   by how much redder the floor of the images is
// u      wavelength, from -1 at the short end of the camera's range to 1 at the long end
//
// A floor of another colour changes how fast a channel loses light with the path, not its level
// alone: what is redder has its red at longer waves, of which water takes more.
//
// in double precision, with the derivatives over l and over the numbers of the rig's [water] that a
// fit looks for, and over q1 and q2. Symbols are those of light/path_table.h and light/veil.h.
//
// Between even steps of l each is the cubic that has values and slopes at both ends. Wavelengths
// are the middles of bands of a nanometre. Derivatives over the water are central differences of
// the whole rig read with the number kWaterStep more and less, so that any number of [water] will
// do; they err by kWaterStep^2.
#pragma once

#include "light/path_range.h"
#include "rig/file/rig_text.h"
#include "rig/rig.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr double kWaterStep = 1e-3;  // relative

// Values at even steps, with slopes, of several functions at once.
class CubicTable {
  public:
    CubicTable(double first, double last, std::size_t steps, std::size_t lanes);

    [[nodiscard]] double place(std::size_t node) const {
        return first_ + static_cast<double>(node) * step_;
    }
    [[nodiscard]] std::size_t nodes() const { return nodes_; }
    [[nodiscard]] std::size_t lanes() const { return lanes_; }
    [[nodiscard]] double& value(std::size_t node, std::size_t lane) {
        return samples_[2 * (node * lanes_ + lane)];
    }
    [[nodiscard]] double& slope(std::size_t node, std::size_t lane) {
        return samples_[2 * (node * lanes_ + lane) + 1];
    }

    // Beyond the ends as at the ends.
    void at(double x, double* values) const;
    void slopes_at(double x, double* slopes) const;

  private:
    double first_;
    double step_;
    std::size_t nodes_;
    std::size_t lanes_;
    std::vector<double> samples_;
};

// A number of [water] that the fit looks for, with its value there.
struct WaterNumber {
    std::string key;  // water.multiple
    double value = 0.0;
};

using FloorTint = std::array<double, 2>;  // q1, q2

class PathLight {
  public:
    // Of every distinct lamp spectrum of the rig, for paths up to the longest, and from the
    // shortest on that light can take. derivatives: over the numbers, which are set in the rig.
    PathLight(const RigText& rig,
              const std::vector<WaterNumber>& numbers,
              const FloorTint& colour,
              PathRange paths,
              bool has_derivatives);

    // Lanes: (version, channel), version 0 the light itself, then its derivatives by number, then
    // by q1 and q2.
    [[nodiscard]] const CubicTable& floor(std::size_t strobe) const {
        return floor_[lamp_of_strobe_[strobe]];
    }
    // Lanes: (version, scatterer, channel).
    [[nodiscard]] const CubicTable& veil(std::size_t strobe) const {
        return veil_[lamp_of_strobe_[strobe]];
    }
    // Over psi; lanes: (version, scatterer).
    [[nodiscard]] const CubicTable& phases() const { return phases_; }

    [[nodiscard]] std::size_t versions() const { return versions_; }
    [[nodiscard]] std::size_t scatterers() const { return scatterers_; }
    [[nodiscard]] const Rig& rig() const { return rig_; }

  private:
    Rig rig_;
    std::size_t versions_;
    std::size_t scatterers_;
    std::vector<std::size_t> lamp_of_strobe_;
    std::vector<CubicTable> floor_;  // by lamp spectrum
    std::vector<CubicTable> veil_;
    CubicTable phases_;
};

}  // namespace aphotic
