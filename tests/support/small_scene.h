// SPDX-License-Identifier: BSD-3-Clause
//
// The project's scenes with few pixels over the same field of view.
#pragma once

#include "support/scene_text.h"
#include "support/temp_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

namespace aphotic {

inline std::vector<std::filesystem::path> rigs_under(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> rigs;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == ".toml") rigs.push_back(entry.path());
    }
    std::sort(rigs.begin(), rigs.end());
    return rigs;
}

// Those that POV-Ray scenes of the users' own come with.
inline std::vector<std::filesystem::path> user_scenes() {
    return rigs_under(scene_file("user"));
}

// All others: what they show is in the rig.
inline std::vector<std::filesystem::path> all_scenes() {
    std::vector<std::filesystem::path> scenes = rigs_under(scene_file(""));
    const std::vector<std::filesystem::path> apart = user_scenes();
    std::erase_if(scenes, [&](const auto& scene) {
        return std::binary_search(apart.begin(), apart.end(), scene);
    });
    return scenes;
}

// A rig's text, so many times coarser each way.
inline std::string small_scene(const std::filesystem::path& file, int coarser = 40) {
    std::string text = scene_text(file);
    std::smatch found;
    const std::regex resolution(R"(\nresolution\s*=\s*\[(\d+), (\d+)\])");
    const std::regex pitch(R"(\npixel_pitch_um\s*=\s*([0-9.]+))");
    if (!std::regex_search(text, found, resolution))  // it is the calibration's
        return replaced(text, "[camera]\n", fmt::format("[camera]\nscale = {}\n", 1.0 / coarser));
    const int width = std::stoi(found[1]) / coarser;
    const int height = std::stoi(found[2]) / coarser;
    const std::string size = fmt::format("\nresolution = [{}, {}]", width, height);
    text = std::regex_replace(text, resolution, size);
    if (!std::regex_search(text, found, pitch))
        throw std::runtime_error("no pixel pitch in " + file.string());
    return std::regex_replace(
        text, pitch, fmt::format("\npixel_pitch_um = {}", std::stod(found[1]) * coarser));
}

// Puts a scene so made into the folder as rig.toml, with the tables and meshes that lie beside it.
inline void put_small_scene(const std::filesystem::path& file,
                            const std::filesystem::path& folder) {
    write_file(folder / "rig.toml", small_scene(file));
    for (const auto& entry : std::filesystem::directory_iterator(scene_file(file).parent_path())) {
        if (entry.path().extension() == ".toml" || entry.is_directory()) continue;
        std::filesystem::copy_file(entry.path(), folder / entry.path().filename());
    }
}

}  // namespace aphotic
