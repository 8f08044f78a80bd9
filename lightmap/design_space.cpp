// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/design_space.h"

#include "base/degrees.h"
#include "base/error.h"
#include "base/number.h"
#include "base/offered.h"
#include "light/path_range.h"
#include "rig/camera/lens.h"
#include "rig/geometry.h"
#include "spectral/lamp_flux.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

namespace aphotic {
namespace {

using Eigen::Vector3d;

constexpr std::string_view kStrobes = "strobe.";

// Longer endings first, since one may be the other's end.
constexpr std::array<std::string_view, 4> kKeys{"aim.tilt_deg", "position_m", "aim", "power"};

std::vector<std::string> split_at(std::string_view text, char mark) {
    std::vector<std::string> parts;
    for (std::size_t from = 0; from <= text.size();) {
        const std::size_t to = std::min(text.find(mark, from), text.size());
        parts.emplace_back(text.substr(from, to - from));
        from = to + 1;
    }
    return parts;
}

std::optional<double> metres_of(std::string_view text) {
    const auto value = read_number<double>(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

// One number, or two separated by a colon, the smaller first.
std::optional<std::array<double, 2>> side_of(std::string_view text) {
    const std::vector<std::string> ends = split_at(text, ':');
    const auto first = metres_of(ends.front());
    const auto last = metres_of(ends.back());
    if (ends.size() > 2 || !first || !last || *first > *last) return std::nullopt;
    return std::array{*first, *last};
}

std::pair<Vector3d, Vector3d> across(const Vector3d& axis) {
    const BeamFrame frame = frame_about(axis);
    return {frame.along, frame.across};
}

double tilt_rad_of(const Vector3d& axis) {
    return std::atan2(std::hypot(axis.x(), axis.y()), axis.z());
}

// Towards the camera's axis; straight down or up if on it.
Vector3d aimed(double tilt_rad, const Vector3d& position_m) {
    const Vector3d inward(-position_m.x(), -position_m.y(), 0.0);
    if (inward.norm() == 0.0) return {0.0, 0.0, tilt_rad < 1.0 ? 1.0 : -1.0};
    return std::cos(tilt_rad) * Vector3d::UnitZ() + std::sin(tilt_rad) * inward.normalized();
}

double between(double least, double most, double share) {
    return least + share * (most - least);
}

// The corners of a lamp, or its position.
std::vector<Vector3d> ends_of(const Strobe& strobe) {
    if (!strobe.emitter) return {strobe.position_m};
    const BeamFrame frame = frame_about(strobe.axis);
    std::vector<Vector3d> ends;
    for (const double a : {-0.5, 0.5}) {
        for (const double b : {-0.5, 0.5}) {
            ends.emplace_back(strobe.position_m + a * strobe.emitter->along_m * frame.along +
                              b * strobe.emitter->across_m * frame.across);
        }
    }
    return ends;
}

double rounded(double value, int places) {
    const double scale = std::pow(10.0, places);
    return std::round(scale * value) / scale;
}

Vector3d rounded(const Vector3d& v, int places) {
    return v.unaryExpr([&](double value) { return rounded(value, places); });
}

std::vector<double> numbers_of(const Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

// Multiplies the power or flux of the rig, in the same key.
void brighten(RigText& text, const std::string& strobe, double factor) {
    static constexpr std::array kPowers{"luminous_flux_lm", "radiant_flux_w", "energy_j", "power"};
    const auto* said =
        std::ranges::find_if(kPowers, [&](const char* key) { return text.has(strobe + key); });
    const std::string key = strobe + (said == kPowers.end() ? "power" : *said);
    const double power = factor * text.number(key).value_or(1.0);
    text.set(key, rounded_to_digits(power, DesignSpace::kDigitsOfPower));
}

}  // namespace

DesignSpace::DesignSpace(const RigText& text, const DesignFreedom& freedom, std::vector<Sled> poses)
    : text_(text),
      rig_(text.rig()),
      poses_(std::move(poses)),
      turn_rad_(freedom.turn_rad),
      free_(rig_.strobes.size()) {
    for (std::size_t s = 0; s < free_.size(); ++s)
        is_aimed_.push_back(text.has(fmt::format("strobe.{}.aim", s)));
    set_keys(freedom.keys);
    set_boxes(freedom);
    set_powers();
    set_start();
    const std::string fault = why_not(places_at(start_));
    if (!fault.empty()) throw InputError(fault);
}

std::string DesignSpace::allowed_keys() const {
    std::vector<std::string> names{"*"};
    for (const Strobe& strobe : rig_.strobes) names.push_back(strobe.name);
    return fmt::format(
        "allowed: strobe.NAME.position_m, strobe.NAME.aim, strobe.NAME.aim.tilt_deg "
        "or strobe.NAME.power, with the NAME {}",
        fmt::join(names, ", "));
}

void DesignSpace::set_key(std::size_t strobe, const std::string& key, const std::string& path) {
    Free& free = free_[strobe];
    if (key == "position_m") free.position = true;
    if (key == "power") free.power = true;
    if (key == "aim") {
        free.aim = true;
    }
    if (key == "aim.tilt_deg") {
        if (!is_aimed_[strobe])
            throw InputError("{}: found a strobe with a direction; allowed: strobe.{}.aim",
                             path,
                             rig_.strobes[strobe].name);
        free.tilt = true;
    }
    if (free.aim && free.tilt)
        throw InputError("{}: found both aim and aim.tilt_deg; allowed: one of them", path);
}

void DesignSpace::set_keys(const std::vector<std::string>& keys) {
    for (const std::string& path : keys) {
        const auto key = std::ranges::find_if(
            kKeys, [&](std::string_view end) { return path.ends_with(fmt::format(".{}", end)); });
        bool is_known = false;
        if (path.starts_with(kStrobes) && key != kKeys.end() &&
            path.size() > kStrobes.size() + key->size() + 1) {
            const std::string name =
                path.substr(kStrobes.size(), path.size() - kStrobes.size() - key->size() - 1);
            for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
                if (name != "*" && name != rig_.strobes[s].name) continue;
                set_key(s, std::string(*key), path);
                is_known = true;
            }
        }
        if (!is_known) throw InputError("--vary: found {}; {}", path, allowed_keys());
    }
}

void DesignSpace::set_boxes(const DesignFreedom& freedom) {
    for (std::size_t s = 0; s < free_.size(); ++s) {
        const Vector3d room_m = Vector3d::Constant(free_[s].position ? freedom.within_m : 0.0);
        free_[s].least_m = rig_.strobes[s].position_m - room_m;
        free_[s].most_m = rig_.strobes[s].position_m + room_m;
    }
    for (const std::string& text : freedom.boxes) {
        const std::size_t mark = text.rfind('=');
        const std::vector<std::string> sides =
            mark == std::string::npos ? std::vector<std::string>{}
                                      : split_at(std::string_view(text).substr(mark + 1), ',');
        const auto strobe = std::ranges::find(
            rig_.strobes, mark == std::string::npos ? text : text.substr(0, mark), &Strobe::name);
        const auto s = static_cast<std::size_t>(strobe - rig_.strobes.begin());
        if (sides.size() != 3 || strobe == rig_.strobes.end() || !free_[s].position) {
            throw InputError(
                "--box: found {}; allowed: NAME=X0:X1,Y0:Y1,Z0:Z1 in metres, of a "
                "strobe whose position_m varies",
                text);
        }
        for (Eigen::Index i = 0; i < 3; ++i) {
            const auto side = side_of(sides[static_cast<std::size_t>(i)]);
            const double at_m = strobe->position_m(i);
            if (!side || at_m < (*side)[0] || at_m > (*side)[1]) {
                throw InputError(
                    "--box: found {} for {}; allowed: FROM:TO, or one number, around "
                    "the {} m where the strobe is",
                    sides[static_cast<std::size_t>(i)],
                    strobe->name,
                    at_m);
            }
            free_[s].least_m(i) = (*side)[0];
            free_[s].most_m(i) = (*side)[1];
        }
    }
}

void DesignSpace::set_powers() {
    flux_per_power_.assign(free_.size(), 0.0);
    double most = 0.0;
    double least = std::numeric_limits<double>::infinity();
    int count = 0;
    for (std::size_t s = 0; s < free_.size(); ++s) {
        if (!free_[s].power) continue;
        const Strobe& strobe = rig_.strobes[s];
        flux_per_power_[s] = radiant_flux_w(strobe.spectrum);
        const double flux = strobe.power * flux_per_power_[s];
        if (flux <= 0.0) {
            throw InputError(
                "strobe.{}.power: found a strobe without light; allowed: one with light to share",
                strobe.name);
        }
        shared_flux_ += flux;
        most = std::max(most, flux);
        least = std::min(least, flux);
        ++count;
    }
    if (count == 1) {
        throw InputError(
            "--vary: found the power of one strobe; allowed: the power of two or more, which share "
            "their total light");
    }
    if (count > 0) least_share_ = std::min(kLeastFluxShare, least / most);
}

std::vector<double> DesignSpace::tilt_range_rad(std::size_t strobe) const {
    constexpr double kMostTiltRad = 180.0 * kRadiansPerDegree;
    const double tilt_rad = tilt_rad_of(rig_.strobes[strobe].axis);
    return {std::max(0.0, tilt_rad - turn_rad_), std::min(kMostTiltRad, tilt_rad + turn_rad_)};
}

void DesignSpace::set_start() {
    double most = 0.0;
    for (std::size_t s = 0; s < free_.size(); ++s)
        most = std::max(most, rig_.strobes[s].power * flux_per_power_[s]);
    const auto share = [](double value, double least, double last) {
        return std::clamp((value - least) / (last - least), 0.0, 1.0);
    };
    for (std::size_t s = 0; s < free_.size(); ++s) {
        const Free& free = free_[s];
        const Strobe& strobe = rig_.strobes[s];
        for (Eigen::Index i = 0; i < 3; ++i) {
            if (free.most_m(i) > free.least_m(i))
                start_.push_back(share(strobe.position_m(i), free.least_m(i), free.most_m(i)));
        }
        if (free.aim) start_.insert(start_.end(), 2, 0.5);
        if (free.tilt) {
            const std::vector<double> range = tilt_range_rad(s);
            start_.push_back(share(tilt_rad_of(strobe.axis), range[0], range[1]));
        }
        if (free.power)
            start_.push_back(share(strobe.power * flux_per_power_[s] / most, least_share_, 1.0));
    }
    if (start_.empty()) throw InputError("--vary: found nothing that is free; {}", allowed_keys());
}

std::vector<StrobePlace> DesignSpace::places_at(std::span<const double> point) const {
    std::vector<StrobePlace> places;
    std::vector<double> share(free_.size(), 0.0);
    auto next = point.begin();
    for (std::size_t s = 0; s < free_.size(); ++s) {
        const Free& free = free_[s];
        const Strobe& strobe = rig_.strobes[s];
        StrobePlace place{
            .position_m = strobe.position_m, .axis = strobe.axis, .power = strobe.power};
        for (Eigen::Index i = 0; i < 3; ++i) {
            if (free.most_m(i) > free.least_m(i))
                place.position_m(i) = between(free.least_m(i), free.most_m(i), *next++);
        }
        if (free.aim) {
            const auto [e_1, e_2] = across(strobe.axis);
            const double a = between(-turn_rad_, turn_rad_, *next++);
            const double b = between(-turn_rad_, turn_rad_, *next++);
            place.axis = (strobe.axis + std::tan(a) * e_1 + std::tan(b) * e_2).normalized();
        } else if (is_aimed_[s] && (free.position || free.tilt)) {
            double tilt_rad = tilt_rad_of(strobe.axis);
            if (free.tilt) {
                const std::vector<double> range = tilt_range_rad(s);
                tilt_rad = between(range[0], range[1], *next++);
            }
            place.axis = aimed(tilt_rad, place.position_m);
        }
        if (free.power) share[s] = between(least_share_, 1.0, *next++);
        places.push_back(place);
    }
    double all = 0.0;
    for (const double one : share) all += one;
    for (std::size_t s = 0; s < free_.size(); ++s) {
        if (free_[s].power) places[s].power = shared_flux_ * share[s] / all / flux_per_power_[s];
    }
    return places;
}

std::string DesignSpace::why_not(const std::vector<StrobePlace>& places) const {
    for (std::size_t s = 0; s < places.size(); ++s) {
        const Free& free = free_[s];
        if (!free.position && !free.aim && !free.tilt) continue;
        Strobe strobe = rig_.strobes[s];
        put(places[s], strobe);
        const bool is_aimed = is_aimed_[s] && !free.aim;
        const bool is_on_axis = strobe.position_m.head<2>().norm() == 0.0;
        if (is_aimed && is_on_axis && std::abs(strobe.axis.z()) < 1.0)
            return fmt::format("strobe '{}': found on the camera's axis", strobe.name);
        for (const Vector3d& end_m : ends_of(strobe)) {
            if (is_in_view(rig_.camera, end_m, kRoomAboutView) || end_m.norm() < kLeastDistance_m) {
                return fmt::format(
                    "strobe '{}': found in the camera's view or within a tenth of "
                    "it; allowed: outside",
                    strobe.name);
            }
            for (const Sled& pose : poses_) {
                const double height_m = height_above(floor_plane(pose), end_m);
                if (height_m >= kRoomOverFloor * pose.altitude_m) continue;
                return fmt::format(
                    "strobe '{}': found {} m over the floor at an altitude of "
                    "{:.4g} m; allowed: at least {} of it, in every pose",
                    strobe.name,
                    at_most(height_m),
                    pose.altitude_m,
                    kRoomOverFloor);
            }
        }
    }
    return {};
}

bool DesignSpace::allows(const std::vector<StrobePlace>& places) const {
    return why_not(places).empty();
}

RigText DesignSpace::text_at(std::span<const double> point) const {
    RigText text = text_;
    if (std::ranges::equal(point, start_)) return text;
    const std::vector<StrobePlace> places = places_at(point);
    for (std::size_t s = 0; s < free_.size(); ++s) {
        const Free& free = free_[s];
        const Strobe& was = rig_.strobes[s];
        const std::string key = fmt::format("strobe.{}.", s);
        if (free.position) {
            const Vector3d rounded_m = rounded(places[s].position_m, kPlacesOfMetre);
            text.set(key + "position_m",
                     numbers_of(rounded_m.cwiseMax(free.least_m).cwiseMin(free.most_m)));
        }
        if (free.aim) {
            text.erase(key + "aim");
            text.set(key + "direction", numbers_of(rounded(places[s].axis, kPlacesOfDirection)));
        }
        if (free.tilt)
            text.set(key + "aim.tilt_deg",
                     rounded(tilt_rad_of(places[s].axis) * kDegreesPerRadian, kPlacesOfDegree));
        if (free.power) brighten(text, key, places[s].power / was.power);
    }
    return text;
}

PathRange DesignSpace::paths() const {
    Rig cornered = rig_;
    cornered.strobes.clear();
    for (std::size_t s = 0; s < free_.size(); ++s) {
        for (std::size_t corner = 0; corner < (free_[s].position ? 8U : 1U); ++corner) {
            Strobe strobe = rig_.strobes[s];
            for (Eigen::Index i = 0; i < 3; ++i) {
                const bool is_most = ((corner >> static_cast<std::size_t>(i)) & 1U) != 0;
                strobe.position_m(i) = is_most ? free_[s].most_m(i) : free_[s].least_m(i);
            }
            cornered.strobes.push_back(strobe);
        }
    }
    // The longest is at a corner. The shortest is at least the way straight down and up.
    PathRange all = paths_of(cornered, poses_);
    all.shortest_m = std::numeric_limits<double>::infinity();
    for (const Sled& pose : poses_) {
        const Plane floor = floor_plane(pose);
        const double up_m = height_above(floor, Vector3d::Zero()) - port_reach_m(rig_);
        for (const Strobe& strobe : cornered.strobes) {
            const double down_m =
                std::max(kRoomOverFloor * pose.altitude_m, height_above(floor, strobe.position_m)) -
                emitter_reach_m(strobe);
            all.shortest_m = std::min(all.shortest_m, std::max(up_m, 0.0) + down_m);
        }
    }
    all.shortest_m = std::max(all.shortest_m / kPathRoom, kLeastDistance_m);
    return all;
}

}  // namespace aphotic
