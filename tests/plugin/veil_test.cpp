// SPDX-License-Identifier: BSD-3-Clause
//
// Water that scatters through real POV-Ray, with the veil that we add, against the reference at
// every pixel: its losses, phase functions and quadrature are its own.
#include "image/output_images.h"
#include "spectral/integrator.h"
#include "spectral/phase_function.h"
#include "support/random_camera.h"
#include "support/rendered.h"
#include "support/veil_rig.h"
#include "validation/tracer.h"

#include <numbers>

namespace aphotic::veil_test {
namespace {

// The half float's rounding of the floor's light, and what the veil is off by beside it.
constexpr double kOfTheSum = 6e-4;
constexpr double kMiddle_nm = 550.0;

Rig in_water(Rig rig, const PhaseFunction& phase) {
    rig = with_particles(std::move(rig), phase);
    rig.water.scatterers.push_back(sea());
    return rig;
}

struct Found {
    double worst = 0.0;
    double most_veil = 0.0;  // as a share of the sum
};

// R, G, B and one plane; a trace without its veil tells how much of it there is.
Found against_the_reference(const Rig& rig) {
    const TempFolder folder;
    const SceneSet set = make_scene_set(rig, plan_render(rig, {}));
    const RenderResult result =
        render(find_povray(""), folder.path(), set, {.jobs = 1, .report = {}});
    integrate(folder.path(), result.manifest);
    ExrReader image(folder.path() / "image.exr");
    const std::vector<float> found = image.planes(std::vector<std::string>{"R", "G", "B"});
    ExrReader planes(veil_path(folder.path()));
    const std::vector<float> veil = planes.planes(std::vector<std::string>{"R", "G", "B"});
    const Tracer tracer(rig, {.signals = true, .planes_nm = {}, .threads = 2});
    const std::vector<double> traced = tracer.rows(0, rig.camera.height_px);
    const std::vector<unsigned char> on_edge = tracer.on_edges(rig.camera.range);
    Found worst;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (on_edge[i % on_edge.size()] != 0) continue;
        worst.worst = std::max(worst.worst, std::abs(found[i] / traced[i] - 1.0));
        worst.most_veil = std::max(worst.most_veil, static_cast<double>(veil[i]) / traced[i]);
    }
    return worst;
}

void expect_agreement(const Rig& rig) {
    const Found found = against_the_reference(rig);
    EXPECT_LE(found.worst, kOfTheSum);
    EXPECT_GT(found.most_veil, 0.05);
}

TEST(Veil, OfConesIsTheReferences) {
    expect_agreement(in_water(small_habcam(34, 26), fournier_forand(0.0183)));
}

TEST(Veil, OfSmoothBeamsIsTheReferences) {
    Rig rig =
        in_water(small_habcam(34, 26), {.name = "forward", .kind = HenyeyGreenstein{.g = 0.924}});
    // Cosines to the fourth, whose edge is at 90 degrees and 0.
    for (Strobe& strobe : rig.strobes) {
        strobe.beam.cones = {{.part = "all",
                              .half_angle_rad = 0.5 * std::numbers::pi,
                              .weight = 1.0,
                              .exponent = 4.0}};
    }
    expect_agreement(rig);
}

// The veil ends where they stand, as a frame of fog tells.
TEST(Veil, BeforeObjectsIsTheReferences) {
    Rig rig = in_water(small_habcam(34, 26), fournier_forand(0.0183));
    const Spectrum grey("grey", {300.0, 900.0}, {0.4, 0.4});
    rig.objects.push_back({.name = "ball",
                           .shape = Sphere{.centre_m = {0.3, 0.2, 1.2}, .radius_m = 0.25},
                           .reflectance = grey});
    rig.objects.push_back({.name = "far ball",
                           .shape = Sphere{.centre_m = {-0.4, -0.2, 1.7}, .radius_m = 0.2},
                           .reflectance = grey});
    expect_agreement(rig);
}

// Each wavelength by its own ray.
TEST(Veil, BehindAPortIsTheReferences) {
    Rig rig = in_water(small_habcam(34, 26), fournier_forand(0.0183));
    Dice dice(17);
    give_port(kPortKinds.front(), dice, rig.camera);
    expect_agreement(rig);
}

}  // namespace
}  // namespace aphotic::veil_test
