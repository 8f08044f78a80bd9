// SPDX-License-Identifier: BSD-3-Clause
//
// Beams of every kind through real POV-Ray, against the closed form of the physics at every pixel:
// two strobes without any symmetry over a tilted floor.
#include "base/error.h"
#include "support/refusal.h"
#include "support/rendered.h"

namespace aphotic::beams_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const std::vector<double> kWavelengthsNm{450.0, 550.0, 650.0};
constexpr BeamWindow kWindow{.glass_index = 1.52, .water_index = 1.34};

std::vector<double> radians(std::vector<double> degrees) {
    for (double& angle : degrees) angle *= kDegree;
    return degrees;
}

// Intensities without any symmetry, of 0.2 to 1.
BeamTable table(TableAngles angles, std::vector<double> vertical, std::vector<double> horizontal) {
    BeamTable made{.angles = angles,
                   .vertical_rad = radians(std::move(vertical)),
                   .horizontal_rad = radians(std::move(horizontal)),
                   .intensity = {}};
    const bool closes = angles == TableAngles::TypeC && made.horizontal_rad.size() > 1;
    for (std::size_t h = 0; h < made.horizontal_rad.size(); ++h) {
        for (std::size_t v = 0; v < made.vertical_rad.size(); ++v) {
            const std::size_t plane = closes && h + 1 == made.horizontal_rad.size() ? 0 : h;
            const bool is_pole = angles == TableAngles::TypeC && made.vertical_rad[v] == 0.0;
            const double mixed = is_pole ? 3.0 : static_cast<double>((7 * plane + 5 * v + 3) % 11);
            made.intensity.push_back(0.2 + 0.08 * mixed);
        }
    }
    return made;
}

Beam beam_of(BeamPattern pattern, double turn_deg = 0.0) {
    return scaled_to_flux({.name = "made",
                           .weights = ConeWeights::Flux,
                           .cones = {},
                           .pattern = std::move(pattern),
                           .per_flux = 1.0,
                           .turn_rad = turn_deg * kDegree,
                           .window = {}});
}

Beam soft_cones() {
    return {.name = "soft",
            .weights = ConeWeights::Flux,
            .cones = {{.part = "narrow",
                       .half_angle_rad = 25.0 * kDegree,
                       .weight = 0.4,
                       .exponent = 8.0,
                       .edge_rad = 25.0 * kDegree},
                      {.part = "wide",
                       .half_angle_rad = 70.0 * kDegree,
                       .weight = 0.5,
                       .exponent = 1.0,
                       .edge_rad = 30.0 * kDegree},
                      {.part = "all", .half_angle_rad = 90.0 * kDegree, .weight = 0.1}}};
}

// Where cosines are 0, and their powers 0^0.
Beam extreme_cones() {
    const auto cone = [](double half_angle_deg, double exponent, double edge_deg) {
        return Cone{.part = "part",
                    .half_angle_rad = half_angle_deg * kDegree,
                    .weight = 0.3,
                    .exponent = exponent,
                    .edge_rad = edge_deg * kDegree};
    };
    return {.name = "extreme",
            .weights = ConeWeights::Flux,
            .cones = {cone(90.0, 0.0, 13.949023469432351),
                      cone(90.0, 0.0, 90.0),
                      cone(90.0, 1000.0, 90.0),
                      cone(90.0, 1e-300, 1e-9)}};
}

Beam behind_window(Beam beam) {
    beam.window = kWindow;
    return beam;
}

const std::vector<double> kUneven{0, 3, 10, 14, 25, 41, 60, 90};
Beam all_about() {
    return beam_of(table(TableAngles::TypeC, kUneven, {0, 20, 90, 135, 180, 250, 360}), 33.0);
}
Beam rectangle(TableAngles angles) {
    return beam_of(table(angles, {-37, -20, -4, 11, 30, 44}, {-60, -31, -5, 2, 19, 38, 51}), -12.0);
}

// The source paper's diffuser behind a lens.
Beam optics(double distance_m) {
    return beam_of(BeamOptics{.along_m = 0.0302,
                              .across_m = 0.0635,
                              .focal_length_m = 0.065,
                              .distance_m = distance_m,
                              .aperture_m = 0.07},
                   20.0);
}

Rig lit_by(const Beam& beam) {
    Rig rig = small_habcam();
    rig.sled = {.altitude_m = 1.7, .pitch_rad = 11.0 * kDegree, .roll_rad = -17.0 * kDegree};
    rig.strobes.erase(rig.strobes.begin() + 2, rig.strobes.end());
    rig.strobes[0].position_m = {0.62, 0.21, -0.13};
    rig.strobes[0].axis = Eigen::Vector3d(-0.21, 0.17, 0.93).normalized();
    rig.strobes[1].position_m = {-0.33, 0.44, 0.18};
    rig.strobes[1].axis = Eigen::Vector3d(0.12, -0.31, 0.85).normalized();
    rig.strobes[1].power = 0.37;
    for (Strobe& strobe : rig.strobes) strobe.beam = beam;
    return rig;
}

struct Kind {
    const char* name;
    Beam (*make)();
};
void PrintTo(const Kind& kind, std::ostream* out) {
    *out << kind.name;
}

const std::vector<Kind> kKinds{
    {"ExtremeCones", extreme_cones},
    {"SoftCones", soft_cones},
    {"ConesBehindAWindow", [] { return behind_window(soft_cones()); }},
    {"RoundTable", [] { return beam_of(table(TableAngles::TypeC, kUneven, {0})); }},
    {"TypeC", all_about},
    {"TypeCBehindAWindow", [] { return behind_window(all_about()); }},
    {"TypeA", [] { return rectangle(TableAngles::TypeA); }},
    {"TypeB", [] { return rectangle(TableAngles::TypeB); }},
    {"TypeBBehindAWindow", [] { return behind_window(rectangle(TableAngles::TypeB)); }},
    {"Optics", [] { return optics(0.05); }},
    {"OpticsBehindAWindow", [] { return behind_window(optics(0.05)); }},
    {"SharpOptics", [] { return optics(0.065); }},
};

class Beams : public testing::TestWithParam<Kind> {};

TEST_P(Beams, EveryPixelHasItsRadiance) {
    const Rig rig = lit_by(GetParam().make());
    const Difference found = against_closed_form(rig, scenes_of(rig, kWavelengthsNm));
    EXPECT_LE(found.worst, kHalfFloatError) << testing::PrintToString(found);
    EXPECT_EQ(found.on_edges, 0) << testing::PrintToString(found);
    EXPECT_LT(found.brightest_sample, std::exp2(kTargetLog2 + 1));
    // Something shines, and in no even light.
    EXPECT_GT(found.brightest_sample, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Beams, testing::ValuesIn(kKinds), [](const auto& kind) {
    return std::string(kind.param.name);
});

// POV-Ray takes what is filtered below a share of the light for full shadow.
TEST(Beams, DimDirectionsAreLit) {
    constexpr double kDim = 1e-8;
    const Rig rig = lit_by(beam_of(BeamTable{.angles = TableAngles::TypeC,
                                             .vertical_rad = radians({0, 5, 10, 90}),
                                             .horizontal_rad = {0},
                                             .intensity = {1.0, 1.0, kDim, kDim}}));
    const Difference found = against_closed_form(rig, scenes_of(rig, {450.0}));
    EXPECT_LE(found.worst, kHalfFloatError) << testing::PrintToString(found);
    EXPECT_LT(found.darkest_sample, 10.0 * kDim * found.brightest_sample);
    EXPECT_GT(found.darkest_sample, 0.0);
}

TEST(Beams, ShineBehindAPortToo) {
    Rig rig = lit_by(all_about());
    rig.camera.port = {.distance_m = 0.042, .thickness_m = 0.009, .glass = builtin_glass("bk7")};
    const Difference found = against_closed_form(rig, scenes_of(rig, kWavelengthsNm));
    EXPECT_LE(found.worst, kHalfFloatError) << testing::PrintToString(found);
}

// Each of an emitter's lamps has its shell, as close to the next as a centimetre.
TEST(Beams, EmittersAreTheirGridsOfLamps) {
    Rig rig = lit_by(all_about());
    for (Strobe& strobe : rig.strobes) strobe.emitter = {.across_m = 0.03, .along_m = 0.02};
    const SceneOptions options{.wavelengths_per_frame = 3,
                               .emitter_lamps = LampGrid{.across = 3, .along = 2}};
    const Difference found =
        against_closed_form(rig, scenes_of(rig, {470.0, 610.0}, options), 3, 2);
    EXPECT_LE(found.worst, kHalfFloatError) << testing::PrintToString(found);
}

// A strobe half a millimetre beside the way from another to what a pixel shows: a shell of a
// thousandth of a metre would stand in its way.
TEST(Beams, ShellsShadowNoPixel) {
    Rig rig = lit_by(all_about());
    const closed_form::Ray ray = closed_form::camera_ray(rig, 30, 20, kWavelengthsNm[0]);
    const closed_form::Vector down = closed_form::world_down(rig.sled);
    const double r = rig.sled.altitude_m * down[2] / closed_form::dot(ray.direction, down);
    const Eigen::Vector3d floor_m =
        r * Eigen::Vector3d(ray.direction[0], ray.direction[1], ray.direction[2]);
    rig.strobes[1].position_m =
        0.5 * (rig.strobes[0].position_m + floor_m) + Eigen::Vector3d(0.0005, 0.0, 0.0);
    const SceneSet set = scenes_of(rig, kWavelengthsNm);
    const Difference found = against_closed_form(rig, set);
    EXPECT_LE(found.worst, kHalfFloatError) << testing::PrintToString(found);
    SceneSet in_metres = set;
    for (FrameScene& scene : in_metres.scenes) {
        scene.sdl = replaced(scene.sdl, "#declare Aphotic_Unit = 0.0078125;\n", "");
    }
    const Difference shadowed = against_closed_form(rig, in_metres);
    EXPECT_GT(shadowed.worst, 0.05);
    EXPECT_EQ(shadowed.column, 30);
    EXPECT_EQ(shadowed.row, 20);
}

TEST(Beams, LampsInOnePlaceAreRefused) {
    Rig rig = lit_by(all_about());
    rig.strobes[1].position_m = rig.strobes[0].position_m;
    EXPECT_EQ(refusal_of([&] { static_cast<void>(scenes_of(rig, kWavelengthsNm)); }),
              "strobes 'fore' and 'aft' have lamps in one place, and the beam 'made' is not a "
              "sum of cones in water; allowed: lamps at least a micrometre apart");
}

}  // namespace
}  // namespace aphotic::beams_test
