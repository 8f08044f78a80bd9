// SPDX-License-Identifier: BSD-3-Clause
//
// Renders that the tracer itself makes with few lamps, as POV-Ray would, held against the
// reference.
#include "validation/validation.h"

#include "support/scene_rig.h"
#include "validation/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace aphotic::validation_test {
namespace {

const std::vector<double> kLambda_nm{480.0, 600.0};
const std::vector<EmitterLamps> kLamps(4, EmitterLamps{.across = 3, .along = 2});
// What the coarse lamps of HabCam's emitters err by, and a float's rounding.
constexpr double kPromise = 1.1e-4;

Rig small_rig(const std::string& scene) {
    return scene_rig(scene + ".toml", 34, 26);
}

RenderedImages render(const Rig& rig) {
    TraceOptions options{.signals = true, .planes_nm = kLambda_nm};
    options.rendered_lamps = kLamps;
    const std::vector<double> rows = Tracer(rig, options).rows(0, rig.camera.height_px);
    const auto signals = static_cast<std::ptrdiff_t>(rows.size() / 5 * 3);
    RenderedImages images{.lambda_nm = kLambda_nm,
                          .index_nm = kLambda_nm,
                          .shift_error = {0.0, 0.0},
                          .radiance_black = {0x1p-34, 0x1p-34},
                          .promise = {kPromise, kPromise, kPromise},
                          .black = {},
                          .radiance = {},
                          .signals = {.width_px = rig.camera.width_px,
                                      .height_px = rig.camera.height_px,
                                      .samples = {rows.begin(), rows.begin() + signals}},
                          .lamps = kLamps};
    images.radiance = [planes = std::vector<float>(rows.begin() + signals, rows.end())](
                          std::size_t first, std::size_t count) {
        const std::size_t plane = planes.size() / kLambda_nm.size();
        const auto from = planes.begin() + static_cast<std::ptrdiff_t>(first * plane);
        return std::vector<float>(from, from + static_cast<std::ptrdiff_t>(count * plane));
    };
    return images;
}

template <typename Check>
void for_each_comparison(const ValidationReport& report, const Check& check) {
    for (const Comparison& one : report.wavelengths) check(one);
    for (const Comparison& one : report.channels) check(one);
}

// 40 % of the pixels: more than a third.
TEST(Validation, BoundsThePenumbraeOfEmitters) {
    const Rig rig = small_rig("habcam-emitters");
    const ValidationReport report = validate(rig, render(rig), 2);
    EXPECT_TRUE(report.holds());
    for_each_comparison(report, [](const Comparison& one) {
        EXPECT_EQ(one.compared, 34U * 26U) << one.name;
        EXPECT_EQ(one.on_edges, 0U) << one.name;
        EXPECT_GT(one.in_penumbrae, 34U * 26U / 3U) << one.name;
        EXPECT_GT(one.max_error_of_penumbrae, 0.01) << one.name << ": a staircase of six steps";
        EXPECT_LT(one.max_error, kPromise) << one.name;
    });
    EXPECT_NEAR(report.edges().share_in_penumbrae, 0.4, 0.05);
}

// The error of the smooth light alone, 1e-4, would not tell.
TEST(Validation, TellsAnEmitterThatIsTurned) {
    const Rig rig = small_rig("habcam-emitters");
    Rig turned = rig;
    for (Strobe& strobe : turned.strobes) {
        std::swap(strobe.emitter->across_m, strobe.emitter->along_m);
    }
    const ValidationReport report = validate(rig, render(turned), 2);
    for_each_comparison(report,
                        [](const Comparison& one) { EXPECT_GT(one.max_error, 0.01) << one.name; });
}

TEST(Validation, LeavesPenumbraeToTheEdgesWhereLampsAreNotKnown) {
    const Rig rig = small_rig("habcam-emitters");
    RenderedImages rendered = render(rig);
    rendered.lamps.clear();
    const ValidationReport report = validate(rig, rendered, 2);
    for_each_comparison(report, [](const Comparison& one) {
        EXPECT_EQ(one.in_penumbrae, 0U) << one.name;
        EXPECT_GT(one.on_edges, 34U * 26U / 3U) << one.name;
    });
}

// Shadows by emitters too; outlines and the lamps' own shadows keep their edges.
TEST(Validation, BoundsTheHalfShadowsOfObjects) {
    Rig rig = small_rig("objects");
    for (Strobe& strobe : rig.strobes) {
        strobe.emitter = Emitter{.across_m = 0.1, .along_m = 0.05};
        // No cone's edge: what is left are shadows.
        strobe.beam.cones = {
            {.part = "diffuse", .half_angle_rad = 1.5707963267948966, .weight = 1.0}};
    }
    RenderedImages rendered = render(rig);
    rendered.promise = {1e-2, 1e-2, 1e-2};  // few lamps for such an emitter, near objects
    const ValidationReport report = validate(rig, rendered, 2);
    for_each_comparison(report, [](const Comparison& one) {
        EXPECT_GT(one.in_penumbrae, 10U) << one.name;
        EXPECT_GT(one.max_error_of_penumbrae, 0.01) << one.name;
        EXPECT_LT(one.max_error, 1e-2) << one.name;
    });
}

}  // namespace
}  // namespace aphotic::validation_test
