// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/camera_to_srgb.h"

#include "base/error.h"
#include "spectral/colour_difference.h"

#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace aphotic {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr WavelengthRange kVisible{380.0, 780.0};

// Calls work with every whole nanometre of the range.
template <typename Work>
void each_nm(WavelengthRange range, const Work& work) {
    for (double nm = std::ceil(range.first_nm); nm <= range.last_nm; nm += 1.0) work(nm);
}

double reflected(const Spectrum& surface, double lambda_nm) {
    return surface.at(std::clamp(lambda_nm, surface.range().first_nm, surface.range().last_nm));
}

std::vector<Spectrum> surfaces() {
    std::vector<Spectrum> surfaces;
    for (const BuiltinTable& patch : chart_patches()) {
        const Table table = parse_table(std::string(patch.name), patch.csv);
        surfaces.push_back(curves_of(table, CurveRole::Reflectance).front());
    }
    for (const std::string& name : builtin_names(role_name(CurveRole::Reflectance))) {
        surfaces.push_back(load_curve(name, CurveRole::Reflectance, {}));
    }
    return surfaces;
}

// An observer's response under daylight.
class Observer {
  public:
    Observer()
        : daylight_(load_curve("cie-d65", CurveRole::LampSpectrum, {})),
          matching_(load_curves("cie-1931", CurveRole::ColourMatching, {})) {
        white_ = seen([](double) { return 1.0; });
        scale_ = 1.0 / white_.y();
        white_ *= scale_;
        // IEC 61966-2-1, x and y of red, green and blue.
        Matrix3d primaries;
        primaries << 0.64 / 0.33, 0.30 / 0.60, 0.15 / 0.06,  //
            1.0, 1.0, 1.0,                                   //
            0.03 / 0.33, 0.10 / 0.60, 0.79 / 0.06;
        const Vector3d luminances = primaries.inverse() * white_;
        xyz_of_srgb_ = primaries * luminances.asDiagonal();
        srgb_of_xyz_ = xyz_of_srgb_.inverse();
    }

    [[nodiscard]] Vector3d srgb_of(const Spectrum& surface) const {
        return srgb_of_xyz_ * scale_ *
               seen([&](double lambda_nm) { return reflected(surface, lambda_nm); });
    }

    [[nodiscard]] Vector3d lab_of(const Vector3d& srgb) const {
        const Vector3d shares = (xyz_of_srgb_ * srgb).cwiseQuotient(white_);
        const Lab lab = aphotic::lab_of({shares.x(), shares.y(), shares.z()});
        return {lab.L, lab.a, lab.b};
    }

  private:
    template <typename Reflectance>
    [[nodiscard]] Vector3d seen(const Reflectance& reflectance) const {
        Vector3d sum = Vector3d::Zero();
        each_nm(kVisible, [&](double nm) {
            const double light = daylight_.at(nm) * reflectance(nm);
            for (int i = 0; i < 3; ++i) {
                sum[i] += light * matching_[static_cast<std::size_t>(i)].at(nm);
            }
        });
        return sum;
    }

    Spectrum daylight_;
    std::vector<Spectrum> matching_;
    double scale_ = 1.0;
    Vector3d white_;
    Matrix3d xyz_of_srgb_;
    Matrix3d srgb_of_xyz_;
};

// The response to each surface over that to white, under equal energy in each channel.
std::vector<ShownSurface> shown(const Sensor& sensor,
                                WavelengthRange range,
                                const std::function<double(double)>& light,
                                const Observer& observer) {
    std::vector<double> lambda_nm;
    std::vector<Vector3d> weights;
    Vector3d white = Vector3d::Zero();
    each_nm(range, [&](double nm) {
        lambda_nm.push_back(nm);
        weights.emplace_back(light(nm) * Vector3d(sensor.response(0, nm),
                                                  sensor.response(1, nm),
                                                  sensor.response(2, nm)));
        white += weights.back();
    });
    if (!(white.minCoeff() > 0.0)) {
        throw InputError("a channel receives none of the light; allowed: light in every channel");
    }
    std::vector<ShownSurface> all;
    for (const Spectrum& surface : surfaces()) {
        Vector3d sum = Vector3d::Zero();
        for (std::size_t i = 0; i < lambda_nm.size(); ++i) {
            sum += reflected(surface, lambda_nm[i]) * weights[i];
        }
        all.push_back({.name = surface.short_name(),
                       .channels = sum.cwiseQuotient(white),
                       .srgb = observer.srgb_of(surface)});
    }
    return all;
}

// A row that adds up to 1 is the identity's plus a combination of two rows that add up to 0: least
// squares in two unknowns, of least norm where the surfaces do not determine them.
Matrix3d fitted(const std::vector<ShownSurface>& surfaces) {
    const auto rows = static_cast<Eigen::Index>(surfaces.size());
    Eigen::MatrixX2d differences(rows, 2);
    Eigen::MatrixX3d missing(rows, 3);
    for (Eigen::Index i = 0; i < rows; ++i) {
        const ShownSurface& surface = surfaces[static_cast<std::size_t>(i)];
        const Vector3d& v = surface.channels;
        differences.row(i) << v[0] - v[1], v[1] - v[2];
        missing.row(i) = surface.srgb - v;
    }
    // Channels that differ only by rounding are equal.
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixX2d> solver;
    constexpr double kSame = 1e-9;
    solver.setThreshold(kSame);
    solver.compute(differences);
    const Eigen::Matrix<double, 2, 3> shares = solver.solve(missing);
    Eigen::Matrix<double, 2, 3> zero_sums;
    zero_sums << 1.0, -1.0, 0.0,  //
        0.0, 1.0, -1.0;
    return Matrix3d::Identity() + shares.transpose() * zero_sums;
}

}  // namespace

double CameraToSrgb::mean_delta_e() const {
    double sum = 0.0;
    for (const ShownSurface& surface : surfaces) sum += surface.delta_e;
    return sum / static_cast<double>(surfaces.size());
}

const ShownSurface& CameraToSrgb::worst() const {
    return *std::ranges::max_element(surfaces, {}, &ShownSurface::delta_e);
}

CameraToSrgb camera_to_srgb(const Sensor& sensor,
                            WavelengthRange range,
                            const std::function<double(double)>& light) {
    const Observer observer;
    CameraToSrgb result{.surfaces = shown(sensor, range, light, observer)};
    result.matrix = fitted(result.surfaces);
    for (ShownSurface& surface : result.surfaces) {
        const Vector3d is = observer.lab_of(result.matrix * surface.channels);
        surface.delta_e = (is - observer.lab_of(surface.srgb)).norm();
    }
    return result;
}

}  // namespace aphotic
