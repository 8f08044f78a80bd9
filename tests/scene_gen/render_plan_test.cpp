// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/render_plan.h"

#include "light/dispersion.h"
#include "support/random_rig.h"

#include "base/error.h"
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
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::render_plan_test {
namespace {

constexpr unsigned kSeed = 20240614;
constexpr double kDegree = std::numbers::pi / 180.0;
// Between the paths on which a fitter judges itself an error may peak this much higher.
constexpr double kBetweenPaths = 0.02;
// Of Simpson's rule with kPanels between knots, and of the grid that a fitter compares with.
constexpr int kPanels = 4;
constexpr double kQuadrature = 1e-8;

std::vector<double> wavelengths_of(const RenderPlan& plan) {
    std::vector<double> lambda_nm;
    for (const PlannedWavelength& w : plan.wavelengths) lambda_nm.push_back(w.lambda_nm);
    return lambda_nm;
}

std::string error_of(const Rig& rig, const PlanRequest& request) {
    return refusal_of([&] { static_cast<void>(plan_render(rig, request)); });
}

// Wavelengths increase and lie in the range; the frames hold each of them once, in their order.
void expect_order(const Rig& rig, const RenderPlan& plan) {
    const std::vector<double> lambda_nm = wavelengths_of(plan);
    for (std::size_t j = 0; j < lambda_nm.size(); ++j) {
        EXPECT_TRUE(rig.camera.range.contains(lambda_nm[j])) << lambda_nm[j];
        if (j == 0) continue;
        EXPECT_LT(lambda_nm[j - 1], lambda_nm[j]);
    }
    std::size_t frame = 0;
    std::size_t channel = 0;
    for (const PlannedWavelength& w : plan.wavelengths) {
        if (w.frame != frame) {
            EXPECT_EQ(w.frame, frame + 1);
            frame = w.frame;
            channel = 0;
        }
        EXPECT_EQ(w.channel, channel++);
        EXPECT_LT(w.channel, static_cast<std::size_t>(plan.scene.wavelengths_per_frame));
    }
    EXPECT_EQ(plan.frames(), frame + 1);
}

// --- Frames ------------------------------------------------------------------------------------

std::vector<double> even(double first_nm, double last_nm, int count) {
    std::vector<double> lambda_nm;
    for (int i = 0; i < count; ++i) {
        lambda_nm.push_back(std::lerp(first_nm, last_nm, i / (count - 1.0)));
    }
    return lambda_nm;
}

using Counts = std::vector<std::size_t>;

// The wavelengths in each frame.
Counts counts_of(const std::vector<PlannedWavelength>& wavelengths) {
    Counts counts;
    for (const PlannedWavelength& w : wavelengths) {
        counts.resize(w.frame + 1);
        EXPECT_EQ(w.channel, counts.back()++);
    }
    return counts;
}

TEST(InFrames, EveryThreeShareWithoutAPort) {
    const auto counts = [](int wavelengths, int per_frame, double bound) {
        return counts_of(in_frames(
            habcam(),
            even(400.0, 720.0, wavelengths),
            {.wavelengths_per_frame = per_frame, .pixel_shift = bound, .emitter_lamps = {}}));
    };
    EXPECT_EQ(counts(8, 3, kPixelShift), (Counts{3, 3, 2}));
    EXPECT_EQ(counts(8, 3, 0.0), (Counts{3, 3, 2}));
    EXPECT_EQ(counts(5, 2, 0.0), (Counts{2, 2, 1}));
    EXPECT_EQ(counts(3, 1, 9.0), (Counts{1, 1, 1}));
}

// All at random: the frames follow each other and hold every wavelength once; none is larger or
// spread farther than allowed, and none ends before it must.
TEST(InFrames, FramesAreAsLargeAsTheyMayBe) {
    constexpr unsigned kSeedOfFrames = 20240612;
    constexpr double kRounding = 1e-10;  // a few of a wavelength in nm
    std::mt19937_64 random(kSeedOfFrames);
    const auto between = [&](double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(random);
    };
    Rig rig = scene_rig("port.toml");
    int shared = 0;
    int parted_by_bound = 0;
    for (int n = 0; n < 200; ++n) {
        rig.sled.altitude_m = between(0.5, 5.0);
        rig.camera.focal_length_m = between(0.008, 0.03);
        std::vector<double> lambda_nm;
        for (double nm = between(400.0, 420.0); nm < 720.0; nm += between(0.1, 30.0)) {
            lambda_nm.push_back(nm);
        }
        const int per_frame = 1 + n % 3;
        const double bound = between(0.0, 1.0);
        const auto wavelengths = in_frames(
            rig,
            lambda_nm,
            {.wavelengths_per_frame = per_frame, .pixel_shift = bound, .emitter_lamps = {}});
        ASSERT_EQ(wavelengths.size(), lambda_nm.size());
        std::size_t next = 0;
        for (const std::size_t count : counts_of(wavelengths)) {
            ASSERT_GE(count, 1U);
            ASSERT_LE(count, static_cast<std::size_t>(per_frame));
            const std::size_t first = next;
            next += count;
            ASSERT_LE(next, lambda_nm.size());
            const double first_nm = lambda_nm[first];
            const double last_nm = lambda_nm[next - 1];
            EXPECT_LE(corner_shift_px(rig, first_nm, last_nm), bound)
                << first_nm << " to " << last_nm << " nm";
            for (std::size_t j = first; j < next; ++j) {
                EXPECT_EQ(wavelengths[j].lambda_nm, lambda_nm[j]);
                EXPECT_NEAR(wavelengths[j].index_nm, 0.5 * (first_nm + last_nm), kRounding);
            }
            shared += count > 1 ? 1 : 0;
            if (next == lambda_nm.size() || count == static_cast<std::size_t>(per_frame)) {
                continue;
            }
            ++parted_by_bound;
            EXPECT_GT(corner_shift_px(rig, first_nm, lambda_nm[next]), bound)
                << "the frame from " << first_nm << " nm ends before " << lambda_nm[next] << " nm";
        }
        EXPECT_EQ(next, lambda_nm.size());
    }
    EXPECT_GT(shared, 100);
    EXPECT_GT(parted_by_bound, 100);
}

// --- The promise, pixel by pixel ------------------------------------------------------- --------

struct Pixel {
    int column, row;
};

using Signals = std::array<double, kChannels>;

Signals exact_signals(const Rig& rig, Pixel pixel, int panels) {
    Signals signals{};
    for (const auto& [nm, weight] : simpson_nodes(rig, panels)) {
        const double L = closed_form::radiance(rig, pixel.column, pixel.row, nm).radiance;
        for (int c = 0; c < kChannels; ++c) {
            signals[static_cast<std::size_t>(c)] += weight * L * rig.camera.sensor.response(c, nm);
        }
    }
    return signals;
}

class PlannedSignals {
  public:
    PlannedSignals(const Rig& rig, const RenderPlan& plan) : wavelengths_(plan.wavelengths) {
        for (const PlannedWavelength& w : wavelengths_) {
            rigs_.push_back(frozen_at(rig, w.lambda_nm));
        }
    }

    [[nodiscard]] Signals at(Pixel pixel) const {
        Signals signals{};
        for (std::size_t j = 0; j < rigs_.size(); ++j) {
            const PlannedWavelength& w = wavelengths_[j];
            const double L =
                closed_form::radiance(rigs_[j], pixel.column, pixel.row, w.index_nm).radiance;
            for (std::size_t c = 0; c < kChannels; ++c) signals[c] += w.weight[c] * L;
        }
        return signals;
    }

  private:
    std::vector<PlannedWavelength> wavelengths_;
    std::vector<Rig> rigs_;
};

// The worst relative error of pixels off the cones' edges, by channel, and where.
struct Worst {
    Signals error{};
    std::array<Pixel, kChannels> pixel{};
    int pixels = 0;
};

Pixel brightest_pixel(const Rig& rig) {
    constexpr int kStep = 32;
    Pixel brightest{};
    double most = 0.0;
    for (int row = 0; row < rig.camera.height_px; row += kStep) {
        for (int column = 0; column < rig.camera.width_px; column += kStep) {
            const double L = closed_form::radiance(rig, column, row, 550.0).radiance;
            if (L > most) brightest = {.column = column, .row = row};
            most = std::max(most, L);
        }
    }
    return brightest;
}

// Half of them anywhere, half near the brightest, and two corners.
std::vector<Pixel> some_pixels(const Rig& rig, int count) {
    constexpr double kNear = 60.0;
    std::mt19937_64 random(kSeed);
    const int width = rig.camera.width_px;
    const int height = rig.camera.height_px;
    std::uniform_int_distribution<int> column(0, width - 1);
    std::uniform_int_distribution<int> row(0, height - 1);
    std::normal_distribution<double> aside(0.0, kNear);
    const auto brightest = brightest_pixel(rig);
    std::vector<Pixel> pixels{{.column = 0, .row = 0}, {.column = width - 1, .row = height - 1}};
    for (int i = 2; i < count; ++i) {
        const auto beside = [&](int middle, int end) {
            return std::clamp(middle + static_cast<int>(aside(random)), 0, end - 1);
        };
        if (i % 2 == 0) {
            pixels.push_back({.column = column(random), .row = row(random)});
        } else {
            pixels.push_back(
                {.column = beside(brightest.column, width), .row = beside(brightest.row, height)});
        }
    }
    return pixels;
}

Worst worst_pixels(const Rig& rig, const RenderPlan& plan, int pixels) {
    // How far another wavelength's ray may move a floor point, seen from a lamp.
    const double edge_rad = rig.camera.port ? 0.02 : 1e-6;
    const PlannedSignals planned(rig, plan);
    Worst worst;
    for (const Pixel pixel : some_pixels(rig, pixels)) {
        const auto middle = closed_form::radiance(rig, pixel.column, pixel.row, 550.0);
        if (middle.radiance == 0.0 || middle.edge_rad < edge_rad) continue;
        ++worst.pixels;
        const Signals exact = exact_signals(rig, pixel, kPanels);
        const Signals found = planned.at(pixel);
        for (std::size_t c = 0; c < kChannels; ++c) {
            const double error = std::abs(found[c] / exact[c] - 1.0);
            if (!(error > worst.error[c])) continue;
            worst.error[c] = error;
            worst.pixel[c] = pixel;
        }
    }
    return worst;
}

void expect_promise_kept(const Rig& rig,
                         const RenderPlan& plan,
                         int pixels,
                         const std::string& what) {
    const Worst worst = worst_pixels(rig, plan, pixels);
    EXPECT_GT(worst.pixels, pixels / 3) << what;
    for (std::size_t c = 0; c < kChannels; ++c) {
        EXPECT_LE(worst.error[c], plan.quality[c].error * (1.0 + kBetweenPaths) + kQuadrature)
            << what << ": channel " << kChannelNames[c] << ", column " << worst.pixel[c].column
            << ", row " << worst.pixel[c].row << "; " << plan.wavelengths.size()
            << " wavelengths in " << plan.frames() << " frames";
    }
}

// --- HabCam ---------------------------------------------------------------------------- --------

// The goal of the whole: one frame, with an error of under 1e-5.
TEST(RenderPlan, OfHabCamIsOneFrameOfThreeWavelengths) {
    const RenderPlan plan = plan_render(habcam(), {});
    EXPECT_EQ(plan.method, PlanMethod::Fitted);
    EXPECT_EQ(plan.tolerance, 1e-3);
    ASSERT_EQ(plan.frames(), 1U);
    EXPECT_EQ(plan.wavelengths.size(), 3U);
    EXPECT_LT(plan.error(), 1e-5);
    EXPECT_LT(plan.promise(), 1e-3);
    EXPECT_GE(plan.promise(), kFrameError) << "no image is better than its frames";
    EXPECT_EQ(plan.frame_error, kFrameError);
    expect_order(habcam(), plan);
}

TEST(RenderPlan, OfHabCamKeepsItsErrorOnPixels) {
    expect_promise_kept(habcam(), plan_render(habcam(), {}), 40, "HabCam");
}

TEST(RenderPlan, KeepsItsErrorOnPixelsOfRandomRigs) {
    std::mt19937_64 random(kSeed);
    const auto between = [&](double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(random);
    };
    for (int n = 0; n < 4; ++n) {
        Rig rig = habcam();
        rig.sled = {.altitude_m = between(1.0, 4.0),
                    .pitch_rad = between(-0.4, 0.4),
                    .roll_rad = between(-0.4, 0.4)};
        rig.water.multiple = between(0.0, 3.0);
        rig.water.uniform_loss_per_m = between(0.0, 0.3);
        if (n % 2 == 0) rig.seafloor.phong = between(0.0, 0.5);
        rig.strobes[1].spectrum = load_curve("xenon-arc", CurveRole::LampSpectrum, {});
        for (Strobe& strobe : rig.strobes) {
            strobe.power = between(0.1, 3.0);
            strobe.position_m.z() = between(-0.5, 0.5);
        }
        expect_promise_kept(rig, plan_render(rig, {}), 12, "rig " + std::to_string(n));
    }
}

TEST(RenderPlan, IsTheSameEveryTime) {
    for (const char* scene : {"habcam.toml", "port.toml"}) {
        const RenderPlan first = plan_render(scene_rig(scene), {});
        const RenderPlan second = plan_render(scene_rig(scene), {});
        EXPECT_EQ(wavelengths_of(first), wavelengths_of(second)) << scene;
        for (std::size_t j = 0; j < first.wavelengths.size(); ++j) {
            EXPECT_EQ(first.wavelengths[j].weight, second.wavelengths[j].weight);
        }
        EXPECT_EQ(first.promise(), second.promise());
    }
}

TEST(RenderPlan, SaysWhatIsLeftOut) {
    Rig rig = habcam();
    rig.strobes[0].power = 0.0;
    const std::vector<Omission> left_out = plan_render(rig, {}).omissions;
    ASSERT_EQ(left_out.size(), 3U);
    EXPECT_EQ(left_out[0].what, "a port");
    EXPECT_EQ(left_out[1].what, "the floor's highlight");
    EXPECT_EQ(left_out[2].what, "strobe 'fore'");
}

// Where the emitter's lamps stand for it the frame errs by their number, too.
TEST(RenderPlan, CountsTheErrorOfAnEmittersLamps) {
    Rig rig = habcam();
    EXPECT_EQ(frame_error(rig), kFrameError);
    rig.strobes[3].emitter = Emitter{.across_m = 0.0635, .along_m = 0.0302};
    EXPECT_EQ(frame_error(rig), kFrameError + kLampError);
    const RenderPlan plan = plan_render(rig, {});
    EXPECT_EQ(plan.frame_error, kFrameError + kLampError);
    EXPECT_GE(plan.promise(), kFrameError + kLampError);
    EXPECT_EQ(plan.frames(), 1U);
}

// --- Equal bands, listed wavelengths --------------------------------------------------- --------

// docs/background/physics.md has 36 bands err by 1.3e-3 over 4 m; the weights are widths times
// responses.
TEST(RenderPlan, OfEqualBandsIsTheMidpointRule) {
    PlanRequest request;
    request.bands = 36;
    const Rig rig = habcam();
    const RenderPlan plan = plan_render(rig, request);
    EXPECT_EQ(plan.method, PlanMethod::EqualBands);
    ASSERT_EQ(plan.wavelengths.size(), 36U);
    EXPECT_EQ(plan.frames(), 12U);
    constexpr double kWidthNm = 320.0 / 36.0;
    for (std::size_t j = 0; j < 36; ++j) {
        const PlannedWavelength& w = plan.wavelengths[j];
        EXPECT_NEAR(w.lambda_nm, 400.0 + (static_cast<double>(j) + 0.5) * kWidthNm, 1e-9);
        for (int c = 0; c < kChannels; ++c) {
            EXPECT_NEAR(w.weight[static_cast<std::size_t>(c)],
                        kWidthNm * rig.camera.sensor.response(c, w.lambda_nm),
                        1e-12);
        }
    }
    EXPECT_NEAR(plan.error(), 1.3e-3, 2e-4);
    EXPECT_GT(plan.error(), 50.0 * plan_render(rig, {}).error());
    expect_order(rig, plan);
    expect_promise_kept(rig, plan, 10, "36 bands");
}

// What the bands' error is stated to be is what it is: the worst pixel comes near it.
TEST(RenderPlan, StatesTheErrorOfEqualBandsClosely) {
    PlanRequest request;
    for (const int bands : {9, 18}) {
        request.bands = bands;
        const RenderPlan plan = plan_render(habcam(), request);
        const Worst worst = worst_pixels(habcam(), plan, 20);
        for (std::size_t c = 0; c < kChannels; ++c) {
            EXPECT_GE(worst.error[c], 0.9 * plan.quality[c].error)
                << bands << " bands, channel " << kChannelNames[c];
        }
    }
}

TEST(RenderPlan, KeepsListedWavelengths) {
    PlanRequest request;
    request.wavelengths_nm = {478.0, 576.0, 638.0};
    const RenderPlan plan = plan_render(habcam(), request);
    EXPECT_EQ(plan.method, PlanMethod::Listed);
    EXPECT_EQ(wavelengths_of(plan), request.wavelengths_nm);
    EXPECT_EQ(plan.frames(), 1U);
    expect_promise_kept(habcam(), plan, 20, "listed");
    // Better ones are not known than those that were looked for.
    EXPECT_GT(plan.error(), plan_render(habcam(), {}).error());

    request.wavelengths_nm = {450.0, 500.0, 550.0, 600.0, 650.0};
    const RenderPlan five = plan_render(habcam(), request);
    EXPECT_EQ(wavelengths_of(five), request.wavelengths_nm);
    ASSERT_EQ(five.frames(), 2U);
    EXPECT_EQ(five.wavelengths[2].frame, 0U);
    EXPECT_EQ(five.wavelengths[3].frame, 1U);
}

// However bad, they are what was asked for, and the promise says so.
TEST(RenderPlan, TakesListedWavelengthsThatCannotKeepATolerance) {
    PlanRequest request;
    request.wavelengths_nm = {550.0};
    const RenderPlan plan = plan_render(habcam(), request);
    EXPECT_GT(plan.promise(), 1e-2);
    EXPECT_EQ(plan.frames(), 1U);
}

TEST(RenderPlan, RefusesListedWavelengthsOutOfOrderOrRange) {
    PlanRequest request;
    request.wavelengths_nm = {550.0, 500.0};
    EXPECT_EQ(error_of(habcam(), request),
              "wavelengths: found 500 nm at position 2; allowed: increasing wavelengths from 400 "
              "to 720 nm");
    request.wavelengths_nm = {390.0, 500.0};
    EXPECT_EQ(error_of(habcam(), request),
              "wavelengths: found 390 nm at position 1; allowed: increasing wavelengths from 400 "
              "to 720 nm");
}

// --- Paths, materials, water ----------------------------------------------------------- --------

PlanRequest over_paths(double tolerance) {
    PlanRequest request;
    request.paths = PathRange{.shortest_m = 2.0, .longest_m = 16.0};
    request.tolerance = tolerance;
    return request;
}

TEST(RenderPlan, IsForThePathsThatAreAskedFor) {
    const Rig rig = habcam();
    const RenderPlan plan = plan_render(rig, over_paths(1e-3));
    EXPECT_EQ(plan.family.shortest_path_m, 2.0);
    EXPECT_EQ(plan.family.longest_path_m, 16.0);
    EXPECT_EQ(plan.wavelengths.size(), 6U) << "three are not enough over 14 m";
    EXPECT_EQ(plan.frames(), 2U);
    EXPECT_LT(plan.error(), 1e-6);
    EXPECT_LE(plan.promise(), 1e-3);
    const RenderPlan loose = plan_render(rig, over_paths(2e-3));
    EXPECT_EQ(loose.wavelengths.size(), 3U);
    EXPECT_LT(loose.error(), 1e-3);
    EXPECT_LE(loose.promise(), 2e-3);
    EXPECT_EQ(loose.tolerance, 2e-3);
}

// HabCam from 1.2 to 7 m looks along paths of 2.5 to 16 m: one plan keeps its error on all.
TEST(RenderPlan, KeepsItsErrorOnPixelsAtOtherAltitudes) {
    const RenderPlan plan = plan_render(habcam(), over_paths(1e-3));
    for (const double altitude_m : {1.2, 3.0, 6.5}) {
        Rig rig = habcam();
        rig.sled.altitude_m = altitude_m;
        const PathRange paths = path_range(rig);
        ASSERT_GE(paths.shortest_m, 2.0) << altitude_m;
        ASSERT_LE(paths.longest_m, 16.0) << altitude_m;
        expect_promise_kept(rig, plan, 12, std::to_string(altitude_m) + " m above the floor");
    }
}

Rig rig_with_materials() {
    Rig rig = habcam();
    for (const char* name : {"green-algae", "brown-algae", "red-algae"}) {
        rig.materials.push_back(load_curve(name, CurveRole::Reflectance, {}));
    }
    // Dark in the blue, with an edge in the green and a dip in the red.
    rig.materials.emplace_back("sponge",
                               std::vector{380.0, 520.0, 560.0, 640.0, 670.0, 700.0, 780.0},
                               std::vector{0.02, 0.04, 0.35, 0.40, 0.15, 0.55, 0.6});
    return rig;
}

TEST(RenderPlan, OfFiveMaterialsIsThreeFramesAtMost) {
    const Rig rig = rig_with_materials();
    const RenderPlan plan = plan_render(rig, {});
    EXPECT_EQ(plan.family.sources.size(), 5U);
    EXPECT_LE(plan.wavelengths.size(), 9U);
    EXPECT_LE(plan.frames(), 3U);
    EXPECT_LE(plan.promise(), 1e-3);
    expect_order(rig, plan);
}

TEST(RenderPlan, KeepsItsErrorOnPixelsOfEveryMaterial) {
    const Rig rig = rig_with_materials();
    const RenderPlan plan = plan_render(rig, {});
    for (const Spectrum& material : rig.materials) {
        Rig floor = rig;
        floor.seafloor.reflectance = material;
        expect_promise_kept(floor, plan, 8, material.name());
    }
}

// With the horizon in view the light goes on until it is black.
TEST(RenderPlan, ReachesTheHorizon) {
    Rig rig = habcam();
    rig.sled.pitch_rad = 75.0 * kDegree;
    for (Strobe& strobe : rig.strobes) strobe.beam.cones = {strobe.beam.cones[2]};
    PlanRequest request;
    request.tolerance = 3e-3;
    const RenderPlan plan = plan_render(rig, request);
    EXPECT_LE(plan.promise(), 3e-3);
    EXPECT_GT(plan.family.longest_path_m, 100.0);
    expect_promise_kept(rig, plan, 30, "horizon");
}

// The fore edge looks level at a pitch of atan(12 mm / (512 * 6.45 um)) = 74.6 degrees. A
// thousandth of a degree before that there is as little light far away as behind it: what can be
// kept there can be kept here.
TEST(RenderPlan, BearsAnEdgeThatAllButSeesTheHorizon) {
    Rig rig = habcam();
    const double horizon_rad = std::atan2(0.012, 512.0 * 6.45e-6);
    for (const double beyond_deg : {0.001, -0.1, -0.001}) {
        rig.sled.pitch_rad = horizon_rad + beyond_deg * kDegree;
        const PathRange paths = path_range(rig);
        EXPECT_EQ(paths.has_horizon, beyond_deg > 0.0) << beyond_deg;
        EXPECT_EQ(error_of(rig, {}), "nothing was said")
            << beyond_deg << " degrees beyond; paths " << paths.shortest_m << " to "
            << paths.longest_m << " m";
    }
}

// A tolerance that nothing keeps is refused, with one that can be kept. A search is not so even
// that what one tolerance keeps, a little larger one keeps too, so what is offered is what was
// tried.
TEST(RenderPlan, RefusesATooSmallToleranceAndKeepsTheOneThatItOffers) {
    constexpr std::string_view kStart = "tolerance: found 1e-05; allowed: ";
    for (const Rig& rig : {habcam(), random_rig(2), random_rig(5), random_rig(11)}) {
        PlanRequest request;
        request.tolerance = 1e-5;
        const std::string message = error_of(rig, request);
        ASSERT_TRUE(message.starts_with(kStart)) << rig.title << ": " << message;
        EXPECT_TRUE(message.ends_with(" wavelengths achieve")) << rig.title << ": " << message;
        request.tolerance = std::stod(message.substr(kStart.size()));
        EXPECT_GE(request.tolerance, kFrameError) << message;
        EXPECT_LE(plan_render(rig, request).promise(), request.tolerance) << rig.title << message;
    }
}

// What three wavelengths keep is not given to more, however near it is to the frames' own error.
// The chip's half diagonal is 0.5 * 6.45 um * hypot(1360, 1024) = 5.490 mm: behind 0.6628 mm that
// is 2 atan(8.283) = 166.2 degrees.
TEST(RenderPlan, NamesAFocalLengthThatNoLensHasWhereItCannotKeepATolerance) {
    Rig rig = habcam();
    rig.camera.focal_length_m = 0.6628e-3;
    PlanRequest request;
    request.tolerance = 4.95e-4;
    const std::string error = error_of(rig, request);
    EXPECT_TRUE(error.starts_with("tolerance: found 0.000495; allowed: ")) << error;
    EXPECT_TRUE(
        has(error, "camera.focal_length_mm: 0.6628 gives a field of view of 166.2 degrees"));
    rig.camera.focal_length_m = 12e-3;
    request.tolerance = 4e-4;
    EXPECT_TRUE(error_of(rig, request).starts_with("tolerance: found 0.0004; allowed: "));
}

// --- Behind a port --------------------------------------------------------------------- --------

TEST(RenderPlan, BehindAPortKeepsItsToleranceAndItsSharing) {
    const Rig rig = scene_rig("port.toml");
    for (const double tolerance : {6e-4, 1e-3, 1e-2}) {
        PlanRequest request;
        request.tolerance = tolerance;
        const RenderPlan plan = plan_render(rig, request);
        EXPECT_LE(plan.promise(), tolerance);
        EXPECT_LE(plan.frames(), plan.wavelengths.size());
        for (const PlannedWavelength& a : plan.wavelengths) {
            for (const PlannedWavelength& b : plan.wavelengths) {
                if (a.frame != b.frame) continue;
                EXPECT_LE(corner_shift_px(rig, a.lambda_nm, b.lambda_nm), request.scene.pixel_shift)
                    << "tolerance " << tolerance;
            }
        }
        expect_order(rig, plan);
    }
}

// With all of it, the frames' own error included, no pixel is off by more than the tolerance: of
// HabCam behind its port, under one lamp close to the floor, and with a lamp's mirror image.
TEST(RenderPlan, BehindAPortKeepsItsToleranceOnPixels) {
    Rig low = scene_rig("port.toml");
    low.strobes.resize(1, low.strobes.front());
    low.strobes[0].position_m = {0.25, 0.3, 1.95};
    low.strobes[0].axis = Eigen::Vector3d::UnitZ();
    low.strobes[0].beam.cones = {low.strobes[0].beam.cones[2]};
    Rig glossy = low;
    glossy.strobes[0].position_m = {0.2, 0.2, 0.2};
    glossy.seafloor.phong = 5.0;
    glossy.seafloor.phong_size = 1000.0;
    struct Case {
        std::string name;
        Rig rig;
        double tolerance;
    };
    for (const Case& each : {Case{"HabCam", scene_rig("port.toml"), 6e-4},
                             {"a low lamp", low, 1e-2},
                             {"a glossy floor", glossy, 2e-3},
                             {"a glossy floor", glossy, 1e-2}}) {
        PlanRequest request;
        request.tolerance = each.tolerance;
        const RenderPlan plan = plan_render(each.rig, request);
        const Worst worst = worst_pixels(each.rig, plan, 120);
        EXPECT_GT(worst.pixels, 30) << each.name;
        for (std::size_t c = 0; c < kChannels; ++c) {
            const double from_frames = plan.quality[c].amplification * plan.frame_error;
            EXPECT_LE(worst.error[c] + from_frames, each.tolerance)
                << each.name << ": channel " << kChannelNames[c] << " errs by " << worst.error[c]
                << " of " << plan.quality[c].error << ", column " << worst.pixel[c].column
                << ", row " << worst.pixel[c].row;
        }
    }
}

// Three wavelengths in one frame, each shifted by as much as 2 pixels: the promise knows.
TEST(RenderPlan, KnowsWhatSharedFramesShift) {
    const Rig rig = scene_rig("port.toml");
    PlanRequest request;
    request.wavelengths_nm = {480.0, 550.0, 620.0};
    const RenderPlan apart = plan_render(rig, request);
    EXPECT_EQ(apart.frames(), 3U);
    request.scene.pixel_shift = 10.0;
    const RenderPlan shared = plan_render(rig, request);
    ASSERT_EQ(shared.frames(), 1U);
    EXPECT_EQ(shared.wavelengths[0].index_nm, 550.0);
    EXPECT_GT(shared.error(), apart.error());
    expect_promise_kept(rig, apart, 40, "apart");
    expect_promise_kept(rig, shared, 40, "shared");
}

// Where sharing would break the tolerance, each wavelength has a frame of its own.
TEST(RenderPlan, BehindAPortGivesUpSharingForTheTolerance) {
    const Rig rig = scene_rig("port.toml");
    PlanRequest request;
    request.scene.pixel_shift = 1000.0;
    for (const double tolerance : {6e-4, 7e-4, 1e-3, 3e-3}) {
        request.tolerance = tolerance;
        const RenderPlan plan = plan_render(rig, request);
        EXPECT_LE(plan.promise(), tolerance);
        const bool is_shared = plan.frames() < plan.wavelengths.size();
        EXPECT_EQ(plan.scene.pixel_shift, is_shared ? 1000.0 : 0.0) << tolerance;
    }
}

}  // namespace
}  // namespace aphotic::render_plan_test
