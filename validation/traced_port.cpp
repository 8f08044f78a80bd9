// SPDX-License-Identifier: BSD-3-Clause
#include "validation/traced_port.h"

#include <Eigen/Geometry>

#include <cmath>

namespace aphotic {

namespace {

using Eigen::Vector3d;
using WideVector = Eigen::Matrix<long double, 3, 1>;

TracedRay through_faces_across_z(const PortWindow& port,
                                 const Vector3d& in_air,
                                 double glass_index,
                                 double water_index) {
    const double cos_air = 1.0 / in_air.norm();
    const double u = in_air.x() * cos_air;
    const double v = in_air.y() * cos_air;
    const double glass_z = std::sqrt(glass_index * glass_index - u * u - v * v);
    const double water_z = std::sqrt(water_index * water_index - u * u - v * v);
    const double per_sine = port.distance_m / cos_air + port.thickness_m / glass_z;
    return {.origin_m = {u * per_sine, v * per_sine, port.distance_m + port.thickness_m},
            .direction = Vector3d(u, v, water_z).cast<long double>()};
}

TracedRay through_tilted_faces(const PortWindow& port,
                               const WideVector& in_air,
                               double glass_index,
                               double water_index) {
    // Rotated so that the normal is z.
    const Eigen::Quaternion<long double> turn = Eigen::Quaternion<long double>::FromTwoVectors(
        port.normal.cast<long double>(), WideVector::UnitZ());
    const WideVector turned = turn * in_air;
    const TracedRay ray = through_faces_across_z(
        port, (turned / turned.z()).cast<double>(), glass_index, water_index);
    const Eigen::Quaternion<long double> back = turn.conjugate();
    return {.origin_m = (back * ray.origin_m.cast<long double>()).cast<double>(),
            .direction = back * ray.direction};
}

TracedRay through_dome(const PortWindow& port,
                       const WideVector& in_air,
                       double glass_index,
                       double water_index) {
    const WideVector centre_m = port.dome->centre_m.cast<long double>();
    const long double inner_m = port.dome->radius_m;
    const long double outer_m = inner_m + port.thickness_m;
    const WideVector along = in_air.normalized();
    const WideVector nearest_m = -centre_m + centre_m.dot(along) * along;  // from the centre
    const long double b_m = nearest_m.norm();
    if (b_m == 0.0L)
        return {.origin_m = (centre_m + outer_m * along).cast<double>(), .direction = along};
    const WideVector aside = nearest_m / b_m;
    const auto inclination = [&](long double index, long double radius_m) {
        return std::asin(b_m / (index * radius_m));
    };
    const auto at_angle = [&](long double angle_rad) -> WideVector {
        return std::cos(angle_rad) * aside + std::sin(angle_rad) * along;
    };
    const long double quarter_rad = std::acos(0.0L);
    const long double enters_glass_rad = quarter_rad - inclination(1.0L, inner_m);
    const long double in_glass_rad = enters_glass_rad + inclination(glass_index, inner_m);
    const long double enters_water_rad = in_glass_rad - inclination(glass_index, outer_m);
    const long double in_water_rad = enters_water_rad + inclination(water_index, outer_m);
    return {.origin_m = (centre_m + outer_m * at_angle(enters_water_rad)).cast<double>(),
            .direction = at_angle(in_water_rad)};
}

}  // namespace

TracedRay through_port(const PortWindow& port,
                       const WideVector& in_air,
                       double glass_index,
                       double water_index) {
    if (port.dome) return through_dome(port, in_air, glass_index, water_index);
    if (port.normal == Vector3d::UnitZ()) {
        const WideVector per_z = in_air / in_air.z();
        return through_faces_across_z(port, per_z.cast<double>(), glass_index, water_index);
    }
    return through_tilted_faces(port, in_air, glass_index, water_index);
}

}  // namespace aphotic
