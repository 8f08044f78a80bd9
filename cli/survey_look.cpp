// SPDX-License-Identifier: BSD-3-Clause
#include "cli/survey_look.h"

#include "cli/progress.h"
#include "spectral/error.h"
#include "spectral/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>

namespace aphotic::cli {

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
    look.altitude_m = sled.altitude_m;
    look.quotient = middle_quotient(taken.raw, map, taken.levels, least_light);
    look.map_mean = means_of(map);
    if (const auto other =
            survey.light.map_as_radians ? survey.light.map_as_radians(sled) : std::nullopt) {
        look.as_radians = likeness(taken.raw, taken.levels, map, *other);
    }
    return look;
}

}  // namespace

SurveyLook look_at(const Survey& survey, const LookRequest& request) {
    const std::size_t count = std::min(request.most_images, survey.files.size());
    std::vector<std::optional<ImageLook>> looks(count);
    const auto file_of = [&](std::size_t i) -> const SurveyFile& {
        return survey.files[i * survey.files.size() / count];
    };
    ProgressLine line;
    std::mutex mutex;
    SurveyLook all{.images = {}, .names = {}, .count = count, .first_why = {}};
    parallel_for(count, request.jobs, [&](std::size_t i, std::size_t) {
        try {
            looks[i] = look_at_image(file_of(i), survey, request.least_light);
        } catch (const InputError& error) {
            // It is said of the image when its turn comes, if one does.
            const std::scoped_lock lock(mutex);
            if (all.first_why.empty()) {
                all.first_why = fmt::format("{}: {}", file_of(i).name.string(), error.what());
            }
        }
        const std::scoped_lock lock(mutex);
        line.show("looking at the survey", static_cast<double>(i + 1) / static_cast<double>(count));
    });
    for (std::size_t i = 0; i < count; ++i) {
        if (!looks[i]) continue;
        all.images.push_back(*looks[i]);
        all.names.push_back(file_of(i).name.string());
    }
    return all;
}

std::vector<Suspicion> suspicions_of(std::vector<SurveyFile> files,
                                     const CameraNumbers& camera,
                                     std::size_t jobs) {
    constexpr std::size_t kImages = 8;
    const SurveyLook look = look_at({.files = std::move(files), .light = {}, .camera = camera},
                                    {.most_images = kImages, .jobs = jobs});
    return suspicions(look.images, camera.mosaic);
}

void add_strict_option(CLI::App& app, bool& strict) {
    app.add_flag("--strict", strict, "what looks wrong about the survey ends the command");
}

void tell(const std::vector<Suspicion>& suspicions, bool strict) {
    std::string all;
    for (const Suspicion& one : suspicions) {
        if (!strict) fmt::print(stderr, "aphotic: looks wrong: {}: {}\n", one.about, one.what);
        all += fmt::format("{}{}: {}", all.empty() ? "" : "; ", one.about, one.what);
    }
    if (strict && !all.empty()) throw InputError("looks wrong, by --strict: " + all);
}

nlohmann::ordered_json suspicions_json(const std::vector<Suspicion>& suspicions) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Suspicion& one : suspicions)
        json.push_back({{"about", one.about}, {"what", one.what}});
    return json;
}

}  // namespace aphotic::cli
