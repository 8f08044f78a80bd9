// SPDX-License-Identifier: BSD-3-Clause
//
// The experiment of a study (study.h): every setting rendered from nothing, integrated, and held
// against the reference, which is traced once. What is measured stays in the folder, so that a
// study that was stopped goes on with the settings that are left:
//
//   reference/image.exr     the reference, with the time of its trace
//   settings/NAME.json      a measure (saved_measure.h); settings/NAME/ while it is made
//
// Nothing here runs POV-Ray: whoever calls it hands in what renders a setting.
#pragma once

#include "rig/rig.h"
#include "spectral/manifest.h"
#include "validation/study.h"

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

namespace aphotic {

struct StudyFrames {
    Manifest manifest{};  // of the frames that are in the folder
    double promise = 0.0;
    double render_s = 0.0;
};

struct StudyHands {
    // Renders the frames of a setting into the folder. The rig has the setting's size already.
    std::function<StudyFrames(
        const Rig& rig, const StudySetting& setting, const std::filesystem::path& folder)>
        render;
    std::function<void(std::string_view what, double share)> progress = [](auto, auto) {};
    // index: from 0. Not called for a setting that was measured before.
    std::function<void(const StudySetting& setting, std::size_t index)> begins = [](const auto&,
                                                                                    auto) {};
};

// Fills in the reference and the measures of a study whose rig, versions and cores are named. The
// folder is there, and nobody else works in it.
void run_study(Study& study,
               const Rig& rig,
               const std::vector<StudySetting>& settings,
               const std::filesystem::path& folder,
               const StudyHands& hands);

}  // namespace aphotic
