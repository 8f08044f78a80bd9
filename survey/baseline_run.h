// SPDX-License-Identifier: BSD-3-Clause
//
// A survey's images, each corrected without a model of the lamps (baseline.h) and written; what the
// formats, the mask and the journal are is that of all corrections (result_files.h, image_run.h).
//
//   exr        the camera's own numbers less the black level
//   tiff, png  the same as a share of the white level less the black level
//
// A mask knows saturated, black and clipped pixels. A mosaic's other channels are filled in after
// the correction. baseline.json in the folder of results is the report below.
//
// A correction that learns reads the whole survey before it corrects the first image, and again
// when an image comes, changes or goes: its pattern is another one then, and all images are
// corrected anew.
#pragma once

#include "survey/baseline.h"
#include "survey/image_run.h"
#include "survey/survey.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct BaselineRunOptions {
    Baseline baseline = Baseline::IlluminationReflectance;
    BaselineOptions settings;
    ImageRunOptions run{.folder = {}, .format = {.format = "exr"}};
};

struct BaselineReport {
    std::string_view baseline;
    nlohmann::ordered_json settings;
    std::string folder;
    std::optional<SrgbEncoding> srgb{};  // none: linear alone
    std::vector<Suspicion> looks_wrong{};
    std::optional<RunOutcome> run{};  // none: it has not ended
};
[[nodiscard]] nlohmann::ordered_json to_json(const BaselineReport& report);

// The survey's light is not asked for. An InputError when the baseline needs altitudes and the
// survey has no navigation.
BaselineReport correct_by_baseline(const Survey& survey,
                                   const BaselineRunOptions& options,
                                   const RunWatch& watch);

}  // namespace aphotic
