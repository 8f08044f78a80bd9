// SPDX-License-Identifier: BSD-3-Clause
#include "rig/veil.h"

#include <boost/math/special_functions/legendre.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace aphotic {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// Two directions on the plane of ray and lamp, and what lies between lamp and ray.
struct View {
    double foot_m;     // t_0
    double away_m;     // h
    Vector3d towards;  // e, unit, across the ray
    Vector3d along;    // u
};

View view_of(const Vector3d& lamp_m, const WaterRay& ray) {
    const Vector3d to_lamp = lamp_m - ray.origin_m;
    const double foot_m = to_lamp.dot(ray.direction);
    const Vector3d across = ray.origin_m + foot_m * ray.direction - lamp_m;
    // On the ray itself its light has no end; a micrometre beside it has.
    constexpr double kNear_m = 1e-6;
    const double away_m = across.norm();
    if (away_m >= kNear_m) return {foot_m, away_m, across / away_m, ray.direction};
    return {foot_m, kNear_m, ray.direction.unitOrthogonal(), ray.direction};
}

// Where the beam's edges cross the ray.
void add_crossings(const View& view,
                   const Vector3d& axis,
                   const std::vector<double>& edges_rad,
                   std::vector<double>& cuts) {
    const double A = axis.dot(view.towards);
    const double B = axis.dot(view.along);
    const double size = std::hypot(A, B);
    for (const double edge_rad : edges_rad) {
        const double cosine = std::cos(edge_rad);
        if (std::abs(cosine) >= size) continue;
        const double middle = std::atan2(B, A);
        const double half = std::acos(cosine / size);
        for (const double phi : {middle - half, middle + half})
            cuts.push_back(std::remainder(phi, 2.0 * pi));
    }
}

// Where the ray crosses a beam's rim, found between steps.
void add_rim_crossings(const View& view,
                       const Beam& beam,
                       const BeamFrame& frame,
                       double first,
                       double last,
                       std::vector<double>& cuts) {
    constexpr int kSteps = 48;
    constexpr int kHalvings = 50;
    const auto is_lit = [&](double phi) {
        return is_within_rim(
            beam, frame, std::cos(phi) * view.towards + std::sin(phi) * view.along);
    };
    double before = first;
    bool was_lit = is_lit(before);
    for (int step = 1; step <= kSteps; ++step) {
        const double after = first + (last - first) * step / kSteps;
        const bool is_lit_now = is_lit(after);
        if (is_lit_now != was_lit) {
            double low = before;
            double high = after;
            for (int i = 0; i < kHalvings; ++i) {
                const double middle = 0.5 * (low + high);
                (is_lit(middle) == was_lit ? low : high) = middle;
            }
            cuts.push_back(low);
        }
        before = after;
        was_lit = is_lit_now;
    }
}

double least_veil_attenuation_per_m(const Rig& rig) {
    std::vector<double> knots_nm = union_of_knots(rig.water.curves(), rig.camera.range);
    double least = std::numeric_limits<double>::infinity();
    for (const double nm : knots_nm) least = std::min(least, rig.water.veil_attenuation_per_m(nm));
    return least;
}

}  // namespace

void VeilNodes::clear() {
    path_m.clear();
    for (std::vector<double>& of_scatterer : weight) of_scatterer.clear();
}

Veil::Veil(const Rig& rig, unsigned points) : rig_(rig) {
    const std::vector<double> zeros =
        boost::math::legendre_p_zeros<double>(static_cast<int>(points));
    for (const double zero : zeros) {  // those that are not negative
        const double slope = boost::math::legendre_p_prime(static_cast<int>(points), zero);
        const double weight = 1.0 / ((1.0 - zero * zero) * slope * slope);
        points_.push_back(0.5 + 0.5 * zero);
        weights_.push_back(weight);
        if (zero == 0.0) continue;
        points_.push_back(0.5 - 0.5 * zero);
        weights_.push_back(weight);
    }
    for (const Strobe& strobe : rig.strobes) {
        frames_.push_back(frame_about(strobe.axis));
        edges_rad_.push_back(edges_rad(strobe.beam));
        std::vector<Lamp> lamps{{strobe.position_m, 1.0}};
        if (strobe.emitter) {
            lamps.clear();
            const BeamFrame& frame = frames_.back();
            const double out = 0.5 * std::sqrt(0.6);
            const std::array<double, 3> places{-out, 0.0, out};
            const std::array<double, 3> shares{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t j = 0; j < 3; ++j) {
                    lamps.push_back({strobe.position_m +
                                         places[i] * strobe.emitter->across_m * frame.across +
                                         places[j] * strobe.emitter->along_m * frame.along,
                                     shares[i] * shares[j]});
                }
            }
        }
        lamps_.push_back(std::move(lamps));
    }
    const double least_per_m = rig.water.scatters() ? least_veil_attenuation_per_m(rig) : 0.0;
    longest_m_ =
        least_per_m > 0.0 ? kVeilDepth / least_per_m : std::numeric_limits<double>::infinity();
}

void Veil::nodes(std::size_t strobe, const WaterRay& ray, double length_m, VeilNodes& nodes) const {
    nodes.clear();
    nodes.weight.resize(rig_.water.scatterers.size());
    const Beam& beam = rig_.strobes[strobe].beam;
    const BeamFrame& frame = frames_[strobe];
    for (const Lamp& lamp : lamps_[strobe]) {
        const View view = view_of(lamp.position_m, ray);
        const double end_m = std::min(length_m, longest_m_);
        const double first = std::max(std::atan2(-view.foot_m, view.away_m), kVeilCut - 0.5 * pi);
        const double last = std::atan2(end_m - view.foot_m, view.away_m);
        if (!(last > first)) continue;
        std::vector<double> cuts{first, last};
        add_crossings(view, frame.axis, edges_rad_[strobe], cuts);
        if (has_rim(beam)) add_rim_crossings(view, beam, frame, first, last, cuts);
        std::erase_if(cuts, [&](double cut) { return cut < first || cut > last; });
        std::ranges::sort(cuts);
        for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
            const double span = cuts[k + 1] - cuts[k];
            if (span <= 0.0) continue;
            const double middle = 0.5 * (cuts[k] + cuts[k + 1]);
            const Vector3d seen = std::cos(middle) * view.towards + std::sin(middle) * view.along;
            if (!edges_rad_[strobe].empty() && intensity_towards(beam, frame, seen) == 0.0)
                continue;
            const int panels = std::max(1, static_cast<int>(std::ceil(span / kVeilPanelRad)));
            const double width = span / panels;
            for (int panel = 0; panel < panels; ++panel) {
                for (std::size_t n = 0; n < points_.size(); ++n) {
                    const double phi = cuts[k] + width * (panel + points_[n]);
                    const double cosine = std::cos(phi);
                    const double sine = std::sin(phi);
                    const double intensity = continued_intensity(
                        beam, frame, cosine * view.towards + sine * view.along, seen);
                    nodes.path_m.push_back(view.foot_m + view.away_m * (1.0 + sine) / cosine);
                    const double share = lamp.share * intensity * width * weights_[n] / view.away_m;
                    for (std::size_t i = 0; i < nodes.weight.size(); ++i) {
                        nodes.weight[i].push_back(
                            share * rig_.water.scatterers[i].phase.at(phi + 0.5 * pi));
                    }
                }
            }
        }
    }
}

double Veil::radiance(const WaterRay& ray, double length_m, double lambda_nm) const {
    const double loss_per_m = rig_.water.veil_attenuation_per_m(lambda_nm);
    double sum = 0.0;
    VeilNodes found;
    for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
        nodes(s, ray, length_m, found);
        double light = 0.0;
        for (std::size_t i = 0; i < found.weight.size(); ++i) {
            double of_scatterer = 0.0;
            for (std::size_t n = 0; n < found.path_m.size(); ++n)
                of_scatterer += found.weight[i][n] * std::exp(-loss_per_m * found.path_m[n]);
            light += rig_.water.scattering_per_m(i, lambda_nm) * of_scatterer;
        }
        sum += rig_.strobes[s].power * rig_.strobes[s].spectrum.at(lambda_nm) * light;
    }
    return sum;
}

VeilSight sight_of(const Rig& rig, double column, double row, double lambda_nm) {
    const WaterRay ray = pixel_ray(rig, column, row, lambda_nm);
    const auto length_m = distance_to(floor_plane(rig.sled), ray);
    return {ray, length_m.value_or(std::numeric_limits<double>::infinity())};
}

}  // namespace aphotic
