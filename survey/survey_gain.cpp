// SPDX-License-Identifier: BSD-3-Clause
#include "survey/survey_gain.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

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
        throw InputError(fmt::format(
            "none of the {} images looked at can be corrected; {}", look.count, look.first_why));
    }
    SurveyGain gain{.gain = {}, .middle = middle, .images = {}};
    std::array<std::vector<double>, kChannels> quotients;
    for (const SeenImage& seen : look.images) {
        const PerChannel& quotient = seen.look.quotient;
        if (!seen.is_for_gain) continue;
        if (!std::ranges::all_of(quotient, [](double q) { return q > 0.0; })) continue;
        gain.images.push_back(seen.name);
        for (std::size_t c = 0; c < kChannels; ++c) quotients[c].push_back(quotient[c]);
    }
    if (gain.images.empty()) {
        throw InputError(
            fmt::format("no gain can be taken from these images: of {} looked at, none has light "
                        "and a map in every channel; allowed: --gain{}{}",
                        look.count,
                        look.first_why.empty() ? "" : "; ",
                        look.first_why));
    }
    for (std::size_t c = 0; c < kChannels; ++c)
        gain.gain[c] = gain.middle[c] / median(quotients[c]);
    return gain;
}

}  // namespace aphotic
