// SPDX-License-Identifier: BSD-3-Clause
#include "light/beam_light.h"

#include <cmath>

namespace aphotic {

using Eigen::Vector3d;

BeamLight::BeamLight(const Beam& beam, const Vector3d& axis)
    : beam_(beam), frame_(frame_about(axis)), cones_(cone_lights(beam)) {}

double BeamLight::of_cones(const PatternView& view, const PatternView& from) const {
    const double cosine = view.direction.z() / view.direction.norm();
    const double cosine_from = from.direction.z() / from.direction.norm();
    double intensity = 0.0;
    for (const ConeLight& cone : cones_) intensity += cone.at(cosine, cosine_from);
    return view.factor * intensity;
}

double BeamLight::at(const Vector3d& towards) const {
    if (cones_.empty()) return intensity_towards(beam_, frame_, towards);
    const auto view = pattern_view(beam_, frame_, towards);
    return view ? of_cones(*view, *view) : 0.0;
}

double BeamLight::continued(const Vector3d& towards, const Vector3d& from) const {
    if (cones_.empty()) return continued_intensity(beam_, frame_, towards, from);
    const auto view_from = pattern_view(beam_, frame_, from);
    return view_from ? of_cones(continued_view(beam_, frame_, towards), *view_from) : 0.0;
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
