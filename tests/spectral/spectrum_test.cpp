// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/spectrum.h"

#include "base/error.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <limits>

namespace aphotic::spectrum_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Spectrum curve(const std::string& name, double first_nm, double last_nm) {
    return {name, {first_nm, 550.0, last_nm}, {1.0, 2.0, 3.0}};
}

std::string message_of(const auto& action) {
    return refusal_of([&] { action(); });
}

TEST(Spectrum, IsExactAtItsKnots) {
    const Spectrum spectrum("a", {380.0, 382.5, 401.7}, {0.1, 0.7, 0.3});
    EXPECT_EQ(spectrum.at(380.0), 0.1);
    EXPECT_EQ(spectrum.at(382.5), 0.7);
    EXPECT_EQ(spectrum.at(401.7), 0.3);
}

TEST(Spectrum, IsLinearBetweenItsKnots) {
    const Spectrum spectrum("a", {400.0, 500.0, 600.0}, {1.0, 3.0, -1.0});
    EXPECT_DOUBLE_EQ(spectrum.at(425.0), 1.5);
    EXPECT_DOUBLE_EQ(spectrum.at(550.0), 1.0);
}

TEST(Spectrum, HasNoValueOutsideItsRange) {
    const Spectrum spectrum("reflectance 'sand'", {350.0, 800.0}, {0.2, 0.6});
    EXPECT_EQ(message_of([&] { static_cast<void>(spectrum.at(800.5)); }),
              "reflectance 'sand' covers 350 to 800 nm and has no value at 800.5 nm");
    EXPECT_THROW(static_cast<void>(spectrum.at(349.9)), InputError);
    EXPECT_THROW(static_cast<void>(spectrum.at(kNan)), InputError);
}

TEST(Spectrum, RefusesKnotsThatAreNotACurve) {
    EXPECT_EQ(message_of([] { Spectrum("a", {400.0}, {1.0}); }),
              "a: found 1 knots; a curve needs 2 or more");
    EXPECT_EQ(message_of([] {
                  Spectrum("a", {400.0, 400.0}, {1.0, 2.0});
              }),
              "a: wavelength 400 nm follows 400 nm; allowed: increasing");
    EXPECT_EQ(message_of([] {
                  Spectrum("a", {400.0, 500.0}, {1.0});
              }),
              "a: 2 wavelengths but 1 values");
    EXPECT_EQ(message_of([] {
                  Spectrum("a", {400.0, 500.0}, {1.0, kNan});
              }),
              "a: found a number that is not finite");
    EXPECT_THROW(Spectrum("a", {400.0, kInfinity}, {1.0, 2.0}), InputError);
}

TEST(CommonRange, IsTheIntersection) {
    const Spectrum a = curve("a", 380.0, 727.5);
    const Spectrum b = curve("b", 400.0, 780.0);
    const std::vector<const Spectrum*> curves{&a, &b};
    EXPECT_EQ(common_range(curves).first_nm, 400.0);
    EXPECT_EQ(common_range(curves).last_nm, 727.5);
}

TEST(RequireCover, AcceptsARangeUpToTheLastKnots) {
    const Spectrum a = curve("a", 380.0, 727.5);
    const std::vector<const Spectrum*> curves{&a};
    EXPECT_NO_THROW(require_cover(curves, {380.0, 727.5}));
}

TEST(RequireCover, NamesTheCurveTheGapAndTheRemedy) {
    const Spectrum water = curve("water absorption 'pope-fry-1997'", 380.0, 727.5);
    const Spectrum lamp = curve("lamp spectrum 'xenon-flash'", 380.0, 780.0);
    const std::vector<const Spectrum*> curves{&lamp, &water};
    EXPECT_EQ(message_of([&] {
                  require_cover(curves, {380.0, 780.0});
              }),
              "water absorption 'pope-fry-1997' covers 380 to 727.5 nm, which leaves 727.5 to 780 "
              "nm of the range 380 to 780 nm without a value; range_nm = [380, 727.5] works");
}

TEST(RequireCover, NamesEveryCurveThatLacksSomething) {
    const Spectrum a = curve("a", 400.0, 700.0);
    const Spectrum b = curve("b", 360.0, 750.0);
    const std::vector<const Spectrum*> curves{&a, &b};
    EXPECT_EQ(message_of([&] {
                  require_cover(curves, {350.0, 740.0});
              }),
              "a covers 400 to 700 nm, which leaves 350 to 400 nm and 700 to 740 nm of the range "
              "350 to 740 nm without a value; b covers 360 to 750 nm, which leaves 350 to 360 nm "
              "of the range 350 to 740 nm without a value; range_nm = [400, 700] works");
}

TEST(RequireCover, SaysWhenNoRangeWouldDo) {
    const Spectrum a("a", {300.0, 400.0}, {1.0, 1.0});
    const Spectrum b("b", {500.0, 600.0}, {1.0, 1.0});
    const std::vector<const Spectrum*> curves{&a, &b};
    EXPECT_EQ(message_of([&] {
                  require_cover(curves, {300.0, 400.0});
              }),
              "b covers 500 to 600 nm, which leaves all of the range 300 to 400 nm without a "
              "value; no range_nm works, since these curves have no wavelengths in common");
}

TEST(RequireCover, SuggestsTheCoveredRangeWhenTheAskedOneIsElsewhere) {
    const Spectrum a = curve("a", 400.0, 700.0);
    const std::vector<const Spectrum*> curves{&a};
    EXPECT_EQ(message_of([&] {
                  require_cover(curves, {900.0, 1000.0});
              }),
              "a covers 400 to 700 nm, which leaves all of the range 900 to 1000 nm without a "
              "value; range_nm = [400, 700] works");
}

TEST(RequireCover, RefusesAnEmptyRange) {
    EXPECT_THROW(require_cover({}, {700.0, 400.0}), InputError);
    EXPECT_THROW(require_cover({}, {kNan, 400.0}), InputError);
}

TEST(UnionOfKnots, IsSortedWithoutRepeatsAndHoldsTheEnds) {
    const Spectrum a("a", {380.0, 500.0, 600.0, 780.0}, {1.0, 1.0, 1.0, 1.0});
    const Spectrum b("b", {400.0, 450.0, 600.0, 720.0}, {1.0, 1.0, 1.0, 1.0});
    const std::vector<const Spectrum*> curves{&a, &b};
    EXPECT_EQ(union_of_knots(curves, {400.0, 710.0}),
              (std::vector<double>{400.0, 450.0, 500.0, 600.0, 710.0}));
}

TEST(Spectrum, IsCalledAfterItsTable) {
    const auto called = [](std::optional<CurveSource> source) {
        return Spectrum("the floor's", {400.0, 700.0}, {0.0, 1.0}, std::move(source)).short_name();
    };
    EXPECT_EQ(called(CurveSource{.table = "sand"}), "sand");
    EXPECT_EQ(called(CurveSource{.table = "/home/me/rigs/mud.csv", .file_sha256 = "ab12"}),
              "mud.csv");
    EXPECT_EQ(called(std::nullopt), "the floor's");
}

}  // namespace
}  // namespace aphotic::spectrum_test
