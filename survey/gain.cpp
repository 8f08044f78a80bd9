// SPDX-License-Identifier: BSD-3-Clause
#include "survey/gain.h"

#include "base/error.h"
#include "base/json_text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace aphotic {
namespace {

double median(std::vector<double> numbers) {
    const auto middle = numbers.begin() + std::ssize(numbers) / 2;
    std::ranges::nth_element(numbers, middle);
    return *middle;
}

}  // namespace

SurveyGain measured_gain(const SurveyLook& look, const PerChannel& middle) {
    if (look.images.empty()) {
        throw InputError(
            "none of the {} images looked at can be corrected; {}", look.count, look.first_why);
    }
    SurveyGain gain{.middle = middle};
    std::array<std::vector<double>, kChannels> quotients;
    for (const ImageLook& image : look.images) {
        const PerChannel& quotient = image.quotient;
        if (!image.is_for_gain) continue;
        if (!std::ranges::all_of(quotient, [](double q) { return q > 0.0; })) continue;
        gain.images.push_back(image.name);
        for (std::size_t c = 0; c < kChannels; ++c) quotients[c].push_back(quotient[c]);
    }
    if (gain.images.empty()) {
        throw InputError(
            "no gain can be taken from these images: of {} looked at, none has light and a map in "
            "every channel; allowed: --gain{}{}",
            look.count,
            look.first_why.empty() ? "" : "; ",
            look.first_why);
    }
    for (std::size_t c = 0; c < kChannels; ++c)
        gain.gain[c] = gain.middle[c] / median(quotients[c]);
    return gain;
}

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
