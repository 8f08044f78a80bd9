// SPDX-License-Identifier: BSD-3-Clause
//
// The reference: our own tracer, which shares the rig and the spectra with the POV-Ray path, but no
// code for geometry or light.
//
// For every pixel and every wavelength of its grid: the camera's ray, through the port if there is
// one (each wavelength refracted by its own indices), to the floor or to the object before it
// (shapes.h); from there to every strobe and every lamp of its emitter that no object hides:
//
//   L(lambda) = sum  Phi power I(-l) / (N d^2)
//                    (rho cos(i) + phong max(0, m.l)^size) / pi  exp(-K (d + r))
//   S_c       = sum_j w_cj L(lambda_j)
//
// plus, in water that scatters, the veil before it, or before the horizon (traced_veil.h).
//
// I      the beam's intensity (traced_beam.h)              d  lamp to surface [m]
// i      angle of incidence at the surface                 r  surface to port or pupil [m]
// m      the camera's ray mirrored at the surface          l  from the surface to the lamp
// N      lamps of the emitter
//
// Double precision, except for heights above the floor and the angle to the horizon, which are
// small differences at the extremes and computed in long double. The spectral grid is exact to
// kSpectralError of a channel's signal (full_spectrum.h). An emitter with a size is represented by
// as many equal lamps as keep the error of the smooth part of its light within kEmitterError, at
// every plane's wavelength and in every signal (for a beam whose falloff is not cos^n, by an
// estimate: TracedBeam::steepness()); a beam's edge is a staircase with as many steps. Every term
// of a sum has the same sign, so a sum of n terms is accurate to n 1.1e-16.
#pragma once

#include "rig/rig.h"
#include "spectral/bands.h"
#include "spectral/light_family.h"
#include "validation/full_spectrum.h"
#include "validation/shapes.h"
#include "validation/traced_beam.h"
#include "validation/traced_lens.h"
#include "validation/traced_port.h"
#include "validation/traced_water.h"
#include "validation/veil_spectrum.h"

#include <Eigen/Core>

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace aphotic {

inline constexpr double kSpectralError = 1e-8;
inline constexpr double kEmitterError = 2e-5;

inline constexpr double kEdgeRad = 1e-9;
inline constexpr double kEdgeBehindPortRad = 1e-7;
// For a calibrated lens, whose rays POV-Ray interpolates to 2e-6 (kRayErrorRad of
// scene_gen/camera_rays.h) in a mesh in single precision, 2e-7 more. It is an angle of view; at a
// lamp closer to the floor it is larger in proportion.
inline constexpr double kEdgeThroughLensRad = 2.2e-6;
// For an object's outline, its faces and its shadows: edges are where the image, shifted by this
// much, shows another face or is lit by other lamps. POV-Ray stores meshes in single precision, 0.1
// um at 2 m.
inline constexpr double kEdgePx = 2e-3;
// POV-Ray ignores blockers this close to the lit point or to the lamp (SHADOW_TOLERANCE, 1e-3 of
// its units, ours are metres; plus some rounding). Behind such a blocker it may also miss a farther
// part of the same mesh.
inline constexpr double kNoShadowWithin_m = 1.01e-3;
// For a mesh's face at grazing light: below this cosine, POV-Ray's single-precision normals matter.
inline constexpr double kGrazing = 1e-3;
// An edge is where the rounding of a port's index or of a lens's rays changes the light on an
// object by more than this, half of the part of validation.h's bound that half floats leave.
inline constexpr double kRoundingChange = 5e-5;
// On an object behind a port, dispersion may change the light by at most this much (its logarithm),
// as a plan assumes (kObjectTilt of scene_gen/light_paths.h).
inline constexpr double kSteepest = 0.05;

// Equal lamps that represent an emitter, in even rows.
struct EmitterLamps {
    int across = 1;
    int along = 1;
};

struct TraceOptions {
    bool signals = true;            // R, G, B over the full spectrum
    std::vector<double> planes_nm;  // and the radiance at these wavelengths
    int threads = 1;                // does not affect the result
    // Lamps across and along every emitter with a size; 0: as kEmitterError requires.
    int lamps_across = 0;
    int lamps_along = 0;
    // By strobe, the lamps of another renderer, to trace exactly its image: edges are then those of
    // each lamp, without penumbrae. Empty: as above.
    std::vector<EmitterLamps> rendered_lamps{};
};

using WideVector = Eigen::Matrix<long double, 3, 1>;

class Tracer {
  public:
    Tracer(const Rig& rig, const TraceOptions& options);

    // The planes of these rows, one after another: R, G, B if requested, then one per wavelength.
    // Memory is these planes and one spectrum per thread, whatever the grid.
    // progress: called by the caller's thread with the share of the pixels; may be empty.
    [[nodiscard]] std::vector<double> rows(int first_row,
                                           int count,
                                           const std::function<void(double)>& progress = {}) const;

    // The same for these pixels only, numbered row by row: the planes one after another.
    [[nodiscard]] std::vector<double> pixels(
        std::span<const std::size_t> which, const std::function<void(double)>& progress = {}) const;

    // The lamps of the strobe's emitter.
    [[nodiscard]] EmitterLamps lamps(std::size_t strobe) const { return grids_[strobe]; }

    [[nodiscard]] std::size_t planes() const;

    // 1 for every pixel, row by row, whose value depends on rounding, or has a step, somewhere in
    // the range:
    //   beams    its centre is within kEdgeRad of a beam's edge (kEdgeBehindPortRad behind a port,
    //            whose index POV-Ray keeps in single precision, kEdgeThroughLensRad with a lens),
    //            an emitter of a size has lamps on both sides of it, or dispersion takes it across;
    //            a smooth beam has none, unless light changes by kRoundingChange through the error
    //            of a lens's rays
    //   objects  within kEdgePx or that error, or by dispersion, the image shows another face or is
    //            lit by other lamps; an emitter is hidden in part; a blocker is nearer than
    //            kNoShadowWithin_m; a lamp grazes a mesh; light changes by kSteepest through
    //            dispersion, or by kRoundingChange through the rounding of a port's index or a
    //            lens's rays
    // within_px: includes pixels within about this distance of an edge, for images that blur it.
    [[nodiscard]] std::vector<unsigned char> on_edges(WavelengthRange range,
                                                      double within_px = 0.0) const;
    // The same for these pixels only.
    [[nodiscard]] std::vector<unsigned char> on_edges_of(std::span<const std::size_t> which,
                                                         WavelengthRange range,
                                                         double within_px = 0.0) const;

    // The ray of an image point at a wavelength, up to what it sees; empty if it sees nothing.
    [[nodiscard]] std::optional<VeilRay> ray(double column, double row, double lambda_nm) const;

    // The surface that an image point sees at a wavelength; empty if it sees none.
    struct Seen {
        Eigen::Vector3d point_m;
        Eigen::Vector3d normal;   // unit, towards the camera
        std::size_t surface = 0;  // the floor, then the objects in the rig's order
    };
    [[nodiscard]] std::optional<Seen> seen(double column, double row, double lambda_nm) const;

    // For the full spectrum; 0 without signals.
    [[nodiscard]] std::size_t grid_size() const { return signal_nodes_; }

    [[nodiscard]] const Rig& rig() const { return rig_; }

  private:
    // One point lamp of one strobe.
    struct Lamp {
        std::size_t strobe;
        Eigen::Vector3d position_m;
    };
    // A point from which a strobe's beam has its edges, and the extent of its lamps about it.
    struct Apex {
        std::size_t strobe;
        Eigen::Vector3d position_m;
        double reach_m;
    };
    // All surfaces in view: the floor, then the objects in the rig's order.
    struct Surface {
        Spectrum reflectance;
        double phong;
        double phong_size;
    };
    // A lamp's effect on a point as the camera sees it, without wavelength.
    struct Contribution {
        double diffuse = 0.0;   // sum of I cos(i) / (N d^2)  [1/m^2]
        double specular = 0.0;  // sum of I (m.l)^size phong / (N d^2)
        double path_m = 0.0;    // d + r
    };
    struct View {
        VeilRay ray;
        Eigen::Vector3d point_m;
        Eigen::Vector3d normal;    // towards the camera
        Eigen::Vector3d mirrored;  // the ray's direction
        double distance_m = 0.0;   // in water
        std::size_t surface = 0;
        int face = 0;
        bool is_clear = false;  // set beforehand: no object is near, so none is searched for
    };
    struct Index {
        double glass;
        double water;
    };
    static constexpr Stretch kWholeWay{0.0, std::numeric_limits<double>::infinity()};

    [[nodiscard]] Index index_at(double lambda_nm) const;
    void place_lamps();
    void place_edges();
    [[nodiscard]] EmitterLamps lamps_of(std::size_t strobe) const;
    [[nodiscard]] double spacing_m(std::size_t strobe, double d_m, bool is_floor) const;
    void tabulate_spectra();
    [[nodiscard]] std::vector<WeightedWavelength> spectrum_in_view() const;
    // nearest_m: from where any ray enters the water to the nearest lamp.
    [[nodiscard]] VeilLights veil_in_view(const LightFamily& family,
                                          double nearest_m,
                                          bool is_all_floor) const;
    // The height over the floor.
    [[nodiscard]] double height_m(const Eigen::Vector3d& point_m) const;
    // The direction of an image point in air, with z = 1; empty where the lens has no image.
    [[nodiscard]] std::optional<WideVector> sight(double column, double row) const;
    [[nodiscard]] bool look_along(const WideVector& sight, const Index& index, View& view) const;
    [[nodiscard]] bool look(double column, double row, const Index& index, View& view) const;
    // The largest angle between neighbouring pixels [rad].
    [[nodiscard]] double widest_pixel_rad() const;
    [[nodiscard]] Contribution light(const Lamp& lamp, const View& view) const;
    void trace_pixel(int column, int row, Eigen::ArrayXd& radiance) const;
    void trace_sight(int column, int row, const WideVector& in_air, Eigen::ArrayXd& radiance) const;
    // The numbers of all pixels of these rows.
    [[nodiscard]] std::vector<std::size_t> pixels_of(int first_row, int count) const;
    // Writes a sample to every plane, `stride` apart.
    void write_planes(const Eigen::ArrayXd& radiance, double* sample, std::size_t stride) const;
    [[nodiscard]] bool is_on_edge(std::size_t pixel,
                                  WavelengthRange range,
                                  const std::array<Index, 3>& indices,  // at its start, middle, end
                                  double within_px) const;

    [[nodiscard]] bool is_blocked(const Lamp& lamp,
                                  const View& view,
                                  Stretch stretch = kWholeWay) const;
    [[nodiscard]] bool turns_steeply(double column,
                                     double row,
                                     const View& view,
                                     double lambda_nm) const;
    [[nodiscard]] bool is_on_steep_light(double column, double row, WavelengthRange range) const;
    [[nodiscard]] double edge_px() const;
    [[nodiscard]] bool shines_on(const Lamp& lamp, const View& view) const;
    [[nodiscard]] bool is_on_beam_edge(double column,
                                       double row,
                                       const std::array<Index, 3>& indices,
                                       double within_px) const;
    [[nodiscard]] bool is_on_object_edge(double column,
                                         double row,
                                         WavelengthRange range,
                                         double within_px) const;
    [[nodiscard]] WavelengthRange traced_range() const;
    [[nodiscard]] bool is_clear_of_objects(double column,
                                           double row,
                                           WavelengthRange range,
                                           double within_px) const;
    [[nodiscard]] bool is_near_an_object(const View& view, double reach_m) const;
    [[nodiscard]] bool is_uncertain(const View& view) const;
    [[nodiscard]] bool shows_the_same(const View& a, const View& b) const;
    [[nodiscard]] double change_between(const View& from, const View& to, double lambda_nm) const;

    Rig rig_;
    TracedWater water_;
    TraceOptions options_;
    std::optional<TracedLens> lens_;
    double pixel_rad_;
    double sight_error_rad_;  // of POV-Ray's rays, from its single precision
    WideVector exact_down_;
    Eigen::Vector3d down_;
    std::vector<TracedBeam> beams_;  // by strobe
    std::vector<Surface> surfaces_;
    std::vector<TracedShape> shapes_;  // of the objects
    std::vector<Lamp> lamps_;
    std::vector<Lamp> rim_lamps_;  // an emitter's corners, or its points
    std::vector<Apex> apexes_;
    std::vector<EmitterLamps> grids_;  // by strobe
    std::vector<double> lamps_of_strobe_;

    // By wavelength: the grid's first, then the planes'.
    std::size_t signal_nodes_ = 0;
    std::vector<double> lambda_nm_;
    Eigen::ArrayXd attenuation_per_m_;
    std::vector<std::vector<Eigen::ArrayXd>> diffuse_;  // by strobe, surface: Phi power rho / pi
    std::vector<Eigen::ArrayXd> specular_;              // by strobe: Phi power / pi
    Eigen::ArrayXXd weights_;                           // of the grid, by channel
    std::vector<Index> indices_;                        // behind a port
    std::optional<VeilSpectrum> veil_;                  // of water that scatters
};

}  // namespace aphotic
