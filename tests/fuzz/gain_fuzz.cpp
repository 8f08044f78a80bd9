// SPDX-License-Identifier: BSD-3-Clause
//
// The gain in the notes of a corrected survey, from any text. Of this survey's own notes, what is
// not ours tells of none, so every text is taken; those of another survey are refused in words. A
// gain that comes of it is one to multiply with.
#include "fuzz.h"
#include "survey/correct/corrector.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <vector>

namespace {

void demand_gain(const aphotic::SurveyGain& noted) {
    for (const double gain : noted.gain) {
        if (!std::isfinite(gain) || gain <= 0.0) std::abort();
    }
    for (const double middle : noted.middle) {
        if (!std::isfinite(middle) || middle <= 0.0) std::abort();
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto text = aphotic::text_of(data, size);
    // Its own, where it has some: of others it tells of no gain.
    const auto notes = nlohmann::ordered_json::parse(text, nullptr, false);
    const nlohmann::ordered_json settings =
        notes.is_object() && notes.contains("settings") ? notes["settings"] : nullptr;
    if (const auto kept = aphotic::kept_gain(text, settings)) demand_gain(*kept);
    if (const auto balance = aphotic::kept_balance(text, settings)) {
        for (const double number : *balance) {
            if (!std::isfinite(number) || number <= 0.0) std::abort();
        }
    }
    aphotic::LightAt light;
    light.digest = "rig";
    light.camera_digest = "camera";
    aphotic::expect_result_or_placed_error("--gain-from: dive", [&] {
        std::vector<aphotic::Suspicion> doubts;
        demand_gain(aphotic::gain_of_notes(text, "dive", light, {}, doubts));
    });
    return 0;
}
