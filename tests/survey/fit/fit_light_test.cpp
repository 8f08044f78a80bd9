// SPDX-License-Identifier: BSD-3-Clause
//
// The fit's light against lightmaps of the same rig, and its derivatives against differences.
#include "survey/fit/fit_light.h"

#include "base/degrees.h"
#include "support/fit_rig.h"
#include "support/hills.h"
#include "survey/fit/block_planes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::fit_light_test {
namespace {

// Bands of a nanometre against an adaptive grid.
constexpr double kBands = 3e-4;
// Besides, kFitVeilPoints over the veil's angle, and a polynomial over the image.
constexpr double kVeilRule = 3e-3;
// Central differences of the light.
constexpr double kDifference = 2e-5;
// The same over what tables of floats depend on, by longer steps.
constexpr double kTableDifference = 3e-4;

const Sled kTilted{
    .altitude_m = 1.7, .pitch_rad = 3.0 * kRadiansPerDegree, .roll_rad = -2.0 * kRadiansPerDegree};

struct Known {
    RigText text;
    Rig rig = text.rig();
    FitState state{};
    FitPlaces places{};
    Known(const FitRigNumbers& numbers, FitBeamKind kind) : text(fit_rig(numbers)) {
        places = fit_places(rig.camera.width_px, rig.camera.height_px, rig.camera.width_px);
        state.beams = {FitBeam(kind, rig.strobes[0].beam, 1.0, 0.05)};
        state.beam_of = {0, 0};
        state.aim_rad = {{0.0, 0.0}, {0.0, 0.0}};
        state.power = {rig.strobes[0].power, rig.strobes[1].power};
        state.water = {{rig.water.scatters() ? "water.chlorophyll_mg_m3" : "water.multiple",
                        numbers.multiple}};
    }
};

// A lightmap's mean over the blocks of these places, R, G, B of each.
std::vector<double> means_of(const std::vector<float>& map, const FitPlaces& places) {
    const std::size_t pixels = map.size() / kChannels;
    const auto width = static_cast<std::size_t>(places.width_px);
    const auto block = static_cast<std::size_t>(places.block_px);
    std::vector<double> means;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const auto left = static_cast<std::size_t>(places.column(k)) - block / 2;
        const auto top = static_cast<std::size_t>(places.row(k)) - block / 2;
        for (std::size_t c = 0; c < kChannels; ++c) {
            double sum = 0.0;
            for (std::size_t i = 0; i < block * block; ++i)
                sum += map[c * pixels + (top + i / block) * width + left + i % block];
            means.push_back(sum / static_cast<double>(block * block));
        }
    }
    return means;
}

double worst_against_lightmap(const FitRigNumbers& numbers, int pixels_of_block = 1) {
    Known known(numbers, FitBeamKind::Held);
    known.places =
        fit_places(numbers.width_px, numbers.height_px, numbers.width_px / pixels_of_block);
    const FitLight light(known.rig, known.places);
    const PathLight path(
        known.text, known.state.water, {}, light.paths({{.name = {}, .sled = kTilted}}));
    const BlockLight found = light.at(known.state, path, kTilted, {});
    const LightmapMaker maker(known.rig, paths_of(known.rig, {kTilted}), {});
    const std::vector<double> wanted = means_of(signal_of(maker.map(kTilted)), known.places);
    double worst = 0.0;
    for (std::size_t row = 0; row < wanted.size(); ++row) {
        const double signal = std::exp(found.logarithm(static_cast<Eigen::Index>(row)));
        worst = std::max(worst, std::abs(signal / wanted[row] - 1.0));
    }
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
    EXPECT_LT(worst_against_lightmap(numbers, 8), kBands);
    // Eight and a half, that see the light bend from each to the next.
    constexpr double kCoarse = 2e-3;
    EXPECT_LT(worst_against_lightmap(numbers, 16), kCoarse);
}

TEST(FitLight, HasTheVeilOfTheSameRig) {
    FitRigNumbers numbers;
    numbers.water = "chlorophyll_mg_m3 = {}";
    numbers.multiple = 0.4;
    EXPECT_LT(worst_against_lightmap(numbers), kVeilRule);
}

// Of hills, a plane for each pixel: the map on their relief, but where a lamp is behind one.
double worst_against_relief_map(const FitRigNumbers& numbers) {
    Known known(numbers, FitBeamKind::Held);
    const FitLight light(known.rig, known.places);
    const ReliefMapMaker maker(known.rig, {});
    const Relief relief = relief_of(Hills{}, maker, numbers.width_px, numbers.height_px);
    const FitImage image{
        .name = {}, .sled = {}, .planes = block_planes(relief, known.places, known.rig)};
    const PathLight path(known.text, known.state.water, {}, light.paths({image}));
    const BlockLight found = light.at(known.state, path, image.sled, {}, image.planes);
    const std::vector<double> wanted = means_of(signal_of(maker.map(relief, 0).map), known.places);
    double worst = 0.0;
    for (std::size_t row = 0; row < wanted.size(); ++row) {
        if (!std::isfinite(image.planes[row / kChannels].normal.z())) continue;
        const double signal = std::exp(found.logarithm(static_cast<Eigen::Index>(row)));
        worst = std::max(worst, std::abs(signal / wanted[row] - 1.0));
    }
    return worst;
}

TEST(FitLight, OnPlanesOfAReliefIsItsMap) {
    EXPECT_LT(worst_against_relief_map({}), kBands);
    FitRigNumbers numbers;
    numbers.water = "chlorophyll_mg_m3 = {}";
    numbers.multiple = 0.4;
    EXPECT_LT(worst_against_relief_map(numbers), kVeilRule);
}

// On planes of its own each number does what it does on the same plane of the sled, and the pose
// nothing. A block without a plane has no light.
TEST(FitLight, OnPlanesThatAreOneIsTheSame) {
    constexpr double kRounding = 1e-9;
    const Known known({}, FitBeamKind::Cosine);
    const FitLight light(known.rig, known.places);
    const std::vector<FitPlaceInState> free{{FitPart::Beam, 0, 0},
                                            {FitPart::Aim, 1, 0},
                                            {FitPart::Power, 0},
                                            {FitPart::Water, 0},
                                            {FitPart::Offset, 0, 0}};
    const PathLight path(
        known.text, known.state.water, {}, light.paths({{.name = {}, .sled = kTilted}}));
    std::vector<Plane> planes(known.places.size(), floor_plane(kTilted));
    const BlockLight one = light.at(known.state, path, kTilted, free);
    const BlockLight same = light.at(known.state, path, {.altitude_m = 9.0}, free, planes);
    EXPECT_LT((same.logarithm - one.logarithm).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_LT((same.slopes - one.slopes).leftCols(4).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_EQ(same.slopes.col(4).norm(), 0.0);
    EXPECT_EQ(same.by_pose.norm(), 0.0);
    planes[0].normal.setConstant(std::nan(""));
    const BlockLight less = light.at(known.state, path, kTilted, free, planes);
    EXPECT_TRUE(std::isnan(less.logarithm(0)));
    EXPECT_EQ(less.logarithm(kChannels), same.logarithm(kChannels));
}

// Every number there is, and the pose's three. The veil's change with the pose is left out.
void expect_slopes(const FitRigNumbers& numbers, FitBeamKind kind) {
    Known known(numbers, kind);
    known.state.vignetting = {3.0};
    known.state.tint = {0.2, -0.1};
    known.state.floor_brightness = 1.4;
    known.state.aim_rad = {{0.03, -0.02}, {0.01, 0.04}};
    const FitLight light(known.rig, known.places);
    std::vector<FitPlaceInState> free;
    for (std::size_t k = 0; k < known.state.beams[0].coefficients().size(); ++k)
        free.push_back({FitPart::Beam, 0, k});
    for (const FitPlaceInState& one : {FitPlaceInState{FitPart::Aim, 0, 0},
                                       {FitPart::Aim, 0, 1},
                                       {FitPart::Aim, 1, 1},
                                       {FitPart::Power, 1},
                                       {FitPart::Water, 0},
                                       {FitPart::Tint, 0, 0},
                                       {FitPart::Tint, 0, 1},
                                       {FitPart::Brightness},
                                       {FitPart::Lens},
                                       {FitPart::Offset, 0, 0},
                                       {FitPart::Offset, 0, 1},
                                       {FitPart::Offset, 0, 2}})
        free.push_back(one);
    const PathRange paths = light.paths({{.name = {}, .sled = kTilted}});
    const auto at = [&](const FitState& state) {
        return light.at(state, {known.text, state.water, state.tint, paths}, kTilted, free);
    };
    const BlockLight found = at(known.state);
    for (std::size_t k = 0; k < free.size(); ++k) {
        if (known.rig.water.scatters() && free[k].part == FitPart::Offset) continue;
        const bool is_of_table = free[k].part == FitPart::Water || free[k].part == FitPart::Tint;
        const double step = is_of_table ? 3e-3 : 1e-5;
        const double most = is_of_table ? kTableDifference : kDifference;
        FitState more = known.state;
        FitState less = known.state;
        number_in(more, free[k]) += step;
        number_in(less, free[k]) -= step;
        const Eigen::VectorXd wanted = (at(more).logarithm - at(less).logarithm) / (2.0 * step);
        const Eigen::VectorXd slopes = found.slopes.col(static_cast<Eigen::Index>(k));
        EXPECT_LT((slopes - wanted).norm(), most * std::max(wanted.norm(), 1e-3))
            << "number " << k << " of part " << static_cast<int>(free[k].part);
        if (free[k].part != FitPart::Offset) continue;
        EXPECT_EQ(found.by_pose.col(static_cast<Eigen::Index>(free[k].which)), slopes);
    }
}

TEST(FitLight, SlopesAreThoseOfTheLight) {
    for (const FitBeamKind kind : {FitBeamKind::Table, FitBeamKind::Cones, FitBeamKind::Cosine}) {
        SCOPED_TRACE(static_cast<int>(kind));
        expect_slopes({}, kind);
        FitRigNumbers numbers;
        numbers.water = "chlorophyll_mg_m3 = {}";
        numbers.multiple = 0.4;
        expect_slopes(numbers, kind);
    }
}

}  // namespace
}  // namespace aphotic::fit_light_test
