// SPDX-License-Identifier: BSD-3-Clause
#include "validation/veil_spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace aphotic {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;

namespace {

// Lagrange's polynomials of the nodes, at every place: one row a place.
ArrayXXd lagrange(const ArrayXd& nodes, const ArrayXd& places) {
    ArrayXXd shares = ArrayXXd::Ones(places.size(), nodes.size());
    for (Index n = 0; n < nodes.size(); ++n) {
        for (Index other = 0; other < nodes.size(); ++other) {
            if (other == n) continue;
            shares.col(n) *= (places - nodes(other)) / (nodes(n) - nodes(other));
        }
    }
    return shares;
}

// From least to most, denser towards the ends.
ArrayXd chebyshev(double least, double most, int count) {
    ArrayXd nodes(count);
    for (int n = 0; n < count; ++n)
        nodes(n) = std::midpoint(least, most) -
                   0.5 * (most - least) * std::cos(std::numbers::pi * (n + 0.5) / count);
    return nodes;
}

// Light of the points at each loss, by scatterer; paths are counted from from_m.
struct VeilSums {
    ArrayXd loss_per_m;
    std::vector<ArrayXd> of;  // by scatterer

    VeilSums(const ArrayXd& losses, std::size_t scatterers)
        : loss_per_m(losses), of(scatterers, ArrayXd::Zero(losses.size())) {}

    void add(const VeilPoints& points, std::size_t n, double from_m) {
        const ArrayXd left = light_left((points.path_m[n] - from_m) * loss_per_m);
        for (std::size_t i = 0; i < of.size(); ++i) of[i] += points.light[i][n] * left;
    }
};

}  // namespace

VeilSpectrum::VeilSpectrum(const Rig& rig,
                           const TracedWater& water,
                           const std::vector<double>& lambda_nm)
    : veil_(rig, water), loss_per_m_(static_cast<Index>(lambda_nm.size())) {
    for (std::size_t j = 0; j < lambda_nm.size(); ++j)
        loss_per_m_(static_cast<Index>(j)) = water.loss_per_m(lambda_nm[j]);
    for (const Strobe& strobe : rig.strobes) {
        auto& of_strobe = light_.emplace_back();
        for (std::size_t i = 0; i < water.phases().size(); ++i) {
            ArrayXd& light = of_strobe.emplace_back(loss_per_m_.size());
            for (std::size_t j = 0; j < lambda_nm.size(); ++j) {
                light(static_cast<Index>(j)) = strobe.spectrum.at(lambda_nm[j]) * strobe.power *
                                               water.scattering_per_m(i, lambda_nm[j]);
            }
        }
    }
    if (lambda_nm.size() <= std::size_t{kLossNodes}) return;
    const double least_per_m = loss_per_m_.minCoeff();
    const double most_per_m = loss_per_m_.maxCoeff();
    if (least_per_m < most_per_m) {
        nodes_per_m_ = chebyshev(least_per_m, most_per_m, kLossNodes);
        shares_of_nodes_ = lagrange(nodes_per_m_, loss_per_m_);
    }
    place_rays(lambda_nm);
}

// The wavelengths nearest to Chebyshev's extremes, whose sets are nested.
void VeilSpectrum::place_rays(const std::vector<double>& lambda_nm) {
    const Eigen::Map<const ArrayXd> all_nm(lambda_nm.data(), loss_per_m_.size());
    const double first_nm = all_nm.minCoeff();
    const double last_nm = all_nm.maxCoeff();
    for (const int parts : {2, 4, 8, 16}) {
        Rays rays;
        for (int n = 0; n <= parts; ++n) {
            const double wanted_nm =
                std::midpoint(first_nm, last_nm) -
                0.5 * (last_nm - first_nm) * std::cos(std::numbers::pi * n / parts);
            Index nearest = 0;
            (all_nm - wanted_nm).abs().minCoeff(&nearest);
            rays.wavelengths.push_back(static_cast<std::size_t>(nearest));
        }
        ArrayXd nodes_nm(parts + 1);
        for (int n = 0; n <= parts; ++n)
            nodes_nm(n) = lambda_nm[rays.wavelengths[static_cast<std::size_t>(n)]];
        const Index apart = nodes_nm.size() - 1;
        if (!(nodes_nm.tail(apart) > nodes_nm.head(apart)).all()) return;
        rays.shares = lagrange(nodes_nm, all_nm);
        rays_.push_back(std::move(rays));
    }
}

ArrayXd VeilSpectrum::along(const VeilRay& ray) const {
    ArrayXd veil = ArrayXd::Zero(loss_per_m_.size());
    if (veil.size() == 0) return veil;
    const Losses losses{.least_per_m = loss_per_m_.minCoeff(),
                        .most_per_m = loss_per_m_.maxCoeff()};
    const double span_per_m = losses.most_per_m - losses.least_per_m;
    VeilPoints points;
    for (std::size_t s = 0; s < light_.size(); ++s) {
        veil_.trace(s, ray, losses, points);
        if (points.path_m.empty()) continue;
        const double nearest_m = std::ranges::min(points.path_m);
        VeilSums at_nodes(nodes_per_m_, light_[s].size());
        VeilSums direct(loss_per_m_, light_[s].size());
        for (std::size_t n = 0; n < points.path_m.size(); ++n) {
            const bool is_smooth = nodes_per_m_.size() > 0 &&
                                   span_per_m * (points.path_m[n] - nearest_m) < kSmoothDepth;
            (is_smooth ? at_nodes : direct).add(points, n, nearest_m);
        }
        const ArrayXd left = light_left(nearest_m * loss_per_m_);
        for (std::size_t i = 0; i < light_[s].size(); ++i) {
            if (nodes_per_m_.size() > 0)
                direct.of[i] += (shares_of_nodes_.matrix() * at_nodes.of[i].matrix()).array();
            veil += light_[s][i] * direct.of[i] * left;
        }
    }
    return veil;
}

ArrayXd VeilSpectrum::along(const std::function<VeilRay(std::size_t)>& ray) const {
    const std::size_t count = static_cast<std::size_t>(loss_per_m_.size());
    std::vector<ArrayXd> traced(count);  // by the wavelength of the ray; none yet
    const auto of_ray = [&](std::size_t j) -> const ArrayXd& {
        if (traced[j].size() == 0) traced[j] = along(ray(j));
        return traced[j];
    };
    ArrayXd coarse;
    for (const Rays& rays : rays_) {
        ArrayXd veil = ArrayXd::Zero(loss_per_m_.size());
        for (std::size_t n = 0; n < rays.wavelengths.size(); ++n)
            veil += rays.shares.col(static_cast<Index>(n)) * of_ray(rays.wavelengths[n]);
        if (coarse.size() > 0 && ((veil - coarse).abs() <= kVeilOverRays * veil).all()) return veil;
        coarse = std::move(veil);
    }
    ArrayXd veil(loss_per_m_.size());
    for (std::size_t j = 0; j < count; ++j)
        veil(static_cast<Index>(j)) = of_ray(j)(static_cast<Index>(j));
    return veil;
}

}  // namespace aphotic
