// SPDX-License-Identifier: BSD-3-Clause
#include "validation/monte_carlo.h"

#include "base/error.h"
#include "rig/geometry.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <random>

namespace aphotic {

using Eigen::Vector3d;
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();
// Paths whose importance has fallen to this share survive at random (Russian roulette), with an
// importance of this share.
constexpr double kLeastShare = 0.1;

// A unit vector at an angle from another.
Vector3d turned(const Vector3d& from, double angle_rad, double azimuth_rad) {
    const Vector3d side = from.unitOrthogonal();
    const Vector3d other = from.cross(side);
    return std::cos(angle_rad) * from +
           std::sin(angle_rad) * (std::cos(azimuth_rad) * side + std::sin(azimuth_rad) * other);
}

// Statistics of a quantity to which many paths contribute.
struct Tally {
    double sum = 0.0;
    double squares = 0.0;

    void add(double value) {
        sum += value;
        squares += value * value;
    }
    [[nodiscard]] Estimate of(std::size_t paths) const {
        const auto n = static_cast<double>(paths);
        const double mean = sum / n;
        const double variance = std::max(0.0, squares / n - mean * mean);
        return {mean, n > 1.0 ? std::sqrt(variance / (n - 1.0)) : kForever};
    }
};

double down_cosine_height(const Rig& rig, const Vector3d& down, const Vector3d& point_m) {
    return down.dot(Vector3d(0.0, 0.0, rig.sled.altitude_m) - point_m);
}

}  // namespace

// Random numbers that are the same with every standard library, unlike its distributions.
class MonteCarlo::Dice {
  public:
    Dice(std::uint64_t seed, std::uint64_t stream) {
        std::seed_seq words{static_cast<std::uint32_t>(seed),
                            static_cast<std::uint32_t>(seed >> 32U),
                            static_cast<std::uint32_t>(stream),
                            static_cast<std::uint32_t>(stream >> 32U)};
        engine_.seed(words);
    }
    // From 0 to below 1.
    double roll() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }

  private:
    std::mt19937_64 engine_;
};

// One path, and its light so far.
struct MonteCarlo::Path {
    const MonteCarlo& light;
    Dice& dice;
    std::vector<Vector3d> lamps_m;  // drawn on the emitters
    double floor = 0.0;
    double veil = 0.0;
    double late = 0.0;  // of both, from the second half of the turns

    struct Vertex {
        Vector3d place_m;
        Vector3d arriving;  // the path's direction
        bool is_floor;
        bool has_met_floor;
        double weight;
        int turns;  // so far
    };

    void see(const Vertex& at, double radiance) {
        (at.has_met_floor ? floor : veil) += radiance;
        if (at.turns > light.options_.most_turns / 2) late += radiance;
    }

    // The distance to the floor.
    [[nodiscard]] double reach_m(const Vector3d& from_m, const Vector3d& direction) const {
        const double approach = light.down_.dot(direction);
        if (approach <= 0.0) return kForever;
        return std::max(0.0, down_cosine_height(light.rig_, light.down_, from_m)) / approach;
    }

    // The probability density of this direction for the path.
    [[nodiscard]] double density(const Vertex& at, const Vector3d& direction) const {
        if (at.is_floor) return std::max(0.0, -light.down_.dot(direction)) / std::numbers::pi;
        return light.turns_.density(angle_between(at.arriving, direction));
    }

    [[nodiscard]] Vector3d next_direction(const Vertex& at) const {
        const double azimuth = 2.0 * std::numbers::pi * dice.roll();
        if (at.is_floor) {
            return turned(-light.down_, std::asin(std::sqrt(dice.roll())), azimuth);
        }
        return turned(at.arriving, light.turns_.quantile(dice.roll()), azimuth);
    }

    // The geometry of a vertex, a direction from it, and a lamp.
    struct Triangle {
        double far_m;  // D
        double h_m;
        double foot_m;
        double from;  // of the angle at the lamp
        double to;
        Triangle(const Vector3d& to_lamp, const Vector3d& direction, double reach_m, double least)
            : far_m(to_lamp.norm()),
              h_m(to_lamp.cross(direction).norm()),
              foot_m(to_lamp.dot(direction)),
              from(std::max(std::atan2(-foot_m, h_m), least - 0.5 * std::numbers::pi)),
              to(std::isfinite(reach_m) ? std::atan2(reach_m - foot_m, h_m)
                                        : 0.5 * std::numbers::pi) {}
    };

    // I exp(-c (s + d)), with w from the lamp to y.
    [[nodiscard]] double arriving_from(std::size_t s, const Vector3d& w, double path_m) const {
        const Source& source = light.sources_[s];
        return source.flux * source.beam.intensity(w) *
               std::exp(-light.attenuation_per_m_ * path_m);
    }

    // The combined density of all ways to draw y.
    void join_over(const Vertex& at, std::size_t s, const Vector3d& y_m) {
        const Vector3d to_y = y_m - at.place_m;
        const Vector3d to_lamp = lamps_m[s] - at.place_m;
        const double s_m = to_y.norm();
        const double d_m = (y_m - lamps_m[s]).norm();
        if (s_m == 0.0 || d_m == 0.0) return;
        const Vector3d direction = to_y / s_m;
        const double reach = at.is_floor ? kForever : reach_m(at.place_m, direction);
        if (s_m > reach) return;
        const double onwards = density(at, direction);
        const double psi = angle_between((y_m - lamps_m[s]) / d_m, -direction);
        const double turn = light.turns_.density(psi);
        if (onwards == 0.0 || turn == 0.0) return;
        const Triangle triangle(to_lamp, direction, reach, light.turns_.least_rad());
        const double width = triangle.to - triangle.from;
        const double by_path = width > 0.0 ? onwards * triangle.h_m / width : 0.0;
        const double by_turn = turn * std::sin(psi) / psi * triangle.far_m;
        const double by_lamp =
            d_m < triangle.far_m ? s_m * s_m / (4.0 * std::numbers::pi * triangle.far_m) : 0.0;
        const double drawn = by_path + by_turn + by_lamp;
        if (!(drawn > 0.0)) return;
        see(at,
            at.weight * light.turns_.scattering_per_m() *
                arriving_from(s, y_m - lamps_m[s], s_m + d_m) * onwards * turn / drawn);
    }

    void join_along(const Vertex& at, const Vector3d& direction, double reach_m) {
        for (std::size_t s = 0; s < lamps_m.size(); ++s) {
            const Triangle triangle(
                lamps_m[s] - at.place_m, direction, reach_m, light.turns_.least_rad());
            const double phi = std::lerp(triangle.from, triangle.to, dice.roll());
            if (!(triangle.to > triangle.from) || triangle.h_m == 0.0) continue;
            const double s_m = triangle.foot_m + triangle.h_m * std::tan(phi);
            join_over(at, s, at.place_m + s_m * direction);
        }
    }

    void join_by_turn(const Vertex& at) {
        for (std::size_t s = 0; s < lamps_m.size(); ++s) {
            const double psi = light.turns_.quantile(dice.roll());
            const double alpha = psi * dice.roll();
            const double azimuth = 2.0 * std::numbers::pi * dice.roll();
            const Vector3d to_lamp = lamps_m[s] - at.place_m;
            const double far_m = to_lamp.norm();
            if (far_m == 0.0 || std::sin(psi) <= 0.0) continue;
            const double s_m = far_m * std::sin(psi - alpha) / std::sin(psi);
            join_over(at, s, at.place_m + s_m * turned(to_lamp / far_m, alpha, azimuth));
        }
    }

    void join_about_lamp(const Vertex& at) {
        for (std::size_t s = 0; s < lamps_m.size(); ++s) {
            const double cosine = 2.0 * dice.roll() - 1.0;
            const double azimuth = 2.0 * std::numbers::pi * dice.roll();
            const double d_m = dice.roll() * (lamps_m[s] - at.place_m).norm();
            join_over(
                at, s, lamps_m[s] + d_m * turned(Vector3d::UnitZ(), std::acos(cosine), azimuth));
        }
    }

    // For a ray of given direction: y is drawn evenly over the angle at the lamp.
    void join_on_sight(const VeilRay& ray, double stratum) {
        for (std::size_t s = 0; s < lamps_m.size(); ++s) {
            const Triangle triangle(
                lamps_m[s] - ray.origin_m, ray.direction, ray.length_m, light.turns_.least_rad());
            if (!(triangle.to > triangle.from) || triangle.h_m == 0.0) continue;
            const double phi = std::lerp(triangle.from, triangle.to, stratum);
            const double s_m = triangle.foot_m + triangle.h_m * std::tan(phi);
            const Vector3d w = ray.origin_m + s_m * ray.direction - lamps_m[s];
            veil += light.turns_.scattering_per_m() *
                    light.turns_.density(phi + 0.5 * std::numbers::pi) *
                    arriving_from(s, w, s_m + triangle.h_m / std::cos(phi)) *
                    (triangle.to - triangle.from) / triangle.h_m;
        }
    }

    void join_straight(const Vertex& at) {
        for (std::size_t s = 0; s < lamps_m.size(); ++s) {
            const Vector3d w = at.place_m - lamps_m[s];
            const double d_m = w.norm();
            const double cosine = down_cosine_height(light.rig_, light.down_, lamps_m[s]) / d_m;
            if (!(cosine > 0.0)) continue;
            see(at, at.weight * cosine / std::numbers::pi * arriving_from(s, w, d_m) / (d_m * d_m));
        }
    }

    // A path's remaining importance: a random walk at distance D from the pupil returns with a
    // probability of about 1/(c D). Without this, paths in water that absorbs nothing stray for
    // thousands of turns.
    [[nodiscard]] double importance(const Vertex& at) const {
        return at.weight / (1.0 + light.attenuation_per_m_ * at.place_m.norm());
    }

    // Follows the path from a vertex to its end.
    void follow(Vertex at) {
        const double c = light.attenuation_per_m_;
        const double b = light.turns_.scattering_per_m();
        const double least = kLeastShare * importance(at);
        for (;;) {
            if (at.is_floor) {
                at.has_met_floor = true;
                at.weight *= light.reflectance_;
                join_straight(at);
            }
            if (at.turns >= light.options_.most_turns || b == 0.0) return;
            const double chance = importance(at) / least;
            if (chance < 1.0) {
                if (dice.roll() >= chance) return;
                at.weight /= chance;
            }
            const Vector3d direction = next_direction(at);
            const double reach = at.is_floor ? kForever : reach_m(at.place_m, direction);
            join_along(at, direction, reach);
            join_by_turn(at);
            join_about_lamp(at);
            const double flight_m = -std::log1p(-dice.roll()) / c;
            at.place_m += std::min(flight_m, reach) * direction;
            at.arriving = direction;
            at.is_floor = flight_m >= reach;
            if (at.is_floor) continue;
            at.weight *= b / c;
            ++at.turns;
        }
    }

    void trace(const VeilRay& ray, double stratum) {
        const double c = light.attenuation_per_m_;
        const double b = light.turns_.scattering_per_m();
        // Paths that reach the floor and those that do not, each with its share: little light comes
        // from the floor in turbid water, and little from elsewhere in clear water.
        const double through = std::isfinite(ray.length_m) ? std::exp(-c * ray.length_m) : 0.0;
        if (through > 0.0) {
            follow({.place_m = ray.origin_m + ray.length_m * ray.direction,
                    .arriving = ray.direction,
                    .is_floor = true,
                    .has_met_floor = true,
                    .weight = through,
                    .turns = 0});
        }
        if (b == 0.0 || light.options_.most_turns < 1) return;
        join_on_sight(ray, stratum);
        if (light.options_.most_turns < 2) return;
        const double flight_m = -std::log1p(-dice.roll() * (1.0 - through)) / c;
        follow({.place_m = ray.origin_m + flight_m * ray.direction,
                .arriving = ray.direction,
                .is_floor = false,
                .has_met_floor = false,
                .weight = (1.0 - through) * b / c,
                .turns = 1});
    }
};

MonteCarlo::MonteCarlo(const Rig& rig, double lambda_nm, const MonteCarloOptions& options)
    : rig_(rig),
      options_(options),
      turns_(TracedWater(rig.water), lambda_nm, options.least_turn_rad),
      reflectance_(rig.seafloor.reflectance.at(lambda_nm)),
      down_(-std::sin(rig.sled.pitch_rad),
            std::cos(rig.sled.pitch_rad) * std::sin(rig.sled.roll_rad),
            std::cos(rig.sled.pitch_rad) * std::cos(rig.sled.roll_rad)) {
    if (!rig.objects.empty()) throw InputError("Monte Carlo: found objects; allowed: a bare floor");
    if (rig.seafloor.phong > 0.0)
        throw InputError("Monte Carlo: found a floor with a highlight; allowed: phong = 0");
    const double absorption =
        rig.water.multiple == 0.0 ? 0.0 : rig.water.absorption_per_m.at(lambda_nm);
    attenuation_per_m_ =
        rig.water.multiple * absorption + rig.water.uniform_loss_per_m + turns_.scattering_per_m();
    for (const Strobe& strobe : rig.strobes) {
        const StrobeSides sides = sides_about(strobe.axis);
        const Emitter emitter = strobe.emitter.value_or(Emitter{});
        sources_.push_back({.beam = TracedBeam(strobe.beam, strobe.axis),
                            .position_m = strobe.position_m,
                            .across_m = emitter.across_m * sides.across,
                            .along_m = emitter.along_m * sides.along,
                            .flux = strobe.power * strobe.spectrum.at(lambda_nm)});
    }
}

LightOfAllOrders MonteCarlo::radiance(const VeilRay& ray, std::uint64_t stream) const {
    Dice dice(options_.seed, stream);
    Tally floor;
    Tally veil;
    Tally sum;
    Tally late;
    Path path{.light = *this, .dice = dice, .lamps_m = {}};
    for (std::size_t n = 0; n < options_.paths; ++n) {
        path.lamps_m.clear();
        for (const Source& source : sources_) {
            path.lamps_m.push_back(source.position_m + (dice.roll() - 0.5) * source.across_m +
                                   (dice.roll() - 0.5) * source.along_m);
        }
        path.floor = 0.0;
        path.veil = 0.0;
        path.late = 0.0;
        const double stratum =
            (static_cast<double>(n) + dice.roll()) / static_cast<double>(options_.paths);
        path.trace(ray, stratum);
        floor.add(path.floor);
        veil.add(path.veil);
        sum.add(path.floor + path.veil);
        late.add(path.late);
    }
    const double later_over_late = 1.0 / (std::numbers::sqrt2 - 1.0);
    return {floor.of(options_.paths),
            veil.of(options_.paths),
            sum.of(options_.paths),
            later_over_late * late.of(options_.paths).mean};
}

}  // namespace aphotic
