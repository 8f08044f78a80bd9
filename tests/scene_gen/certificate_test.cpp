// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/certificate.h"

#include "rig/file/rig_reader.h"
#include "scene_gen/render_plan.h"
#include "support/random_rig.h"
#include "validation/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace aphotic::certificate_test {
namespace {

// The grid has the image's corners, half a pixel beyond the corner pixels' centres.
constexpr double kCorners = 1.5;
// Of the floor's light along straight lines between the certificate's wavelengths.
constexpr double kStraightLines = 2e-6;

Rig highlight_behind_a_port() {
    return with_pixels(
        read_rig(std::string(APHOTIC_SOURCE_DIR) + "/tests/rigs/highlight-behind-port/rig.toml"),
        20,
        15);
}

RenderPlan plan_of(const Rig& rig, std::vector<double> wavelengths_nm) {
    PlanRequest request;
    request.wavelengths_nm = std::move(wavelengths_nm);
    request.scene.wavelengths_per_frame = 1;
    return plan_render(rig, request);
}

std::array<double, kChannels> port_error_of(const Rig& rig, const RenderPlan& plan) {
    return port_error(rig, plan.wavelengths);
}

// Of every pixel, by the reference: its signals against the rule's sum of its radiances.
std::array<double, kChannels> traced_error(const Rig& rig, const RenderPlan& plan) {
    TraceOptions options{.signals = true, .planes_nm = {}};
    for (const PlannedWavelength& w : plan.wavelengths) {
        options.planes_nm.push_back(w.lambda_nm);
    }
    const std::vector<double> planes = Tracer(rig, options).rows(0, rig.camera.height_px);
    const std::size_t pixels = planes.size() / (kChannels + options.planes_nm.size());
    std::array<double, kChannels> error{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        for (std::size_t i = 0; i < pixels; ++i) {
            double found = 0.0;
            for (std::size_t j = 0; j < plan.wavelengths.size(); ++j) {
                found += plan.wavelengths[j].weight[c] * planes[(kChannels + j) * pixels + i];
            }
            error[c] = std::max(error[c], std::abs(found / planes[c * pixels + i] - 1.0));
        }
    }
    return error;
}

TEST(Certificate, FindsTheLargestErrorOfPixelsBehindAPort) {
    const Rig rig = highlight_behind_a_port();
    for (const std::vector<double>& wavelengths_nm :
         {std::vector{434.812, 449.188, 603.906, 684.719},
          std::vector{420.0, 480.0, 540.0, 600.0, 660.0},
          std::vector{550.0}}) {
        const RenderPlan plan = plan_of(rig, wavelengths_nm);
        const auto stated = port_error_of(rig, plan);
        const auto right = traced_error(rig, plan);
        for (std::size_t c = 0; c < kChannels; ++c) {
            EXPECT_GE(stated[c], right[c] - kStraightLines)
                << wavelengths_nm.size() << kChannelNames[c];
            EXPECT_LE(stated[c], kCorners * right[c] + kStraightLines)
                << wavelengths_nm.size() << kChannelNames[c];
        }
    }
}

// The fit's own judgement of these wavelengths is 3.5e-4.
TEST(Certificate, IsTheErrorThatAPlanPromises) {
    const Rig rig = highlight_behind_a_port();
    const RenderPlan plan = plan_of(rig, {434.812, 449.188, 603.906, 684.719});
    const auto right = traced_error(rig, plan);
    EXPECT_GT(right[0], 3.6e-4);
    for (std::size_t c = 0; c < kChannels; ++c) EXPECT_GE(plan.quality[c].error, right[c]);
}

TEST(Certificate, MakesAPlanTakeAsManyWavelengthsAsItsToleranceNeeds) {
    const Rig rig = highlight_behind_a_port();
    PlanRequest request;
    request.scene.wavelengths_per_frame = 1;
    const RenderPlan plan = plan_render(rig, request);
    EXPECT_LE(plan.promise(), request.tolerance);
    EXPECT_GT(plan.wavelengths.size(), 4U);
    const auto right = traced_error(rig, plan);
    for (std::size_t c = 0; c < kChannels; ++c) {
        EXPECT_LE(right[c], plan.quality[c].error);
    }
}

}  // namespace
}  // namespace aphotic::certificate_test
