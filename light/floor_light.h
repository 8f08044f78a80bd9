// SPDX-License-Identifier: BSD-3-Clause
//
// The light of a rig's strobes on the bare floor, at a place of the image: the one sum.
//
//   S_c = sum over lamps of  share I(w) cos(i) / d^2 T_c(d + r)  +  highlight
//
// share   the strobe's power over pi and its number of lamps
// I(w)    beam, per direction (beam_light.h)            cos(i)  at the floor (floor_arrival.h)
// d, r    lamp to floor, floor to camera, in water      T_c     signal by path (signal_table.h)
//
// Behind a port every wavelength has its own ray. G, the contribution of one lamp, is a smooth
// function of the water's index, so the signal is
//
//   S_c = sum_j  G_j T_jc(l_j)
//
// over the index nodes (index_nodes.h). Halfway between nodes
//
//   doubt = max |G(n) - sum_j G(n_j) l_j(n)|
//
// shows where it is not smooth: a kink of the beam between two nodes shows there with at least a
// third of its maximum. A ray that crosses a kink and returns does not show; unless the kink is
// steep the effect is small, so steep ones are searched for explicitly (beam_crease.h), on the
// parabola through the nodes. A place whose doubt exceeds kMostDoubt of its signal, or where a ray
// crosses a steep kink, gets a ray for each wavelength,
//
//   S_c = sum_i w_ci G(n_i) exp(-K_i l(n_i))
//
// For a camera without a port, places are computed in lanes (base/lanes.h).
//
// A beam's edge, which dispersion spreads over several pixels, is sharp and located by the middle
// index.
#pragma once

#include "base/lanes.h"
#include "light/beam_light.h"
#include "light/floor_arrival.h"
#include "light/floor_ray.h"
#include "light/index_nodes.h"
#include "light/ray_table.h"
#include "light/signal_table.h"
#include "light/steep_crease.h"
#include "rig/beam/beam_crease.h"
#include "rig/rig.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr double kMostDoubt = 1e-5;

// For the middle index, the first and the last; then halfway between the middle and either.
inline constexpr std::size_t kLooks = 2 * kIndexNodes - 1;
using PlaceRays = std::array<FloorRay, kLooks>;

// Their wavelengths: for a camera without a port only the first.
[[nodiscard]] std::vector<double> place_rays_nm(const Rig& rig);

// The rays of a camera at the indices of light, independent of the sled's pose.
class CameraRays {
  public:
    CameraRays(const Rig& rig, int threads);
    // All light takes the ray of this wavelength.
    CameraRays(const Rig& rig, double lambda_nm, int threads);

    [[nodiscard]] std::size_t nodes() const { return has_port_ ? kIndexNodes : 1; }
    // At pixels' centres and between them. The rays halfway between nodes only if requested.
    [[nodiscard]] PlaceRays at(double column, double row, const Plane& floor, bool looks) const;
    // Directions in air.
    [[nodiscard]] LaneVector in_air(const Lanes& column, const Lanes& row) const {
        return table_.look(column, row);
    }

  private:
    bool has_port_;  // whose rays differ
    RayTable table_;
};

struct FloorLamp {
    Eigen::Vector3d position_m;
    double floor_m = 0.0;  // its height
    double share = 0.0;
    std::size_t strobe = 0;
};

// The light of some lamps at a place of the image.
struct PlaceLight {
    Signals signals{};
    Signals doubts{};
    bool crosses = false;    // a steep kink
    bool is_before = false;  // light whose path is shorter than the table's range
    bool is_beyond = false;  // or longer
};

// Places seen by a camera without a port: its rays start at the pupil.
struct LaneRays {
    LaneVector direction;
    Lanes down;  // 0 where it sees no floor
};
struct LaneLight {
    std::array<Lanes, kChannels> signals{};
    bool is_before = false;  // of any lane
    bool is_beyond = false;

    [[nodiscard]] PlaceLight of_lane(std::size_t k) const {
        return {.signals = {signals[0][k], signals[1][k], signals[2][k]},
                .is_before = is_before,
                .is_beyond = is_beyond};
    }
};

class FloorLight {
  public:
    // For one pose of the rig's sled. Everything but the sled must outlive it.
    FloorLight(const Rig& rig, const Sled& sled, const SignalTable& table, const CameraRays& rays);

    [[nodiscard]] const std::vector<FloorLamp>& lamps() const { return lamps_; }
    [[nodiscard]] const std::vector<Crease>& creases(const FloorLamp& lamp) const {
        return strobes_[lamp.strobe].creases;
    }
    [[nodiscard]] bool has_port() const { return rays_.nodes() > 1; }
    [[nodiscard]] PlaceRays rays_at(double column, double row, bool looks) const {
        return rays_.at(column, row, floor_, looks);
    }
    // On a plane other than the sled's floor.
    [[nodiscard]] PlaceRays rays_at(double column, double row, const Plane& plane) const {
        return rays_.at(column, row, plane, false);
    }
    // Adds a lamp's light, with its doubts if the halfway rays were computed.
    void add(const FloorLamp& lamp, const PlaceRays& rays, bool looks, PlaceLight& light) const;
    [[nodiscard]] LaneRays rays_at(const Lanes& column, const Lanes& row) const;
    void add(const FloorLamp& lamp, const LaneRays& rays, LaneLight& light) const;
    // With a ray for each wavelength, for all these lamps.
    [[nodiscard]] Signals dispersed(std::span<const FloorLamp* const> lamps,
                                    double column,
                                    double row,
                                    const PlaceRays& rays) const;

  private:
    struct StrobeLight {
        BeamLight beam;
        std::vector<Crease> creases;
        std::vector<Crease> steep;
        const LampSignal* signal;
    };
    // For one lamp along one ray.
    [[nodiscard]] FloorArrival arrive(const FloorLamp& lamp,
                                      const FloorRay& ray,
                                      const Eigen::Vector3d* from) const;
    // Adds the light that arrives, by the table of an index node; returns the place in the table,
    // or -1 for no light.
    double shine(const LampSignal& signal,
                 std::size_t node,
                 const FloorArrival& arrived,
                 PlaceLight& light) const;
    [[nodiscard]] double place_in_table(double path_m) const {
        return (path_m - table_.steps.first_m) * table_.steps.steps_per_m;
    }

    const Rig& rig_;
    const SignalTable& table_;
    const CameraRays& rays_;
    Plane floor_;
    double pupil_m_;  // its height
    std::vector<StrobeLight> strobes_;
    std::vector<FloorLamp> lamps_;
};

// An InputError, which names the sled's pose and the strobe, unless all lamps of the rig are above
// the floor.
void require_over_floor(const Rig& rig, const Sled& sled);
[[nodiscard]] std::string in_words(const Sled& sled);

}  // namespace aphotic
