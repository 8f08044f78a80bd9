// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/media_samples.h"

#include "scene_gen/beam_sdl.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace aphotic {
namespace {

using Eigen::Vector3d;

struct Interval {
    double from_m;
    double to_m;
};

struct Lamp {
    std::size_t strobe;
    Vector3d at_m;
    double share;
};

struct Piece {
    const WaterRay& ray;
    Interval all;
};

// The part of the ray within a half angle of a lamp's axis. The cone is convex, so it is one
// interval.
std::optional<Interval> within_cone(const Piece& piece,
                                    const Vector3d& lamp_m,
                                    const Vector3d& axis,
                                    double half_angle_rad) {
    const auto is_within = [&](double t_m) {
        const Vector3d from_lamp = piece.ray.origin_m + t_m * piece.ray.direction - lamp_m;
        return angle_between(axis, from_lamp) <= half_angle_rad;
    };
    // (axis . v)^2 = cos^2 |v|^2 along v = a + t u
    const Vector3d a = piece.ray.origin_m - lamp_m;
    const double cos2 = std::pow(std::cos(half_angle_rad), 2);
    const double ka = axis.dot(a);
    const double ku = axis.dot(piece.ray.direction);
    const double A = ku * ku - cos2;
    const double B = ka * ku - cos2 * a.dot(piece.ray.direction);
    const double C = ka * ka - cos2 * a.squaredNorm();
    std::vector<double> ends{piece.all.from_m, piece.all.to_m};
    if (const double root2 = B * B - A * C; root2 >= 0.0 && A != 0.0) {
        for (const double sign : {-1.0, 1.0}) {
            const double t_m = (-B + sign * std::sqrt(root2)) / A;
            if (t_m > piece.all.from_m && t_m < piece.all.to_m) ends.push_back(t_m);
        }
    }
    std::ranges::sort(ends);
    std::optional<Interval> lit;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        if (!is_within(0.5 * (ends[k] + ends[k + 1]))) continue;
        if (!lit) lit = Interval{.from_m = ends[k], .to_m = ends[k + 1]};
        lit->to_m = ends[k + 1];
    }
    return lit;
}

// The piece, cut where it crosses a cone's sharp edge.
std::vector<Interval> between_steps(const Rig& rig,
                                    std::span<const Lamp> lamps,
                                    const Piece& piece,
                                    bool cuts_edges) {
    if (!cuts_edges) return {piece.all};
    std::vector<double> cuts{piece.all.from_m, piece.all.to_m};
    for (const Lamp& lamp : lamps) {
        const Strobe& strobe = rig.strobes[lamp.strobe];
        if (needs_shell(strobe.beam)) continue;
        const Vector3d axis = frame_about(strobe.axis).axis;
        for (const Cone& cone : strobe.beam.cones) {
            if (cone.weight == 0.0 || cone.edge_rad > 0.0) continue;
            if (cone.half_angle_rad >= 0.5 * std::numbers::pi) continue;
            const auto within = within_cone(piece, lamp.at_m, axis, cone.half_angle_rad);
            if (within) cuts.insert(cuts.end(), {within->from_m, within->to_m});
        }
    }
    std::ranges::sort(cuts);
    std::vector<Interval> intervals;
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        if (cuts[k] < cuts[k + 1]) intervals.push_back({.from_m = cuts[k], .to_m = cuts[k + 1]});
    }
    return intervals;
}

// The intervals of all lamps, merged where they overlap.
std::vector<Interval> lit_intervals(const Rig& rig,
                                    std::span<const Lamp> lamps,
                                    const Piece& piece) {
    std::vector<Interval> lit;
    for (const Lamp& lamp : lamps) {
        const Strobe& strobe = rig.strobes[lamp.strobe];
        if (needs_shell(strobe.beam)) return {piece.all};
        const Vector3d axis = frame_about(strobe.axis).axis;
        for (const Cone& cone : strobe.beam.cones) {
            if (cone.weight == 0.0) continue;
            const auto within = within_cone(piece, lamp.at_m, axis, cone.half_angle_rad);
            if (within) lit.push_back(*within);
        }
    }
    std::ranges::sort(lit, {}, &Interval::from_m);
    std::vector<Interval> merged;
    for (const Interval& interval : lit) {
        if (merged.empty() || interval.from_m > merged.back().to_m) {
            merged.push_back(interval);
        } else {
            merged.back().to_m = std::max(merged.back().to_m, interval.to_m);
        }
    }
    return merged;
}

std::vector<Lamp> lamps_of(const Rig& rig, std::span<const LampGrid> grids) {
    std::vector<Lamp> lamps;
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        if (rig.strobes[s].power == 0.0) continue;
        const std::vector<Vector3d> places = lamp_positions_m(rig.strobes[s], grids[s]);
        for (const Vector3d& at_m : places)
            lamps.push_back({s, at_m, 1.0 / static_cast<double>(places.size())});
    }
    return lamps;
}

}  // namespace

std::vector<VeilNodes> media_samples(const Rig& rig,
                                     std::span<const LampGrid> lamp_grids,
                                     const MediaSampling& sampling,
                                     const WaterRay& ray,
                                     double length_m) {
    std::vector<VeilNodes> nodes(rig.strobes.size());
    for (VeilNodes& of_strobe : nodes) of_strobe.weight.resize(sampling.lobes.size());
    std::vector<BeamFrame> frames;
    for (const Strobe& strobe : rig.strobes) frames.push_back(frame_about(strobe.axis));
    const std::vector<Lamp> lamps = lamps_of(rig, lamp_grids);
    double end_m = sampling.sight_m;
    for (double from_m = 0.0; from_m < length_m; from_m = end_m, end_m *= 2.0) {
        if (2.0 * from_m >= sampling.most_m) break;
        const Piece piece{.ray = ray, .all = {from_m, std::min(end_m, length_m)}};
        std::vector<Interval> all_lit;
        for (const Interval& part : between_steps(rig, lamps, piece, sampling.cuts_edges)) {
            const std::vector<Interval> lit = lit_intervals(rig, lamps, {.ray = ray, .all = part});
            all_lit.insert(all_lit.end(), lit.begin(), lit.end());
        }
        for (const Interval& lit : all_lit) {
            const double step_m = (lit.to_m - lit.from_m) / sampling.samples;
            for (int k = 0; k < sampling.samples; ++k) {
                const double t_m = lit.from_m + (k + 0.5) * step_m;
                for (const Lamp& lamp : lamps) {
                    const Strobe& strobe = rig.strobes[lamp.strobe];
                    const Vector3d towards = ray.origin_m + t_m * ray.direction - lamp.at_m;
                    const double intensity =
                        intensity_towards(strobe.beam, frames[lamp.strobe], towards);
                    if (intensity == 0.0) continue;
                    const double psi_rad = angle_between(towards, -ray.direction);
                    VeilNodes& found = nodes[lamp.strobe];
                    found.path_m.push_back(t_m + towards.norm());
                    const double light = lamp.share * intensity * step_m / towards.squaredNorm();
                    for (std::size_t m = 0; m < sampling.lobes.size(); ++m)
                        found.weight[m].push_back(light * sampling.lobes[m].at(psi_rad));
                }
            }
        }
    }
    return nodes;
}

}  // namespace aphotic
