// SPDX-License-Identifier: BSD-3-Clause
//
// What a case of `aphotic stress` is called, with renders of the tests' own in POV-Ray's place.
#include "validation/stress.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/temp_folder.h"
#include "validation/exact_light.h"
#include "validation/tracer.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace aphotic::stress_test {
namespace {

constexpr int kWidth_px = 6;

const StressCase& case_of(const std::vector<StressCase>& cases, const std::string& name) {
    const auto found = std::ranges::find_if(
        cases, [&](const StressCase& one) { return one.name.find(name) != std::string::npos; });
    if (found == cases.end()) throw std::logic_error("no case " + name);
    return *found;
}

// What a perfect renderer brings: the tracer's light, in floats, at an exposure that hides nothing.
RenderedImages perfect(const Rig& rig) {
    const std::vector<double> lambda_nm{480.0, 560.0};
    const Tracer tracer(rig, {.signals = true, .planes_nm = lambda_nm});
    const std::vector<double> rows = tracer.rows(0, rig.camera.height_px);
    const auto signals = static_cast<std::ptrdiff_t>(rows.size() / 5 * 3);
    RenderedImages images{.lambda_nm = lambda_nm,
                          .index_nm = lambda_nm,
                          .shift_error = {0.0, 0.0},
                          .radiance_black = {0x1p-34, 0x1p-34},
                          .promise = {1e-6, 1e-6, 1e-6},
                          .black = {},
                          .radiance = {},
                          .signals = {.width_px = rig.camera.width_px,
                                      .height_px = rig.camera.height_px,
                                      .samples = {rows.begin(), rows.begin() + signals}}};
    images.radiance = [planes = std::vector<float>(rows.begin() + signals, rows.end())](
                          std::size_t, std::size_t) { return planes; };
    return images;
}

class Stress : public testing::Test {
  protected:
    StressFound measure(const std::string& name, const StressRender& render) {
        return measure_stress(case_of(cases_, name), folder_.path() / "case", render);
    }

    TempFolder folder_;
    std::vector<StressCase> cases_ = stress_cases(kWidth_px);
};

TEST_F(Stress, EveryCaseHasAFolderOfItsOwnAndAllGroupsAreThere) {
    std::set<std::string> names;
    std::set<std::string> groups;
    for (const StressCase& one : cases_) {
        names.insert(one.name);
        groups.insert(one.group);
        EXPECT_FALSE(one.value.empty()) << one.name;
    }
    EXPECT_EQ(names.size(), cases_.size());
    EXPECT_EQ(
        groups,
        (std::set<std::string>{
            "water", "scattering", "geometry", "cones", "spectra", "images", "frames", "sums"}));
}

TEST_F(Stress, APerfectRenderHolds) {
    const StressFound found = measure("altitude-m-1", [](const Rig& rig, const auto&, const auto&) {
        EXPECT_EQ(rig.sled.altitude_m, 1.0);
        EXPECT_EQ(rig.camera.width_px, kWidth_px);
        return perfect(rig);
    });
    EXPECT_EQ(found.answer, StressAnswer::Holds) << found.said;
    EXPECT_TRUE(found.as_expected());
    EXPECT_GT(found.traced_radiance, 0.0);
    EXPECT_GT(found.peak, 0.0);
}

TEST_F(Stress, RadianceOffByAThousandthGrows) {
    const StressFound found = measure("altitude-m-1", [](const Rig& rig, const auto&, const auto&) {
        RenderedImages images = perfect(rig);
        images.radiance = [planes = images.radiance(0, 2)](std::size_t, std::size_t) {
            std::vector<float> off = planes;
            off.back() *= 1.001F;
            return off;
        };
        return images;
    });
    EXPECT_EQ(found.answer, StressAnswer::Grows);
    EXPECT_NEAR(found.povray_radiance, 1e-3, 1e-6);
    EXPECT_FALSE(found.as_expected());
}

TEST_F(Stress, ASignalBeyondThePromiseGrows) {
    const StressFound found = measure("altitude-m-1", [](const Rig& rig, const auto&, const auto&) {
        RenderedImages images = perfect(rig);
        images.signals.samples.front() *= 1.00001F;
        return images;
    });
    EXPECT_EQ(found.answer, StressAnswer::Grows);
}

TEST_F(Stress, NotANumberIsNeverWithinABound) {
    const StressFound found = measure("altitude-m-1", [](const Rig& rig, const auto&, const auto&) {
        RenderedImages images = perfect(rig);
        images.signals.samples.back() = std::numeric_limits<float>::quiet_NaN();
        return images;
    });
    EXPECT_EQ(found.answer, StressAnswer::Grows);
    EXPECT_TRUE(std::isinf(found.povray_signal));
}

TEST_F(Stress, ABlackImageWhereThereIsLightIsNoAnswer) {
    const StressFound found = measure("altitude-m-1", [](const Rig& rig, const auto&, const auto&) {
        RenderedImages images = perfect(rig);
        std::ranges::fill(images.signals.samples, 0.0F);
        const std::size_t size = images.radiance(0, 2).size();
        images.radiance = [size](std::size_t, std::size_t) { return std::vector<float>(size); };
        return images;
    });
    EXPECT_EQ(found.answer, StressAnswer::Grows);
}

TEST_F(Stress, LightThatNoFloatHoldsIsBlack) {
    const StressFound found =
        measure("uniform-loss-1-m-at-2-m-50",
                [](const Rig& rig, const auto&, const auto&) { return perfect(rig); });
    EXPECT_EQ(found.answer, StressAnswer::Black) << found.povray_radiance;
}

TEST_F(Stress, ARefusalKeepsItsWords) {
    const StressFound found =
        measure("altitude-m-100000", [](const Rig&, const auto&, const auto&) {
            ADD_FAILURE() << "the reader let it pass";
            return RenderedImages{};
        });
    EXPECT_EQ(found.answer, StressAnswer::Refused);
    EXPECT_NE(found.said.find("rig.toml:2: sled.altitude_m"), std::string::npos) << found.said;
    EXPECT_TRUE(found.as_expected());
}

TEST_F(Stress, ARefusalForAnotherReasonIsNotAsExpected) {
    StressCase misspelt = case_of(cases_, "altitude-m-100000");
    misspelt.rig.replace(misspelt.rig.find("altitude_m"), 10, "altitude_n");
    const StressFound found = measure_stress(misspelt, folder_.path() / "case", {});
    EXPECT_EQ(found.answer, StressAnswer::Refused);
    EXPECT_FALSE(found.as_expected()) << found.said;
    for (const StressCase& one : cases_) {
        if (one.expected != StressAnswer::Refused) continue;
        EXPECT_FALSE(one.says.empty()) << one.name;
    }
}

TEST_F(Stress, TablesSayWhatWasFoundAndWhatWasExpected) {
    StressFound refused;
    refused.asked = case_of(cases_, "altitude-m-100000");
    refused.answer = StressAnswer::Refused;
    refused.said =
        "/some/where/" + refused.asked.name +
        "/rig.toml:2: sled.altitude_m: found no | yes, .frame.5f3a9c01-f000003c-123.part.exr";
    StressFound surprise;
    surprise.asked = case_of(cases_, "altitude-m-1");
    surprise.answer = StressAnswer::Grows;
    surprise.traced_signal = std::numeric_limits<double>::infinity();
    write_stress(std::vector{refused, surprise}, folder_.path());

    const std::string text = read_text_file(folder_.path() / "stress.md");
    EXPECT_NE(
        text.find("refused: `rig.toml:2: sled.altitude_m: found no \\| yes, .frame.part.exr`"),
        std::string::npos)
        << text;
    EXPECT_NE(text.find("not finite | **NOT AS EXPECTED:** grows |"), std::string::npos) << text;
    const auto json = nlohmann::json::parse(read_text_file(folder_.path() / "stress.json"));
    ASSERT_EQ(json.size(), 2U);
    EXPECT_TRUE(json[0].at("as_expected").get<bool>());
    EXPECT_FALSE(json[1].at("as_expected").get<bool>());
    EXPECT_TRUE(json[1].at("traced_signal_error").is_null());
}

}  // namespace
}  // namespace aphotic::stress_test
