// SPDX-License-Identifier: BSD-3-Clause
//
// Maps against the reference tracer, which shares the rig and the spectra with them and no line of
// geometry or light.
#include "lightmap/lightmap.h"

#include "base/error.h"
#include "light/floor_image.h"
#include "rig/file/rig_reader.h"
#include "rig/geometry.h"
#include "spectral/curve_loader.h"
#include "support/effort.h"
#include "support/random_beam.h"
#include "support/random_camera.h"
#include "support/refusal.h"
#include "support/scene_rig.h"
#include "support/temp_folder.h"
#include "validation/tracer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::lightmap_test {
namespace {

// What is promised to users at every pixel off the beams' edges.
constexpr double kPromise = 1e-4;
// The error that is asked for, the tracer's own grid, and the rounding of a sum of a dozen floats.
constexpr double kAsked = 1e-5;
constexpr double kWithoutPort = kAsked + kSpectralError + 12.0 * 0x1p-24;

Lightmap map_of(const Rig& rig, int threads = 1) {
    return LightmapMaker(rig, std::nullopt, {.error = kAsked, .threads = threads}).map(rig.sled);
}

struct Difference {
    double worst = 0.0;  // relative, off the edges
    int compared = 0;
    int on_edges = 0;
    std::size_t worst_at = 0;
};

void PrintTo(const Difference& d, std::ostream* out) {
    *out << "worst relative error " << d.worst << " at sample " << d.worst_at << "; " << d.compared
         << " pixels compared, " << d.on_edges << " on edges";
}

// The tracer takes the same lamps for an emitter: what they are worth is its tests' concern.
Difference against_tracer(const Rig& rig, const Lightmap& map) {
    TraceOptions options;
    for (const Strobe& strobe : rig.strobes) {
        if (!strobe.emitter) continue;
        const LampGrid grid = lamp_grid(rig, strobe, 0.0);
        options.lamps_across = grid.across;
        options.lamps_along = grid.along;
    }
    const Tracer tracer(rig, options);
    const std::vector<double> wanted = tracer.rows(0, rig.camera.height_px);
    const std::vector<unsigned char> edges = tracer.on_edges(rig.camera.range);
    const std::size_t plane = edges.size();
    Difference difference;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto first = wanted.begin() + static_cast<std::ptrdiff_t>(c * plane);
        const double brightest =
            *std::max_element(first, first + static_cast<std::ptrdiff_t>(plane));
        for (std::size_t i = 0; i < plane; ++i) {
            if (edges[i] != 0) continue;
            const double expected = wanted[c * plane + i];
            const double found = map.samples[c * plane + i];
            // Beyond the longest path the map is black, and such light at most is lost.
            const double off = std::abs(found - expected);
            if (off <= kDarkShare * brightest) continue;
            const double error = off / expected;
            if (error > difference.worst) {
                difference.worst = error;
                difference.worst_at = c * plane + i;
            }
        }
    }
    difference.on_edges = static_cast<int>(std::count(edges.begin(), edges.end(), 1));
    difference.compared = static_cast<int>(plane) - difference.on_edges;
    return difference;
}

void expect_equal(const Rig& rig, double bound, const std::string& what) {
    const Difference difference = against_tracer(rig, map_of(rig));
    testing::Test::RecordProperty(what, std::to_string(difference.worst));
    EXPECT_LE(difference.worst, bound) << what << ": " << testing::PrintToString(difference);
    EXPECT_GT(difference.compared, difference.on_edges) << what;
}

// Some sled: strobes about the camera, each with cones of its own, one lamp spectrum or two.
Rig random_rig(std::mt19937& engine) {
    const auto between = [&](double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(engine);
    };
    Rig rig = habcam(96, 72);
    rig.sled = {.altitude_m = between(0.5, 6.0),
                .pitch_rad = between(-15.0, 15.0) * kDegree,
                .roll_rad = between(-15.0, 15.0) * kDegree};
    rig.camera.pixel_pitch_m *= between(0.5, 2.0);
    rig.water.multiple = between(0.0, 3.0);
    rig.water.uniform_loss_per_m = between(0.0, 0.2);
    for (Strobe& strobe : rig.strobes) {
        // No lamp at the height of the floor, even under the steepest attitude.
        strobe.position_m = {between(-0.7, 0.7), between(-0.7, 0.7), between(-0.3, 0.1)};
        strobe.axis = Eigen::Vector3d(between(-0.6, 0.6), between(-0.6, 0.6), 1.0).normalized();
        strobe.power = between(0.1, 3.0);
        strobe.beam.weights = between(0.0, 1.0) < 0.5 ? ConeWeights::Flux : ConeWeights::Literal;
        for (Cone& cone : strobe.beam.cones) {
            cone.half_angle_rad = between(5.0, 90.0) * kDegree;
            cone.weight = between(0.0, 1.0);
        }
        if (between(0.0, 1.0) < 0.5) {
            strobe.spectrum = load_curve("xenon-arc", CurveRole::LampSpectrum, {});
        }
    }
    return rig;
}

TEST(Lightmap, IsThatOfTheTracerForRandomRigs) {
    std::mt19937 engine(20110711);
    for (int i = 0; i < cases(40); ++i) {
        expect_equal(random_rig(engine), kWithoutPort, "rig " + std::to_string(i));
    }
}

// An error may be asked for that floats cannot hold: the promise counts their rounding.
TEST(Lightmap, PromisesNoLessThanFloatsRound) {
    const Rig rig = habcam(136, 102);
    const LightmapOptions least{.error = 1e-7, .threads = 1};
    const Difference difference =
        against_tracer(rig, LightmapMaker(rig, std::nullopt, least).map(rig.sled));
    EXPECT_LE(difference.worst, map_promise(rig, least).error + kSpectralError)
        << testing::PrintToString(difference);
    EXPECT_GT(difference.worst, least.error) << testing::PrintToString(difference);
}

// 57 by 49 degrees off the axis in air, close to the floor: what dispersion does grows with both.
TEST(Lightmap, IsThatOfTheTracerBehindAPortOfAWideLens) {
    Rig rig = scene_rig("port.toml", 64, 48);
    rig.camera.pixel_pitch_m *= 4.2;
    for (const double altitude_m : {0.7, 3.0}) {
        rig.sled.altitude_m = altitude_m;
        expect_equal(rig, kPromise, "wide port");
    }
}

TEST(Lightmap, IsThatOfTheTracerForLampsOfASize) {
    Rig rig = habcam(96, 72);
    for (Strobe& strobe : rig.strobes) strobe.emitter = {.across_m = 0.0635, .along_m = 0.0302};
    expect_equal(rig, kWithoutPort, "emitters");
}

// A long emitter that shines level, nearly fore or aft: turned by 90 degrees it would stand
// upright.
TEST(Lightmap, IsThatOfTheTracerForEmittersThatShineNearlyForeOrAft) {
    Rig rig = habcam(24, 18);
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    rig.strobes[0].position_m = {-0.2, 0.3, 1.5};
    rig.strobes[0].beam.cones = {{.part = "all", .half_angle_rad = 90.0 * kDegree, .weight = 1.0}};
    rig.strobes[0].emitter = {.across_m = 0.3, .along_m = 0.01};
    for (const double end : {1.0, -1.0}) {
        for (const double off_rad : {0.0, 0.5e-6, 2e-6, 3e-5, 1e-4}) {
            rig.strobes[0].axis = Eigen::Vector3d(end, 0.6 * off_rad, 0.8 * off_rad).normalized();
            expect_equal(rig, kWithoutPort, "off by " + std::to_string(end * off_rad));
        }
    }
}

// So many rigs of each kind, the same in each run.
template <typename Kinds, typename Give>
void expect_equal_of_every(
    const Kinds& kinds, unsigned seed, int count, double bound, const Give& give) {
    for (const auto kind : kinds) {
        std::mt19937 engine(seed);
        Dice dice(seed);
        for (int i = 0; i < cases(count); ++i) {
            Rig rig = random_rig(engine);
            give(kind, i, dice, rig);
            expect_equal(rig, bound, fmt::format("kind {}, rig {}", static_cast<int>(kind), i));
        }
    }
}

void give_beams(BeamKind kind, Dice& dice, Rig& rig) {
    for (Strobe& strobe : rig.strobes) strobe.beam = random_beam_of(kind, dice);
}

// Rows of several blocks, of which smooth ones are fitted (light/floor_image.h), and the last is
// shorter.
TEST(Lightmap, IsThatOfTheTracerWhereRowsAreFitted) {
    const auto give = [](BeamKind kind, int, Dice& dice, Rig& rig) {
        rig.camera.pixel_pitch_m *= 96.0 / 300.0;
        rig.camera.width_px = 300;
        rig.camera.height_px = 12;
        give_beams(kind, dice, rig);
    };
    expect_equal_of_every(kBeamKinds, 7200, 12, kWithoutPort + kTileError, give);
}

TEST(Lightmap, IsThatOfTheTracerForEveryKindOfBeam) {
    const auto give = [](BeamKind kind, int i, Dice& dice, Rig& rig) {
        give_beams(kind, dice, rig);
        if (i % 3 == 2) rig.seafloor.phong = 0.5;
    };
    expect_equal_of_every(kBeamKinds, 7100, 6, kWithoutPort, give);
}

TEST(Lightmap, IsThatOfTheTracerThroughEveryKindOfLens) {
    constexpr double kOfVignetting = 2.0 * 0x1p-24;  // its factor and the product
    const auto give = [](LensKind kind, int i, Dice& dice, Rig& rig) {
        give_lens(kind, dice, rig.camera);
        give_vignetting(static_cast<std::size_t>(i), dice, rig.camera);
    };
    expect_equal_of_every(kLensKinds, 7300, 6, kWithoutPort + kOfVignetting, give);
}

TEST(Lightmap, IsThatOfTheTracerThroughEveryKindOfPort) {
    const auto give = [](PortKind kind, int i, Dice& dice, Rig& rig) {
        rig.camera.width_px = pixels(rig.camera.width_px);
        rig.camera.height_px = pixels(rig.camera.height_px);
        give_port(kind, dice, rig.camera);
        if (i % 2 == 1) give_lens(LensKind::RadialTangential, dice, rig.camera);
    };
    expect_equal_of_every(kPortKinds, 7400, 3, kPromise, give);
}

TEST(Lightmap, IsThatOfTheTracerForGlossyFloors) {
    Rig rig = habcam(96, 72);
    rig.seafloor.phong = 0.7;
    for (const double size : {0.0, 3.5, 40.0, 500.0}) {
        rig.seafloor.phong_size = size;
        expect_equal(rig, kWithoutPort, "phong " + std::to_string(size));
    }
}

TEST(Lightmap, IsThatOfTheTracerUpToTheHorizon) {
    Rig rig = habcam(96, 72);
    rig.sled = {.altitude_m = 4.0, .pitch_rad = -80.0 * kDegree};  // the fore strobe 0.2 m over it
    for (const double loss_per_m : {0.0, 0.3}) {
        rig.water.uniform_loss_per_m = loss_per_m;
        expect_equal(rig, kWithoutPort, "horizon " + std::to_string(loss_per_m));
    }
    rig.water.multiple = 0.0;
    rig.water.uniform_loss_per_m = 0.0;
    expect_equal(rig, kWithoutPort, "horizon in clear water");
}

// The same tables serve every sled within their paths, and give the map that its own would.
TEST(Lightmap, ServesOtherSleds) {
    Rig rig = habcam(96, 72);
    const Sled low{.altitude_m = 1.0, .pitch_rad = -0.1, .roll_rad = 0.05};
    const Sled high{.altitude_m = 4.0, .pitch_rad = 0.1, .roll_rad = -0.05};
    const LightmapMaker maker(rig, paths_of(rig, {low, high}), {.error = kAsked, .threads = 1});
    for (const Sled& sled : {low, high, Sled{.altitude_m = 2.3}}) {
        rig.sled = sled;
        const Difference difference = against_tracer(rig, maker.map(sled));
        EXPECT_LE(difference.worst, kWithoutPort) << testing::PrintToString(difference);
    }
}

TEST(Lightmap, RefusesSledsWhosePathsItsTablesDoNotServe) {
    const Rig rig = habcam(32, 24);
    const LightmapMaker maker(rig, PathRange{.shortest_m = 3.9, .longest_m = 5.0}, {});
    EXPECT_NO_THROW((void)maker.map({.altitude_m = 2.0}));
    EXPECT_THROW((void)maker.map({.altitude_m = 1.5}), InputError);
    EXPECT_THROW((void)maker.map({.altitude_m = 2.8}), InputError);
}

std::string sled_refusal(const Rig& rig, const Sled& sled) {
    return refusal_of([&] { return LightmapMaker(rig, paths_of(rig, {sled}), {}).map(sled); });
}

// The aft strobe, half a metre behind the pupil, stands h cos(p) - 0.5 m sin(p) over the floor.
TEST(Lightmap, RefusesSledsThatPutAStrobeUnderTheFloor) {
    const Rig rig = habcam(32, 24);
    EXPECT_EQ(sled_refusal(rig, {.altitude_m = 0.02, .pitch_rad = 30.0 * kDegree}),
              "altitude 0.02 m, pitch 30, roll 0 degrees: strobe 'aft' is 0.2327 m below the sea "
              "floor; allowed: at least 0.001 m above it");
    EXPECT_EQ(sled_refusal(rig, {.altitude_m = 2.0, .pitch_rad = -std::numbers::pi}),
              "altitude 2 m, pitch -180, roll 0 degrees: strobe 'fore' is 2.0000 m below the sea "
              "floor; allowed: at least 0.001 m above it");
    const double grazing_m = 0.5 * std::tan(30.0 * kDegree);
    for (const double over_m : {-1e-6, 0.9e-3}) {
        const Sled low{.altitude_m = grazing_m + over_m / std::cos(30.0 * kDegree),
                       .pitch_rad = 30.0 * kDegree};
        EXPECT_NE(sled_refusal(rig, low), kAccepted) << over_m;
    }
    const Sled above{.altitude_m = grazing_m + 1.2e-3, .pitch_rad = 30.0 * kDegree};
    EXPECT_EQ(sled_refusal(rig, above), kAccepted);
}

TEST(Lightmap, RefusesSledsThatPutPartOfAnEmitterUnderTheFloor) {
    Rig rig = scene_rig("one-lamp.toml", 32, 24);
    rig.strobes[0].position_m = {0.0, 0.5, 0.0};
    rig.strobes[0].axis = Eigen::Vector3d::UnitZ();
    rig.strobes[0].emitter = {.across_m = 0.1, .along_m = 0.1};
    EXPECT_EQ(sled_refusal(rig, {.altitude_m = 0.6}), kAccepted);
    // The middle 40 mm over the floor, the side forward 43.3 mm nearer.
    const std::string refusal =
        sled_refusal(rig, {.altitude_m = 0.08, .pitch_rad = -60.0 * kDegree});
    EXPECT_TRUE(
        refusal.starts_with("altitude 0.08 m, pitch -60, roll 0 degrees: strobe 'lamp' has a lamp "
                            "at or below the sea floor, "))
        << refusal;
}

// Lamps a hundredth of their height apart: 1e8 of them, and a map would take a day.
TEST(Lightmap, RefusesAnEmitterOfMoreLampsThanAnyoneHasTimeFor) {
    Rig rig = scene_rig("one-lamp.toml", 32, 24);
    rig.strobes[0].emitter = {.across_m = 0.2, .along_m = 0.2};
    const std::string refusal = sled_refusal(rig, {.altitude_m = 0.002});
    EXPECT_TRUE(
        refusal.starts_with("altitude 0.002 m, pitch 0, roll 0 degrees: strobe 'lamp': found "
                            "an emitter that needs "))
        << refusal;
    EXPECT_TRUE(refusal.ends_with("; allowed: up to 100000")) << refusal;
}

TEST(Lightmap, RefusesObjectsAndScenes) {
    Rig with_object = habcam(8, 6);
    with_object.objects.push_back({.name = "ball",
                                   .shape = Sphere{.centre_m = {0.0, 0.0, 1.5}, .radius_m = 0.1},
                                   .reflectance = with_object.seafloor.reflectance});
    EXPECT_EQ(
        refusal_of([&] { return map_of(with_object); }),
        "found the object 'ball'; allowed: the bare floor, since a lightmap shows nothing else");
    Rig with_scene = habcam(8, 6);
    with_scene.scene = "reef.pov";
    EXPECT_THROW(map_of(with_scene), InputError);
}

TEST(Lightmap, IsTheSameToTheBitForAnyThreads) {
    Rig rig = habcam(200, 150);
    const Lightmap one = map_of(rig, 1);
    for (const int threads : {2, 3, 7}) EXPECT_EQ(map_of(rig, threads).samples, one.samples);
}

// The shape of a beam's table counts, not its unit.
TEST(Lightmap, DoesNotDependOnTheScaleOfABeamsTable) {
    const TempFolder folder;
    const auto map_with = [&](const std::string& one, const std::string& half) {
        write_file(folder.path() / "lamp.csv",
                   fmt::format("theta_deg,intensity\n0,{0}\n30,{0}\n50,{1}\n90,0\n", one, half));
        std::ifstream habcam(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam-led.toml");
        std::string text{std::istreambuf_iterator<char>(habcam), {}};
        const std::string fwhm = "fwhm_deg = 100.0";
        text.replace(text.find(fwhm), fwhm.size(), "table = \"lamp.csv\"");
        Rig rig = parse_rig(text, "rig.toml", folder.path());
        rig.camera.width_px = 32;
        rig.camera.height_px = 24;
        return map_of(rig).samples;
    };
    const std::vector<float> expected = map_with("2", "1");
    EXPECT_GT(*std::ranges::max_element(expected), 0.0F);
    for (const auto& [one, half] : {std::pair{"1e308", "5e307"},
                                    std::pair{"1e200", "5e199"},
                                    std::pair{"1e-200", "5e-201"},
                                    std::pair{"1e-307", "5e-308"}}) {
        const std::vector<float> found = map_with(one, half);
        for (std::size_t i = 0; i < expected.size(); ++i)
            ASSERT_NEAR(found[i] / expected[i], 1.0, 4.0 * 0x1p-24) << one << ", sample " << i;
    }
}

// Else maps would be black, infinite, or of few digits.
TEST(Lightmap, RefusesALightThatFloatsDoNotHold) {
    const auto error_of = [](const auto& change) {
        Rig rig = habcam(8, 6);
        change(rig);
        return refusal_of([&] { return map_of(rig); });
    };
    const auto lamp = [](double value) {
        return [value](Rig& rig) {
            rig.strobes[1].spectrum = Spectrum("lamp", {300.0, 900.0}, {value, value});
        };
    };
    const auto weight = [](double value) {
        return [value](Rig& rig) {
            for (Cone& cone : rig.strobes[1].beam.cones) cone.weight = value;
        };
    };
    const auto power = [](double value) {
        return [value](Rig& rig) { rig.strobes[1].power = value; };
    };
    for (const double value : {1e-320, 1e-100, 1e-40, 1e40, 1e100, 1e308}) {
        for (const std::string& error :
             {error_of(lamp(value)), error_of(weight(value)), error_of(power(value))}) {
            EXPECT_TRUE(error.starts_with("strobe 'aft', R: found up to "))
                << value << ": " << error;
        }
    }
    for (const double value : {0.0, 1e-20, 1e20}) {
        EXPECT_EQ(error_of(lamp(value)), kAccepted) << value;
        EXPECT_EQ(error_of(weight(value)), kAccepted) << value;
        EXPECT_EQ(error_of(power(value)), kAccepted) << value;
    }
}

}  // namespace
}  // namespace aphotic::lightmap_test
