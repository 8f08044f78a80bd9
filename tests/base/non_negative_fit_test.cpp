// SPDX-License-Identifier: BSD-3-Clause
#include "base/non_negative_fit.h"

#include <gtest/gtest.h>

#include <random>

namespace aphotic::non_negative_fit_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kExact = 1e-12;
constexpr double kOptimal = 1e-9;  // of the gradient, relative to b

TEST(NonNegativeFit, IsTheUnboundedFitWhereThatIsPositive) {
    const MatrixXd G{{2.0, 1.0}, {1.0, 2.0}};
    const VectorXd x = non_negative_fit(G, VectorXd{{4.0, 5.0}});
    EXPECT_NEAR(x(0), 1.0, kExact);
    EXPECT_NEAR(x(1), 2.0, kExact);
}

// Unbounded it is (-2, 3): along x_0 = 0 the best is b_1 / G_11.
TEST(NonNegativeFit, HoldsAtZeroWhatWouldBeNegative) {
    const MatrixXd G{{2.0, 1.0}, {1.0, 2.0}};
    const VectorXd x = non_negative_fit(G, VectorXd{{-1.0, 4.0}});
    EXPECT_EQ(x(0), 0.0);
    EXPECT_NEAR(x(1), 2.0, kExact);
}

TEST(NonNegativeFit, GivesColumnsOfNothingNothing) {
    const MatrixXd G{{0.0, 0.0}, {0.0, 4.0}};
    const VectorXd x = non_negative_fit(G, VectorXd{{0.0, 2.0}});
    EXPECT_EQ(x(0), 0.0);
    EXPECT_NEAR(x(1), 0.5, kExact);
}

// Karush, Kuhn and Tucker's conditions, of problems at random.
TEST(NonNegativeFit, IsTheMinimum) {
    std::mt19937_64 dice(7);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 50; ++trial) {
        const auto draw = [&] { return normal(dice); };
        const MatrixXd A = MatrixXd::NullaryExpr(30, 12, draw);
        const VectorXd y = VectorXd::NullaryExpr(30, draw);
        const MatrixXd G = A.transpose() * A;
        const VectorXd b = A.transpose() * y;
        const VectorXd x = non_negative_fit(G, b);
        const VectorXd gradient = G * x - b;
        const double small = kOptimal * b.cwiseAbs().maxCoeff();
        for (Eigen::Index i = 0; i < x.size(); ++i) {
            EXPECT_GE(x(i), 0.0);
            EXPECT_GT(gradient(i), -small);
            if (x(i) > 0.0) {
                EXPECT_LT(gradient(i), small);
            }
        }
    }
}

}  // namespace
}  // namespace aphotic::non_negative_fit_test
