// SPDX-License-Identifier: BSD-3-Clause
#include "survey/relief/local_planes.h"

#include "base/upper_median.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace aphotic {
namespace {

constexpr double kKnownShare = 0.25;
constexpr double kWorse = 2.0;  // times the least rms, from where a window's own is left

// Sums over some pixels, of places less the block's own middle so that no digits are lost.
struct Moments {
    double count = 0.0;
    Eigen::Vector3d first = Eigen::Vector3d::Zero();  // of x, y, 1/Z
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

    void add(const Eigen::Vector3d& value) {
        count += 1.0;
        first += value;
        second += value * value.transpose();
    }
    // The same about another middle, which lies `by` farther on.
    [[nodiscard]] Moments about(const Eigen::Vector3d& by) const {
        return {.count = count,
                .first = first - count * by,
                .second = second - first * by.transpose() - by * first.transpose() +
                          count * by * by.transpose()};
    }
    Moments& operator+=(const Moments& other) {
        count += other.count;
        first += other.first;
        second += other.second;
        return *this;
    }
};

struct Block {
    Moments moments;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
};

// Of the plane through these, about that middle.
LocalPlane plane_of(const Moments& sums, const Eigen::Vector3d& middle) {
    const Eigen::Vector3d mean = sums.first / sums.count;
    const Eigen::Matrix3d spread = sums.second / sums.count - mean * mean.transpose();
    const Eigen::Matrix2d places = spread.topLeftCorner<2, 2>();
    const Eigen::Vector2d along = spread.topRightCorner<2, 1>();
    LocalPlane plane;
    // One row or column of pixels has a slope along itself alone.
    constexpr double kLeastSpread = 1e-6;
    const Eigen::Vector2d slope =
        places.determinant() > kLeastSpread * places.trace() * places.trace()
            ? Eigen::Vector2d(places.inverse() * along)
            : Eigen::Vector2d::Zero();
    const Eigen::Vector3d centre = middle + mean;
    plane.abc << centre.z() - slope.dot(centre.head<2>()), slope;
    plane.rms_per_m = std::sqrt(std::max(0.0, spread(2, 2) - slope.dot(along)));
    return plane;
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
    std::vector<Block> blocks(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_));
    for (int row = 0; row < height_px; ++row) {
        for (int column = 0; column < width_px; ++column) {
            const InversePlace& one = places[static_cast<std::size_t>(row * width_px + column)];
            if (!std::isfinite(one.inverse_per_m)) continue;
            const Eigen::Vector3d value(one.place.x(), one.place.y(), one.inverse_per_m);
            Block& block =
                blocks[static_cast<std::size_t>(row / block_px * across_ + column / block_px)];
            if (block.moments.count == 0.0) block.middle = value;
            block.moments.add(value - block.middle);
        }
    }
    const double whole = 9.0 * block_px * block_px;
    for (int j = 0; j < down_; ++j) {
        for (int i = 0; i < across_; ++i) {
            Moments sums;
            std::optional<Eigen::Vector3d> middle;
            for (int y = std::max(0, j - 1); y <= std::min(down_ - 1, j + 1); ++y) {
                for (int x = std::max(0, i - 1); x <= std::min(across_ - 1, i + 1); ++x) {
                    const Block& block = blocks[static_cast<std::size_t>(y * across_ + x)];
                    if (block.moments.count == 0.0) continue;
                    if (!middle) middle = block.middle;
                    sums += block.moments.about(*middle - block.middle);
                }
            }
            Window& window = windows_.emplace_back();
            window.is_known = sums.count >= std::max(4.0, kKnownShare * whole);
            if (!window.is_known) continue;
            window.plane = plane_of(sums, *middle);
            window.mean_per_m = middle->z() + sums.first.z() / sums.count;
        }
    }
}

const LocalPlanes::Window* LocalPlanes::window(int across, int down) const {
    if (across < 0 || down < 0 || across >= across_ || down >= down_) return nullptr;
    const Window& found = windows_[static_cast<std::size_t>(down * across_ + across)];
    return found.is_known ? &found : nullptr;
}

std::optional<LocalPlane> LocalPlanes::at(int column, int row) const {
    constexpr int kReach = 2;
    const int i = column / block_px_;
    const int j = row / block_px_;
    const Window* const own = window(i, j);
    double least = own != nullptr ? own->plane.rms_per_m : std::numeric_limits<double>::infinity();
    // Rounding of single precision is no roughness.
    constexpr double kRounding = 1e-6;
    if (own != nullptr && least <= kRounding * own->mean_per_m) return own->plane;
    for (int y = j - 1; y <= j + 1; ++y) {
        for (int x = i - 1; x <= i + 1; ++x)
            if (const Window* const near = window(x, y))
                least = std::min(least, near->plane.rms_per_m);
    }
    if (own != nullptr && own->plane.rms_per_m <= kWorse * least) return own->plane;
    const InversePlace& here = places_[static_cast<std::size_t>(row * width_px_ + column)];
    const bool is_known = std::isfinite(here.inverse_per_m);
    const Window* best = nullptr;
    double best_score = std::numeric_limits<double>::infinity();
    for (int y = j - kReach; y <= j + kReach; ++y) {
        for (int x = i - kReach; x <= i + kReach; ++x) {
            const Window* const near = window(x, y);
            if (near == nullptr) continue;
            const double off =
                is_known ? near->plane.inverse_at(here.place) - here.inverse_per_m : 0.0;
            const double score = std::hypot(near->plane.rms_per_m, off);
            if (score >= best_score) continue;
            best_score = score;
            best = near;
        }
    }
    if (best == nullptr) return std::nullopt;
    return best->plane;
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
