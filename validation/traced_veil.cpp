// SPDX-License-Identifier: BSD-3-Clause
#include "validation/traced_veil.h"

#include "base/gauss_rule.h"

#include <Eigen/Geometry>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace aphotic {

using Eigen::Vector3d;

namespace {

constexpr double kRightAngle = 0.5 * std::numbers::pi;
constexpr std::size_t kPoints = 15;

struct RulePoint {
    double at;  // from -1 to 1
    double width;
    double width_of_gauss;  // 0 where only Kronrod has a point
};

std::array<RulePoint, kPoints> make_rule() {
    using Kronrod = boost::math::quadrature::gauss_kronrod<double, kPoints>;
    using Gauss = boost::math::quadrature::gauss<double, kPoints / 2>;
    std::array<RulePoint, kPoints> rule{};
    std::size_t next = 0;
    // Boost lists abscissae from 0 up; every other one, from 0, is Gauss's.
    for (std::size_t k = 0; k < Kronrod::abscissa().size(); ++k) {
        const double gauss = k % 2 == 0 ? Gauss::weights()[k / 2] : 0.0;
        rule.at(next++) = {Kronrod::abscissa()[k], Kronrod::weights()[k], gauss};
        if (k > 0) rule.at(next++) = {-Kronrod::abscissa()[k], Kronrod::weights()[k], gauss};
    }
    return rule;
}

const std::array<RulePoint, kPoints>& rule() {
    static const std::array<RulePoint, kPoints> kRule = make_rule();
    return kRule;
}

}  // namespace

// The computation for one lamp and one ray.
struct TracedVeil::Work {
    const TracedVeil& veil;
    const Source& source;
    const Lamp& lamp;
    const Losses& losses;
    Vector3d across;  // from the lamp to the ray's nearest point, unit
    Vector3d along;
    double h_m;
    double foot_m;
    std::vector<double> whole;  // by scatterer: of the least loss, of the most

    struct Panel {
        std::array<double, kPoints> path_m;
        std::vector<std::array<double, kPoints>> light;  // by scatterer
        std::vector<double> sum;                         // as whole
        std::vector<double> doubt;
    };

    [[nodiscard]] Panel panel(double from, double to) const {
        const std::size_t scatterers = veil.water_.phases().size();
        Panel found;
        found.light.resize(scatterers);
        found.sum.assign(2 * scatterers, 0.0);
        found.doubt.assign(2 * scatterers, 0.0);
        const double half = 0.5 * (to - from);
        for (std::size_t n = 0; n < kPoints; ++n) {
            const RulePoint& point = rule().at(n);
            const double x = 0.5 * (from + to) + half * point.at;
            const double path_m = foot_m + h_m * std::tan(0.5 * (kRightAngle + x));
            const double arriving =
                lamp.share * source.beam.intensity(std::cos(x) * across + std::sin(x) * along) *
                half / h_m;
            const std::array<double, 2> left{std::exp(-losses.least_per_m * path_m),
                                             std::exp(-losses.most_per_m * path_m)};
            found.path_m.at(n) = path_m;
            for (std::size_t i = 0; i < scatterers; ++i) {
                const double light =
                    arriving == 0.0 ? 0.0 : arriving * veil.water_.phases()[i].at(x + kRightAngle);
                found.light[i].at(n) = light * point.width;
                for (std::size_t k = 0; k < 2; ++k) {
                    found.sum[2 * i + k] += light * point.width * left.at(k);
                    found.doubt[2 * i + k] +=
                        light * (point.width - point.width_of_gauss) * left.at(k);
                }
            }
        }
        return found;
    }

    void settle(const Panel& panel, double from, double to, int depth, VeilPoints& points) const {
        constexpr int kDepth = 45;
        bool is_settled = depth >= kDepth;
        if (!is_settled) {
            is_settled = true;
            for (std::size_t k = 0; k < whole.size(); ++k)
                is_settled &= std::abs(panel.doubt[k]) <= kVeilTolerance * whole[k];
        }
        if (!is_settled) {
            const double middle = 0.5 * (from + to);
            settle(this->panel(from, middle), from, middle, depth + 1, points);
            settle(this->panel(middle, to), middle, to, depth + 1, points);
            return;
        }
        for (std::size_t n = 0; n < kPoints; ++n) {
            if (std::ranges::all_of(panel.light, [&](const auto& l) { return l.at(n) == 0.0; }))
                continue;
            points.path_m.push_back(panel.path_m.at(n));
            for (std::size_t i = 0; i < panel.light.size(); ++i)
                points.light[i].push_back(panel.light[i].at(n));
        }
    }
};

TracedVeil::TracedVeil(const Rig& rig, const TracedWater& water) : water_(water) {
    const std::vector<GaussNode>& on_side = gauss_rule(kVeilLamps);
    for (const Strobe& strobe : rig.strobes) {
        Source source{.beam = TracedBeam(strobe.beam, strobe.axis),
                      .lamps = {},
                      .power = strobe.power,
                      .spectrum = strobe.spectrum};
        if (!strobe.emitter) {
            source.lamps.push_back({strobe.position_m, 1.0});
        } else {
            const StrobeSides sides = sides_about(strobe.axis);
            for (const GaussNode& i : on_side) {
                for (const GaussNode& j : on_side) {
                    source.lamps.push_back(
                        {strobe.position_m +
                             (i.at - 0.5) * strobe.emitter->across_m * sides.across +
                             (j.at - 0.5) * strobe.emitter->along_m * sides.along,
                         i.weight * j.weight});
                }
            }
        }
        sources_.push_back(std::move(source));
    }
    for (const TracedPhase& phase : water_.phases()) {
        kinks_rad_.insert(kinks_rad_.end(), phase.kinks_rad().begin(), phase.kinks_rad().end());
    }
}

void TracedVeil::add_lamp(const Source& source,
                          const Lamp& lamp,
                          const VeilRay& ray,
                          const Losses& losses,
                          VeilPoints& points) const {
    const Vector3d to_lamp = lamp.position_m - ray.origin_m;
    const double foot_m = to_lamp.dot(ray.direction);
    Vector3d across = ray.origin_m + foot_m * ray.direction - lamp.position_m;
    double h_m = across.norm();
    if (h_m < kVeilBeside_m) {
        across = ray.direction.unitOrthogonal();
        h_m = kVeilBeside_m;
    }
    across.normalize();
    const double from = std::max(std::atan2(-foot_m, h_m), kVeilCut - kRightAngle);
    const double to =
        std::isfinite(ray.length_m) ? std::atan2(ray.length_m - foot_m, h_m) : kRightAngle;
    if (!(from < to)) return;

    std::vector<double> cuts{from, to};
    source.beam.add_crossings(across, ray.direction, cuts);
    for (const double kink_rad : kinks_rad_) cuts.push_back(kink_rad - kRightAngle);
    std::erase_if(cuts, [&](double x) { return x < from || x > to; });
    std::ranges::sort(cuts);

    Work work{.veil = *this,
              .source = source,
              .lamp = lamp,
              .losses = losses,
              .across = across,
              .along = ray.direction,
              .h_m = h_m,
              .foot_m = foot_m,
              .whole = std::vector<double>(2 * water_.phases().size(), 0.0)};
    constexpr double kWidest = 0.25;
    struct Piece {
        double from;
        double to;
        Work::Panel panel;
    };
    std::vector<Piece> pieces;
    for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
        const double width = cuts[c + 1] - cuts[c];
        if (!(width > 0.0)) continue;
        const int parts = static_cast<int>(std::ceil(width / kWidest));
        for (int k = 0; k < parts; ++k) {
            const double a = cuts[c] + width * k / parts;
            const double b = cuts[c] + width * (k + 1) / parts;
            pieces.push_back({a, b, work.panel(a, b)});
            for (std::size_t i = 0; i < work.whole.size(); ++i)
                work.whole[i] += pieces.back().panel.sum[i];
        }
    }
    for (const Piece& piece : pieces) work.settle(piece.panel, piece.from, piece.to, 0, points);
}

void TracedVeil::trace(std::size_t strobe,
                       const VeilRay& ray,
                       const Losses& losses,
                       VeilPoints& points) const {
    points.path_m.clear();
    points.light.assign(water_.phases().size(), {});
    const Source& source = sources_[strobe];
    if (source.power == 0.0) return;
    for (const Lamp& lamp : source.lamps) add_lamp(source, lamp, ray, losses, points);
}

double TracedVeil::radiance(const VeilRay& ray, double lambda_nm) const {
    const double loss_per_m = water_.loss_per_m(lambda_nm);
    double sum = 0.0;
    VeilPoints points;
    for (std::size_t s = 0; s < sources_.size(); ++s) {
        trace(s, ray, {loss_per_m, loss_per_m}, points);
        const double flux = sources_[s].power * sources_[s].spectrum.at(lambda_nm);
        for (std::size_t i = 0; i < points.light.size(); ++i) {
            const double b = water_.scattering_per_m(i, lambda_nm);
            for (std::size_t n = 0; n < points.path_m.size(); ++n) {
                sum += flux * b * points.light[i][n] * std::exp(-loss_per_m * points.path_m[n]);
            }
        }
    }
    return sum;
}

}  // namespace aphotic
