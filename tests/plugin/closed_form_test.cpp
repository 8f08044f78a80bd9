// SPDX-License-Identifier: BSD-3-Clause
//
// What POV-Ray really renders, against the closed form of the physics, per pixel and wavelength.
#include "support/rendered.h"

namespace aphotic::closed_form_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// Blue, green, red, and the dark red end, where water takes nearly everything.
const std::vector<double> kWavelengthsNm{450.0, 550.0, 650.0, 720.0};

struct Scene {
    const char* name;
    std::function<void(Rig&)> change;
};

void PrintTo(const Scene& scene, std::ostream* out) {
    *out << scene.name;
}

void keep_strobes(Rig& rig, std::ptrdiff_t count) {
    rig.strobes.erase(rig.strobes.begin() + count, rig.strobes.end());
}

void keep_cone(Rig& rig, const std::string& part) {
    for (Strobe& strobe : rig.strobes) {
        std::erase_if(strobe.beam.cones, [&](const Cone& cone) { return cone.part != part; });
    }
}

void use_literal_weights(Rig& rig) {
    for (Strobe& strobe : rig.strobes) strobe.beam.weights = ConeWeights::Literal;
}

// Nothing in it is mirrored: a swapped axis or sign moves the light.
void make_asymmetric(Rig& rig) {
    rig.sled = {.altitude_m = 1.7, .pitch_rad = 11.0 * kDegree, .roll_rad = -17.0 * kDegree};
    keep_strobes(rig, 2);
    rig.strobes[0].position_m = {0.62, 0.21, -0.13};
    rig.strobes[0].axis = Eigen::Vector3d(-0.21, 0.17, 0.93).normalized();
    rig.strobes[1].position_m = {-0.33, 0.44, 0.18};
    rig.strobes[1].axis = Eigen::Vector3d(0.12, -0.31, 0.85).normalized();
    rig.strobes[1].power = 0.37;
}

void give_port(Rig& rig) {
    rig.camera.port = {.distance_m = 0.042, .thickness_m = 0.009, .glass = builtin_glass("bk7")};
}

const std::vector<Scene> kScenes{
    {"HabCam", [](Rig&) {}},
    {"OneLamp", [](Rig& rig) { keep_strobes(rig, 1); }},
    {"CollimatedAlone", [](Rig& rig) { keep_cone(rig, "collimated"); }},
    {"FocusedAlone", [](Rig& rig) { keep_cone(rig, "focused"); }},
    {"DiffuseAlone", [](Rig& rig) { keep_cone(rig, "diffuse"); }},
    {"LiteralWeights", use_literal_weights},
    {"Exponents",
     [](Rig& rig) {
         make_asymmetric(rig);
         for (Strobe& strobe : rig.strobes) {
             strobe.beam.cones[0].exponent = 20.0;
             strobe.beam.cones[1].exponent = 0.0;
             strobe.beam.cones[2].exponent = 2.5;
         }
     }},
    {"Air", [](Rig& rig) { rig.water.multiple = 0.0; }},
    {"HalfAbsorption", [](Rig& rig) { rig.water.multiple = 0.5; }},
    {"TenTimesAbsorption", [](Rig& rig) { rig.water.multiple = 10.0; }},
    {"UniformLoss", [](Rig& rig) { rig.water.uniform_loss_per_m = 0.4; }},
    {"LossInAir",
     [](Rig& rig) {
         rig.water.multiple = 0.0;
         rig.water.uniform_loss_per_m = 0.4;
     }},
    {"FourMetres", [](Rig& rig) { rig.sled.altitude_m = 4.0; }},
    {"Asymmetric", make_asymmetric},
    {"Highlight",
     [](Rig& rig) {
         make_asymmetric(rig);
         rig.seafloor.phong = 0.3;
         rig.seafloor.phong_size = 25.0;
     }},
    {"Port", give_port},
    {"AsymmetricPort",
     [](Rig& rig) {
         make_asymmetric(rig);
         give_port(rig);
     }},
    {"PortInAir",
     [](Rig& rig) {
         give_port(rig);
         rig.water.multiple = 0.0;
     }},
    {"HorizonInView",
     [](Rig& rig) {
         rig.sled = {.altitude_m = 10.0, .pitch_rad = 78.0 * kDegree, .roll_rad = 0.0};
     }},
    {"FaintLamp",
     [](Rig& rig) {
         for (Strobe& strobe : rig.strobes) strobe.power = 1e-13;
     }},
    {"StrongLamp",
     [](Rig& rig) {
         for (Strobe& strobe : rig.strobes) strobe.power = 1e12;
     }},
};

class ClosedForm : public testing::TestWithParam<Scene> {};

TEST_P(ClosedForm, EveryPixelHasItsRadiance) {
    Rig rig = small_habcam();
    GetParam().change(rig);
    const Difference found = against_closed_form(rig, scenes_of(rig, kWavelengthsNm));
    EXPECT_LE(found.worst, kHalfFloatError) << testing::PrintToString(found);
    // A pixel's centre on an edge is a coincidence, not a habit.
    EXPECT_LE(found.on_edges, 4 * 4) << testing::PrintToString(found);
    EXPECT_LT(found.brightest_sample, std::exp2(kTargetLog2 + 1));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ClosedForm, testing::ValuesIn(kScenes), [](const auto& scene) {
    return std::string(scene.param.name);
});

TEST(ClosedForm, EmitterIsItsGridOfLamps) {
    constexpr int kAcross = 3;
    constexpr int kAlong = 2;
    Rig rig = small_habcam();
    make_asymmetric(rig);
    for (Strobe& strobe : rig.strobes) strobe.emitter = {.across_m = 0.0635, .along_m = 0.0302};
    const SceneOptions options{.wavelengths_per_frame = 3,
                               .emitter_lamps = LampGrid{.across = kAcross, .along = kAlong}};
    const Difference found =
        against_closed_form(rig, scenes_of(rig, {470.0, 610.0}, options), kAcross, kAlong);
    EXPECT_LE(found.worst, kHalfFloatError) << testing::PrintToString(found);
}

TEST(ClosedForm, StrobesMayHaveLampsOfTheirOwn) {
    Rig rig = small_habcam();
    make_asymmetric(rig);
    rig.strobes[1].spectrum = load_curve("xenon-arc", CurveRole::LampSpectrum, {});
    const Difference found = against_closed_form(rig, scenes_of(rig, {425.0, 475.0, 655.0}));
    EXPECT_LE(found.worst, kHalfFloatError) << testing::PrintToString(found);
}

// At 4 m the light of 720 nm is 1e-4 of what it is in blue: in one exposure for all, it would sit
// among the coarse denormals of a half float, or the blue would saturate.
TEST(ClosedForm, DarkRedKeepsItsDigits) {
    Rig rig = small_habcam();
    rig.sled.altitude_m = 4.0;
    rig.water.multiple = 2.0;
    const Difference found = against_closed_form(rig, scenes_of(rig, {450.0, 720.0}));
    EXPECT_LE(found.worst_of_lit, kHalfFloatError) << testing::PrintToString(found);
    EXPECT_GT(found.darkest_sample, kSmallestNormalHalf);
    const double blue = closed_form::radiance(rig, 30, 20, 450.0).radiance;
    const double red = closed_form::radiance(rig, 30, 20, 720.0).radiance;
    EXPECT_LT(red / blue, 1e-6) << "the case is not as dark as it claims";
}

}  // namespace
}  // namespace aphotic::closed_form_test
