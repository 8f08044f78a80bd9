// SPDX-License-Identifier: BSD-3-Clause
//
// The veil: light that the water scatters into the view, on its way from a lamp to the floor or
// elsewhere. Single scattering, along the ray of a pixel:
//
//   A(lambda) = Phi(lambda) sum_i b_i(lambda) int p_i(psi) I(w) exp(-K (t + d)) / d^2 dt
//
// t         along the ray, from where it enters the water to its end                 [m]
// d, w      from the lamp to that point of the ray: distance [m] and direction
// psi       the scattering angle there, kVeilCut or more: light scattered by less appears beside
//           its lamp, and is omitted
// b_i, p_i  of each scatterer; K: loss (spectral/water.h)
// I         the beam's intensity (rig/beam/beam.h)                                   [1/sr]
//
// With h the lamp's distance from the ray, t_0 its foot point on it, and phi the angle at the lamp
// from there,
//
//   t = t_0 + h tan(phi),   d = h / cos(phi),   dt/d^2 = dphi/h,   psi = phi + 90 degrees
//
// so that the integrand is smooth, however close the lamp is to the ray, and the lamp's direction
// is linear in cos(phi) and sin(phi): the points where a beam's edge or kink crosses the ray have a
// closed form (rig/beam/beam_crease.h). Between these, the kinks of a tabulated phase function and
// the cut, Gauss-Legendre quadrature uses panels no wider than kVeilPanelRad, nor than their
// distance from +-90 degrees, where the integrand has its singularities: at -90 degrees those of
// forward scattering (Henyey and Greenstein's poles are at -90 degrees +- i ln(1/g)), and at +90
// degrees the essential one of exp(-K l). So the integrand is analytic within the Bernstein ellipse
// of rho = 3 + sqrt(8) about each panel, and the error of n points is at most
//
//   64/15 M rho^-2n / (1 - rho^-2)       M: its largest value there, for a panel of length 2
//
// (Trefethen): 3e-12 M with 8 points. Narrower panels use as many points as keep rho^-2n. The
// effect of M and of the few creases without a closed form is measured: veil_error(). The nodes do
// not depend on wavelength: they serve every wavelength, and the signal as well, by a table over
// the path length.
//
// An emitter with a size is 3 x 3 lamps by Gauss-Legendre quadrature, more with more points.
// Shadows of objects in the veil are omitted.
#pragma once

#include "base/gauss_rule.h"
#include "rig/beam/beam_crease.h"
#include "rig/beam/table_pieces.h"
#include "rig/geometry.h"
#include "rig/rig.h"

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace aphotic {

inline constexpr double kVeilPanelRad = 0.35;
inline constexpr unsigned kVeilPoints = 8;  // of a panel
// Enough for images and maps: the error is 2e-6, unless light is lost within a panel, as in milky
// water. With this many or fewer, a round table is approximated by cubics with an error of at most
// kVeilBeamOff of its brightest (rig/beam/table_pieces.h), so that panels need not end at each of
// its rows.
inline constexpr unsigned kVeilMapPoints = 3;
inline constexpr double kVeilBeamOff = 1e-4;
// Light attenuated below e^-kVeilDepth is omitted.
inline constexpr double kVeilDepth = 40.0;

// The contribution of a part of a strobe of power 1: A = Phi sum_n sum_i b_i weight[i][n] exp(-K
// path_m[n]).
struct VeilNodes {
    std::vector<double> path_m;                 // t + d
    std::vector<std::vector<double>> weight{};  // by scatterer  [1/(m sr)]
    std::vector<double> cuts_rad{};             // workspace of Veil

    void clear();
};

class Veil {
  public:
    // points: per panel; values other than kVeilPoints are for measuring or stating the error.
    explicit Veil(const Rig& rig, unsigned points = kVeilPoints);

    // Over the whole length of the ray, which may be infinite; replaces the nodes. Thread-safe.
    // Each cone of a beam is a part, and so is any other beam: where one part has an edge, the
    // others are smooth.
    void nodes(std::size_t part, const WaterRay& ray, double length_m, VeilNodes& nodes) const;
    [[nodiscard]] const std::vector<std::size_t>& strobe_of_part() const { return strobes_; }

    // A of all strobes at one wavelength, powers included.
    [[nodiscard]] double radiance(const WaterRay& ray, double length_m, double lambda_nm) const;

  private:
    struct Lamp {
        Eigen::Vector3d position_m;
        double share;
    };
    struct Light {
        Beam beam;
        BeamFrame frame;
        std::vector<Crease> creases;
        std::optional<ConeLight> cone;   // of a beam without pattern and window
        std::vector<TablePiece> pieces;  // of a round table without a window, of a flux of 1
        std::vector<Lamp> lamps;
        double widest_panel_rad;
        bool ends_in_a_power;  // at 90 degrees: a cosine's fractional one, or a window's
        bool is_of_optics;     // all its creases have the power 3/2
        std::optional<Eigen::Vector3d> pole;  // of a table's angles
    };
    // p at even steps from kVeilCut to pi, if its formula is slow.
    struct Phase {
        const PhaseFunction* function;
        std::vector<double> samples;
        [[nodiscard]] double at(double psi_rad) const;
    };
    struct View;  // of one lamp from one ray
    struct Point {
        double cosine;  // of phi
        double sine;
        double weight;  // of the rule, times the panel's width
    };
    // From one kink to the next: the same panel for every ray and lamp. Without points if it would
    // be too wide.
    struct KinkPanel {
        double room_rad = 0.0;
        std::vector<Point> points{};
        std::vector<double> phases{};  // by point and scatterer
    };
    class Shine;

    [[nodiscard]] Light light_of(const Strobe& strobe,
                                 const Beam& beam,
                                 unsigned emitter_side) const;
    void add_lamp(const Light& light,
                  const Lamp& lamp,
                  const WaterRay& ray,
                  double length_m,
                  VeilNodes& nodes) const;
    void add_piece(const Light& light,
                   const Lamp& lamp,
                   const View& view,
                   double from,
                   double to,
                   VeilNodes& nodes) const;
    void add_panels(const Shine& shine, double from, double to, VeilNodes& nodes) const;
    void add_known(const Shine& shine, const KinkPanel& panel, VeilNodes& nodes) const;
    void add_kink_panels();
    [[nodiscard]] const std::vector<GaussNode>& rule_for(double width, double room) const;

    std::shared_ptr<const Rig> rig_;
    unsigned points_;
    std::vector<Light> parts_;
    std::vector<std::size_t> strobes_;           // by part
    std::vector<Phase> phases_;                  // by scatterer
    std::vector<double> kinks_rad_;              // of all phase functions, as phi, ascending
    std::vector<KinkPanel> panels_;              // by the kink where they begin
    double longest_m_ = 0.0;                     // path beyond which no light remains
    std::vector<std::vector<GaussNode>> rules_;  // by number of points
};

// The difference between kVeilPoints and twice as many, relative to the veil, or to kDimVeilShare
// of the brightest if it is less: the largest on a coarse grid of the image, at the ends and in the
// middle of the camera's range. Measured, not a bound. 0 in water that does not scatter.
inline constexpr double kDimVeilShare = 1e-6;
[[nodiscard]] double veil_error(const Rig& rig, unsigned points = kVeilPoints);

// kVeilMapPoints if these are accurate to the error, as measured by veil_error(); else kVeilPoints.
[[nodiscard]] unsigned veil_points(const Rig& rig, double error);

// The camera's ray in water for a pixel's centre, and its distance to the bare floor; infinite if
// it does not reach it.
struct VeilSight {
    WaterRay ray;
    double length_m = 0.0;
};
[[nodiscard]] VeilSight sight_of(const Rig& rig, double column, double row, double lambda_nm);

}  // namespace aphotic
