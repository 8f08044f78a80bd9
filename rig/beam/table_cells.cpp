// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/table_cells.h"

#include <array>
#include <cstddef>
#include <limits>
#include <numbers>

namespace aphotic {
namespace {

using std::numbers::pi;

// atan(t) for |t| <= 7/16, as t minus t^3 times this polynomial in t^2: fdlibm's s_atan.c (Sun
// Microsystems, 1993), accurate to 2^-58. Even and odd powers are separate, which makes two short
// chains.
Pack arc_tangent(const Pack& t) {
    constexpr std::array kByDegree{3.33333333333329318027e-01,
                                   -1.99999999998764832476e-01,
                                   1.42857142725034663711e-01,
                                   -1.11111104054623557880e-01,
                                   9.09088713343650656196e-02,
                                   -7.69187620504482999495e-02,
                                   6.66107313738753120669e-02,
                                   -5.83357013379057348645e-02,
                                   4.97687799461593236017e-02,
                                   -3.65315727442169155270e-02,
                                   1.62858201153657823623e-02};
    const Pack t2 = t * t;
    const Pack t4 = t2 * t2;
    Pack even = kByDegree[10];
    Pack odd = kByDegree[9];
    for (const std::size_t k : {8U, 6U, 4U, 2U}) {
        even = kByDegree[k] + t4 * even;
        odd = kByDegree[k - 1] + t4 * odd;
    }
    return t - t * t2 * (kByDegree[0] + t4 * even + t2 * odd);
}

// atan2(y, x), for length r. Half the angle to the nearer axis has the tangent lo / (r + hi), at
// most tan(pi / 8).
Pack angle_of(const Pack& y, const Pack& x, const Pack& r) {
    namespace simd = std::experimental;
    const Pack across = simd::abs(y);
    const Pack along = simd::abs(x);
    const Pack far = r + simd::max(across, along);
    constexpr double kNone = std::numeric_limits<double>::min();  // all are 0
    Pack angle = 2.0 * arc_tangent(simd::min(across, along) / simd::max(far, Pack(kNone)));
    where(across > along, angle) = 0.5 * pi - angle;
    where(x < 0.0, angle) = pi - angle;
    where(y < 0.0, angle) = -angle;
    return angle;
}

// V and H, as in angles_of().
std::array<Pack, 2> pack_angles(TableAngles type, const PackVector& direction, const Pack& length) {
    const auto& [x, y, z] = direction;
    if (type == TableAngles::TypeC) {
        const Pack off_axis = root(x * x + y * y);
        Pack turn_rad = angle_of(-y, x, off_axis);
        where(turn_rad < 0.0, turn_rad) = turn_rad + 2.0 * pi;
        return {angle_of(off_axis, z, length), turn_rad};
    }
    const bool is_a = type == TableAngles::TypeA;
    const Pack& latitude = is_a ? x : y;
    const Pack& longitude = is_a ? y : x;
    const Pack rest = root(longitude * longitude + z * z);
    const Pack latitude_rad = angle_of(latitude, rest, length);
    const Pack longitude_rad = angle_of(longitude, z, rest);
    if (is_a) return {latitude_rad, longitude_rad};
    return {longitude_rad, latitude_rad};
}

}  // namespace

TableCells::Axis::Axis(const std::vector<double>& nodes_rad) : cell(nodes_rad) {
    for (std::size_t i = 1; i < nodes_rad.size(); ++i)
        per_step.push_back(1.0 / (nodes_rad[i] - nodes_rad[i - 1]));
}

bool TableCells::Axis::contains(double angle_rad) const {
    return angle_rad >= cell.nodes().front() - kCellAngle_rad &&
           angle_rad <= cell.nodes().back() + kCellAngle_rad;
}

TableCells::Place TableCells::Axis::place(double angle_rad) const {
    const std::size_t k = cell(angle_rad);
    return {.cell = k, .share = (angle_rad - cell.nodes()[k]) * per_step[k]};
}

TableCells::TableCells(const BeamTable& table)
    : angles_(table.angles),
      vertical_(table.vertical_rad),
      horizontal_(table.horizontal_rad),
      intensity_(table.intensity) {}

Lanes TableCells::at(const LaneVector& direction, const Lanes& length) const {
    Lanes vertical_rad;
    Lanes horizontal_rad;
    for_each_pack([&](std::size_t k) {
        const auto [V, H] = pack_angles(angles_, pack(direction, k), length.pack(k));
        vertical_rad.set_pack(k, V);
        horizontal_rad.set_pack(k, H);
    });
    Lanes I;
    for (std::size_t k = 0; k < kLanes; ++k) I[k] = at(vertical_rad[k], horizontal_rad[k]);
    return I;
}

double TableCells::at(double V, double H) const {
    if (!vertical_.contains(V) || !horizontal_.contains(H)) return 0.0;
    const auto [row, v] = vertical_.place(V);
    const auto [column, h] = horizontal_.place(H);
    const double* const near = &intensity_[column * vertical_.per_step.size() + column + row];
    const double* const far = near + vertical_.per_step.size() + 1;
    return (1.0 - h) * ((1.0 - v) * near[0] + v * near[1]) + h * ((1.0 - v) * far[0] + v * far[1]);
}

}  // namespace aphotic
