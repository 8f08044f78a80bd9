// SPDX-License-Identifier: BSD-3-Clause
//
// A user's POV-Ray scene, and its properties measured before it is rendered: its spectra, the paths
// of its light, and its brightness.
//
//   L(lambda) <= Phi(lambda) max over pixels  sum_s G_s exp(-K l_s)
//
// Phi  the strongest of the rig's lamps        K  loss of the water [1/m]
// G_s  radiance of the scene, all white, by strobe s at lamp flux 1 [1/(m^2 sr)]
// l_s  path of that light, lamp to surface to camera [m]
//
// G_s and l_s are measured by rendering the scene at a small size (plugin/probe.h): details smaller
// than one of those pixels are missed.
#pragma once

#include "rig/rig.h"
#include "scene_gen/band_sdl.h"
#include "scene_gen/light_paths.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

// A user's scene on the disk: its file, and those that it names.
struct SceneFile {
    std::filesystem::path path{};  // absolute; empty: the rig's floor
    std::string digest{};          // digest_of_scene
    bool writes_files = false;     // and may read them: one POV-Ray at a time
};

struct UserScene {
    // The light of one strobe in one pixel.
    struct Lit {
        double radiance_per_flux = 0.0;
        double path_m = 0.0;
    };

    SceneFile file;  // as probed
    // SHA-256 of the files' digest and of the probe's pictures.
    std::string digest;
    std::vector<NamedSpectrum> materials;  // with the scene's names for them
    PathRange paths;
    std::vector<std::string> no_promise;   // reasons against a promise; empty: it has one
    std::vector<std::vector<Lit>> pixels;  // by pixel, the strobes that light it

    [[nodiscard]] double brightest_radiance(const Rig& rig, double lambda_nm) const;
};

// The path l of light that is attenuated by one loss to G exp(-K l), and by another, less by D, to
// G exp(-(K - D) l): ln(brighter / dimmer) / D.
[[nodiscard]] double measured_path_m(double dimmer, double brighter, double difference_per_m);

// Margin on both sides of the measured paths, for light between the probe's pixels.
inline constexpr double kProbeRoom = 1.05;

// The paths in the pixels, with kProbeRoom; both zero if nothing is lit.
[[nodiscard]] PathRange paths_of(const std::vector<std::vector<UserScene::Lit>>& pixels);

// The spectra that the scene names: a CSV file next to the scene, one of the rig's own spectra, or
// a built-in one. Throws InputError for an unknown name, or a table that does not cover the rig's
// range.
[[nodiscard]] std::vector<NamedSpectrum> scene_materials(std::span<const std::string> names,
                                                         const Rig& rig,
                                                         const std::filesystem::path& scene_file);

// SHA-256 of the scene and of every existing file in the scene's folder that it, or a file found
// this way, names in quotes: its includes, pictures and meshes. Names composed by the scene are not
// found.
[[nodiscard]] std::string digest_of_scene(const std::filesystem::path& scene_file);

// Whether it, or an existing file that it names, opens a file to write: #fopen ... write.
[[nodiscard]] bool opens_to_write(const std::filesystem::path& scene_file);

// As it is now.
[[nodiscard]] SceneFile scene_file_at(const std::filesystem::path& path);

// A scene edited during the probe or the render would give a mixture of two scenes: throws RunError
// if the files no longer match the digest.
void require_unchanged(const SceneFile& scene);

// The rig with the scene's materials instead of its floor, plus white, for anything with a colour
// or a highlight of POV-Ray's own.
[[nodiscard]] Rig rig_of_scene(Rig rig, const UserScene& scene);

}  // namespace aphotic
