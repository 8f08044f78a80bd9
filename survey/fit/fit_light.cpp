// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_light.h"

#include "light/dispersion.h"
#include "light/floor_arrival.h"
#include "light/floor_ray.h"
#include "light/tile_fit.h"
#include "rig/camera/lens.h"
#include "rig/camera/vignetting.h"
#include "rig/geometry.h"
#include "spectral/bands.h"

#include <ceres/jet.h>
#include <Eigen/Geometry>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kNear_m = 1e-6;  // least distance of a lamp from a ray

// Order: altitude, pitch and roll, then the aim along and across.
constexpr int kPose = FitLight::kPose;
constexpr int kAim = kPose;
using Jet = ceres::Jet<double, kAim + 2>;

using FloorJet = BasicPlane<Jet>;

FloorJet fixed(const Plane& floor) {
    return {.point_m = floor.point_m.cast<Jet>(), .normal = floor.normal.cast<Jet>()};
}

Jet height_above(const FloorJet& floor, const Vector3d& point_m) {
    return floor.normal.dot(point_m.cast<Jet>() - floor.point_m);
}

template <typename T>
Vector3<T> aimed(const Vector3d& axis, const T& along_rad, const T& across_rad) {
    using std::tan;
    const BeamFrame frame = frame_about(axis);
    return (frame.axis.cast<T>() + tan(along_rad) * frame.along.cast<T>() +
            tan(across_rad) * frame.across.cast<T>())
        .normalized();
}

struct LampJet {
    Vector3d position_m;
    Eigen::Matrix<Jet, 3, 3> into_frame;
};
LampJet lamp_of(const Strobe& strobe, const std::array<double, 2>& aim_rad) {
    const auto frame =
        frame_about<Jet>(aimed(strobe.axis, Jet(aim_rad[0], kAim), Jet(aim_rad[1], kAim + 1)));
    LampJet lamp{.position_m = strobe.position_m, .into_frame = {}};
    lamp.into_frame << frame.along.transpose(), frame.across.transpose(), frame.axis.transpose();
    return lamp;
}

BasicFloorRay<Jet> ray_to(const FloorJet& floor, const WaterRay& ray) {
    return {.origin_m = ray.origin_m,
            .direction = ray.direction,
            .down = -floor.normal.dot(ray.direction.cast<Jet>()),
            .height_m = height_above(floor, ray.origin_m)};
}

using Rows = BlockLight::Rows;
using GridShares = FitLight::Grids::Shares;

// Means over the blocks along a line from the values at their middles, extrapolated linearly at
// both ends.
GridShares means_over_blocks(std::size_t blocks, int block_px) {
    const auto count = static_cast<Index>(blocks);
    MatrixXd bend = MatrixXd::Zero(count, count);
    if (block_px >= 2 && count >= 4) {
        for (Index k = 1; k + 1 < count; ++k) bend.row(k).segment<3>(k - 1) << 1.0, -2.0, 1.0;
        bend.row(0) = 2.0 * bend.row(1) - bend.row(2);
        bend.row(count - 1) = 2.0 * bend.row(count - 2) - bend.row(count - 3);
    }
    return (MatrixXd::Identity(count, count) + bend / 24.0).sparseView();
}

// At the middles of blocks along a side of the image, from the veil's nodes.
GridShares from_nodes(std::size_t blocks, int block_px, int size_px) {
    MatrixXd shares(static_cast<Index>(blocks), kTilePoints);
    for (Index k = 0; k < shares.rows(); ++k) {
        const auto of_nodes =
            chebyshev_shares((2.0 * static_cast<double>(k) + 1.0) * block_px / size_px - 1.0);
        shares.row(k) = Eigen::RowVectorXd::Map(of_nodes.data(), kTilePoints);
    }
    return shares.sparseView();
}

void add_to_grid(const FitLight::Grids& grids, const Rows& from, Rows& to) {
    const Index numbers = kChannels * from.cols();  // of a place
    const Index across = grids.along.rows();
    Rows of_rows(grids.down.cols() * across, numbers);
    for (Index j = 0; j < grids.down.cols(); ++j) {
        const Index first = j * grids.along.cols();
        of_rows.middleRows(j * across, across).noalias() =
            grids.along *
            Eigen::Map<const Rows>(from.data() + first * numbers, grids.along.cols(), numbers);
    }
    Eigen::Map<Rows>(to.data(), grids.down.rows(), across * numbers).noalias() +=
        grids.down * Eigen::Map<const Rows>(of_rows.data(), grids.down.cols(), across * numbers);
}

double mean_wavelength_nm(const Camera& camera, std::size_t channel) {
    constexpr int kBands = 100;
    double sum = 0.0;
    double moment = 0.0;
    for (const WeightedWavelength& band : equal_bands(camera.sensor, camera.range, kBands)) {
        sum += band.weight[channel];
        moment += band.weight[channel] * band.lambda_nm;
    }
    return moment / sum;
}

}  // namespace

std::vector<double> powers_in(const FitState& state, const Rig& rig) {
    std::vector<double> powers;
    double all = 0.0;
    double was = 0.0;
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        powers.push_back(state.power[s] * state.beams[state.beam_of[s]].fitted().flux);
        all += powers.back();
        was += rig.strobes[s].power;
    }
    for (double& power : powers) power *= was / all;
    return powers;
}

double& number_in(FitState& state, const FitPlaceInState& at) {
    switch (at.part) {
        case FitPart::Water:
            return state.water[at.of].value;
        case FitPart::Tint:
            return state.tint[at.which];
        case FitPart::Brightness:
            return state.floor_brightness;
        case FitPart::Aim:
            return state.aim_rad[at.of][at.which];
        case FitPart::Power:
            return state.power[at.of];
        case FitPart::Lens:
            return state.vignetting[at.which];
        case FitPart::Offset:
            return at.which == 0   ? state.offset.altitude_m
                   : at.which == 1 ? state.offset.pitch_rad
                                   : state.offset.roll_rad;
        case FitPart::Beam:
            break;
    }
    return state.beams[at.of].coefficient(at.which);
}

Vector3d aimed_axis(const Rig& rig, const std::array<double, 2>& aim_rad, std::size_t strobe) {
    return aimed(rig.strobes[strobe].axis, aim_rad[0], aim_rad[1]);
}

namespace {

// What places and nodes of an image have in common, and the columns for their light: of the
// numbers, of the pose, of the floor's light and of all light.
class Scene {
  public:
    Scene(const Rig& rig,
          const FitState& state,
          const PathLight& light,
          const Sled& sled,
          const std::vector<FitPlaceInState>& numbers,
          const std::vector<Plane>& planes)
        : state_(state),
          light_(light),
          floor_(floor_plane(Jet(sled.altitude_m + state.offset.altitude_m, 0),
                             Jet(sled.pitch_rad + state.offset.pitch_rad, 1),
                             Jet(sled.roll_rad + state.offset.roll_rad, 2))),
          planes_(planes),
          pose_(std::ssize(numbers)) {
        const auto column_of = [&](const FitPlaceInState& at) -> Index {
            const auto found = std::ranges::find(numbers, at);
            return found == numbers.end() ? kHeld : found - numbers.begin();
        };
        for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
            lamps_.push_back(lamp_of(rig.strobes[s], state.aim_rad[s]));
            aims_.push_back({column_of({FitPart::Aim, s, 0}), column_of({FitPart::Aim, s, 1})});
            powers_.push_back(column_of({FitPart::Power, s}));
            beams_.push_back(column_of({FitPart::Beam, state.beam_of[s]}));
        }
        for (std::size_t k = 0; k < state.water.size(); ++k)
            versions_.push_back(column_of({FitPart::Water, k}));
        for (std::size_t k = 0; k < state.tint.size(); ++k)
            versions_.push_back(column_of({FitPart::Tint, 0, k}));
    }

    [[nodiscard]] const FitState& state() const { return state_; }
    [[nodiscard]] const PathLight& light() const { return light_; }
    [[nodiscard]] FloorJet floor(std::size_t place) const {
        return has_planes() ? fixed(planes_[place]) : floor_;
    }
    [[nodiscard]] bool has_planes() const { return !planes_.empty(); }
    [[nodiscard]] const std::vector<LampJet>& lamps() const { return lamps_; }
    [[nodiscard]] Index pose() const { return pose_; }
    [[nodiscard]] Index of_floor() const { return pose_ + kPose; }
    [[nodiscard]] Index of_all() const { return pose_ + kPose + 1; }
    [[nodiscard]] bool is_looked_for(std::size_t version) const {
        return versions_[version - 1] != kHeld;
    }

    // Light of a lamp in the direction w: times the beam, for one channel.
    struct Lit {
        std::size_t strobe = 0;
        bool is_floor = false;
        Vector3<Jet> w;
    };
    struct OfBeam {
        BeamValue value;
        Jet intensity;
    };
    void look(const Lit& lit, OfBeam& beam) const {
        state_.beams[state_.beam_of[lit.strobe]].at({lit.w.x().a, lit.w.y().a, lit.w.z().a},
                                                    beam.value);
        beam.intensity = Jet(beam.value.intensity);
        for (Index k = 0; k < 3; ++k) beam.intensity.v += beam.value.gradient(k) * lit.w(k).v;
    }
    // factor: the visible share of the beam's light. by_version: the same for versions from 1 on.
    void add(const Lit& lit,
             const OfBeam& beam,
             const Jet& factor,
             const std::vector<double>& by_version,
             Rows::RowXpr row) const {
        const Jet value = beam.intensity * factor;
        row(of_all()) += value.a;
        if (lit.is_floor) row(of_floor()) += value.a;
        for (int k = 0; k < kPose; ++k) row(pose_ + k) += value.v(k);
        const auto put = [&](Index column, double slope) {
            if (column != kHeld) row(column) += slope;
        };
        for (std::size_t k = 0; k < 2; ++k)
            put(aims_[lit.strobe][k], value.v(kAim + static_cast<int>(k)));
        put(powers_[lit.strobe], value.a / state_.power[lit.strobe]);
        if (beams_[lit.strobe] != kHeld) {
            for (std::size_t k = 0; k < beam.value.by.size(); ++k)
                row(beams_[lit.strobe] + static_cast<Index>(beam.value.first + k)) +=
                    beam.value.by[k] * factor.a;
        }
        for (std::size_t v = 0; v < versions_.size(); ++v)
            put(versions_[v], beam.intensity.a * by_version[v]);
    }

  private:
    static constexpr Index kHeld = -1;
    const FitState& state_;
    const PathLight& light_;
    FloorJet floor_;
    const std::vector<Plane>& planes_;
    Index pose_;
    std::vector<LampJet> lamps_;
    std::vector<std::array<Index, 2>> aims_;
    std::vector<Index> powers_;
    std::vector<Index> beams_;  // of the beam's first coefficient; the others follow
    std::vector<Index> versions_;
};

void light_floor(const Scene& scene, const std::vector<FitLight::Rays>& places, Rows& rows) {
    const FitState& state = scene.state();
    Scene::Lit lit{.is_floor = true, .w = {}};
    Scene::OfBeam beam;
    std::vector<double> by_version(scene.light().versions() - 1);
    std::vector<PathSignal> T(scene.light().versions());
    for (std::size_t place = 0; place < places.size(); ++place) {
        const FitLight::Rays& rays = places[place];
        const FloorJet floor = scene.floor(place);
        for (std::size_t r = 0; r < rays.size(); ++r) {
            const BasicFloorRay<Jet> ray = ray_to(floor, rays[r]);
            if (!ray.sees_floor()) continue;
            for (lit.strobe = 0; lit.strobe < scene.lamps().size(); ++lit.strobe) {
                const LampJet& lamp = scene.lamps()[lit.strobe];
                const Jet lamp_height_m = height_above(floor, lamp.position_m);
                if (!(lamp_height_m > 0.0)) continue;
                const Vector3<Jet> V = towards(lamp.position_m, ray);
                const Jet length = sqrt(V.squaredNorm());
                const Arriving<Jet> way = arriving(lamp_height_m, ray.height_m, ray.down, length);
                lit.w = lamp.into_frame * V / length;
                scene.look(lit, beam);
                const Jet spread =
                    (state.floor_brightness * state.power[lit.strobe] / pi) * way.per_area;
                for (std::size_t v = 0; v < T.size(); ++v)
                    if (v == 0 || scene.is_looked_for(v))
                        T[v] = scene.light().floor(lit.strobe, v, way.path_m.a);
                const std::size_t last = rays.size() == 1 ? kChannels : r + 1;
                for (std::size_t c = rays.size() == 1 ? 0 : r; c < last; ++c) {
                    Jet signal(T[0].value[c]);
                    signal.v = T[0].slope[c] * way.path_m.v;
                    for (std::size_t v = 1; v < T.size(); ++v)
                        by_version[v - 1] = spread.a * T[v].value[c];
                    scene.add(lit,
                              beam,
                              spread * signal,
                              by_version,
                              rows.row(static_cast<Index>(kChannels * place + c)));
                }
            }
        }
    }
}

void light_water(const Scene& scene, const std::vector<FitLight::Rays>& nodes, Rows& of_nodes) {
    using Gauss = boost::math::quadrature::gauss<double, kFitVeilPoints>;
    const PathLight& light = scene.light();
    Scene::Lit lit;
    Scene::OfBeam beam;
    std::vector<double> by_version(light.versions() - 1);
    // Light scattered at the angle phi at the lamp, which is away_m off the ray.
    const auto scatter = [&](const WaterRay& ray, std::size_t node, std::size_t r, double last) {
        const LampJet& lamp = scene.lamps()[lit.strobe];
        const Vector3d from_lamp = ray.origin_m - lamp.position_m;
        const double foot_m = -from_lamp.dot(ray.direction);
        const double away_m = std::max((from_lamp + foot_m * ray.direction).norm(), kNear_m);
        const double end = std::atan2(last - foot_m, away_m);
        const double first = std::max(std::atan2(-foot_m, away_m), kVeilCut - 0.5 * pi);
        if (end <= first) return;
        const auto add_point = [&](double x, double weight) {
            const double phi = first + 0.5 * (end - first) * (1.0 + x);
            const double t = foot_m + away_m * std::tan(phi);
            const double path_m = t + away_m / std::cos(phi);
            lit.w = lamp.into_frame * (from_lamp + t * ray.direction).normalized().cast<Jet>();
            scene.look(lit, beam);
            const double factor =
                scene.state().power[lit.strobe] * 0.5 * weight * (end - first) / away_m;
            std::array<double, kChannels> value{};
            std::vector<std::array<double, kChannels>> by(by_version.size());
            for (std::size_t i = 0; i < light.scatterers(); ++i) {
                const double p = factor * light.phase(0, i, phi + 0.5 * pi);
                const PathSignal V = light.veil(lit.strobe, 0, i, path_m);
                for (std::size_t c = 0; c < kChannels; ++c) value[c] += p * V.value[c];
                for (std::size_t v = 1; v < light.versions(); ++v) {
                    if (!scene.is_looked_for(v)) continue;
                    const double p_v = factor * light.phase(v, i, phi + 0.5 * pi);
                    const PathSignal V_v = light.veil(lit.strobe, v, i, path_m);
                    for (std::size_t c = 0; c < kChannels; ++c)
                        by[v - 1][c] += p * V_v.value[c] + p_v * V.value[c];
                }
            }
            const std::size_t count = nodes[node].size();
            const std::size_t after = count == 1 ? kChannels : r + 1;
            for (std::size_t c = count == 1 ? 0 : r; c < after; ++c) {
                for (std::size_t v = 0; v < by.size(); ++v) by_version[v] = by[v][c];
                scene.add(lit,
                          beam,
                          Jet(value[c]),
                          by_version,
                          of_nodes.row(static_cast<Index>(kChannels * node + c)));
            }
        };
        for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i)
            for (const double sign : {-1.0, 1.0})
                add_point(sign * Gauss::abscissa()[i], Gauss::weights()[i]);
    };
    for (std::size_t node = 0; node < nodes.size(); ++node) {
        for (std::size_t r = 0; r < nodes[node].size(); ++r) {
            const WaterRay& ray = nodes[node][r];
            const BasicFloorRay<Jet> sight = ray_to(scene.floor(node), ray);
            if (scene.has_planes() && !sight.sees_floor()) continue;
            // Towards the horizon, about as far as the longest tabulated path.
            const double last_m = sight.sees_floor()
                                      ? std::min(sight.height_m.a / sight.down.a, light.longest_m())
                                      : 0.5 * light.longest_m();
            for (lit.strobe = 0; lit.strobe < scene.lamps().size(); ++lit.strobe)
                scatter(ray, node, r, last_m);
        }
    }
}

void apply_vignetting(const FitState& state,
                      const std::vector<FitPlaceInState>& numbers,
                      const std::vector<FitLight::Sight>& sights,
                      Rows& rows) {
    const Index all = rows.cols() - 1;
    for (std::size_t place = 0; place < sights.size(); ++place) {
        const FitLight::Sight& sight = sights[place];
        const std::vector<double>& a = state.vignetting;
        const double q = sight.from_middle2;
        double V = sight.vignetting;
        std::array<double, 3> slopes{q, q * q, q * q * q};
        if (a.size() == 1) {
            V = std::pow(sight.cosine, a[0]);
            slopes[0] = V * std::log(sight.cosine);
        } else if (a.size() == 3) {
            V = 1.0 + q * (a[0] + q * (a[1] + q * a[2]));
        }
        for (std::size_t c = 0; c < kChannels; ++c) {
            auto row = rows.row(static_cast<Index>(kChannels * place + c));
            const double bare = row(all);
            row *= V;
            for (std::size_t k = 0; k < numbers.size(); ++k)
                if (numbers[k].part == FitPart::Lens)
                    row(static_cast<Index>(k)) = bare * slopes.at(numbers[k].which);
        }
    }
}

}  // namespace

FitLight::FitLight(const Rig& rig, const FitPlaces& places)
    : rig_(rig),
      places_(places),
      means_{.along = means_over_blocks(places.across(), places.block_px),
             .down = means_over_blocks(places.down(), places.block_px)} {
    const Camera& camera = rig.camera;
    std::vector<double> lambda_nm{0.5 * (camera.range.first_nm + camera.range.last_nm)};
    if (disperses(rig)) {
        lambda_nm.clear();
        for (std::size_t c = 0; c < kChannels; ++c)
            lambda_nm.push_back(mean_wavelength_nm(camera, c));
    }
    const auto rays_at = [&](double column, double row) {
        Rays rays;
        for (const double nm : lambda_nm) rays.push_back(pixel_ray(rig, column, row, nm));
        return rays;
    };
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double column = places.column(i);
        const double row = places.row(i);
        rays_.push_back(rays_at(column, row));
        sights_.push_back({.from_middle2 = radial_square(camera, column, row),
                           .cosine = direction_in_air(camera, column, row).z(),
                           .vignetting = vignetting_at(camera, column, row)});
    }
    if (!rig.water.scatters()) return;
    for (int j = 0; j < kTilePoints; ++j) {
        for (int i = 0; i < kTilePoints; ++i)
            veil_nodes_.push_back(rays_at(0.5 * camera.width_px * (1.0 + chebyshev_point(i)),
                                          0.5 * camera.height_px * (1.0 + chebyshev_point(j))));
    }
    veil_ = {.along = from_nodes(places.across(), places.block_px, camera.width_px),
             .down = from_nodes(places.down(), places.block_px, camera.height_px)};
}

BlockLight FitLight::at(const FitState& state,
                        const PathLight& light,
                        const Sled& sled,
                        const std::vector<FitPlaceInState>& numbers,
                        const std::vector<Plane>& planes) const {
    const Scene scene(rig_, state, light, sled, numbers, planes);
    const auto rows = static_cast<Index>(kChannels * places_.size());
    Rows middles = Rows::Zero(rows, scene.of_all() + 1);
    light_floor(scene, rays_, middles);
    if (light.scatterers() > 0 && scene.has_planes()) {
        light_water(scene, rays_, middles);
    } else if (light.scatterers() > 0) {
        Rows of_nodes = Rows::Zero(kChannels * std::ssize(veil_nodes_), middles.cols());
        light_water(scene, veil_nodes_, of_nodes);
        add_to_grid(veil_, of_nodes, middles);
    }
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        const auto column = static_cast<Index>(k);
        if (numbers[k].part == FitPart::Offset)
            middles.col(column) = middles.col(scene.pose() + static_cast<Index>(numbers[k].which));
        if (numbers[k].part == FitPart::Brightness)
            middles.col(column) = middles.col(scene.of_floor()) / state.floor_brightness;
    }
    apply_vignetting(state, numbers, sights_, middles);
    Rows means;
    if (scene.has_planes()) {
        means.swap(middles);
    } else {
        means.setZero(middles.rows(), middles.cols());
        add_to_grid(means_, middles, means);
    }
    BlockLight found;
    const Eigen::VectorXd all = means.col(scene.of_all());
    found.logarithm =
        (all.array() > 0.0).select(all.array().log(), std::numeric_limits<double>::quiet_NaN());
    const Eigen::VectorXd per = all.cwiseInverse();
    found.floor_share = means.col(scene.of_floor()).cwiseProduct(per);
    found.slopes = per.asDiagonal() * means.leftCols(scene.pose());
    found.by_pose = per.asDiagonal() * means.middleCols(scene.pose(), kPose);
    return found;
}

template <typename Use>
void FitLight::for_each_way(const std::vector<FitImage>& images, const Use& use) const {
    for (const FitImage& image : images) {
        for (std::size_t place = 0; place < places_.size(); ++place) {
            const Plane floor =
                image.planes.empty() ? floor_plane(image.sled) : image.planes[place];
            for (const WaterRay& ray : rays_[place]) {
                const auto length_m = distance_to(floor, ray);
                if (!length_m) continue;
                const Vector3d seen_m = ray.origin_m + *length_m * ray.direction;
                for (const Strobe& strobe : rig_.strobes) use(ray, strobe, seen_m);
            }
        }
    }
}

PathRange FitLight::paths(const std::vector<FitImage>& images) const {
    constexpr double kRoom = 1.2;  // for offsets of the altitude
    PathRange range{.shortest_m = std::numeric_limits<double>::infinity(), .longest_m = 0.0};
    for_each_way(images, [&](const WaterRay& ray, const Strobe& strobe, const Vector3d& seen_m) {
        const double path_m = (seen_m - ray.origin_m).norm() + (seen_m - strobe.position_m).norm();
        range.longest_m = std::max(range.longest_m, kRoom * path_m);
        range.shortest_m = std::min(
            range.shortest_m,
            rig_.water.scatters() ? (strobe.position_m - ray.origin_m).norm() : path_m / kRoom);
    });
    range.shortest_m = std::min(range.shortest_m, range.longest_m);
    return range;
}

double FitLight::block_rad() const {
    const double column = 0.5 * places_.width_px;
    const double row = 0.5 * places_.height_px;
    const double nm = 0.5 * (rig_.camera.range.first_nm + rig_.camera.range.last_nm);
    const Vector3d one = pixel_ray(rig_, column, row, nm).direction;
    const Vector3d other = pixel_ray(rig_, column + 0.5 * places_.block_px, row, nm).direction;
    return 2.0 * angle_between(one, other);
}

double FitLight::widest_rad(const std::vector<FitImage>& images) const {
    double widest_rad = 0.0;
    for_each_way(
        images, [&](const WaterRay& /*ray*/, const Strobe& strobe, const Vector3d& seen_m) {
            widest_rad =
                std::max(widest_rad, angle_between(strobe.axis, seen_m - strobe.position_m));
        });
    return std::min(widest_rad, 0.5 * pi);
}

}  // namespace aphotic
