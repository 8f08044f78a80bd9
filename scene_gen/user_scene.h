// SPDX-License-Identifier: BSD-3-Clause
//
// A user's POV-Ray scene, and what is measured before it is rendered: its spectra, the paths of its
// light, and its brightness.
//
//   L(lambda) <= Phi(lambda) max over pixels  sum_s G_s exp(-K l_s)
//
// Phi  the strongest of the rig's lamps        K  loss of the water [1/m]
// G_s  radiance of the scene, all white, by strobe s at lamp flux 1 [1/(m^2 sr)]
// l_s  path of that light, lamp to surface to camera [m]
//
// G_s and l_s are measured by rendering the scene small (plugin/probe.h): details smaller than one
// of those pixels are missed.
#pragma once

#include "rig/rig.h"
#include "scene_gen/band_sdl.h"
#include "scene_gen/light_paths.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

struct UserScene {
    // The light of one strobe in one pixel.
    struct Lit {
        double radiance_per_flux = 0.0;
        double path_m = 0.0;
    };

    std::filesystem::path file;  // absolute
    std::string files_digest;    // digest_of_scene, before the probe
    // SHA-256 of that and of the probe's pictures.
    std::string digest;
    std::vector<NamedSpectrum> materials;  // under the names that the scene gives them
    PathRange paths;
    bool writes_files = false;             // that it may read back: one POV-Ray at a time
    std::vector<std::string> no_promise;   // why its image has none; empty: it has one
    std::vector<std::vector<Lit>> pixels;  // by pixel, those strobes that light it

    [[nodiscard]] double brightest_radiance(const Rig& rig, double lambda_nm) const;
};

// The path l of light that one loss attenuates to G exp(-K l), and another, less by D, to G exp(-(K
// - D) l): ln(brighter / dimmer) / D.
[[nodiscard]] double measured_path_m(double dimmer, double brighter, double difference_per_m);

// Margin on both sides of the measured paths, for what lies between the probe's pixels.
inline constexpr double kProbeRoom = 1.05;

// Of what the pixels show, with kProbeRoom; both zero when nothing is lit.
[[nodiscard]] PathRange paths_of(const std::vector<std::vector<UserScene::Lit>>& pixels);

// The spectra by the names that the scene gives them: a CSV file next to the scene, one of the
// rig's own spectra, or a built-in one. Throws InputError for an unknown name, or a table that does
// not cover the rig's range.
[[nodiscard]] std::vector<NamedSpectrum> scene_materials(std::span<const std::string> names,
                                                         const Rig& rig,
                                                         const std::filesystem::path& scene_file);

// SHA-256 of the scene and of every existing file that it, or a file so found, names in quotes, in
// the scene's folder: its includes, pictures and meshes. Names composed by the scene are not seen.
[[nodiscard]] std::string digest_of_scene(const std::filesystem::path& scene_file);

// Whether it, or an existing file that it names, opens a file to write: #fopen ... write.
[[nodiscard]] bool opens_to_write(const std::filesystem::path& scene_file);

// A scene edited during the probe or the render would be half one scene, half another: throws
// RunError if the files no longer match files_digest.
void require_unchanged(const std::filesystem::path& scene_file, const std::string& files_digest);

// The rig with the scene's materials instead of its floor, plus white, for anything with a colour
// or a highlight of POV-Ray's own.
[[nodiscard]] Rig rig_of_scene(Rig rig, const UserScene& scene);

}  // namespace aphotic
