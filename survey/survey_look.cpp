// SPDX-License-Identifier: BSD-3-Clause
#include "survey/survey_look.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace aphotic {

namespace {

ImageLook look_at_image(const SurveyFile& file, const Survey& survey, double least_light) {
    ImageLook look;
    const bool has_light = static_cast<bool>(survey.light.map);
    Sled sled;
    if (has_light) sled = survey.light.pose(file.source);
    const SurveyImage taken = read_survey_image(file.source, survey.camera);
    look.top = top_of(taken.raw, taken.rounding > 0.0);
    look.white = taken.levels.white;
    if (taken.raw.mosaic != Mosaic::None) look.sites = site_medians(taken.raw, taken.levels.black);
    if (!has_light) return look;
    const PlaneSize size = survey.light.size;
    require_size(taken.raw, size.width_px, size.height_px, "as the map has");
    const Lightmap map = survey.light.map(sled);
    if (survey.light.has_poses) look.altitude_m = sled.altitude_m;
    look.quotient = middle_quotient(taken.raw, map, taken.levels, least_light);
    look.map_mean = means_of(map);
    if (const auto other =
            survey.light.map_as_radians ? survey.light.map_as_radians(sled) : std::nullopt) {
        look.as_radians = likeness(taken.raw, taken.levels, map, *other);
    }
    return look;
}

// Of that many files, spread evenly: by index, and whether the gain is taken from it.
std::map<std::size_t, bool> chosen(std::size_t files, const LookRequest& request) {
    std::map<std::size_t, bool> chosen;
    const auto spread = [&](std::size_t most, bool is_for_gain) {
        const std::size_t count = std::min(most, files);
        for (std::size_t i = 0; i < count; ++i) chosen[i * files / count] = is_for_gain;
    };
    if (request.gain_images < request.most_images) spread(request.most_images, false);
    spread(request.gain_images, true);
    return chosen;
}

}  // namespace

std::vector<ImageLook> SurveyLook::looks() const {
    std::vector<ImageLook> looks;
    for (const SeenImage& seen : images) looks.push_back(seen.look);
    return looks;
}

SurveyLook look_at(const Survey& survey, const LookRequest& request) {
    struct Seen {
        std::size_t file = 0;
        bool is_for_gain = false;
        std::optional<ImageLook> look;
        std::string why;
    };
    std::vector<Seen> all;
    for (const auto& [file, is_for_gain] : chosen(survey.files.size(), request)) {
        all.push_back({file, is_for_gain, std::nullopt, {}});
    }
    ProgressLine line;
    std::mutex mutex;
    parallel_for(all.size(), request.jobs, [&](std::size_t i, std::size_t) {
        Seen& seen = all[i];
        try {
            seen.look = look_at_image(survey.files[seen.file], survey, request.least_light);
        } catch (const InputError& error) {
            seen.why = error.what();  // it is said of the image when its turn comes, if one does
        }
        const std::scoped_lock lock(mutex);
        line.show("looking at the survey",
                  static_cast<double>(i + 1) / static_cast<double>(all.size()));
    });
    SurveyLook result{.images = {}, .count = all.size(), .first_why = {}};
    for (const Seen& seen : all) {
        const std::string name = survey.files[seen.file].name.string();
        if (seen.look) {
            result.images.push_back({name, *seen.look, seen.is_for_gain});
        } else if (result.first_why.empty()) {
            result.first_why = fmt::format("{}: {}", name, seen.why);
        }
    }
    return result;
}

std::vector<Suspicion> suspicions_of(std::vector<SurveyFile> files,
                                     const CameraNumbers& camera,
                                     std::size_t jobs) {
    constexpr std::size_t kImages = 8;
    const SurveyLook look = look_at({.files = std::move(files), .light = {}, .camera = camera},
                                    {.most_images = kImages, .jobs = jobs});
    return suspicions(look.looks(), camera.mosaic);
}

void add_strict_option(CLI::App& app, bool& strict) {
    app.add_flag("--strict", strict, "Treat warnings about the survey as errors");
}

void tell(const std::vector<Suspicion>& suspicions, bool strict) {
    std::string all;
    for (const Suspicion& one : suspicions) {
        if (!strict) fmt::print(stderr, "aphotic: looks wrong: {}: {}\n", one.about, one.what);
        all += fmt::format("{}{}: {}", all.empty() ? "" : "; ", one.about, one.what);
    }
    if (strict && !all.empty()) throw InputError("--strict: suspicious survey: " + all);
}

nlohmann::ordered_json suspicions_json(const std::vector<Suspicion>& suspicions) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Suspicion& one : suspicions)
        json.push_back({{"about", one.about}, {"what", one.what}});
    return json;
}

}  // namespace aphotic
