// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/user_scene.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/nearest.h"
#include "base/sha256.h"
#include "spectral/curve_loader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace aphotic {

namespace fs = std::filesystem;

double UserScene::brightest_radiance(const Rig& rig, double lambda_nm) const {
    double flux = 0.0;
    for (const Strobe& strobe : rig.strobes) flux = std::max(flux, strobe.spectrum.at(lambda_nm));
    const double attenuation_per_m = rig.water.attenuation_per_m(lambda_nm);
    double brightest = 0.0;
    for (const std::vector<Lit>& pixel : pixels) {
        double radiance = 0.0;
        for (const Lit& lit : pixel) {
            radiance += lit.radiance_per_flux * std::exp(-attenuation_per_m * lit.path_m);
        }
        brightest = std::max(brightest, radiance);
    }
    return flux * brightest;
}

double measured_path_m(double dimmer, double brighter, double difference_per_m) {
    return std::log(brighter / dimmer) / difference_per_m;
}

PathRange paths_of(const std::vector<std::vector<UserScene::Lit>>& pixels) {
    PathRange range{.shortest_m = std::numeric_limits<double>::infinity(), .longest_m = 0.0};
    for (const auto& pixel : pixels) {
        for (const UserScene::Lit& lit : pixel) {
            range.shortest_m = std::min(range.shortest_m, lit.path_m / kProbeRoom);
            range.longest_m = std::max(range.longest_m, lit.path_m * kProbeRoom);
        }
    }
    return range.longest_m > 0.0 ? range : PathRange{};
}

namespace {

std::optional<Spectrum> of_the_rig(const std::string& name, const Rig& rig) {
    for (const Spectrum& material : materials_of(rig)) {
        if (material.short_name() == name) return material;
    }
    return std::nullopt;
}

void require_known(const std::string& name, const Rig& rig) {
    std::vector<std::string> known = builtin_names(role_name(CurveRole::Reflectance));
    if (std::ranges::find(known, name) != known.end()) return;
    known.push_back(rig.seafloor.reflectance.short_name());
    for (const Spectrum& material : rig.materials) known.push_back(material.short_name());
    std::ranges::sort(known);
    known.erase(std::unique(known.begin(), known.end()), known.end());
    const std::string nearest = nearest_name(name, known);
    throw InputError("is not a known reflectance{}; allowed: {}, or a .csv file beside the scene",
                     nearest.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", nearest),
                     fmt::join(known, ", "));
}

}  // namespace

std::vector<NamedSpectrum> scene_materials(std::span<const std::string> names,
                                           const Rig& rig,
                                           const fs::path& scene_file) {
    std::vector<NamedSpectrum> materials;
    for (const std::string& name : names) {
        try {
            const bool is_beside_it =
                names_a_file(name) && fs::exists(scene_file.parent_path() / name);
            std::optional<Spectrum> spectrum;
            if (!is_beside_it) spectrum = of_the_rig(name, rig);
            if (!spectrum && !names_a_file(name)) require_known(name, rig);
            if (!spectrum) {
                spectrum = load_curve(name, CurveRole::Reflectance, scene_file.parent_path());
            }
            const Spectrum* curve = &*spectrum;
            require_cover({&curve, 1}, rig.camera.range);
            materials.push_back({.name = name, .spectrum = std::move(*spectrum)});
        } catch (const InputError& error) {
            throw InputError(
                "{}: Aphotic_Pigment (\"{}\"): {}", scene_file.string(), name, error.what());
        }
    }
    return materials;
}

namespace {

// The quoted strings within one line. Not by regular expression: on a long line, as in a mesh, the
// library's overflows the stack.
std::vector<std::string> quoted_in(const std::string& text) {
    std::vector<std::string> all;
    std::size_t open = text.find('"');
    while (open != std::string::npos) {
        const std::size_t close = text.find_first_of("\"\n", open + 1);
        if (close == std::string::npos) break;
        const bool is_quoted = text[close] == '"' && close > open + 1;
        if (is_quoted) all.push_back(text.substr(open + 1, close - open - 1));
        open = text.find('"', is_quoted ? close + 1 : close);
    }
    return all;
}

bool is_language(const fs::path& file) {
    constexpr std::array kLanguage{".pov", ".inc", ".mac", ".mcr"};
    return std::ranges::find(kLanguage, file.extension().string()) != kLanguage.end();
}

// The scene, and the existing files that it, or a file found this way, names.
std::set<fs::path> files_of(const fs::path& scene_file) {
    std::set<fs::path> seen;
    std::vector<fs::path> open{fs::absolute(scene_file).lexically_normal()};
    const fs::path folder = open.front().parent_path();
    while (!open.empty()) {
        const fs::path file = open.back();
        open.pop_back();
        if (!seen.insert(file).second || !is_language(file)) continue;
        for (const std::string& name : quoted_in(read_text_file(file))) {
            const fs::path named = (folder / name).lexically_normal();
            std::error_code ignored;
            if (fs::is_regular_file(named, ignored)) open.push_back(named);
        }
    }
    return seen;
}

}  // namespace

std::string digest_of_scene(const fs::path& scene_file) {
    const fs::path folder = fs::absolute(scene_file).lexically_normal().parent_path();
    std::map<std::string, std::string> digests;  // in an order independent of the listing
    for (const fs::path& file : files_of(scene_file)) {
        digests[file.lexically_relative(folder).generic_string()] = sha256_of_file(file);
    }
    std::string all;
    for (const auto& [name, digest] : digests) all += name + ' ' + digest + '\n';
    return sha256_of_text(all);
}

bool opens_to_write(const fs::path& scene_file) {
    const auto opens = [](const fs::path& file) {
        if (!is_language(file)) return false;
        const std::string text = read_text_file(file);
        const auto has = [&](const char* word) { return text.find(word) != std::string::npos; };
        return has("fopen") && (has("write") || has("append"));
    };
    return std::ranges::any_of(files_of(scene_file), opens);
}

SceneFile scene_file_at(const fs::path& path) {
    return {.path = fs::absolute(path).lexically_normal(),
            .digest = digest_of_scene(path),
            .writes_files = opens_to_write(path)};
}

void require_unchanged(const SceneFile& scene) {
    if (digest_of_scene(scene.path) == scene.digest) return;
    throw RunError(
        "{}: this scene, or a file that it names, changed during the run; run the same command "
        "again with the current scene{}",
        scene.path.string(),
        scene.writes_files ? ". Files that it writes itself must be the same each time" : "");
}

Rig rig_of_scene(Rig rig, const UserScene& scene) {
    const WavelengthRange range = rig.camera.range;
    rig.seafloor = {.reflectance = {"white", {range.first_nm, range.last_nm}, {1.0, 1.0}}};
    rig.materials.clear();
    rig.objects.clear();
    for (const NamedSpectrum& material : scene.materials) {
        rig.materials.push_back(material.spectrum);
    }
    return rig;
}

}  // namespace aphotic
