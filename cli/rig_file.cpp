// SPDX-License-Identifier: BSD-3-Clause
#include "cli/rig_file.h"

#include "base/error.h"
#include "cli/option_words.h"
#include "cli/terminal.h"
#include "rig/file/rig_cameras.h"
#include "rig/file/rig_reader.h"
#include "rig/plausibility.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <vector>

namespace aphotic::cli {
namespace {

std::vector<std::string> set_keys;

constexpr std::string_view kCamera = "camera=";

// Of a rig with several; --camera is kept as a setting like others.
std::optional<std::string> chosen_camera() {
    const auto chosen = std::ranges::find_if(
        set_keys, [](const std::string& setting) { return setting.starts_with(kCamera); });
    return chosen == set_keys.end() ? std::nullopt : std::optional(chosen->substr(kCamera.size()));
}

// For commands that make images of a rig; for others the given images determine the size.
constexpr std::array<std::string_view, 8> kScaled{
    "render", "plan", "generate", "trace", "validate", "study", "lightmap", "survey"};

std::string setting_fault(const std::string& text) {
    const std::size_t sign = text.find('=');
    const bool is_whole = sign != std::string::npos && sign > 0 && sign + 1 < text.size();
    return is_whole ? "" : fmt::format("found {}; allowed: KEY=VALUE", text);
}

}  // namespace

void add_set_option(CLI::App& app) {
    CLI::Option* rig = nullptr;
    for (CLI::Option* option : app.get_options()) {
        const std::string name = option->get_positional() ? option->get_name(true) : "";
        if (name.starts_with("RIG") || option->get_type_name() == "RIG") rig = option;
    }
    if (rig == nullptr) return;
    const auto take = [](const std::vector<std::string>& said) {
        set_keys.insert(set_keys.end(), said.begin(), said.end());
    };
    add_option_function<std::vector<std::string>>(app, "--set", take)
        ->allow_extra_args(false)
        ->check(CLI::Validator(setting_fault, ""))
        ->needs(rig);
    const auto choose = [](const std::string& name) {
        set_keys.push_back(std::string(kCamera) + name);
    };
    add_option_function<std::string>(app, "--camera", choose)->needs(rig);
    if (std::ranges::find(kScaled, app.get_name()) == kScaled.end()) return;
    const auto scale = [](const double& factor) {
        set_keys.push_back(fmt::format("camera.scale={}", factor));
    };
    add_option_function<double>(app, "--scale", scale)
        ->check(in_range(kLeastScale, 1.0))
        ->needs(rig);
}

std::optional<ManifestSettings> rig_settings() {
    if (set_keys.empty()) return std::nullopt;
    return ManifestSettings{.keys = set_keys};
}

RigText read_rig_text_as_set(const std::string& file) {
    const std::filesystem::path place(file);
    const auto camera = chosen_camera();
    RigText text = camera ? rig_of_camera(place, *camera) : RigText(place);
    std::vector<RigSetting> settings;
    std::string said;
    for (const std::string& setting : set_keys) {
        if (setting.starts_with(kCamera)) continue;
        const std::size_t sign = setting.find('=');
        settings.push_back({setting.substr(0, sign), setting.substr(sign + 1)});
        said += fmt::format("{}--set {}", said.empty() ? "" : " ", setting);
    }
    if (settings.empty()) return text;
    try {
        if (camera) return rig_of_camera(place, *camera, settings);
        for (const RigSetting& one : settings) text.set_toml(one.key, one.value);
        static_cast<void>(text.rig());
    } catch (const InputError& error) {
        throw InputError("{}: {}", said, error.what());
    }
    return text;
}

Rig read_rig_as_set(const std::string& file) {
    return set_keys.empty() ? read_rig(file) : read_rig_text_as_set(file).rig();
}

void add_strict_option(CLI::App& app, bool& strict) {
    add_flag(app, "--strict", strict);
}

void check_plausible(const Rig& rig, const std::string& file, bool strict) {
    std::string all;
    for (const Doubt& doubt : doubts_of(rig)) {
        const std::string words = in_words(doubt, file);
        if (!strict) warn("looks wrong: {}", words);
        all += (all.empty() ? "" : "; ") + words;
    }
    if (strict && !all.empty()) throw InputError("--strict: looks wrong: " + all);
}

Rig read_plausible_rig(const std::string& file, bool strict) {
    Rig rig = read_rig_as_set(file);
    check_plausible(rig, file, strict);
    return rig;
}

}  // namespace aphotic::cli
