// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/atlas.h"

#include "lightmap/atlas_export.h"
#include "scene_gen/rig_reader.h"
#include "spectral/error.h"
#include "spectral/exr.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aphotic {
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

// The error that it states is that of the maps that it gives, off the edges: of all pixels few are
// worse, and those are where an edge crosses.
TEST(Atlas, IsAsFarFromTheTruthBetweenBinsAsItStates) {
    const TempFolder folder;
    write(folder.path(), few_bins());
    Atlas atlas(folder.path());
    const InterpolationError stated = atlas.manifest().interpolation;
    EXPECT_GT(stated.worst, 0.0);
    EXPECT_LT(stated.rms, stated.worst);
    const Sled between{.altitude_m = 1.93, .pitch_rad = 0.7 * kDegree, .roll_rad = 0.0};
    const Lightmap found = atlas.map({.sled = between});
    const Lightmap truth = direct(habcam(), between);
    int worse = 0;
    for (std::size_t i = 0; i < truth.samples.size(); ++i) {
        worse += std::abs(found.samples[i] / truth.samples[i] - 1.0) > 1.1 * stated.worst ? 1 : 0;
    }
    EXPECT_LE(worse, 2.0 * stated.crossed_share * static_cast<double>(truth.samples.size()));
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

}  // namespace
}  // namespace aphotic
