// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_json.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aphotic::fit_json_test {
namespace {

FitResult of_two_numbers() {
    FitResult result;
    result.state.beams = {FitBeam(FitBeamKind::Held, {}, 1.0, 0.02)};
    result.numbers = {{.key = "water.multiple", .start = 1.0, .value = 1.1, .error = 0.1},
                      {.key = "strobe.fore.aim_along_deg",
                       .error = 3.0,
                       .spread = 2.0,
                       .is_determined = false,
                       .fly_at = FlyAt{.altitude_m = 1.2, .error = 0.5}}};
    result.covariance = Eigen::Vector2d(0.01, 9.0).asDiagonal();
    result.images.resize(3);
    result.images[0].sled.altitude_m = 2.0;
    result.images[1].sled.altitude_m = 3.0;
    result.images[2].sled.altitude_m = 1.0;
    result.block_px = 8;
    result.blocks = 700;
    result.dispersion = 2.5;
    return result;
}

TEST(FitJson, TellsWhatItWasFittedTo) {
    FitResult result = of_two_numbers();
    EXPECT_EQ(to_json(result).at("fitted_to"),
              nlohmann::ordered_json::parse(
                  R"({"images": 3, "blocks": 700, "block_px": 8, "altitude_m": [1.0, 3.0],
                      "beam": "held"})"));
    result.are_maps = true;
    EXPECT_EQ(to_json(result).at("fitted_to").at("maps"), 3);
}

TEST(FitJson, NumbersHaveTheirErrorsAndWhatWouldDetermineThem) {
    const auto json = to_json(of_two_numbers());
    const auto& rows = json.at("covariance").at("rows");
    EXPECT_EQ(rows.at(0).at(0), 0.01);
    EXPECT_EQ(rows.at(1).at(1), 9.0);
    EXPECT_EQ(json.at("dispersion"), 2.5);
    EXPECT_EQ(json.at("covariance").at("of").at(1), "strobe.fore.aim_along_deg");
    const auto& numbers = json.at("numbers");
    EXPECT_EQ(numbers.at(0).at("value"), 1.1);
    EXPECT_EQ(numbers.at(0).at("determined"), true);
    EXPECT_FALSE(numbers.at(0).contains("fly_at"));
    EXPECT_EQ(numbers.at(1).at("determined"), false);
    EXPECT_EQ(numbers.at(1).at("fly_at").at("altitude_m"), 1.2);
}

}  // namespace
}  // namespace aphotic::fit_json_test
