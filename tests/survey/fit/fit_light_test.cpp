// SPDX-License-Identifier: BSD-3-Clause
//
// The fit's light against lightmaps, which share no code with it, and its derivatives against
// differences.
#include "survey/fit/fit_light.h"

#include "base/degrees.h"
#include "support/fit_rig.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::fit_light_test {
namespace {

// Bands of a nanometre against an adaptive grid.
constexpr double kBands = 3e-4;
// Besides, kFitVeilPoints over the veil's angle, and a phase function's table.
constexpr double kVeilRule = 2e-3;
// Where all of the signal is veil, from farther away than these points are made for.
constexpr double kVeilOfTheHorizon = 1e-2;
// Central differences of the light, and the water's own.
constexpr double kDifference = 2e-5;
// Where the veil ends moves a rule whose panel a spline's knots cross.
constexpr double kVeilDifference = 3e-4;

const Sled kTilted{
    .altitude_m = 1.7, .pitch_rad = 3.0 * kRadiansPerDegree, .roll_rad = -2.0 * kRadiansPerDegree};

struct Known {
    RigText text;
    Rig rig = text.rig();
    FitState state{};
    FitPlaces places{};
    explicit Known(const FitRigNumbers& numbers) : text(fit_rig(numbers)) {
        places = fit_places(rig.camera.width_px, rig.camera.height_px, rig.camera.width_px);
        state.beams = {FitBeam::held(rig.strobes[0].beam)};
        state.beam_of = {0, 0};
        state.aim_rad = {{0.0, 0.0}, {0.0, 0.0}};
        state.power = {rig.strobes[0].power, rig.strobes[1].power};
        state.water = {{"water.multiple", rig.water.multiple}};
        state.vignetting = {-0.1, 0.0, 0.0};
    }
};

// A lightmap's mean over the blocks of these places, R, G, B of each.
std::vector<double> means_of(const std::vector<float>& map, const FitPlaces& places) {
    const std::size_t pixels = map.size() / kChannels;
    const auto width = static_cast<std::size_t>(places.width_px);
    const auto block = static_cast<std::size_t>(places.block_px);
    std::vector<double> means;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const auto left = static_cast<std::size_t>(places.columns[k]) - block / 2;
        const auto top = static_cast<std::size_t>(places.rows[k]) - block / 2;
        for (std::size_t c = 0; c < kChannels; ++c) {
            double sum = 0.0;
            for (std::size_t i = 0; i < block * block; ++i)
                sum += map[c * pixels + (top + i / block) * width + left + i % block];
            means.push_back(sum / static_cast<double>(block * block));
        }
    }
    return means;
}

double worst_against_lightmap(const FitRigNumbers& numbers,
                              const Sled& sled = kTilted,
                              int pixels_of_block = 1) {
    Known known(numbers);
    known.places =
        fit_places(numbers.width_px, numbers.height_px, numbers.width_px / pixels_of_block);
    const FitLight light(known.rig, known.places);
    const PathLight path(known.text, known.state.water, {}, light.paths({sled}), false);
    FitLight::Rows rows;
    light.parts_into(known.state, path, sled, rows);
    const LightmapMaker maker(known.rig, paths_of(known.rig, {sled}), {});
    const std::vector<double> wanted = means_of(signal_of(maker.map(sled)), known.places);
    double worst = 0.0;
    for (std::size_t row = 0; row < wanted.size(); ++row)
        worst =
            std::max(worst, std::abs(rows(static_cast<Eigen::Index>(row), 0) / wanted[row] - 1));
    return worst;
}

TEST(FitLight, IsTheLightmapOfTheSameRig) {
    EXPECT_LT(worst_against_lightmap({}), kBands);
}

// Seventeen blocks across; of their middles alone the light would be off by 1.3e-3.
TEST(FitLight, IsTheMeanOverBlocks) {
    FitRigNumbers numbers;
    numbers.width_px = 136;
    numbers.height_px = 104;
    EXPECT_LT(worst_against_lightmap(numbers, kTilted, 8), kBands);
    // Eight and a half, that see the light bend from each to the next.
    constexpr double kCoarse = 2e-3;
    EXPECT_LT(worst_against_lightmap(numbers, kTilted, 16), kCoarse);
}

TEST(FitLight, HasTheVeilOfTheSameRig) {
    FitRigNumbers numbers;
    numbers.water = "type = \"jerlov-1C\"\nmultiple = {}";
    EXPECT_LT(worst_against_lightmap(numbers), kVeilRule);
    numbers.width_px = 20;
    numbers.height_px = 15;  // of which the veil has kFewestVeilNodes
    EXPECT_LT(worst_against_lightmap(numbers), kVeilRule);
}

TEST(FitLight, HasTheVeilUpToTheHorizon) {
    FitRigNumbers numbers;
    numbers.water = "type = \"jerlov-1C\"\nmultiple = {}";
    const Sled ahead{.altitude_m = 4.0, .pitch_rad = 80.0 * kRadiansPerDegree, .roll_rad = 0.0};
    EXPECT_LT(worst_against_lightmap(numbers, ahead), kVeilOfTheHorizon);
}

// Every number there is, and the pose's three.
void expect_slopes(const FitRigNumbers& numbers, const FitBeam& beam, double most) {
    Known known(numbers);
    known.state.beams = {beam};
    known.state.floor = {0.2, -0.1};
    known.state.floor_brightness = 1.4;
    known.state.aim_rad = {{0.03, -0.02}, {0.01, 0.04}};
    const FitLight light(known.rig, known.places);
    const Eigen::VectorXd shares =
        Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(beam.parts()), 2.0, 0.5);
    std::vector<FitNumber> free{{FitPart::Water, 0, 0},
                                {FitPart::Aim, 0, 0},
                                {FitPart::Aim, 0, 1},
                                {FitPart::Aim, 1, 1},
                                {FitPart::Power, 1, 0},
                                {FitPart::LensFactor, 0, 0},
                                {FitPart::LensFactor, 0, 2},
                                {FitPart::Gain, 2, 0},
                                {FitPart::FloorColour, 0, 0},
                                {FitPart::FloorColour, 0, 1},
                                {FitPart::FloorBrightness, 0, 0},
                                {FitPart::Offset, 0, 0},
                                {FitPart::Offset, 0, 1},
                                {FitPart::Offset, 0, 2}};
    for (std::size_t k = 0; k < beam.shapes().size(); ++k)
        free.push_back({FitPart::BeamShape, 0, k});
    const PathRange paths = light.paths({kTilted});
    FitLight::Rows all;
    light.columns_into(known.state,
                       {known.text, known.state.water, known.state.floor, paths, true},
                       kTilted,
                       shares,
                       free,
                       all);
    const auto signal = [&](const FitState& state) {
        FitLight::Rows parts;
        light.parts_into(
            state, {known.text, state.water, state.floor, paths, false}, kTilted, parts);
        return Eigen::VectorXd(parts * shares);
    };
    // Parts and signal are those of the light without slopes.
    constexpr double kRounding = 1e-12;
    EXPECT_LT((all.leftCols(shares.size()) * shares - signal(known.state)).norm(),
              kRounding * signal(known.state).norm());
    EXPECT_LT((all.rightCols<1>() - signal(known.state)).norm(),
              kRounding * signal(known.state).norm());
    for (std::size_t k = 0; k < free.size(); ++k) {
        constexpr double kStep = 1e-5;
        FitState more = known.state;
        FitState less = known.state;
        number_in(more, free[k]) += kStep;
        number_in(less, free[k]) -= kStep;
        const Eigen::VectorXd wanted = (signal(more) - signal(less)) / (2.0 * kStep);
        const auto column = shares.size() + static_cast<Eigen::Index>(k);
        const double off = (all.col(column) - wanted).norm();
        EXPECT_LT(off, most * wanted.norm()) << "number " << k;
    }
}

// The pose's need no derivatives over the water, which an image's own pose is found without.
TEST(FitLight, SlopesOfThePoseWithoutThoseOfTheWater) {
    for (const char* water :
         {"absorption = \"pope-fry-1997\"\nmultiple = {}", "type = \"jerlov-1C\"\nmultiple = {}"}) {
        FitRigNumbers numbers;
        numbers.water = water;
        const Known known(numbers);
        const FitLight light(known.rig, known.places);
        const PathRange paths = light.paths({kTilted});
        const auto pose_columns = [&](bool has_derivatives) {
            FitLight::Rows all;
            light.columns_into(
                known.state,
                {known.text, known.state.water, known.state.floor, paths, has_derivatives},
                kTilted,
                Eigen::VectorXd::Ones(1),
                {},
                all);
            return FitLight::Rows(all.middleCols(1, FitLight::kPoseColumns));
        };
        EXPECT_EQ(pose_columns(false), pose_columns(true));
    }
}

TEST(FitLight, SlopesAreThoseOfTheLight) {
    expect_slopes({}, FitBeam::table(12, 1.2), kDifference);
    expect_slopes({}, FitBeam::cosine(5.0), kDifference);
}

TEST(FitLight, SlopesOfTheVeil) {
    FitRigNumbers numbers;
    numbers.water = "type = \"jerlov-1C\"\nmultiple = {}";
    numbers.width_px = 16;
    numbers.height_px = 12;
    expect_slopes(numbers, FitBeam::table(12, 1.5), kVeilDifference);
}

// p is 1 in the corners of an image whose middle is the lens'.
TEST(FitLight, IsBrightWhereTheCornersAre) {
    Known known({});
    const FitLight light(known.rig, known.places);
    known.state.vignetting = {-0.5, -0.49, 0.0};
    EXPECT_TRUE(light.is_bright(known.state));
    known.state.vignetting = {-0.5, -0.51, 0.0};
    EXPECT_FALSE(light.is_bright(known.state));
    known.state.vignetting = {-4.0, 3.9, 0.0};  // dark half-way
    EXPECT_FALSE(light.is_bright(known.state));
    known.state.vignetting.clear();  // the rig's own
    EXPECT_TRUE(light.is_bright(known.state));
}

}  // namespace
}  // namespace aphotic::fit_light_test
