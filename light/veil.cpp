// SPDX-License-Identifier: BSD-3-Clause
#include "light/veil.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <variant>

namespace aphotic {

namespace {

constexpr double kPoleRad = 0.5 * std::numbers::pi;
constexpr double kNoPole = 10.0;

}  // namespace

// Two directions in the plane of ray and lamp, and the distance between lamp and ray.
struct Veil::View {
    double foot_m;            // t_0
    double away_m;            // h
    Eigen::Vector3d towards;  // e, unit, across the ray
    Eigen::Vector3d along;    // u
    // Where the ray passes a table's pole: the middle, and how far to each side.
    double pole_rad = 0.0;
    double off_pole_rad = kNoPole;

    // Distance from a panel to the singularities next to it.
    [[nodiscard]] double room(double start, double width) const {
        double room = std::min(kPoleRad - start - width, start + kPoleRad);
        if (off_pole_rad >= room) return room;
        const double middle = start + 0.5 * width;
        const double to_pole = std::abs(std::remainder(middle - pole_rad, std::numbers::pi));
        return std::min(room, std::hypot(std::max(0.0, to_pole - 0.5 * width), off_pole_rad));
    }
};

namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// A path of this many times 2 h counts as infinite.
constexpr double kVeilEndRad = 1e-9;
// On the ray itself a lamp's veil is infinite; a micrometre beside it is not.
constexpr double kVeilNear_m = 1e-6;

double least_loss_in_view_per_m(const Rig& rig) {
    const std::vector<double> knots_nm = union_of_knots(rig.water.curves(), rig.camera.range);
    double least = std::numeric_limits<double>::infinity();
    for (const double nm : knots_nm) least = std::min(least, rig.water.attenuation_per_m(nm));
    return least;
}

// The lamps of an emitter, by Gauss-Legendre's rule.
template <class Lamps>
void add_lamps_of(const Strobe& strobe,
                  const BeamFrame& frame,
                  const std::vector<GaussNode>& rule,
                  Lamps& lamps) {
    for (const GaussNode& i : rule) {
        for (const GaussNode& j : rule) {
            lamps.push_back({strobe.position_m +
                                 (i.at - 0.5) * strobe.emitter->across_m * frame.across +
                                 (j.at - 0.5) * strobe.emitter->along_m * frame.along,
                             i.weight * j.weight});
        }
    }
}

// The pole of a table's angles.
std::optional<Vector3d> pole_of(const Beam& beam, const BeamFrame& frame) {
    const auto* table = std::get_if<BeamTable>(&beam.pattern);
    if (table == nullptr) return std::nullopt;
    if (table->angles == TableAngles::TypeC) return frame.axis;
    const double c = std::cos(beam.turn_rad);
    const double s = std::sin(beam.turn_rad);
    if (table->angles == TableAngles::TypeA) return c * frame.along + s * frame.across;
    return c * frame.across - s * frame.along;
}

bool is_round_table(const Beam& beam) {
    const auto* table = std::get_if<BeamTable>(&beam.pattern);
    return table != nullptr && table->angles == TableAngles::TypeC &&
           table->horizontal_rad.size() == 1 && !beam.window;
}

// The same beam with kinks where pieces meet.
Beam with_rows_of(Beam beam, const std::vector<TablePiece>& pieces) {
    auto& table = std::get<BeamTable>(beam.pattern);
    table.vertical_rad = {pieces.front().first_rad};
    for (const TablePiece& piece : pieces) table.vertical_rad.push_back(piece.last_rad);
    table.intensity.assign(table.vertical_rad.size(), 0.0);
    return beam;
}

struct CosSin {
    double cosine;
    double sine;
};

// For half a panel at most: accurate to rounding.
CosSin near_zero(double x) {
    static_assert(kVeilPanelRad <= 0.36);
    const double q = x * x;
    return {1.0 - q * (1.0 / 2.0) *
                      (1.0 - q * (1.0 / 12.0) *
                                 (1.0 - q * (1.0 / 30.0) *
                                            (1.0 - q * (1.0 / 56.0) * (1.0 - q * (1.0 / 90.0))))),
            x * (1.0 - q * (1.0 / 6.0) *
                           (1.0 - q * (1.0 / 20.0) *
                                      (1.0 - q * (1.0 / 42.0) * (1.0 - q * (1.0 / 72.0)))))};
}

bool is_whole(double x) {
    return x == std::floor(x);
}

double steepest_cone(const Beam& beam) {
    double steepest = 1.0;
    for (const Cone& cone : beam.cones) steepest = std::max(steepest, cone.exponent);
    return steepest;
}

// The number of these that suffices in a narrower panel, by rho^-2n.
std::size_t points_for(std::size_t points, double width, double room) {
    const double z = 1.0 + 2.0 * room / width;
    const double rho = z + std::sqrt(z * z - 1.0);
    constexpr double kRho = 3.0 + 2.0 * std::numbers::sqrt2;  // of room = width
    const double share = std::log(kRho) / std::log(rho);
    return static_cast<std::size_t>(std::ceil(static_cast<double>(points) * std::min(1.0, share)));
}

}  // namespace

void VeilNodes::clear() {
    path_m.clear();
    for (std::vector<double>& of_scatterer : weight) of_scatterer.clear();
}

Veil::Veil(const Rig& rig, unsigned points)
    : rig_(std::make_shared<const Rig>(rig)), points_(points) {
    for (unsigned n = 0; n <= points; ++n) rules_.push_back(gauss_rule(n));
    constexpr unsigned kEmitterSide = 3;
    const unsigned side =
        std::min(points, std::max(kEmitterSide, points * kEmitterSide / kVeilPoints));
    for (std::size_t s = 0; s < rig_->strobes.size(); ++s) {
        const Strobe& strobe = rig_->strobes[s];
        for (const Beam& part : parts_of(strobe.beam)) {
            if (is_dark(part)) continue;
            parts_.push_back(light_of(strobe, part, side));
            strobes_.push_back(s);
        }
    }
    for (const Scatterer& scatterer : rig_->water.scatterers) {
        Phase phase{.function = &scatterer.phase, .samples = {}};
        const auto& kind = scatterer.phase.kind;
        if (const auto* table = std::get_if<PhaseTable>(&kind)) {
            for (const double angle_rad : table->angle_rad)
                if (angle_rad > kVeilCut) kinks_rad_.push_back(angle_rad - kPoleRad);
        }
        if (!std::holds_alternative<HenyeyGreenstein>(kind)) {
            constexpr int kSteps = 8192;
            for (int i = 0; i <= kSteps; ++i)
                phase.samples.push_back(
                    scatterer.phase.at(kVeilCut + (pi - kVeilCut) * i / kSteps));
        }
        phases_.push_back(std::move(phase));
    }
    add_kink_panels();
    const double least_per_m = rig.water.scatters() ? least_loss_in_view_per_m(rig) : 0.0;
    longest_m_ =
        least_per_m > 0.0 ? kVeilDepth / least_per_m : std::numeric_limits<double>::infinity();
}

void Veil::add_kink_panels() {
    std::ranges::sort(kinks_rad_);
    for (std::size_t k = 0; k + 1 < kinks_rad_.size(); ++k) {
        const double from = kinks_rad_[k];
        const double width = kinks_rad_[k + 1] - from;
        KinkPanel panel{
            .room_rad = std::min({kVeilPanelRad, kPoleRad - kinks_rad_[k + 1], from + kPoleRad})};
        for (const GaussNode& node : rule_for(width, panel.room_rad)) {
            if (width > panel.room_rad) break;
            const double phi = from + width * node.at;
            panel.points.push_back(
                {.cosine = std::cos(phi), .sine = std::sin(phi), .weight = width * node.weight});
            for (const Phase& phase : phases_) panel.phases.push_back(phase.at(phi + kPoleRad));
        }
        panels_.push_back(std::move(panel));
    }
}

Veil::Light Veil::light_of(const Strobe& strobe, const Beam& beam, unsigned emitter_side) const {
    const BeamFrame frame = frame_about(strobe.axis);
    Light light{.beam = beam,
                .frame = frame,
                .creases = creases_of(beam, frame),
                .cone = std::nullopt,
                .pieces = {},
                .lamps = {},
                .widest_panel_rad =
                    std::min(kVeilPanelRad, 4.0 * kVeilPanelRad / std::sqrt(steepest_cone(beam))),
                .ends_in_a_power = beam.window.has_value(),
                .is_of_optics = std::holds_alternative<BeamOptics>(beam.pattern),
                .pole = pole_of(beam, frame)};
    if (is_round_table(beam)) {
        const auto& table = std::get<BeamTable>(beam.pattern);
        light.pieces = pieces_of(table, points_ <= kVeilMapPoints ? kVeilBeamOff : 0.0);
        light.creases = creases_of(with_rows_of(beam, light.pieces), frame);
        for (TablePiece& piece : light.pieces)
            for (double& c : piece.c) c *= beam.per_flux;
    }
    if (const auto cones = cone_lights(beam); !beam.window && !cones.empty())
        light.cone = cones.front();
    for (const Cone& cone : beam.cones)
        light.ends_in_a_power |= cone.half_angle_rad >= kPoleRad && !is_whole(cone.exponent);
    if (strobe.emitter)
        add_lamps_of(strobe, frame, rules_[emitter_side], light.lamps);
    else
        light.lamps.push_back({strobe.position_m, 1.0});
    return light;
}

// Lagrange's cubic through the four nearest samples.
double Veil::Phase::at(double psi_rad) const {
    if (samples.empty()) return function->at(psi_rad);
    const int steps = static_cast<int>(samples.size()) - 1;
    const double place = (psi_rad - kVeilCut) * (steps / (pi - kVeilCut));
    const int first = std::clamp(static_cast<int>(place) - 1, 0, steps - 3);
    const double* const y = &samples[static_cast<std::size_t>(first)];
    const double a = place - first;
    const double b = a - 1.0;
    const double c = a - 2.0;
    const double d = a - 3.0;
    return (c * d * (3.0 * a * y[1] - b * y[0]) + a * b * (c * y[3] - 3.0 * d * y[2])) / 6.0;
}

const std::vector<GaussNode>& Veil::rule_for(double width, double room) const {
    return rules_[points_for(rules_.size() - 1, width, room)];
}

void Veil::nodes(std::size_t part, const WaterRay& ray, double length_m, VeilNodes& nodes) const {
    nodes.clear();
    nodes.weight.resize(phases_.size());
    for (const Lamp& lamp : parts_[part].lamps) add_lamp(parts_[part], lamp, ray, length_m, nodes);
}

void Veil::add_lamp(const Light& light,
                    const Lamp& lamp,
                    const WaterRay& ray,
                    double length_m,
                    VeilNodes& nodes) const {
    const Vector3d to_lamp = lamp.position_m - ray.origin_m;
    View view{.foot_m = to_lamp.dot(ray.direction),
              .away_m = 0.0,
              .towards = ray.direction.unitOrthogonal(),
              .along = ray.direction};
    const Vector3d across = view.foot_m * ray.direction - to_lamp;
    view.away_m = std::max(kVeilNear_m, across.norm());
    if (across.norm() > kVeilNear_m) view.towards = across / view.away_m;

    if (light.pole) {
        const double A = light.pole->dot(view.towards);
        const double B = light.pole->dot(view.along);
        constexpr double kLeastRoom = 1e-3;
        view.pole_rad = std::atan2(B, A);
        view.off_pole_rad = std::max(kLeastRoom, std::acos(std::min(1.0, std::hypot(A, B))));
    }
    const double end_m = std::min(length_m, longest_m_);
    const double first = std::max(std::atan2(-view.foot_m, view.away_m), kVeilCut - kPoleRad);
    const double last =
        std::min(std::atan2(end_m - view.foot_m, view.away_m), kPoleRad - kVeilEndRad);
    if (!(last > first)) return;
    std::vector<double>& cuts = nodes.cuts_rad;
    cuts.clear();
    for (const Crease& crease : light.creases)
        add_crossings(crease, view.towards, view.along, cuts);
    // Panels shrink towards an end that behaves like a power.
    const auto shrink_towards = [&](std::size_t from, std::initializer_list<double> steps) {
        const std::size_t end = cuts.size();
        for (std::size_t k = from; k < end; ++k) {
            for (const double step : steps) {
                cuts.push_back(cuts[k] - step);
                cuts.push_back(cuts[k] + step);
            }
        }
    };
    if (light.is_of_optics) shrink_towards(0, {0.03, 0.004});
    if (light.ends_in_a_power) {
        const std::size_t from = cuts.size();
        add_crossings(light.creases.back(), view.towards, view.along, cuts);
        shrink_towards(from, {0.12, 0.03, 0.006, 0.0012, 0.0002});
    }
    std::erase_if(cuts, [&](double cut) { return !(cut > first && cut < last); });
    cuts.push_back(first);
    cuts.push_back(last);
    std::ranges::sort(cuts);
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        if (cuts[k] < cuts[k + 1]) add_piece(light, lamp, view, cuts[k], cuts[k + 1], nodes);
    }
}

// A lamp's light in a piece of the ray within which its beam has no edge and no kink.
class Veil::Shine {
  public:
    const Light& light;
    const View& view;
    double share;  // of the lamp, over h

    Shine(const Light& of_light, const Lamp& lamp, const View& of_view, double middle_rad)
        : light(of_light),
          view(of_view),
          share(lamp.share / view.away_m),
          k_e_(light.frame.axis.dot(view.towards)),
          k_u_(light.frame.axis.dot(view.along)),
          seen_(towards(std::cos(middle_rad), std::sin(middle_rad))),
          cos_seen_(light.frame.axis.dot(seen_)),
          is_lit_(light.cone && cos_seen_ > light.cone->edge_cosine) {
        if (!light.pieces.empty()) {
            const double theta_rad = std::acos(std::clamp(cos_seen_, -1.0, 1.0));
            const auto after =
                std::ranges::upper_bound(light.pieces, theta_rad, {}, [](const TablePiece& piece) {
                    return piece.first_rad;
                });
            if (after != light.pieces.begin() && theta_rad < (after - 1)->last_rad)
                piece_ = &*(after - 1);
        }
    }

    [[nodiscard]] bool is_dark() const {
        if (light.cone) return !is_lit_;
        if (!light.pieces.empty()) return piece_ == nullptr || piece_->c == kNothing;
        return intensity_towards(light.beam, light.frame, seen_) == 0.0;
    }

    [[nodiscard]] double intensity(double cosine, double sine) const {
        if (piece_ != nullptr) {
            const double cos_theta = std::clamp(cosine * k_e_ + sine * k_u_, -1.0, 1.0);
            return std::max(0.0, piece_->at(std::acos(cos_theta)));
        }
        if (!light.cone)
            return continued_intensity(light.beam, light.frame, towards(cosine, sine), seen_);
        const double cos_theta = std::max(0.0, cosine * k_e_ + sine * k_u_);
        const ConeLight& cone = *light.cone;
        const double I =
            cone.on_axis * (cone.exponent == 1.0 ? cos_theta : std::pow(cos_theta, cone.exponent));
        if (cos_seen_ >= cone.full_cosine) return I;
        const double t = (cos_theta - cone.edge_cosine) / (cone.full_cosine - cone.edge_cosine);
        return I * t * t * (3.0 - 2.0 * t);
    }

    // phase_of: by scatterer.
    template <typename PhaseOf>
    void add(const Point& point, const PhaseOf& phase_of, VeilNodes& nodes) const {
        const double weight = share * intensity(point.cosine, point.sine) * point.weight;
        nodes.path_m.push_back(view.foot_m + view.away_m * (1.0 + point.sine) / point.cosine);
        for (std::size_t i = 0; i < nodes.weight.size(); ++i)
            nodes.weight[i].push_back(weight * phase_of(i));
    }

  private:
    static constexpr std::array<double, 4> kNothing{};
    [[nodiscard]] Vector3d towards(double cosine, double sine) const {
        return cosine * view.towards + sine * view.along;
    }
    double k_e_;
    double k_u_;
    Vector3d seen_;
    double cos_seen_;
    bool is_lit_;  // by its cone
    const TablePiece* piece_ = nullptr;
};

void Veil::add_piece(const Light& light,
                     const Lamp& lamp,
                     const View& view,
                     double from,
                     double to,
                     VeilNodes& nodes) const {
    const Shine shine(light, lamp, view, 0.5 * (from + to));
    if (shine.is_dark()) return;
    const auto first = std::ranges::upper_bound(kinks_rad_, from);
    for (auto kink = first; from < to; ++kink) {
        const double end = kink == kinks_rad_.end() ? to : std::min(to, *kink);
        const auto known = static_cast<std::size_t>(kink - kinks_rad_.begin()) - 1;
        const bool is_whole_panel = kink != first && kink != kinks_rad_.end() && end == *kink;
        if (is_whole_panel && !panels_[known].points.empty() &&
            std::min(light.widest_panel_rad, view.room(from, end - from)) >=
                panels_[known].room_rad)
            add_known(shine, panels_[known], nodes);
        else
            add_panels(shine, from, end, nodes);
        from = end;
        if (kink == kinks_rad_.end()) break;
    }
}

void Veil::add_known(const Shine& shine, const KinkPanel& panel, VeilNodes& nodes) const {
    const double* phase = panel.phases.data();
    for (const Point& point : panel.points) {
        shine.add(
            point, [&](std::size_t i) { return phase[i]; }, nodes);
        phase += phases_.size();
    }
}

void Veil::add_panels(const Shine& shine, double from, double to, VeilNodes& nodes) const {
    for (double start = from; start < to;) {
        // Bisects the rest until a panel is no wider than its room.
        double width = to - start;
        double room = 0.0;
        while (true) {
            room = std::min(shine.light.widest_panel_rad, shine.view.room(start, width));
            if (width <= room * (1.0 + 1e-9)) break;
            width *= 0.5;
        }
        const bool is_last = width >= (to - start) * (1.0 - 1e-9);
        const double middle = start + 0.5 * width;
        const double cos_middle = std::cos(middle);
        const double sin_middle = std::sin(middle);
        for (const GaussNode& node : rule_for(width, room)) {
            const double off = width * (node.at - 0.5);
            const auto [cos_off, sin_off] = near_zero(off);
            const double psi = middle + off + kPoleRad;
            shine.add(
                {.cosine = cos_middle * cos_off - sin_middle * sin_off,
                 .sine = sin_middle * cos_off + cos_middle * sin_off,
                 .weight = width * node.weight},
                [&](std::size_t i) { return phases_[i].at(psi); },
                nodes);
        }
        start = is_last ? to : start + width;
    }
}

double Veil::radiance(const WaterRay& ray, double length_m, double lambda_nm) const {
    const Rig& rig = *rig_;
    const double loss_per_m = rig.water.attenuation_per_m(lambda_nm);
    double sum = 0.0;
    VeilNodes found;
    for (std::size_t part = 0; part < parts_.size(); ++part) {
        const Strobe& strobe = rig.strobes[strobes_[part]];
        nodes(part, ray, length_m, found);
        double light = 0.0;
        for (std::size_t i = 0; i < found.weight.size(); ++i) {
            double of_scatterer = 0.0;
            for (std::size_t n = 0; n < found.path_m.size(); ++n)
                of_scatterer += found.weight[i][n] * std::exp(-loss_per_m * found.path_m[n]);
            light += rig.water.scattering_per_m(i, lambda_nm) * of_scatterer;
        }
        sum += strobe.power * strobe.spectrum.at(lambda_nm) * light;
    }
    return sum;
}

double veil_error(const Rig& rig, unsigned points) {
    if (!rig.water.scatters()) return 0.0;
    constexpr int kColumns = 9;
    constexpr int kRows = 7;
    const WavelengthRange range = rig.camera.range;
    const std::array<double, 3> lambda_nm{
        range.first_nm, 0.5 * (range.first_nm + range.last_nm), range.last_nm};
    const Veil veil(rig, points);
    const Veil finer(rig, 2 * points);
    struct Pair {
        double found;
        double wanted;
    };
    double worst = 0.0;
    for (const double nm : lambda_nm) {
        std::vector<Pair> pairs;
        double most = 0.0;
        for (int i = 0; i < kColumns; ++i) {
            for (int j = 0; j < kRows; ++j) {
                const VeilSight sight = sight_of(rig,
                                                 rig.camera.width_px * (i + 0.5) / kColumns,
                                                 rig.camera.height_px * (j + 0.5) / kRows,
                                                 lambda_nm[1]);
                pairs.push_back({veil.radiance(sight.ray, sight.length_m, nm),
                                 finer.radiance(sight.ray, sight.length_m, nm)});
                most = std::max(most, pairs.back().wanted);
            }
        }
        for (const Pair& pair : pairs) {
            const double scale = std::max(pair.wanted, kDimVeilShare * most);
            if (scale > 0.0) worst = std::max(worst, std::abs(pair.found - pair.wanted) / scale);
        }
    }
    return worst;
}

unsigned veil_points(const Rig& rig, double error) {
    return veil_error(rig, kVeilMapPoints) <= error ? kVeilMapPoints : kVeilPoints;
}

VeilSight sight_of(const Rig& rig, double column, double row, double lambda_nm) {
    const WaterRay ray = pixel_ray(rig, column, row, lambda_nm);
    const auto length_m = distance_to(floor_plane(rig.sled), ray);
    return {ray, length_m.value_or(std::numeric_limits<double>::infinity())};
}

}  // namespace aphotic
