// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation/navigation_ifdo.h"

#include "base/degrees.h"
#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace aphotic {
namespace {

constexpr const char* kIfdoOverSea = "image-altitude-meters";

bool has_value_of(const Ifdo& ifdo, const std::string& key) {
    if (!ifdo.field(IfdoJson::object(), key).is_null()) return true;
    return std::ranges::any_of(ifdo.items(), [&](const IfdoJson& item) {
        const IfdoJson* image = still_image(item);
        return image != nullptr && !ifdo.field(*image, key).is_null();
    });
}

std::string without_height(const Ifdo& ifdo, const IfdoJson& image) {
    return fmt::format(
        "found no {}{}",
        kIfdoHeight,
        ifdo.field(image, kIfdoOverSea).is_null()
            ? ""
            : fmt::format("; {} is above sea level, not above the floor", kIfdoOverSea));
}

// NaN and a fault unless it is a number.
double ifdo_number(const Ifdo& ifdo, const IfdoJson& image, const char* key, ImagePose& pose) {
    const IfdoJson& field = ifdo.field(image, key);
    if (field.is_number()) return field.get<double>();
    if (pose.fault.empty()) {
        pose.fault = field.is_null()
                         ? fmt::format("found no {}", key)
                         : fmt::format("{}: found a {}; allowed: a number", key, field.type_name());
    }
    return std::numeric_limits<double>::quiet_NaN();
}

ImagePose ifdo_pose(const Ifdo& ifdo,
                    const std::string& name,
                    const IfdoJson& item,
                    const GivenAngles& given,
                    const Sled& rig_sled) {
    ImagePose pose{.image = name, .sled = rig_sled};
    const IfdoJson* image = still_image(item);
    if (image == nullptr) {
        pose.fault = item.is_array()
                         ? fmt::format("found {} objects, as of a video; allowed: 1", item.size())
                         : fmt::format("found a {}; allowed: an object", item.type_name());
        return pose;
    }
    if (ifdo.field(*image, kIfdoHeight).is_null()) {
        pose.fault = without_height(ifdo, *image);
        return pose;
    }
    const double height_m = ifdo_number(ifdo, *image, kIfdoHeight, pose);
    Sled& sled = pose.sled;
    if (given.pitch)
        sled.pitch_rad = ifdo_number(ifdo, *image, kIfdoPitch, pose) * kRadiansPerDegree;
    if (given.roll) sled.roll_rad = ifdo_number(ifdo, *image, kIfdoRoll, pose) * kRadiansPerDegree;
    sled.altitude_m = height_m;
    if (pose.fault.empty()) pose.fault = fault_of(sled);
    sled.altitude_m /= std::cos(sled.pitch_rad) * std::cos(sled.roll_rad);
    return pose;
}

}  // namespace

Navigation parse_navigation_ifdo(const std::string& name,
                                 std::string_view text,
                                 const Sled& rig_sled) {
    const Ifdo ifdo = parse_ifdo(name, text);
    if (ifdo.items().empty()) throw InputError("{}: found no image in image-set-items", name);
    if (!has_value_of(ifdo, kIfdoHeight)) {
        throw InputError(
            "{}: {}, in the header or of any image; allowed: the camera's height above the sea "
            "floor in metres",
            name,
            without_height(ifdo, *ifdo.items().begin()));
    }
    const GivenAngles given{.pitch = has_value_of(ifdo, kIfdoPitch),
                            .roll = has_value_of(ifdo, kIfdoRoll)};
    std::vector<ImagePose> poses;
    for (const auto& [image, item] : ifdo.items().items()) {
        poses.push_back(ifdo_pose(ifdo, image, item, given, rig_sled));
    }
    return {name, poses, given};
}

}  // namespace aphotic
