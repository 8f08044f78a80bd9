// SPDX-License-Identifier: BSD-3-Clause
//
// The reference: a tracer of our own that shares with the POV-Ray way the rig and the spectra,
// and no line of geometry or light.
//
// For every pixel and every wavelength of its grid: the camera's ray, through the port where
// there is one (each wavelength bent by its own indices), to the floor; from there every strobe,
// every lamp of its emitter, every cone:
//
//   L(lambda) = sum  Phi power A_k cos(theta) / (N d^2)
//                    (rho cos(i) + phong max(0, m.l)^size) / pi  exp(-K (d + r))
//   S_c       = sum_j w_cj L(lambda_j)
//
// theta  angle off the strobe's axis, within the cone      d  lamp to floor [m]
// i      angle of incidence at the floor                   r  floor to port or pupil [m]
// m      the camera's ray mirrored at the floor            l  from the floor to the lamp
// N      lamps of the emitter                              A_k  pi sin^2(gamma) A_k = alpha_k
//
// Double precision throughout. The spectral grid is exact to kSpectralError of a channel's
// signal (spectral/light_family.h). An emitter of a size is as many equal lamps as hold the
// smooth part of its light to kEmitterError; a cone's edge is a staircase with as many steps.
// Every term of a sum has the same sign, so a sum of n terms is right to n 1.1e-16.
#pragma once

#include "scene_gen/rig.h"
#include "spectral/bands.h"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace aphotic {

inline constexpr double kSpectralError = 1e-8;
inline constexpr double kEmitterError = 2e-5;

inline constexpr double kEdgeRad = 1e-9;
inline constexpr double kEdgeBehindPortRad = 1e-7;

struct TraceOptions {
    bool signals = true;            // R, G, B over the full spectrum
    std::vector<double> planes_nm;  // and the radiance at these wavelengths
    int threads = 1;                // changes no bit
    // Lamps across and along every emitter that has a size; 0: as kEmitterError asks.
    int lamps_across = 0;
    int lamps_along = 0;
};

class Tracer {
  public:
    Tracer(const Rig& rig, const TraceOptions& options);

    // The planes of these rows, one after another: R, G, B if asked for, then one a wavelength.
    // Memory is these planes and one spectrum a thread, whatever the grid.
    [[nodiscard]] std::vector<double> rows(int first_row, int count) const;

    [[nodiscard]] std::size_t planes() const;

    // 1 for every pixel, row by row, that lies on the edge of a cone at some wavelength of the
    // range: its centre is within kEdgeRad of the edge (kEdgeBehindPortRad behind a port, whose
    // index POV-Ray keeps in single precision), an emitter of a size has lamps on both sides of
    // it, or dispersion takes it across. within_px: also pixels about so many from an edge, for
    // images that blur it.
    [[nodiscard]] std::vector<unsigned char> on_cone_edges(WavelengthRange range,
                                                           double within_px = 0.0) const;

    // Of the full spectrum; 0 without signals.
    [[nodiscard]] std::size_t grid_size() const { return signal_nodes_; }

    [[nodiscard]] const Rig& rig() const { return rig_; }

  private:
    // One point lamp of one strobe.
    struct Lamp {
        std::size_t strobe;
        Eigen::Vector3d position_m;
    };
    // What a lamp does to a floor point as the camera sees it, without wavelength.
    struct Contribution {
        double diffuse = 0.0;   // sum of A cos(theta) cos(i) / (N d^2)    [1/m^2]
        double specular = 0.0;  // sum of A cos(theta) (m.l)^size phong / (N d^2)
        double path_m = 0.0;    // d + r
    };
    struct View {
        Eigen::Vector3d point_m;
        Eigen::Vector3d mirrored;
        double distance_m = 0.0;  // in water
    };
    struct Index {
        double glass;
        double water;
    };

    [[nodiscard]] Index index_at(double lambda_nm) const;
    void place_lamps();
    void tabulate_spectra();
    [[nodiscard]] std::vector<WeightedWavelength> full_spectrum() const;
    [[nodiscard]] bool look(double column, double row, const Index& index, View& view) const;
    [[nodiscard]] Contribution light(const Lamp& lamp, const View& view) const;
    void trace_pixel(int column, int row, Eigen::ArrayXd& radiance) const;

    Rig rig_;
    TraceOptions options_;
    Eigen::Vector3d down_;
    std::vector<Lamp> lamps_;
    std::vector<double> lamps_of_strobe_;
    std::vector<std::vector<double>> axial_intensity_;  // by strobe and cone
    std::vector<std::vector<double>> cos_edge_;

    // By wavelength: the grid's first, then the planes'.
    std::size_t signal_nodes_ = 0;
    std::vector<double> lambda_nm_;
    Eigen::ArrayXd attenuation_per_m_;
    std::vector<Eigen::ArrayXd> diffuse_;   // by strobe: Phi power rho / pi
    std::vector<Eigen::ArrayXd> specular_;  // by strobe: Phi power / pi
    Eigen::ArrayXXd weights_;               // of the grid, by channel
    std::vector<Index> indices_;            // behind a port
};

}  // namespace aphotic
