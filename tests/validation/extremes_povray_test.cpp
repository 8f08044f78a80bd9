// SPDX-License-Identifier: BSD-3-Clause
//
// Each row of extremes.toml through real POV-Ray, at few pixels, and what a plan or a render
// refuses.
#include "support/extremes.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

namespace aphotic::extremes_povray_test {
namespace {

using extremes::Extreme;
using extremes::ExtremeFound;

class ExtremesByPovRay : public testing::TestWithParam<Extreme> {};

TEST_P(ExtremesByPovRay, ComeOutAsTheTableSays) {
    const TempFolder folder;
    const ExtremeFound found =
        extremes::measure(GetParam(), folder.path(), extremes::render_by_povray);
    EXPECT_TRUE(is_as_expected(GetParam(), found))
        << "expected: " << GetParam().expected << "; found: " << found.outcome << " " << found.said
        << "\nPOV-Ray: radiance " << found.povray_radiance << ", signals " << found.povray_signal
        << " of " << found.promise << "\ntracer: radiance " << found.traced_radiance << ", signals "
        << found.traced_signal;
}

// What the reader refuses, extremes_test.cpp has seen.
std::vector<Extreme> rows_of(const std::string& group) {
    constexpr int kWidth_px = 6;
    std::vector<Extreme> rows = extremes::extremes_of(group, kWidth_px);
    std::erase_if(rows, [](const Extreme& one) { return one.expected == "refused"; });
    return rows;
}

// A suite a group: CTest runs some at a time, for a row mostly waits for POV-Ray.
const auto kName = [](const testing::TestParamInfo<Extreme>& row) { return row.param.name; };
INSTANTIATE_TEST_SUITE_P(Water, ExtremesByPovRay, testing::ValuesIn(rows_of("water")), kName);
INSTANTIATE_TEST_SUITE_P(Scattering,
                         ExtremesByPovRay,
                         testing::ValuesIn(rows_of("scattering")),
                         kName);
INSTANTIATE_TEST_SUITE_P(Geometry, ExtremesByPovRay, testing::ValuesIn(rows_of("geometry")), kName);
INSTANTIATE_TEST_SUITE_P(Cones, ExtremesByPovRay, testing::ValuesIn(rows_of("cones")), kName);
INSTANTIATE_TEST_SUITE_P(Spectra, ExtremesByPovRay, testing::ValuesIn(rows_of("spectra")), kName);
INSTANTIATE_TEST_SUITE_P(Images, ExtremesByPovRay, testing::ValuesIn(rows_of("images")), kName);
INSTANTIATE_TEST_SUITE_P(Frames, ExtremesByPovRay, testing::ValuesIn(rows_of("frames")), kName);
INSTANTIATE_TEST_SUITE_P(Sums, ExtremesByPovRay, testing::ValuesIn(rows_of("sums")), kName);

}  // namespace
}  // namespace aphotic::extremes_povray_test
