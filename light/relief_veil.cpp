// SPDX-License-Identifier: BSD-3-Clause
#include "light/relief_veil.h"

#include "image/image_size.h"
#include "light/relief_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace aphotic {
namespace {

constexpr std::size_t kDepths = 4;  // of a cubic

// ln Z in steps, for depths from which light returns.
double steps_to(double depth_m) {
    const double lit_m = std::clamp(depth_m, kReliefPaths.shortest_m, kReliefPaths.longest_m);
    return std::log(lit_m) / std::log1p(kVeilDepthStep);
}

// Weights of the cubic through -1, 0, 1 and 2.
std::array<double, kDepths> cubic_shares(double t) {
    return {-t * (t - 1.0) * (t - 2.0) / 6.0,
            (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
            -(t + 1.0) * t * (t - 2.0) / 2.0,
            (t + 1.0) * t * (t - 1.0) / 6.0};
}

}  // namespace

ReliefVeil::ReliefVeil(const VeilMap& map, const CameraRays& rays, int width_px, int height_px)
    : map_(map),
      rays_(rays),
      spacing_px_(std::max(1.0, static_cast<double>(width_px) / kVeilPlaces)),
      across_(static_cast<int>(std::ceil(width_px / spacing_px_)) + 1),
      down_(static_cast<int>(std::ceil(height_px / spacing_px_)) + 1) {}

std::shared_ptr<const ReliefVeil::Level> ReliefVeil::level(int k) const {
    const std::scoped_lock lock(mutex_);
    std::shared_ptr<const Level>& known = levels_[k];
    if (known) return known;
    const double depth_m = std::pow(1.0 + kVeilDepthStep, k);
    // A level floor that ends every ray at this depth.
    const Plane level{.point_m = {0.0, 0.0, depth_m}, .normal = -Eigen::Vector3d::UnitZ()};
    auto found = std::make_shared<Level>();
    VeilNodes nodes;
    for (int j = 0; j < down_; ++j) {
        for (int i = 0; i < across_; ++i) {
            const PlaceRays rays = rays_.at(i * spacing_px_, j * spacing_px_, level);
            const VeilMap::Signal veil = map_.at(rays, nodes);
            for (std::size_t c = 0; c < kChannels; ++c)
                found->push_back(static_cast<float>(veil[c]));
        }
    }
    known = std::move(found);
    return known;
}

std::vector<float> ReliefVeil::before(const Relief& relief) const {
    const std::size_t pixels = relief.point_m.size();
    std::vector<float> veil(kChannels * pixels);
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (std::size_t i = 0; i < pixels; ++i) {
        if (!relief.knows(i)) continue;
        const double steps = steps_to(relief.point_m[i].z());
        least = std::min(least, steps);
        most = std::max(most, steps);
    }
    if (!(least <= most)) return veil;
    const int first = static_cast<int>(std::floor(least)) - 1;
    std::vector<std::shared_ptr<const Level>> levels;
    for (int k = first; k <= static_cast<int>(std::floor(most)) + 2; ++k)
        levels.push_back(level(k));
    for (int row = 0; row < relief.height_px; ++row) {
        const double y = (row + 0.5) / spacing_px_;
        const int j = static_cast<int>(y);
        for (int column = 0; column < relief.width_px; ++column) {
            const std::size_t pixel = relief.at(column, row);
            if (!relief.knows(pixel)) continue;
            const double x = (column + 0.5) / spacing_px_;
            const int i = static_cast<int>(x);
            const double steps = steps_to(relief.point_m[pixel].z());
            const std::array<double, kDepths> shares = cubic_shares(steps - std::floor(steps));
            const std::size_t lowest =
                static_cast<std::size_t>(static_cast<int>(std::floor(steps)) - 1 - first);
            const std::array<double, 4> corners{(1.0 - x + i) * (1.0 - y + j),
                                                (x - i) * (1.0 - y + j),
                                                (1.0 - x + i) * (y - j),
                                                (x - i) * (y - j)};
            const std::size_t place = size_of(j) * size_of(across_) + size_of(i);
            const std::size_t next_row = size_of(across_);
            const std::array<std::size_t, 4> places{
                place, place + 1, place + next_row, place + next_row + 1};
            for (std::size_t c = 0; c < kChannels; ++c) {
                double sum = 0.0;
                for (std::size_t k = 0; k < kDepths; ++k) {
                    double over_image = 0.0;
                    for (std::size_t n = 0; n < corners.size(); ++n)
                        over_image += corners[n] * (*levels[lowest + k])[kChannels * places[n] + c];
                    sum += shares[k] * over_image;
                }
                veil[c * pixels + pixel] = static_cast<float>(std::max(0.0, sum));
            }
        }
    }
    return veil;
}

}  // namespace aphotic
