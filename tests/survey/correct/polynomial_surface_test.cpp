// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/polynomial_surface.h"

#include "base/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace aphotic::polynomial_surface_test {
namespace {

constexpr int kWidth_px = 61;
constexpr int kHeight_px = 43;
constexpr double kFloat = 2e-6;  // samples of about 1, as floats

template <typename Function>
std::vector<float> plane_of(const Function& f) {
    std::vector<float> plane;
    for (int row = 0; row < kHeight_px; ++row) {
        for (int column = 0; column < kWidth_px; ++column)
            plane.push_back(static_cast<float>(f(column / 60.0, row / 42.0)));
    }
    return plane;
}

double quartic(double x, double y) {
    return 1.0 + 0.3 * x - 0.5 * y + 0.2 * x * y * y + 0.4 * x * x * x * x - 0.1 * x * x * y * y;
}

TEST(PolynomialSurface, FindsAPolynomialOfItsOrder) {
    const std::vector<float> plane = plane_of(quartic);
    for (const int order : {4, 6}) {
        PolynomialSurface surface(kWidth_px, kHeight_px, order);
        surface.add(plane);
        const std::vector<float> fitted = surface.fitted();
        for (std::size_t i = 0; i < plane.size(); ++i) ASSERT_NEAR(fitted[i], plane[i], kFloat);
    }
}

// What is left of any plane holds nothing of the model: its products with 1, x, y, xy, ... vanish.
TEST(PolynomialSurface, LeavesNothingOfItsOwnKindBehind) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform;
    const std::vector<float> plane = plane_of([&](double, double) { return uniform(random); });
    PolynomialSurface surface(kWidth_px, kHeight_px, 2);
    surface.add(plane);
    const std::vector<float> fitted = surface.fitted();
    const std::vector<std::vector<float>> terms{plane_of([](double, double) { return 1.0; }),
                                                plane_of([](double x, double) { return x; }),
                                                plane_of([](double, double y) { return y; }),
                                                plane_of([](double x, double y) { return x * y; }),
                                                plane_of([](double x, double) { return x * x; }),
                                                plane_of([](double, double y) { return y * y; })};
    for (const std::vector<float>& term : terms) {
        double product = 0.0;
        for (std::size_t i = 0; i < plane.size(); ++i)
            product += (static_cast<double>(plane[i]) - fitted[i]) * term[i];
        EXPECT_NEAR(product / static_cast<double>(plane.size()), 0.0, kFloat);
    }
}

TEST(PolynomialSurface, OfManyImagesIsTheirMeans) {
    PolynomialSurface surface(kWidth_px, kHeight_px, 4);
    surface.add(plane_of([](double x, double y) { return quartic(x, y) + x; }));
    surface.add(plane_of([](double x, double y) { return quartic(x, y) - x + 2.0 * y; }));
    EXPECT_EQ(surface.planes(), 2U);
    const std::vector<float> wanted =
        plane_of([](double x, double y) { return quartic(x, y) + y; });
    const std::vector<float> fitted = surface.fitted();
    for (std::size_t i = 0; i < wanted.size(); ++i) ASSERT_NEAR(fitted[i], wanted[i], kFloat);
}

TEST(PolynomialSurface, RefusesFewerPixelsThanTerms) {
    EXPECT_NO_THROW(PolynomialSurface(5, 9, 4));
    EXPECT_THROW(PolynomialSurface(4, 9, 4), InputError);
    EXPECT_THROW(PolynomialSurface(9, 4, 4), InputError);
}

}  // namespace
}  // namespace aphotic::polynomial_surface_test
