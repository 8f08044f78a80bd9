// SPDX-License-Identifier: BSD-3-Clause
//
// A lightmap as an OpenEXR file: R, G, B, in water that scatters veil.R, veil.G, veil.B, and on
// request the same for the rig's parts, in channels such as fore.R (planes.h). Its attributes name
// the rig, pose and error.
#pragma once

#include "lightmap/planes.h"
#include "spectral/manifest.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

struct LightmapRequest {
    std::filesystem::path file;
    std::vector<RigPart> parts;
    bool is_normalised = false;  // each channel is divided by its largest value, parts by the
                                 // largest value of the whole
    LightmapOptions map;
    std::string version;  // of the program that made it
    std::optional<ManifestModel> model{};
};

struct WrittenLightmap {
    Lightmap map;
    std::vector<std::string> channels;
    std::array<float, kChannels> peaks{};  // before division
    PathRange paths;
    std::size_t grid_size = 0;
    int table_steps = 0;
    double tables_s = 0.0;
    double map_s = 0.0;
};

// Names of maps by altitude in one folder, such as altitude_2.10m.exr: two decimals, or as many as
// distinguish the altitudes.
[[nodiscard]] std::vector<std::string> map_names(const std::vector<double>& altitude_m);
// Maps with such names, from an earlier run.
void remove_maps(const std::filesystem::path& folder);

// An InputError where LightmapMaker throws one.
[[nodiscard]] WrittenLightmap write_lightmap(const Rig& rig, const LightmapRequest& request);

}  // namespace aphotic
