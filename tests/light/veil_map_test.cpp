// SPDX-License-Identifier: BSD-3-Clause
//
// The veil of maps against light/veil.h's, whose own tests hold it against closed forms: with twice
// the points of other renderers, at the pixel itself, wavelength by wavelength.
#include "light/veil_map.h"

#include "image/exr.h"
#include "lightmap/lightmap.h"
#include "lightmap/lightmap_file.h"
#include "rig/geometry.h"
#include "support/dice.h"
#include "support/effort.h"
#include "support/random_beam.h"
#include "support/random_camera.h"
#include "support/temp_folder.h"
#include "support/veil_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::veil_map_test {
namespace {

constexpr double kOfSignal = 1e-4;  // what is promised of the sum
constexpr double kFloatSum = 4.0 * 0x1p-24;

// With the sea's own scattering, too.
Rig coast(int width_px, int height_px) {
    Rig rig = aphotic::coast(width_px, height_px);
    rig.water.scatterers.push_back(sea());
    return rig;
}

LightmapOptions options(int threads = 1) {
    return {.error = 1e-5, .threads = threads};
}

// By the definition, on a grid of wavelengths: Simpson's rule on twice the knots of the response.
std::array<double, kChannels> by_wavelengths(const Rig& rig, double column, double row) {
    const WavelengthRange range = rig.camera.range;
    constexpr int kSteps = 640;
    const double step_nm = (range.last_nm - range.first_nm) / kSteps;
    const Veil veil(rig, 2 * kVeilPoints);
    const VeilSight sight = sight_of(rig, column, row, 0.5 * (range.first_nm + range.last_nm));
    std::array<double, kChannels> sum{};
    for (std::size_t part = 0; part < veil.strobe_of_part().size(); ++part) {
        const Strobe& strobe = rig.strobes[veil.strobe_of_part()[part]];
        VeilNodes nodes;
        veil.nodes(part, sight.ray, sight.length_m, nodes);
        for (int k = 0; k <= kSteps; ++k) {
            const double nm = range.first_nm + k * step_nm;
            const double rule = (k == 0 || k == kSteps ? 1.0 : k % 2 == 1 ? 4.0 : 2.0) / 3.0;
            const double loss_per_m = rig.water.attenuation_per_m(nm);
            double light = 0.0;
            for (std::size_t i = 0; i < nodes.weight.size(); ++i) {
                double left = 0.0;
                for (std::size_t n = 0; n < nodes.path_m.size(); ++n)
                    left += nodes.weight[i][n] * std::exp(-loss_per_m * nodes.path_m[n]);
                light += rig.water.scattering_per_m(i, nm) * left;
            }
            light *= strobe.power * strobe.spectrum.at(nm) * rule * step_nm;
            for (std::size_t c = 0; c < kChannels; ++c)
                sum[c] += light * rig.camera.sensor.response(static_cast<int>(c), nm);
        }
    }
    return sum;
}

void expect_right(const Rig& rig, const Lightmap& map, int pixels, const std::string& what) {
    ASSERT_EQ(map.veil.size(), map.samples.size());
    const auto plane = static_cast<std::size_t>(map.width_px * map.height_px);
    Dice dice(5);
    double worst = 0.0;
    for (int k = 0; k < pixels; ++k) {
        const int column = dice.whole(0, map.width_px - 1);
        const int row = dice.whole(0, map.height_px - 1);
        const auto at = static_cast<std::size_t>(row * map.width_px + column);
        const auto expected = by_wavelengths(rig, column + 0.5, row + 0.5);
        for (std::size_t c = 0; c < kChannels; ++c) {
            const double found = map.veil[c * plane + at];
            const double signal = map.samples[c * plane + at] + expected[c];
            worst = std::max(worst, std::abs(found - expected[c]) / signal);
        }
    }
    testing::Test::RecordProperty(what, std::to_string(worst));
    EXPECT_LT(worst, kOfSignal) << what;
    EXPECT_GT(worst, 0.0) << what;
}

}  // namespace

TEST(VeilMap, IsTheVeilOfEachPixel) {
    const Rig rig = coast(680, 512);
    expect_right(rig, LightmapMaker(rig, std::nullopt, options()).map(rig.sled), 150, "habcam");
}

// Past a lamp on the camera's axis the veil is as bright on the left as on the right, so that nodes
// show no third difference; on the axis it has a needle, or none where the lamp is behind.
TEST(VeilMap, IsTheVeilOfEachPixelAboutALampOnTheAxis) {
    for (const double along_m : {1.0, -0.3}) {
        Rig rig = coast(5, 3);
        rig.sled.pitch_rad = 0.0;
        rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
        rig.strobes[0].position_m = {1e-3, 0.0, along_m};
        rig.strobes[0].axis = {0.0, 0.0, 1.0};
        expect_right(rig,
                     LightmapMaker(rig, std::nullopt, options()).map(rig.sled),
                     40,
                     "lamp at " + std::to_string(along_m));
        rig.strobes[0].position_m.x() = 0.0;
        expect_right(rig,
                     LightmapMaker(rig, std::nullopt, options()).map(rig.sled),
                     40,
                     "lamp on the axis at " + std::to_string(along_m));
    }
}

// The largest departure from a rule of so many points at the pixel, by default the map's own, of
// the signal, over every so many pixels.
double off_by(const Rig& rig,
              const LightmapOptions& options,
              int step,
              std::optional<unsigned> points = {}) {
    const Lightmap map = LightmapMaker(rig, std::nullopt, options).map(rig.sled);
    const VeilMap exact(rig, path_range(rig), 1e-5, points.value_or(map_veil_points(rig, options)));
    const CameraRays rays(rig, 1);
    const Plane floor = floor_plane(rig.sled);
    const std::size_t plane = map.veil.size() / kChannels;
    VeilNodes nodes;
    double worst = 0.0;
    for (int row = step / 2; row < map.height_px; row += step) {
        for (int column = step / 2; column < map.width_px; column += step) {
            const auto expected = exact.at(rays.at(column + 0.5, row + 0.5, floor), nodes);
            const auto at = static_cast<std::size_t>(row * map.width_px + column);
            for (std::size_t c = 0; c < kChannels; ++c) {
                const double off =
                    std::abs(static_cast<double>(map.veil[c * plane + at]) - expected[c]);
                const double signal =
                    static_cast<double>(map.samples[c * plane + at]) + expected[c];
                worst = std::max(worst, signal > 0.0 ? off / signal : off);
            }
        }
    }
    return worst;
}

// Edges of cones in the water and on the floor included.
TEST(VeilMap, IsInterpolatedWhereThatIsRight) {
    const double worst = off_by(coast(1360, 1024), options(), 7);
    RecordProperty("interpolation", std::to_string(worst));
    EXPECT_LT(worst, kOfSignal);
}

// Whatever is asked for.
TEST(VeilMap, IsAsRightAsItsTolerance) {
    const Rig rig = coast(1360, 1024);
    for (const double tolerance : {1e-2, 1e-3, 1e-5}) {
        LightmapOptions asked = options();
        asked.veil_tolerance = tolerance;
        const double worst = off_by(rig, asked, 13);
        RecordProperty("at " + std::to_string(tolerance), std::to_string(worst));
        EXPECT_LT(worst, tolerance);
    }
}

// Of whole beams, against more points than a map takes.
TEST(VeilMap, OfBeamsOfEveryKindIsAsRightAsItsTolerance) {
    for (const BeamKind kind : kBeamKinds) {
        for (int i = 0; i < campaign(1, 2); ++i) {
            Dice dice(7300 + static_cast<std::uint64_t>(i));
            Rig rig = coast(400, 180);
            for (Strobe& strobe : rig.strobes) strobe.beam = random_beam_of(kind, dice);
            if (i == 1) give_lens(LensKind::Fisheye, dice, rig.camera);
            for (const double tolerance : {kVeilOfSignal, 1e-3}) {
                LightmapOptions asked = options();
                asked.veil_tolerance = tolerance;
                EXPECT_LT(off_by(rig, asked, 7, 4 * kVeilPoints), tolerance)
                    << "kind " << static_cast<int>(kind) << ", rig " << i;
            }
        }
    }
}

// Of soft cones one in another, of which three points a panel are off by 3 % of the veil: against
// four times the points that a map then takes.
TEST(VeilMap, TakesMorePointsWhereFewAreNotRight) {
    for (std::uint64_t seed = 7300; seed < 7303; ++seed) {
        Dice dice(seed);
        Rig rig = coast(200, 90);
        for (Strobe& strobe : rig.strobes) strobe.beam = random_beam_of(BeamKind::Cones, dice);
        ASSERT_GT(veil_error(rig, kVeilMapPoints), 0.01);
        EXPECT_LT(map_promise(rig, options()).error, 2.0 * kVeilOfSignal);
        EXPECT_LT(off_by(rig, options(), 5, 4 * kVeilPoints), kVeilOfSignal) << seed;
    }
}

// A streak of light across the view that is narrower than the places of a tile are apart: of a
// sharp cone, a soft one, and a lobe.
TEST(VeilMap, OverlooksNoNarrowBeam) {
    constexpr double kNarrow_rad = 0.8 * std::numbers::pi / 180.0;
    const std::vector<Cone> beams{{.part = "sharp", .half_angle_rad = kNarrow_rad, .weight = 1.0},
                                  {.part = "soft",
                                   .half_angle_rad = 2.0 * kNarrow_rad,
                                   .weight = 1.0,
                                   .edge_rad = 2.0 * kNarrow_rad},
                                  {.part = "lobe",
                                   .half_angle_rad = 0.5 * std::numbers::pi,
                                   .weight = 1.0,
                                   .exponent = 1.0 / (kNarrow_rad * kNarrow_rad)}};
    for (const Cone& cone : beams) {
        for (const double across_m : {0.05, 0.23}) {
            if (across_m > 0.1 && !is_night()) continue;
            Rig rig = coast(680, 512);
            rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
            rig.strobes[0].beam.cones = {cone};
            rig.strobes[0].position_m = {-0.6, across_m, 0.9};
            rig.strobes[0].axis = Eigen::Vector3d(1.0, 0.0, 0.1).normalized();
            EXPECT_LT(off_by(rig, options(), 9), kOfSignal) << cone.part << ' ' << across_m;
        }
    }
}

// A lamp in view is a needle of light.
TEST(VeilMap, OverlooksNoNeedle) {
    Rig rig = coast(400, 300);
    rig.sled.pitch_rad = 0.0;
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    rig.strobes[0].beam.cones = {
        {.part = "even", .half_angle_rad = 0.5 * std::numbers::pi, .weight = 1.0}};
    rig.strobes[0].axis = {0.0, 0.0, 1.0};
    for (const double x_m : {1e-3, 0.2}) {
        rig.strobes[0].position_m = {x_m, 0.05, 1.0};
        EXPECT_LT(off_by(rig, options(), 3), kOfSignal) << x_m;
    }
}

TEST(VeilMap, HoldsAtOtherHeightsAttitudesAndPowers) {
    Rig rig = coast(340, 256);
    rig.strobes[1].power = 0.4;
    for (const double altitude_m : {1.0, 3.5}) {
        rig.sled = {.altitude_m = altitude_m, .pitch_rad = -0.12, .roll_rad = 0.2};
        expect_right(rig, LightmapMaker(rig, std::nullopt, options()).map(rig.sled), 60, "sled");
    }
}

// Above the horizon there is no floor, and yet light.
TEST(VeilMap, IsThereWithoutAFloor) {
    Rig rig = coast(96, 72);
    rig.sled.pitch_rad = 1.4;
    rig.sled.altitude_m = 6.0;
    const Lightmap map = LightmapMaker(rig, std::nullopt, options()).map(rig.sled);
    expect_right(rig, map, 40, "horizon");
    bool has_bare_veil = false;
    for (std::size_t i = 0; i < map.samples.size(); ++i)
        has_bare_veil |= map.samples[i] == 0.0F && map.veil[i] > 0.0F;
    EXPECT_TRUE(has_bare_veil);
}

// Behind a port each wavelength has its own ray.
TEST(VeilMap, BehindAPortIsThatOfEachWavelengthsRay) {
    Rig rig = scene_rig("port.toml");
    const Rig water = coast(96, 72);
    rig.water = water.water;
    const Lightmap map = LightmapMaker(rig, std::nullopt, options()).map(rig.sled);
    const auto plane = static_cast<std::size_t>(map.width_px * map.height_px);
    const Veil veil(rig, 2 * kVeilPoints);
    Dice dice(6);
    double worst = 0.0;
    for (int k = 0; k < 24; ++k) {
        const int column = dice.whole(0, map.width_px - 1);
        const int row = dice.whole(0, map.height_px - 1);
        const auto at = static_cast<std::size_t>(row * map.width_px + column);
        constexpr int kSteps = 320;
        const WavelengthRange range = rig.camera.range;
        const double step_nm = (range.last_nm - range.first_nm) / kSteps;
        std::array<double, kChannels> sum{};
        for (int n = 0; n <= kSteps; ++n) {
            const double nm = range.first_nm + n * step_nm;
            const double rule = (n == 0 || n == kSteps ? 1.0 : n % 2 == 1 ? 4.0 : 2.0) / 3.0;
            const VeilSight sight = sight_of(rig, column + 0.5, row + 0.5, nm);
            const double L = veil.radiance(sight.ray, sight.length_m, nm) * rule * step_nm;
            for (std::size_t c = 0; c < kChannels; ++c)
                sum[c] += L * rig.camera.sensor.response(static_cast<int>(c), nm);
        }
        for (std::size_t c = 0; c < kChannels; ++c) {
            worst = std::max(worst,
                             std::abs(static_cast<double>(map.veil[c * plane + at]) - sum[c]) /
                                 (static_cast<double>(map.samples[c * plane + at]) + sum[c]));
        }
    }
    RecordProperty("port", std::to_string(worst));
    EXPECT_LT(worst, kOfSignal);
}

TEST(VeilMap, OfThreadsAndOfRowsIsTheSameBits) {
    const Rig rig = coast(200, 150);
    const LightmapMaker maker(rig, std::nullopt, options());
    const Lightmap map = maker.map(rig.sled);
    const Lightmap by_two = LightmapMaker(rig, std::nullopt, options(2)).map(rig.sled);
    EXPECT_EQ(map.veil, by_two.veil);
    EXPECT_EQ(map.samples, by_two.samples);
    for (const auto& [first, count] :
         std::vector<std::pair<int, int>>{{0, 64}, {64, 64}, {128, 22}}) {
        Lightmap rows;
        maker.rows_into(rig.sled, first, count, rows);
        ASSERT_EQ(rows.height_px, count);
        const auto size = static_cast<std::size_t>(count) * 200;
        for (std::size_t c = 0; c < kChannels; ++c) {
            const std::size_t from = (c * 150 + static_cast<std::size_t>(first)) * 200;
            for (std::size_t i = 0; i < size; ++i) {
                ASSERT_EQ(rows.veil[c * size + i], map.veil[from + i]);
                ASSERT_EQ(rows.samples[c * size + i], map.samples[from + i]);
            }
        }
    }
}

TEST(VeilMap, ChangesNothingOfTheFloorsLight) {
    const Rig rig = coast(160, 120);
    const Lightmap both = LightmapMaker(rig, std::nullopt, options()).map(rig.sled);
    LightmapOptions bare = options();
    bare.has_veil = false;
    const Lightmap floor = LightmapMaker(rig, std::nullopt, bare).map(rig.sled);
    EXPECT_EQ(both.samples, floor.samples);
    EXPECT_TRUE(floor.veil.empty());
    Rig clear = rig;
    clear.water.scatterers.clear();
    EXPECT_TRUE(LightmapMaker(clear, std::nullopt, options()).map(rig.sled).veil.empty());
    EXPECT_FALSE(map_promise(clear, options()).has_veil);
    EXPECT_TRUE(map_promise(rig, options()).has_veil);
    EXPECT_FALSE(map_promise(rig, options()).is_bounded);
}

// Light adds up, and the lens takes of both alike.
TEST(VeilMap, OfStrobesAddsUpAndIsDimmedByTheLens) {
    Rig rig = coast(120, 90);
    const Lightmap whole = LightmapMaker(rig, std::nullopt, options()).map(rig.sled);
    std::vector<double> sum(whole.veil.size());
    for (const RigPart& part : parts_by_strobe(rig)) {
        const Lightmap share = LightmapMaker(part.rig, std::nullopt, options()).map(rig.sled);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += static_cast<double>(share.veil[i]);
    }
    constexpr double kOfFiveMaps = 4.0 * kOfSignal;
    for (std::size_t i = 0; i < sum.size(); ++i) {
        const double signal = static_cast<double>(whole.veil[i] + whole.samples[i]);
        ASSERT_NEAR(sum[i], static_cast<double>(whole.veil[i]), kOfFiveMaps * signal);
    }
    rig.camera.vignetting = NaturalVignetting{};
    const std::vector<float> V = vignetting_plane(rig.camera);
    const Lightmap dimmed = LightmapMaker(rig, std::nullopt, options()).map(rig.sled);
    for (std::size_t i = 0; i < sum.size(); ++i) {
        const double expected =
            static_cast<double>(whole.veil[i]) * static_cast<double>(V[i % V.size()]);
        ASSERT_NEAR(static_cast<double>(dimmed.veil[i]) / expected, 1.0, kFloatSum);
    }
}

TEST(VeilMap, IsWrittenBesideTheFloorAndDividedByTheSamePeak) {
    const TempFolder folder;
    const Rig rig = coast(80, 60);
    const Lightmap map = LightmapMaker(rig, std::nullopt, options()).map(rig.sled);
    LightmapRequest request{.file = folder.path() / "map.exr",
                            .parts = parts_by_strobe(rig),
                            .is_normalised = true,
                            .map = options(),
                            .version = "test"};
    const WrittenLightmap written = write_lightmap(rig, request);
    ExrReader reader(request.file);
    const std::vector<std::string> names{"R", "veil.R", "fore.veil.R"};
    const std::vector<float> planes = reader.planes(names);
    const std::size_t size = planes.size() / 3;
    for (std::size_t i = 0; i < size; ++i) {
        ASSERT_EQ(planes[i], map.samples[i] / written.peaks[0]);
        ASSERT_EQ(planes[size + i], map.veil[i] / written.peaks[0]);
        ASSERT_LT(planes[2 * size + i], planes[size + i]);
    }
}

}  // namespace aphotic::veil_map_test
