// SPDX-License-Identifier: BSD-3-Clause
#include "light/beam_light.h"

#include "light/lane_ray.h"

#include <cmath>
#include <numbers>
#include <variant>

namespace aphotic {

using Eigen::Vector3d;

namespace {

const BeamFrame kLampFrame{Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitY()};

// I = 1 in air.
Beam even_light_behind(const BeamWindow& window) {
    return {.name = {},
            .weights = ConeWeights::Literal,
            .cones = {{.part = {},
                       .half_angle_rad = 0.5 * std::numbers::pi,
                       .weight = 1.0,
                       .exponent = 0.0}},
            .window = window};
}

}  // namespace

BeamLight::BeamLight(const Beam& beam, const Vector3d& axis)
    : beam_(beam), frame_(frame_about(axis)), has_edge_(!edges_rad(beam).empty() || has_rim(beam)) {
    if (is_round(beam)) {
        profile_.emplace(beam);
        return;
    }
    const double c = std::cos(beam.turn_rad);
    const double s = std::sin(beam.turn_rad);
    pattern_frame_ = {.axis = axis,
                      .along = c * frame_.along + s * frame_.across,
                      .across = c * frame_.across - s * frame_.along};
    in_air_ = beam;
    in_air_.turn_rad = 0.0;
    in_air_.window.reset();
    if (beam.window) window_factor_.emplace(even_light_behind(*beam.window));
    if (const auto* table = std::get_if<BeamTable>(&beam.pattern)) cells_.emplace(*table);
}

Lanes BeamLight::cosine(const LaneVector& towards, const Lanes& length) const {
    Lanes cosine;
    for_each_pack([&](std::size_t k) {
        cosine.set_pack(k, dot(frame_.axis, pack(towards, k)) / length.pack(k));
    });
    return cosine;
}

Lanes BeamLight::at(const LaneVector& towards, const Lanes& length) const {
    if (profile_) return profile_->at(cosine(towards, length));
    Lanes I = of_pattern(towards, length);
    if (!window_factor_) return I;
    const Lanes factor = window_factor_->at(cosine(towards, length));
    for (std::size_t k = 0; k < kLanes; ++k) I[k] *= factor[k];
    return I;
}

Lanes BeamLight::of_pattern(const LaneVector& towards, const Lanes& length) const {
    const double index = beam_.window ? beam_.window->water_index : 1.0;
    LaneVector own;
    for_each_pack([&](std::size_t k) {
        const PackVector V = pack(towards, k);
        const Pack x = index * dot(pattern_frame_.along, V);
        const Pack y = index * dot(pattern_frame_.across, V);
        const Pack air_z = root(length.pack(k) * length.pack(k) - x * x - y * y);
        set_pack(own, k, {x, y, beam_.window ? air_z : dot(pattern_frame_.axis, V)});
    });
    Lanes I;
    if (cells_) {
        I = cells_->at(own, length);
        for (double& one : I.lane) one *= in_air_.per_flux;
    } else {
        for (std::size_t k = 0; k < kLanes; ++k)
            I[k] = intensity_towards(in_air_, kLampFrame, {own[0][k], own[1][k], own[2][k]});
    }
    return I;
}

Lanes BeamLight::continued(const LaneVector& towards,
                           const Lanes& length,
                           const LaneVector& from,
                           const Lanes& from_length) const {
    if (!has_edge_) return at(towards, length);
    if (profile_) return profile_->continued(cosine(towards, length), cosine(from, from_length));
    Lanes I;
    for (std::size_t k = 0; k < kLanes; ++k)
        I[k] =
            continued_intensity(beam_, frame_, vector_of_lane(towards, k), vector_of_lane(from, k));
    return I;
}

BeamEdges::BeamEdges(const Strobe& strobe) : beam_(strobe.beam), frame_(frame_about(strobe.axis)) {
    if (strobe.power == 0.0) return;
    for (const double edge_rad : edges_rad(strobe.beam)) cosines_.push_back(std::cos(edge_rad));
    has_rim_ = has_rim(strobe.beam);
}

bool BeamEdges::is_within(std::size_t edge, const Vector3d& towards) const {
    if (edge == cosines_.size()) return is_within_rim(beam_, frame_, towards);
    return frame_.axis.dot(towards) >= cosines_[edge] * towards.norm();
}

std::vector<Crease> BeamEdges::creases(std::size_t edge) const {
    if (edge == cosines_.size()) return creases_of(beam_, frame_);
    return {{.l = frame_.axis, .at = cosines_[edge]}};
}

}  // namespace aphotic
