// SPDX-License-Identifier: BSD-3-Clause
#include "survey/relief/local_planes.h"

#include "base/upper_median.h"
#include "image/image_size.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace aphotic {
namespace {

constexpr double kKnownShare = 0.25;
// For the rms of n independent residuals, in its own standard deviations 1/sqrt(2 n).
constexpr double kWorse = 4.0;
constexpr double kConsistent = 3.0;  // a range's own residual, in rms

// The sum over some pixels of v v^T, v = (1, x, y, z = 1/Z). In double, since variances may be as
// small as a millionth of the squares.
using Moments = Eigen::Matrix4d;

Moments moments_of(const InversePlace& one) {
    const Eigen::Vector4d v(1.0, one.place.x(), one.place.y(), one.inverse_per_m);
    return v * v.transpose();
}

LocalPlane plane_through(const Moments& sums) {
    const Eigen::Vector3d mean = sums.bottomLeftCorner<3, 1>() / sums(0, 0);
    const Eigen::Matrix3d covariance =
        sums.bottomRightCorner<3, 3>() / sums(0, 0) - mean * mean.transpose();
    const Eigen::Matrix2d of_places = covariance.topLeftCorner<2, 2>();
    const Eigen::Vector2d with_z = covariance.topRightCorner<2, 1>();
    // A single row or column of pixels has no slope across itself.
    constexpr double kLeastSpread = 1e-6;
    Eigen::Vector2d bc = Eigen::Vector2d::Zero();
    if (of_places.determinant() > kLeastSpread * of_places.trace() * of_places.trace())
        bc = of_places.inverse() * with_z;
    return {.abc = {mean.z() - bc.dot(mean.head<2>()), bc.x(), bc.y()},
            .rms_per_m = std::sqrt(std::max(0.0, covariance(2, 2) - bc.dot(with_z)))};
}

}  // namespace

LocalPlanes::LocalPlanes(const std::vector<InversePlace>& places, int width_px, int block_px)
    : places_(places),
      width_px_(width_px),
      block_px_(block_px),
      across_((width_px + block_px - 1) / block_px),
      down_(0) {
    const auto height_px = static_cast<int>(places.size()) / width_px;
    down_ = (height_px + block_px - 1) / block_px;
    std::vector<Moments> blocks(size_of(across_) * size_of(down_), Moments::Zero());
    for (int row = 0; row < height_px; ++row) {
        Moments* const blocks_of_row = &blocks[size_of(row / block_px) * size_of(across_)];
        for (int column = 0; column < width_px; ++column) {
            const InversePlace& one = places[size_of(row) * size_of(width_px) + size_of(column)];
            if (std::isfinite(one.inverse_per_m))
                blocks_of_row[column / block_px] += moments_of(one);
        }
    }
    const double whole = 9.0 * block_px * block_px;
    for (int j = 0; j < down_; ++j) {
        for (int i = 0; i < across_; ++i) {
            Moments sums = Moments::Zero();
            for (int y = std::max(0, j - 1); y <= std::min(down_ - 1, j + 1); ++y)
                for (int x = std::max(0, i - 1); x <= std::min(across_ - 1, i + 1); ++x)
                    sums += blocks[size_of(y) * size_of(across_) + size_of(x)];
            Window& window = windows_.emplace_back();
            window.count = sums(0, 0);
            window.is_known = window.count >= std::max(4.0, kKnownShare * whole);
            if (!window.is_known) continue;
            window.plane = plane_through(sums);
            window.mean_per_m = sums(0, 3) / window.count;
        }
    }
    for (int j = 0; j < down_; ++j)
        for (int i = 0; i < across_; ++i) judge(i, j);
}

const LocalPlanes::Window* LocalPlanes::window(int across, int down) const {
    if (across < 0 || down < 0 || across >= across_ || down >= down_) return nullptr;
    const Window& found = windows_[size_of(down) * size_of(across_) + size_of(across)];
    return found.is_known ? &found : nullptr;
}

// Single-precision rounding does not count as roughness.
void LocalPlanes::judge(int across, int down) {
    constexpr double kRoundingOfFloats = 1e-6;
    Window& own = windows_[size_of(down) * size_of(across_) + size_of(across)];
    double least = own.plane.rms_per_m;
    for (int y = down - 1; y <= down + 1; ++y) {
        for (int x = across - 1; x <= across + 1; ++x)
            if (const Window* const near = window(x, y))
                least = std::min(least, near->plane.rms_per_m);
    }
    const double worse = 1.0 + kWorse / std::sqrt(2.0 * own.count);
    own.is_good = own.is_known && own.plane.rms_per_m <=
                                      std::max(worse * least, kRoundingOfFloats * own.mean_per_m);
}

std::optional<LocalPlane> LocalPlanes::at(int column, int row) const {
    const auto found = between(column, row);
    return found ? found : best(column, row);
}

std::optional<LocalPlane> LocalPlanes::between(int column, int row) const {
    const double x = std::clamp((column + 0.5) / block_px_ - 0.5, 0.0, across_ - 1.0);
    const double y = std::clamp((row + 0.5) / block_px_ - 0.5, 0.0, down_ - 1.0);
    const int i = static_cast<int>(x);
    const int j = static_cast<int>(y);
    LocalPlane found;
    for (int k = 0; k < 4; ++k) {
        const int across = std::min(i + k % 2, across_ - 1);
        const int down = std::min(j + k / 2, down_ - 1);
        const Window& one = windows_[size_of(down) * size_of(across_) + size_of(across)];
        if (!one.is_good) return std::nullopt;
        const double share =
            (k % 2 == 0 ? 1.0 - x + i : x - i) * (k / 2 == 0 ? 1.0 - y + j : y - j);
        found.abc += share * one.plane.abc;
        found.rms_per_m += share * one.plane.rms_per_m;
    }
    return found;
}

// The best of the windows of 3 x 3 pixels that contain this one; empty if none is fully known.
std::optional<LocalPlane> LocalPlanes::finest(int column, int row) const {
    const int height_px = static_cast<int>(places_.size()) / width_px_;
    std::optional<LocalPlane> found;
    for (int y = row - 1; y <= row + 1; ++y) {
        for (int x = column - 1; x <= column + 1; ++x) {
            if (x < 1 || y < 1 || x > width_px_ - 2 || y > height_px - 2) continue;
            Moments sums = Moments::Zero();
            for (int k = 0; k < 9; ++k)
                sums += moments_of(
                    places_[size_of(y - 1 + k / 3) * size_of(width_px_) + size_of(x - 1 + k % 3)]);
            const LocalPlane plane = plane_through(sums);
            if (std::isfinite(plane.abc.sum()) && (!found || plane.rms_per_m < found->rms_per_m))
                found = plane;
        }
    }
    return found;
}

std::optional<LocalPlane> LocalPlanes::best(int column, int row) const {
    if (block_px_ == kLeastBlock_px) {
        if (auto near = finest(column, row)) return near;
    }
    constexpr int kReach = 2;
    const int i = column / block_px_;
    const int j = row / block_px_;
    const InversePlace& here = places_[size_of(row) * size_of(width_px_) + size_of(column)];
    const bool is_known = std::isfinite(here.inverse_per_m);
    const Window* found = nullptr;
    double best_score = std::numeric_limits<double>::infinity();
    for (int y = j - kReach; y <= j + kReach; ++y) {
        for (int x = i - kReach; x <= i + kReach; ++x) {
            const Window* const near = window(x, y);
            if (near == nullptr) continue;
            const double off =
                is_known ? near->plane.inverse_at(here.place) - here.inverse_per_m : 0.0;
            const double score = std::max(near->plane.rms_per_m, std::abs(off) / kConsistent);
            if (score >= best_score) continue;
            best_score = score;
            found = near;
        }
    }
    return found != nullptr ? std::optional(found->plane) : std::nullopt;
}

double LocalPlanes::roughness() const {
    std::vector<double> all;
    for (const Window& window : windows_)
        if (window.is_known) all.push_back(window.plane.rms_per_m / window.mean_per_m);
    return all.empty() ? 0.0 : upper_median(all);
}

int block_for(double roughness, double pixel_rad, int width_px) {
    const double window_px = std::sqrt(std::sqrt(12.0) * roughness / (kSlopeError * pixel_rad));
    constexpr int kWidest = 36;  // windows are up to a twelfth of the image
    return std::clamp(static_cast<int>(std::ceil(window_px / 3.0)),
                      kLeastBlock_px,
                      std::max(kLeastBlock_px, width_px / kWidest));
}

}  // namespace aphotic
