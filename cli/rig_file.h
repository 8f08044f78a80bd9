// SPDX-License-Identifier: BSD-3-Clause
//
// The rig given to a command, with warnings about implausible values (rig/plausibility.h), in the
// form of those about surveys. With --strict they are errors, before anything is written.
//
// --set KEY=VALUE sets keys of its text (rig/file/rig_text.h) before it is read, for every command:
// from then on this is the rig, and its digest is that of the changed text. --scale 0.1, of the
// commands that make images of a rig, is --set camera.scale=0.1. --camera NAME chooses one of
// several (rig/file/rig_cameras.h); keys are set as the file has them.
#pragma once

#include "rig/file/rig_text.h"
#include "rig/rig.h"
#include "spectral/manifest.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace aphotic::cli {

void add_strict_option(CLI::App& app, bool& strict);

// Called after the options' changes to the rig.
void check_plausible(const Rig& rig, const std::string& file, bool strict);

// For a command with an argument or an option for a rig; others are not changed.
void add_set_option(CLI::App& app);
// The values of --set, in order; may be empty.
[[nodiscard]] std::optional<ManifestSettings> rig_settings();

// The rig of the file, with these keys set. Throws InputError as read_rig does
// (rig/file/rig_reader.h), prefixed with --set if a key or its value is at fault.
[[nodiscard]] RigText read_rig_text_as_set(const std::string& file);
[[nodiscard]] Rig read_rig_as_set(const std::string& file);

[[nodiscard]] Rig read_plausible_rig(const std::string& file, bool strict);

}  // namespace aphotic::cli
