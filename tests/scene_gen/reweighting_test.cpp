// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/reweighting.h"

#include "base/error.h"
#include "scene_gen/scene_set.h"
#include "spectral/curve_loader.h"
#include "support/has.h"
#include "support/refusal.h"
#include "support/scene_rig.h"
#include "tests/support/closed_form.h"
#include "tests/support/simpson.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::reweighting_test {
namespace {

constexpr unsigned kSeed = 20240615;
constexpr double kTolerance = 1e-3;
// Between the paths on which a fitter judges itself an error may peak this much higher.
constexpr double kBetweenPaths = 0.02;
// Of Simpson's rule with kPanels between knots, and of the grid that a fitter compares with.
constexpr int kPanels = 4;
constexpr double kQuadrature = 1e-8;

Spectrum flash(const char* name) {
    return load_curve(name, CurveRole::LampSpectrum, {});
}

Spectrum material(const char* name) {
    return load_curve(name, CurveRole::Reflectance, {});
}

// Three bells, of a width at half height of 70 nm, that count photons.
Sensor bells() {
    const auto bell = [](double peak_nm) {
        std::vector<double> lambda_nm;
        std::vector<double> values;
        for (double nm = 390.0; nm <= 730.0; nm += 5.0) {
            lambda_nm.push_back(nm);
            values.push_back(std::exp(-0.5 * std::pow((nm - peak_nm) / 30.0, 2.0)));
        }
        return Spectrum("bell", lambda_nm, values);
    };
    return {{bell(610.0), bell(540.0), bell(460.0)}, ResponseKind::Quantum};
}

Manifest manifest_of(const Rig& rig, const PlanRequest& request = {}) {
    return make_scene_set(rig, plan_render(rig, request)).manifest;
}

// HabCam's own frames: three wavelengths.
const Manifest& habcams() {
    static const Manifest kManifest = manifest_of(habcam());
    return kManifest;
}

using Change = std::function<void(Rig&)>;

Rig changed(Rig rig, const Change& change) {
    change(rig);
    return rig;
}

double promise_of(const Manifest& manifest) {
    double worst = 0.0;
    for (std::size_t c = 0; c < kChannels; ++c) worst = std::max(worst, manifest.promise(c));
    return worst;
}

std::string error_of(const Rig& rig, const Manifest& manifest, double tolerance = kTolerance) {
    return refusal_of([&] { static_cast<void>(reintegrate(rig, manifest, tolerance)); });
}

// --- Integrals of the test's own ------------------------------------------------------- --------

double integral(const Rig& rig, const std::function<double(double)>& f) {
    double sum = 0.0;
    for (const SimpsonNode& node : simpson_nodes(rig, kPanels)) sum += node.weight_nm * f(node.nm);
    return sum;
}

double attenuation_per_m(const Water& water, double nm) {
    const double absorbed_per_m =
        water.multiple > 0.0 ? water.multiple * water.absorption_per_m.at(nm) : 0.0;
    return absorbed_per_m + water.uniform_loss_per_m;
}

// Index 0 is the floor's own reflectance.
double reflectance_of(const Rig& rig, std::size_t index, double nm) {
    return (index == 0 ? rig.seafloor.reflectance : rig.materials[index - 1]).at(nm);
}

// The signal of a strobe's light by a path over a material, in one channel.
double signal(
    const Rig& rig, std::size_t strobe, std::size_t index, double path_m, std::size_t channel) {
    return integral(rig, [&](double nm) {
        return rig.strobes[strobe].power * rig.strobes[strobe].spectrum.at(nm) *
               reflectance_of(rig, index, nm) *
               std::exp(-attenuation_per_m(rig.water, nm) * path_m) *
               rig.camera.sensor.response(static_cast<int>(channel), nm);
    });
}

// What the weights make of it from the frames, whose light is that of the rig they show.
double from_frames(const Manifest& weights,
                   const Rig& shown,
                   std::size_t strobe,
                   std::size_t index,
                   double path_m,
                   std::size_t channel) {
    double sum = 0.0;
    for (const PlannedWavelength& w : weights.wavelengths) {
        sum += w.weight[channel] * shown.strobes[strobe].power *
               shown.strobes[strobe].spectrum.at(w.lambda_nm) *
               reflectance_of(shown, index, w.lambda_nm) *
               std::exp(-attenuation_per_m(shown.water, w.lambda_nm) * path_m);
    }
    return sum;
}

// Random members of the family: strobes, materials and paths that the image has.
void expect_error_kept(const Rig& now,
                       const Rig& shown,
                       const Manifest& weights,
                       const std::string& what) {
    constexpr int kMembers = 12;
    std::mt19937_64 random(kSeed);
    const PathRange paths = path_range(now);
    std::uniform_real_distribution<double> path(paths.shortest_m, paths.longest_m);
    std::uniform_int_distribution<std::size_t> strobe(0, now.strobes.size() - 1);
    std::uniform_int_distribution<std::size_t> index(0, now.materials.size());
    for (int i = 0; i < kMembers; ++i) {
        const std::size_t s = strobe(random);
        const std::size_t m = index(random);
        const double path_m = i == 0 ? paths.shortest_m : i == 1 ? paths.longest_m : path(random);
        for (std::size_t c = 0; c < kChannels; ++c) {
            const double right = signal(now, s, m, path_m, c);
            const double found = from_frames(weights, shown, s, m, path_m, c);
            EXPECT_NEAR(
                found / right, 1.0, weights.quality[c].error * (1.0 + kBetweenPaths) + kQuadrature)
                << what << ": strobe " << s << ", material " << m << ", path " << path_m
                << " m, channel " << kChannelNames[c];
        }
    }
}

// --- What frames can be the image of --------------------------------------------------- --------

TEST(Reintegrate, KeepsItsPromiseForOtherWatersLampsFloorsAndSensors) {
    struct Case {
        std::string what;
        Change change;
    };
    for (const Case& each : std::vector<Case>{
             {"half the absorption", [](Rig& rig) { rig.water.multiple = 0.5; }},
             {"no absorption", [](Rig& rig) { rig.water.multiple = 0.0; }},
             {"other pure water",
              [](Rig& rig) {
                  rig.water.absorption_per_m =
                      load_curve("pure-2016", CurveRole::WaterAbsorption, {});
              }},
             {"another lamp",
              [](Rig& rig) {
                  for (Strobe& strobe : rig.strobes) strobe.spectrum = flash("xenon-arc");
              }},
             {"three times the power",
              [](Rig& rig) {
                  for (Strobe& strobe : rig.strobes) strobe.power = 3.0;
              }},
             {"another floor", [](Rig& rig) { rig.seafloor.reflectance = material("red-algae"); }},
             {"another sensor", [](Rig& rig) { rig.camera.sensor = bells(); }},
             {"colour matching",
              [](Rig& rig) {
                  rig.camera.sensor = Sensor(load_curves("cie-1931", CurveRole::ColourMatching, {}),
                                             ResponseKind::Energy);
              }},
             {"another range",
              [](Rig& rig) {
                  rig.camera.range = {420.0, 680.0};
              }},
             {"all at once", [](Rig& rig) {
                  rig.water.multiple = 0.8;
                  rig.seafloor.reflectance = material("green-algae");
                  rig.camera.sensor = bells();
                  for (Strobe& strobe : rig.strobes) strobe.spectrum = flash("xenon-arc");
              }}}) {
        const Rig now = changed(habcam(), each.change);
        ASSERT_EQ(error_of(now, habcams()), "nothing was said") << each.what;
        const Manifest weights = reintegrate(now, habcams(), kTolerance);
        EXPECT_LE(promise_of(weights), kTolerance) << each.what;
        expect_error_kept(now, habcam(), weights, each.what);
    }
}

// Three wavelengths of HabCam's water cannot be that of twice the absorption to 1e-3, whatever
// their weights; to 2e-3 they can, and twelve to 1e-3.
TEST(Reintegrate, BearsTwiceTheAbsorption) {
    const Rig now = changed(habcam(), [](Rig& rig) { rig.water.multiple = 2.0; });
    const Manifest loose = reintegrate(now, habcams(), 2e-3);
    EXPECT_LE(promise_of(loose), 2e-3);
    expect_error_kept(now, habcam(), loose, "three wavelengths");

    PlanRequest twelve;
    for (double nm = 420.0; nm < 700.0; nm += 25.0) twelve.wavelengths_nm.push_back(nm);
    const Manifest fine = reintegrate(now, manifest_of(habcam(), twelve), kTolerance);
    EXPECT_LE(promise_of(fine), kTolerance);
    expect_error_kept(now, habcam(), fine, "twelve wavelengths");
}

// Frames of water so dark that they hold no red.
TEST(Reintegrate, GivesNoWeightToFramesThatHoldNothing) {
    Rig dark = habcam();
    dark.water.multiple = 100.0;
    PlanRequest request;
    request.wavelengths_nm = {450.0, 550.0, 650.0};
    const Manifest manifest = make_scene_set(dark, plan_render(dark, request)).manifest;
    const Manifest now = reintegrate(dark, manifest, 0.1);
    for (std::size_t c = 0; c < kChannels; ++c) {
        EXPECT_EQ(now.wavelengths.back().weight[c], 0.0);
        EXPECT_GT(now.quality[c].error, 0.01);
    }
}

TEST(Reintegrate, KeepsItsPromiseForOtherMaterials) {
    Rig shown = habcam();
    shown.materials = {material("green-algae"), material("red-algae")};
    const Manifest manifest = manifest_of(shown);
    for (const auto& [what, change] : std::vector<std::pair<std::string, Change>>{
             {"the same", [](Rig&) {}}, {"another lamp", [](Rig& rig) {
                                             for (Strobe& strobe : rig.strobes)
                                                 strobe.spectrum = flash("xenon-arc");
                                         }}}) {
        const Rig now = changed(shown, change);
        ASSERT_EQ(error_of(now, manifest), "nothing was said") << what;
        expect_error_kept(now, shown, reintegrate(now, manifest, kTolerance), what);
    }
}

// The highlight is of the lamp alone, and the frames hold it beside the floor's light.
TEST(Reintegrate, CountsTheHighlight) {
    Rig shown = habcam();
    shown.seafloor.phong = 0.3;
    const Manifest manifest = manifest_of(shown);
    Rig now = shown;
    now.water.multiple = 0.9;
    const Manifest weights = reintegrate(now, manifest, 2e-3);
    EXPECT_LE(promise_of(weights), 2e-3);
    expect_error_kept(now, shown, weights, "floor");
    // A white floor stands for the lamp alone.
    const auto white = [](Rig rig) {
        rig.seafloor.reflectance = Spectrum("white", {300.0, 900.0}, {1.0, 1.0});
        return rig;
    };
    expect_error_kept(white(now), white(shown), weights, "highlight");
}

// Nothing has changed: as good as the plan, which knows equal strobes as one.
TEST(Reintegrate, OfTheSameRigGivesItsOwnImage) {
    constexpr double kConverged = 0.02;  // of the errors, which are small against the promise
    for (const char* scene : {"habcam.toml", "port.toml"}) {
        const Rig rig = scene_rig(scene);
        const Manifest manifest = manifest_of(rig);
        const Manifest again = reintegrate(rig, manifest, kTolerance);
        EXPECT_NEAR(promise_of(again) / promise_of(manifest), 1.0, kConverged) << scene;
        expect_error_kept(rig, rig, again, scene);
    }
}

// Sum of the strobes' int Phi Q_c dlambda (manifest.h), to the grid's 1e-6 of light under water:
// the bare lamp's, which bends more, comes out to a hundred times that.
TEST(Reintegrate, NotesTheLampsOwnSignal) {
    constexpr double kLampsGrid = 1e-4;
    const Rig now = changed(habcam(), [](Rig& rig) {
        for (Strobe& strobe : rig.strobes) strobe.power = 2.0;
        rig.camera.sensor = bells();
    });
    const auto lamps = [](const Rig& rig, std::size_t channel) {
        return integral(rig, [&](double nm) {
            double flux = 0.0;
            for (const Strobe& s : rig.strobes) flux += s.power * s.spectrum.at(nm);
            return flux * rig.camera.sensor.response(static_cast<int>(channel), nm);
        });
    };
    const Manifest again = reintegrate(habcam(), habcams(), kTolerance);
    const Manifest weights = reintegrate(now, habcams(), kTolerance);
    for (std::size_t c = 0; c < kChannels; ++c) {
        EXPECT_NEAR(habcams().lamp_signal[c] / lamps(habcam(), c), 1.0, kLampsGrid)
            << "of the scenes, channel " << kChannelNames[c];
        EXPECT_NEAR(again.lamp_signal[c] / lamps(habcam(), c), 1.0, kLampsGrid)
            << "of the same rig, channel " << kChannelNames[c];
        EXPECT_NEAR(weights.lamp_signal[c] / lamps(now, c), 1.0, kLampsGrid)
            << "of the changed rig, channel " << kChannelNames[c];
    }
}

TEST(Reintegrate, NamesTheChangedRigAndLeavesTheFramesAlone) {
    Rig now = habcam();
    now.title = "another";
    now.digest = "abc";
    now.water.multiple = 0.5;
    const Manifest weights = reintegrate(now, habcams(), 9e-4);
    EXPECT_EQ(weights.rig_title, "another");
    EXPECT_EQ(weights.rig_sha256, "abc");
    EXPECT_EQ(weights.method, "fitted to frames of another rig");
    EXPECT_EQ(weights.tolerance, 9e-4);
    EXPECT_EQ(weights.frame_error, habcams().frame_error);
    EXPECT_EQ(weights.geometry, habcams().geometry);
    ASSERT_EQ(weights.frames.size(), habcams().frames.size());
    EXPECT_EQ(weights.frames[0].name, habcams().frames[0].name);
    EXPECT_EQ(weights.frames[0].scene_sha256, habcams().frames[0].scene_sha256);
    ASSERT_EQ(weights.wavelengths.size(), habcams().wavelengths.size());
    for (std::size_t j = 0; j < weights.wavelengths.size(); ++j) {
        const PlannedWavelength& found = weights.wavelengths[j];
        const PlannedWavelength& frames = habcams().wavelengths[j];
        EXPECT_EQ(found.lambda_nm, frames.lambda_nm);
        EXPECT_EQ(found.frame, frames.frame);
        EXPECT_EQ(found.channel, frames.channel);
        EXPECT_EQ(found.exposure_log2, frames.exposure_log2);
        EXPECT_EQ(found.light.attenuation_per_m, frames.light.attenuation_per_m);
        EXPECT_EQ(found.light.flux, frames.light.flux);
        EXPECT_EQ(found.light.reflectance, frames.light.reflectance);
        EXPECT_NE(found.weight, frames.weight);
    }
}

// --- Power of one strobe ---------------------------------------------------------------------

// One strobe's light cannot be told from another's in frames that hold their sum: twice its share
// would take weights that double it and not the rest, so the best is off by a third both ways.
TEST(Reintegrate, CannotShiftPowerBetweenStrobes) {
    constexpr double kThird = 1.0 / 3.0;
    const Rig now = changed(habcam(), [](Rig& rig) { rig.strobes[1].power = 2.0; });
    const std::string message = error_of(now, habcams());
    const std::string start = "the frames give this rig's image to ";
    ASSERT_TRUE(message.starts_with(start)) << message;
    EXPECT_NEAR(std::stod(message.substr(start.size())), kThird, 1e-2) << message;
    // Nor can the lamp of one.
    const Rig lamp =
        changed(habcam(), [](Rig& rig) { rig.strobes[1].spectrum = flash("xenon-arc"); });
    EXPECT_TRUE(error_of(lamp, habcams()).starts_with(start));
}

// --- What is lacking ------------------------------------------------------------------- --------

// Wavelengths that the message names, whose frames of the changed rig would keep the tolerance.
std::vector<double> lacking_in(const std::string& message) {
    std::vector<double> lambda_nm;
    const std::size_t at = message.find(" at ", message.find("it lacks "));
    std::string rest = message.substr(at + 4);
    while (!rest.empty()) {
        std::size_t end = 0;
        lambda_nm.push_back(std::stod(rest, &end));
        if (rest.substr(end, 2) != ", ") break;
        rest = rest.substr(end + 2);
    }
    return lambda_nm;
}

TEST(Reintegrate, NamesTheFramesThatItLacks) {
    for (const double multiple : {2.0, 8.0, 20.0}) {
        const Rig now = changed(habcam(), [&](Rig& rig) { rig.water.multiple = multiple; });
        const std::string message = error_of(now, habcams());
        const std::string start = "the frames give this rig's image to ";
        ASSERT_TRUE(message.starts_with(start)) << message;
        EXPECT_GT(std::stod(message.substr(start.size())), kTolerance) << message;
        EXPECT_TRUE(has(message, " only; allowed: 0.001, the tolerance; it lacks "));
        EXPECT_TRUE(message.ends_with(" nm in the changed rig's water and light")) << message;

        // With frames of these, it can.
        const QuadratureFitter fitter(
            now.camera.sensor, light_family_by_strobe(now), now.camera.range);
        std::vector<FrameLight> frames;
        for (const PlannedWavelength& w : habcams().wavelengths) {
            FrameLight frame{.lambda_nm = w.lambda_nm,
                             .attenuation_per_m = w.light.attenuation_per_m,
                             .sources = {},
                             .tilt = 0.0};
            for (const double flux : w.light.flux)
                frame.sources.push_back(flux * w.light.reflectance[0]);
            frames.push_back(frame);
        }
        EXPECT_GT(fitter.fit(frames, kFrameError).promise(kFrameError), kTolerance);
        bool is_one_enough = false;
        for (double nm = 400.0; nm <= 720.0 && !is_one_enough; nm += 8.0) {
            std::vector<FrameLight> and_one = frames;
            and_one.push_back(fitter.frame_at(nm));
            is_one_enough = fitter.fit(and_one, kFrameError).promise(kFrameError) <= kTolerance;
        }
        EXPECT_TRUE(!is_one_enough || lacking_in(message).size() == 1U)
            << "one frame is enough; " << message;
        for (const double nm : lacking_in(message)) frames.push_back(fitter.frame_at(nm));
        EXPECT_LE(fitter.fit(frames, kFrameError).promise(kFrameError), kTolerance) << message;
    }
}

// What is refused at one tolerance is taken at the next.
TEST(Reintegrate, TakesWhatTheToleranceAllows) {
    const Rig now = changed(habcam(), [](Rig& rig) { rig.water.multiple = 20.0; });
    const std::string start = "the frames give this rig's image to ";
    const std::string message = error_of(now, habcams(), kTolerance);
    ASSERT_TRUE(message.starts_with(start)) << message;
    const double least = std::stod(message.substr(start.size()));
    constexpr double kThreeDigits = 0.005;  // to which the message gives it
    const Manifest weights = reintegrate(now, habcams(), least * (1.0 + kThreeDigits));
    EXPECT_NEAR(promise_of(weights) / least, 1.0, kThreeDigits);
    expect_error_kept(now, habcam(), weights, "twenty times the absorption");
}

// --- What the frames are not the image of --------------------------------------------------

TEST(Reintegrate, NamesWhatDiffers) {
    const std::string fore = "strobe 'fore': found ";
    const std::string bk7 = "0.05 m off, 0.012 m of bk7";
    struct Shown {
        Rig rig;
        Manifest frames;
    };
    const auto shown = [](const Rig& rig, const PlanRequest& request = {}) {
        return Shown{rig, manifest_of(rig, request)};
    };
    // How many lamps stand for an emitter is the frames' own affair.
    PlanRequest few_lamps;
    few_lamps.scene.emitter_lamps = LampGrid{.across = 5, .along = 3};
    const Shown own = shown(habcam());
    const Shown dark = shown(changed(habcam(), [](Rig& r) { r.strobes[2].power = 0.0; }));
    const Shown emitter = shown(
        changed(
            habcam(),
            [](Rig& r) { r.strobes[1].emitter = Emitter{.across_m = 0.0635, .along_m = 0.0302}; }),
        few_lamps);
    const Shown port = shown(scene_rig("port.toml"));
    const Shown objects = shown(scene_rig("objects.toml"));
    for (const Shown* each : {&dark, &emitter, &port, &objects}) {
        EXPECT_EQ(error_of(each->rig, each->frames), "nothing was said");
    }
    struct Case {
        const Shown& frames;
        Change change;
        std::string message;  // how it begins
    };
    const std::vector<Case> all{
        {own,
         [](Rig& r) { r.sled.altitude_m = 2.5; },
         "sled.altitude_m: found 2.5; allowed: 2, as the frames were rendered"},
        {own,
         [](Rig& r) { r.sled.pitch_rad = 0.25; },
         "sled.pitch_rad: found 0.25; allowed: 0.08726646259971647, as"},
        {own, [](Rig& r) { r.sled.roll_rad = -0.5; }, "sled.roll_rad: found -0.5; allowed: 0, as"},
        {own,
         [](Rig& r) { r.camera.width_px = 680; },
         "camera.resolution: found 680 1024; allowed: 1360 1024, as"},
        {own,
         [](Rig& r) { r.camera.focal_length_m = 0.013; },
         "camera.focal_length_m: found 0.013; allowed: 0.012, as"},
        {own,
         [](Rig& r) { r.camera.pixel_pitch_m = 7e-6; },
         "camera.pixel_pitch_m: found 7e-06; allowed: 6.45e-06, as"},
        {own, [](Rig& r) { r.seafloor.phong = 0.5; }, "seafloor.phong: found 0.5; allowed: 0, as"},
        {own, [](Rig& r) { r.strobes[0].position_m.x() = 0.5625; }, fore + "at 0.5625 0 0 m"},
        {own,
         [](Rig& r) { r.strobes[0].axis = Eigen::Vector3d::UnitZ(); },
         fore + "at 0.5 0 0 m, axis 0 0 1"},
        {own, [](Rig& r) { r.strobes[0].beam.cones[0].half_angle_rad = 0.125; }, fore},
        {own, [](Rig& r) { r.strobes[0].beam.cones.pop_back(); }, fore},
        {own, [](Rig& r) { r.strobes[0].beam.weights = ConeWeights::Literal; }, fore},
        {own,
         [](Rig& r) { r.strobes.pop_back(); },
         "strobe 'starboard': found none; allowed: at 0 0.5 0 m"},
        {own,
         [](Rig& r) {
             r.strobes.push_back(r.strobes[0]);
             r.strobes.back().name = "fifth";
         },
         "strobe 'fifth': found at 0.5 0 0 m"},
        {own,
         [](Rig& r) { r.materials = {material("red-algae")}; },
         "found 4 strobes and 1 further materials; allowed: 4 and 0, as the frames were rendered"},
        {own,
         [](Rig& r) { std::swap(r.strobes[0], r.strobes[3]); },
         "strobes: found starboard, aft, port, fore; allowed: fore, aft, port, starboard, as"},
        {own,
         [](Rig& r) { r.strobes[2].power = 0.0; },
         "strobe 'port': found power 0; allowed: more, since the frames hold its light"},
        {dark,
         [](Rig& r) { r.strobes[2].power = 1.0; },
         "the frames give this rig's image to 1 only; "},
        {own,
         [&](Rig& r) { r = port.rig; },
         "camera.port: found " + bk7 + "; allowed: none, as the frames were rendered"},
        {port,
         [](Rig& r) { r = habcam(); },
         "camera.port: found none; allowed: " + bk7 + ", as the frames were rendered"},
        {port,
         [](Rig& r) { r.camera.port->distance_m = 0.0625; },
         "camera.port: found 0.0625 m off, 0.012 m of bk7; allowed: " + bk7 + ", as"},
        // The water bends the rays behind a port: there it is geometry.
        {port,
         [](Rig& r) { r.water.salinity_psu = 7.0; },
         "water.salinity_psu: found 7; allowed: 35, as"},
        {port,
         [](Rig& r) { r.water.temperature_c = 20.0; },
         "water.temperature_c: found 20; allowed: 10, as"},
        {objects, [](Rig& r) { std::swap(r.objects[0], r.objects[1]); }, "objects: found "},
        {emitter,
         [](Rig& r) { r.strobes[1].emitter->across_m = 0.125; },
         "strobe 'aft' emitter: found 0.125 x 0.0302 m; allowed: 0.0635 x 0.0302 m, as"},
        {emitter,
         [](Rig& r) { r.strobes[1].emitter.reset(); },
         "strobe 'aft' emitter: found none; allowed: 0.0635 x 0.0302 m, as"}};
    for (const Case& each : all) {
        const std::string found =
            error_of(changed(each.frames.rig, each.change), each.frames.frames);
        EXPECT_TRUE(found.starts_with(each.message)) << found << "\nwanted " << each.message;
    }
}

// --- Pixel by pixel -------------------------------------------------------------------- --------

// The frames' own error included, no pixel is off by more than the promise.
void expect_promise_kept(const Rig& now,
                         const Rig& shown,
                         const Manifest& weights,
                         const std::string& what) {
    constexpr int kPixels = 40;
    constexpr double kEdgeRad = 0.02;  // how far a port may move a floor point, seen from a lamp
    std::mt19937_64 random(kSeed);
    std::uniform_int_distribution<int> columns(0, now.camera.width_px - 1);
    std::uniform_int_distribution<int> rows(0, now.camera.height_px - 1);
    std::array<double, kChannels> worst{};
    int looked_at = 0;
    for (int i = 0; i < kPixels; ++i) {
        const int column = i == 0 ? 0 : columns(random);
        const int row = i == 0 ? 0 : rows(random);
        if (closed_form::radiance(now, column, row, 550.0).edge_rad < kEdgeRad) continue;
        ++looked_at;
        for (std::size_t c = 0; c < kChannels; ++c) {
            const double right = integral(now, [&](double nm) {
                return closed_form::radiance(now, column, row, nm).radiance *
                       now.camera.sensor.response(static_cast<int>(c), nm);
            });
            double found = 0.0;
            for (const PlannedWavelength& w : weights.wavelengths) {
                const Rig frozen = frozen_at(shown, w.lambda_nm);
                found +=
                    w.weight[c] * closed_form::radiance(frozen, column, row, w.index_nm).radiance;
            }
            worst[c] = std::max(worst[c], std::abs(found / right - 1.0));
        }
    }
    EXPECT_GT(looked_at, kPixels / 4);
    for (std::size_t c = 0; c < kChannels; ++c) {
        const double from_frames = weights.quality[c].amplification * weights.frame_error;
        EXPECT_LE(worst[c] + from_frames, weights.promise(c) * (1.0 + kBetweenPaths))
            << what << ": channel " << kChannelNames[c] << " errs by " << worst[c] << " of "
            << weights.quality[c].error;
    }
}

TEST(Reintegrate, KeepsItsPromiseOnPixelsBehindAPort) {
    const Rig shown = scene_rig("port.toml");
    PlanRequest request;
    request.wavelengths_nm = {420.0, 460.0, 500.0, 540.0, 580.0, 620.0, 660.0, 700.0};
    const Manifest manifest = manifest_of(shown, request);
    const Rig now = changed(shown, [](Rig& rig) { rig.water.multiple = 0.8; });
    expect_promise_kept(now, shown, reintegrate(now, manifest, 3e-3), "0.8 of the absorption");
}

// Frames of wavelengths that the changed rig's range does not take in serve it all the same, and
// have the rays of their own.
TEST(Reintegrate, KeepsItsPromiseOnPixelsForANarrowerRangeBehindAPort) {
    Rig shown = scene_rig("port.toml");
    shown.camera.focal_length_m = 0.006;
    PlanRequest request;
    request.wavelengths_nm = {420.0, 480.0};
    const Manifest manifest = manifest_of(shown, request);
    const Rig now = changed(shown, [](Rig& rig) { rig.camera.range = {520.0, 560.0}; });
    expect_promise_kept(now, shown, reintegrate(now, manifest, 0.05), "520 to 560 nm");
}

}  // namespace
}  // namespace aphotic::reweighting_test
