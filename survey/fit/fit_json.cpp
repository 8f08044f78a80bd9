// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_json.h"

#include "base/degrees.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

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

// Of the shares, by beam and part, then of the numbers, in their units.
FitJson covariance_json(const FitResult& result) {
    FitJson of = FitJson::array();
    std::vector<double> units;
    for (std::size_t b = 0; b < result.state.beams.size(); ++b) {
        for (std::size_t part = 0; part < result.state.beams[b].parts(); ++part)
            of.push_back(fmt::format("beam.{}.share.{}", b + 1, part + 1));
    }
    units.assign(of.size(), 1.0);
    for (const FittedNumber& one : result.numbers) {
        of.push_back(one.key);
        units.push_back(one.per_unit);
    }
    const auto scale = Eigen::VectorXd::Map(units.data(), std::ssize(units)).asDiagonal();
    const Eigen::MatrixXd covariance = scale * result.covariance * scale;
    FitJson rows = FitJson::array();
    for (const auto row : covariance.rowwise())
        rows.push_back(std::vector<double>(row.begin(), row.end()));
    return {{"of", std::move(of)}, {"rows", std::move(rows)}};
}

std::string_view word_of(FitBeamKind kind) {
    switch (kind) {
        case FitBeamKind::Table:
            return "table";
        case FitBeamKind::Cones:
            return "cones";
        case FitBeamKind::Cosine:
            return "cosine";
        case FitBeamKind::Optics:
            return "optics";
        case FitBeamKind::Held:
            break;
    }
    return "held";
}

FitJson source_json(const FitResult& result) {
    const auto by_altitude = [](const ImageOutcome& image) { return image.sled.altitude_m; };
    const auto [lowest, highest] = std::ranges::minmax(result.left.images, {}, by_altitude);
    const FitBeam& beam = result.state.beams.front();
    return {{result.are_maps ? "maps" : "images", result.left.images.size()},
            {"altitude_m", {lowest.sled.altitude_m, highest.sled.altitude_m}},
            {"block_px", result.block_px},
            {"beam", word_of(beam.kind())},
            {"parts", beam.parts()}};
}

}  // namespace

FitJson to_json(const FitResult& result) {
    FitJson numbers = FitJson::array();
    for (const FittedNumber& one : result.numbers) {
        numbers.push_back({{"key", one.key},
                           {"start", one.start},
                           {"value", one.value},
                           {"error", one.error},
                           {"at_bound", one.is_at_bound}});
    }
    FitJson held = FitJson::array();
    for (const NotTold& one : result.held) {
        FitJson json{{"key", one.key},
                     {"error", one.error},
                     {"confounded_with",
                      one.confounded_with.empty() ? FitJson() : FitJson(one.confounded_with)}};
        json["fly_at_m"] = one.fly_at_m ? FitJson(*one.fly_at_m) : FitJson();
        if (one.fly_at_m) json["error_then"] = one.error_then;
        held.push_back(std::move(json));
    }
    FitJson confounded = FitJson::array();
    for (const Confounded& pair : result.confounded)
        confounded.push_back(
            {{"one", pair.one}, {"other", pair.other}, {"correlation", pair.correlation}});
    FitJson beams = FitJson::array();
    for (const auto& curve : result.beam_curves) beams.push_back(curve_json(curve));
    const auto deviation = [&](std::size_t k) { return std::sqrt(result.effects[k]); };
    return {{"fitted_to", source_json(result)},
            {"numbers", std::move(numbers)},
            {"held", std::move(held)},
            {"as_the_rig_has", result.fixed},
            {"confounded", std::move(confounded)},
            {"looks_wrong", to_json(result.looks_wrong)},
            {"beams", std::move(beams)},
            {"shares", std::vector<double>(result.shares.begin(), result.shares.end())},
            {"covariance", covariance_json(result)},
            {"residual", result.left.residual},
            {"pattern", result.left.pattern},
            {"blocks", result.blocks},
            {"image_deviations",
             {{"level", deviation(0)},
              {"red", deviation(1)},
              {"blue", deviation(2)},
              {"altitude_m", deviation(3)},
              {"pitch_deg", deviation(4) * kDegreesPerRadian},
              {"roll_deg", deviation(5) * kDegreesPerRadian}}},
            {"noise_variance", result.noise.variance},
            {"rounds", result.rounds},
            {"steps", result.steps}};
}

}  // namespace aphotic
