// SPDX-License-Identifier: BSD-3-Clause
#include "rig/camera/port.h"

#include "base/error.h"

#include <fmt/format.h>

#include <cmath>

namespace aphotic {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

WaterRay ray_across_axis(const PortWindow& port,
                         const Vector3d& in_air,
                         double glass_index,
                         double water_index) {
    const Vector2d sin_air = in_air.head<2>();
    const Vector2d sin_glass = sin_air / glass_index;
    const Vector2d sin_water = sin_air / water_index;
    const double cos_glass = std::sqrt(1.0 - sin_glass.squaredNorm());
    const double cos_water = std::sqrt(1.0 - sin_water.squaredNorm());

    WaterRay ray;
    ray.origin_m.head<2>() =
        port.distance_m * sin_air / in_air.z() + port.thickness_m * sin_glass / cos_glass;
    ray.origin_m.z() = front_m(port);
    ray.direction << sin_water, cos_water;
    return ray;
}

// Refraction at a face with this normal, on the light's far side, from one index into another.
// Total reflection does not occur: glass and water are denser than air, and light that entered from
// air leaves again.
Vector3d refracted(const Vector3d& direction, const Vector3d& normal, double from, double into) {
    const double ratio = from / into;
    const double cosine = direction.dot(normal);
    const double cos_behind = std::sqrt(1.0 - ratio * ratio * (1.0 - cosine * cosine));
    return ratio * direction + (cos_behind - ratio * cosine) * normal;
}

WaterRay ray_through_tilted(const PortWindow& port,
                            const Vector3d& in_air,
                            double glass_index,
                            double water_index) {
    const double towards = in_air.dot(port.normal);
    if (towards <= 0.0) throw InputError("a ray of the image misses the port, which faces away");
    const Vector3d in_glass = refracted(in_air, port.normal, 1.0, glass_index);
    return {.origin_m = port.distance_m / towards * in_air +
                        port.thickness_m / in_glass.dot(port.normal) * in_glass,
            .direction = refracted(in_glass, port.normal, glass_index, water_index)};
}

// The distance along the ray from inside to the sphere about the origin.
double way_out_m(const Vector3d& from_m, const Vector3d& direction, double radius_m) {
    const double along = from_m.dot(direction);
    return std::sqrt(along * along - from_m.squaredNorm() + radius_m * radius_m) - along;
}

WaterRay ray_through_dome(const PortWindow& port,
                          const Vector3d& in_air,
                          double glass_index,
                          double water_index) {
    const Dome& dome = *port.dome;
    const double outer_m = dome.radius_m + port.thickness_m;
    Vector3d at_m = -dome.centre_m;  // from the dome's centre
    at_m += way_out_m(at_m, in_air, dome.radius_m) * in_air;
    const Vector3d in_glass = refracted(in_air, at_m.normalized(), 1.0, glass_index);
    at_m += way_out_m(at_m, in_glass, outer_m) * in_glass;
    return {.origin_m = dome.centre_m + at_m,
            .direction = refracted(in_glass, at_m.normalized(), glass_index, water_index)};
}

}  // namespace

WaterRay ray_into_water(const Port& port,
                        const Vector3d& in_air,
                        double lambda_nm,
                        double water_index) {
    if (!port) return {.origin_m = Vector3d::Zero(), .direction = in_air};
    const double glass_index = port->glass.index(lambda_nm);
    if (port->dome) return ray_through_dome(*port, in_air, glass_index, water_index);
    if (is_across_axis(*port)) return ray_across_axis(*port, in_air, glass_index, water_index);
    return ray_through_tilted(*port, in_air, glass_index, water_index);
}

bool is_across_axis(const PortWindow& port) {
    return !port.dome && port.normal == Vector3d::UnitZ();
}

double front_m(const Port& port) {
    if (!port) return 0.0;
    if (!port->dome) return (port->distance_m + port->thickness_m) / port->normal.z();
    return way_out_m(
        -port->dome->centre_m, Vector3d::UnitZ(), port->dome->radius_m + port->thickness_m);
}

std::string port_signature(const PortWindow& port) {
    // Names every field: a new field must be added here.
    const auto& [distance_m, thickness_m, glass, normal, dome] = port;
    const auto words = [](const Vector3d& v) {
        return fmt::format("{} {} {}", v.x(), v.y(), v.z());
    };
    if (dome) {
        const auto& [centre_m, radius_m] = *dome;
        return fmt::format("a dome of radius {} m about {} m, {} m of {}",
                           radius_m,
                           words(centre_m),
                           thickness_m,
                           glass.name());
    }
    const std::string across =
        fmt::format("{} m off, {} m of {}", distance_m, thickness_m, glass.name());
    return is_across_axis(port) ? across : fmt::format("{}, normal {}", across, words(normal));
}

}  // namespace aphotic
