// SPDX-License-Identifier: BSD-3-Clause
#include "survey/kept_gain.h"

#include "base/error.h"
#include "base/json_text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace aphotic {

std::optional<SurveyGain> kept_gain(std::string_view text, const std::string& settings_sha256) {
    try {
        const nlohmann::json notes = parse_json(text, "correction.json");
        if (notes.at("settings_sha256") != settings_sha256) return std::nullopt;
        if (!notes.at("looks_wrong").empty()) return std::nullopt;
        SurveyGain kept{.gain = notes.at("gain").get<PerChannel>(),
                        .middle = notes.at("settings").at("middle").get<PerChannel>(),
                        .images = notes.at("gain_from").get<std::vector<std::string>>()};
        const auto is_gain = [](double gain) { return std::isfinite(gain) && gain > 0.0; };
        return std::ranges::all_of(kept.gain, is_gain) ? std::optional(kept) : std::nullopt;
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    } catch (const InputError&) {
        return std::nullopt;
    }
}

}  // namespace aphotic
