// SPDX-License-Identifier: BSD-3-Clause
//
// The veil that POV-Ray's scattering media make against the quadrature of light/veil.h, whose own
// tests hold it against closed forms: at every pixel and wavelength, of the veil alone.
#include "image/output_images.h"
#include "light/veil.h"
#include "spectral/integrator.h"
#include "support/random_camera.h"
#include "support/rendered.h"
#include "support/veil_rig.h"

#include <Eigen/Geometry>

#include <numbers>

namespace aphotic::povray_veil_test {
namespace {

// The half floats of the frames, 4.9e-4, and the samples: under 2e-4 at 100 a ray.
constexpr double kMethodTwo = 1e-3;
constexpr int kSamples = 100;
// Of POV-Ray's single precision, in a sum of lobes that cancel.
constexpr double kHalfFloat = 6e-4;

const PhaseFunction kForward{.name = "forward", .kind = HenyeyGreenstein{.g = 0.924}};

Rig in_water(Rig rig, const PhaseFunction& phase = kForward) {
    return with_particles(std::move(rig), phase);
}

// Half of the intensity at 40 degrees off the axis.
Rig with_smooth_beams(Rig rig) {
    const double exponent = std::log(0.5) / std::log(std::cos(40.0 * std::numbers::pi / 180.0));
    for (Strobe& strobe : rig.strobes) {
        strobe.beam.cones = {{.part = "fwhm",
                              .half_angle_rad = 0.5 * std::numbers::pi,
                              .weight = 1.0,
                              .exponent = exponent}};
    }
    return rig;
}

// In whose shell there is a point light.
Rig with_tables(Rig rig) {
    BeamTable table{
        .angles = TableAngles::TypeC, .vertical_rad = {}, .horizontal_rad = {0.0}, .intensity = {}};
    constexpr int kRows = 19;
    for (int k = 0; k < kRows; ++k) {
        table.vertical_rad.push_back(0.5 * std::numbers::pi * k / (kRows - 1));
        table.intensity.push_back(std::pow(std::max(0.0, std::cos(table.vertical_rad.back())), 2));
    }
    for (Strobe& strobe : rig.strobes) {
        strobe.beam.cones.clear();
        strobe.beam.pattern = table;
        strobe.beam = scaled_to_flux(strobe.beam);
    }
    return rig;
}

SceneSet veil_set(const Rig& rig, int samples) {
    PlanRequest request;
    request.wavelengths_nm = {450.0, 550.0, 650.0};
    request.scene.veil_samples = samples;
    return make_scene_set(rig, plan_render(rig, request));
}

// The frames of the veil added up, by wavelength and pixel.
std::vector<std::vector<double>> veil_in(const std::filesystem::path& folder,
                                         const Manifest& manifest) {
    const auto pixels =
        static_cast<std::size_t>(manifest.width_px) * static_cast<std::size_t>(manifest.height_px);
    std::vector<std::vector<double>> veil;
    for (const PlannedWavelength& w : manifest.wavelengths) {
        std::vector<double>& sum = veil.emplace_back(pixels);
        for (std::size_t m = 0; m < w.veil->scattering_per_m.size(); ++m) {
            const std::size_t frame = (1 + m) * manifest.direct_frames() + w.frame;
            ExrReader reader(image_path(folder, manifest.frames[frame]));
            const std::vector<float> samples =
                reader.planes(std::vector<std::string>{std::string(kChannelNames[w.channel])});
            const double sign = w.veil->scattering_per_m[m] < 0.0 ? -1.0 : 1.0;
            for (std::size_t i = 0; i < pixels; ++i)
                sum[i] += std::ldexp(sign * samples[i], -w.veil->exposure_log2);
        }
    }
    return veil;
}

std::vector<std::vector<double>> rendered_veil(const SceneSet& set) {
    const TempFolder folder;
    const RenderResult result =
        render(find_povray(""), folder.path(), set, {.jobs = 2, .report = {}});
    return veil_in(folder.path(), result.manifest);
}

struct Difference {
    double worst = 0.0;
    double mean = 0.0;  // with its sign
};

Difference against_quadrature(const Rig& rig, const SceneSet& set) {
    const std::vector<std::vector<double>> found = rendered_veil(set);
    const Veil veil(rig);
    Difference difference;
    std::size_t compared = 0;
    for (std::size_t j = 0; j < found.size(); ++j) {
        const PlannedWavelength& w = set.manifest.wavelengths[j];
        for (int row = 0; row < rig.camera.height_px; ++row) {
            for (int column = 0; column < rig.camera.width_px; ++column) {
                const VeilSight sight = sight_of(rig, column + 0.5, row + 0.5, w.index_nm);
                const double wanted = veil.radiance(sight.ray, sight.length_m, w.lambda_nm);
                const auto at = static_cast<std::size_t>(row * rig.camera.width_px + column);
                const double e = found[j][at] / wanted - 1.0;
                difference.worst = std::max(difference.worst, std::abs(e));
                difference.mean += e;
                ++compared;
            }
        }
    }
    difference.mean /= static_cast<double>(compared);
    return difference;
}

double worst_of(const Rig& rig, int samples = kSamples) {
    return against_quadrature(rig, veil_set(rig, samples)).worst;
}

TEST(PovrayVeil, OfSmoothBeamsIsTheQuadratures) {
    EXPECT_LE(worst_of(with_smooth_beams(in_water(small_habcam(17, 13)))), kMethodTwo);
}

TEST(PovrayVeil, OfTablesIsTheQuadratures) {
    EXPECT_LE(worst_of(with_tables(in_water(small_habcam(17, 13)))), kMethodTwo);
}

// Whose edges cut the rays.
TEST(PovrayVeil, OfConesIsTheQuadratures) {
    EXPECT_LE(worst_of(in_water(small_habcam(17, 13))), kMethodTwo);
}

// Whose air the camera stays in, whatever cuts the rays; the third lamp's cones cross its housing.
TEST(PovrayVeil, BehindPortsIsTheQuadratures) {
    for (const PortKind kind : kPortKinds) {
        Rig rig = in_water(small_habcam(9, 7));
        rig.strobes[2].position_m = {0.02, 0.03, -0.6};
        rig.strobes[2].axis = {0.0, 0.0, 1.0};
        Dice dice(17);
        give_port(kind, dice, rig.camera);
        EXPECT_LE(worst_of(rig), kMethodTwo) << static_cast<int>(kind);
    }
}

// Where rays end in the dark, piece by piece.
TEST(PovrayVeil, TowardOpenWaterIsOffByNoMoreThanIsSaid) {
    Rig rig = with_smooth_beams(in_water(small_habcam(9, 7)));
    rig.sled.pitch_rad = 82.0 * std::numbers::pi / 180.0;
    rig.sled.altitude_m = 10.0;
    ASSERT_TRUE(std::isinf(sight_of(rig, 4.5, 0.5, 550.0).length_m));
    const SceneSet set = veil_set(rig, kSamples);
    const double said = set.manifest.veil->povray->error;
    EXPECT_LE(said, 3e-3);
    EXPECT_LE(against_quadrature(rig, set).worst, said + kHalfFloat);
}

TEST(PovrayVeil, IsOffByTheSecondOrderOfItsSamples) {
    constexpr double kOrder = 4.0;
    constexpr double kNearly = 0.15;  // the half floats' rounding, in the mean
    const Rig rig = with_smooth_beams(in_water(small_habcam(17, 13)));
    const double coarse = against_quadrature(rig, veil_set(rig, 10)).mean;
    const double fine = against_quadrature(rig, veil_set(rig, 20)).mean;
    EXPECT_NEAR(coarse / fine, kOrder, kNearly * kOrder) << coarse << " " << fine;
}

// In the sea's water, whose lobes cancel in part.
TEST(PovrayVeil, OfFournierAndForandIsOffByNoMoreThanIsSaid) {
    Rig rig = with_smooth_beams(in_water(small_habcam(17, 13), fournier_forand(0.0183)));
    rig.water.scatterers.push_back(
        {line("sea", 0.006, 0.0006), {.name = "molecular", .kind = MolecularScattering{}}});
    const SceneSet set = veil_set(rig, kSamples);
    const double said = set.manifest.veil->povray->error;
    EXPECT_LE(said, 3e-3);
    EXPECT_LE(against_quadrature(rig, set).worst, said + kHalfFloat);
}

// Each in one way that leaves a plausible picture.
TEST(PovrayVeil, IsToldFromOneThatIsSpoilt) {
    const Rig rig = with_smooth_beams(in_water(small_habcam(17, 13)));
    const std::vector<std::pair<std::string, std::string>> spoilt{
        {"rgb Aphotic_Scattering * Aphotic_Unit / 4  ecc",
         "rgb Aphotic_Scattering * Aphotic_Unit  ecc"},
        {"eccentricity Aphotic_Eccentricity  extinction 0", "eccentricity Aphotic_Eccentricity"},
        {"eccentricity Aphotic_Eccentricity", "eccentricity -Aphotic_Eccentricity"},
        {"media_attenuation on", "media_attenuation off"},
        {"method 2  intervals 1", "method 3  intervals 1"},
        {"#local Widest = 89.99943;", "#local Widest = 90;"}};
    for (const auto& [from, to] : spoilt) {
        SceneSet set = veil_set(rig, kSamples);
        for (FrameScene& scene : set.scenes) {
            if (scene.name.starts_with("veil_"))
                scene.sdl = replaced(with_library(scene.sdl), from, to);
        }
        EXPECT_GT(against_quadrature(rig, set).worst, 3.0 * kMethodTwo) << to;
    }
}

// A ball before the only lamp. Its shadow is a cone about the way from the lamp to its centre, from
// where that way touches it on, of which a ray cuts out one stretch: the veil lacks what the
// quadrature finds there.
TEST(PovrayVeil, HasShadows) {
    // The ends of the stretch lie anywhere between two samples.
    constexpr double kShadowEdge = 1.5 / kSamples;
    Rig rig = with_smooth_beams(in_water(small_habcam(17, 13)));
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    const Eigen::Vector3d lamp_m = rig.strobes.front().position_m;
    // Half way to what the middle of the image shows at 1.2 m, and out of sight.
    const Eigen::Vector3d shaded_m(0.0, 0.0, 1.2);
    const Sphere ball{.centre_m = lamp_m + 0.3 * (shaded_m - lamp_m), .radius_m = 0.06};
    rig.objects.push_back({.name = "ball",
                           .shape = ball,
                           .reflectance = Spectrum("grey", {300.0, 900.0}, {0.4, 0.4})});
    const SceneSet set = veil_set(rig, kSamples);
    const std::vector<std::vector<double>> found = rendered_veil(set);

    const Veil veil(rig);
    const Eigen::Vector3d to_ball = ball.centre_m - lamp_m;
    const double reach_m = to_ball.norm();
    const double half_angle_rad = std::asin(ball.radius_m / reach_m);
    const double cos2 = std::pow(std::cos(half_angle_rad), 2);
    const Eigen::Vector3d axis = to_ball / reach_m;
    double deepest = 0.0;
    int shaded = 0;
    for (std::size_t j = 0; j < found.size(); ++j) {
        const double nm = set.manifest.wavelengths[j].lambda_nm;
        for (int row = 0; row < rig.camera.height_px; ++row) {
            for (int column = 0; column < rig.camera.width_px; ++column) {
                const VeilSight sight = sight_of(rig, column + 0.5, row + 0.5, nm);
                const Eigen::Vector3d& u = sight.ray.direction;
                const Eigen::Vector3d a = sight.ray.origin_m - lamp_m;
                const auto up_to = [&](double length_m) {
                    return veil.radiance(sight.ray, length_m, nm);
                };
                const double lit = up_to(sight.length_m);
                // (axis . (a + t u))^2 = cos^2 |a + t u|^2
                const double A = std::pow(axis.dot(u), 2) - cos2;
                const double B = axis.dot(a) * axis.dot(u) - cos2 * a.dot(u);
                const double C = std::pow(axis.dot(a), 2) - cos2 * a.squaredNorm();
                std::vector<double> ends_m{0.0, sight.length_m};
                if (const double root2 = B * B - A * C; root2 > 0.0) {
                    for (const double root : {-std::sqrt(root2), std::sqrt(root2)})
                        ends_m.push_back(std::clamp((-B + root) / A, 0.0, sight.length_m));
                }
                std::ranges::sort(ends_m);
                double lost = 0.0;
                for (std::size_t k = 0; k + 1 < ends_m.size(); ++k) {
                    const Eigen::Vector3d middle = a + 0.5 * (ends_m[k] + ends_m[k + 1]) * u;
                    if (axis.dot(middle) > middle.norm() * std::cos(half_angle_rad))
                        lost += up_to(ends_m[k + 1]) - up_to(ends_m[k]);
                }
                const auto at = static_cast<std::size_t>(row * rig.camera.width_px + column);
                ASSERT_NEAR(found[j][at] / lit, 1.0 - lost / lit, kShadowEdge)
                    << nm << " nm, column " << column << ", row " << row;
                deepest = std::max(deepest, lost / lit);
                if (lost > 0.0) ++shaded;
            }
        }
    }
    EXPECT_GT(deepest, 0.1) << "a shadow that counts";
    EXPECT_GT(shaded, 3);
}

// The image is the direct light and the veil, with weights of its own.
TEST(PovrayVeil, AddsUpToTheImageOfTheQuadrature) {
    const Rig rig = with_smooth_beams(in_water(small_habcam(17, 13), fournier_forand(0.0183)));
    PlanRequest request;
    const auto image_of = [&](const TempFolder& folder) {
        const SceneSet set = make_scene_set(rig, plan_render(rig, request));
        const RenderResult result =
            render(find_povray(""), folder.path(), set, {.jobs = 2, .report = {}});
        integrate(folder.path(), result.manifest);
        return std::pair(
            ExrReader(folder.path() / "image.exr").planes(std::vector<std::string>{"R", "G", "B"}),
            result.manifest);
    };
    const TempFolder by_quadrature;
    const auto [wanted, plain] = image_of(by_quadrature);
    request.scene.veil_samples = kSamples;
    const TempFolder by_povray;
    const auto [found, manifest] = image_of(by_povray);
    EXPECT_FALSE(std::filesystem::exists(veil_path(by_povray.path())));
    for (std::size_t i = 0; i < found.size(); ++i) {
        const std::size_t c = i / (found.size() / kChannels);
        EXPECT_NEAR(found[i] / wanted[i], 1.0, manifest.promise(c) + plain.promise(c));
    }
}

}  // namespace
}  // namespace aphotic::povray_veil_test
