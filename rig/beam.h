// SPDX-License-Identifier: BSD-3-Clause
//
// How a strobe's light is spread over directions: all that may be asked of a beam.
//
//   I(w)   intensity in the direction w, per unit of the lamp's power   [1/sr]
//
// A beam is a sum of cones about the strobe's axis. With theta the angle off it,
//
//   I = sum of A_k cos^n_k(theta) over the cones with theta <= gamma_k, theta < 90 degrees
//
//   flux:     A_k = alpha_k (n + 1) / (2 pi (1 - cos^(n + 1) gamma_k)), so that the cone carries
//             alpha_k of the flux; for n = 1, alpha_k / (pi sin^2 gamma_k)
//   literal:  A_k = alpha_k, as the source paper prints it
//
// Whoever wants to know of a beam asks here, and knows no kind of it. Three read the cones
// themselves: the rig's reader, scene_gen/beam_sdl.h for POV-Ray, and the reference (validation/),
// which computes light from what the rig says and nothing else.
#pragma once

#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

namespace aphotic {

// Light within half_angle_rad of the axis.
struct Cone {
    std::string part;
    double half_angle_rad = 0.0;
    double weight = 0.0;    // alpha_k
    double exponent = 1.0;  // n

    [[nodiscard]] bool operator==(const Cone&) const = default;
};

// What a cone's weight means: its share of the lamp's flux, or its intensity on the axis.
enum class ConeWeights { Flux, Literal };

struct Beam {
    std::string name;
    ConeWeights weights = ConeWeights::Flux;
    std::vector<Cone> cones;

    [[nodiscard]] bool operator==(const Beam&) const = default;
};

// How a beam, and an emitter, lies in the sled's frame: unit vectors. `along` is the sled's forward
// direction as the plane across the axis sees it (down, for an axis within a millionth of a radian
// of fore or aft, where forward is all but lost in rounding), across = axis x along. aphotic.inc
// has the same rule.
struct BeamFrame {
    Eigen::Vector3d axis;
    Eigen::Vector3d along;
    Eigen::Vector3d across;
};
[[nodiscard]] BeamFrame frame_about(const Eigen::Vector3d& axis);
inline constexpr double kForeAndAftSine = 1e-6;

// Directions `towards` are in the sled's frame, of any length.

[[nodiscard]] double intensity_towards(const Beam& beam,
                                       const BeamFrame& frame,
                                       const Eigen::Vector3d& towards);

// The same as though what lights the direction `from` had no edge: where a small turn crosses
// none, it is I itself.
[[nodiscard]] double continued_intensity(const Beam& beam,
                                         const BeamFrame& frame,
                                         const Eigen::Vector3d& towards,
                                         const Eigen::Vector3d& from);

// Bound of I over all directions within an angle of this one, and over all there are.
[[nodiscard]] double most_intensity(const Beam& beam,
                                    const BeamFrame& frame,
                                    const Eigen::Vector3d& towards,
                                    double within_rad);
[[nodiscard]] double most_intensity(const Beam& beam);

// Whether there is light within an angle of this direction, and whether there is any.
[[nodiscard]] bool reaches(const Beam& beam,
                           const BeamFrame& frame,
                           const Eigen::Vector3d& towards,
                           double within_rad);
[[nodiscard]] bool is_dark(const Beam& beam);

// The angles off the axis where I has a step, or falls as steeply as one: cos^n goes to 0 at 90
// degrees, so there a cone has an edge if n < 1 alone.
[[nodiscard]] std::vector<double> edges_rad(const Beam& beam);

// The same light carried on to 90 degrees.
[[nodiscard]] Beam without_edges(Beam beam);

// I falls no steeper off the axis than cos to this power: (ln I)' >= n (ln cos)', away from edges.
[[nodiscard]] double steepest_exponent(const Beam& beam);

// The flux of a lamp of power 1: the integral of I over all directions.
[[nodiscard]] double flux_of(const Beam& beam);

// What adds up to the beam: its cones, each a beam with the cone's name.
[[nodiscard]] std::vector<Beam> parts_of(const Beam& beam);
// The beam of those that are wanted.
[[nodiscard]] Beam parts_that(const Beam& beam, const std::function<bool(const Beam&)>& is_wanted);

// The beam as plain numbers, for loops over many directions:
//
//   I = sum of on_axis cos^exponent(theta) over the lobes with cos(theta) >= edge_cosine
struct Lobe {
    double edge_cosine = 0.0;
    double on_axis = 0.0;  // [1/sr]
    double exponent = 1.0;
};
[[nodiscard]] std::vector<Lobe> lobes_of(const Beam& beam);

// Beams of the same signature shine alike. Names do not count.
[[nodiscard]] std::string beam_signature(const Beam& beam);

}  // namespace aphotic
