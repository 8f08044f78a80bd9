// SPDX-License-Identifier: BSD-3-Clause
//
// The quantity that a fit minimises: the negative log probability of the images and the prior.
//
//   ln y_bc = ln L_bc(p; pose) + mu_c + x_bc
//
// y    the signal of a block in a channel (fit_samples.h)       mu   the floor's mean level
// L    its light (fit_light.h)                                  x    the floor's texture
//
//   S = sum over Haar's details of all levels  rho_2(d; Sigma_l)    d  of x, in q channels
//     + sum over images                        rho_4(m; Psi)        m  the mean of x
//     + sum over images  (poses' errors)^2 / variance
//     + |R x - r|^2                                                 (fit_problem.h)
//   rho_nu(d; Sigma) = (nu + q) ln(1 + d^T Sigma^-1 d / nu) + ln det Sigma
//
// A floor is a rough field, with stones and patches of every size. The Haar details of such fields
// are nearly independent (right half less left, lower less upper, and across, of cells of 2, 4, 8
// blocks and so on), and their variances by level are the field's spectrum, whatever it is: 1/k^2
// and pink noise alike. They are multivariate t with two degrees of freedom, which allows for edges
// of patches and shadows of stones. An image's level has four degrees of freedom: how it varies
// with altitude constrains the water, and a black or white floor must count as an outlier. Sigma
// and Psi are learned along with all else by maximum likelihood: the mean of w d d^T,
// w = (nu + q)/(nu + d^T Sigma^-1 d). Each also has kFirst observations of its initial scale, since
// a few images without texture would give none.
//
// An image's errors of altitude, pitch and roll are numbers of its own, eliminated from its normal
// equations, and updated with each step. Where its blocks have planes of their own, they have no
// effect and stay 0.
//
// The details of one image are correlated: a stone is seen by several, a shadow by many. They
// therefore carry less information than S implies, by the dispersion phi of the images' gradients
// over their curvatures, and S is divided by it before the prior is added: 1 on white floors, 3
// on patchy ones (fit_errors.h).
//
// The search is Gauss-Newton with the t's weights (iteratively reweighted least squares). Along the
// valley of aims that compensate for each other, the floor's texture curves S as much as the light
// does, and steps are short: Anderson acceleration lengthens them. None exceeds kLongestStep prior
// spreads.
//
// K. L. Lange, R. J. A. Little and J. M. G. Taylor, J. Am. Stat. Assoc. 84, 1989, 881 (multivariate
// t); G. W. Wornell, Proc. IEEE 81, 1993, 1428 (wavelets of 1/f processes); H. F. Walker and P. Ni,
// SIAM J. Numer. Anal. 49, 2011, 1715 (Anderson's acceleration).
#pragma once

#include "survey/fit/fit_light.h"
#include "survey/fit/fit_problem.h"
#include "survey/fit/fit_samples.h"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <vector>

namespace aphotic {

inline constexpr double kDetailFreedom = 2.0;
inline constexpr double kLevelFreedom = 4.0;
inline constexpr double kFirstLevel = 0.1;
inline constexpr double kFirstDetail = 1e-4;
inline constexpr double kFirst = 1.0;
inline constexpr double kFirstDispersion = 3.0;
inline constexpr double kLongestStep = 0.75;
inline constexpr int kMostRounds = 40;
// A block counts if its light is at least this share of the image's brightest: below it, noise is
// not proportional to the signal.
inline constexpr double kDarkestBlock = 0.01;

// Sigma, from cells of 2 x 2 blocks up, and Psi.
struct TextureScales {
    std::vector<Eigen::MatrixXd> details;
    Eigen::MatrixXd level;
};

struct FitPoint {
    Eigen::VectorXd x;                  // the problem's numbers, then mu
    std::vector<Eigen::Vector3d> pose;  // by image, relative to the navigation
    TextureScales texture;
    double dispersion = kFirstDispersion;
};

// The rig at a point, and its light by path.
struct FitModel {
    FitState state;
    PathLight light;
};

// An image at a point. Columns: the residual, that is its blocks' logarithms less the model's, then
// the model's slopes over the point's x, then those over the pose. Residuals are NaN of blocks that
// do not count.
struct ImageView {
    BlockLight light;
    BlockLight::Rows rows{};   // by place, then channel
    BlockLight::Rows level{};  // their mean, by channel
    std::size_t blocks = 0;
};

// Which second derivative of S: that of its majorant, used by the search; its own; or that expected
// of future images.
enum class Curvature { Majorant, Observed, Expected };

// An image's contribution to half of S's negative gradient and curvature, its pose eliminated.
struct ImageTerms {
    Eigen::MatrixXd H;
    Eigen::VectorXd g;
    Eigen::MatrixXd pose_answer;  // the pose's step: constant, then by -dx
    TextureScales moments;        // sums of w d d^T
    std::vector<double> weights;  // sums of w: of details by level, then of the level
};

class FitObjective {
  public:
    FitObjective(const RigText& rig,
                 const FitSamples& samples,
                 const FitOptions& options,
                 const FitLight& light,
                 const FitProblem& problem);

    // The rig itself, with the level and the texture that fit it best.
    [[nodiscard]] FitPoint first_point() const;
    // The point of least S, starting there; nearness: to a share of the numbers' errors.
    [[nodiscard]] FitPoint search(FitPoint point,
                                  double nearness,
                                  const std::function<void(int round)>& progress) const;

    // By image, at a point.
    [[nodiscard]] std::vector<ImageTerms> terms_at(const FitPoint& point,
                                                   Curvature curvature) const;
    // The contribution of one more image.
    [[nodiscard]] Eigen::MatrixXd information_at(const FitPoint& point, const Sled& sled) const;
    // The sum of R^T R and the images' curvature, over x.
    [[nodiscard]] Eigen::MatrixXd curvature_of(const std::vector<ImageTerms>& terms) const;

    // The negative gradient of half of S.
    [[nodiscard]] Eigen::VectorXd gradient_of(const FitPoint& point,
                                              const std::vector<ImageTerms>& terms) const;

    [[nodiscard]] FitModel model_at(const Eigen::VectorXd& x) const;
    // An image's pose: the navigation's, corrected.
    [[nodiscard]] Sled sled_at(const FitPoint& point, std::size_t image) const;
    [[nodiscard]] ImageView view(const FitPoint& point,
                                 const FitModel& model,
                                 std::size_t image) const;
    // Whether enough blocks of an image are lit and observed.
    [[nodiscard]] bool counts(const ImageView& view) const {
        return 2 * view.blocks >= samples_.places.size();
    }
    [[nodiscard]] std::size_t channels() const { return channels_; }

  private:
    [[nodiscard]] ImageTerms terms_of(const ImageView& view,
                                      const FitPoint& point,
                                      const Eigen::Vector3d& pose,
                                      Curvature curvature) const;
    [[nodiscard]] ImageView view_of(const FitPoint& point,
                                    const FitModel& model,
                                    const Sled& sled,
                                    const FitImage* image) const;
    [[nodiscard]] Eigen::VectorXd within_bounds(const Eigen::VectorXd& x, Eigen::VectorXd dx) const;
    void learn_texture(const std::vector<ImageTerms>& terms, TextureScales& texture) const;

    const RigText& rig_;
    const FitSamples& samples_;
    const FitLight& light_;
    const FitProblem& problem_;
    PathRange paths_;
    int threads_;
    std::size_t channels_;
    std::size_t levels_;           // of details
    Eigen::Vector3d pose_weight_;  // 1/variance; infinite: exact poses
};

}  // namespace aphotic
