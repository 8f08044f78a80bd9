// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/atlas.h"

#include "base/error.h"
#include "image/exr.h"
#include "lightmap/atlas_export.h"
#include "rig/rig_reader.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aphotic::atlas_test {
namespace {

namespace fs = std::filesystem;

constexpr double kDegree = std::numbers::pi / 180.0;

Rig habcam() {
    Rig rig = read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
    rig.camera.pixel_pitch_m *= rig.camera.width_px / 68.0;
    rig.camera.width_px = 68;
    rig.camera.height_px = 51;
    return rig;
}

MapAxes few_bins() {
    return {.altitude_m = {1.8, 2.0, 2.2},
            .pitch_rad = {0.0, 2.0 * kDegree},
            .roll_rad = {0.0},
            .water_multiple = {1.0}};
}

std::size_t write(const fs::path& folder, const MapAxes& axes, const Rig& rig = habcam()) {
    return write_atlas(folder,
                       rig,
                       {.axes = axes,
                        .interpolation = interpolation_error(rig, axes),
                        .map = {.error = 1e-5, .threads = 2},
                        .version = "test",
                        .progress = {}});
}

Lightmap direct(const Rig& rig, const Sled& sled) {
    return LightmapMaker(rig, paths_of(rig, {sled}), {}).map(sled);
}

TEST(Atlas, GivesItsBinsToTheBit) {
    const TempFolder folder;
    EXPECT_EQ(write(folder.path(), few_bins()), 6U);
    Atlas atlas(folder.path());
    const Rig rig = habcam();
    MapSource source(rig, few_bins(), {.error = 1e-5, .threads = 1});
    for (const MapPoint& point : points_of(few_bins())) {
        EXPECT_EQ(atlas.map(point).samples, source.map(point).samples);
    }
}

// Of light without an edge in view every sample is as near as stated.
TEST(Atlas, IsAsFarFromTheTruthBetweenBinsAsItStates) {
    Rig rig = habcam();
    for (Strobe& strobe : rig.strobes) {
        strobe.beam.cones = {
            {.part = "diffuse", .half_angle_rad = 0.5 * std::numbers::pi, .weight = 1.0}};
    }
    const TempFolder folder;
    const MapAxes axes{.altitude_m = {1.8, 2.0, 2.2},
                       .pitch_rad = {0.0, 2.0 * kDegree},
                       .roll_rad = {-3.0 * kDegree, 0.0},
                       .water_multiple = {0.5, 1.0}};
    write(folder.path(), axes, rig);
    Atlas atlas(folder.path());
    const InterpolationError stated = atlas.manifest().interpolation;
    EXPECT_LT(stated.rms, stated.worst);
    for (const double share : {0.2, 0.5, 0.9}) {
        const MapPoint point{.sled = {.altitude_m = 1.8 + 0.4 * share,
                                      .pitch_rad = 2.0 * kDegree * share,
                                      .roll_rad = -3.0 * kDegree * share},
                             .water_multiple = 0.5 + 0.5 * share};
        Rig there = rig;
        there.water.multiple = point.water_multiple;
        const Lightmap found = atlas.map(point);
        const Lightmap truth = direct(there, point.sled);
        for (std::size_t i = 0; i < truth.samples.size(); ++i) {
            ASSERT_NEAR(found.samples[i] / truth.samples[i], 1.0F, stated.worst) << share;
        }
    }
}

// Of light with edges, wherever none lies between the point and the bins about it.
TEST(Atlas, IsOffMoreOnlyWhereEdgesCross) {
    const TempFolder folder;
    write(folder.path(), few_bins());
    Atlas atlas(folder.path());
    const MapPoint point{.sled = {.altitude_m = 1.93, .pitch_rad = 0.7 * kDegree, .roll_rad = 0.0}};
    const Lightmap found = atlas.map(point);
    const Lightmap truth = direct(habcam(), point.sled);
    MapSource source(habcam(), few_bins(), {});
    const std::vector<double> cones = source.cones(point);
    std::vector<char> is_crossed(cones.size(), 0);
    for (const MapPoint& corner : points_of(few_bins())) {
        const std::vector<double> there = source.cones(corner);
        for (std::size_t i = 0; i < cones.size(); ++i) is_crossed[i] |= there[i] != cones[i];
    }
    // The stated error is of all cones together; where some strobes have more of them, theirs
    // counts for more.
    constexpr double kOtherMix = 1.5;
    const double most = kOtherMix * atlas.manifest().interpolation.worst;
    for (std::size_t i = 0; i < truth.samples.size(); ++i) {
        if (is_crossed[i % cones.size()] != 0) continue;
        ASSERT_NEAR(found.samples[i] / truth.samples[i], 1.0F, most) << i;
    }
    constexpr double kMostCrossed = 0.5;
    EXPECT_LT(static_cast<double>(std::ranges::count(is_crossed, 1)),
              kMostCrossed * static_cast<double>(cones.size()));
}

TEST(Atlas, GoesOnWhereItStopped) {
    const TempFolder folder;
    write(folder.path(), few_bins());
    EXPECT_EQ(write(folder.path(), few_bins()), 0U);
    const std::vector<MapPoint> points = points_of(few_bins());
    fs::remove(folder.path() / "bins" / bin_name(points[1]));
    write_file(folder.path() / "bins" / bin_name(points[4]), "half");
    EXPECT_EQ(write(folder.path(), few_bins()), 2U);
    // One bin more in the middle keeps the others; one axis less drops them.
    MapAxes finer = few_bins();
    finer.altitude_m = {1.8, 1.9, 2.0, 2.2};
    EXPECT_EQ(write(folder.path(), finer), 2U);
    MapAxes other = few_bins();
    other.pitch_rad = {0.0};
    EXPECT_EQ(write(folder.path(), other), 0U);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path() / "bins"), {}), 3);
    // Another rig's are of no use.
    Rig rig = habcam();
    rig.digest = "another";
    EXPECT_EQ(write(folder.path(), other, rig), 3U);
}

// A manifest as an interruption leaves it, some bins further than it says.
void forget(const fs::path& folder, const std::vector<std::size_t>& bins) {
    auto manifest = nlohmann::ordered_json::parse(read_text_file(folder / "atlas.json"));
    for (const std::size_t bin : bins) manifest["bins"][bin]["sha256"] = "";
    write_file(folder / "atlas.json", manifest.dump());
}

TEST(Atlas, KnowsBinsThatWereNotNotedAnyMore) {
    const TempFolder folder;
    write(folder.path(), few_bins());
    const std::string whole = read_text_file(folder.path() / "atlas.json");
    forget(folder.path(), {2, 3, 4, 5});
    EXPECT_EQ(write(folder.path(), few_bins()), 0U);
    EXPECT_EQ(read_text_file(folder.path() / "atlas.json"), whole);

    // Neither one of another point or rig, nor one that is not whole.
    const auto bin = [&](std::size_t i) {
        return folder.path() / "bins" / bin_name(points_of(few_bins())[i]);
    };
    forget(folder.path(), {1, 2, 3});
    fs::copy_file(bin(0), bin(1), fs::copy_options::overwrite_existing);
    Rig other = habcam();
    other.digest = "another";
    const TempFolder beside;
    write(beside.path(), few_bins(), other);
    fs::copy_file(
        beside.path() / "bins" / bin(2).filename(), bin(2), fs::copy_options::overwrite_existing);
    fs::resize_file(bin(3), fs::file_size(bin(3)) - 100);
    EXPECT_EQ(write(folder.path(), few_bins()), 3U);
    EXPECT_EQ(read_text_file(folder.path() / "atlas.json"), whole);
}

TEST(Atlas, RefusesFoldersThatHoldNone) {
    const TempFolder folder;
    EXPECT_THROW(Atlas(folder.path()), InputError);
    write_file(folder.path() / "atlas.json", R"({"format": "something else"})");
    EXPECT_THROW(Atlas(folder.path()), InputError);
    write_file(folder.path() / "atlas.json", "{");
    EXPECT_THROW(Atlas(folder.path()), InputError);
}

TEST(AtlasExport, MosaicIsRggb) {
    const Lightmap map{.width_px = 3,
                       .height_px = 2,
                       .samples = {1,
                                   2,
                                   3,
                                   4,
                                   5,
                                   6,
                                   10,
                                   20,
                                   30,
                                   40,
                                   50,
                                   60,  //
                                   100,
                                   200,
                                   300,
                                   400,
                                   500,
                                   600}};
    EXPECT_EQ(mosaic_rggb(map), (std::vector<float>{1, 20, 3, 40, 500, 60}));
}

// What the file holds gives back the light that it was fitted to, as far as it says.
TEST(AtlasExport, ExponentialGivesBackTheLight) {
    const TempFolder folder;
    Rig rig = habcam();
    std::vector<double> altitude_m;
    for (int i = 0; i <= 12; ++i) altitude_m.push_back(1.5 + 0.1 * i);
    const ExportedFit stated = export_exponential(folder.path(),
                                                  rig,
                                                  {.altitude_m = altitude_m,
                                                   .map = {.error = 1e-5, .threads = 2},
                                                   .progress = [](double) {}});
    ExrReader reader(folder.path() / stated.file);
    const std::size_t plane = std::size_t{68} * 51;
    std::vector<float> fit(4 * plane);
    const std::vector<std::string> channels{"a.G", "b.G", "c.G", "residual.G"};
    reader.read_rows(0, 51, channels, fit);
    std::vector<double> squares(plane);
    std::vector<double> mean(plane);
    for (const double h : altitude_m) {
        rig.sled.altitude_m = h;
        const Lightmap map = direct(rig, rig.sled);
        for (std::size_t i = 0; i < plane; ++i) {
            const double given = fit[i] * std::exp(fit[plane + i] * h) + fit[2 * plane + i];
            squares[i] += std::pow(given - map.samples[plane + i], 2);
            mean[i] += map.samples[plane + i] / static_cast<double>(altitude_m.size());
        }
    }
    constexpr double kFloats = 1e-5;  // a and c may all but cancel
    for (std::size_t i = 0; i < plane; ++i) {
        const double residual = std::sqrt(squares[i] / static_cast<double>(altitude_m.size()));
        EXPECT_NEAR(residual / mean[i], fit[3 * plane + i], kFloats);
        EXPECT_LE(fit[3 * plane + i], stated.worst);
    }
}

// Far off, lamps and pupil are one: the light of one wavelength goes as exp(-2 K h)/h^2, so b is
// -2 K but for the square, which adds the slope of its logarithm, -2/h. That is its bias: 1 part in
// K h, here 4 % at 42 m.
TEST(AtlasExport, ExponentialIsTheWatersOwnFarOff) {
    Rig rig = habcam();
    rig.camera.width_px = rig.camera.height_px = 1;
    rig.camera.range = {549.0, 551.0};
    rig.sled.pitch_rad = 0.0;
    rig.water.multiple = 10.0;
    for (Strobe& strobe : rig.strobes) {
        strobe.beam.cones = {
            {.part = "diffuse", .half_angle_rad = 0.5 * std::numbers::pi, .weight = 1.0}};
    }
    const double K_per_m = rig.water.multiple * rig.water.absorption_per_m.at(550.0);
    double bias = 0.0;
    for (const double middle_m : {42.0, 21.0}) {
        const TempFolder folder;
        std::vector<double> altitude_m;
        for (int i = -8; i <= 8; ++i) altitude_m.push_back(middle_m + 0.25 * i);
        const ExportedFit made = export_exponential(folder.path(),
                                                    rig,
                                                    {.altitude_m = altitude_m,
                                                     .map = {.error = 1e-6, .threads = 1},
                                                     .progress = [](double) {}});
        std::vector<float> b_per_m(1);
        ExrReader(folder.path() / made.file)
            .read_rows(0, 1, std::vector<std::string>{"b.G"}, b_per_m);
        constexpr double kLampsAside = 1e-2;  // half a metre of 21, squared; and the square's bend
        EXPECT_NEAR(b_per_m[0] / (-2.0 * K_per_m - 2.0 / middle_m), 1.0, kLampsAside) << middle_m;
        // Half as far off the bias is twice as large.
        EXPECT_GT(std::abs(b_per_m[0] + 2.0 * K_per_m), 1.5 * bias);
        bias = std::abs(b_per_m[0] + 2.0 * K_per_m);
        constexpr double kMostBias = 0.1;
        EXPECT_LT(bias, kMostBias * 2.0 * K_per_m) << middle_m;
    }
}

}  // namespace
}  // namespace aphotic::atlas_test
