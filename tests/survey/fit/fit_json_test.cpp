// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_json.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aphotic::fit_json_test {
namespace {

// A share and two numbers, one of which is told in degrees.
FitResult of_two_numbers() {
    FitResult result;
    result.state.beams = {FitBeam::cosine(2.0)};
    result.shares = Eigen::VectorXd::Ones(1);
    result.covariance = Eigen::Vector3d(0.01, 4.0, 9.0).asDiagonal();
    constexpr double kDegrees = 57.0;
    result.numbers.resize(2);
    result.numbers[0].key = "water.multiple";
    result.numbers[1].key = "strobe.fore.aim_along_deg";
    result.numbers[1].per_unit = kDegrees;
    result.left.images.resize(3);
    result.left.images[0].sled.altitude_m = 2.0;
    result.left.images[1].sled.altitude_m = 3.0;
    result.left.images[2].sled.altitude_m = 1.0;
    result.block_px = 8;
    return result;
}

TEST(FitJson, TellsWhatItWasFittedTo) {
    FitResult result = of_two_numbers();
    EXPECT_EQ(to_json(result).at("fitted_to"),
              nlohmann::ordered_json::parse(
                  R"({"images": 3, "altitude_m": [1.0, 3.0], "block_px": 8, "beam": "cosine",
                      "parts": 1})"));
    result.are_maps = true;
    EXPECT_EQ(to_json(result).at("fitted_to").at("maps"), 3);
}

TEST(FitJson, HasAllInTheUnitsOfItsKeys) {
    const auto json = to_json(of_two_numbers());
    const auto& rows = json.at("covariance").at("rows");
    EXPECT_EQ(rows.at(0).at(0), 0.01);
    EXPECT_EQ(rows.at(1).at(1), 4.0);
    EXPECT_EQ(rows.at(2).at(2), 9.0 * 57.0 * 57.0);
}

}  // namespace
}  // namespace aphotic::fit_json_test
