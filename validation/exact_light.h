// SPDX-License-Identifier: BSD-3-Clause
//
// The light of a rig's bare floor, pixel by pixel, in a number type of the caller's choice: the
// answer to which both renderers are held where double or single precision ends.
//
//   L(lambda) = sum  Phi power I / (pi d^2)
//                    (rho cos(i) + phong max(0, m.l)^size)  exp(-K (d + r))
//   S_c       = sum over panels of Gauss-Legendre of L(lambda) Q_c(lambda)
//
// with the letters of tracer.h. It is as slow and as plain as the formula: nothing is tabulated,
// every wavelength starts from the rig again. Angles of incidence come from heights above the
// floor and not from differences of points, so that grazing light loses no digits.
//
//   long double   64 bits of mantissa, and exponents down to 1e-4932: optical depths of 11 000
//   any other     of Boost.Multiprecision, say, to tell what long double is worth
//
// Between neighbouring knots of all tables every factor but the exponential is a straight line; a
// panel is cut so short that the exponent changes by at most kPanelDepth over it, where
// kPanelPoints nodes are exact to 1e-18. What has lost kNothing of depth to the brighter end of its
// interval is e^-kNothing of it, and left out.
//
// I is the sum of A_k cos^n(theta) S over the cones, with the letters of rig/beam.h; the flux of a
// soft edge is integrated by parts, 2 pi / (n + 1) times the integral of S'(u) (1 - u^(n + 1)) over
// the cosine u.
//
// Limits: point lamps, no objects, a flat floor, no veil. Q_c is taken in double, for its table is
// double; so is I of a pattern, or behind a window (traced_beam.h).
#pragma once

#include "rig/rig.h"
#include "spectral/refractive_index.h"
#include "spectral/sensor.h"
#include "validation/traced_beam.h"
#include "validation/traced_water.h"

#include <boost/math/constants/constants.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace aphotic {

template <typename Real>
class ExactLight {
  public:
    explicit ExactLight(const Rig& rig) : rig_(rig), water_(rig.water) {
        using std::cos;
        using std::sin;
        const Real pitch = rig.sled.pitch_rad;
        const Real roll = rig.sled.roll_rad;
        down_ = {-sin(pitch), cos(pitch) * sin(roll), cos(pitch) * cos(roll)};
        std::vector<const Spectrum*> curves = rig.camera.sensor.curves();
        curves.push_back(&rig.seafloor.reflectance);
        if (rig.water.multiple != 0.0) {
            curves.push_back(&rig.water.absorption_per_m);
            for (const Scatterer& scatterer : rig.water.scatterers)
                curves.push_back(&scatterer.scattering_per_m);
        }
        for (const Strobe& strobe : rig.strobes) {
            curves.push_back(&strobe.spectrum);
            beams_.emplace_back(strobe.beam, strobe.axis);
            on_axis_.emplace_back();
            for (const Cone& cone : strobe.beam.cones) {
                const bool is_flux = strobe.beam.weights == ConeWeights::Flux;
                on_axis_.back().push_back(is_flux ? Real(cone.weight / flux_of_lobe(cone))
                                                  : Real(cone.weight));
            }
        }
        knots_nm_ = union_of_knots(curves, rig.camera.range);
    }

    // Of the point (column, row) of the image; pixel (0, 0)'s centre is (0.5, 0.5).
    [[nodiscard]] Real radiance(double column, double row, double lambda_nm) const {
        return radiance_of(lit_at(column, row, lambda_nm), lambda_nm);
    }

    [[nodiscard]] std::array<Real, kChannels> signals(double column, double row) const {
        const Pixel pixel{column, row};
        const std::vector<Lit> lit = lit_at(column, row, middle_nm(0, knots_nm_.size() - 1));
        std::array<Real, kChannels> sum{};
        for (std::size_t k = 0; k + 1 < knots_nm_.size(); ++k) add_interval(pixel, lit, k, sum);
        return sum;
    }

  private:
    using Vector = std::array<Real, 3>;

    static constexpr int kPanelPoints = 10;
    static constexpr double kPanelDepth = 2.0;
    static constexpr double kNothing = 80.0;

    struct Pixel {
        double column;
        double row;
    };

    struct View {
        Vector point_m;
        Vector direction;
        Real distance_m;  // in water
    };

    // What one strobe does to a point as the camera sees it, without wavelength.
    struct Lit {
        const Strobe* strobe;
        Real diffuse;   // sum of power I cos(i) / (pi d^2)
        Real specular;  // the same with phong max(0, m.l)^size for cos(i)
        Real path_m;    // d + r
    };

    [[nodiscard]] double middle_nm(std::size_t first, std::size_t last) const {
        return 0.5 * (knots_nm_[first] + knots_nm_[last]);
    }

    [[nodiscard]] static Real dot(const Vector& a, const Vector& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }

    [[nodiscard]] static Vector from(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

    // A table's value between its knots, in Real: f_i + (f_j - f_i) t.
    [[nodiscard]] static Real value(const Spectrum& table, const Real& lambda_nm) {
        const std::span<const double> knots_nm = table.lambda_nm();
        const auto above = std::upper_bound(
            knots_nm.begin() + 1, knots_nm.end() - 1, static_cast<double>(lambda_nm));
        const auto j = static_cast<std::size_t>(std::distance(knots_nm.begin(), above));
        const Real left_nm = knots_nm[j - 1];
        const Real left = table.values()[j - 1];
        return left +
               (table.values()[j] - left) * ((lambda_nm - left_nm) / (knots_nm[j] - left_nm));
    }

    [[nodiscard]] Real attenuation_per_m(const Real& lambda_nm) const {
        const Water& water = rig_.water;
        if (water.multiple == 0.0) return water.uniform_loss_per_m;
        Real loss = value(water.absorption_per_m, lambda_nm);
        for (std::size_t i = 0; i < water.scatterers.size(); ++i) {
            loss += water_.lost(i) * value(water.scatterers[i].scattering_per_m, lambda_nm);
        }
        return water.multiple * loss + water.uniform_loss_per_m;
    }

    // Height of a point over the floor, the plane through (0, 0, altitude).
    [[nodiscard]] Real height_m(const Vector& point_m) const {
        return down_[2] * (rig_.sled.altitude_m - point_m[2]) - down_[0] * point_m[0] -
               down_[1] * point_m[1];
    }

    [[nodiscard]] std::optional<View> look(double column, double row, double lambda_nm) const {
        using std::sqrt;
        const Camera& camera = rig_.camera;
        const Real pitch_m = camera.pixel_pitch_m;
        const Real right = (column - Real(camera.width_px) / 2) * pitch_m / camera.focal_length_m;
        const Real up = (Real(camera.height_px) / 2 - row) * pitch_m / camera.focal_length_m;
        const Real length = sqrt(right * right + up * up + 1);
        Vector origin_m{0, 0, 0};
        Vector direction{up / length, right / length, 1 / length};
        if (camera.port) enter_water(*camera.port, lambda_nm, origin_m, direction);
        const Real approach = dot(direction, down_);
        const Real height = height_m(origin_m);
        if (!(approach > 0) || !(height > 0)) return std::nullopt;
        View view{.point_m = origin_m, .direction = direction, .distance_m = height / approach};
        for (std::size_t i = 0; i < 3; ++i) view.point_m[i] += view.distance_m * direction[i];
        return view;
    }

    // Snell at both faces: the sine off the axis, times the index, stays what it was.
    void enter_water(const PortWindow& port,
                     double lambda_nm,
                     Vector& origin_m,
                     Vector& direction) const {
        using std::sqrt;
        const Real glass = port.glass.index(lambda_nm);
        const Real water =
            seawater_index(lambda_nm, rig_.water.salinity_psu, rig_.water.temperature_c);
        const Real sine2 = direction[0] * direction[0] + direction[1] * direction[1];
        const Real aside =
            port.distance_m / direction[2] + port.thickness_m / sqrt(glass * glass - sine2);
        const Real front_m = Real(port.distance_m) + port.thickness_m;
        origin_m = {direction[0] * aside, direction[1] * aside, front_m};
        direction = {direction[0] / water, direction[1] / water, sqrt(1 - sine2 / (water * water))};
    }

    // Nothing where the image sees no floor.
    [[nodiscard]] std::vector<Lit> lit_at(double column, double row, double lambda_nm) const {
        std::vector<Lit> lit;
        const auto view = look(column, row, lambda_nm);
        if (!view) return lit;
        for (std::size_t s = 0; s < rig_.strobes.size(); ++s) lit.push_back(lit_by(s, *view));
        return lit;
    }

    [[nodiscard]] Lit lit_by(std::size_t s, const View& view) const {
        using std::pow;
        using std::sqrt;
        const Strobe& strobe = rig_.strobes[s];
        const Vector lamp_m = from(strobe.position_m);
        Vector path_m{};
        for (std::size_t i = 0; i < 3; ++i) path_m[i] = view.point_m[i] - lamp_m[i];
        const Real d = sqrt(dot(path_m, path_m));
        const Real cos_incidence = height_m(lamp_m) / d;
        Lit lit{.strobe = &strobe, .diffuse = 0, .specular = 0, .path_m = d + view.distance_m};
        if (!(cos_incidence > 0)) return lit;
        const Real pi = boost::math::constants::pi<Real>();
        const Real arriving = strobe.power * intensity(s, path_m, d) / (pi * d * d);
        lit.diffuse = arriving * cos_incidence;
        // m = v - 2 (v.n) n with n = -down, and l = -path / d
        const Real aligned =
            (2 * dot(view.direction, down_) * dot(path_m, down_) - dot(view.direction, path_m)) / d;
        if (rig_.seafloor.phong > 0.0 && aligned > 0) {
            lit.specular =
                arriving * rig_.seafloor.phong * pow(aligned, Real(rig_.seafloor.phong_size));
        }
        return lit;
    }

    // The integral of cos^n S: 2 pi (1 - cos^(n + 1)) / (n + 1) of a sharp edge, without a small
    // difference, and the mean of that over a soft one.
    [[nodiscard]] static Real flux_of_lobe(const Cone& cone) {
        using std::expm1;
        using std::log1p;
        using std::sin;
        const Real pi = boost::math::constants::pi<Real>();
        const Real power = Real(cone.exponent) + 1;
        const Real sine = sin(Real(cone.half_angle_rad));
        if (cone.edge_rad == 0.0) {
            return cone.exponent == 1.0
                       ? Real(pi * sine * sine)
                       : Real(-2 * pi * expm1(power / 2 * log1p(-sine * sine)) / power);
        }
        const Real none = versine(cone.half_angle_rad);
        const Real full = versine(Real(cone.half_angle_rad) - cone.edge_rad);
        const auto share = [&](const Real& t) {
            const Real cosine = 1 - none + (none - full) * t;
            if (!(cosine > 0)) return Real(6 * t * (1 - t));
            return Real(-6 * t * (1 - t) * expm1(power * log1p(-none + (none - full) * t)));
        };
        boost::math::quadrature::tanh_sinh<Real> quadrature;
        return 2 * pi / power * quadrature.integrate(share, Real(0), Real(1));
    }

    // 1 - cos.
    [[nodiscard]] static Real versine(const Real& angle_rad) {
        using std::sin;
        const Real half = sin(angle_rad / 2);
        return 2 * half * half;
    }

    [[nodiscard]] Real intensity(std::size_t s, const Vector& path_m, const Real& d) const {
        const Strobe& strobe = rig_.strobes[s];
        const Beam& beam = strobe.beam;
        if (beam.window || !std::holds_alternative<std::monostate>(beam.pattern)) {
            return beams_[s].intensity({static_cast<double>(path_m[0]),
                                        static_cast<double>(path_m[1]),
                                        static_cast<double>(path_m[2])});
        }
        const Real cos_theta = dot(path_m, from(strobe.axis)) / d;
        Real sum = 0;
        for (std::size_t k = 0; k < beam.cones.size() && cos_theta > 0; ++k) {
            sum += on_axis_[s][k] * falloff(beam.cones[k], cos_theta);
        }
        return sum;
    }

    // cos^n S
    [[nodiscard]] static Real falloff(const Cone& cone, const Real& cos_theta) {
        using std::cos;
        using std::pow;
        const Real none = cos(Real(cone.half_angle_rad));
        if (cos_theta < none) return 0;
        const Real lobe =
            cone.exponent == 1.0 ? cos_theta : Real(pow(cos_theta, Real(cone.exponent)));
        const Real full = cos(Real(cone.half_angle_rad) - cone.edge_rad);
        if (cos_theta >= full) return lobe;
        const Real t = (cos_theta - none) / (full - none);
        return lobe * t * t * (3 - 2 * t);
    }

    [[nodiscard]] Real radiance_of(const std::vector<Lit>& lit, const Real& lambda_nm) const {
        using std::exp;
        const Real attenuation = attenuation_per_m(lambda_nm);
        const Real reflectance = value(rig_.seafloor.reflectance, lambda_nm);
        Real sum = 0;
        for (const Lit& one : lit) {
            sum += value(one.strobe->spectrum, lambda_nm) *
                   (reflectance * one.diffuse + one.specular) * exp(-attenuation * one.path_m);
        }
        return sum;
    }

    // Between the knots k and k + 1, from the end where the water is clearer.
    void add_interval(const Pixel& pixel,
                      const std::vector<Lit>& lit,
                      std::size_t k,
                      std::array<Real, kChannels>& sum) const {
        using std::abs;
        const Real first = attenuation_per_m(knots_nm_[k]);
        const Real last = attenuation_per_m(knots_nm_[k + 1]);
        Real longest_m = 0;
        for (const Lit& one : lit) longest_m = std::max(longest_m, one.path_m);
        const double panels = std::max(
            1.0, std::ceil(static_cast<double>(abs(last - first) * longest_m) / kPanelDepth));
        const Real width_nm = (Real(knots_nm_[k + 1]) - knots_nm_[k]) / panels;
        const auto counted = static_cast<int>(std::min(panels, kNothing / kPanelDepth));
        for (int p = 0; p < counted; ++p) {
            const Real from_clear_nm = width_nm * (2 * p + 1) / 2;
            add_panel(pixel,
                      lit,
                      first <= last ? Real(knots_nm_[k] + from_clear_nm)
                                    : Real(knots_nm_[k + 1] - from_clear_nm),
                      width_nm / 2,
                      sum);
        }
    }

    void add_panel(const Pixel& pixel,
                   const std::vector<Lit>& lit,
                   const Real& middle_nm,
                   const Real& half_nm,
                   std::array<Real, kChannels>& sum) const {
        using Gauss = boost::math::quadrature::gauss<Real, kPanelPoints>;
        const auto add_node = [&](const Real& lambda_nm, const Real& weight) {
            const auto nm =
                std::clamp(static_cast<double>(lambda_nm), knots_nm_.front(), knots_nm_.back());
            // Behind a port every wavelength has its own ray.
            const Real arriving =
                weight * half_nm *
                radiance_of(rig_.camera.port ? lit_at(pixel.column, pixel.row, nm) : lit,
                            lambda_nm);
            for (int c = 0; c < kChannels; ++c) {
                sum[static_cast<std::size_t>(c)] += arriving * rig_.camera.sensor.response(c, nm);
            }
        };
        for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
            const Real step_nm = half_nm * Gauss::abscissa()[i];
            add_node(middle_nm + step_nm, Gauss::weights()[i]);
            add_node(middle_nm - step_nm, Gauss::weights()[i]);
        }
    }

    Rig rig_;
    TracedWater water_;
    Vector down_;
    std::vector<double> knots_nm_;
    // By strobe.
    std::vector<TracedBeam> beams_;
    std::vector<std::vector<Real>> on_axis_;  // A_k
};

}  // namespace aphotic
