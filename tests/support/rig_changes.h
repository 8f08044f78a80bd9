// SPDX-License-Identifier: BSD-3-Clause
//
// What may be done to a rig so that its image follows from the image before, by the physics alone.
//
//   scaled       all lengths in the water times s, all losses per metre over s: light falls with
//   the
//                square of the distance, L(s) = L / s^2. Of the camera only the port has lengths in
//                the scene; focal length and pixel pitch count by their ratio alone, as a beam's
//                optics do
//   mirrored     port and starboard exchanged, in beams as well: the columns run the other way
//   turned       a quarter of a turn about the camera's axis, forward to starboard: the rows of a
//                square image become its columns. What lies along the sled's axes, an emitter's
//                sides, is not turned with it
//   with_power   every strobe's power times a factor: so is every sample
#pragma once

#include "rig/beam/beam.h"
#include "rig/rig.h"

#include <Eigen/Geometry>

#include <cmath>
#include <utility>
#include <variant>
#include <vector>

namespace aphotic {

inline Spectrum times(const Spectrum& spectrum, double factor) {
    std::vector<double> values(spectrum.values().begin(), spectrum.values().end());
    for (double& value : values) value *= factor;
    return {spectrum.name(),
            {spectrum.lambda_nm().begin(), spectrum.lambda_nm().end()},
            std::move(values)};
}

// Every point of the shape through `move`, which takes axes to axes.
template <typename Move>
Shape moved(const Shape& shape, const Move& move, double radius_factor = 1.0) {
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        return Sphere{.centre_m = move(sphere->centre_m),
                      .radius_m = radius_factor * sphere->radius_m};
    }
    if (const auto* box = std::get_if<Box>(&shape)) {
        const Eigen::Vector3d a_m = move(box->least_m);
        const Eigen::Vector3d b_m = move(box->most_m);
        return Box{.least_m = a_m.cwiseMin(b_m), .most_m = a_m.cwiseMax(b_m)};
    }
    Mesh mesh = std::get<Mesh>(shape);
    for (Eigen::Vector3d& vertex_m : mesh.vertices_m) vertex_m = move(vertex_m);
    return mesh;
}

inline Rig scaled(Rig rig, double s) {
    rig.sled.altitude_m *= s;
    if (rig.camera.port) {
        rig.camera.port->distance_m *= s;
        rig.camera.port->thickness_m *= s;
    }
    rig.water.absorption_per_m = times(rig.water.absorption_per_m, 1.0 / s);
    rig.water.uniform_loss_per_m /= s;
    for (Strobe& strobe : rig.strobes) {
        strobe.position_m *= s;
        if (!strobe.emitter) continue;
        strobe.emitter->across_m *= s;
        strobe.emitter->along_m *= s;
    }
    for (Object& object : rig.objects) {
        object.shape = moved(
            object.shape, [s](const Eigen::Vector3d& p) { return Eigen::Vector3d(s * p); }, s);
    }
    return rig;
}

// Of a beam whose lamp's frame is mirrored across `across`: the planes come in reverse order, at
// the other side of 0; about the axis, at the rest of the turn.
inline BeamTable mirrored(BeamTable table) {
    if (table.horizontal_rad.size() == 1) return table;
    const double whole_rad = table.angles == TableAngles::TypeC ? table.horizontal_rad.back() : 0.0;
    BeamTable other = table;
    const std::size_t planes = table.horizontal_rad.size();
    const std::size_t rows = table.vertical_rad.size();
    for (std::size_t h = 0; h < planes; ++h) {
        const std::size_t from = planes - 1 - h;
        other.horizontal_rad[h] = whole_rad - table.horizontal_rad[from];
        for (std::size_t v = 0; v < rows; ++v) {
            other.intensity[h * rows + v] = table.intensity[from * rows + v];
        }
    }
    return other;
}

inline Beam mirrored(Beam beam) {
    if (auto* table = std::get_if<BeamTable>(&beam.pattern)) *table = mirrored(*table);
    beam.turn_rad = -beam.turn_rad;
    return beam;
}

inline Rig mirrored(Rig rig) {
    const auto mirror = [](const Eigen::Vector3d& p) {
        return Eigen::Vector3d(p.x(), -p.y(), p.z());
    };
    rig.sled.roll_rad = -rig.sled.roll_rad;
    for (Strobe& strobe : rig.strobes) {
        strobe.position_m = mirror(strobe.position_m);
        strobe.axis = mirror(strobe.axis);
        strobe.beam = mirrored(strobe.beam);
    }
    for (Object& object : rig.objects) object.shape = moved(object.shape, mirror);
    return rig;
}

inline Rig turned(Rig rig) {
    const auto turn = [](const Eigen::Vector3d& p) {
        return Eigen::Vector3d(-p.y(), p.x(), p.z());
    };
    // Straight down in the sled's frame is (-sin p, cos p sin q, cos p cos q).
    const double p = rig.sled.pitch_rad;
    const double q = rig.sled.roll_rad;
    const Eigen::Vector3d down =
        turn({-std::sin(p), std::cos(p) * std::sin(q), std::cos(p) * std::cos(q)});
    rig.sled.pitch_rad = -std::asin(down.x());
    rig.sled.roll_rad = std::atan2(down.y(), down.z());
    // The floor's point straight below the pupil lies on the axis of the turn: it stays.
    for (Strobe& strobe : rig.strobes) {
        strobe.position_m = turn(strobe.position_m);
        // The beam turns along, and its frame does not quite.
        const Eigen::Vector3d along = turn(frame_about(strobe.axis).along);
        strobe.axis = turn(strobe.axis);
        const BeamFrame frame = frame_about(strobe.axis);
        strobe.beam.turn_rad += std::atan2(along.dot(frame.across), along.dot(frame.along));
    }
    for (Object& object : rig.objects) object.shape = moved(object.shape, turn);
    return rig;
}

inline Rig with_power(Rig rig, double factor) {
    for (Strobe& strobe : rig.strobes) strobe.power *= factor;
    return rig;
}

inline Rig with_loss(Rig rig, double per_m) {
    rig.water.uniform_loss_per_m += per_m;
    return rig;
}

inline Rig only_strobe(Rig rig, std::size_t index) {
    rig.strobes = {rig.strobes[index]};
    return rig;
}

}  // namespace aphotic
