// SPDX-License-Identifier: BSD-3-Clause
#include "survey/relief/depth_check.h"

#include "base/upper_median.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aphotic {
namespace {

template <typename Value>
double median_of(std::span<const DepthLook> looks, const Value& value) {
    std::vector<double> values;
    for (const DepthLook& look : looks)
        if (const std::optional<double> one = value(look)) values.push_back(*one);
    return upper_median(values);
}

std::optional<std::string> other_unit(std::span<const DepthLook> looks,
                                      std::optional<double> rig_altitude_m) {
    const double depth_m =
        median_of(looks, [](const DepthLook& l) { return std::optional(l.depth_m); });
    double altitude_m = median_of(looks, [](const DepthLook& look) { return look.altitude_m; });
    const bool has_navigation = std::isfinite(altitude_m);
    if (!has_navigation) altitude_m = rig_altitude_m.value_or(depth_m);
    const double ratio = depth_m / altitude_m;
    if (ratio < kOtherDepth && ratio > 1.0 / kOtherDepth) return std::nullopt;
    return fmt::format(
        "depth maps show {:.3g} m in the median, {} says {:.3g} m: {:.3g} times as much; is it "
        "another unit (--depth-unit)?",
        depth_m,
        has_navigation ? "the navigation" : "the rig's altitude",
        altitude_m,
        ratio);
}

std::optional<std::string> other_convention(std::span<const DepthLook> looks) {
    constexpr double kPerCent = 100.0;
    const auto off = [&](DepthIs is) {
        return median_of(looks, [&](const DepthLook& look) {
            return std::optional(is == DepthIs::AlongAxis ? look.flatness.along_axis
                                                          : look.flatness.along_ray);
        });
    };
    const DepthIs taken = looks.front().taken;
    const DepthIs other = taken == DepthIs::AlongAxis ? DepthIs::AlongRay : DepthIs::AlongAxis;
    if (!(off(taken) < kEvenFloor && off(other) < kOtherConvention * off(taken)))
        return std::nullopt;
    // Of single precision and millimetres nothing can be told.
    constexpr double kTold = 2e-3;
    if (off(taken) < kTold) return std::nullopt;
    return fmt::format(
        "taken {}, depth maps are {:.2g} % off a plane in the median; {}, {:.2g} %: is it "
        "--depth-is {}?",
        taken == DepthIs::AlongAxis ? "along the axis" : "along rays",
        kPerCent * off(taken),
        taken == DepthIs::AlongAxis ? "along rays" : "along the axis",
        kPerCent * off(other),
        taken == DepthIs::AlongAxis ? "ray" : "axis");
}

std::optional<std::string> other_images(std::span<const DepthLook> looks) {
    constexpr std::size_t kEnough = 6;
    double count = 0.0;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const DepthLook& look : looks) {
        if (!look.altitude_m) continue;
        const Eigen::Vector2d both(std::log(look.depth_m), std::log(*look.altitude_m));
        count += 1.0;
        mean += both;
        spread += both * both.transpose();
    }
    if (count < static_cast<double>(kEnough)) return std::nullopt;
    mean /= count;
    spread = spread / count - mean * mean.transpose();
    const double deviation = std::sqrt(std::max(0.0, spread(1, 1)));
    if (deviation < kSpreadOfAltitudes) return std::nullopt;
    const double likeness = spread(0, 1) / std::sqrt(spread(0, 0) * spread(1, 1));
    if (likeness >= kLikeAltitudes) return std::nullopt;
    return fmt::format(
        "the altitudes that depth maps show do not go with the navigation's: their correlation is "
        "{:.2g} over {} images; are they other images' maps?",
        likeness,
        static_cast<std::size_t>(count));
}

}  // namespace

DepthLook look_at_depth(const DepthMap& map,
                        DepthIs is,
                        const ReliefMapMaker& rays,
                        const std::optional<Sled>& sled) {
    std::vector<double> depths;
    for (const float depth_m : map.depth_m)
        if (std::isfinite(depth_m)) depths.push_back(depth_m);
    DepthLook look{.depth_m = upper_median(depths), .flatness = flatness(map, rays), .taken = is};
    if (sled) look.altitude_m = sled->altitude_m;
    return look;
}

std::vector<std::string> depth_doubts(std::span<const DepthLook> looks,
                                      std::optional<double> rig_altitude_m) {
    std::vector<std::string> doubts;
    if (looks.empty()) return doubts;
    // The first explains what the others would say.
    for (const auto& doubt :
         {other_unit(looks, rig_altitude_m), other_convention(looks), other_images(looks)}) {
        if (doubt) {
            doubts.push_back(*doubt);
            break;
        }
    }
    return doubts;
}

}  // namespace aphotic
