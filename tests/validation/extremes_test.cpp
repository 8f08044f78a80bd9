// SPDX-License-Identifier: BSD-3-Clause
//
// Each row of extremes.toml: the reference tracer against long double, and what the reader refuses.
// What POV-Ray makes of the same rows is extremes_povray_test.cpp's.
#include "support/extremes.h"
#include "support/effort.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace aphotic::extremes_test {
namespace {

using extremes::Extreme;
using extremes::ExtremeFound;

constexpr int kWidth_px = 4;

// What a perfect renderer brings: the tracer's light, in floats, at an exposure that hides nothing.
RenderedImages perfect(const Rig& rig, const Extreme&, const std::filesystem::path&) {
    const WavelengthRange& range = rig.camera.range;
    const std::vector<double> lambda_nm{
        range.first_nm, 0.5 * (range.first_nm + range.last_nm), range.last_nm};
    const Tracer tracer(rig, {.signals = true, .planes_nm = lambda_nm});
    const std::vector<double> rows = tracer.rows(0, rig.camera.height_px);
    const auto signals =
        static_cast<std::ptrdiff_t>(rows.size() / (kChannels + lambda_nm.size()) * kChannels);
    RenderedImages images{.lambda_nm = lambda_nm,
                          .index_nm = lambda_nm,
                          .shift_error = {0.0, 0.0, 0.0},
                          .radiance_black = {0x1p-34, 0x1p-34, 0x1p-34},
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

class Extremes : public testing::TestWithParam<Extreme> {};

// Beside a perfect renderer only the tracer can be out of bounds.
TEST_P(Extremes, AreWithinTheTracersBoundsOrRefusedByTheReader) {
    const TempFolder folder;
    const ExtremeFound found = extremes::measure(GetParam(), folder.path(), perfect);
    if (GetParam().expected == "refused") {
        EXPECT_TRUE(is_as_expected(GetParam(), found)) << found.outcome << ": " << found.said;
        return;
    }
    EXPECT_EQ(found.said, "");
    EXPECT_EQ(found.outcome == "grows", GetParam().expected == "grows")
        << "radiance " << found.traced_radiance << ", signals " << found.traced_signal;
}

std::vector<Extreme> rows_of(const std::string& group) {
    std::vector<Extreme> rows = extremes::extremes_of(group, kWidth_px);
    std::erase_if(rows, [](const Extreme& one) { return one.expected == "unrenderable"; });
    // By day every third row, and all of those that are refused: these take no time.
    std::size_t row = 0;
    std::erase_if(rows, [&](const Extreme& one) {
        constexpr std::size_t kByDay = 3;
        return one.expected != "refused" && row++ % kByDay != 0 && !is_night();
    });
    return rows;
}

const auto kName = [](const testing::TestParamInfo<Extreme>& row) { return row.param.name; };
INSTANTIATE_TEST_SUITE_P(Water, Extremes, testing::ValuesIn(rows_of("water")), kName);
INSTANTIATE_TEST_SUITE_P(Scattering, Extremes, testing::ValuesIn(rows_of("scattering")), kName);
INSTANTIATE_TEST_SUITE_P(Geometry, Extremes, testing::ValuesIn(rows_of("geometry")), kName);
INSTANTIATE_TEST_SUITE_P(Cones, Extremes, testing::ValuesIn(rows_of("cones")), kName);
INSTANTIATE_TEST_SUITE_P(Spectra, Extremes, testing::ValuesIn(rows_of("spectra")), kName);
INSTANTIATE_TEST_SUITE_P(Images, Extremes, testing::ValuesIn(rows_of("images")), kName);
INSTANTIATE_TEST_SUITE_P(Sums, Extremes, testing::ValuesIn(rows_of("sums")), kName);

TEST(ExtremesTable, NamesEachRowAndNoGroupIsLeftOut) {
    const std::vector<Extreme> rows = extremes::all_extremes(kWidth_px);
    EXPECT_GT(rows.size(), 150U);
    std::set<std::string> names;
    std::set<std::string> groups;
    for (const Extreme& one : rows) {
        names.insert(one.name);
        groups.insert(one.group);
        EXPECT_FALSE(one.value.empty()) << one.name;
        const bool is_refusal = one.expected == "refused" || one.expected == "unrenderable";
        EXPECT_TRUE(!is_refusal || !one.says.empty()) << one.name;
    }
    EXPECT_EQ(names.size(), rows.size());
    EXPECT_EQ(
        groups,
        (std::set<std::string>{
            "water", "scattering", "geometry", "cones", "spectra", "images", "frames", "sums"}));
}

// That a row can fail: renders that are off, each in its way.
Extreme ordinary() {
    for (Extreme& one : extremes::all_extremes(kWidth_px)) {
        if (one.what == "altitude (m)" && one.value == "1") return one;
    }
    throw std::logic_error("no row of an altitude of 1 m");
}

ExtremeFound with(
    const std::function<void(RenderedImages& images, std::vector<float>& planes)>& fault) {
    const TempFolder folder;
    return extremes::measure(
        ordinary(), folder.path(), [&](const Rig& rig, const Extreme& row, const auto& its) {
            RenderedImages images = perfect(rig, row, its);
            std::vector<float> planes = images.radiance(0, images.lambda_nm.size());
            fault(images, planes);
            images.radiance = [planes](std::size_t, std::size_t) { return planes; };
            return images;
        });
}

TEST(ExtremesTable, SeesRendersThatAreOff) {
    EXPECT_EQ(with([](auto&, auto&) {}).outcome, "holds");
    const ExtremeFound by_a_thousandth =
        with([](auto&, std::vector<float>& planes) { planes.back() *= 1.001F; });
    EXPECT_EQ(by_a_thousandth.outcome, "grows");
    EXPECT_NEAR(by_a_thousandth.povray_radiance, 1e-3, 1e-6);
    const ExtremeFound beyond_the_promise =
        with([](RenderedImages& images, auto&) { images.signals.samples.front() *= 1.00001F; });
    EXPECT_EQ(beyond_the_promise.outcome, "grows");
    const ExtremeFound no_number = with([](RenderedImages& images, auto&) {
        images.signals.samples.back() = std::numeric_limits<float>::quiet_NaN();
    });
    EXPECT_EQ(no_number.outcome, "grows");
    EXPECT_TRUE(std::isinf(no_number.povray_signal));
    const ExtremeFound black = with([](RenderedImages& images, std::vector<float>& planes) {
        std::ranges::fill(images.signals.samples, 0.0F);
        std::ranges::fill(planes, 0.0F);
    });
    EXPECT_EQ(black.outcome, "grows");
}

TEST(ExtremesTable, ARefusalForAnotherReasonIsNotAsExpected) {
    Extreme misspelt = ordinary();
    misspelt.expected = "refused";
    misspelt.says = {"sled.altitude_m: found"};
    misspelt.rig.replace(misspelt.rig.find("altitude_m"), 10, "altitude_n");
    const TempFolder folder;
    const ExtremeFound found = extremes::measure(misspelt, folder.path(), perfect);
    EXPECT_EQ(found.outcome, "refused");
    EXPECT_FALSE(is_as_expected(misspelt, found)) << found.said;
}

}  // namespace
}  // namespace aphotic::extremes_test
