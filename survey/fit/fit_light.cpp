// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_light.h"

#include "base/lagrange.h"
#include "rig/camera/lens.h"
#include "rig/camera/vignetting.h"
#include "rig/geometry.h"
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

struct NodeWeight {
    std::size_t node;
    double weight;
};

// Nodes along one way of the image, from the first place to the last: each place its own, or one
// for any two, but neither under kFewestVeilNodes nor over kFitVeilNodes.
struct VeilAxis {
    std::size_t nodes;
    bool has_each_its_own;
    double first;
    double apart;

    explicit VeilAxis(std::vector<double> places) {
        std::ranges::sort(places);
        first = places.front();
        const double last = places.back();
        places.erase(std::unique(places.begin(), places.end()), places.end());
        nodes =
            std::min(places.size(), std::clamp(places.size() / 2, kFewestVeilNodes, kFitVeilNodes));
        has_each_its_own = nodes == places.size();
        apart = nodes > 1 ? (last - first) / static_cast<double>(nodes - 1) : 1.0;
    }
    [[nodiscard]] double place(std::size_t node) const {
        return first + static_cast<double>(node) * apart;
    }
    [[nodiscard]] std::vector<NodeWeight> weights(double at) const {
        const double x = (at - first) / apart;
        if (has_each_its_own) return {{static_cast<std::size_t>(std::lround(x)), 1.0}};
        const auto cell = static_cast<std::size_t>(x);
        const std::size_t left = std::clamp<std::size_t>(cell, 1, nodes - 3) - 1;
        const std::array<double, 4> cubic = lagrange_weights(x - static_cast<double>(left));
        std::vector<NodeWeight> weights;
        for (std::size_t k = 0; k < cubic.size(); ++k) weights.push_back({left + k, cubic[k]});
        return weights;
    }
};

enum class LitBy { Floor, Water, End };

// Light of one lamp that some channels of a place get from one direction: a factor of the beam.
// End is what a longer ray would add of the veil, by length.
struct Lit {
    LitBy by{};
    std::size_t strobe = 0;
    std::size_t row = 0;  // of the place's, or node's, first channel
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
        case FitPart::FloorBrightness:
            return state.floor_brightness;
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

// What places and nodes have in common.
struct Scene {
    const FitState& state;
    const PathLight& light;
    Floor floor;
    std::vector<Lamp> lamps;
    bool has_slopes;
    std::size_t versions;  // of the light that are looked at; one of light without derivatives

    Scene(const Rig& rig,
          const FitState& in_state,
          const PathLight& in_light,
          const Sled& sled,
          bool in_has_slopes)
        : state(in_state),
          light(in_light),
          floor(floor_of({.altitude_m = sled.altitude_m + state.offset.altitude_m,
                          .pitch_rad = sled.pitch_rad + state.offset.pitch_rad,
                          .roll_rad = sled.roll_rad + state.offset.roll_rad})),
          has_slopes(in_has_slopes),
          versions(has_slopes ? light.versions() : 1) {
        for (std::size_t s = 0; s < rig.strobes.size(); ++s)
            lamps.push_back(lamp_of(rig, state, floor, s));
    }

    // Of each ray and each lamp: take(ray, landing, lamp). Rays that do not come down to the floor
    // end where `beyond` says; without it they are passed over.
    template <typename Take>
    void for_each_way(const std::vector<WaterRay>& rays,
                      const std::optional<Landing>& beyond,
                      std::size_t row,
                      Lit& lit,
                      const Take& take) const {
        lit.row = row;
        for (std::size_t r = 0; r < rays.size(); ++r) {
            std::optional<Landing> landing = landing_of(floor, rays[r]);
            if (!landing) landing = beyond;
            if (!landing) continue;
            lit.landing = &*landing;
            lit.first_channel = rays.size() == 1 ? 0 : r;
            lit.last_channel = rays.size() == 1 ? kChannels : r + 1;
            for (lit.strobe = 0; lit.strobe < lamps.size(); ++lit.strobe) {
                lit.lamp = &lamps[lit.strobe];
                take(rays[r], *landing, lamps[lit.strobe]);
            }
        }
    }
};

}  // namespace

namespace {

// The mean over a block by its neighbours' middles, along one way of a grid.
struct BlockMean {
    std::size_t first = 0;  // block
    std::vector<double> weights;
};

// By Lagrange's polynomial through the middles, at each of the block's pixels.
BlockMean mean_over(std::size_t block, std::size_t blocks, int block_px) {
    const std::size_t size = std::min(kMeanBlocks, blocks);
    const std::size_t before = std::min(block, size / 2);
    BlockMean mean{.first = std::min(block - before, blocks - size),
                   .weights = std::vector<double>(size, 0.0)};
    for (int pixel = 0; pixel < block_px; ++pixel) {
        const double at = static_cast<double>(block - mean.first) + (pixel + 0.5) / block_px - 0.5;
        for (std::size_t i = 0; i < size; ++i) {
            double share = 1.0 / block_px;
            for (std::size_t k = 0; k < size; ++k) {
                if (k == i) continue;
                share *= (at - static_cast<double>(k)) /
                         (static_cast<double>(i) - static_cast<double>(k));
            }
            mean.weights[i] += share;
        }
    }
    return mean;
}

Eigen::SparseMatrix<double, Eigen::RowMajor> means_over_blocks(const FitPlaces& places) {
    Eigen::SparseMatrix<double, Eigen::RowMajor> means;
    if (places.block_px < 2) return means;
    const auto across =
        static_cast<std::size_t>(std::ranges::count(places.rows, places.rows.front()));
    const std::size_t down = places.size() / across;
    std::vector<Eigen::Triplet<double>> weights;
    for (std::size_t place = 0; place < places.size(); ++place) {
        const BlockMean x = mean_over(place % across, across, places.block_px);
        const BlockMean y = mean_over(place / across, down, places.block_px);
        for (std::size_t j = 0; j < y.weights.size(); ++j) {
            for (std::size_t i = 0; i < x.weights.size(); ++i) {
                weights.emplace_back(static_cast<int>(place),
                                     static_cast<int>((y.first + j) * across + x.first + i),
                                     x.weights[i] * y.weights[j]);
            }
        }
    }
    means.resize(static_cast<Index>(places.size()), static_cast<Index>(places.size()));
    means.setFromTriplets(weights.begin(), weights.end());
    return means;
}

double vignetting_of(const std::vector<double>& a, double q) {
    return 1.0 + q * (a[0] + q * (a[1] + q * a[2]));
}

}  // namespace

FitLight::FitLight(const Rig& rig, const FitPlaces& places)
    : rig_(rig), places_(places), means_(means_over_blocks(places)) {
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
    const auto rays_at = [&](double column, double row) {
        Rays rays;
        for (const double nm : lambda_nm) rays.push_back(pixel_ray(rig, column, row, nm));
        return rays;
    };
    for (std::size_t i = 0; i < places.size(); ++i) {
        sights_.push_back({.rays = rays_at(places.columns[i], places.rows[i]),
                           .from_middle2 = radial_square(camera, places.columns[i], places.rows[i]),
                           .vignetting = vignetting_at(camera, places.columns[i], places.rows[i])});
    }
    if (!rig.water.scatters()) return;
    const VeilAxis across(places.columns);
    const VeilAxis down(places.rows);
    for (std::size_t j = 0; j < down.nodes; ++j) {
        for (std::size_t i = 0; i < across.nodes; ++i)
            veil_nodes_.push_back(rays_at(across.place(i), down.place(j)));
    }
    std::vector<Eigen::Triplet<double>> weights;
    for (std::size_t k = 0; k < places.size(); ++k) {
        for (const NodeWeight& y : down.weights(places.rows[k])) {
            for (const NodeWeight& x : across.weights(places.columns[k])) {
                weights.emplace_back(static_cast<int>(k),
                                     static_cast<int>(y.node * across.nodes + x.node),
                                     y.weight * x.weight);
            }
        }
    }
    from_nodes_.resize(static_cast<Index>(places.size()), static_cast<Index>(veil_nodes_.size()));
    from_nodes_.setFromTriplets(weights.begin(), weights.end());
}

std::size_t FitLight::part_columns(const FitState& state) {
    std::size_t columns = 0;
    for (const FitBeam& beam : state.beams) columns += beam.parts();
    return columns;
}

template <typename Scene, typename Add>
void FitLight::light_floor(const Scene& scene, const Add& add) const {
    const FitState& state = scene.state;
    std::vector<double> T(scene.light.versions() * kChannels);
    std::vector<double> T_by_length(T.size());
    Lit lit;
    lit.by_water.resize(scene.versions - 1);
    const auto take = [&](const WaterRay& ray, const Landing& landing, const Lamp& lamp) {
        const Vector3d way = ray.origin_m + landing.length_m * ray.direction - lamp.position_m;
        const double d = way.norm();
        const double d_by_length = way.dot(ray.direction) / d;
        lit.w = lamp.into_frame * way / d;
        const double spread =
            state.floor_brightness * state.power[lit.strobe] * lamp.height_m / (pi * d * d * d);
        const CubicTable& table = scene.light.floor(lit.strobe);
        table.at(d + landing.length_m, T.data());
        for (std::size_t c = lit.first_channel; c < lit.last_channel; ++c) {
            lit.light[c] = state.gain[c] * spread * T[c];
            for (std::size_t v = 1; v < scene.versions; ++v)
                lit.by_water[v - 1][c] = state.gain[c] * spread * T[v * kChannels + c];
        }
        if (scene.has_slopes) {
            table.slopes_at(d + landing.length_m, T_by_length.data());
            lit.w_by_length = (lamp.into_frame * ray.direction - lit.w * d_by_length) / d;
            for (std::size_t c = lit.first_channel; c < lit.last_channel; ++c) {
                lit.light_by_length[c] =
                    state.gain[c] * spread *
                    (T_by_length[c] * (1.0 + d_by_length) - 3.0 * T[c] * d_by_length / d);
            }
        }
        add(lit);
    };
    for (std::size_t place = 0; place < sights_.size(); ++place)
        scene.for_each_way(sights_[place].rays, std::nullopt, kChannels * place, lit, take);
}

template <typename Scene, typename Add>
void FitLight::light_water(const Scene& scene, const Add& add) const {
    const FitState& state = scene.state;
    const std::size_t scatterers = scene.light.scatterers();
    std::vector<double> V(scene.light.versions() * scatterers * kChannels);
    std::vector<double> p(scene.light.versions() * scatterers);
    Lit lit;
    lit.by_water.resize(scene.versions - 1);

    // Of scattered light at a point of the ray: factor times sum of p V.
    const auto scatter = [&](double factor, double psi, double path_m) {
        scene.light.phases().at(psi, p.data());
        scene.light.veil(lit.strobe).at(path_m, V.data());
        lit.light.fill(0.0);
        for (auto& by : lit.by_water) by.fill(0.0);
        for (std::size_t c = lit.first_channel; c < lit.last_channel; ++c) {
            const double of_channel = state.gain[c] * factor;
            for (std::size_t i = 0; i < scatterers; ++i) {
                const double value = V[i * kChannels + c];
                lit.light[c] += of_channel * p[i] * value;
                for (std::size_t v = 1; v < scene.versions; ++v) {
                    const std::size_t lane = v * scatterers + i;
                    lit.by_water[v - 1][c] +=
                        of_channel * (p[i] * V[lane * kChannels + c] + p[lane] * value);
                }
            }
        }
    };
    const auto take = [&](const WaterRay& ray, const Landing& landing, const Lamp& lamp) {
        const Vector3d from_lamp = ray.origin_m - lamp.position_m;
        const double foot_m = -from_lamp.dot(ray.direction);
        const Vector3d across = from_lamp + foot_m * ray.direction;
        const double away_m = std::max(across.norm(), kNear_m);
        const double last = std::atan2(landing.length_m - foot_m, away_m);
        const double first = std::max(std::atan2(-foot_m, away_m), kVeilCut - 0.5 * pi);
        if (last <= first) return;
        const double power = state.power[lit.strobe];
        lit.by = LitBy::Water;
        const VeilRule& rule = veil_rule();
        for (std::size_t i = 0; i < rule.points.size(); ++i) {
            const double phi = first + (last - first) * rule.points[i];
            const double t = foot_m + away_m * std::tan(phi);
            lit.w = lamp.into_frame * (from_lamp + t * ray.direction).normalized();
            scatter(power * rule.weights[i] * (last - first) / away_m,
                    phi + 0.5 * pi,
                    t + away_m / std::cos(phi));
            add(lit);
        }
        if (!scene.has_slopes) return;
        lit.by = LitBy::End;
        const Vector3d way = from_lamp + landing.length_m * ray.direction;
        const double d = way.norm();
        lit.w = lamp.into_frame * way / d;
        scatter(power / (d * d), last + 0.5 * pi, d + landing.length_m);
        add(lit);
    };
    // About as far as the longest path that is tabulated, there and back.
    const CubicTable& table = scene.light.veil(0);
    const Landing beyond{.length_m = 0.5 * table.place(table.nodes() - 1)};
    for (std::size_t node = 0; node < veil_nodes_.size(); ++node)
        scene.for_each_way(veil_nodes_[node], beyond, kChannels * node, lit, take);
}

void FitLight::add_between_nodes(const Rows& of_nodes, Rows& rows) const {
    // A place's three rows as one, and a node's.
    const Index columns = kChannels * rows.cols();
    const Eigen::Map<const Rows> from(of_nodes.data(), from_nodes_.cols(), columns);
    Eigen::Map<Rows>(rows.data(), from_nodes_.rows(), columns).noalias() += from_nodes_ * from;
}

void FitLight::average_over_blocks(Rows& rows) const {
    if (means_.size() == 0) return;
    const Index columns = kChannels * rows.cols();
    Rows means(rows.rows(), rows.cols());
    Eigen::Map<Rows>(means.data(), means_.rows(), columns).noalias() =
        means_ * Eigen::Map<const Rows>(rows.data(), means_.cols(), columns);
    rows.swap(means);
}

bool FitLight::is_bright(const FitState& state) const {
    constexpr int kRadii = 64;
    const Camera& camera = rig_.camera;
    double farthest2 = 0.0;
    for (const int column : {0, camera.width_px})
        for (const int row : {0, camera.height_px})
            farthest2 = std::max(farthest2, radial_square(camera, column, row));
    for (int i = 0; i <= kRadii && !state.vignetting.empty(); ++i) {
        if (vignetting_of(state.vignetting, farthest2 * i / kRadii) <= 0.0) return false;
    }
    return true;
}

void FitLight::multiply_by_vignetting(const FitState& state, Rows& rows) const {
    for (std::size_t place = 0; place < sights_.size(); ++place) {
        const double q = sights_[place].from_middle2;
        const double V = state.vignetting.empty() ? sights_[place].vignetting
                                                  : vignetting_of(state.vignetting, q);
        rows.middleRows(static_cast<Index>(kChannels * place), kChannels) *= V;
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
    std::vector<BeamPartValue> values;
    const auto add_to = [&](Rows& lit_rows) {
        return [&](const Lit& lit) {
            const std::size_t b = state.beam_of[lit.strobe];
            state.beams[b].at(lit.w, false, values);
            for (const BeamPartValue& value : values) {
                const Index column = first_part[b] + static_cast<Index>(value.part);
                for (std::size_t c = lit.first_channel; c < lit.last_channel; ++c)
                    lit_rows(static_cast<Index>(lit.row + c), column) += value.value * lit.light[c];
            }
        };
    };
    const Scene scene(rig_, state, light, sled, false);
    rows_of.setZero(static_cast<Index>(rows()), parts);
    light_floor(scene, add_to(rows_of));
    if (light.scatterers() > 0) {
        Rows of_nodes = Rows::Zero(static_cast<Index>(kChannels * veil_nodes_.size()), parts);
        light_water(scene, add_to(of_nodes));
        add_between_nodes(of_nodes, rows_of);
    }
    multiply_by_vignetting(state, rows_of);
    average_over_blocks(rows_of);
}

void FitLight::columns_into(const FitState& state,
                            const PathLight& light,
                            const Sled& sled,
                            const Eigen::VectorXd& shares,
                            const std::vector<FitNumber>& numbers,
                            Rows& all) const {
    constexpr Index kHeld = -1;
    const auto count = static_cast<Index>(numbers.size());
    const auto first_number = static_cast<Index>(part_columns(state));
    const auto column_of = [&](FitPart part, std::size_t of, std::size_t which) {
        const auto at = std::find_if(numbers.begin(), numbers.end(), [&](const FitNumber& n) {
            return n.part == part && n.of == of && n.which == which;
        });
        return at == numbers.end() ? kHeld
                                   : first_number + static_cast<Index>(at - numbers.begin());
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

    const Index of_pose = first_number + count;
    const Index of_floor = of_pose + static_cast<Index>(kPoseColumns);
    const Index of_signal = of_floor + 1;
    std::vector<BeamPartValue> values;
    const auto add_to = [&](Rows& lit_rows) {
        return [&](const Lit& lit) {
            const std::size_t b = state.beam_of[lit.strobe];
            state.beams[b].at(lit.w, true, values);
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
                auto row = lit_rows.row(static_cast<Index>(lit.row + c));
                const double value = I * lit.light[c];
                const auto add = [&](Index column, double slope) {
                    if (column != kHeld) row(column) += slope;
                };
                if (lit.by == LitBy::End) {
                    for (std::size_t q = 0; q < kPoseColumns; ++q)
                        row(of_pose + static_cast<Index>(q)) += value * lit.landing->length_by[q];
                    continue;
                }
                for (const BeamPartValue& part : values)
                    row(first_part[b] + static_cast<Index>(part.part)) += part.value * lit.light[c];
                row(of_signal) += value;
                if (lit.by == LitBy::Floor) row(of_floor) += value;
                add(of.aim[0], by_aim(0) * lit.light[c]);
                add(of.aim[1], by_aim(1) * lit.light[c]);
                add(of.power, value / state.power[lit.strobe]);
                for (std::size_t k = 0; k < 2; ++k) add(of.shape[k], by_shape[k] * lit.light[c]);
                // None of light without derivatives.
                for (std::size_t k = 0; k < lit.by_water.size(); ++k)
                    add(water[k], I * lit.by_water[k][c]);
                if (lit.by == LitBy::Water) continue;
                const double by_length =
                    I * lit.light_by_length[c] + gradient.dot(lit.w_by_length) * lit.light[c];
                for (std::size_t q = 0; q < kPoseColumns; ++q) {
                    row(of_pose + static_cast<Index>(q)) +=
                        by_length * lit.landing->length_by[q] +
                        value / lit.lamp->height_m * lit.lamp->height_by[q];
                }
            }
        };
    };
    const Scene scene(rig_, state, light, sled, true);
    all.setZero(static_cast<Index>(rows()), of_signal + 1);
    light_floor(scene, add_to(all));
    if (light.scatterers() > 0) {
        Rows of_nodes =
            Rows::Zero(static_cast<Index>(kChannels * veil_nodes_.size()), of_signal + 1);
        light_water(scene, add_to(of_nodes));
        add_between_nodes(of_nodes, all);
    }
    const Eigen::VectorXd without_lens = all.col(of_signal);
    multiply_by_vignetting(state, all);

    for (Index k = 0; k < count; ++k) {
        const FitNumber& number = numbers[static_cast<std::size_t>(k)];
        if (number.part == FitPart::Offset)
            all.col(first_number + k) = all.col(of_pose + static_cast<Index>(number.which));
        if (number.part == FitPart::FloorBrightness)
            all.col(first_number + k) = all.col(of_floor) / state.floor_brightness;
        for (Index row = 0; row < all.rows(); ++row) {
            const auto at = static_cast<std::size_t>(row);
            if (number.part == FitPart::Gain && at % kChannels == number.of)
                all(row, first_number + k) = all(row, of_signal) / state.gain[number.of];
            if (number.part == FitPart::LensFactor) {
                all(row, first_number + k) =
                    without_lens(row) * std::pow(sights_[at / kChannels].from_middle2,
                                                 static_cast<double>(number.which + 1));
            }
        }
    }
    average_over_blocks(all);
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

double FitLight::block_rad() const {
    const double column = 0.5 * places_.width_px;
    const double row = 0.5 * places_.height_px;
    const double nm = 0.5 * (rig_.camera.range.first_nm + rig_.camera.range.last_nm);
    const Vector3d one = pixel_ray(rig_, column, row, nm).direction;
    const Vector3d other = pixel_ray(rig_, column + 0.5 * places_.block_px, row, nm).direction;
    return 2.0 * std::acos(std::min(1.0, one.dot(other)));
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
