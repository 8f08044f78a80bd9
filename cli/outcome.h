// SPDX-License-Identifier: BSD-3-Clause
//
// The results of commands. Each is a struct with to_json(), for programs, and print(), for people.
#pragma once

#include "base/json_text.h"
#include "cli/terminal.h"
#include "image/preview.h"
#include "spectral/manifest.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace aphotic::cli {

template <typename Result>
void show(const Result& result, bool as_json) {
    if (as_json) {
        say_text(json_text(to_json(result)));
    } else {
        print(result);
    }
}

// The images in a folder, and their signals.
struct MadeImages {
    struct Signal {
        float least = 0.0F;
        double mean = 0.0;
        float most = 0.0F;
    };
    std::filesystem::path folder;
    int width_px = 0;
    int height_px = 0;
    std::array<Signal, kChannels> signals{};
    bool has_spectral = true;
};

[[nodiscard]] MadeImages made_images(const std::filesystem::path& folder, const CameraImage& image);
[[nodiscard]] nlohmann::ordered_json to_json(const MadeImages& made);
void print(const MadeImages& made);

struct Integration {
    Manifest manifest;
    MadeImages images;
    double seconds = 0.0;
};

// Integrates the frames of `folder` into `images`, the same folder or another; another receives the
// signals only. Writes image.exr, spectral.exr and preview.png.
[[nodiscard]] Integration integrate_folder(const std::filesystem::path& folder,
                                           const Manifest& manifest,
                                           const PreviewOptions& preview,
                                           const std::filesystem::path& images);
[[nodiscard]] nlohmann::ordered_json to_json(const Integration& integration);
void print(const Integration& integration);

// The error bound of a plan or manifest, per channel: error, amplification and promise. Null if a
// user's scene voids it; no_promise in the JSON then gives the reason.
void put_promises(nlohmann::ordered_json& json, const Manifest& manifest);

// The reason for a missing error bound, for people.
void print_no_promise(const std::vector<std::string>& reasons);

// A line about the veil, if POV-Ray renders it.
[[nodiscard]] std::string povray_veil_in_words(const Manifest& manifest);

}  // namespace aphotic::cli
