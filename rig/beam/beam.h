// SPDX-License-Identifier: BSD-3-Clause
//
// The distribution of a strobe's light over directions, and all properties of a beam.
//
//   I(w)   intensity in the direction w, per unit of the lamp's power   [1/sr]
//
// A beam is a sum of cones about the strobe's axis, or a pattern: a measured table
// (rig/beam/beam_table.h) or the image of a diffuser through a lens (rig/beam/beam_optics.h).
// Either may have been measured in air, behind a window (rig/beam/beam_window.h). With theta the
// angle off the axis, cones are
//
//   I = sum of A_k cos^n_k(theta) S_k(theta) over the cones with theta <= gamma_k, theta < 90
//   degrees
//
//   S_k       1 up to gamma_k - edge_k, then t^2 (3 - 2 t), down to 0 at gamma_k, with t linear in
//             the cosine; 1 up to gamma_k if edge_k = 0
//   flux:     A_k = alpha_k / (integral of cos^n S over all directions), so that the cone carries
//             alpha_k of the flux; for n = 1 without a soft edge, alpha_k / (pi sin^2 gamma_k)
//   literal:  A_k = alpha_k, as the source paper prints it
//
// A pattern is scaled to a flux of 1, in air if it was measured there; light that the window
// reflects is lost.
//
// Callers use these functions and do not know a beam's kind. Three use the kinds directly: the
// rig's reader, scene_gen/beam_sdl.h for POV-Ray, and the reference (validation/), which computes
// light from the rig's description only. A new kind is a file next to rig/beam/beam_table.h, a case
// in rig/beam/beam.cpp, and these three.
#pragma once

#include "rig/beam/beam_optics.h"
#include "rig/beam/beam_table.h"
#include "rig/beam/beam_window.h"

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace aphotic {

// Light within half_angle_rad of the axis.
struct Cone {
    std::string part;
    double half_angle_rad = 0.0;
    double weight = 0.0;    // alpha_k
    double exponent = 1.0;  // n
    double edge_rad = 0.0;  // the falloff to 0, up to half_angle_rad

    [[nodiscard]] bool operator==(const Cone&) const = default;
};

// The meaning of a cone's weight: its share of the lamp's flux, or its intensity on the axis.
enum class ConeWeights { Flux, Literal };

using BeamPattern = std::variant<std::monostate, BeamTable, BeamOptics>;

struct Beam {
    std::string name;
    ConeWeights weights = ConeWeights::Flux;
    std::vector<Cone> cones;  // of a beam without a pattern
    BeamPattern pattern{};
    double per_flux = 1.0;  // of the pattern: 1 / its own flux, from scaled_to_flux()
    double turn_rad = 0.0;  // rotation of the pattern about the axis, from along to across
    std::optional<BeamWindow> window{};  // if measured in air

    [[nodiscard]] bool operator==(const Beam&) const = default;
};

// Sets a pattern's per_flux.
[[nodiscard]] Beam scaled_to_flux(Beam beam);

// The orientation of a beam, and of an emitter, in the sled's frame: unit vectors. `along` is the
// sled's forward direction projected on the plane across the axis (down, for an axis within a
// millionth of a radian of fore or aft, where rounding leaves almost nothing of forward), across =
// axis x along. aphotic.inc has the same rule. The scalar T is a number, or a number with
// derivatives (ceres::Jet).
inline constexpr double kForeAndAftSine = 1e-6;
template <typename T>
struct BasicBeamFrame {
    Eigen::Matrix<T, 3, 1> axis;
    Eigen::Matrix<T, 3, 1> along;
    Eigen::Matrix<T, 3, 1> across;
};
using BeamFrame = BasicBeamFrame<double>;
template <typename T>
[[nodiscard]] BasicBeamFrame<T> frame_about(const Eigen::Matrix<T, 3, 1>& axis) {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const bool is_fore_and_aft = axis.cross(Vector::UnitX()).norm() < kForeAndAftSine;
    const Vector reference = is_fore_and_aft ? Vector::UnitZ() : Vector::UnitX();
    const Vector along = (reference - reference.dot(axis) * axis).normalized();
    return {.axis = axis, .along = along, .across = axis.cross(along)};
}
[[nodiscard]] inline BeamFrame frame_about(const Eigen::Vector3d& axis) {
    return frame_about<double>(axis);
}
// [rad], for directions of any length.
[[nodiscard]] double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

// Directions `towards` are in the sled's frame, of any length.

[[nodiscard]] double intensity_towards(const Beam& beam,
                                       const BeamFrame& frame,
                                       const Eigen::Vector3d& towards);

// A direction in the pattern's frame: the lamp's frame, rotated, and in air if it was measured
// there. Empty where the window transmits no light.
struct PatternView {
    Eigen::Vector3d direction;
    double factor = 1.0;  // relative to the pattern's value there
};
[[nodiscard]] std::optional<PatternView> pattern_view(const Beam& beam,
                                                      const BeamFrame& frame,
                                                      const Eigen::Vector3d& towards);
// intensity_towards() without the edge between the two directions: the light at `from` continues
// smoothly. If a small turn crosses no edge, it is I itself.
[[nodiscard]] double continued_intensity(const Beam& beam,
                                         const BeamFrame& frame,
                                         const Eigen::Vector3d& towards,
                                         const Eigen::Vector3d& from);

// Upper bounds of I over all directions within an angle of this one, and over all directions.
[[nodiscard]] double most_intensity(const Beam& beam,
                                    const BeamFrame& frame,
                                    const Eigen::Vector3d& towards,
                                    double within_rad);
[[nodiscard]] double most_intensity(const Beam& beam);

// Whether there is light within an angle of this direction, and in any direction.
[[nodiscard]] bool reaches(const Beam& beam,
                           const BeamFrame& frame,
                           const Eigen::Vector3d& towards,
                           double within_rad);
[[nodiscard]] bool is_dark(const Beam& beam);

// The angles off the axis where I has a step, or falls as steeply as one: cos^n goes to 0 at 90
// degrees, so a cone has an edge there only if n < 1. Behind a window, the end of its light.
[[nodiscard]] std::vector<double> edges_rad(const Beam& beam);
// Whether I has steps that are not circles about the axis: those of a table over a rectangle of
// angles, or of a sharp image. They bound one region of directions, which contains the light.
[[nodiscard]] bool has_rim(const Beam& beam);
[[nodiscard]] bool is_within_rim(const Beam& beam,
                                 const BeamFrame& frame,
                                 const Eigen::Vector3d& towards);

// I changes no more steeply with the direction than cos to this power does, and curves no more: for
// cones without soft edges (ln I)' >= n (ln cos)'. For all others it is an estimate, found on a
// grid of a degree, with I limited to at least kDimBeamShare of the largest.
inline constexpr double kDimBeamShare = 0.01;
[[nodiscard]] double steepest_exponent(const Beam& beam);

// The flux of a lamp of power 1: the integral of I over all directions.
[[nodiscard]] double flux_of(const Beam& beam);

// The parts that add up to the beam: its cones, each a beam with the cone's name; a pattern is one
// part.
[[nodiscard]] std::vector<Beam> parts_of(const Beam& beam);
// The beam of the selected parts.
[[nodiscard]] Beam parts_that(const Beam& beam, const std::function<bool(const Beam&)>& is_wanted);

// A cone as plain numbers, for loops over many directions. Empty for a beam that is a pattern.
// Behind a window cosines are those in air.
struct ConeLight {
    double on_axis = 0.0;  // [1/sr]
    double exponent = 1.0;
    double edge_cosine = 0.0;
    double full_cosine = -1.0;  // start of the soft edge; -1 without one
};
[[nodiscard]] std::vector<ConeLight> cone_lights(const Beam& beam);

// Beams of the same signature have the same light. Names are ignored.
[[nodiscard]] std::string beam_signature(const Beam& beam);

}  // namespace aphotic
