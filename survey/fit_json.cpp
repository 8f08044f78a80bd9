// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit_json.h"

#include "base/degrees.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace aphotic {
namespace {

using Json = nlohmann::ordered_json;

Json curve_json(const std::vector<BeamPoint>& curve) {
    Json json{{"theta_deg", Json::array()}, {"intensity", Json::array()}, {"error", Json::array()}};
    for (const BeamPoint& point : curve) {
        json["theta_deg"].push_back(point.theta_rad * kDegreesPerRadian);
        json["intensity"].push_back(point.intensity);
        json["error"].push_back(point.error);
    }
    return json;
}

Json matrix_json(const Eigen::MatrixXd& matrix) {
    Json rows = Json::array();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
        Json row = Json::array();
        for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
        rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace

Json to_json(const FitResult& result) {
    Json numbers = Json::array();
    for (const FittedNumber& one : result.numbers) {
        numbers.push_back({{"key", one.key},
                           {"start", one.start},
                           {"value", one.value},
                           {"error", one.error},
                           {"at_bound", one.is_at_bound}});
    }
    Json held = Json::array();
    for (const NotTold& one : result.held) {
        Json json{
            {"key", one.key},
            {"error", one.error},
            {"confounded_with", one.confounded_with.empty() ? Json() : Json(one.confounded_with)}};
        json["fly_at_m"] = one.fly_at_m ? Json(*one.fly_at_m) : Json();
        if (one.fly_at_m) json["error_then"] = one.error_then;
        held.push_back(std::move(json));
    }
    Json confounded = Json::array();
    for (const Confounded& pair : result.confounded)
        confounded.push_back(
            {{"one", pair.one}, {"other", pair.other}, {"correlation", pair.correlation}});
    Json doubts = Json::array();
    for (const FitDoubt& doubt : result.doubts)
        doubts.push_back({{"what", doubt.what}, {"size", doubt.size}});
    Json beams = Json::array();
    for (const auto& curve : result.beam_curves) beams.push_back(curve_json(curve));
    const auto deviation = [&](std::size_t k) { return std::sqrt(result.effects[k]); };
    return {{"numbers", std::move(numbers)},
            {"held", std::move(held)},
            {"confounded", std::move(confounded)},
            {"doubts", std::move(doubts)},
            {"beams", std::move(beams)},
            {"shares", std::vector<double>(result.shares.begin(), result.shares.end())},
            {"covariance", matrix_json(result.covariance)},
            {"residual", result.residual},
            {"pattern", result.pattern},
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
