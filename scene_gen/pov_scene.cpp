// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/pov_scene.h"

#include "scene_gen/omissions.h"
#include "scene_gen/pov_objects.h"
#include "scene_gen/solid.h"
#include "spectral/error.h"
#include "spectral/refraction.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>

namespace aphotic {

using Eigen::Vector3d;

namespace {

// POV-Ray's law 2/(1 + (d/f)^2) is 2 f^2/d^2 (1 - (f/d)^2 + ...): with f under a thousandth of
// the least distance the inverse square holds to 1e-6.
constexpr double kFadeShare = 1e-3;

using Channels = std::array<double, 3>;

// Seventeen significant digits carry a double through text unchanged.
std::string number(double value) {
    return fmt::format("{:.17g}", value);
}

std::string vector(const Channels& v) {
    return fmt::format("<{}, {}, {}>", number(v[0]), number(v[1]), number(v[2]));
}

// In POV-Ray's frame.
std::string point(const Vector3d& sled) {
    const Vector3d pov = to_povray(sled);
    return vector({pov.x(), pov.y(), pov.z()});
}

// What a rig says in words may hold anything; in a comment it must stay on its line.
std::string comment_text(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    return text;
}

// Wavelengths as they stand in file names: with as few decimals as tell all of them apart.
std::vector<std::string> wavelength_labels(std::span<const double> lambda_nm) {
    constexpr int kMostDecimals = 6;
    const std::set<double> distinct(lambda_nm.begin(), lambda_nm.end());
    std::vector<std::string> labels;
    for (int decimals = 0; decimals <= kMostDecimals; ++decimals) {
        labels.clear();
        for (const double l : lambda_nm) labels.push_back(fmt::format("{:.{}f}", l, decimals));
        if (std::set(labels.begin(), labels.end()).size() == distinct.size()) break;
    }
    return labels;
}

// Fade distance: a power of two, so that 1/(2 f^2) scales the light without rounding it.
double fade_distance_m(const Rig& rig) {
    double least_m = std::numeric_limits<double>::infinity();
    for (const Strobe& strobe : rig.strobes) {
        for (const Vector3d& lamp_m : lamp_positions_m(strobe, {.across = 2, .along = 2})) {
            least_m = std::min(least_m, least_throw_m(rig, strobe, lamp_m));
        }
    }
    return std::exp2(std::floor(std::log2(kFadeShare * least_m)));
}

// Half sizes of the glass block and of the air cavity in it, across the camera's axis.
struct Housing {
    double cavity_x_m, cavity_y_m, block_x_m, block_y_m;  // x, y of POV-Ray
    double back_m;                                        // behind the pupil, of the cavity
};

Housing housing(const Camera& camera) {
    // Wider than any ray can be at the faces: in glass, rays run steeper than in air.
    constexpr double kRoom = 1.25;
    const FlatPort& port = *camera.port;
    const double front_m = port.distance_m + port.thickness_m;
    const double half_pixel = 0.5 * camera.pixel_pitch_m / camera.focal_length_m;
    Housing h{};
    h.cavity_x_m = kRoom * port.distance_m * half_pixel * camera.width_px + port.thickness_m;
    h.cavity_y_m = kRoom * port.distance_m * half_pixel * camera.height_px + port.thickness_m;
    h.block_x_m = kRoom * front_m * half_pixel * camera.width_px + 2.0 * port.thickness_m;
    h.block_y_m = kRoom * front_m * half_pixel * camera.height_px + 2.0 * port.thickness_m;
    h.back_m = port.distance_m;
    return h;
}

LampGrid lamps_of(const Rig& rig, const Strobe& strobe, const SceneOptions& options) {
    if (options.soft_edges) return {};
    return options.emitter_lamps.value_or(lamp_grid(rig, strobe));
}

// Half the angle that an emitter spans, seen from the floor below it.
double soft_edge_deg(const Rig& rig, const Strobe& strobe, const SceneOptions& options) {
    if (!options.soft_edges || !strobe.emitter) return 0.0;
    const double size_m = 0.5 * (strobe.emitter->across_m + strobe.emitter->along_m);
    const double distance_m = height_above(floor_plane(rig.sled), strobe.position_m);
    return std::atan(0.5 * size_m / distance_m) * 180.0 / std::numbers::pi;
}

// POV-Ray gives up inside a medium when it meets more lights than this.
constexpr std::size_t kMostLightsInMedia = 1024;
// Elsewhere it is patience and memory that end: a scene of this many is 15 MB of text.
constexpr std::size_t kMostLights = 100'000;

void require_few_enough_lights(const Rig& rig, const SceneOptions& options) {
    std::size_t lights = 0;
    for (const Strobe& strobe : rig.strobes) {
        const LampGrid grid = lamps_of(rig, strobe, options);
        const auto lamps =
            static_cast<std::size_t>(grid.across) * static_cast<std::size_t>(grid.along);
        lights += strobe.beam.cones.size() * (strobe.emitter ? lamps : 1);
    }
    const std::size_t most = rig.water.is_clear() ? kMostLights : kMostLightsInMedia;
    if (lights <= most) return;
    throw InputError(
        fmt::format("strobes: {} lights, one for every cone of every lamp; allowed: {}, "
                    "which is what POV-Ray takes in {}. Fewer lamps stand for an "
                    "emitter with --emitter-lamps",
                    lights,
                    most,
                    rig.water.is_clear() ? "clear water" : "water"));
}

void require_place_for_lamps(const Rig& rig, const Strobe& strobe, LampGrid grid) {
    const Plane floor = floor_plane(rig.sled);
    const std::vector<Vector3d> lamps_m = lamp_positions_m(strobe, grid);
    for (const Vector3d& lamp_m : lamps_m) {
        if (height_above(floor, lamp_m) > 0.0) continue;
        throw InputError(
            fmt::format("strobe '{}' has a lamp at or under the sea floor, {:.4f} m below it",
                        strobe.name,
                        -height_above(floor, lamp_m)));
    }
    if (!rig.camera.port) return;
    const Housing h = housing(rig.camera);
    const double front_m = rig.camera.port->distance_m + rig.camera.port->thickness_m;
    const double behind_m = h.back_m + rig.camera.port->thickness_m;
    for (const Vector3d& lamp_m : lamps_m) {
        const Vector3d at = to_povray(lamp_m);
        const bool is_inside = std::abs(at.x()) <= h.block_x_m && std::abs(at.y()) <= h.block_y_m &&
                               at.z() >= -behind_m && at.z() <= front_m;
        if (!is_inside) continue;
        throw InputError(
            fmt::format("strobe '{}' has a lamp inside the camera's housing, which reaches "
                        "{:.3f} m to the side, {:.3f} m fore and aft, and from {:.3f} m above "
                        "the pupil to {:.3f} m below it",
                        strobe.name,
                        h.block_x_m,
                        h.block_y_m,
                        behind_m,
                        front_m));
    }
}

void require_place_for_objects(const Rig& rig) {
    if (!rig.camera.port) return;
    const Housing h = housing(rig.camera);
    const double front_m = rig.camera.port->distance_m + rig.camera.port->thickness_m;
    const double behind_m = h.back_m + rig.camera.port->thickness_m;
    const Eigen::AlignedBox3d block(Vector3d(-h.block_y_m, -h.block_x_m, -behind_m),
                                    Vector3d(h.block_y_m, h.block_x_m, front_m));
    for (const Object& object : rig.objects) {
        if (!block.intersects(bounds_m(object.shape))) continue;
        throw InputError(
            fmt::format("object '{}' reaches into the camera's housing, which reaches {:.3f} m to "
                        "the side, {:.3f} m fore and aft, and from {:.3f} m above the pupil to "
                        "{:.3f} m below it",
                        object.name,
                        h.block_x_m,
                        h.block_y_m,
                        behind_m,
                        front_m));
    }
}

// By strobe and cone: whether the scene needs it.
using LitCones = std::vector<std::vector<bool>>;

LitCones lit_cones(const Rig& rig, const SceneOptions& options) {
    LitCones lit;
    for (const Strobe& strobe : rig.strobes) {
        lit.emplace_back();
        for (const Cone& cone : strobe.beam.cones) {
            lit.back().push_back(!options.omit || (strobe.power > 0.0 && cone.weight > 0.0 &&
                                                   lights_the_view(rig, strobe, cone)));
        }
    }
    return lit;
}

// One scene's text, written part by part.
class SceneWriter {
  public:
    SceneWriter(const Rig& rig,
                const RadianceBound& bound,
                const SceneOptions& options,
                const LitCones& lit_cones,
                std::string name,
                std::vector<double> lambda_nm,
                double index_nm)
        : rig_(rig),
          options_(options),
          lit_cones_(lit_cones),
          fade_m_(fade_distance_m(rig)),
          lambda_nm_(std::move(lambda_nm)) {
        scene_.name = std::move(name);
        scene_.index_nm = index_nm;
        for (const double l : lambda_nm_) {
            scene_.wavelengths.push_back(
                {.lambda_nm = l,
                 .exposure_log2 =
                     exposure_log2(bound.at(l), brightest_colour(l), options.peak_log2)});
        }
    }

    FrameScene write() {
        write_header();
        write_camera();
        write_port();
        write_water();
        write_floor();
        write_objects();
        write_strobes();
        return std::move(scene_);
    }

  private:
    // A frame of fewer than three wavelengths repeats its last one.
    [[nodiscard]] std::size_t wavelength_of(std::size_t channel) const {
        return std::min(channel, lambda_nm_.size() - 1);
    }

    template <typename Function>
    [[nodiscard]] Channels per_channel(Function function) const {
        Channels values{};
        for (std::size_t c = 0; c < 3; ++c) values[c] = function(lambda_nm_[wavelength_of(c)]);
        return values;
    }

    [[nodiscard]] LampGrid grid_of(const Strobe& strobe) const {
        return lamps_of(rig_, strobe, options_);
    }

    [[nodiscard]] bool shines(const Strobe& strobe) const {
        const Channels flux = per_channel([&](double l) { return strobe.spectrum.at(l); });
        return strobe.power > 0.0 &&
               std::any_of(flux.begin(), flux.end(), [](double f) { return f > 0.0; });
    }

    // The largest component of any light's colour, at exposure 0.
    [[nodiscard]] double brightest_colour(double lambda_nm) const {
        double brightest = 0.0;
        for (const Strobe& strobe : rig_.strobes) {
            for (const Cone& cone : strobe.beam.cones) {
                brightest = std::max(brightest,
                                     strobe.spectrum.at(lambda_nm) * strobe.power *
                                         axial_intensity(cone, strobe.beam.weights));
            }
        }
        return brightest / (2.0 * std::numbers::pi * fade_m_ * fade_m_);
    }

    void line(std::string_view text = "") {
        scene_.sdl += text;
        scene_.sdl += '\n';
    }

    void write_header() {
        constexpr std::array kChannelWord{"red  ", "green", "blue "};
        line("// Persistence of Vision Ray Tracer Scene Description File");
        line(fmt::format("// File: {}.pov", scene_.name));
        line(fmt::format("// Description: {}", comment_text(rig_.title)));
        line("//");
        line(
            "// Written by aphotic. Each channel of the image is one wavelength's radiance, times "
            "the");
        line("// power of two with which the frame is exposed:");
        for (std::size_t c = 0; c < 3; ++c) {
            const FrameWavelength& w = scene_.wavelengths[wavelength_of(c)];
            line(fmt::format(
                "//   {}  {} nm, times 2^{}", kChannelWord[c], w.lambda_nm, w.exposure_log2));
        }
        line("//");
        line(fmt::format("// Render in this folder with: povray render.ini +I{}.pov", scene_.name));
        line("//");
        line(
            "// Metres. x starboard, y forward, z down; the camera's entrance pupil is the "
            "origin.");
        line();
        line("#version 3.7;");
        line(
            "global_settings { assumed_gamma 1.0  adc_bailout 0  ambient_light rgb 0  "
            "max_trace_level 20 }");
        line("#default { finish { ambient 0  emission 0  diffuse 1 } }");
        line("background { rgb 0 }");
        line();
    }

    void write_camera() {
        const Camera& camera = rig_.camera;
        line("// Top row forward, right column starboard.");
        line("camera {");
        line("   perspective  location <0, 0, 0>");
        line(fmt::format("   direction z * {}   // focal length", number(camera.focal_length_m)));
        line(fmt::format("   right x * {}", number(camera.width_px * camera.pixel_pitch_m)));
        line(fmt::format("   up y * {}", number(camera.height_px * camera.pixel_pitch_m)));
        line("}");
        line();
    }

    void write_port() {
        if (!rig_.camera.port) return;
        const FlatPort& port = *rig_.camera.port;
        const double lambda_nm = scene_.index_nm;
        const double n_water =
            seawater_index(lambda_nm, rig_.water.salinity_psu, rig_.water.temperature_c);
        const double n_glass = port.glass.index(lambda_nm);
        const Housing h = housing(rig_.camera);
        line(
            "// Flat port: a block of glass and, strictly inside it, the air that holds the "
            "camera.");
        line(
            "// The water around is index 1 to POV-Ray, so indices are relative to it. Neither "
            "block is");
        line("// hollow, so neither holds water; no_shadow, so the lamps' light takes no notice.");
        line(fmt::format("#declare N_Water = {};", number(n_water)));
        line(fmt::format("#declare N_Glass = {};   // {}", number(n_glass), port.glass.name()));
        const auto block =
            [&](double x, double y, double back, double front, std::string_view ior) {
                line(fmt::format("box {{ <{}, {}, {}>, <{}, {}, {}>",
                                 number(-x),
                                 number(-y),
                                 number(-back),
                                 number(x),
                                 number(y),
                                 number(front)));
                line(
                    fmt::format("   pigment {{ rgbt 1 }}  finish {{ ambient 0  diffuse 0 }}  "
                                "interior {{ ior {} }}  no_shadow }}",
                                ior));
            };
        block(h.block_x_m,
              h.block_y_m,
              h.back_m + port.thickness_m,
              port.distance_m + port.thickness_m,
              "N_Glass / N_Water");
        block(h.cavity_x_m, h.cavity_y_m, h.back_m, port.distance_m, "1 / N_Water");
        line();
    }

    [[nodiscard]] bool has_medium() const { return !options_.omit || !rig_.water.is_clear(); }

    void write_water() {
        if (!has_medium()) return;
        const Channels k = per_channel([&](double l) { return rig_.water.attenuation_per_m(l); });
        line(
            "// Water: one absorbing medium everywhere. A constant medium is evaluated in closed "
            "form,");
        line("// so one sample is exact.");
        line(fmt::format("media {{ method 1  intervals 1  samples 1, 1  absorption rgb {} }}",
                         vector(k)));
        line();
    }

    void write_floor() {
        const Plane floor = floor_plane(rig_.sled);
        const Channels rho = per_channel([&](double l) { return rig_.seafloor.reflectance.at(l); });
        line("// Floor: level in the world, so tilted as the sled sees it.");
        line(fmt::format(
            "plane {{ {}, {}", point(floor.normal), number(floor.normal.dot(floor.point_m))));
        line(fmt::format("   pigment {{ rgb {} }}", vector(rho)));
        if (!options_.omit || rig_.seafloor.phong > 0.0) {
            line(fmt::format("   finish {{ phong {}  phong_size {} }}",
                             number(rig_.seafloor.phong),
                             number(rig_.seafloor.phong_size)));
        }
        line("}");
        line();
    }

    void write_objects() {
        scene_.sdl += pov_objects(rig_, [&](const Spectrum& reflectance) {
            return vector(per_channel([&](double l) { return reflectance.at(l); }));
        });
    }

    void write_strobes() {
        line(
            "// A cone shines Flux * Axial_Intensity * cos(theta) within Half_Angle degrees of its "
            "axis.");
        line(
            "// fade_power 2 with a fade_distance far below all distances is the inverse square "
            "law;");
        line("// the 1/pi turns irradiance into the radiance of a white floor.");
        line(fmt::format("#declare Fade_Distance = {};", number(fade_m_)));
        line("#macro Cone_Lamp (Position, Axis, Half_Angle, Axial_Intensity, Flux)");
        line("   light_source {");
        line(
            "      Position, rgb Flux * Axial_Intensity / (2 * pi * Fade_Distance * "
            "Fade_Distance)");
        line("      spotlight  point_at Position + Axis");
        line(options_.soft_edges
                 ? "      radius max(0, Half_Angle - Soft_Edge)  falloff min(90, Half_Angle + "
                   "Soft_Edge)  tightness 1"
                 : "      radius Half_Angle  falloff Half_Angle  tightness 1");
        line("      fade_distance Fade_Distance  fade_power 2");
        // shadowless would spare clear water its shadow rays, but it makes a point light of a
        // spotlight: POV-Ray knows one type a light.
        if (has_medium()) line("      media_attenuation on");
        line("   }");
        line("#end");
        for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
            write_strobe(rig_.strobes[s], lit_cones_[s]);
        }
    }

    void write_strobe(const Strobe& strobe, const std::vector<bool>& lit) {
        line();
        line(fmt::format("// Strobe: {}", comment_text(strobe.name)));
        if (std::ranges::none_of(lit, std::identity{}) || (options_.omit && !shines(strobe))) {
            line("// lights nothing in view at these wavelengths");
            return;
        }
        const auto lamps_m = lamp_positions_m(strobe, grid_of(strobe));
        const auto share = 1.0 / static_cast<double>(lamps_m.size());
        Channels flux{};
        for (std::size_t c = 0; c < 3; ++c) {
            const FrameWavelength& w = scene_.wavelengths[wavelength_of(c)];
            flux[c] =
                std::ldexp(strobe.spectrum.at(w.lambda_nm) * strobe.power * share, w.exposure_log2);
        }
        line(fmt::format("#declare Flux = {};", vector(flux)));
        line(fmt::format("#declare Axis = {};", point(strobe.axis)));
        if (options_.soft_edges) {
            line(fmt::format("#declare Soft_Edge = {};   // degrees",
                             number(soft_edge_deg(rig_, strobe, options_))));
        }
        for (std::size_t k = 0; k < lit.size(); ++k) {
            if (!lit[k]) continue;
            const Cone& cone = strobe.beam.cones[k];
            const double half_angle_deg = cone.half_angle_rad * 180.0 / std::numbers::pi;
            for (const Vector3d& lamp_m : lamps_m) {
                line(fmt::format("Cone_Lamp ({}, Axis, {}, {}, Flux)   // {}",
                                 point(lamp_m),
                                 number(half_angle_deg),
                                 number(axial_intensity(cone, strobe.beam.weights)),
                                 comment_text(cone.part)));
            }
        }
    }

    const Rig& rig_;
    const SceneOptions& options_;
    const LitCones& lit_cones_;
    double fade_m_;
    std::vector<double> lambda_nm_;
    FrameScene scene_;
};

}  // namespace

std::vector<FrameScene> make_scenes(const Rig& rig,
                                    std::span<const double> lambda_nm,
                                    const SceneOptions& options) {
    require_few_enough_lights(rig, options);
    require_place_for_objects(rig);
    for (const Strobe& strobe : rig.strobes) {
        require_place_for_lamps(rig, strobe, lamps_of(rig, strobe, options));
    }
    const RadianceBound bound(rig);
    const std::vector<std::string> labels = wavelength_labels(lambda_nm);
    const LitCones lit = lit_cones(rig, options);
    std::vector<FrameScene> scenes;
    for (const FrameGroup& group :
         frame_groups(rig, lambda_nm, options.wavelengths_per_frame, options.pixel_shift)) {
        const auto first = labels.begin() + static_cast<std::ptrdiff_t>(group.first);
        const std::string name = fmt::format(
            "band_{}nm", fmt::join(first, first + static_cast<std::ptrdiff_t>(group.count), "_"));
        const auto part = lambda_nm.subspan(group.first, group.count);
        scenes.push_back(
            SceneWriter(rig, bound, options, lit, name, {part.begin(), part.end()}, group.index_nm)
                .write());
    }
    return scenes;
}

std::string render_ini(const Rig& rig) {
    return fmt::format(
        "; POV-Ray's settings for the scenes of this folder: povray render.ini +I<scene>.pov\n"
        "; Every option that changes pixels is set here, none is left to the user's own ini.\n"
        "Width={}\n"
        "Height={}\n"
        "; OpenEXR: half floats, linear, unclipped.\n"
        "Output_To_File=on\n"
        "Output_File_Type=E\n"
        "Output_File_Name=frames/\n"
        "Output_Alpha=off\n"
        "File_Gamma=1.0\n"
        "; One ray through each pixel's centre.\n"
        "Antialias=off\n"
        "; Media need full quality.\n"
        "Quality=9\n"
        "Start_Row=0\n"
        "Start_Column=0\n"
        "Display=off\n"
        "Pause_When_Done=off\n"
        "Continue_Trace=off\n"
        "Verbose=on\n"
        "Render_Console=off\n"
        "Statistic_Console=off\n",
        rig.camera.width_px,
        rig.camera.height_px);
}

}  // namespace aphotic
