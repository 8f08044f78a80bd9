// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/minimax.h"

#include "support/dice.h"

#include <gtest/gtest.h>
#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace aphotic::minimax_test {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Residuals of a few numbers near 1, from a Gram matrix whose condition is a few thousand.
constexpr double kRounding = 1e-11;
// The ridge's own share of an error, ridge^2 times the solution, and rounding.
constexpr double kRidge = 1e-12;
// How near Lawson's iteration comes to its limit in kEnough steps, when no two sets of rows have
// the same error: it is linear, and the nearer the second best set, the slower.
constexpr int kEnough = 1000;
constexpr double kConverged = 2e-3;

class Dice : public aphotic::Dice {
  public:
    using aphotic::Dice::Dice;
    MatrixXd matrix(Index rows, Index columns) {
        MatrixXd m(rows, columns);
        for (Index j = 0; j < columns; ++j) {
            for (Index i = 0; i < rows; ++i) m(i, j) = between(-1.0, 1.0);
        }
        return m;
    }
    // Not negative, and their sum is 1.
    ArrayXd weights(Index rows) {
        ArrayXd u(rows);
        for (Index i = 0; i < rows; ++i) u(i) = between(0.0, 1.0);
        return u / u.sum();
    }
};

double largest_residual(const MatrixXd& a, const VectorXd& b, const VectorXd& x) {
    return (a * x - b).cwiseAbs().maxCoeff();
}

// n + 1 rows and n columns of rank n: the residual's part along y, y^T A = 0, is y^T b whatever
// x is; spread evenly it is |y^T b| / sum |y_i|, and can be no less.
double error_of_a_reference(const MatrixXd& a, const VectorXd& b) {
    const MatrixXd kernel = Eigen::FullPivLU<MatrixXd>(a.transpose()).kernel();
    const VectorXd y = kernel.col(0);
    return std::abs(y.dot(b)) / y.cwiseAbs().sum();
}

// The minimax error by de la Vallee Poussin's theorem: the largest among all sets of n + 1 rows.
double exact_error(const MatrixXd& a, const VectorXd& b) {
    const Index members = a.cols() + 1;
    std::vector<bool> is_taken(static_cast<std::size_t>(a.rows()), false);
    std::fill_n(is_taken.begin(), members, true);
    double largest = 0.0;
    do {
        MatrixXd rows(members, a.cols());
        VectorXd right(members);
        Index row = 0;
        for (Index i = 0; i < a.rows(); ++i) {
            if (!is_taken[static_cast<std::size_t>(i)]) continue;
            rows.row(row) = a.row(i);
            right(row++) = b(i);
        }
        largest = std::max(largest, error_of_a_reference(rows, right));
    } while (std::prev_permutation(is_taken.begin(), is_taken.end()));
    return largest;
}

MatrixXd joined(const MatrixXd& a, const VectorXd& column) {
    MatrixXd both(a.rows(), a.cols() + 1);
    both << a, column;
    return both;
}

// --- Fits that are known in closed form -------------------------------------------------------

// x^n less its best approximation by lower powers is T_n(x) / 2^(n-1), which is +- 1 / 2^(n-1)
// at cos(k pi / n) and nowhere more. (P. L. Chebyshev, 1854.)
TEST(Minimax, FitsAPowerByLowerPowersAsChebyshevDid) {
    for (const int n : {1, 2, 3, 5, 8}) {
        std::vector<double> points;
        for (int k = 0; k <= n; ++k) points.push_back(std::cos(k * std::numbers::pi / n));
        for (int k = 1; k < 40; ++k) points.push_back(-1.0 + 0.05 * k);
        const auto rows = static_cast<Index>(points.size());
        MatrixXd a(rows, n);
        VectorXd b(rows);
        VectorXd chebyshev(rows);
        for (Index i = 0; i < rows; ++i) {
            const double x = points[static_cast<std::size_t>(i)];
            for (int j = 0; j < n; ++j) a(i, j) = std::pow(x, j);
            b(i) = std::pow(x, n);
            chebyshev(i) = std::cos(n * std::acos(x));
        }
        const double right = std::pow(2.0, 1 - n);
        const MinimaxFit fit = minimax_fit(a, b, {.iterations = kEnough, .weights = {}});
        EXPECT_NEAR(fit.error / right, 1.0, kConverged) << "x^" << n << ": " << fit.error;
        EXPECT_GE(fit.error, right * (1.0 - kRounding)) << "x^" << n;
        // The error is flat at the optimum: its shape comes as the root of its size.
        const VectorXd found = (b - a * fit.x) / right;
        EXPECT_LT((found - chebyshev).cwiseAbs().maxCoeff(), 2.0 * std::sqrt(kConverged))
            << "x^" << n;
    }
}

// One constant: the middle of the largest and the smallest.
TEST(Minimax, PutsOneConstantInTheMiddle) {
    const VectorXd b{{2.0, -1.0, 0.5, 7.0, 3.0, -0.25}};
    const MinimaxFit fit =
        minimax_fit(MatrixXd::Ones(6, 1), b, {.iterations = kEnough, .weights = {}});
    EXPECT_NEAR(fit.error, 4.0, 4.0 * kRounding);
    EXPECT_NEAR(fit.x(0), 3.0, 3.0 * kRounding);
    // All the weight on those two.
    EXPECT_NEAR(fit.weights(1), 0.5, kRounding);
    EXPECT_NEAR(fit.weights(3), 0.5, kRounding);
}

// On n + 1 rows the residuals of least squares are y_i / u_i, so the second step has them even.
TEST(Minimax, NeedsTwoStepsForOneRowMoreThanColumns) {
    Dice dice(1);
    for (int trial = 0; trial < 50; ++trial) {
        const Index columns = 1 + trial % 5;
        const MatrixXd a = dice.matrix(columns + 1, columns);
        const VectorXd b = dice.matrix(columns + 1, 1);
        const double right = error_of_a_reference(a, b);
        const MinimaxFit fit = minimax_fit(a, b, {.iterations = 2, .weights = {}});
        // Random matrices may be nearly singular: then the ridge takes its share.
        constexpr double kSingular = 1e-9;
        EXPECT_NEAR(fit.error / right, 1.0, kSingular)
            << "trial " << trial << ": " << fit.error << " and " << right;
    }
}

TEST(Minimax, ComesToTheErrorOfTheWorstSetOfRows) {
    Dice dice(2);
    for (int trial = 0; trial < 40; ++trial) {
        const Index columns = 1 + trial % 3;
        const MatrixXd a = dice.matrix(8, columns);
        const VectorXd b = dice.matrix(8, 1);
        const double right = exact_error(a, b);
        const MinimaxFit fit = minimax_fit(a, b, {.iterations = kEnough, .weights = {}});
        EXPECT_LE(fit.error, right * (1.0 + kConverged)) << "trial " << trial;
        EXPECT_GE(fit.error, right * (1.0 - kRounding)) << "trial " << trial;
    }
}

// Its parts agree with each other.
TEST(Minimax, ReturnsTheErrorOfItsSolutionAndWeightsThatSumToOne) {
    Dice dice(3);
    for (const int iterations : {1, 3, 60}) {
        const MatrixXd a = dice.matrix(20, 4);
        const VectorXd b = dice.matrix(20, 1);
        const MinimaxFit fit = minimax_fit(a, b, {.iterations = iterations, .weights = {}});
        EXPECT_EQ(fit.error, largest_residual(a, b, fit.x)) << iterations << " iterations";
        ASSERT_EQ(fit.weights.size(), 20);
        EXPECT_NEAR(fit.weights.sum(), 1.0, kRounding) << iterations << " iterations";
        EXPECT_GE(fit.weights.minCoeff(), 0.0) << iterations << " iterations";
    }
}

// --- Systems that can be solved ---------------------------------------------------------------

TEST(Minimax, IsExactForAConsistentSystem) {
    Dice dice(4);
    for (int trial = 0; trial < 20; ++trial) {
        const Index columns = 1 + trial % 6;
        const MatrixXd a = dice.matrix(columns + 5, columns);
        const VectorXd x = dice.matrix(columns, 1);
        const MinimaxFit fit = minimax_fit(a, a * x);
        EXPECT_LT(fit.error, kRidge) << "trial " << trial;
        EXPECT_LT((fit.x - x).cwiseAbs().maxCoeff(), kRidge * 100.0) << "trial " << trial;
    }
}

TEST(Minimax, FindsNothingForNothing) {
    const MinimaxFit fit = minimax_fit(MatrixXd::Ones(4, 2), VectorXd::Zero(4));
    EXPECT_EQ(fit.error, 0.0);
    EXPECT_EQ(fit.x.cwiseAbs().maxCoeff(), 0.0);
}

// --- The ridge --------------------------------------------------------------------------------

// Minimise (x - 1)^2 + r^2 x^2: x = 1 / (1 + r^2).
TEST(Minimax, PaysTheSquareOfTheRidge) {
    for (const double ridge : {1e-1, 1e-2, 1e-4}) {
        const MinimaxFit fit =
            minimax_fit(MatrixXd::Ones(3, 1), VectorXd::Ones(3), {.ridge = ridge, .weights = {}});
        const double right = ridge * ridge / (1.0 + ridge * ridge);
        EXPECT_NEAR(fit.error, right, 1e-15) << "ridge " << ridge;  // rounding of 1
    }
}

// Of all x with x_0 + x_1 + x_2 = 1 the smallest has thirds; columns count in their own scale.
TEST(Minimax, SharesTheLoadBetweenDependentColumns) {
    // The Gram matrix is singular but for the ridge: rounding over ridge^2.
    constexpr double kSingular = 1e-2;
    MatrixXd a(5, 3);
    a.col(0).setLinSpaced(5, 1.0, 2.0);
    a.col(1) = a.col(0);
    a.col(2) = 4.0 * a.col(0);
    const VectorXd b = 3.0 * a.col(0);
    const MinimaxFit fit = minimax_fit(a, b);
    EXPECT_LT(fit.error, 1e-9) << "of " << b.maxCoeff();
    EXPECT_NEAR(fit.x(0), 1.0, kSingular);
    EXPECT_NEAR(fit.x(1), 1.0, kSingular);
    EXPECT_NEAR(4.0 * fit.x(2), 1.0, kSingular);
}

TEST(Minimax, GivesAColumnOfZerosNothing) {
    MatrixXd a = MatrixXd::Ones(4, 2);
    a.col(1).setZero();
    const MinimaxFit fit = minimax_fit(a, VectorXd::Constant(4, 2.0));
    EXPECT_NEAR(fit.x(0), 2.0, kRidge);
    EXPECT_EQ(fit.x(1), 0.0);
}

// Two dozen of the same column, and of columns that differ in their last digits.
TEST(Minimax, StaysFiniteHoweverDependentTheColumns) {
    constexpr Index kColumns = 24;
    Dice dice(5);
    for (const double noise : {0.0, 1e-16, 1e-13, 1e-9, 1e-6}) {
        const VectorXd column = dice.matrix(40, 1);
        MatrixXd a(40, kColumns);
        for (Index j = 0; j < kColumns; ++j) a.col(j) = column + noise * dice.matrix(40, 1);
        const VectorXd b = dice.matrix(40, 1);
        const MinimaxFit fit = minimax_fit(a, b);
        EXPECT_TRUE(fit.x.allFinite()) << "noise " << noise;
        EXPECT_TRUE(fit.weights.allFinite()) << "noise " << noise;
        // All zeros would err by this much.
        EXPECT_LE(fit.error, b.cwiseAbs().maxCoeff()) << "noise " << noise;
    }
}

// exp(-k l), k from 0.1 to 1, of which two dozen are one another's sums but for 1e-16.
TEST(Minimax, StaysFiniteForTwoDozenExponentials) {
    constexpr Index kColumns = 24;
    const ArrayXd l = ArrayXd::LinSpaced(60, 1.0, 5.0);
    MatrixXd a(60, kColumns);
    for (Index j = 0; j < kColumns; ++j) {
        a.col(j) = (-(0.1 + 0.9 * static_cast<double>(j) / (kColumns - 1)) * l).exp();
    }
    // The same integrated over k: well within their reach.
    const VectorXd b = ((-0.1 * l).exp() - (-l).exp()) / l;
    const MinimaxFit fit = minimax_fit(a, b);
    EXPECT_TRUE(fit.x.allFinite());
    EXPECT_LT(fit.error, 1e-9 * b.maxCoeff()) << "largest of x: " << fit.x.cwiseAbs().maxCoeff();
}

// The one thing that a larger ridge may not do. (A. E. Hoerl and R. W. Kennard, Technometrics
// 12, 1970: the solution's length falls, the sum of squares rises.)
TEST(Minimax, ShrinksUnderALargerRidge) {
    Dice dice(6);
    for (int trial = 0; trial < 10; ++trial) {
        MatrixXd a = dice.matrix(12, 3);
        a.col(2) = a.col(1) + 1e-3 * a.col(2);
        a = (a.array().rowwise() / a.array().abs().colwise().maxCoeff()).matrix();
        const VectorXd b = dice.matrix(12, 1);
        double last = std::numeric_limits<double>::infinity();
        for (const double ridge : {1e-7, 1e-5, 1e-3, 1e-2, 1e-1, 1.0}) {
            const double length =
                minimax_fit(a, b, {.iterations = 1, .ridge = ridge, .weights = {}}).x.norm();
            EXPECT_LE(length, last * (1.0 + kRounding)) << "trial " << trial << ", ridge " << ridge;
            last = length;
        }
    }
}

// --- Iterations and weights -------------------------------------------------------------------

TEST(Minimax, IsNeverWorseForMoreIterations) {
    Dice dice(9);
    for (int trial = 0; trial < 10; ++trial) {
        const MatrixXd a = dice.matrix(24, 1 + trial % 6);
        const VectorXd b = dice.matrix(24, 1);
        double last = std::numeric_limits<double>::infinity();
        for (int iterations = 1; iterations <= 40; ++iterations) {
            const double error = minimax_fit(a, b, {.iterations = iterations, .weights = {}}).error;
            EXPECT_LE(error, last) << "trial " << trial << ", " << iterations << " iterations";
            last = error;
        }
    }
}

// A start that has given up on the rows that matter: zero times anything stays zero, so it takes
// in an even share.
TEST(Minimax, RecoversFromWeightsThatAreZeroWhereItMatters) {
    const VectorXd b{{0.0, 1.0, 1.0, 1.0, 1.0, 10.0}};
    ArrayXd weights = ArrayXd::Zero(6);
    weights(2) = 1.0;
    const MinimaxFit fit =
        minimax_fit(MatrixXd::Ones(6, 1), b, {.iterations = kEnough, .weights = weights});
    EXPECT_NEAR(fit.error, 5.0, 5.0 * kRounding);
}

// --- Giving up --------------------------------------------------------------------------------

// Under weights that sum to 1 the least root mean square is a lower bound of the minimax error:
// whoever would end under give_up is never given up.
TEST(Minimax, NeverGivesUpAFitThatEndsUnderTheLimit) {
    constexpr double kAbove = 1.0 + 1e-9;
    Dice dice(13);
    for (int trial = 0; trial < 200; ++trial) {
        const Index columns = 1 + trial % 5;
        const MatrixXd a = dice.matrix(columns + 1 + trial % 20, columns);
        const VectorXd b = dice.matrix(a.rows(), 1);
        const MinimaxFit fit = minimax_fit(a, b);
        const MinimaxFit limited =
            minimax_fit(a, b, {.give_up = fit.error * kAbove, .weights = {}});
        EXPECT_EQ(limited.error, fit.error) << "trial " << trial;
        EXPECT_TRUE((limited.x.array() == fit.x.array()).all()) << "trial " << trial;
    }
}

TEST(Minimax, PretendsNothingWhenItGivesUp) {
    Dice dice(15);
    for (int trial = 0; trial < 40; ++trial) {
        const MatrixXd a = dice.matrix(8, 1 + trial % 3);
        const VectorXd b = dice.matrix(8, 1);
        const double right = exact_error(a, b);
        for (const double share : {0.01, 0.5, 0.9, 0.999}) {
            const double found = minimax_fit(a, b, {.give_up = share * right, .weights = {}}).error;
            EXPECT_GE(found, right * (1.0 - kRounding)) << "trial " << trial << ", share " << share;
            EXPECT_GT(found, share * right) << "trial " << trial;
        }
    }
}

// Numbers 0 and 1, half of each, by one constant: least squares errs by 1/2 everywhere, and so
// does every fit. A limit below that ends it after the first step.
TEST(Minimax, GivesUpAsSoonAsTheRootMeanSquareIsOver) {
    const VectorXd b{{0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.2, 0.8}};
    const MatrixXd a = MatrixXd::Ones(10, 1);
    const MinimaxFit first = minimax_fit(a, b, {.iterations = 1, .weights = {}});
    // Mean square: (8 * 0.25 + 2 * 0.09) / 10.
    const double root = std::sqrt(0.218);
    const MinimaxFit under = minimax_fit(a, b, {.give_up = root * (1.0 - 1e-9), .weights = {}});
    // It never came to weigh the rows anew.
    EXPECT_EQ(under.weights.minCoeff(), under.weights.maxCoeff());
    EXPECT_EQ(under.error, first.error);
    const MinimaxFit over = minimax_fit(a, b, {.give_up = root * (1.0 + 1e-9), .weights = {}});
    EXPECT_LT(over.weights.minCoeff(), over.weights.maxCoeff());
}

// --- Lower bounds -----------------------------------------------------------------------------

TEST(MinimaxLowerBounds, NeverExceedTheErrorOfTheWorstSetOfRows) {
    Dice dice(17);
    for (int trial = 0; trial < 60; ++trial) {
        const Index columns = trial % 3;
        const MatrixXd a = dice.matrix(8, columns);
        const VectorXd b = dice.matrix(8, 1);
        const MatrixXd candidate = dice.matrix(8, 1);
        const double right = exact_error(joined(a, candidate.col(0)), b);
        const double least = minimax_lower_bounds(a, b, candidate, dice.weights(8))(0);
        EXPECT_LE(least, right * (1.0 + kRounding)) << "trial " << trial;
    }
}

// What least squares leaves, by hand: b = (0, 1), the candidate (1, 1), equal weights. The best
// constant is 1/2 and errs by 1/2 at both.
TEST(MinimaxLowerBounds, AreTheRootMeanSquareThatIsLeft) {
    const VectorXd b{{0.0, 1.0}};
    const ArrayXd half = ArrayXd::Constant(2, 0.5);
    const MatrixXd none(2, 0);
    EXPECT_NEAR(minimax_lower_bounds(none, b, MatrixXd::Ones(2, 1), half)(0), 0.5, kRounding);
    // A candidate of zeros takes nothing away: sqrt((0 + 1) / 2).
    EXPECT_NEAR(
        minimax_lower_bounds(none, b, MatrixXd::Zero(2, 1), half)(0), std::sqrt(0.5), kRounding);
    // With both, nothing is left but the root of what rounding leaves of a square.
    constexpr double kRootOfRounding = 1e-7;
    const MatrixXd first{{1.0}, {0.0}};
    EXPECT_NEAR(
        minimax_lower_bounds(MatrixXd::Ones(2, 1), b, first, half)(0), 0.0, kRootOfRounding);
}

// Columns twice, candidates that are there already, weights of zero: never a number that is not
// one, and never over what a fit finds.
TEST(MinimaxLowerBounds, BearDependentColumnsAndRowsWithoutWeight) {
    Dice dice(19);
    for (int trial = 0; trial < 40; ++trial) {
        MatrixXd a = dice.matrix(12, 3);
        a.col(2) = a.col(0);
        if (trial % 2 == 0) a.col(1).setZero();
        const VectorXd b = dice.matrix(12, 1);
        MatrixXd candidates = dice.matrix(12, 4);
        candidates.col(1) = a.col(0);
        candidates.col(2).setZero();
        candidates.col(3) = b;
        ArrayXd weights = dice.weights(12);
        weights.head(trial % 11).setZero();
        weights /= weights.sum();
        const ArrayXd least = minimax_lower_bounds(a, b, candidates, weights);
        for (Index j = 0; j < 4; ++j) {
            const double found =
                minimax_fit(joined(a, candidates.col(j)), b, {.iterations = 200, .weights = {}})
                    .error;
            // b itself fits exactly; the root of what rounding leaves of a square.
            constexpr double kRootOfRounding = 1e-7;
            EXPECT_LE(least(j), found + kRootOfRounding) << "trial " << trial << ", " << j;
            EXPECT_GE(least(j), 0.0) << "trial " << trial << ", " << j;
        }
    }
}

}  // namespace
}  // namespace aphotic::minimax_test
