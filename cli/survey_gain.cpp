// SPDX-License-Identifier: BSD-3-Clause
#include "cli/survey_gain.h"

#include "cli/progress.h"
#include "spectral/error.h"
#include "spectral/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <optional>

namespace aphotic::cli {

namespace {

double median(std::vector<double> numbers) {
    const auto middle = numbers.begin() + std::ssize(numbers) / 2;
    std::ranges::nth_element(numbers, middle);
    return *middle;
}

}  // namespace

SurveyGain measured_gain(const Survey& survey, const GainRequest& request) {
    const std::size_t count = std::min(request.most_images, survey.files.size());
    std::vector<std::optional<PerChannel>> middles(count);
    const auto file_of = [&](std::size_t i) -> const SurveyFile& {
        return survey.files[i * survey.files.size() / count];
    };
    ProgressLine line;
    std::mutex line_mutex;
    std::string first_why;
    std::size_t unusable = 0;
    parallel_for(count, request.jobs, [&](std::size_t i, std::size_t) {
        try {
            const Sled sled = survey.light.pose(file_of(i).source);
            const SurveyImage taken = read_survey_image(file_of(i).source, survey.camera);
            const PlaneSize size = survey.light.size;
            require_size(taken.raw, size.width_px, size.height_px, "as the map has");
            middles[i] = middle_quotient(
                taken.raw, survey.light.map(sled), taken.levels, request.least_light);
        } catch (const InputError& error) {
            // It is said of the image when its turn comes, if one does.
            const std::scoped_lock lock(line_mutex);
            ++unusable;
            if (first_why.empty()) {
                first_why = fmt::format("{}: {}", file_of(i).name.string(), error.what());
            }
        }
        const std::scoped_lock lock(line_mutex);
        line.show("taking the gain", static_cast<double>(i + 1) / static_cast<double>(count));
    });
    SurveyGain gain{.gain = {}, .middle = request.middle, .images = {}};
    std::array<std::vector<double>, kChannels> quotients;
    for (std::size_t i = 0; i < count; ++i) {
        if (!middles[i] || !std::ranges::all_of(*middles[i], [](double q) { return q > 0.0; })) {
            continue;
        }
        gain.images.push_back(file_of(i).name.string());
        for (std::size_t c = 0; c < kChannels; ++c) quotients[c].push_back((*middles[i])[c]);
    }
    if (unusable == count) {
        throw InputError(
            fmt::format("none of the {} images looked at can be corrected; {}", count, first_why));
    }
    if (gain.images.empty()) {
        throw InputError(
            fmt::format("no gain can be taken from these images: of {} looked at, none has light "
                        "and a map in every channel; allowed: --gain{}{}",
                        count,
                        first_why.empty() ? "" : "; ",
                        first_why));
    }
    for (std::size_t c = 0; c < kChannels; ++c)
        gain.gain[c] = gain.middle[c] / median(quotients[c]);
    return gain;
}

}  // namespace aphotic::cli
