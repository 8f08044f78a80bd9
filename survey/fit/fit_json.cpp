// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_json.h"

#include "base/degrees.h"
#include "base/words.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace aphotic {
namespace {

using FitJson = nlohmann::ordered_json;

FitJson curve_json(const std::vector<BeamPoint>& curve) {
    FitJson json{{"theta_deg", FitJson::array()},
                 {"intensity", FitJson::array()},
                 {"error", FitJson::array()}};
    for (const BeamPoint& point : curve) {
        json["theta_deg"].push_back(point.theta_rad * kDegreesPerRadian);
        json["intensity"].push_back(point.intensity);
        json["error"].push_back(point.error);
    }
    return json;
}

FitJson covariance_json(const FitResult& result) {
    FitJson of = FitJson::array();
    for (const FittedNumber& one : result.numbers) of.push_back(one.key);
    FitJson rows = FitJson::array();
    for (const auto row : result.covariance.rowwise())
        rows.push_back(std::vector<double>(row.begin(), row.end()));
    return {{"of", std::move(of)}, {"rows", std::move(rows)}};
}

FitJson source_json(const FitResult& result) {
    const auto by_altitude = [](const ImageOutcome& image) { return image.sled.altitude_m; };
    const FitBeamKind beam = result.state.beams.front().kind();
    const auto [lowest, highest] = std::ranges::minmax(result.images, {}, by_altitude);
    return {{result.are_maps ? "maps" : "images", result.images.size()},
            {"blocks", result.blocks},
            {"block_px", result.block_px},
            {"altitude_m", {lowest.sled.altitude_m, highest.sled.altitude_m}},
            {"beam", beam == FitBeamKind::Held ? "held" : name_of(kFitBeams, beam)}};
}

FitJson number_json(const FittedNumber& one) {
    FitJson json{{"key", one.key},
                 {"start", one.start},
                 {"value", one.value},
                 {"error", one.error},
                 {"prior", one.spread},
                 {"determined", one.is_determined}};
    if (one.fly_at)
        json["fly_at"] = {{"altitude_m", one.fly_at->altitude_m}, {"error", one.fly_at->error}};
    return json;
}

}  // namespace

FitJson to_json(const FitResult& result) {
    FitJson numbers = FitJson::array();
    for (const FittedNumber& one : result.numbers) numbers.push_back(number_json(one));
    FitJson confounded = FitJson::array();
    for (const Confounded& pair : result.confounded)
        confounded.push_back(
            {{"one", pair.one}, {"other", pair.other}, {"correlation", pair.correlation}});
    FitJson beams = FitJson::array();
    for (const auto& curve : result.beam_curves) beams.push_back(curve_json(curve));
    FitJson images = FitJson::array();
    for (const ImageOutcome& image : result.images) {
        images.push_back({{"name", image.name},
                          {"altitude_m", image.sled.altitude_m},
                          {"floor_brightness", image.brightness},
                          {"altitude_off_m", image.off.x()},
                          {"pitch_off_deg", image.off.y() * kDegreesPerRadian},
                          {"roll_off_deg", image.off.z() * kDegreesPerRadian}});
    }
    return {{"fitted_to", source_json(result)},
            {"expected_unevenness", result.unevenness},
            {"moved", result.moved},
            {"rig_expected_unevenness", rig_unevenness(result)},
            {"numbers", std::move(numbers)},
            {"fixed", result.fixed},
            {"beams", std::move(beams)},
            {"confounded", std::move(confounded)},
            {"looks_wrong", to_json(result.looks_wrong)},
            {"pattern", to_json(result.pattern)},
            {"veil_share", result.veil_share},
            {"texture", result.texture},
            {"floor_brightness_spread", result.level_spread},
            {"images", std::move(images)},
            {"covariance", covariance_json(result)},
            {"dispersion", result.dispersion},
            {"rounds", result.rounds},
            {"dropouts", to_json(result.marked)}};
}

}  // namespace aphotic
