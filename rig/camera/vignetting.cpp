// SPDX-License-Identifier: BSD-3-Clause
#include "rig/camera/vignetting.h"

#include "base/degrees.h"
#include "base/error.h"
#include "rig/camera/camera.h"
#include "rig/camera/lens.h"
#include "spectral/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace aphotic {

using Eigen::Vector2d;

namespace {

double angle_in_air_rad(const Camera& camera, double column, double row) {
    const Eigen::Vector3d direction = direction_in_air(camera, column, row);
    return std::atan2(direction.head<2>().norm(), direction.z());
}

double factor(const NaturalVignetting& natural, const Camera& camera, double column, double row) {
    const double cosine = direction_in_air(camera, column, row).z();
    // A product for the usual exponent, and a power for the others.
    if (natural.exponent == 4.0) return cosine * cosine * cosine * cosine;
    return std::pow(std::max(cosine, 0.0), natural.exponent);
}

double factor(const RadialVignetting& radial, const Camera& camera, double column, double row) {
    const double q = radial_square(camera, column, row);
    return 1.0 + q * (radial.a[0] + q * (radial.a[1] + q * radial.a[2]));
}

double factor(const TabulatedVignetting& table, const Camera& camera, double column, double row) {
    const double angle_rad = angle_in_air_rad(camera, column, row);
    const std::vector<double>& angles_rad = table.angles_rad;
    if (angle_rad > angles_rad.back()) {
        throw InputError(
            "the table ends at {:.4g} degrees, but the image reaches {:.4g} at column {}, row {}; "
            "allowed: a table that reaches as far",
            angles_rad.back() * kDegreesPerRadian,
            angle_rad * kDegreesPerRadian,
            column,
            row);
    }
    const auto above = std::upper_bound(angles_rad.begin() + 1, angles_rad.end() - 1, angle_rad);
    const auto j = static_cast<std::size_t>(above - angles_rad.begin());
    const double share = (angle_rad - angles_rad[j - 1]) / (angles_rad[j] - angles_rad[j - 1]);
    return std::lerp(table.factors[j - 1], table.factors[j], share);
}

}  // namespace

double radial_square(const Camera& camera, double column, double row) {
    const Vector2d image_px(camera.width_px, camera.height_px);
    const Vector2d centre_px = camera.lens ? camera.lens->centre_px : Vector2d(0.5 * image_px);
    return (Vector2d(column, row) - centre_px).squaredNorm() / (0.25 * image_px.squaredNorm());
}

double vignetting_at(const Camera& camera, double column, double row) {
    if (!camera.vignetting) return 1.0;
    return std::visit([&](const auto& kind) { return factor(kind, camera, column, row); },
                      *camera.vignetting);
}

RadialVignetting radial_like(const Camera& camera) {
    if (!camera.vignetting) return {};
    if (const auto* radial = std::get_if<RadialVignetting>(&*camera.vignetting)) return *radial;
    constexpr int kSteps = 24;
    Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
            const double column = static_cast<double>(camera.width_px) * i / kSteps;
            const double row = static_cast<double>(camera.height_px) * j / kSteps;
            const double q = radial_square(camera, column, row);
            const Eigen::Vector3d powers(q, q * q, q * q * q);
            G += powers * powers.transpose();
            b += powers * (vignetting_at(camera, column, row) - 1.0);
        }
    }
    const Eigen::Vector3d a = G.ldlt().solve(b);
    return {.a = {a(0), a(1), a(2)}};
}

std::vector<float> vignetting_plane(const Camera& camera) {
    std::vector<float> plane;
    plane.reserve(static_cast<std::size_t>(camera.width_px) *
                  static_cast<std::size_t>(camera.height_px));
    for (int row = 0; row < camera.height_px; ++row) {
        for (int column = 0; column < camera.width_px; ++column) {
            plane.push_back(static_cast<float>(vignetting_at(camera, column + 0.5, row + 0.5)));
        }
    }
    return plane;
}

void require_bright(const Camera& camera) {
    constexpr int kSteps = 64;
    for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
            const double column = camera.width_px * (i / static_cast<double>(kSteps));
            const double row = camera.height_px * (j / static_cast<double>(kSteps));
            const double V = vignetting_at(camera, column, row);
            if (V > 0.0) continue;
            throw InputError(
                "found a factor of {:.4g} at column {:.0f}, row {:.0f}; allowed: above 0",
                V,
                column,
                row);
        }
    }
}

TabulatedVignetting parse_vignetting_csv(const std::string& file_name, std::string_view text) {
    const Table table = parse_table(file_name, text);
    if (table.columns != std::vector<std::string>{"angle_deg", "factor"}) {
        fail_at_line(file_name,
                     table.header_line,
                     "found the columns {}; allowed: angle_deg,factor",
                     fmt::join(table.columns, ","));
    }
    TabulatedVignetting made;
    for (const auto& [line, fields] : table.rows) {
        const double angle_rad = fields[0] * kRadiansPerDegree;
        const bool increases =
            made.angles_rad.empty() ? angle_rad == 0.0 : angle_rad > made.angles_rad.back();
        if (!increases)
            fail_at_line(
                file_name, line, "angle_deg: found {}; allowed: from 0, increasing", fields[0]);
        if (!(fields[1] > 0.0))
            fail_at_line(file_name, line, "factor: found {}; allowed: above 0", fields[1]);
        made.angles_rad.push_back(angle_rad);
        made.factors.push_back(fields[1]);
    }
    if (made.factors.size() < 2)
        fail_at_line(
            file_name, table.header_line, "found {} rows; allowed: 2 or more", made.factors.size());
    return made;
}

std::string vignetting_signature(const Vignetting& vignetting) {
    if (const auto* radial = std::get_if<RadialVignetting>(&vignetting))
        return fmt::format("radial {}", fmt::join(radial->a, " "));
    if (const auto* table = std::get_if<TabulatedVignetting>(&vignetting)) {
        return fmt::format(
            "table {} at {}", fmt::join(table->factors, " "), fmt::join(table->angles_rad, " "));
    }
    const double exponent = std::get<NaturalVignetting>(vignetting).exponent;
    return exponent == 4.0 ? "natural" : fmt::format("cosine {}", exponent);
}

}  // namespace aphotic
