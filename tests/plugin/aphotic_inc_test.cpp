// SPDX-License-Identifier: BSD-3-Clause
//
// plugin/include/aphotic.inc, by real POV-Ray: every macro in a scene, against closed forms; every
// error provoked.
#include "rig/file/rig_reader.h"
#include "rig/geometry.h"
#include "scene_gen/quick_look.h"
#include "support/has.h"
#include "support/mistakes.h"
#include "support/povray_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

namespace aphotic::aphotic_inc_test {
namespace {

constexpr double kPi = std::numbers::pi;
// A half float's rounding, and a little for single-precision colours.
constexpr double kHalfFloatError = 6e-4;
// Two half floats of nearly equal light.
constexpr double kTwoHalfFloats = 2.0 * kHalfFloatError;

class AphoticInc : public testing::Test {
  protected:
    PovRayRun run(const std::string& sdl, int width_px = 8, int height_px = 8) {
        return run_povray(folder_.path(), sdl, width_px, height_px);
    }
    PovRayRun well(const std::string& sdl, int width_px = 8, int height_px = 8) {
        PovRayRun result = run(sdl, width_px, height_px);
        EXPECT_TRUE(result.end.succeeded()) << result.said() << sdl;
        EXPECT_EQ(result.said(), "") << "nothing is printed when all is well";
        if (result.samples.empty()) result.samples.resize(3U * 64U);
        return result;
    }
    // One floating-point expression, as POV-Ray evaluates it.
    double value(const std::string& expression) {
        const PovRayRun result =
            run(in_band(odd_band(),
                        "#debug concat(\"value \", str(" + expression +
                            ", 0, 15), \"\\n\")\ncamera { location 0 } sphere { 9, 1 }\n"));
        const std::size_t at = result.said().find("value ");
        EXPECT_NE(at, std::string::npos) << result.said();
        return at == std::string::npos ? 0.0 : std::stod(result.said().substr(at + 6));
    }
    void expect_equal_images(const PovRayRun& a, const PovRayRun& b, double bound) {
        ASSERT_EQ(a.samples.size(), b.samples.size());
        for (std::size_t i = 0; i < a.samples.size(); ++i) {
            ASSERT_NEAR(a.samples[i], b.samples[i], bound * std::abs(b.samples[i])) << i;
        }
        EXPECT_GT(b.at(1, 4, 4), 0.0F);
    }

    TempFolder folder_;
};

// A lamp beside the camera at the origin, a plane at distance 2 facing both; one pixel on the axis.
constexpr const char* kCamera = "Aphotic_Camera (1, 0.01)\n";
constexpr const char* kFloor =
    "plane { -z, -2 pigment { Aphotic_Pigment (\"light\") } finish { Aphotic_Finish (0, 40) } }\n";

// --- The closed form -------------------------------------------------------------------------

// L = Flux P A cos(theta) / (pi d^2) rho cos(i) exp(-K (d + r)) E at the image's middle.
TEST_F(AphoticInc, AConeInWaterIsTheClosedForm) {
    const Band band = odd_band();
    const PovRayRun image = well(in_band(band,
                                         std::string(kCamera) + "Aphotic_Water ()\n" +
                                             "Aphotic_Cone (<0.5, 0, 0>, <-0.1, 0, 2>, 40, 0.25, "
                                             "\"arc\", 3)\n" +
                                             kFloor + "Aphotic_End ()\n"),
                                 1,
                                 1);
    const double d_m = std::hypot(0.5, 2.0);
    const double cos_theta = (0.5 * 0.1 + 2.0 * 2.0) / (d_m * std::hypot(0.1, 2.0));
    for (std::size_t c = 0; c < 3; ++c) {
        const double nm = band.lambda_nm[c];
        const double expected = band.lamps[1].spectrum.at(nm) * 3.0 * 0.25 * cos_theta /
                                (kPi * d_m * d_m) * band.reflectances[0].spectrum.at(nm) *
                                (2.0 / d_m) * std::exp(-band.attenuation_per_m[c] * (d_m + 2.0)) *
                                band.exposure[c];
        EXPECT_NEAR(image.samples[c] / expected, 1.0, kHalfFloatError) << "channel " << c;
    }
}

// A highlight adds phong max(0, r.l)^size, whatever the reflectance: here seen in the mirror's
// direction.
TEST_F(AphoticInc, AFinishHasPovraysPhong) {
    const std::string lamp = "Aphotic_Cone (<0, 0, 0.5>, z, 90, 0.25, \"flash\", 1)\n";
    const std::string floor =
        "plane { -z, -2 pigment { rgb 0 } finish { Aphotic_Finish (0.3, 12) } }\n";
    const Band band = odd_band();
    const PovRayRun image = well(in_band(band, kCamera + lamp + floor), 1, 1);
    for (std::size_t c = 0; c < 3; ++c) {
        const double expected = band.lamps[0].spectrum.at(band.lambda_nm[c]) * 0.25 * 0.3 /
                                (kPi * 1.5 * 1.5) * band.exposure[c];
        EXPECT_NEAR(image.samples[c] / expected, 1.0, kHalfFloatError);
    }
}

// Cosines c between those of the edge's ends weigh as 6 s (1 - s), s from 0 to 1: the moments of c
// make the integrals of cos^n times the soft step closed forms.
TEST_F(AphoticInc, SoftLobesOfAnyExtremeAreTheirIntegrals) {
    constexpr double kSimpson = 1e-8;
    struct Lobe {
        double half_angle_deg, exponent, edge_deg, integral;
    };
    const auto none = [](double half_angle_deg, double edge_deg) {
        return 1.0 - (std::cos(half_angle_deg * kPi / 180.0) +
                      std::cos((half_angle_deg - edge_deg) * kPi / 180.0)) /
                         2.0;
    };
    const double narrow = std::pow(std::sin(1e-3 * kPi / 180.0), 2);
    const std::vector<Lobe> lobes{
        {90.0, 0.0, 13.949023469432351, 2.0 * kPi * none(90.0, 13.949023469432351)},
        {90.0, 0.0, 90.0, kPi},
        {90.0, 0.0, 1e-9, 2.0 * kPi},
        {90.0, 1.0, 90.0, kPi * (1.0 - 6.0 / 20.0)},
        {90.0, 1000.0, 90.0, 2.0 * kPi / 1001.0 * (1.0 - 6.0 / (1003.0 * 1004.0))},
        {90.0, 1e-9, 90.0, kPi},
        {50.0, 0.0, 1e-15, 2.0 * kPi * none(50.0, 0.0)},
        {1e-3, 1.0, 1e-13, kPi * narrow},
        {1e-3, 1.0, 1e-3, 0.5 * kPi * narrow}};
    for (const Lobe& lobe : lobes) {
        const std::string call =
            fmt::format("Aphotic_Lobe_Intensity ({:.17g}, 1, {:.17g}, {:.17g})",
                        lobe.half_angle_deg,
                        lobe.exponent,
                        lobe.edge_deg);
        EXPECT_NEAR(value(call) * lobe.integral, 1.0, kSimpson) << call;
    }
}

TEST_F(AphoticInc, AxialIntensityCarriesItsShareOfTheFlux) {
    constexpr double kDigits = 1e-12;  // of those printed
    EXPECT_NEAR(value("Aphotic_Axial_Intensity (90, 0.5)"), 0.5 / kPi, kDigits);
    EXPECT_NEAR(value("Aphotic_Axial_Intensity (30, 1)"), 4.0 / kPi, kDigits);
    // The integral of cos^3 over 60 degrees is 2 pi/4 (1 - 1/16).
    EXPECT_NEAR(value("Aphotic_Lobe_Intensity (60, 1, 3, 0)"), 32.0 / (15.0 * kPi), kDigits);
    EXPECT_NEAR(value("Aphotic_Lobe_Intensity (90, 1, 0, 0)"), 0.5 / kPi, kDigits);
    // An edge over all of a hemisphere makes c^2 (3 - 2 c) of it, whose integral is 2 pi/2, and of
    // c^3 (3 - 2 c) 2 pi 7/20.
    constexpr double kSimpson = 1e-9;
    EXPECT_NEAR(value("Aphotic_Lobe_Intensity (90, 1, 0, 90)"), 1.0 / kPi, kSimpson);
    EXPECT_NEAR(value("Aphotic_Lobe_Intensity (90, 1, 1, 90)"), 10.0 / (7.0 * kPi), kSimpson);
}

TEST_F(AphoticInc, ReflectanceIsTheBandsAsAVector) {
    constexpr double kDigits = 1e-12;
    const Band band = odd_band();
    EXPECT_NEAR(value("Aphotic_Reflectance (\"dark\").x"),
                band.reflectances[1].spectrum.at(450.0),
                kDigits);
    EXPECT_NEAR(value("Aphotic_Reflectance (\"dark\").z"),
                band.reflectances[1].spectrum.at(650.0),
                kDigits);
}

// A strobe is its cones, an emitter its lamps, at the centres of the rectangle's cells.
TEST_F(AphoticInc, AStrobeIsItsConesFromItsLamps) {
    const std::string before = std::string("Aphotic_Camera (1, 2)\nAphotic_Water ()\n") + kFloor +
                               "#declare Beam = array[2][2] {{20, 0.3}, {90, 0.7}}\n";
    const PovRayRun strobe =
        well(in_band(odd_band(),
                     before + "Aphotic_Strobe (<0.3, 0.1, 0>, z, Beam, \"flash\", "
                              "2, <0.2, 0.1, 2, 1>)\n"));
    std::string cones = before;
    for (const char* x : {"0.25", "0.35"}) {
        for (const char* cone :
             {"20, Aphotic_Axial_Intensity (20, 0.3)", "90, Aphotic_Axial_Intensity (90, 0.7)"}) {
            cones += fmt::format("Aphotic_Cone (<{}, 0.1, 0>, z, {}, \"flash\", 1)\n", x, cone);
        }
    }
    expect_equal_images(strobe, well(in_band(odd_band(), cones)), kTwoHalfFloats);
}

// A pattern is what it says, in whichever unit and however the sled is turned; and the rig's own
// beams are had by name.
TEST_F(AphoticInc, APatternIsItsFunction) {
    const std::string cone = "#declare Beam = array[1][2] {{90, 1}}\n";
    const std::string pattern =
        "#declare Lambert = function (x, y, z) { max(0, z) / pi }\n"
        "#declare Beam = Aphotic_Pattern (Lambert, 0.4)\n";
    const std::string strobe =
        "Aphotic_Strobe (<0.3, 0.1, 0> / Aphotic_Unit, <-0.2, 0.1, 1>, Beam, \"flash\", 2, "
        "<0.2 / Aphotic_Unit, 0.1 / Aphotic_Unit, 2, 3>)\n";
    for (const char* setting : {"",
                                "#declare Aphotic_Unit = 0.01;\n",
                                "#declare Aphotic_Sled = transform { rotate <20, -30, 70> "
                                "translate <3, -2, 5> }\n"}) {
        const auto scene = [&](const std::string& beam) {
            return in_band(odd_band(),
                           setting + beam + "Aphotic_Camera (1, 2)\nAphotic_Water ()\n" + strobe +
                               "Aphotic_Seafloor (2 / Aphotic_Unit, 9, -7, \"light\")\n");
        };
        expect_equal_images(well(scene(pattern)), well(scene(cone)), kTwoHalfFloats);
    }
}

TEST_F(AphoticInc, AQuickLookKnowsTheRigsBeamsByName) {
    const std::string begin =
        "#version 3.7;\n#include \"aphotic.inc\"\nAphotic_Rig_Camera ()\n"
        "Aphotic_Seafloor (2, 5, 0, \"sand\")\n";
    const auto lit_by = [&](const std::string& beam) {
        return well(begin + "Aphotic_Strobe (<0.5, 0, 0>, <-0.47, 0, 0.88>, " + beam +
                    ", \"xenon-flash\", 1, 0)\n");
    };
    expect_equal_images(lit_by("Aphotic_Beam (\"fresnel\")"),
                        lit_by("array[3][2] {{10, 0.165}, {26.565, 0.094}, {90, 0.741}}"),
                        kTwoHalfFloats);
}

// The lamps of an emitter stand where the generator has them, also where it shines so nearly fore
// or aft that forward in its plane is hardly told from any other way. For the macro that makes
// them, one that says where they are.
TEST_F(AphoticInc, AnEmittersLampsAreTheGenerators) {
    const Emitter emitter{.across_m = 0.2, .along_m = 0.1};
    std::vector<Eigen::Vector3d> wanted_m;
    std::string scene =
        "#macro Aphotic_Light (Position, Axis, Half_Angle, Axial_Intensity, Exponent, Edge, Lamp, "
        "Power, Caller)\n"
        "   #debug concat(\"lamp \", vstr(3, Position, \" \", 0, 15), \"\\n\")\n#end\n"
        "#declare Beam = array[1][2] {{60, 1}}\n";
    for (const double end : {1.0, -1.0}) {
        for (const double off_rad : {0.0, 0.5e-6, 2e-6, 3e-5, 1e-4, 0.3}) {
            const Eigen::Vector3d axis(end, 0.6 * off_rad, -0.8 * off_rad);
            const Strobe strobe{.name = "",
                                .position_m = {0.2, 0.3, 0.1},
                                .axis = axis.normalized(),
                                .beam = {},
                                .spectrum = odd_band().lamps[0].spectrum,
                                .power = 1.0,
                                .emitter = emitter};
            for (const Eigen::Vector3d& lamp_m : lamp_positions_m(strobe, {2, 2})) {
                wanted_m.push_back(to_povray(lamp_m));
            }
            scene += fmt::format(
                "Aphotic_Strobe (<0.3, 0.2, 0.1>, <{}, {}, {}>, Beam, \"flash\", 1, "
                "<0.2, 0.1, 2, 2>)\n",
                axis.y(),
                axis.x(),
                axis.z());
        }
    }
    const PovRayRun result =
        run(in_band(odd_band(), scene + "camera { location 0 } sphere { 9, 1 }\n"));
    std::vector<Eigen::Vector3d> found_m;
    std::istringstream words(result.said());
    for (std::string word; words >> word;) {
        if (word != "lamp") continue;
        Eigen::Vector3d& lamp_m = found_m.emplace_back();
        words >> lamp_m.x() >> lamp_m.y() >> lamp_m.z();
    }
    ASSERT_EQ(found_m.size(), wanted_m.size()) << result.said();
    // A millionth of a radian has ten digits left of a double's sixteen.
    constexpr double kRounding = 1e-9;
    // Each strobe has four, in an order of its own.
    for (std::size_t i = 0; i < found_m.size(); ++i) {
        double nearest_m = 1.0;
        for (std::size_t j = i / 4 * 4; j < i / 4 * 4 + 4; ++j) {
            nearest_m = std::min(nearest_m, (found_m[i] - wanted_m[j]).norm());
        }
        EXPECT_LE(nearest_m, kRounding) << "lamp " << i << " at " << found_m[i].transpose();
    }
}

// --- Places and units ------------------------------------------------------------------------

const std::string kSledScene =
    "Aphotic_Camera (1, 1)\nAphotic_Water ()\n"
    "Aphotic_Cone (<0.5, 0.2, 0>, <-0.2, 0.1, 2>, 50, 0.25, \"flash\", 1)\n";

// The floor through (0, 0, 2) in the sled's frame is a level plane 2 below the camera in a world
// whose y is up, and a sphere at (0.2, 0.1, 1.9) is one at (0.2, 0.1, 0.1) of it.
TEST_F(AphoticInc, PlaceTransPutsTheSledIntoAWorldOfAnotherFrame) {
    const std::string things = "pigment { Aphotic_Pigment (\"light\") } }\n";
    const PovRayRun sled = well(in_band(
        odd_band(),
        kSledScene + "plane { -z, -2 " + things + "sphere { <0.2, 0.1, 1.9>, 0.15 " + things));
    const PovRayRun world = well(in_band(
        odd_band(),
        "#declare Aphotic_Sled = Aphotic_Place_Trans (<0, 2, 0>, <0, 0, 0>, z)\n" + kSledScene +
            "plane { y, 0 " + things + "sphere { <0.2, 0.1, 0.1>, 0.15 " + things));
    expect_equal_images(world, sled, kTwoHalfFloats);
}

TEST_F(AphoticInc, UnitScalesWaterAndLight) {
    const std::string things = " pigment { Aphotic_Pigment (\"light\") } }\n";
    const PovRayRun metres = well(in_band(odd_band(), kSledScene + "plane { -z, -2" + things));
    const PovRayRun centimetres =
        well(in_band(odd_band(),
                     "#declare Aphotic_Unit = 0.01;\nAphotic_Camera (1, 1)\nAphotic_Water ()\n"
                     "Aphotic_Cone (<50, 20, 0>, <-20, 10, 200>, 50, 0.25, \"flash\", 1)\n"
                     "plane { -z, -200" +
                         things));
    expect_equal_images(centimetres, metres, kTwoHalfFloats);
}

// Straight down, the floor at Altitude along z; with pitch it falls away forward: the top of the
// image sees it farther off, so darker.
TEST_F(AphoticInc, TheSeafloorTiltsWithTheSled) {
    const std::string before =
        "Aphotic_Camera (1, 0.5)\nAphotic_Cone (<0, 0, 0>, z, 90, 0.25, \"flash\", 1)\n";
    const PovRayRun level =
        well(in_band(odd_band(), before + "Aphotic_Seafloor (2, 0, 0, \"light\")\n"));
    const PovRayRun plane = well(in_band(odd_band(), before + kFloor));
    expect_equal_images(level, plane, 0.0);
    const PovRayRun bow_up =
        well(in_band(odd_band(), before + "Aphotic_Seafloor (2, 20, 0, \"light\")\n"));
    EXPECT_LT(bow_up.at(1, 4, 0), bow_up.at(1, 4, 7));
    const PovRayRun starboard_down =
        well(in_band(odd_band(), before + "Aphotic_Seafloor (2, 0, 20, \"light\")\n"));
    EXPECT_LT(starboard_down.at(1, 0, 4), starboard_down.at(1, 7, 4));
}

// The field of view does not depend on the size of the image.
TEST_F(AphoticInc, TheCameraShowsTheSameFieldAtAnySize) {
    const std::string scene =
        "Aphotic_Camera (12, 9)\nAphotic_Cone (0, z, 90, 1, \"flash\", 1)\n"
        "plane { -z, -2 pigment { checker Aphotic_Pigment (\"light\") "
        "Aphotic_Pigment (\"dark\") scale 0.375 } }\n";
    // Nine pixels' centres of one are those of a third of the other's.
    const PovRayRun coarse = well(in_band(odd_band(), scene), 4, 4);
    const PovRayRun fine = well(in_band(odd_band(), scene), 12, 12);
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            EXPECT_EQ(coarse.at(1, column, row), fine.at(1, 3 * column + 1, 3 * row + 1));
        }
    }
}

// Of index 1, a port is not there; in glass and air no water dims.
TEST_F(AphoticInc, APortHoldsNoWater) {
    Band band = odd_band();
    band.water_index = 1.0;
    band.glasses = {{.name = "air", .index = 1.0}};
    const std::string cone = "Aphotic_Cone (<1.5, 0, 0>, <-0.7, 0, 1>, 90, 0.25, \"flash\", 1)\n";
    const std::string before = kCamera + std::string("Aphotic_Water ()\n");
    const PovRayRun bare = well(in_band(band, before + cone + kFloor), 1, 1);
    const PovRayRun port =
        well(in_band(band, before + "Aphotic_Port (0.1, 0.05, \"air\")\n" + cone + kFloor), 1, 1);
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(port.samples[c] / bare.samples[c],
                    std::exp(band.attenuation_per_m[c] * 0.15),
                    kTwoHalfFloats);
    }
}

// Whatever of the scene's own is around the camera, and in which order POV-Ray meets it: only the
// port bends rays.
TEST_F(AphoticInc, APortIsTheSameInsideOtherObjects) {
    const std::string unseen = " hollow pigment { rgbt 1 } finish { ambient 0 diffuse 0 } }\n";
    const std::string sky = "sphere { 0, 100" + unseen;
    const std::string water = "box { <-50, -60, -70>, <80, 90, 100>" + unseen;
    const std::string surface = "plane { z, -3 inverse" + unseen;
    const std::vector<std::string> all{"Bounding=on", "Bounding_Threshold=1"};
    const std::vector<std::string> by_another_tree{"Bounding_Method=2", "Bounding_Threshold=1"};
    const std::vector<std::string> none{"Bounding=off"};
    struct Around {
        std::string port, before, after;
        std::vector<std::string> settings;
    };
    const std::string flat = "Aphotic_Port (0.05, 0.01, \"bk7\")\n";
    const std::string tilted = "Aphotic_Tilted_Port (0.05, 0.01, \"bk7\", <0.2, -0.3, 1>)\n";
    const std::string dome = "Aphotic_Dome_Port (<0.01, 0, 0.02>, 0.09, 0.01, \"bk7\")\n";
    const std::vector<Around> cases{{dome, "", "", all},
                                    {dome, "", sky, none},
                                    {dome, water, "", all},
                                    {dome, "", water + sky, by_another_tree},
                                    {dome, surface, sky, all},
                                    {flat, water, sky, all},
                                    {tilted, "", surface, none}};
    for (const Around& around : cases) {
        SCOPED_TRACE(around.port + around.before + around.after + around.settings.front());
        const auto scene = [&](const std::string& before, const std::string& after) {
            return in_band(odd_band(),
                           before + "Aphotic_Camera (1, 0.7)\nAphotic_Water ()\n" + around.port +
                               after +
                               "Aphotic_Cone (<0.5, 0.2, 0>, <-0.2, 0.1, 2>, 90, 0.25, \"flash\", "
                               "1)\n" +
                               kFloor);
        };
        const PovRayRun alone = run_povray(folder_.path(), scene("", ""), 8, 8, none);
        const PovRayRun inside =
            run_povray(folder_.path(), scene(around.before, around.after), 8, 8, around.settings);
        expect_equal_images(inside, alone, kTwoHalfFloats);
    }
}

// --- Spectra over a surface ------------------------------------------------------------------

// A mask of two materials is each of them where it says so, to the last bit.
TEST_F(AphoticInc, AMaskOfTwoMaterialsIsTheTwoRendersPutTogether) {
    constexpr int kSide = 24;
    // A plain PGM as mask: columns and rows in a pattern without symmetry.
    std::string mask = fmt::format("P2\n{} {}\n255\n", kSide, kSide);
    const auto is_dark = [](int column, int row) { return (column * 5 + row * 3) % 7 < 3; };
    for (int row = 0; row < kSide; ++row) {
        for (int column = 0; column < kSide; ++column) mask += is_dark(column, row) ? "255 " : "0 ";
        mask += "\n";
    }
    write_file(folder_.path() / "mask.pgm", mask);
    const auto scene = [](const std::string& pigment) {
        return in_band(odd_band(),
                       "Aphotic_Camera (1, 1)\nAphotic_Water ()\n"
                       "Aphotic_Cone (<0.5, 0.2, 0>, <-0.2, 0.1, 2>, 50, 0.25, \"flash\", 1)\n"
                       "plane { -z, -2 pigment { " +
                           pigment + " } }\n");
    };
    // The picture lies over the floor's 2 x 2 that the camera sees.
    const PovRayRun both =
        well(scene("image_pattern { pgm \"mask.pgm\" gamma 1.0 once } pigment_map { "
                   "[0 Aphotic_Pigment (\"light\")] [1 Aphotic_Pigment (\"dark\")] } "
                   "translate <-0.5, -0.5, 0> scale 2"),
             kSide,
             kSide);
    const PovRayRun light = well(scene("Aphotic_Pigment (\"light\")"), kSide, kSide);
    const PovRayRun dark = well(scene("Aphotic_Pigment (\"dark\")"), kSide, kSide);
    for (int row = 0; row < kSide; ++row) {
        for (int column = 0; column < kSide; ++column) {
            for (std::size_t c = 0; c < 3; ++c) {
                const PovRayRun& one = is_dark(column, row) ? dark : light;
                ASSERT_EQ(both.at(c, column, row), one.at(c, column, row)) << column << ", " << row;
            }
        }
    }
}

// --- What would spoil ------------------------------------------------------------------------

TEST_F(AphoticInc, TheSceneCannotBringBackPovraysOwnLight) {
    const std::string scene = std::string(kCamera) +
                              "Aphotic_Cone (<0.5, 0, 0>, z, 90, 0.25, \"flash\", 1)\n" +
                              "plane { -z, -2 pigment { Aphotic_Pigment (\"light\") } "
                              "finish { ambient 0.5 diffuse 1 } }\n";
    const PovRayRun plain = well(in_band(odd_band(), scene + "Aphotic_End ()\n"));
    const PovRayRun spoilt = well(
        in_band(odd_band(),
                "global_settings { ambient_light rgb 9 adc_bailout 0.5 }\nbackground { rgb 1 }\n" +
                    scene + "Aphotic_End ()\n"));
    expect_equal_images(spoilt, plain, 0.0);
}

// A dozen sheets that each let half of the light through leave 2^-12 of it, which POV-Ray's own
// bailout, 1/255, takes for nothing. Two dozen leave less than counts.
TEST_F(AphoticInc, RaysAreFollowedAsFarAsTheyCount) {
    const std::string scene =
        std::string(kCamera) + "Aphotic_Cone (<0.5, 0, 0>, z, 90, 0.25, \"flash\", 1)\n" + kFloor;
    const auto behind = [&](int sheets) {
        return well(in_band(odd_band(),
                            scene + fmt::format("#for (I, 1, {}) plane {{ -z, -1 - I / 50 pigment "
                                                "{{ rgbt 0.5 }} finish {{ diffuse 0 }} no_shadow "
                                                "}} #end\n",
                                                sheets)),
                    1,
                    1)
            .samples[1];
    };
    const float bare = well(in_band(odd_band(), scene), 1, 1).samples[1];
    EXPECT_NEAR(std::ldexp(behind(12), 12) / bare, 1.0, kTwoHalfFloats);
    EXPECT_EQ(behind(24), 0.0F);
}

// Down a corridor of perfect mirrors, seen askew: thirty reflections to the wall at its end.
TEST_F(AphoticInc, MirrorsAreFollowedThirtyTimes) {
    const Band band = odd_band();
    const PovRayRun image = well(
        in_band(
            band,
            "#declare Mirror = texture { pigment { rgb 0 } finish { diffuse 0 reflection 1 } }\n"
            "plane { y, 0.5 texture { Mirror } rotate 45*x }\n"
            "plane { y, -0.5 texture { Mirror } rotate 45*x }\n"
            "plane { -z, -30.2 pigment { Aphotic_Pigment (\"light\") } rotate 45*x }\n"
            "Aphotic_Camera (1, 0.0001)\n"
            "Aphotic_Cone (vrotate(29.2*z, 45*x), vrotate(z, 45*x), 80, 0.25, \"flash\", 1)\n"),
        1,
        1);
    const double d2_m2 = 1.0 + 0.2 * 0.2;  // to the wall 1 m off, 0.2 m beside the axis
    const double expected = band.lamps[0].spectrum.at(550.0) * 0.25 / (kPi * d2_m2 * d2_m2) *
                            band.reflectances[0].spectrum.at(550.0) * band.exposure[1];
    EXPECT_NEAR(image.samples[1] / expected, 1.0, kHalfFloatError);
}

// The first word on gamma counts, and it is the library's: POV-Ray itself says so.
TEST_F(AphoticInc, AnotherGammaIsIgnoredAloud) {
    const std::string scene =
        std::string(kCamera) + "Aphotic_Cone (<0.5, 0, 0>, z, 90, 0.25, \"flash\", 1)\n" + kFloor;
    const PovRayRun spoilt =
        run(in_band(odd_band(), "global_settings { assumed_gamma 2.2 }\n" + scene));
    EXPECT_TRUE(has(spoilt.said(), "New instance of assumed_gamma ignored"));
    expect_equal_images(spoilt, well(in_band(odd_band(), scene)), 0.0);
}

TEST_F(AphoticInc, KeepsTheLanguageVersionOfTheScene) {
    const std::string sdl =
        "#version 3.6;\n" + band_sdl(odd_band()) +
        "#include \"aphotic.inc\"\n#include \"aphotic.inc\"\n#debug concat(\"version \", "
        "str(version, 0, 1), \"\\n\")\ncamera { location 0 } sphere { 9, 1 }\n";
    EXPECT_TRUE(has(run(sdl).said(), "version 3.6"));
}

TEST_F(AphoticInc, TellsOfItselfWhenAsked) {
    const PovRayRun result =
        run("#version 3.7;\n#declare View_POV_Include_Stack = true;\n"
            "#include \"aphotic.inc\"\ncamera { location 0 } sphere { 9, 1 }\n");
    EXPECT_TRUE(has(result.log, "including aphotic.inc"));
    EXPECT_TRUE(has(result.log, "including aphotic_quick.inc"));
}

// --- The quick look --------------------------------------------------------------------------

TEST_F(AphoticInc, WithoutABandIsAQuickLookByHabcam) {
    const std::string begin = "#version 3.7;\n#include \"aphotic.inc\"\n";
    const std::string floor = "Aphotic_Rig_Seafloor ()\n";
    const PovRayRun whole = well(begin + "Aphotic_Rig ()\n" + floor);
    const PovRayRun parts =
        well(begin + "Aphotic_Rig_Camera ()\nAphotic_Water ()\nAphotic_Rig_Strobes ()\n" + floor);
    expect_equal_images(parts, whole, 0.0);
    // For the eye: within 0 and 1, and water takes the red.
    for (const float sample : whole.samples) {
        EXPECT_GT(sample, 0.0F);
        EXPECT_LT(sample, 1.0F);
    }
    EXPECT_LT(whole.at(0, 4, 4), whole.at(1, 4, 4));
    const PovRayRun brighter =
        well(begin + "#declare Aphotic_Quick_Exposure = 0.5;\nAphotic_Rig ()\n" + floor);
    EXPECT_NEAR(brighter.at(1, 4, 4) / whole.at(1, 4, 4), 0.5, kTwoHalfFloats);
}

TEST_F(AphoticInc, AQuickLookShowsAnUnknownSpectrumAsGreyAloud) {
    const PovRayRun result =
        run("#version 3.7;\n#include \"aphotic.inc\"\nAphotic_Rig ()\n"
            "plane { -z, -2 pigment { Aphotic_Pigment (\"rust.csv\") } }\n");
    EXPECT_TRUE(result.end.succeeded());
    EXPECT_TRUE(has(result.said(), "a quick look shows \"rust.csv\" as grey. It knows: sand"));
}

// The file in the repository is the generator's.
TEST(QuickLook, IsWhatTheGeneratorWrites) {
    const std::string source = APHOTIC_SOURCE_DIR;
    EXPECT_EQ(read_text_file(source + "/plugin/include/aphotic_quick.inc"),
              quick_look_sdl(read_rig(source + "/scenes/habcam.toml"), source + "/scenes"))
        << "write it anew: aphotic generate scenes/habcam.toml --quick-look "
           "plugin/include/aphotic_quick.inc";
    for (const std::string scene : {"reef", "anchor", "chart"}) {
        const std::string folder = source + "/scenes/user/" + scene;
        EXPECT_EQ(read_text_file(folder + "/aphotic_quick.inc"),
                  quick_look_sdl(read_rig(folder + "/" + scene + ".toml"), folder))
            << scene;
    }
}

// --- Errors ----------------------------------------------------------------------------------

std::vector<Mistake> misuses() {
    return mistakes_in("plugin/mistakes/aphotic_inc.txt", 50);
}

class AphoticIncMisuse : public testing::TestWithParam<Mistake> {};

TEST_P(AphoticIncMisuse, IsNamed) {
    const TempFolder folder;
    const PovRayRun result = run_povray(
        folder.path(),
        in_band(odd_band(), GetParam().parts.front().text + "\ncamera { location 0 }\n"));
    EXPECT_EQ(result.end.exit_code, 1);
    EXPECT_TRUE(has(result.said(), GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(All,
                         AphoticIncMisuse,
                         testing::ValuesIn(misuses()),
                         [](const auto& misuse) { return misuse.param.parts.front().key; });

// What comes too late for any macro the end tells; so does a sled that comes after all of them, one
// that skews, and a floor in another unit than the strobes.
TEST_F(AphoticInc, SettingsThatComeTooLateAreErrors) {
    const std::string rig =
        "Aphotic_Camera (1, 1)\nAphotic_Cone (<0.5, 0, 0>, z, 90, 0.25, \"flash\", 1)\n";
    const auto said = [&](const std::string& scene) {
        return run(in_band(odd_band(), scene)).said();
    };
    const auto expect = [&](const std::string& scene, const std::string& message) {
        const std::string words = said(scene);
        EXPECT_TRUE(has(words, message));
    };
    expect(rig + "#declare Aphotic_Unit = 0.01;\nAphotic_End ()\n",
           "Aphotic_End: found Aphotic_Unit 0.010000, declared after macros that took it for "
           "1.000000;");
    expect("Aphotic_Seafloor (2, 0, 0, \"light\")\n#declare Aphotic_Unit = 0.01;\n" + rig,
           "Aphotic_Cone: found Aphotic_Unit 0.01");
    expect(rig + "#declare Aphotic_Sled = transform { translate x }\nAphotic_End ()\n",
           "Aphotic_End: found Aphotic_Sled declared or changed after Aphotic_C");
    // Another for a part of the scene, or none.
    const std::string sled = "#declare Aphotic_Sled = transform { translate x }\n";
    expect(sled +
               "Aphotic_Camera (1, 1)\n#declare Aphotic_Sled = transform { translate y }\n"
               "Aphotic_Cone (0, z, 90, 1, \"flash\", 1)\n",
           "Aphotic_Cone: found Aphotic_Sled declared or changed after Aphotic_Camera");
    expect(sled + rig + "#undef Aphotic_Sled\nAphotic_Seafloor (2, 0, 0, \"light\")\n",
           "Aphotic_Seafloor: found Aphotic_Sled declared or changed after Aphotic_Camera");
    expect("#declare Aphotic_Sled = transform { scale <-1, 1, 1> }\n" + rig, "or mirrors them");
    expect("#declare Aphotic_Sled = transform { matrix <1, 0, 0, 0.5, 1, 0, 0, 0, 1, 0, 0, 0> }\n" +
               rig,
           "or skews or mirrors them");
    expect(rig + "#declare Aphotic_Fade_Distance = 1;\nAphotic_End ()\n",
           "Aphotic_End: found Aphotic_Fade_Distance 1.000000,");
    // Each strobe may have its own edge, and a sled may lie anywhere, turned by any angle.
    well(in_band(odd_band(),
                 "#declare Aphotic_Sled = transform { rotate <12.3, 45.6, 78.9> "
                 "translate <1e4, -2e4, 3e4> }\n" +
                     rig +
                     "#declare Aphotic_Sled = transform { Aphotic_Sled }\n"
                     "#declare Aphotic_Soft_Edge = 2;\n"
                     "Aphotic_Cone (<0.5, 0, 0>, z, 60, 0.25, \"flash\", 1)\n"
                     "Aphotic_Seafloor (2, 0, 0, \"light\")\nAphotic_End ()\nAphotic_End ()\n"));
}

// One that is added wants an entry above. Each entry provokes one of its own but for seven: too
// wide and too narrow share theirs, so do intensity and power, three beams of a wrong form, glass
// too thin and too near, and a lamp in a shell with a shell round a lamp; of water in a container
// POV-Ray itself complains. The frame of another version is below.
TEST(AphoticIncErrors, AreAllProvoked) {
    const std::string_view text = include_library().front().text;
    std::size_t errors = 0;
    for (auto at = text.find("#error"); at != std::string_view::npos;
         at = text.find("#error", at + 1)) {
        ++errors;
    }
    EXPECT_EQ(errors, misuses().size() - 7 + 1);
}

TEST_F(AphoticInc, RefusesAFrameOfAnotherVersion) {
    std::string sdl = in_band(odd_band(), "camera { location 0 }\n");
    const std::string version = fmt::format("Aphotic_Band_Version = {}", kBandVersion);
    sdl.replace(sdl.find(version), version.size(), "Aphotic_Band_Version = 99");
    EXPECT_TRUE(has(run(sdl).said(), "the frame was written for 99"));
}

}  // namespace
}  // namespace aphotic::aphotic_inc_test
