// SPDX-License-Identifier: BSD-3-Clause
//
// Where the strobes of a rig may be: the free keys and their boxes, as a unit cube to search.
//
//   strobe.NAME.position_m     the position, within a box about it
//   strobe.NAME.aim            the direction, within an angle of the original one
//   strobe.NAME.aim.tilt_deg   its tilt alone, of an aim = { tilt_deg = ..., toward = "axis" }
//   strobe.NAME.power          its share of the total flux of the strobes with free power
//
// NAME may be * for every strobe. An aim turns by two angles a and b of its own, each within t:
//
//   axis = unit(axis_0 + tan(a) e_1 + tan(b) e_2)
//
// with e_1, e_2 across axis_0 and each other: at a = b = 0 it is the axis of the start, and it has
// no pole. A strobe whose rig aims it towards the camera's axis keeps pointing there as it moves,
// since its aim is relative.
//
// Powers share their initial flux (power times the integral of the lamp's table): light is
// redistributed, not added. None falls below kLeastFluxShare of the strongest, or its own share of
// it.
//
// A place is allowed if every lamp is above the floor by at least kRoomOverFloor of the altitude,
// in every pose, and outside the camera's view, enlarged kRoomAboutView times each way.
#pragma once

#include "light/path_range.h"
#include "lightmap/lightmap.h"
#include "rig/file/rig_text.h"
#include "rig/rig.h"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr double kLeastFluxShare = 0.1;
inline constexpr double kRoomOverFloor = 0.05;
inline constexpr double kRoomAboutView = 1.1;

struct DesignFreedom {
    std::vector<std::string> keys;
    double within_m = 0.25;            // of the start, each way
    std::vector<std::string> boxes{};  // NAME=x0:x1,y0:y1,z0:z1 in metres; one number: fixed
    double turn_rad = 0.5;             // t
};

class DesignSpace {
  public:
    // An InputError, which names the key or box, for anything that the rig does not have or cannot
    // have.
    DesignSpace(const RigText& text, const DesignFreedom& freedom, std::vector<Sled> poses);

    // The free numbers, each from 0 to 1.
    [[nodiscard]] std::size_t size() const { return start_.size(); }
    [[nodiscard]] const std::vector<double>& start() const { return start_; }

    // By strobe, including those that are not free.
    [[nodiscard]] std::vector<StrobePlace> places_at(std::span<const double> point) const;
    [[nodiscard]] bool allows(const std::vector<StrobePlace>& places) const;
    // The reason, for messages; empty: allowed.
    [[nodiscard]] std::string why_not(const std::vector<StrobePlace>& places) const;

    // The rig's text with the strobes there. Numbers are rounded: to a number of decimals for
    // metres, within the boxes, for directions and degrees, and to a number of digits for powers.
    static constexpr int kPlacesOfMetre = 4;
    static constexpr int kPlacesOfDirection = 5;
    static constexpr int kPlacesOfDegree = 2;
    static constexpr int kDigitsOfPower = 5;
    [[nodiscard]] RigText text_at(std::span<const double> point) const;

    // All paths that can be seen from anywhere in the space, in any pose.
    [[nodiscard]] PathRange paths() const;

    [[nodiscard]] const std::vector<Sled>& poses() const { return poses_; }

  private:
    struct Free {
        bool position = false;
        bool aim = false;
        bool tilt = false;
        bool power = false;
        Eigen::Vector3d least_m = Eigen::Vector3d::Zero();
        Eigen::Vector3d most_m = Eigen::Vector3d::Zero();
    };

    void set_keys(const std::vector<std::string>& keys);
    void set_key(std::size_t strobe, const std::string& key, const std::string& path);
    void set_boxes(const DesignFreedom& freedom);
    void set_powers();
    void set_start();
    [[nodiscard]] std::vector<double> tilt_range_rad(std::size_t strobe) const;
    [[nodiscard]] std::string allowed_keys() const;

    RigText text_;
    Rig rig_;
    std::vector<Sled> poses_;
    double turn_rad_ = 0.0;
    std::vector<bool> is_aimed_;  // by strobe: its text has an aim, not a direction
    std::vector<Free> free_;
    std::vector<double> flux_per_power_;
    double shared_flux_ = 0.0;
    double least_share_ = kLeastFluxShare;
    std::vector<double> start_;
};

}  // namespace aphotic
