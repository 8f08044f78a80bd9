// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit_light.h"

#include "rig/geometry.h"
#include "rig/lens.h"
#include "rig/vignetting.h"
#include "spectral/bands.h"

#include <Eigen/Geometry>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kNear_m = 1e-6;  // a lamp is never nearer to a ray

// The floor under a sled, and how it moves with altitude, pitch and roll.
struct Floor {
    Vector3d up;
    Vector3d point_m;
    std::array<Vector3d, FitLight::kPoseColumns> up_by;
    std::array<Vector3d, FitLight::kPoseColumns> point_by;
};

Floor floor_of(const Sled& sled) {
    const double cp = std::cos(sled.pitch_rad);
    const double sp = std::sin(sled.pitch_rad);
    const double cq = std::cos(sled.roll_rad);
    const double sq = std::sin(sled.roll_rad);
    const Vector3d zero = Vector3d::Zero();
    return {.up = {sp, -cp * sq, -cp * cq},
            .point_m = {0.0, 0.0, sled.altitude_m},
            .up_by = {zero, Vector3d(cp, sp * sq, sp * cq), Vector3d(0.0, -cp * cq, cp * sq)},
            .point_by = {Vector3d::UnitZ(), zero, zero}};
}

// Where a ray meets the floor, and how that moves.
struct Landing {
    double length_m = 0.0;
    std::array<double, FitLight::kPoseColumns> length_by{};
};

std::optional<Landing> landing_of(const Floor& floor, const WaterRay& ray) {
    const Vector3d to_point = floor.point_m - ray.origin_m;
    const double fall = floor.up.dot(ray.direction);
    if (fall >= 0.0) return std::nullopt;
    Landing landing{.length_m = floor.up.dot(to_point) / fall};
    if (landing.length_m <= 0.0) return std::nullopt;
    for (std::size_t q = 0; q < FitLight::kPoseColumns; ++q) {
        landing.length_by[q] = (floor.up_by[q].dot(to_point) + floor.up.dot(floor.point_by[q]) -
                                landing.length_m * floor.up_by[q].dot(ray.direction)) /
                               fall;
    }
    return landing;
}

struct Lamp {
    Vector3d position_m;
    Matrix3d into_frame;  // rows: along, across, axis
    double height_m;
    std::array<double, FitLight::kPoseColumns> height_by{};
};

Lamp lamp_of(const Rig& rig, const FitState& state, const Floor& floor, std::size_t strobe) {
    const BeamFrame frame = frame_about(aimed_axis(rig, state, strobe));
    Lamp lamp{.position_m = rig.strobes[strobe].position_m, .into_frame = {}, .height_m = 0.0};
    lamp.into_frame.row(0) = frame.along;
    lamp.into_frame.row(1) = frame.across;
    lamp.into_frame.row(2) = frame.axis;
    const Vector3d from_floor = lamp.position_m - floor.point_m;
    lamp.height_m = floor.up.dot(from_floor);
    for (std::size_t q = 0; q < FitLight::kPoseColumns; ++q)
        lamp.height_by[q] = floor.up_by[q].dot(from_floor) - floor.up.dot(floor.point_by[q]);
    return lamp;
}

enum class LitBy { Floor, Water, End };

// Light of one lamp that some channels of a place get from one direction: a factor of the beam.
// End is what a longer ray would add of the veil, by length.
struct Lit {
    LitBy by{};
    std::size_t strobe = 0;
    std::size_t row = 0;  // of the place's first channel
    std::size_t first_channel = 0;
    std::size_t last_channel = 0;
    Vector3d w;
    std::array<double, kChannels> light{};
    std::vector<std::array<double, kChannels>> by_water{};
    // Of the floor's, with the ray's length.
    std::array<double, kChannels> light_by_length{};
    Vector3d w_by_length = Vector3d::Zero();
    const Landing* landing = nullptr;
    const Lamp* lamp = nullptr;
};

struct VeilRule {
    std::vector<double> points;  // on 0 to 1
    std::vector<double> weights;
};

const VeilRule& veil_rule() {
    static const VeilRule kRule = [] {
        using Gauss = boost::math::quadrature::gauss<double, kFitVeilPoints>;
        VeilRule made;
        for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
            for (const double sign : {-1.0, 1.0}) {
                made.points.push_back(0.5 + 0.5 * sign * Gauss::abscissa()[i]);
                made.weights.push_back(0.5 * Gauss::weights()[i]);
            }
        }
        return made;
    }();
    return kRule;
}

}  // namespace

double& number_in(FitState& state, const FitNumber& number) {
    switch (number.part) {
        case FitPart::Water:
            return state.water[number.of].value;
        case FitPart::FloorColour:
            return state.floor[number.which];
        case FitPart::Aim:
            return state.aim_rad[number.of][number.which];
        case FitPart::Power:
            return state.power[number.of];
        case FitPart::LensFactor:
            return state.vignetting[number.which];
        case FitPart::Gain:
            return state.gain[number.of];
        case FitPart::Offset:
            return number.which == 0   ? state.offset.altitude_m
                   : number.which == 1 ? state.offset.pitch_rad
                                       : state.offset.roll_rad;
        case FitPart::BeamShape:
            break;
    }
    return state.beams[number.of].shape(number.which);
}

Vector3d aimed_axis(const Rig& rig, const FitState& state, std::size_t strobe) {
    const BeamFrame frame = frame_about(rig.strobes[strobe].axis);
    const auto& [along_rad, across_rad] = state.aim_rad[strobe];
    return (frame.axis + std::tan(along_rad) * frame.along + std::tan(across_rad) * frame.across)
        .normalized();
}

namespace {

// How the axis moves with the two angles, in the frame about it: a column each, of along and
// across.
Eigen::Matrix2d turns_of_axis(const Rig& rig, const FitState& state, std::size_t strobe) {
    const BeamFrame was = frame_about(rig.strobes[strobe].axis);
    const Vector3d axis = aimed_axis(rig, state, strobe);
    const BeamFrame now = frame_about(axis);
    const double size = 1.0 / axis.dot(was.axis);  // before it was made a unit vector
    Eigen::Matrix2d turns;
    for (Index k = 0; k < 2; ++k) {
        const double cosine = std::cos(state.aim_rad[strobe][static_cast<std::size_t>(k)]);
        const Vector3d by = (k == 0 ? was.along : was.across) / (cosine * cosine * size);
        turns.col(k) << by.dot(now.along), by.dot(now.across);
    }
    return turns;
}

}  // namespace

FitLight::FitLight(const Rig& rig, const FitPlaces& places) : rig_(rig), places_(places) {
    const Camera& camera = rig.camera;
    std::vector<double> lambda_nm;
    if (camera.port) {
        for (int c = 0; c < kChannels; ++c) {
            double sum = 0.0;
            double moment = 0.0;
            for (const WeightedWavelength& band : equal_bands(camera.sensor, camera.range, 100)) {
                const double weight = band.weight[static_cast<std::size_t>(c)];
                sum += weight;
                moment += weight * band.lambda_nm;
            }
            lambda_nm.push_back(moment / sum);
        }
    } else {
        lambda_nm.push_back(0.5 * (camera.range.first_nm + camera.range.last_nm));
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
        Place sight;
        for (const double nm : lambda_nm)
            sight.rays.push_back(pixel_ray(rig, places.columns[i], places.rows[i], nm));
        sight.vignetting = vignetting_at(camera, places.columns[i], places.rows[i]);
        sight.from_middle2 = radial_square(camera, places.columns[i], places.rows[i]);
        sights_.push_back(std::move(sight));
    }
}

std::size_t FitLight::part_columns(const FitState& state) {
    std::size_t columns = 0;
    for (const FitBeam& beam : state.beams) columns += beam.parts();
    return columns;
}

template <typename Add>
void FitLight::light_up(const FitState& state,
                        const PathLight& light,
                        const Sled& sled,
                        bool has_slopes,
                        const Add& add) const {
    const Floor floor = floor_of({.altitude_m = sled.altitude_m + state.offset.altitude_m,
                                  .pitch_rad = sled.pitch_rad + state.offset.pitch_rad,
                                  .roll_rad = sled.roll_rad + state.offset.roll_rad});
    std::vector<Lamp> lamps;
    for (std::size_t s = 0; s < rig_.strobes.size(); ++s)
        lamps.push_back(lamp_of(rig_, state, floor, s));

    const std::size_t versions = has_slopes ? light.versions() : 1;
    const std::size_t scatterers = light.scatterers();
    std::vector<double> T(light.versions() * kChannels);
    std::vector<double> T_by_length(T.size());
    std::vector<double> V(light.versions() * std::max<std::size_t>(1, scatterers) * kChannels);
    std::vector<double> p(light.versions() * std::max<std::size_t>(1, scatterers));
    Lit lit;
    lit.by_water.resize(versions - 1);

    // Of scattered light at a point of the ray: factor times sum of p V.
    const auto scatter = [&](double factor, double psi, double path_m) {
        light.phases().at(psi, p.data());
        light.veil(lit.strobe).at(path_m, V.data());
        lit.light.fill(0.0);
        for (auto& by : lit.by_water) by.fill(0.0);
        for (std::size_t i = 0; i < scatterers; ++i) {
            for (std::size_t c = lit.first_channel; c < lit.last_channel; ++c) {
                const double value = V[i * kChannels + c];
                lit.light[c] += factor * p[i] * value;
                for (std::size_t v = 1; v < versions; ++v) {
                    const std::size_t lane = v * scatterers + i;
                    lit.by_water[v - 1][c] +=
                        factor * (p[i] * V[lane * kChannels + c] + p[lane] * value);
                }
            }
        }
    };

    for (std::size_t place = 0; place < sights_.size(); ++place) {
        const Place& sight = sights_[place];
        double V_lens = sight.vignetting;
        if (!state.vignetting.empty()) {
            const double q = sight.from_middle2;
            V_lens = 1.0 + q * (state.vignetting[0] +
                                q * (state.vignetting[1] + q * state.vignetting[2]));
        }
        lit.row = kChannels * place;
        for (std::size_t r = 0; r < sight.rays.size(); ++r) {
            const WaterRay& ray = sight.rays[r];
            const std::optional<Landing> landing = landing_of(floor, ray);
            if (!landing) continue;
            lit.landing = &*landing;
            lit.first_channel = sight.rays.size() == 1 ? 0 : r;
            lit.last_channel = sight.rays.size() == 1 ? kChannels : r + 1;
            const Vector3d seen_m = ray.origin_m + landing->length_m * ray.direction;
            for (std::size_t s = 0; s < lamps.size(); ++s) {
                const Lamp& lamp = lamps[s];
                lit.strobe = s;
                lit.lamp = &lamp;
                // Of what all channels share.
                const double common = V_lens * state.power[s];
                const Vector3d way = seen_m - lamp.position_m;
                const double d = way.norm();
                const double d_by_length = way.dot(ray.direction) / d;
                lit.by = LitBy::Floor;
                lit.w = lamp.into_frame * way / d;
                const double spread = common * lamp.height_m / (pi * d * d * d);
                light.floor(s).at(d + landing->length_m, T.data());
                for (std::size_t c = lit.first_channel; c < lit.last_channel; ++c) {
                    lit.light[c] = state.gain[c] * spread * T[c];
                    for (std::size_t v = 1; v < versions; ++v)
                        lit.by_water[v - 1][c] = state.gain[c] * spread * T[v * kChannels + c];
                }
                if (has_slopes) {
                    light.floor(s).slopes_at(d + landing->length_m, T_by_length.data());
                    lit.w_by_length = (lamp.into_frame * ray.direction - lit.w * d_by_length) / d;
                    for (std::size_t c = lit.first_channel; c < lit.last_channel; ++c) {
                        lit.light_by_length[c] =
                            state.gain[c] * spread *
                            (T_by_length[c] * (1.0 + d_by_length) - 3.0 * T[c] * d_by_length / d);
                    }
                }
                add(lit);
                if (scatterers == 0) continue;

                const Vector3d from_lamp = ray.origin_m - lamp.position_m;
                const double foot_m = -from_lamp.dot(ray.direction);
                const Vector3d across = from_lamp + foot_m * ray.direction;
                const double away_m = std::max(across.norm(), kNear_m);
                const double last = std::atan2(landing->length_m - foot_m, away_m);
                const double first = std::max(std::atan2(-foot_m, away_m), kVeilCut - 0.5 * pi);
                if (last <= first) continue;
                lit.by = LitBy::Water;
                const VeilRule& rule = veil_rule();
                for (std::size_t i = 0; i < rule.points.size(); ++i) {
                    const double phi = first + (last - first) * rule.points[i];
                    const double t = foot_m + away_m * std::tan(phi);
                    lit.w = lamp.into_frame * (from_lamp + t * ray.direction).normalized();
                    scatter(common * rule.weights[i] * (last - first) / away_m,
                            phi + 0.5 * pi,
                            t + away_m / std::cos(phi));
                    for (std::size_t c = lit.first_channel; c < lit.last_channel; ++c) {
                        lit.light[c] *= state.gain[c];
                        for (auto& by : lit.by_water) by[c] *= state.gain[c];
                    }
                    add(lit);
                }
                if (!has_slopes) continue;
                lit.by = LitBy::End;
                lit.w = lamp.into_frame * way / d;
                scatter(common / (d * d), last + 0.5 * pi, d + landing->length_m);
                for (std::size_t c = lit.first_channel; c < lit.last_channel; ++c)
                    lit.light[c] *= state.gain[c];
                add(lit);
            }
        }
    }
}

void FitLight::parts_into(const FitState& state,
                          const PathLight& light,
                          const Sled& sled,
                          Rows& rows_of) const {
    std::vector<Index> first_part;
    Index parts = 0;
    for (const FitBeam& beam : state.beams) {
        first_part.push_back(parts);
        parts += static_cast<Index>(beam.parts());
    }
    rows_of.setZero(static_cast<Index>(rows()), parts);
    std::vector<BeamPartValue> values;
    light_up(state, light, sled, false, [&](const Lit& lit) {
        const std::size_t b = state.beam_of[lit.strobe];
        state.beams[b].at(lit.w, values);
        for (const BeamPartValue& value : values) {
            const Index column = first_part[b] + static_cast<Index>(value.part);
            for (std::size_t c = lit.first_channel; c < lit.last_channel; ++c)
                rows_of(static_cast<Index>(lit.row + c), column) += value.value * lit.light[c];
        }
    });
}

void FitLight::slopes_into(const FitState& state,
                           const PathLight& light,
                           const Sled& sled,
                           const Eigen::VectorXd& shares,
                           const std::vector<FitNumber>& numbers,
                           Rows& rows_of) const {
    constexpr Index kHeld = -1;
    const auto count = static_cast<Index>(numbers.size());
    const auto column_of = [&](FitPart part, std::size_t of, std::size_t which) {
        const auto at = std::find_if(numbers.begin(), numbers.end(), [&](const FitNumber& n) {
            return n.part == part && n.of == of && n.which == which;
        });
        return at == numbers.end() ? kHeld : static_cast<Index>(at - numbers.begin());
    };
    struct Columns {
        std::array<Index, 2> aim;
        Index power;
        std::array<Index, 2> shape;
        Eigen::Matrix2d turns;
    };
    std::vector<Columns> columns;
    std::vector<Index> first_part;
    Index parts = 0;
    for (const FitBeam& beam : state.beams) {
        first_part.push_back(parts);
        parts += static_cast<Index>(beam.parts());
    }
    for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
        const std::size_t b = state.beam_of[s];
        columns.push_back(
            {.aim = {column_of(FitPart::Aim, s, 0), column_of(FitPart::Aim, s, 1)},
             .power = column_of(FitPart::Power, s, 0),
             .shape = {column_of(FitPart::BeamShape, b, 0), column_of(FitPart::BeamShape, b, 1)},
             .turns = turns_of_axis(rig_, state, s)});
    }
    std::vector<Index> water;
    for (std::size_t k = 0; k < state.water.size(); ++k)
        water.push_back(column_of(FitPart::Water, k, 0));
    for (std::size_t k = 0; k < state.floor.size(); ++k)
        water.push_back(column_of(FitPart::FloorColour, 0, k));

    rows_of.setZero(static_cast<Index>(rows()), count + static_cast<Index>(kPoseColumns));
    std::vector<double> signal(rows(), 0.0);
    std::vector<BeamPartValue> values;
    light_up(state, light, sled, true, [&](const Lit& lit) {
        const std::size_t b = state.beam_of[lit.strobe];
        state.beams[b].at(lit.w, values);
        double I = 0.0;
        Vector3d gradient = Vector3d::Zero();
        std::array<double, 2> by_shape{};
        for (const BeamPartValue& value : values) {
            const double share = shares(first_part[b] + static_cast<Index>(value.part));
            I += share * value.value;
            gradient += share * value.gradient;
            for (std::size_t k = 0; k < 2; ++k) by_shape[k] += share * value.by_shape[k];
        }
        const Vector3d& w = lit.w;
        const Columns& of = columns[lit.strobe];
        const Eigen::RowVector2d by_aim =
            Eigen::RowVector2d(gradient.z() * w.x() - gradient.x() * w.z(),
                               gradient.z() * w.y() - gradient.y() * w.z()) *
            of.turns;
        for (std::size_t c = lit.first_channel; c < lit.last_channel; ++c) {
            const auto row = static_cast<Index>(lit.row + c);
            const double value = I * lit.light[c];
            const auto add_to = [&](Index column, double slope) {
                if (column != kHeld) rows_of(row, column) += slope;
            };
            if (lit.by == LitBy::End) {
                for (std::size_t q = 0; q < kPoseColumns; ++q)
                    rows_of(row, count + static_cast<Index>(q)) +=
                        value * lit.landing->length_by[q];
                continue;
            }
            signal[lit.row + c] += value;
            add_to(of.aim[0], by_aim(0) * lit.light[c]);
            add_to(of.aim[1], by_aim(1) * lit.light[c]);
            add_to(of.power, value / state.power[lit.strobe]);
            for (std::size_t k = 0; k < 2; ++k) add_to(of.shape[k], by_shape[k] * lit.light[c]);
            // None of light without derivatives.
            for (std::size_t k = 0; k < lit.by_water.size(); ++k)
                add_to(water[k], I * lit.by_water[k][c]);
            if (lit.by == LitBy::Water) continue;
            const double by_length =
                I * lit.light_by_length[c] + gradient.dot(lit.w_by_length) * lit.light[c];
            for (std::size_t q = 0; q < kPoseColumns; ++q) {
                rows_of(row, count + static_cast<Index>(q)) +=
                    by_length * lit.landing->length_by[q] +
                    value / lit.lamp->height_m * lit.lamp->height_by[q];
            }
        }
    });

    for (Index k = 0; k < count; ++k) {
        const FitNumber& number = numbers[static_cast<std::size_t>(k)];
        if (number.part == FitPart::Offset) {
            rows_of.col(k) = rows_of.col(count + static_cast<Index>(number.which));
        }
        if (number.part != FitPart::Gain && number.part != FitPart::LensFactor) continue;
        for (std::size_t row = 0; row < rows(); ++row) {
            const std::size_t c = row % kChannels;
            double& slope = rows_of(static_cast<Index>(row), k);
            if (number.part == FitPart::Gain) {
                if (c == number.of) slope = signal[row] / state.gain[c];
                continue;
            }
            const double q = sights_[row / kChannels].from_middle2;
            const double V = 1.0 + q * (state.vignetting[0] +
                                        q * (state.vignetting[1] + q * state.vignetting[2]));
            slope = signal[row] / V * q;
            for (std::size_t power = 0; power < number.which; ++power) slope *= q;
        }
    }
}

PathRange FitLight::paths(const std::vector<Sled>& sleds) const {
    constexpr double kRoom = 1.2;  // for offsets of the altitude
    PathRange range{.shortest_m = std::numeric_limits<double>::infinity(), .longest_m = 0.0};
    for (const Sled& sled : sleds) {
        const Floor floor = floor_of(sled);
        for (const Place& sight : sights_) {
            for (const WaterRay& ray : sight.rays) {
                const std::optional<Landing> landing = landing_of(floor, ray);
                if (!landing) continue;
                for (const Strobe& strobe : rig_.strobes) {
                    const Vector3d seen_m = ray.origin_m + landing->length_m * ray.direction;
                    const double path_m = landing->length_m + (seen_m - strobe.position_m).norm();
                    range.longest_m = std::max(range.longest_m, kRoom * path_m);
                    range.shortest_m =
                        std::min(range.shortest_m,
                                 rig_.water.scatters() ? (strobe.position_m - ray.origin_m).norm()
                                                       : path_m / kRoom);
                }
            }
        }
    }
    range.shortest_m = std::min(range.shortest_m, range.longest_m);
    return range;
}

double FitLight::widest_rad(const std::vector<Sled>& sleds) const {
    double widest_rad = 0.0;
    for (const Sled& sled : sleds) {
        const Floor floor = floor_of(sled);
        for (const Place& sight : sights_) {
            for (const WaterRay& ray : sight.rays) {
                const std::optional<Landing> landing = landing_of(floor, ray);
                if (!landing) continue;
                const Vector3d seen_m = ray.origin_m + landing->length_m * ray.direction;
                for (const Strobe& strobe : rig_.strobes) {
                    widest_rad = std::max(widest_rad,
                                          angle_between(strobe.axis, seen_m - strobe.position_m));
                }
            }
        }
    }
    widest_rad += kAimRoom_rad + (rig_.water.scatters() ? kVeilRoom_rad : 0.0);
    return std::min(widest_rad, 0.5 * pi);
}

}  // namespace aphotic
