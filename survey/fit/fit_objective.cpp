// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_objective.h"

#include "base/error.h"
#include "base/parallel.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr Index kPoseNumbers = FitLight::kPose;
constexpr double kFirstTexture = 0.2;
constexpr int kRoundsOfTexture = 3;  // at the start

// W with W^T W = Sigma^-1.
MatrixXd whitening(const MatrixXd& scale) {
    return scale.llt().matrixL().solve(MatrixXd::Identity(scale.rows(), scale.cols()));
}

// Weights of residuals of variance 1, with a row of slopes each.
struct Weighed {
    double freedom;
    double channels;
    Curvature curvature;

    // w for the whitened residual d.
    [[nodiscard]] double weight(const VectorXd& d) const {
        if (curvature == Curvature::Expected)
            return (freedom + channels) / (freedom + channels + 2.0);
        return (freedom + channels) / (freedom + d.squaredNorm());
    }
    // For -(2 w^2 / (nu + q)) J^T d d^T J, the factor of J^T d.
    [[nodiscard]] double bend(double w) const { return w * std::sqrt(2.0 / (freedom + channels)); }
};

// Means over cells of a grid, of the residual and of its slopes.
struct Cells {
    Index across;
    Index down;
    Index q;
    BlockLight::Rows rows;  // an ImageView's

    // The means of 2 x 2 cells; `take` receives the three details where all four have a mean. An
    // odd last row or column is dropped.
    template <typename Take>
    [[nodiscard]] Cells halved(const Take& take) const {
        Cells half{across / 2, down / 2, q, {}};
        half.rows.setConstant(
            half.across * half.down * q, rows.cols(), std::numeric_limits<double>::quiet_NaN());
        BlockLight::Rows sum(q, rows.cols());
        // Right less left, lower less upper, and across.
        constexpr std::array<std::array<double, 4>, 3> kSigns{
            {{-1.0, 1.0, -1.0, 1.0}, {-1.0, -1.0, 1.0, 1.0}, {1.0, -1.0, -1.0, 1.0}}};
        for (Index cell = 0; cell < half.across * half.down; ++cell) {
            const Index first = (cell / half.across * 2 * across + cell % half.across * 2) * q;
            const std::array<Index, 4> parts{
                first, first + q, first + across * q, first + (across + 1) * q};
            double seen = 0.0;
            sum.setZero();
            for (const Index part : parts) {
                if (!rows.col(0).segment(part, q).allFinite()) continue;
                seen += 1.0;
                sum += rows.middleRows(part, q);
            }
            if (seen > 0.0) half.rows.middleRows(cell * q, q) = sum / seen;
            if (seen < 4.0) continue;
            const auto part = [&](std::size_t k) { return rows.middleRows(parts[k], q); };
            for (const auto& signs : kSigns) {
                sum = 0.5 * (signs[0] * part(0) + signs[1] * part(1) + signs[2] * part(2) +
                             signs[3] * part(3));
                take(sum);
            }
        }
        return half;
    }
};

// Anderson acceleration: where steps progress slowly along a valley, it extrapolates the last few
// linearly.
class Anderson {
  public:
    // The step to take from x instead of dx. errors: the scales by which numbers compare.
    VectorXd step(const VectorXd& x, const VectorXd& dx, const VectorXd& errors) {
        if (x_.size() > 0) {
            keep(moves_, x - x_);
            keep(changes_, dx - dx_);
        }
        x_ = x;
        dx_ = dx;
        if (moves_.cols() == 0) return dx;
        const MatrixXd F = errors.cwiseInverse().asDiagonal() * changes_;
        const MatrixXd normal = F.transpose() * F;
        const MatrixXd tied =
            normal + kTie * normal.trace() * MatrixXd::Identity(normal.rows(), normal.cols());
        return dx -
               (moves_ + changes_) * tied.llt().solve(F.transpose() * dx.cwiseQuotient(errors));
    }

  private:
    static constexpr Index kDepth = 3;
    static constexpr double kTie = 1e-6;
    static void keep(MatrixXd& last, const VectorXd& next) {
        const Index kept = std::min(last.cols(), kDepth - 1);
        MatrixXd longer(next.size(), kept + 1);
        if (kept > 0) longer.leftCols(kept) = last.rightCols(kept);
        longer.col(kept) = next;
        last = std::move(longer);
    }

    VectorXd x_;
    VectorXd dx_;
    MatrixXd moves_;    // the latest in the last column
    MatrixXd changes_;  // of dx
};

}  // namespace

FitObjective::FitObjective(const RigText& rig,
                           const FitSamples& samples,
                           const FitOptions& options,
                           const FitLight& light,
                           const FitProblem& problem)
    : rig_(rig),
      samples_(samples),
      light_(light),
      problem_(problem),
      threads_(options.threads),
      channels_(rig.rig().camera.sensor.is_mono() ? 1 : kChannels),
      levels_(0),
      pose_weight_(1.0 / (options.altitude_error_m * options.altitude_error_m),
                   1.0 / (options.attitude_error_rad * options.attitude_error_rad),
                   1.0 / (options.attitude_error_rad * options.attitude_error_rad)) {
    paths_ = light.paths(samples.images);
    const std::size_t across = samples.places.across();
    const std::size_t down = samples.places.down();
    while ((std::min(across, down) >> (levels_ + 1)) > 0) ++levels_;
}

FitModel FitObjective::model_at(const VectorXd& x) const {
    const FitState state = problem_.state_at(x.head(std::ssize(problem_.numbers)));
    return {state, {rig_, state.water, state.tint, paths_}};
}

Sled FitObjective::sled_at(const FitPoint& point, std::size_t image) const {
    Sled sled = samples_.images[image].sled;
    const Vector3d& off = point.pose[image];
    sled.altitude_m += off.x();
    sled.pitch_rad += off.y();
    sled.roll_rad += off.z();
    return sled;
}

ImageView FitObjective::view(const FitPoint& point,
                             const FitModel& model,
                             std::size_t image) const {
    return view_of(point, model, sled_at(point, image), &samples_.images[image]);
}

// Without an image the residual is 0, on the sled's plane.
ImageView FitObjective::view_of(const FitPoint& point,
                                const FitModel& model,
                                const Sled& sled,
                                const FitImage* image) const {
    ImageView view{.light = light_.at(model.state,
                                      model.light,
                                      sled,
                                      problem_.places(),
                                      image == nullptr ? std::vector<Plane>() : image->planes)};
    const auto q = static_cast<Index>(channels_);
    const auto numbers = std::ssize(problem_.numbers);
    const auto places = static_cast<Index>(samples_.places.size());
    view.rows.setZero(places * q, 1 + numbers + q + kPoseNumbers);
    view.rows.col(0).setConstant(std::numeric_limits<double>::quiet_NaN());
    view.level.setZero(q, view.rows.cols());
    double brightest = -std::numeric_limits<double>::infinity();
    for (const double logarithm : view.light.logarithm)
        if (logarithm > brightest) brightest = logarithm;  // false for NaN
    const double darkest = brightest + std::log(kDarkestBlock);
    VectorXd slope(numbers);
    for (Index k = 0; k < numbers; ++k)
        slope(k) = problem_.numbers[static_cast<std::size_t>(k)].slope(point.x(k));
    for (Index place = 0; place < places; ++place) {
        VectorXd off(q);
        for (Index c = 0; c < q; ++c) {
            const Index row = place * kChannels + c;
            const double lit = view.light.logarithm(row);
            const double seen =
                image == nullptr ? 0.0 : image->signal[static_cast<std::size_t>(row)];
            off(c) = image == nullptr ? 0.0 : std::log(seen) - lit - point.x(numbers + c);
            if (!(lit > darkest) || (image != nullptr && !(seen > 0.0)))
                off(c) = std::numeric_limits<double>::quiet_NaN();
        }
        if (!off.allFinite()) continue;
        auto rows = view.rows.middleRows(place * q, q);
        rows << off, view.light.slopes.middleRows(place * kChannels, q) * slope.asDiagonal(),
            MatrixXd::Identity(q, q), view.light.by_pose.middleRows(place * kChannels, q);
        view.level += rows;
        ++view.blocks;
    }
    if (view.blocks > 0) view.level /= static_cast<double>(view.blocks);
    return view;
}

ImageTerms FitObjective::terms_of(const ImageView& view,
                                  const FitPoint& point,
                                  const Vector3d& pose,
                                  Curvature curvature) const {
    const auto q = static_cast<Index>(channels_);
    const Index columns = view.rows.cols();
    const Index kept = columns - 1 - kPoseNumbers;
    ImageTerms terms{.H = MatrixXd::Zero(kept, kept),
                     .g = VectorXd::Zero(kept),
                     .pose_answer = MatrixXd::Zero(kPoseNumbers, kept + 1),
                     .moments = {{levels_, MatrixXd::Zero(q, q)}, MatrixXd::Zero(q, q)},
                     .weights = std::vector<double>(levels_ + 1, 0.0)};
    if (!counts(view)) return terms;
    const Weighed levels{kLevelFreedom, static_cast<double>(q), curvature};
    const Weighed details{kDetailFreedom, static_cast<double>(q), curvature};
    const auto most = (static_cast<Index>(samples_.places.size()) + 1) * q;
    BlockLight::Rows rows(most, columns);  // times the root of their weights
    BlockLight::Rows bends(most / q, columns);
    Index used = 0;
    BlockLight::Rows white(q, columns);
    const auto add = [&](const Weighed& weighed,
                         const MatrixXd& W,
                         const BlockLight::Rows& mean,
                         MatrixXd& moments,
                         double& weights) {
        white.noalias() = W.lazyProduct(mean);  // a general product packs its factors first
        const VectorXd off = white.col(0);
        const double w = weighed.weight(off);
        rows.middleRows(used * q, q) = std::sqrt(w) * white;
        if (curvature == Curvature::Observed)
            bends.row(used).noalias() = weighed.bend(w) * off.transpose().lazyProduct(white);
        moments += w * mean.col(0) * mean.col(0).transpose();
        weights += w;
        ++used;
    };
    add(levels,
        whitening(point.texture.level),
        view.level,
        terms.moments.level,
        terms.weights.back());

    Cells cells{static_cast<Index>(samples_.places.across()),
                static_cast<Index>(samples_.places.down()),
                q,
                view.rows};
    for (std::size_t level = 0; level < levels_; ++level) {
        const MatrixXd W = whitening(point.texture.details[level]);
        cells = cells.halved([&](const BlockLight::Rows& detail) {
            add(details, W, detail, terms.moments.details[level], terms.weights[level]);
        });
    }
    MatrixXd H = MatrixXd::Zero(columns, columns);
    H.selfadjointView<Eigen::Lower>().rankUpdate(rows.topRows(used * q).transpose());
    if (curvature == Curvature::Observed) {
        bends.col(0).setZero();
        H.selfadjointView<Eigen::Lower>().rankUpdate(bends.topRows(used).transpose(), -1.0);
    }
    H = H.selfadjointView<Eigen::Lower>();
    H /= point.dispersion;
    // The residual's column is the gradient; the pose is eliminated.
    MatrixXd known = H.block(1, 0, kept, 1 + kept);
    if (pose_weight_.allFinite()) {
        MatrixXd other = H.bottomLeftCorner(kPoseNumbers, 1 + kept);
        other.col(0) -= pose_weight_.cwiseProduct(pose);
        const Eigen::Matrix3d own =
            H.bottomRightCorner<3, 3>() + Eigen::Matrix3d(pose_weight_.asDiagonal());
        terms.pose_answer = own.ldlt().solve(other);
        known -= H.block(1, 1 + kept, kept, kPoseNumbers) * terms.pose_answer;
    }
    terms.g = known.col(0);
    terms.H = known.rightCols(kept);
    return terms;
}

std::vector<ImageTerms> FitObjective::terms_at(const FitPoint& point, Curvature curvature) const {
    const FitModel model = model_at(point.x);
    std::vector<ImageTerms> terms(samples_.images.size());
    parallel_for(terms.size(), static_cast<std::size_t>(threads_), [&](std::size_t i, std::size_t) {
        terms[i] = terms_of(view(point, model, i), point, point.pose[i], curvature);
    });
    return terms;
}

MatrixXd FitObjective::information_at(const FitPoint& point, const Sled& sled) const {
    const ImageView view = view_of(point, model_at(point.x), sled, nullptr);
    return terms_of(view, point, Vector3d::Zero(), Curvature::Expected).H;
}

MatrixXd FitObjective::curvature_of(const std::vector<ImageTerms>& terms) const {
    const auto numbers = std::ssize(problem_.numbers);
    const auto all = numbers + static_cast<Index>(channels_);
    MatrixXd A = MatrixXd::Zero(all, all);
    A.topLeftCorner(numbers, numbers) = problem_.prior_rows.transpose() * problem_.prior_rows;
    for (const ImageTerms& one : terms) A += one.H;
    return A;
}

VectorXd FitObjective::gradient_of(const FitPoint& point,
                                   const std::vector<ImageTerms>& terms) const {
    const auto numbers = std::ssize(problem_.numbers);
    VectorXd g = VectorXd::Zero(point.x.size());
    g.head(numbers) = problem_.prior_rows.transpose() *
                      (problem_.prior_means - problem_.prior_rows * point.x.head(numbers));
    for (const ImageTerms& one : terms) g += one.g;
    return g;
}

void FitObjective::learn_texture(const std::vector<ImageTerms>& terms,
                                 TextureScales& texture) const {
    const auto q = static_cast<Index>(channels_);
    std::vector<double> weights(levels_ + 1, kFirst);
    texture.level = kFirst * kFirstLevel * kFirstLevel * MatrixXd::Identity(q, q);
    texture.details.assign(levels_,
                           kFirst * kFirstDetail * kFirstDetail * MatrixXd::Identity(q, q));
    for (const ImageTerms& one : terms) {
        texture.level += one.moments.level;
        for (std::size_t level = 0; level < levels_; ++level)
            texture.details[level] += one.moments.details[level];
        for (std::size_t level = 0; level <= levels_; ++level) weights[level] += one.weights[level];
    }
    texture.level /= weights.back();
    for (std::size_t level = 0; level < levels_; ++level) texture.details[level] /= weights[level];
}

FitPoint FitObjective::first_point() const {
    const auto q = static_cast<Index>(channels_);
    const auto numbers = std::ssize(problem_.numbers);
    FitPoint point{.x = VectorXd::Zero(numbers + q),
                   .pose = std::vector<Vector3d>(samples_.images.size(), Vector3d::Zero()),
                   .texture = {{levels_, kFirstTexture * kFirstTexture * MatrixXd::Identity(q, q)},
                               MatrixXd::Identity(q, q)}};
    const FitModel model = model_at(point.x);
    VectorXd level = VectorXd::Zero(q);
    double images = 0.0;
    for (std::size_t i = 0; i < samples_.images.size(); ++i) {
        const ImageView seen = view(point, model, i);
        if (!counts(seen)) continue;
        level += seen.level.col(0);
        images += 1.0;
    }
    if (images == 0.0)
        throw InputError(
            "found no image with half of its blocks lit by the rig and observed; allowed: images "
            "that are neither black nor saturated, of a rig that lights them");
    point.x.tail(q) = level / images;
    for (int round = 0; round < kRoundsOfTexture; ++round)
        learn_texture(terms_at(point, Curvature::Majorant), point.texture);
    return point;
}

FitPoint FitObjective::search(FitPoint point,
                              double nearness,
                              const std::function<void(int round)>& progress) const {
    Anderson anderson;
    for (int round = 0; round < kMostRounds; ++round) {
        progress(round);
        const std::vector<ImageTerms> terms = terms_at(point, Curvature::Majorant);
        const VectorXd g = gradient_of(point, terms);
        const Eigen::LLT<MatrixXd> solver(curvature_of(terms));
        VectorXd dx = solver.solve(g);
        const VectorXd errors =
            solver.solve(MatrixXd::Identity(dx.size(), dx.size())).diagonal().cwiseSqrt();
        dx = within_bounds(point.x, anderson.step(point.x, dx, errors));
        point.x += dx;
        for (std::size_t i = 0; i < terms.size(); ++i) {
            const MatrixXd& answer = terms[i].pose_answer;
            point.pose[i] += answer.col(0) - answer.rightCols(dx.size()) * dx;
        }
        learn_texture(terms, point.texture);
        constexpr int kFewestRounds = 6;  // steps are short until Anderson acceleration starts
        if (round + 1 >= kFewestRounds && (dx.cwiseAbs().array() < nearness * errors.array()).all())
            break;
    }
    return point;
}

// At most kLongestStep spreads, and within each number's bounds.
VectorXd FitObjective::within_bounds(const VectorXd& x, VectorXd dx) const {
    double share = 1.0;
    for (std::size_t k = 0; k < problem_.numbers.size(); ++k)
        share = std::min(
            share, kLongestStep * problem_.numbers[k].spread / std::abs(dx(static_cast<Index>(k))));
    dx *= share;
    for (std::size_t k = 0; k < problem_.numbers.size(); ++k) {
        const FitNumber& number = problem_.numbers[k];
        const auto at = static_cast<Index>(k);
        dx(at) = std::clamp(x(at) + dx(at), number.least, number.most) - x(at);
    }
    return dx;
}

}  // namespace aphotic
