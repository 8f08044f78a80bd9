// SPDX-License-Identifier: BSD-3-Clause
//
// The light of a rig's bare floor, pixel by pixel, in a number type of the caller's choice: the
// answer to which both renderers are held where double or single precision ends.
//
//   L(lambda) = sum  Phi power I / (pi d^2)
//                    (rho cos(i) + phong max(0, m.l)^size)  exp(-K (d + r))
//               + veil
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
// I is the sum of A_k cos^n(theta) S over the cones, with the letters of rig/beam/beam.h; the flux
// of a soft edge is integrated by parts, 2 pi / (n + 1) times the integral of S'(u) (1 - u^(n + 1))
// over the cosine u.
//
// The veil of a strobe, by u along the ray from the lamp's nearest point at t_0, h away:
//
//   x = h sinh(u),   dt/d^2 = du / (h cosh(u)),   t + d = t_0 + h e^u,   psi = 2 atan(e^u)
//
// A unit of u is a panel of kVeilPoints of Gauss's, the nearest pole i pi/2 away, and less where
// light is lost faster than by kVeilDepth a panel. Panels end where cones do, by the roots of
// (k.(P - L))^2 = cos^2 d^2, and at a tabulated phase function's rows. A lamp on the ray is
// kVeilBeside_m beside it (traced_veil.h).
//
// Limits: a pinhole, with a flat port across its axis or none, and no vignetting; point lamps, no
// objects, a flat floor; in water that scatters, beams of cones in water. All else is an
// InputError. Q_c is taken in double, for its table is double; so are phase functions, and I of a
// pattern, or behind a window (traced_beam.h).
#pragma once

#include "base/error.h"
#include "rig/rig.h"
#include "spectral/refractive_index.h"
#include "spectral/sensor.h"
#include "validation/traced_beam.h"
#include "validation/traced_veil.h"
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
        require_to_know(rig);
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
        if (!water_.scatters()) return;
        least_loss_per_m_ = attenuation_per_m(knots_nm_.front());
        most_loss_per_m_ = least_loss_per_m_;
        for (const double nm : knots_nm_) {
            const Real loss = attenuation_per_m(nm);
            least_loss_per_m_ = std::min(least_loss_per_m_, loss);
            most_loss_per_m_ = std::max(most_loss_per_m_, loss);
        }
    }

    // Of the point (column, row) of the image; pixel (0, 0)'s centre is (0.5, 0.5).
    [[nodiscard]] Real radiance(double column, double row, double lambda_nm) const {
        return radiance_of(sight_at(column, row, lambda_nm), lambda_nm);
    }

    [[nodiscard]] std::array<Real, kChannels> signals(double column, double row) const {
        const Pixel pixel{column, row};
        const Sight sight = sight_at(column, row, middle_nm(0, knots_nm_.size() - 1));
        std::array<Real, kChannels> sum{};
        for (std::size_t k = 0; k + 1 < knots_nm_.size(); ++k) add_interval(pixel, sight, k, sum);
        return sum;
    }

  private:
    using Vector = std::array<Real, 3>;

    static constexpr int kPanelPoints = 10;
    static constexpr double kPanelDepth = 2.0;
    static constexpr double kNothing = 80.0;
    static constexpr int kVeilPoints = 20;
    static constexpr double kVeilDepth = 8.0;
    static constexpr double kVeilNothing = 45.0;  // of depth from its beginning: 3e-20 is left
    // Of u, over the lamp's nearest point: beyond, sech(u) is e^-kVeilFar.
    static constexpr double kVeilFar = 60.0;

    struct Pixel {
        double column;
        double row;
    };

    // In water, to the floor; sky has no length.
    struct View {
        Vector origin_m;
        Vector direction;
        std::optional<Real> length_m;

        [[nodiscard]] Vector at(const Real& distance_m) const {
            Vector point_m = origin_m;
            for (std::size_t i = 0; i < 3; ++i) point_m[i] += distance_m * direction[i];
            return point_m;
        }
    };

    // What one strobe does to a point as the camera sees it, without wavelength.
    struct Lit {
        const Strobe* strobe;
        Real diffuse;   // sum of power I cos(i) / (pi d^2)
        Real specular;  // the same with phong max(0, m.l)^size for cos(i)
        Real path_m;    // d + r
    };

    // What the water turns of one strobe's light into the view.
    struct Turned {
        const Strobe* strobe;
        std::vector<Real> path_m;              // t + d
        std::vector<std::vector<Real>> light;  // by scatterer, power and quadrature included
    };

    struct Sight {
        std::vector<Lit> lit;  // none where the image sees no floor
        std::vector<Turned> turned;
    };

    static void require_to_know(const Rig& rig) {
        const Camera& camera = rig.camera;
        const auto refuse_if = [](bool is_there, const char* found) {
            if (!is_there) return;
            throw InputError(
                "found {}; allowed in the exact light: a pinhole, with a flat port "
                "across its axis or none, point lamps and a bare floor; and beams of "
                "cones where the water scatters",
                found);
        };
        refuse_if(camera.lens.has_value(), "a calibrated lens");
        refuse_if(camera.vignetting.has_value(), "vignetting");
        refuse_if(camera.port && camera.port->dome, "a dome");
        refuse_if(camera.port && !is_across_axis(*camera.port), "a tilted port");
        refuse_if(!rig.objects.empty() || !rig.scene.empty(), "objects");
        for (const Strobe& strobe : rig.strobes) {
            refuse_if(strobe.emitter.has_value(), "an emitter of a size");
            const bool is_of_cones =
                std::holds_alternative<std::monostate>(strobe.beam.pattern) && !strobe.beam.window;
            refuse_if(rig.water.scatters() && !is_of_cones,
                      "a beam that is no sum of cones in water that scatters");
        }
    }

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

    [[nodiscard]] View look(double column, double row, double lambda_nm) const {
        using std::sqrt;
        const Camera& camera = rig_.camera;
        const Real pitch_m = camera.pixel_pitch_m;
        const Real right = (column - Real(camera.width_px) / 2) * pitch_m / camera.focal_length_m;
        const Real up = (Real(camera.height_px) / 2 - row) * pitch_m / camera.focal_length_m;
        const Real length = sqrt(right * right + up * up + 1);
        View view{.origin_m = {0, 0, 0},
                  .direction = {up / length, right / length, 1 / length},
                  .length_m = std::nullopt};
        if (camera.port) enter_water(*camera.port, lambda_nm, view.origin_m, view.direction);
        const Real approach = dot(view.direction, down_);
        const Real height = height_m(view.origin_m);
        if (approach > 0 && height > 0) view.length_m = height / approach;
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

    [[nodiscard]] Sight sight_at(double column, double row, double lambda_nm) const {
        Sight sight;
        const View view = look(column, row, lambda_nm);
        for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
            if (view.length_m) sight.lit.push_back(lit_by(s, view));
            if (water_.scatters()) sight.turned.push_back(turned_by(s, view));
        }
        return sight;
    }

    [[nodiscard]] Lit lit_by(std::size_t s, const View& view) const {
        using std::pow;
        using std::sqrt;
        const Strobe& strobe = rig_.strobes[s];
        const Vector lamp_m = from(strobe.position_m);
        Vector path_m = view.at(*view.length_m);
        for (std::size_t i = 0; i < 3; ++i) path_m[i] -= lamp_m[i];
        const Real d = sqrt(dot(path_m, path_m));
        const Real cos_incidence = height_m(lamp_m) / d;
        Lit lit{.strobe = &strobe, .diffuse = 0, .specular = 0, .path_m = d + *view.length_m};
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

    // A lamp from the ray: the foot of its perpendicular is t_0 along, h away.
    struct Beside {
        Vector across_m;  // from the lamp to the foot
        Vector along;
        Real foot_m;
        Real away_m;
    };

    [[nodiscard]] Beside beside(const Vector& lamp_m, const View& view) const {
        using std::abs;
        using std::sqrt;
        Vector to_lamp_m = lamp_m;
        for (std::size_t i = 0; i < 3; ++i) to_lamp_m[i] -= view.origin_m[i];
        Beside found{.across_m = {},
                     .along = view.direction,
                     .foot_m = dot(to_lamp_m, view.direction),
                     .away_m = 0};
        for (std::size_t i = 0; i < 3; ++i)
            found.across_m[i] = found.foot_m * view.direction[i] - to_lamp_m[i];
        found.away_m = sqrt(dot(found.across_m, found.across_m));
        if (found.away_m >= kVeilBeside_m) return found;
        // Any way across.
        const std::size_t least = abs(view.direction[0]) < Real(0.5) ? 0 : 1;
        Vector across{};
        across[least] = 1;
        const Real aside = dot(across, view.direction);
        for (std::size_t i = 0; i < 3; ++i) across[i] -= aside * view.direction[i];
        const Real length = sqrt(dot(across, across));
        for (std::size_t i = 0; i < 3; ++i) found.across_m[i] = across[i] / length * kVeilBeside_m;
        found.away_m = kVeilBeside_m;
        return found;
    }

    // Where the ray crosses the cone of the half angle, and the plane across its axis, as x.
    void add_crossings(const Beside& lamp,
                       const Vector& axis,
                       const Real& half_angle_rad,
                       std::vector<Real>& x_m) const {
        using std::cos;
        using std::sqrt;
        const Real to_foot = dot(axis, lamp.across_m);
        const Real along = dot(axis, lamp.along);
        const Real cosine = cos(half_angle_rad);
        const Real a = along * along - cosine * cosine;
        const Real b = to_foot * along;
        const Real c = to_foot * to_foot - cosine * cosine * lamp.away_m * lamp.away_m;
        if (along != 0) x_m.push_back(-to_foot / along);
        const Real inside = b * b - a * c;
        if (inside < 0) return;
        const Real q = b < 0 ? Real(sqrt(inside) - b) : Real(-sqrt(inside) - b);
        if (a != 0) x_m.push_back(q / a);
        if (q != 0) x_m.push_back(c / q);
    }

    [[nodiscard]] Turned turned_by(std::size_t s, const View& view) const {
        using std::asinh;
        using std::exp;
        using std::tan;
        const Strobe& strobe = rig_.strobes[s];
        const Beside lamp = beside(from(strobe.position_m), view);
        const auto u_of = [&](const Real& x_m) { return Real(asinh(x_m / lamp.away_m)); };
        std::vector<Real> x_m;
        for (const Cone& cone : strobe.beam.cones) {
            for (const double edge_rad : {0.0, cone.edge_rad})
                add_crossings(lamp, from(strobe.axis), Real(cone.half_angle_rad) - edge_rad, x_m);
        }
        for (const TracedPhase& phase : water_.phases()) {
            for (const double psi_rad : phase.kinks_rad())
                x_m.push_back(-lamp.away_m / tan(Real(psi_rad)));
        }
        const Real first = std::max(u_of(-lamp.foot_m), u_of(-lamp.away_m / tan(Real(kVeilCut))));
        const Real last = view.length_m ? u_of(*view.length_m - lamp.foot_m)
                                        : std::max(first, Real(0)) + kVeilFar;
        std::vector<Real> cuts{first};
        for (const Real& x : x_m) {
            const Real u = u_of(x);
            if (u > first && u < last) cuts.push_back(u);
        }
        std::ranges::sort(cuts);
        cuts.push_back(last);
        Turned turned{.strobe = &strobe,
                      .path_m = {},
                      .light = std::vector<std::vector<Real>>(water_.phases().size())};
        const Real first_path_m = lamp.foot_m + lamp.away_m * exp(first);
        for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
            for (Real u = cuts[k]; u < cuts[k + 1];) {
                const Real reach_m = lamp.away_m * exp(u);
                if (least_loss_per_m_ * (lamp.foot_m + reach_m - first_path_m) > kVeilNothing)
                    return turned;
                const Real depth = most_loss_per_m_ * reach_m;
                const Real widest = depth > kVeilDepth ? Real(kVeilDepth / depth) : Real(1);
                const Real to = std::min(cuts[k + 1], Real(u + widest));
                add_turned(s, lamp, u, to, turned);
                u = to;
            }
        }
        return turned;
    }

    void add_turned(std::size_t s,
                    const Beside& lamp,
                    const Real& first,
                    const Real& last,
                    Turned& turned) const {
        using std::atan;
        using std::cosh;
        using std::exp;
        using std::sinh;
        using Gauss = boost::math::quadrature::gauss<Real, kVeilPoints>;
        const Real half = (last - first) / 2;
        const auto add_node = [&](const Real& u, const Real& weight) {
            const Real d = lamp.away_m * cosh(u);
            Vector path_m = lamp.across_m;
            for (std::size_t i = 0; i < 3; ++i) path_m[i] += lamp.away_m * sinh(u) * lamp.along[i];
            const Real arriving =
                rig_.strobes[s].power * intensity(s, path_m, d) * weight * half / d;
            const auto psi_rad = static_cast<double>(2 * atan(exp(u)));
            turned.path_m.push_back(lamp.foot_m + lamp.away_m * exp(u));
            for (std::size_t i = 0; i < turned.light.size(); ++i)
                turned.light[i].push_back(arriving * water_.phases()[i].at(psi_rad));
        };
        for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
            const Real step = half * Gauss::abscissa()[i];
            add_node(first + half + step, Gauss::weights()[i]);
            add_node(first + half - step, Gauss::weights()[i]);
        }
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

    [[nodiscard]] Real radiance_of(const Sight& sight, const Real& lambda_nm) const {
        return floor_of(sight, lambda_nm) + veil_of(sight, lambda_nm);
    }

    [[nodiscard]] Real floor_of(const Sight& sight, const Real& lambda_nm) const {
        using std::exp;
        const Real attenuation = attenuation_per_m(lambda_nm);
        const Real reflectance = value(rig_.seafloor.reflectance, lambda_nm);
        Real sum = 0;
        for (const Lit& one : sight.lit) {
            sum += value(one.strobe->spectrum, lambda_nm) *
                   (reflectance * one.diffuse + one.specular) * exp(-attenuation * one.path_m);
        }
        return sum;
    }

    [[nodiscard]] Real veil_of(const Sight& sight, const Real& lambda_nm) const {
        using std::exp;
        if (sight.turned.empty()) return 0;
        const Real attenuation = attenuation_per_m(lambda_nm);
        const std::vector<Scatterer>& scatterers = rig_.water.scatterers;
        std::vector<Real> b;
        for (const Scatterer& scatterer : scatterers)
            b.push_back(rig_.water.multiple * value(scatterer.scattering_per_m, lambda_nm));
        Real sum = 0;
        for (const Turned& turned : sight.turned) {
            Real of_strobe = 0;
            for (std::size_t n = 0; n < turned.path_m.size(); ++n) {
                Real scattered = 0;
                for (std::size_t i = 0; i < b.size(); ++i) scattered += b[i] * turned.light[i][n];
                of_strobe += scattered * exp(-attenuation * turned.path_m[n]);
            }
            sum += value(turned.strobe->spectrum, lambda_nm) * of_strobe;
        }
        return sum;
    }

    // Between the knots k and k + 1: the floor's light from the end where the water is clearer, the
    // veil all over, for its short paths are lit there.
    void add_interval(const Pixel& pixel,
                      const Sight& sight,
                      std::size_t k,
                      std::array<Real, kChannels>& sum) const {
        using std::abs;
        const Real first = attenuation_per_m(knots_nm_[k]);
        const Real last = attenuation_per_m(knots_nm_[k + 1]);
        Real longest_m = 0;
        for (const Lit& one : sight.lit) longest_m = std::max(longest_m, one.path_m);
        const double panels = panels_of(abs(last - first) * longest_m);
        const auto counted = static_cast<int>(std::min(panels, kNothing / kPanelDepth));
        const auto floor = [this](const Sight& seen, const Real& nm) { return floor_of(seen, nm); };
        add_panels(pixel, sight, k, panels, counted, first <= last, floor, sum);
        if (sight.turned.empty()) return;
        const double of_veil = panels_of(change_of_veil(sight, k));
        const auto veil = [this](const Sight& seen, const Real& nm) { return veil_of(seen, nm); };
        add_panels(pixel, sight, k, of_veil, static_cast<int>(of_veil), true, veil, sum);
    }

    [[nodiscard]] static double panels_of(const Real& change) {
        return std::max(1.0, std::ceil(static_cast<double>(change) / kPanelDepth));
    }

    // Of the longest path that something is left of.
    [[nodiscard]] Real change_of_veil(const Sight& sight, std::size_t k) const {
        using std::abs;
        const Real first = attenuation_per_m(knots_nm_[k]);
        const Real last = attenuation_per_m(knots_nm_[k + 1]);
        Real longest_m = 0;
        for (const Turned& turned : sight.turned) {
            if (!turned.path_m.empty()) longest_m = std::max(longest_m, turned.path_m.back());
        }
        const Real change = abs(last - first) * longest_m;
        const Real least = std::min(first, last);
        return least > 0 ? std::min(change, Real(abs(last - first) * (kVeilNothing / least)))
                         : change;
    }

    // The first so many of the panels from one end.
    template <typename Light>
    void add_panels(const Pixel& pixel,
                    const Sight& sight,
                    std::size_t k,
                    double panels,
                    int counted,
                    bool from_first,
                    const Light& light,
                    std::array<Real, kChannels>& sum) const {
        const Real width_nm = (Real(knots_nm_[k + 1]) - knots_nm_[k]) / panels;
        for (int p = 0; p < counted; ++p) {
            const Real from_end_nm = width_nm * (2 * p + 1) / 2;
            add_panel(pixel,
                      sight,
                      from_first ? Real(knots_nm_[k] + from_end_nm)
                                 : Real(knots_nm_[k + 1] - from_end_nm),
                      width_nm / 2,
                      light,
                      sum);
        }
    }

    template <typename Light>
    void add_panel(const Pixel& pixel,
                   const Sight& sight,
                   const Real& middle_nm,
                   const Real& half_nm,
                   const Light& light,
                   std::array<Real, kChannels>& sum) const {
        using Gauss = boost::math::quadrature::gauss<Real, kPanelPoints>;
        const auto add_node = [&](const Real& lambda_nm, const Real& weight) {
            const auto nm =
                std::clamp(static_cast<double>(lambda_nm), knots_nm_.front(), knots_nm_.back());
            // Behind a port every wavelength has its own ray.
            const Real arriving =
                weight * half_nm *
                light(rig_.camera.port ? sight_at(pixel.column, pixel.row, nm) : sight, lambda_nm);
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
    Real least_loss_per_m_ = 0;
    Real most_loss_per_m_ = 0;
    // By strobe.
    std::vector<TracedBeam> beams_;
    std::vector<std::vector<Real>> on_axis_;  // A_k
};

}  // namespace aphotic
