// SPDX-License-Identifier: BSD-3-Clause
//
// The light of an image of a survey in water that scatters: what a correction subtracts, against
// the same map to a tolerance at which its pixels are computed one by one. And the light of each
// strobe.
#include "survey/light_at.h"
#include "support/scene_text.h"

#include "support/scene_rig.h"
#include "survey/correction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace aphotic::light_at_test {
namespace {

constexpr double kNoInterpolation = 0.0;
// A quotient of floats, less one: twice half of 2^-23, and of both.
constexpr double kRounding = 4.0 * 0x1p-24;

Rig coast(const std::string& name) {
    Rig rig = scene_rig(name + ".toml", 340, 220);
    const auto line = [](const std::string& curve, double blue, double red) {
        return Spectrum(curve, {300.0, 400.0, 700.0, 900.0}, {blue, blue, red, red});
    };
    rig.water.absorption_per_m = line("absorption", 0.3, 0.65);
    rig.water.scatterers = {{line("scattering", 0.28, 0.18), fournier_forand(0.0183)}};
    return rig;
}

Navigation flight(const Sled& sled) {
    return {"test", {{.image = "a.tif", .sled = sled}}};
}

const std::vector<ImageFile> kFiles{{.source = "a.tif", .name = "a"}};

Lightmap map_of(const Rig& rig, const Sled& sled, double tolerance) {
    return light_of_rig(rig, flight(sled), kFiles, true, tolerance).map(sled);
}

// Of a floor that is half as bright as the rig's.
RawImage raw_of(const Lightmap& map) {
    RawImage raw{.width_px = map.width_px,
                 .height_px = map.height_px,
                 .mosaic = Mosaic::None,
                 .samples = map.samples};
    for (std::size_t i = 0; i < raw.samples.size(); ++i)
        raw.samples[i] = 0.5F * map.samples[i] + map.veil[i];
    return raw;
}

TEST(LightAt, ACorrectionsVeilIsWithinItsTolerance) {
    for (const char* name : {"habcam-led", "habcam"}) {
        const Rig rig = coast(name);
        for (const double altitude_m : {1.4, 2.6}) {
            const Sled sled{.altitude_m = altitude_m, .pitch_rad = 0.07, .roll_rad = -0.05};
            const Lightmap exact = map_of(rig, sled, kNoInterpolation);
            const Lightmap map = light_of_rig(rig, flight(sled), kFiles).map(sled);
            const Correction correction{.gain = {1.0, 1.0, 1.0},
                                        .middle = {1.0, 1.0, 1.0},
                                        .levels = {.black = 0.0F, .white = 1e30F},
                                        .limit = {.share = 1e-6}};
            const RawImage raw = raw_of(exact);
            const CorrectedImage found = corrected(raw, map, correction);
            double of_veil = 0.0;
            double of_corrected = 0.0;
            for (std::size_t i = 0; i < map.veil.size(); ++i) {
                const double floor = exact.samples[i];
                const double signal = floor + static_cast<double>(exact.veil[i]);
                of_veil = std::max(
                    of_veil, std::abs(static_cast<double>(map.veil[i] - exact.veil[i])) / signal);
                if (!(floor > 1e-3 * signal)) continue;
                // What the veil may be off by, as the division enlarges it.
                of_corrected = std::max(
                    of_corrected,
                    std::abs(static_cast<double>(found.image.samples[i]) - 0.5) * floor / signal);
            }
            EXPECT_LT(of_veil, kVeilOfCorrection) << name << ' ' << altitude_m;
            EXPECT_LT(of_corrected, kVeilOfCorrection + kRounding) << name << ' ' << altitude_m;
        }
    }
}

TEST(LightAt, AFinerToleranceIsKept) {
    constexpr double kFine = 1e-5;
    const Rig rig = coast("habcam");
    const Sled sled{.altitude_m = 2.0};
    const Lightmap exact = map_of(rig, sled, kNoInterpolation);
    const Lightmap map = map_of(rig, sled, kFine);
    for (std::size_t i = 0; i < map.veil.size(); ++i) {
        ASSERT_NEAR(map.veil[i],
                    exact.veil[i],
                    kFine * static_cast<double>(exact.samples[i] + exact.veil[i]));
    }
}

TEST(LightAt, TellsTheToleranceOfAVeilItHas) {
    const Rig rig = coast("habcam");
    const Navigation navigation = flight(rig.sled);
    EXPECT_EQ(light_of_rig(rig, navigation, kFiles).veil_tolerance, kVeilOfCorrection);
    EXPECT_FALSE(light_of_rig(rig, navigation, kFiles, false).veil_tolerance);
    Rig clear = rig;
    clear.water.scatterers.clear();
    EXPECT_FALSE(light_of_rig(clear, navigation, kFiles).veil_tolerance);
}

// Light adds up: that of each strobe is what the whole map has more than that of the others.
TEST(LightAt, OfAStrobeIsWhatTheMapHasMoreThanThatOfTheOthers) {
    const Rig rig = read_rig(scene_file("survey/smooth.toml"));
    const Sled sled{.altitude_m = 2.0, .pitch_rad = 0.05, .roll_rad = -0.03};
    const Navigation navigation("flown", {{.image = "a", .sled = sled}});
    const std::vector<ImageFile> files{{.source = "a.tif", .name = "a.tif"}};
    const StrobesAt strobes = strobes_of_rig(rig, navigation, files);
    ASSERT_EQ(strobes.names, (std::vector<std::string>{"fore", "aft", "port", "starboard"}));
    const std::vector<CellPlane> cells = strobes.cells(sled);
    const LightmapMaker maker(rig, paths_of(rig, {sled}), {});
    const CellPlane all = cells_of(maker.map(sled), kCells);
    constexpr double kCoarse = 5e-3;  // the middles of 4 x 3 coarse pixels for a cell's own
    for (std::size_t s = 0; s < 4; ++s) {
        const CellPlane rest = cells_of(strobes.map_without(sled, 1U << s), kCells);
        for (std::size_t k = 0; k < all.size(); ++k)
            ASSERT_NEAR(all[k] - rest[k], cells[s][k], kCoarse * all[k]) << s << " " << k;
    }
}

}  // namespace
}  // namespace aphotic::light_at_test
