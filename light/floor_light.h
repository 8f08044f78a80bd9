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
// shows where it is not smooth: a kink of the beam between two nodes appears there with at least a
// third of its maximum. A ray that crosses a kink and returns is not detected; unless the kink is
// steep the effect is small, so steep ones are searched for explicitly (beam_crease.h), on the
// parabola through the nodes. A place whose doubt exceeds kMostDoubt of its signal, or where a ray
// crosses a steep kink, gets a ray for each wavelength,
//
//   S_c = sum_i w_ci G(n_i) exp(-K_i l(n_i))
//
// Places are computed in lanes (base/lanes.h).
//
// A beam's edge, which dispersion spreads over several pixels, is treated as sharp and located by
// the middle index.
#pragma once

#include "base/lanes.h"
#include "light/beam_light.h"
#include "light/dispersion.h"
#include "light/floor_arrival.h"
#include "light/floor_ray.h"
#include "light/lane_ray.h"
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

// The rays of a place at the index nodes, the middle one first; without a port only that one is
// used.
using PlaceRays = std::array<FloorRay, kIndexNodes>;

// Of kLanes places: the nodes' rays in the same order, then, if requested, those halfway between
// the middle node and either end.
inline constexpr std::size_t kLooks = 2 * kIndexNodes - 1;
struct LaneRays {
    std::size_t count;
    std::array<LaneRay, kLooks> ray;
};

// Their wavelengths: for a camera without a port only the first.
[[nodiscard]] std::vector<double> place_rays_nm(const Rig& rig);

// The rays of a camera at the indices of light, independent of the sled's pose.
class CameraRays {
  public:
    CameraRays(const Rig& rig, int threads);
    // All light takes the ray of this wavelength.
    CameraRays(const Rig& rig, double lambda_nm, int threads);

    [[nodiscard]] std::size_t nodes() const { return has_port_ ? kIndexNodes : 1; }
    // At pixels' centres and between them.
    [[nodiscard]] PlaceRays at(double column, double row, const Plane& floor) const;
    [[nodiscard]] LaneRays at(const Lanes& column,
                              const Lanes& row,
                              const LanePlane& floor,
                              bool looks) const;

  private:
    bool has_port_;  // whose rays differ
    RayTable table_;
};

struct FloorLamp {
    Eigen::Vector3d position_m;
    Lanes floor_m;  // its height over each lane's floor; 0: it does not light the lane
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

using LaneSignals = std::array<Lanes, kChannels>;
struct LaneLight {
    LaneSignals signals{};
    LaneSignals doubts{};
    std::array<bool, kLanes> crosses{};
    bool is_before = false;  // of any lane
    bool is_beyond = false;

    [[nodiscard]] PlaceLight of_lane(std::size_t k) const {
        return {.signals = {signals[0][k], signals[1][k], signals[2][k]},
                .doubts = {doubts[0][k], doubts[1][k], doubts[2][k]},
                .crosses = crosses[k],
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
    [[nodiscard]] PlaceRays rays_at(double column, double row) const {
        return rays_.at(column, row, floor_);
    }
    [[nodiscard]] LaneRays rays_at(const Lanes& column, const Lanes& row, bool looks) const {
        return rays_.at(column, row, lane_floor_, looks);
    }
    // On planes other than the sled's floor.
    [[nodiscard]] LaneRays rays_at(const Lanes& column,
                                   const Lanes& row,
                                   const LanePlane& planes) const {
        return rays_.at(column, row, planes, false);
    }
    // Adds a lamp's light, with its doubts if the halfway rays were computed.
    void add(const FloorLamp& lamp, const LaneRays& rays, LaneLight& light) const;
    // With a ray for each wavelength, for all these lamps, at one place.
    [[nodiscard]] Signals dispersed(std::span<const FloorLamp* const> lamps,
                                    double column,
                                    double row) const;

  private:
    struct StrobeLight {
        BeamLight beam;
        std::vector<Crease> creases;
        std::vector<Crease> steep;
        const LampSignal* signal;
    };
    // A lamp's effect (floor_arrival.h).
    struct LaneArrival {
        LaneVector towards;  // V
        Lanes length;
        Lanes diffuse;
        Lanes highlight;  // set where the floor has one
        Lanes place;      // of the path, in steps of the table
    };
    // As if the edge that lights `from` were absent.
    [[nodiscard]] LaneArrival arrive(const FloorLamp& lamp,
                                     const LaneRay& ray,
                                     const LaneArrival* from) const;
    void look_between(const FloorLamp& lamp,
                      const LaneRays& rays,
                      const std::array<LaneArrival, kIndexNodes>& at_nodes,
                      const Lanes& last_place,
                      LaneLight& light) const;

    const Rig& rig_;
    const SignalTable& table_;
    const CameraRays& rays_;
    Plane floor_;
    LanePlane lane_floor_;
    std::vector<StrobeLight> strobes_;
    std::vector<FloorLamp> lamps_;
};

// An InputError, which names the sled's pose and the strobe, unless all lamps of the rig are above
// the floor.
void require_over_floor(const Rig& rig, const Sled& sled);
[[nodiscard]] std::string in_words(const Sled& sled);

}  // namespace aphotic
