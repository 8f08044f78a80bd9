// SPDX-License-Identifier: BSD-3-Clause
#include "rig/geometry_signature.h"

#include "rig/geometry.h"
#include "spectral/curve_loader.h"
#include "support/scene_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::geometry_signature_test {
namespace {

Spectrum flash(const char* name) {
    return load_curve(name, CurveRole::LampSpectrum, {});
}

Spectrum material(const char* name) {
    return load_curve(name, CurveRole::Reflectance, {});
}

using Change = std::function<void(Rig&)>;

Rig changed(Rig rig, const Change& change) {
    change(rig);
    return rig;
}

TEST(GeometrySignature, KnowsOnlyWhatMovesLight) {
    const auto before = geometry_signature(habcam());
    EXPECT_EQ(geometry_signature(habcam()), before);
    for (const Change& change : std::vector<Change>{
             [](Rig& rig) { rig.title = "another"; },
             [](Rig& rig) { rig.digest = "another"; },
             [](Rig& rig) { rig.mounting.position_m.z() = 3.0; },
             [](Rig& rig) { rig.mounting.altitude_is = AltitudeIs::Plumb; },
             [](Rig& rig) { rig.water.multiple = 3.0; },
             [](Rig& rig) { rig.water.uniform_loss_per_m = 3.0; },
             [](Rig& rig) { rig.water.salinity_psu = 3.0; },
             [](Rig& rig) { rig.water.temperature_c = 3.0; },
             [](Rig& rig) { rig.seafloor.reflectance = material("red-algae"); },
             [](Rig& rig) { rig.seafloor.phong_size = 3.0; },
             [](Rig& rig) { rig.materials = {material("red-algae")}; },
             [](Rig& rig) { rig.strobes[0].power = 3.0; },
             [](Rig& rig) { rig.strobes[0].spectrum = flash("xenon-arc"); },
             [](Rig& rig) { rig.strobes[0].beam.name = "another"; },
             [](Rig& rig) { rig.strobes[0].beam.cones[0].part = "another"; },
             [](Rig& rig) {
                 rig.camera.sensor = Sensor(load_curves("cie-1931", CurveRole::ColourMatching, {}),
                                            ResponseKind::Energy);
             },
             [](Rig& rig) {
                 rig.camera.range = {450.0, 650.0};
             }}) {
        EXPECT_EQ(geometry_signature(changed(habcam(), change)), before);
    }
}

TEST(GeometrySignature, KnowsObjectsByShapeAndGlossAndNotByColour) {
    const Rig rig = scene_rig("objects.toml");
    const auto before = geometry_signature(rig);
    EXPECT_EQ(geometry_signature(
                  changed(rig, [](Rig& r) { r.objects[0].reflectance = material("red-algae"); })),
              before);
    for (const Change& change : std::vector<Change>{
             [](Rig& r) { std::get<Mesh>(r.objects[0].shape).vertices_m[7].x() += 1e-6; },
             [](Rig& r) {
                 std::swap(std::get<Mesh>(r.objects[0].shape).triangles[0][0],
                           std::get<Mesh>(r.objects[0].shape).triangles[9][1]);
             },
             [](Rig& r) { std::get<Sphere>(r.objects[1].shape).radius_m += 1e-9; },
             [](Rig& r) { std::get<Box>(r.objects[2].shape).most_m.z() += 1e-9; },
             [](Rig& r) { r.objects[1].phong_size += 1.0; },
             [](Rig& r) { r.objects.pop_back(); }}) {
        EXPECT_NE(geometry_signature(changed(rig, change)), before);
    }
}

// A cone's intensity in either way of writing it.
TEST(GeometrySignature, KnowsBeamsByTheirLight) {
    Rig literal = habcam();
    for (Strobe& strobe : literal.strobes) {
        for (Cone& cone : strobe.beam.cones) {
            const double sine = std::sin(cone.half_angle_rad);
            cone.weight /= std::numbers::pi * sine * sine;
        }
        strobe.beam.weights = ConeWeights::Literal;
    }
    EXPECT_EQ(geometry_signature(literal), geometry_signature(habcam()));
}

TEST(GeometrySignature, KnowsWhatMovesLight) {
    const auto before = geometry_signature(scene_rig("port.toml"));
    EXPECT_NE(before, geometry_signature(habcam()));
    for (const Change& change :
         std::vector<Change>{[](Rig& rig) { rig.sled.altitude_m += 1e-9; },
                             [](Rig& rig) { rig.sled.pitch_rad += 1e-9; },
                             [](Rig& rig) { rig.sled.roll_rad += 1e-9; },
                             [](Rig& rig) { rig.camera.width_px += 1; },
                             [](Rig& rig) { rig.camera.height_px += 1; },
                             [](Rig& rig) { rig.camera.pixel_pitch_m *= 1.0 + 1e-9; },
                             [](Rig& rig) { rig.camera.focal_length_m *= 1.0 + 1e-9; },
                             [](Rig& rig) { rig.camera.port->distance_m += 1e-9; },
                             [](Rig& rig) { rig.camera.port->thickness_m += 1e-9; },
                             [](Rig& rig) { rig.camera.port->glass = builtin_glass("sapphire"); },
                             [](Rig& rig) { rig.camera.port.reset(); },
                             [](Rig& rig) { rig.water.salinity_psu += 1e-9; },
                             [](Rig& rig) { rig.water.temperature_c += 1e-9; },
                             [](Rig& rig) { rig.seafloor.phong += 1e-9; },
                             [](Rig& rig) { rig.strobes[3].name = "another"; },
                             [](Rig& rig) { rig.strobes[3].position_m.z() += 1e-9; },
                             [](Rig& rig) { rig.strobes[3].axis.x() += 1e-9; },
                             [](Rig& rig) { rig.strobes[3].beam.cones[2].weight += 1e-9; },
                             [](Rig& rig) { rig.strobes[3].beam.cones[2].half_angle_rad -= 1e-9; },
                             [](Rig& rig) { rig.strobes[3].emitter = Emitter{}; },
                             [](Rig& rig) { std::swap(rig.strobes[0], rig.strobes[3]); },
                             [](Rig& rig) { rig.strobes.pop_back(); }}) {
        EXPECT_NE(geometry_signature(changed(scene_rig("port.toml"), change)), before);
    }
    Rig glossy = habcam();
    glossy.seafloor.phong = 0.5;
    const auto gloss = geometry_signature(glossy);
    glossy.seafloor.phong_size += 1e-9;
    EXPECT_NE(geometry_signature(glossy), gloss) << "where there is a highlight its size counts";
}

}  // namespace
}  // namespace aphotic::geometry_signature_test
