// SPDX-License-Identifier: BSD-3-Clause
#include "rig/file/rig_cameras.h"

#include "base/atomic_file.h"
#include "base/degrees.h"
#include "base/error.h"
#include "rig/beam/beam.h"
#include "rig/beam/round_profile.h"
#include "rig/vehicle_pose.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Lines of the text, from 1, both included.
struct Lines {
    std::size_t first = 0;
    std::size_t last = 0;
};

std::size_t last_line(const toml::node& node) {
    std::size_t last = node.source().end.line;
    if (const toml::table* table = node.as_table(); table != nullptr)
        for (auto&& [key, value] : *table) last = std::max(last, last_line(value));
    return last;
}

struct NamedCamera {
    std::string name;
    Lines lines;
};

// Other tables between those of a camera, such as before its [camera.port], would be left out with
// it.
void require_apart(const toml::node& node,
                   const std::vector<NamedCamera>& cameras,
                   const std::string& file) {
    const std::size_t line = node.source().begin.line;
    const bool is_within = std::ranges::any_of(cameras, [&](const NamedCamera& one) {
        return line >= one.lines.first && line <= one.lines.last;
    });
    if (is_within)
        throw InputError(
            "{}:{}: found between the tables of a camera; allowed: before or after them",
            file,
            line);
    if (const toml::table* table = node.as_table(); table != nullptr)
        for (auto&& [key, value] : *table) require_apart(value, cameras, file);
    if (const toml::array* array = node.as_array(); array != nullptr)
        for (const toml::node& value : *array) require_apart(value, cameras, file);
}

std::vector<NamedCamera> cameras_in(const toml::table& root, const std::string& file) {
    const toml::array* array = root["camera"].as_array();
    std::vector<NamedCamera> cameras;
    if (array == nullptr) return cameras;
    for (const toml::node& node : *array) {
        const toml::table* table = node.as_table();
        const auto name = table == nullptr ? std::nullopt : (*table)["name"].value<std::string>();
        if (!name || table->is_inline() ||
            std::ranges::count(cameras, *name, &NamedCamera::name) > 0)
            throw InputError(
                "{}:{}: camera: allowed: tables [[camera]], each with a name of its own",
                file,
                node.source().begin.line);
        cameras.push_back({.name = *name, .lines = {node.source().begin.line, last_line(node)}});
    }
    for (auto&& [key, value] : root)
        if (key != "camera") require_apart(value, cameras, file);
    return cameras;
}

// The text in which this camera is the only one, as [camera]. Lines keep their numbers, for
// messages.
std::string alone(const std::string& toml,
                  const std::vector<NamedCamera>& cameras,
                  const NamedCamera& chosen) {
    std::string text;
    std::istringstream lines(toml);
    std::string line;
    for (std::size_t number = 1; std::getline(lines, line); ++number) {
        const bool is_left_out = std::ranges::any_of(cameras, [&](const NamedCamera& one) {
            return &one != &chosen && number >= one.lines.first && number <= one.lines.last;
        });
        if (is_left_out) line.clear();
        if (number == chosen.lines.first)
            line = "[camera]  # one of several; strobes and [sled] are relative to it";
        text += line + "\n";
    }
    return text;
}

// camera.KEY is the chosen camera's.
void apply(std::span<const RigSetting> settings, bool is_chosen, RigText& text) {
    for (const RigSetting& one : settings)
        if (is_chosen || !one.key.starts_with("camera.")) text.set_toml(one.key, one.value);
}

// To a tenth of a picometre, for readers.
std::vector<double> numbers_of(const Vector3d& vector) {
    constexpr double kSteps = 1e13;
    const Vector3d rounded = (kSteps * vector).array().round() / kSteps;
    return {rounded.begin(), rounded.end()};
}

// From the first camera's frame to the chosen one's.
struct Change {
    Matrix3d turn;
    Vector3d shift_m;

    Change(const Mounting& first, const Mounting& chosen) {
        const Matrix3d into = turn_by(chosen.roll_pitch_yaw_rad).transpose();
        turn = into * turn_by(first.roll_pitch_yaw_rad);
        shift_m = into * (first.position_m - chosen.position_m);
    }
    // By which a pattern turns about its axis, more than its axis turns.
    [[nodiscard]] double twist_rad(const Vector3d& axis) const {
        const Vector3d along = turn * frame_about(axis).along;
        const BeamFrame frame = frame_about(turn * axis);
        return std::atan2(along.dot(frame.across), along.dot(frame.along));
    }
};

void put_strobe(const Strobe& strobe, const Change& change, RigText& text) {
    constexpr double kRounding_rad = 1e-9;
    const std::string key = "strobe." + strobe.name;
    const Vector3d axis = change.turn * strobe.axis;
    text.set(key + ".position_m", numbers_of(change.turn * strobe.position_m + change.shift_m));
    text.erase(key + ".aim");
    text.set(key + ".direction", numbers_of(axis));
    const double twist_rad = change.twist_rad(strobe.axis);
    if (std::abs(twist_rad) < kRounding_rad) return;
    if (strobe.emitter)
        throw InputError(
            "strobe '{}' has an emitter; allowed: cameras that are not turned against the first "
            "one, or lamps that are points",
            strobe.name);
    if (is_round(strobe.beam)) return;
    const std::string own = fmt::format("{}-{}", strobe.beam.name, strobe.name);
    text.copy(text, "beam." + strobe.beam.name, "beam." + own);
    text.set("beam." + own + ".turn_deg", (strobe.beam.turn_rad + twist_rad) * kDegreesPerRadian);
    text.set(key + ".beam", own);
}

}  // namespace

RigText rig_of_camera(const std::string& toml,
                      const std::string& name,
                      const std::filesystem::path& folder,
                      const std::string& camera,
                      std::span<const RigSetting> settings) {
    std::vector<NamedCamera> cameras;
    try {
        cameras = cameras_in(toml::parse(toml), name);
    } catch (const toml::parse_error&) {
        return {toml, name, folder};  // throws, with a message
    }
    const auto read = [&](const NamedCamera& one, bool is_chosen) {
        RigText text(alone(toml, cameras, one), name, folder);
        apply(settings, is_chosen, text);
        return text;
    };
    if (cameras.empty()) {
        RigText text(toml, name, folder);
        if (text.word("camera.name") != camera)
            throw InputError(
                "{}: found one camera, not called '{}'; allowed: no --camera", name, camera);
        apply(settings, true, text);
        return text;
    }
    const auto chosen = std::ranges::find(cameras, camera, &NamedCamera::name);
    if (chosen == cameras.end()) {
        std::vector<std::string> names;
        for (const NamedCamera& one : cameras) names.push_back(one.name);
        throw InputError(
            "{}: found no camera '{}'; allowed: {}", name, camera, fmt::join(names, ", "));
    }
    RigText text = read(*chosen, true);
    if (chosen == cameras.begin()) return text;
    const Rig rig = read(cameras.front(), false).rig();
    if (!rig.objects.empty() || !rig.scene.empty())
        throw InputError("{}: found {}; allowed: none for a camera that is not the first",
                         name,
                         rig.scene.empty() ? "objects" : "a scene");
    const Mounting mounting = text.rig().mounting;
    const Change change(rig.mounting, mounting);
    naming(name, [&] {
        for (const Strobe& strobe : rig.strobes) put_strobe(strobe, change, text);
        const Sled sled = camera_pose(vehicle_pose(rig.sled, rig.mounting), mounting);
        text.set("sled.altitude_m", sled.altitude_m);
        text.set("sled.pitch_deg", sled.pitch_rad * kDegreesPerRadian);
        text.set("sled.roll_deg", sled.roll_rad * kDegreesPerRadian);
    });
    static_cast<void>(text.rig());  // throws if it is no rig
    return text;
}

RigText rig_of_camera(const std::filesystem::path& file,
                      const std::string& camera,
                      std::span<const RigSetting> settings) {
    return rig_of_camera(read_text_file(file), file.string(), file.parent_path(), camera, settings);
}

}  // namespace aphotic
