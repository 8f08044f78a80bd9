// SPDX-License-Identifier: BSD-3-Clause
//
// What a fit minimises: the negative logarithm of a probability, of the images and of what is known
// beforehand.
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
// A floor is a rough field: there are stones and patches of every size. Of such fields Haar's
// details are nearly independent (right half less left, lower less upper, and across, of cells of
// 2, 4, 8 blocks and so on), and their variances by level are the field's spectrum, whatever it is:
// 1/k^2 and pink noise alike. They are multivariate t with two degrees of freedom, of which edges
// of patches and shades of stones are no surprise. An image's level has four: it carries what the
// altitude tells of the water, and forgives a black floor or a white one. Sigma and Psi are learned
// with all else, as maximum likelihood has them: the mean of w d d^T, w = (nu + q)/(nu + d^T
// Sigma^-1 d). Each has kFirst observations of the scale that it begins with besides, for a few
// images without texture would have none.
//
// An image's errors of altitude, pitch and roll are numbers of its own, eliminated from its normal
// equations, and moved with each step. On planes of its own blocks they do nothing, and stay 0.
//
// Details of one image hang together: a stone is seen by several, a shadow by many. What they tell
// is therefore less than S says, by the dispersion phi of the images' gradients over their
// curvatures, and S is divided by it where it meets what is known beforehand: 1 on white floors, 3
// on patchy ones (fit_errors.h).
//
// The search is Gauss and Newton's, with the t's weights (iteratively reweighted least squares).
// Along the valley of aims that make up for each other the floor's texture bends S as much as the
// light does, and its steps are short: Anderson's acceleration makes them long. None is longer than
// kLongestStep spreads of what is known beforehand.
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
// A block counts where its light is at least this share of the image's brightest: below, noise is
// no share of the signal.
inline constexpr double kDarkestBlock = 0.01;

// Sigma, from cells of 2 x 2 blocks on, and Psi.
struct TextureScales {
    std::vector<Eigen::MatrixXd> details;
    Eigen::MatrixXd level;
};

struct FitPoint {
    Eigen::VectorXd x;                  // the problem's numbers, then mu
    std::vector<Eigen::Vector3d> pose;  // by image, off the navigation's
    TextureScales texture;
    double dispersion = kFirstDispersion;
};

// Of an image at a point: its blocks' logarithms less the model's, and the model's slopes.
struct ImageView {
    BlockLight light;
    Eigen::VectorXd residual{};  // by place, then channel; NaN where a block does not count
    BlockLight::Rows slopes{};   // over the point's x, then the pose
    Eigen::VectorXd level{};     // mean of the residual, by channel
    BlockLight::Rows level_slopes{};
    std::size_t blocks = 0;
};

// Which second derivative of S: that of its majorant, by which the search goes; its own; or what is
// to be expected of images that are not there yet.
enum class Curvature { Majorant, Observed, Expected };

// What an image adds to half of S's gradient (negative) and curvature, its pose eliminated.
struct ImageTerms {
    Eigen::MatrixXd H;
    Eigen::VectorXd g;
    Eigen::MatrixXd pose_answer;  // of the pose's step: to 1, then to -dx
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

    // Where the rig is, with the level and the texture that fit best there.
    [[nodiscard]] FitPoint first_point() const;
    // The point of least S from there, to a share of the numbers' errors.
    [[nodiscard]] FitPoint search(FitPoint point,
                                  double nearness,
                                  const std::function<void(int round)>& progress) const;

    // The images of which enough is lit and seen, at a point.
    [[nodiscard]] std::vector<std::size_t> counted(const FitPoint& point) const;
    // By image, at a point.
    [[nodiscard]] std::vector<ImageTerms> terms_at(const FitPoint& point,
                                                   Curvature curvature) const;
    // What one more image would add.
    [[nodiscard]] Eigen::MatrixXd information_at(const FitPoint& point, const Sled& sled) const;
    // R^T R and the images', over x.
    [[nodiscard]] Eigen::MatrixXd curvature_of(const std::vector<ImageTerms>& terms) const;

    // Of half of S, negative.
    [[nodiscard]] Eigen::VectorXd gradient_of(const FitPoint& point,
                                              const std::vector<ImageTerms>& terms) const;

    [[nodiscard]] PathLight path_light(const FitState& state) const;
    [[nodiscard]] ImageView view(const FitPoint& point,
                                 const FitState& state,
                                 const PathLight& light,
                                 std::size_t image) const;
    [[nodiscard]] std::size_t channels() const { return channels_; }
    [[nodiscard]] FitState state_at(const FitPoint& point) const {
        return problem_.state_at(point.x.head(std::ssize(problem_.numbers)));
    }

  private:
    [[nodiscard]] bool counts(const ImageView& view) const {
        return 2 * view.blocks >= samples_.places.size();
    }
    [[nodiscard]] ImageTerms terms_of(const ImageView& view,
                                      const FitPoint& point,
                                      const Eigen::Vector3d& pose,
                                      Curvature curvature) const;
    [[nodiscard]] ImageView view_of(const FitPoint& point,
                                    const FitState& state,
                                    const PathLight& light,
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
    Eigen::Vector3d pose_weight_;  // 1/variance; infinite: they are exact
};

}  // namespace aphotic
