// SPDX-License-Identifier: BSD-3-Clause
//
// Light of all orders of scattering over the rig's flat floor, at one wavelength, by random paths
// from the camera: the truth for the model's K and single scattering (spectral/water.h,
// light/veil.h).
//
// A path leaves the camera along a pixel's ray. It is scattered at rate b_t, by an angle from the
// phase function; at the floor it is reflected as by a Lambertian surface; along its length it is
// attenuated by a. From each vertex x, lamps are connected in two ways:
//
//   at the floor    straight to the lamp:  rho/pi cos(i) I exp(-c d) / d^2
//   over one turn   to a point y and from there to the lamp, with psi the turn at y:
//                   f(x, y) b_t P(psi) I exp(-c (s + d)) / d^2
//
// s from x to y, d from y to the lamp, D from x to the lamp, alpha the angle at x between y and the
// lamp, h = D sin(alpha). y is drawn in three ways: along the path's own next direction, evenly
// over the angle phi at the lamp; by psi from P and alpha evenly from 0 to psi; and evenly over
// directions from the lamp and distances up to D. By direction and length, d^2 times their
// densities are f h / dphi, P sin(psi)/psi D and s^2 / (4 pi D) within D of the lamp, so that
// neither the lamp's 1/d^2 nor the phase function's peak is left in the weight
//
//   b_t I exp(-c (s + d)) f P / (f h / dphi + P sin(psi)/psi D + s^2 / (4 pi D))
//
// (Veach and Guibas's balance heuristic, SIGGRAPH 1995). From the camera itself, whose ray has one
// direction, y is even over the angle at the lamp.
//
// b_t, c   scattering by kLeastTurn or more, and a + b_t [1/m]; smaller deflections are not
//          followed, since the light arrives within 4 cm per metre of its undeflected path
// floor    light that was reflected by the floor; veil: light that was not
// tail     the light of turns beyond most_turns. Where water and floor absorb nothing, a path
//          returns as a random walk does, and its n-th turn contributes as n^(-3/2): all later
//          turns together contribute 1/(sqrt(2) - 1) times as much as the second half of the turns
//          followed. Any absorption reduces it.
//
// The same seed gives the same bits. A standard error is that of the mean, from the spread of the
// paths. Limits: no objects, no highlight; no sea surface.
#pragma once

#include "rig/rig.h"
#include "validation/traced_beam.h"
#include "validation/traced_veil.h"
#include "validation/traced_water.h"
#include "validation/turn_table.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace aphotic {

inline constexpr double kLeastTurn = 2.0 * std::numbers::pi / 180.0;
// In natural water a path ends after some tens of turns; in water without absorption it may never
// end.
inline constexpr int kMostTurns = 250;

struct MonteCarloOptions {
    std::size_t paths = 10000;
    std::uint64_t seed = 1;
    // Scatterings of a path; fewer to examine single orders.
    int most_turns = kMostTurns;
    double least_turn_rad = kLeastTurn;
};

struct Estimate {
    double mean = 0.0;
    double standard_error = 0.0;
};

struct LightOfAllOrders {
    Estimate floor;
    Estimate veil;
    Estimate sum;  // of both, from the same paths
    double tail = 0.0;
};

class MonteCarlo {
  public:
    // Throws InputError if the rig has objects or a highlight.
    MonteCarlo(const Rig& rig, double lambda_nm, const MonteCarloOptions& options);

    // Radiance along the ray, to the floor at its end; infinite length: no floor in view. stream:
    // selects the random numbers, different for each ray.
    [[nodiscard]] LightOfAllOrders radiance(const VeilRay& ray, std::uint64_t stream) const;

  private:
    struct Source {
        TracedBeam beam;
        Eigen::Vector3d position_m;
        Eigen::Vector3d across_m;  // of the emitter, its whole width
        Eigen::Vector3d along_m;
        double flux;  // Phi power
    };
    class Dice;
    struct Path;

    Rig rig_;
    MonteCarloOptions options_;
    TurnTable turns_;
    double attenuation_per_m_;  // c
    double reflectance_;
    Eigen::Vector3d down_;
    std::vector<Source> sources_;
};

}  // namespace aphotic
