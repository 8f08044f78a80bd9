// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/pov_scene.h"

#include "base/error.h"
#include "rig/camera/lens.h"
#include "rig/solid.h"
#include "scene_gen/band_sdl.h"
#include "scene_gen/beam_sdl.h"
#include "scene_gen/camera_rays.h"
#include "scene_gen/light_culling.h"
#include "scene_gen/rig_sdl.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <set>

namespace aphotic {

using Eigen::Vector3d;

namespace {

// POV-Ray's law 2/(1 + (d/f)^2) is 2 f^2/d^2 (1 - (f/d)^2 + ...): with f under a thousandth of
// the least distance the inverse square holds to 1e-6.
constexpr double kFadeShare = 1e-3;
// A user's scene may contain anything, down to a millimetre.
constexpr double kUserFade_m = 0x1p-20;

// The least number of units between the surfaces of a port: twice what aphotic.inc needs, so that a
// millimetre of glass stays in metres.
constexpr double kPortClearance = 0x1p-10;

double power_of_two_within(double most) {
    return std::exp2(std::floor(std::log2(most)));
}

// Wavelengths as in file names: with as few decimals as distinguish them all.
std::vector<std::string> wavelength_labels(std::span<const PlannedWavelength> wavelengths) {
    constexpr int kMostDecimals = 6;
    std::set<double> distinct;
    for (const PlannedWavelength& w : wavelengths) distinct.insert(w.lambda_nm);
    std::vector<std::string> labels;
    for (int decimals = 0; decimals <= kMostDecimals; ++decimals) {
        labels.clear();
        for (const PlannedWavelength& w : wavelengths) {
            labels.push_back(fmt::format("{:.{}f}", w.lambda_nm, decimals));
        }
        if (std::set(labels.begin(), labels.end()).size() == distinct.size()) break;
    }
    return labels;
}

// The least distance from any lamp to a surface that it may light.
double least_throw_m(const Rig& rig) {
    double least_m = std::numeric_limits<double>::infinity();
    for (const Strobe& strobe : rig.strobes) {
        for (const Vector3d& lamp_m : lamp_positions_m(strobe, {.across = 2, .along = 2})) {
            least_m = std::min(least_m, least_throw_m(rig, strobe, lamp_m));
        }
    }
    return least_m;
}

// Fade distance: a power of two, so that 1/(2 f^2) scales the light without rounding it.
double fade_distance_m(const Rig& rig, const SceneOptions& options) {
    if (options.user_scene) return kUserFade_m;
    return power_of_two_within(kFadeShare * least_throw_m(rig));
}

// Half a pixel, at a distance of 1, of POV-Ray's pinhole for the camera.
double half_pixel_slope(const Camera& camera) {
    const Pinhole pinhole = pinhole_about(camera);
    return 0.5 * pinhole.sensor_width_m / camera.width_px / pinhole.focal_length_m;
}

// The largest angle of a ray from the normal of a flat port.
double widest_off_normal_rad(const Camera& camera) {
    const double half_view =
        half_pixel_slope(camera) * std::hypot(camera.width_px, camera.height_px);
    return std::atan(half_view) + std::acos(std::min(1.0, camera.port->normal.z()));
}

// The least distance between the surfaces around the pupil that POV-Ray has to resolve.
double least_clearance_m(const PortWindow& port) {
    const double room_m =
        port.dome ? port.dome->radius_m - port.dome->centre_m.norm() : port.distance_m;
    return std::min(room_m, port.thickness_m);
}

// The housing of glass, camera and pupil, in the sled's frame, as in aphotic.inc. It is wider than
// any ray can be at its faces: rays in glass are steeper than in air.
Eigen::AlignedBox3d housing(const Camera& camera) {
    constexpr double kRoom = 1.25;
    const PortWindow& port = *camera.port;
    if (port.dome) {
        const Vector3d reach_m = Vector3d::Constant(port.dome->radius_m + port.thickness_m);
        return {port.dome->centre_m - reach_m, port.dome->centre_m + reach_m};
    }
    const double front_m = port.distance_m + port.thickness_m;
    if (!is_across_axis(port)) {
        const double aside_m =
            kRoom * std::tan(widest_off_normal_rad(camera)) * front_m + 2.0 * port.thickness_m;
        const Vector3d reach_m = Vector3d::Constant(std::hypot(aside_m, aside_m, front_m));
        return {-reach_m, reach_m};
    }
    const double half_pixel = half_pixel_slope(camera);
    const double half_pixel_m = kRoom * front_m * half_pixel;
    const Vector3d half_m(half_pixel_m * camera.height_px + 2.0 * port.thickness_m,
                          half_pixel_m * camera.width_px + 2.0 * port.thickness_m,
                          front_m);
    return {-half_m, half_m};
}

[[noreturn]] void refuse_in_housing(const std::string& what, const Eigen::AlignedBox3d& block) {
    throw InputError(
        "{} the camera's housing, which reaches {:.3f} m to the side, {:.3f} m fore "
        "and aft, and from {:.3f} m above the pupil to {:.3f} m below it",
        what,
        block.max().y(),
        block.max().x(),
        -block.min().z(),
        block.max().z());
}

// Without a medium, time and memory are the limit: a scene of this many is 15 MB of text.
constexpr std::size_t kMostLights = 100'000;

void require_few_enough_lights(const Rig& rig, std::span<const LampGrid> lamps) {
    std::size_t lights = 0;
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        lights += light_count(rig.strobes[s].beam) * static_cast<std::size_t>(lamps[s].across) *
                  static_cast<std::size_t>(lamps[s].along);
    }
    const std::size_t most = rig.water.is_clear() ? kMostLights : std::size_t{kMostLightsInMedia};
    if (lights <= most) return;
    throw InputError(
        "strobes: found {} lights, one for every cone of every lamp; allowed: {}, POV-Ray's limit "
        "in {}. --emitter-lamps models an emitter with fewer lamps",
        lights,
        most,
        rig.water.is_clear() ? "clear water" : "water");
}

struct PlacedLamp {
    const Strobe* strobe;
    Vector3d at_m;
};

// The least distance from a lamp with a shell to any other.
double least_way_to_shell_m(const Rig& rig, std::span<const LampGrid> grids) {
    // Closer lamps can count as one, and scenes cannot distinguish them.
    constexpr double kOnePlace_m = 1e-6;
    std::vector<PlacedLamp> lamps;
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        for (const Vector3d& at_m : lamp_positions_m(rig.strobes[s], grids[s])) {
            lamps.push_back({&rig.strobes[s], at_m});
        }
    }
    double least_m = std::numeric_limits<double>::infinity();
    for (const PlacedLamp& a : lamps) {
        if (!needs_shell(a.strobe->beam)) continue;
        for (const PlacedLamp& b : lamps) {
            if (&a == &b) continue;
            const double apart_m = (a.at_m - b.at_m).norm();
            least_m = std::min(least_m, apart_m);
            if (apart_m > kOnePlace_m) continue;
            throw InputError(
                "strobes '{}' and '{}' have lamps in one place, and the beam '{}' is not a sum of "
                "cones in water; allowed: lamps at least a micrometre apart",
                a.strobe->name,
                b.strobe->name,
                a.strobe->beam.name);
        }
    }
    return least_m;
}

// A shell, a thousandth of a unit in size, blocks other lamps' light behind it: at most a millionth
// of their directions, and on a floor a spot smaller than any pixel resolves.
double unit_with_shells_m(const Rig& rig, std::span<const LampGrid> lamps) {
    constexpr double kMost_m = 0x1p-7;
    const double unit_m = scene_unit_m(rig);
    if (std::ranges::none_of(rig.strobes, needs_shell, &Strobe::beam)) return unit_m;
    const double least_m = std::min(kMost_m, least_way_to_shell_m(rig, lamps));
    return std::min(unit_m, power_of_two_within(least_m));
}

void require_port(const Camera& camera) {
    constexpr double kWidest_deg = 85.0;  // in aphotic.inc
    constexpr double kLeastClearance_m = 1e-5;
    if (!camera.port) return;
    const double clearance_m = least_clearance_m(*camera.port);
    if (clearance_m < kLeastClearance_m) {
        throw InputError(fmt::format(
            "camera.port: found {:.3g} mm of {}; allowed for a render: {} mm or more, since "
            "POV-Ray ignores surfaces that are closer",
            clearance_m * 1e3,
            clearance_m < camera.port->thickness_m ? "air between the pupil and the glass"
                                                   : "glass",
            kLeastClearance_m * 1e3));
    }
    if (camera.port->dome || is_across_axis(*camera.port)) return;
    const double widest_deg = widest_off_normal_rad(camera) * 180.0 / std::numbers::pi;
    if (widest_deg > kWidest_deg) {
        throw InputError(
            fmt::format("camera.port.normal: found a view that reaches {:.1f} degrees from it; "
                        "allowed for a render: up to {}, since the port must be wider than any ray",
                        widest_deg,
                        kWidest_deg));
    }
}

void require_place(const Rig& rig, std::span<const LampGrid> lamps) {
    std::optional<Eigen::AlignedBox3d> block;
    if (rig.camera.port) block = housing(rig.camera);
    for (const Object& object : rig.objects) {
        if (block && block->intersects(bounds_m(object.shape)))
            refuse_in_housing(fmt::format("object '{}' reaches into", object.name), *block);
    }
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        const Strobe& strobe = rig.strobes[s];
        require_over_floor(rig.sled, strobe, lamps[s]);
        for (const Vector3d& lamp_m : lamp_positions_m(strobe, lamps[s])) {
            if (block && block->contains(lamp_m))
                refuse_in_housing(fmt::format("strobe '{}' has a lamp inside", strobe.name),
                                  *block);
        }
    }
}

// The contents of a frame.
enum class Shown { Surfaces, Water };

// By strobe of the rig. A user's scene may contain anything, and water is everywhere, so for these
// all strobes with light are included.
std::vector<StrobeInScene> strobes_in_scene(const Rig& rig,
                                            std::span<const LampGrid> lamps,
                                            const SceneOptions& options,
                                            Shown shown) {
    const bool may_light_anything = options.user_scene || shown == Shown::Water;
    std::vector<StrobeInScene> strobes;
    for (const Strobe& strobe : rig.strobes) {
        const auto is_wanted = [&](const Beam& part) {
            const bool shines = strobe.power > 0.0 && !is_dark(part) &&
                                (may_light_anything || lights_the_view(rig, strobe, part));
            return shines || !options.omit;
        };
        StrobeInScene in_scene{.beam = parts_that(strobe.beam, is_wanted),
                               .lamps = lamps[strobes.size()]};
        // All cones behind a window are one light.
        if (needs_shell(in_scene.beam)) in_scene.beam = strobe.beam;
        strobes.push_back(std::move(in_scene));
    }
    return strobes;
}

std::vector<NamedSpectrum> named_lamps_of(const Rig& rig) {
    std::vector<Spectrum> spectra;
    for (const Strobe& strobe : rig.strobes) spectra.push_back(strobe.spectrum);
    return named(spectra);
}

// The floor's first; those of a user's scene have the scene's names.
std::vector<NamedSpectrum> reflectances_of(const Rig& rig, const SceneOptions& options) {
    std::vector<Spectrum> own{rig.seafloor.reflectance};
    for (const Object& object : rig.objects) own.push_back(object.reflectance);
    std::vector<NamedSpectrum> names = named(own);
    if (!options.user_scene) return names;
    for (const NamedSpectrum& material : options.user_scene->materials) {
        if (std::ranges::find(names, material.name, &NamedSpectrum::name) == names.end()) {
            names.push_back(material);
        }
    }
    return names;
}

// The largest component of any light's colour, at exposure 0.
double brightest_colour(const Rig& rig, double lambda_nm, double fade_m) {
    double brightest = 0.0;
    for (const Strobe& strobe : rig.strobes) {
        for (const Beam& part : parts_of(strobe.beam)) {
            brightest = std::max(
                brightest, strobe.spectrum.at(lambda_nm) * strobe.power * most_intensity(part));
        }
    }
    return brightest / (2.0 * std::numbers::pi * fade_m * fade_m);
}

// The parts common to all frames of a rig.
struct Parts {
    std::vector<NamedSpectrum> lamps;
    std::vector<NamedSpectrum> reflectances;
    std::string rig{};
    double fade_m;
    double unit_m;  // of the scene; a user's scene declares its own
    bool has_rays;  // of the camera, in a separate file
};

// Relative to the veil's brightest: room for peaks missed by the coarse grid of its bound, and for
// strobes of a user's scene that are elsewhere.
constexpr int kVeilTargetLog2 = 8;
constexpr auto kFogFrame = "distance";

// The wavelengths of one frame.
using Frame = std::span<const PlannedWavelength>;

// A frame of fewer than three wavelengths repeats its last one.
const PlannedWavelength& in_channel(Frame frame, std::size_t channel) {
    return frame[std::min(channel, frame.size() - 1)];
}

Band band_of(const Rig& rig, const Parts& parts, Frame frame) {
    Band band{.lamps = parts.lamps, .reflectances = parts.reflectances};
    for (std::size_t c = 0; c < band.lambda_nm.size(); ++c) {
        const PlannedWavelength& w = in_channel(frame, c);
        band.lambda_nm[c] = w.lambda_nm;
        band.exposure[c] = std::ldexp(1.0, w.exposure_log2);
        band.attenuation_per_m[c] = w.light.attenuation_per_m;
    }
    if (!rig.camera.port) return band;
    const double index_nm = frame.front().index_nm;
    band.water_index = rig.water.refractive_index(index_nm);
    const Glass& glass = rig.camera.port->glass;
    band.glasses = {{.name = glass.name(), .index = glass.index(index_nm)}};
    return band;
}

std::string header_of(const Rig& rig,
                      const std::string& name,
                      Frame frame,
                      const SceneOptions& options,
                      double unit_m) {
    std::string header = fmt::format(
        "// Persistence of Vision Ray Tracer Scene Description File\n"
        "// File: {}.pov\n"
        "// Description: {}\n"
        "//\n"
        "// Written by aphotic. Each channel of the image is one wavelength's radiance, times the\n"
        "// power of two with which the frame is exposed:\n",
        name,
        sdl_comment(rig.title));
    constexpr std::array kChannelWord{"red  ", "green", "blue "};
    for (std::size_t c = 0; c < kChannelWord.size(); ++c) {
        const PlannedWavelength& w = in_channel(frame, c);
        header += fmt::format(
            "//   {}  {} nm, times 2^{}\n", kChannelWord[c], w.lambda_nm, w.exposure_log2);
    }
    if (options.user_scene) {
        return header + fmt::format("//\n// Render in the folder of {}, see render.ini.\n",
                                    sdl_comment(options.user_scene->file.path.filename().string()));
    }
    return header +
           fmt::format(
               "//\n// Render in this folder with: povray render.ini +I{}.pov\n"
               "//\n// {}. x starboard, y forward, z down; the camera's entrance pupil is the "
               "origin.\n",
               name,
               unit_m == 1.0 ? "Metres" : fmt::format("Units of {} m", sdl_number(unit_m)));
}

// own_scene: the user's, by name; empty: the rig's floor.
std::string body_sdl(const Band& band,
                     const Parts& parts,
                     const SceneOptions& options,
                     const std::string& own_scene) {
    std::string sdl = band_sdl(band);
    if (parts.unit_m != 1.0) {
        sdl += fmt::format("#declare Aphotic_Unit = {};\n", sdl_number(parts.unit_m));
    }
    sdl += fmt::format("#declare Aphotic_Fade_Distance = {};\n", sdl_number(parts.fade_m));
    if (options.user_scene) {
        sdl += fmt::format("#declare Aphotic_Bailout = {};\n", sdl_number(options.bailout));
    }
    if (!options.omit) sdl += "#declare Aphotic_Everything = true;\n";
    if (parts.has_rays) sdl += fmt::format("#include \"{}\"\n", kCameraRaysFile);
    sdl += "#include \"aphotic.inc\"\n\n" + parts.rig + "\n";
    sdl += own_scene.empty() ? "Aphotic_Rig ()\nAphotic_Rig_Seafloor ()\nAphotic_Rig_Objects ()\n"
                             : fmt::format("#include {}\n", sdl_text(own_scene));
    return sdl + "Aphotic_End ()\n";
}

std::string scene_sdl(const Rig& rig,
                      const Parts& parts,
                      const std::string& name,
                      Frame frame,
                      const SceneOptions& options,
                      const std::optional<BandScattering>& scattering = {}) {
    const std::string own =
        options.user_scene ? options.user_scene->file.path.filename().string() : std::string();
    Band band = band_of(rig, parts, frame);
    band.scattering = scattering;
    return header_of(rig, name, frame, options, parts.unit_m) + "\n#version 3.7;\n" +
           options.declarations + body_sdl(band, parts, options, own);
}

// The wavelengths of a frame as rendered for the veil.
std::vector<PlannedWavelength> in_veil(Frame frame) {
    std::vector<PlannedWavelength> wavelengths(frame.begin(), frame.end());
    for (PlannedWavelength& w : wavelengths) {
        w.exposure_log2 = w.veil->exposure_log2;
    }
    return wavelengths;
}

// The scattering of one lobe; empty: without scattering.
BandScattering scattering_of(const PovrayVeil& veil, std::optional<std::size_t> lobe, Frame frame) {
    BandScattering scattering{.eccentricity = 0.0,
                              .samples = veil.sampling.samples,
                              .sight_m = veil.sampling.sight_m,
                              .cuts_edges = veil.sampling.cuts_edges};
    if (!lobe) return scattering;
    for (std::size_t c = 0; c < scattering.per_m.size(); ++c)
        scattering.per_m[c] = std::abs(in_channel(frame, c).veil->scattering_per_m[*lobe]);
    const auto* hg = std::get_if<HenyeyGreenstein>(&veil.sampling.lobes[*lobe].kind);
    scattering.eccentricity = hg != nullptr ? std::optional(hg->g) : std::nullopt;
    return scattering;
}

Parts parts_of(const Rig& rig,
               std::span<const LampGrid> lamps,
               const SceneOptions& options,
               Shown shown = Shown::Surfaces) {
    Parts parts{.lamps = named_lamps_of(rig),
                .reflectances = reflectances_of(rig, options),
                .fade_m = fade_distance_m(rig, options),
                .unit_m = options.user_scene ? 1.0 : unit_with_shells_m(rig, lamps),
                .has_rays = rig.camera.lens.has_value()};
    parts.rig = rig_sdl(rig,
                        strobes_in_scene(rig, lamps, options, shown),
                        parts.lamps,
                        parts.reflectances,
                        options.user_scene ? SceneAuthor::User : SceneAuthor::Ours);
    return parts;
}

}  // namespace

double scene_unit_m(const Rig& rig) {
    double least_m =
        std::min(least_throw_m(rig), height_above(floor_plane(rig.sled), Vector3d::Zero()));
    for (const Object& object : rig.objects) {
        least_m = std::min(least_m, bounds_m(object.shape).sizes().maxCoeff());
    }
    const double unit_m = least_m < kLeastInMetres_m ? power_of_two_within(least_m) : 1.0;
    if (!rig.camera.port) return unit_m;
    return std::min(unit_m,
                    power_of_two_within(least_clearance_m(*rig.camera.port) / kPortClearance));
}

double fog_m(const Rig& rig, const SceneOptions& options) {
    constexpr double kExrPaths = 64.0;
    constexpr double kPngPaths = 4.0;
    if (!rig.water.scatters() || options.povray_veil) return 0.0;
    if (rig.objects.empty() && !options.user_scene) return 0.0;
    const PathRange paths = options.user_scene ? options.user_scene->paths : path_range(rig);
    return (options.format == FrameFormat::Exr ? kExrPaths : kPngPaths) *
           (paths.shortest_m > 0.0 ? paths.shortest_m : 1.0);
}

std::vector<LampGrid> scene_lamps(const Rig& rig,
                                  std::span<const PlannedWavelength> wavelengths,
                                  const SceneOptions& options) {
    double K_per_m = 0.0;
    for (const PlannedWavelength& w : wavelengths) {
        K_per_m = std::max(K_per_m, w.light.attenuation_per_m);
    }
    std::vector<LampGrid> lamps;
    for (const Strobe& strobe : rig.strobes) {
        lamps.push_back(!strobe.emitter         ? LampGrid{}
                        : options.emitter_lamps ? *options.emitter_lamps
                                                : lamp_grid(rig, strobe, K_per_m));
    }
    return lamps;
}

std::vector<FrameScene> make_scenes(const Rig& rig,
                                    std::span<const LampGrid> lamps,
                                    const SceneOptions& options,
                                    std::span<PlannedWavelength> wavelengths) {
    require_few_enough_lights(rig, lamps);
    require_port(rig.camera);
    require_place(rig, lamps);
    const Parts parts = parts_of(rig, lamps, options);
    const std::vector<std::string> labels = wavelength_labels(wavelengths);
    // Below a half, whatever the bound's margin, since a PNG's range ends at 1.
    constexpr int kPngPeakLog2 = -1;
    const int peak_log2 = options.format == FrameFormat::Exr ? options.peak_log2 : kPngPeakLog2;
    std::vector<FrameScene> scenes;
    std::optional<RadianceBound> bound;
    if (!options.user_scene) bound.emplace(rig);
    for (PlannedWavelength& w : wavelengths) {
        w.radiance_bound = bound ? bound->at(w.lambda_nm)
                                 : options.user_scene->brightest_radiance(rig, w.lambda_nm);
        w.exposure_log2 = exposure_log2(
            w.radiance_bound, brightest_colour(rig, w.lambda_nm, parts.fade_m), peak_log2);
        if (w.veil) {
            w.veil->exposure_log2 = exposure_log2(w.veil->radiance_bound,
                                                  brightest_colour(rig, w.lambda_nm, parts.fade_m),
                                                  kVeilTargetLog2);
        }
    }
    std::vector<std::string> names;
    std::vector<Frame> frames;
    for (std::size_t first = 0, count = 0; first < wavelengths.size(); first += count) {
        const auto is_of_it = [&](const PlannedWavelength& w) {
            return w.frame == wavelengths[first].frame;
        };
        const auto rest = wavelengths.subspan(first);
        count = static_cast<std::size_t>(std::ranges::find_if_not(rest, is_of_it) - rest.begin());
        frames.push_back(wavelengths.subspan(first, count));
        names.push_back(
            fmt::format("{}nm", fmt::join(std::span(labels).subspan(first, count), "_")));
        const std::string name = "band_" + names.back();
        scenes.push_back(
            {.name = name, .sdl = scene_sdl(rig, parts, name, frames.back(), options)});
    }
    if (options.povray_veil) {
        const PovrayVeil& veil = *options.povray_veil;
        const Parts of_water = parts_of(rig, lamps, options, Shown::Water);
        const auto add_frames = [&](const std::string& what, std::optional<std::size_t> lobe) {
            for (std::size_t f = 0; f < frames.size(); ++f) {
                const std::string name = fmt::format("veil_{}_{}", what, names[f]);
                scenes.push_back({.name = name,
                                  .sdl = scene_sdl(rig,
                                                   of_water,
                                                   name,
                                                   in_veil(frames[f]),
                                                   options,
                                                   scattering_of(veil, lobe, frames[f]))});
            }
        };
        for (std::size_t m = 0; m < veil.sampling.lobes.size(); ++m)
            add_frames(fmt::format("{}", m + 1), m);
        if (options.user_scene) add_frames("surfaces", std::nullopt);
    }
    // Without light, a fog shows the distance that each pixel sees.
    if (const double fog = fog_m(rig, options); fog > 0.0) {
        SceneOptions in_fog = options;
        in_fog.declarations += fmt::format("#declare Aphotic_Fog = {};\n", sdl_number(fog));
        scenes.push_back({.name = kFogFrame,
                          .sdl = scene_sdl(rig, parts, kFogFrame, wavelengths.first(1), in_fog)});
    }
    return scenes;
}

namespace {

// For a user's scene before planning, with everything white.
std::string unplanned_sdl(const Rig& rig,
                          const std::string& scene_name,
                          bool has_rays,
                          const std::function<void(Band&)>& set_light) {
    SceneOptions options;
    options.user_scene = std::make_shared<UserScene>();
    // Sufficient for paths accurate to a hundredth.
    options.bailout = kRayShare * 1e-1;
    const double middle_nm = 0.5 * (rig.camera.range.first_nm + rig.camera.range.last_nm);
    Parts parts = parts_of(rig, std::vector<LampGrid>(rig.strobes.size()), options);
    parts.has_rays = has_rays;
    const PlannedWavelength middle{.lambda_nm = middle_nm, .index_nm = middle_nm};
    Band band = band_of(rig, parts, {&middle, 1});
    set_light(band);
    return body_sdl(band, parts, options, scene_name);
}

}  // namespace

std::string probe_sdl(const Rig& rig, const std::string& scene_name, const ProbeFrame& frame) {
    std::string sdl = "#version 3.7;\n#declare Aphotic_Probe = true;\n";
    if (!frame.dims_lamps) sdl += "#declare Aphotic_No_Lamp_Leg = true;\n";
    if (frame.is_coarse_in_radiosity) sdl += "#declare Aphotic_Coarse_Radiosity = true;\n";
    if (frame.only_strobe != 0) {
        sdl += fmt::format("#declare Aphotic_Only_Strobe = {};\n", frame.only_strobe);
    }
    // A pinhole with the same view is sufficient.
    return sdl + unplanned_sdl(rig, scene_name, false, [&](Band& band) {
               for (std::size_t c = 0; c < band.exposure.size(); ++c) {
                   band.exposure[c] = std::ldexp(frame.strobes[c], frame.exposure_log2);
               }
               band.attenuation_per_m = frame.attenuation_per_m;
           });
}

std::string distance_sdl(const Rig& rig,
                         const std::string& scene_name,
                         const std::string& declarations,
                         double fog_m) {
    return fmt::format(
               "#version 3.7;\n{}#declare Aphotic_Probe = true;\n#declare Aphotic_Fog = {};\n",
               declarations,
               sdl_number(fog_m)) +
           unplanned_sdl(rig, scene_name, rig.camera.lens.has_value(), [](Band&) {});
}

namespace {

// The number of rays is constant, since POV-Ray's threshold compares the three wavelengths
// together, and none may depend on another.
std::string antialias_ini(int rays) {
    if (rays == 0) return "; One ray through each pixel's centre.\nAntialias=off\n";
    return fmt::format(
        "; {} x {} rays per pixel besides the one through its centre.\n"
        "Antialias=on\n"
        "Sampling_Method=1\n"
        "Antialias_Threshold=0.0\n"
        "Antialias_Depth={}\n"
        "Jitter=off\n",
        rays,
        rays,
        rays);
}

}  // namespace

std::string render_ini(const Rig& rig, const SceneOptions& options) {
    const bool is_exr = options.format == FrameFormat::Exr;
    return fmt::format(
        "; POV-Ray's settings for the scenes of this folder: povray render.ini +I<scene>.pov\n"
        "; Every option that changes pixels is set here, none is left to the user's own ini.\n"
        "Width={}\n"
        "Height={}\n"
        "; {}\n"
        "Output_To_File=on\n"
        "Output_File_Type={}\n"
        "Output_Alpha=off\n"
        "File_Gamma=1.0\n"
        "{}"
        "; Media need full quality.\n"
        "Quality=9\n"
        "Start_Row=0\n"
        "Start_Column=0\n"
        "Display=off\n"
        "Pause_When_Done=off\n"
        "Continue_Trace=off\n"
        "Verbose=on\n"
        "Render_Console=off\n"
        "Statistic_Console=off\n"
        "{}",
        rig.camera.width_px,
        rig.camera.height_px,
        is_exr ? "OpenEXR: half floats, linear, unclipped." : "PNG: 16 bits, linear, clipped at 1.",
        is_exr ? "E" : "N\nBits_Per_Color=16",
        antialias_ini(options.antialias),
        fmt::join(options.ini_lines, ""));
}

}  // namespace aphotic
