// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients and curvatures against differences of S as the header has it, which is written here a
// second time, in the plainest way.
#include "survey/fit/fit_objective.h"

#include "base/degrees.h"
#include "support/fit_rig.h"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <cmath>

namespace aphotic::fit_objective_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Central differences over tables of floats.
constexpr double kDifference = 2e-3;
constexpr double kStep = 2e-3;
constexpr Index kQ = kChannels;

FitOptions exact_poses() {
    FitOptions options;
    options.altitude_error_m = 0.0;
    options.attitude_error_rad = 0.0;
    return options;
}

// Maps with noise, and a point near their rig with a texture that is not learned from them.
struct Fitted {
    RigText text;
    FitSamples samples;
    FitLight light;
    FitProblem problem;
    FitObjective objective;
    FitPoint point;

    explicit Fitted(const FitOptions& options)
        : text(fit_rig({.width_px = 16, .height_px = 12})),
          samples(fit_samples_of(text.rig(), {{.altitude_m = 1.5}, {.altitude_m = 2.2}}, 0.05, 7)),
          light(text.rig(), samples.places),
          problem(fit_problem(text, options, 1.0, light.block_rad())),
          objective(text, samples, options, light, problem),
          point(objective.first_point()) {
        for (Index k = 0; k < point.x.size(); ++k)
            point.x(k) += 0.02 * std::sin(3.0 * static_cast<double>(k + 1));
        MatrixXd scale(kQ, kQ);
        scale << 0.05, 0.02, 0.01, 0.02, 0.04, 0.02, 0.01, 0.02, 0.06;
        for (MatrixXd& level : point.texture.details) level = scale * scale;
        point.texture.level = 4.0 * scale * scale;
        point.dispersion = 2.0;
    }
};

double rho(double nu, const VectorXd& d, const MatrixXd& scale) {
    return (nu + kQ) * std::log1p(d.dot(scale.inverse() * d) / nu);
}

// S of the header, without determinants, of images by their dispersion; poses are exact.
double S_of(const Fitted& fitted, const FitPoint& point) {
    const FitModel model = fitted.objective.model_at(point.x);
    const auto across = static_cast<Index>(fitted.samples.places.across());
    double S = 0.0;
    for (std::size_t i = 0; i < fitted.samples.images.size(); ++i) {
        const ImageView view = fitted.objective.view(point, model, i);
        const VectorXd residual = view.rows.col(0);
        const Index places = residual.size() / kQ;
        VectorXd mean = VectorXd::Zero(kQ);
        std::vector<VectorXd> cells;
        for (Index place = 0; place < places; ++place) {
            cells.emplace_back(residual.segment(place * kQ, kQ));
            mean += cells.back() / static_cast<double>(places);
        }
        S += rho(kLevelFreedom, mean, point.texture.level);
        Index width = across;
        Index height = places / across;
        for (const MatrixXd& scale : point.texture.details) {
            std::vector<VectorXd> coarser;
            for (Index y = 0; y + 1 < height; y += 2) {
                for (Index x = 0; x + 1 < width; x += 2) {
                    const auto at = [&](Index dx, Index dy) {
                        return cells[static_cast<std::size_t>((y + dy) * width + x + dx)];
                    };
                    const VectorXd a = at(0, 0);
                    const VectorXd b = at(1, 0);
                    const VectorXd c = at(0, 1);
                    const VectorXd d = at(1, 1);
                    for (const VectorXd& detail : {VectorXd(b + d - a - c),
                                                   VectorXd(c + d - a - b),
                                                   VectorXd(a + d - b - c)})
                        S += rho(kDetailFreedom, 0.5 * detail, scale);
                    coarser.emplace_back((a + b + c + d) / 4.0);
                }
            }
            cells = coarser;
            width /= 2;
            height /= 2;
        }
    }
    const auto numbers = std::ssize(fitted.problem.numbers);
    return S / point.dispersion +
           (fitted.problem.prior_rows * point.x.head(numbers) - fitted.problem.prior_means)
               .squaredNorm();
}

TEST(FitObjective, GradientsAreThoseOfS) {
    const Fitted fitted(exact_poses());
    const VectorXd g = fitted.objective.gradient_of(
        fitted.point, fitted.objective.terms_at(fitted.point, Curvature::Majorant));
    for (Index k = 0; k < g.size(); ++k) {
        FitPoint more = fitted.point;
        FitPoint less = fitted.point;
        more.x(k) += kStep;
        less.x(k) -= kStep;
        const double wanted = -0.5 * (S_of(fitted, more) - S_of(fitted, less)) / (2.0 * kStep);
        EXPECT_NEAR(g(k), wanted, kDifference * (g.cwiseAbs().maxCoeff() * 1e-2 + std::abs(wanted)))
            << k;
    }
}

// The floor's mean level is the one number that logarithms are linear in: there S bends as the t
// alone does.
TEST(FitObjective, ObservedCurvatureIsThatOfS) {
    const Fitted fitted(exact_poses());
    const auto gradient = [&](const FitPoint& point) {
        return fitted.objective.gradient_of(point,
                                            fitted.objective.terms_at(point, Curvature::Majorant));
    };
    const MatrixXd A =
        fitted.objective.curvature_of(fitted.objective.terms_at(fitted.point, Curvature::Observed));
    for (Index k = A.rows() - kQ; k < A.rows(); ++k) {
        constexpr double kFine = 1e-4;
        FitPoint more = fitted.point;
        FitPoint less = fitted.point;
        more.x(k) += kFine;
        less.x(k) -= kFine;
        const VectorXd bend = (gradient(less) - gradient(more)) / (2.0 * kFine);
        for (Index j = A.rows() - kQ; j < A.rows(); ++j)
            EXPECT_NEAR(A(k, j), bend(j), 1e-5 * A.diagonal().maxCoeff()) << k << ' ' << j;
    }
}

// Images of a pose that is 3 cm and a degree off, and all else known: the light tells it.
TEST(FitObjective, TellsPosesByTheLight) {
    FitOptions options;
    options.altitude_error_m = 0.05;
    options.attitude_error_rad = 2.0 * kRadiansPerDegree;
    options.free = {{"water"}};
    Fitted fitted(options);
    const Vector3d off(0.03, 1.0 * kRadiansPerDegree, -1.0 * kRadiansPerDegree);
    fitted.samples =
        fit_samples_of(fitted.text.rig(),
                       {{.altitude_m = 1.5 + off.x(), .pitch_rad = off.y(), .roll_rad = off.z()},
                        {.altitude_m = 2.2}},
                       0.001,
                       7);
    fitted.samples.images[0].sled = {.altitude_m = 1.5};
    const FitPoint point =
        fitted.objective.search(fitted.objective.first_point(), 0.01, [](int) {});
    constexpr double kTold_m = 0.005;
    constexpr double kTold_rad = 0.1 * kRadiansPerDegree;
    EXPECT_NEAR(point.pose[0].x(), off.x(), kTold_m);
    EXPECT_NEAR(point.pose[0].y(), off.y(), kTold_rad);
    EXPECT_NEAR(point.pose[0].z(), off.z(), kTold_rad);
    EXPECT_NEAR(point.pose[1].y(), 0.0, kTold_rad);
}

// A scale is learned with all else: noise of 5 % in each channel by itself.
TEST(FitObjective, LearnsTheTexture) {
    const Fitted fitted(exact_poses());
    const FitPoint point =
        fitted.objective.search(fitted.objective.first_point(), 0.05, [](int) {});
    // Of Gaussian noise a t of two degrees of freedom and three channels finds a scale s with
    // E[5 d^2 / (2 s^2 + D^2)] = s^2, D of all three: 0.815 of its standard deviation (by two
    // million draws).
    constexpr double kOfGaussian = 0.815;
    constexpr double kFew = 0.15;  // 144 details of two images
    for (Index c = 0; c < kQ; ++c)
        EXPECT_NEAR(std::sqrt(point.texture.details.front()(c, c)), kOfGaussian * 0.05, kFew * 0.05)
            << c;
}

}  // namespace
}  // namespace aphotic::fit_objective_test
