// SPDX-License-Identifier: BSD-3-Clause
//
// One measure of a study as JSON text, and back: how a study goes on where it stopped. `key` names
// all that the measure depends on; nothing comes back for another key or a file that is not whole.
#pragma once

#include "validation/study.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace aphotic {

void save_measure(const StudyMeasure& measure,
                  const std::string& key,
                  const std::filesystem::path& file);
[[nodiscard]] std::optional<StudyMeasure> parse_measure(std::string_view text,
                                                        const StudySetting& setting,
                                                        const std::string& key);
[[nodiscard]] std::optional<StudyMeasure> saved_measure(const StudySetting& setting,
                                                        const std::string& key,
                                                        const std::filesystem::path& file);

// As in study.json: what a setting renders, and a measure's channels.
[[nodiscard]] nlohmann::ordered_json setting_json(const StudySetting& setting);
[[nodiscard]] nlohmann::ordered_json json_of_channels(const StudyMeasure& measure);

}  // namespace aphotic
