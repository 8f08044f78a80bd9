// SPDX-License-Identifier: BSD-3-Clause
#include "light/beam_light.h"

#include <cmath>

namespace aphotic {

using Eigen::Vector3d;

BeamLight::BeamLight(const Beam& beam, const Vector3d& axis)
    : beam_(beam), frame_(frame_about(axis)) {
    if (is_round(beam)) profile_.emplace(beam);
}

double BeamLight::at(const Vector3d& towards) const {
    if (!profile_) return intensity_towards(beam_, frame_, towards);
    return profile_->at(frame_.axis.dot(towards) / towards.norm());
}

double BeamLight::continued(const Vector3d& towards, const Vector3d& from) const {
    if (!profile_) return continued_intensity(beam_, frame_, towards, from);
    return profile_->continued(frame_.axis.dot(towards) / towards.norm(),
                               frame_.axis.dot(from) / from.norm());
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
