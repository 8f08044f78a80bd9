// SPDX-License-Identifier: BSD-3-Clause
//
// The model error estimate (validation/model_check.h) of the commands that make images and maps:
// printed beside the promise, never added to it, and refused if it exceeds --model-tolerance.
#pragma once

#include "spectral/manifest.h"
#include "validation/model_check.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <string_view>

namespace aphotic::cli {

inline constexpr double kModelTolerance = 0.1;

void add_model_tolerance(CLI::App& app, double& tolerance);

// Empty for water that does not scatter. Throws InputError if it exceeds the tolerance, and names
// the option or key that sets the altitude.
[[nodiscard]] std::optional<ManifestModel> model_error(
    const Rig& rig,
    const std::string& rig_file,
    double tolerance,
    std::string_view altitude_by = "sled.altitude_m");

void print_model_error(const std::optional<ManifestModel>& model);
void put_model_error(nlohmann::ordered_json& json, const std::optional<ManifestModel>& model);

}  // namespace aphotic::cli
