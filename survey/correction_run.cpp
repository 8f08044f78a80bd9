// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correction_run.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/sha256.h"
#include "survey/contact_sheet.h"
#include "survey/correction_page.h"
#include "survey/share_join.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

PerChannel wanted_middle(const Survey& survey, const CorrectionOptions& options) {
    constexpr double kGrey = 0.2;
    if (!options.middle && survey.light.floor_colour) return *survey.light.floor_colour;
    const double middle = options.middle.value_or(kGrey);
    return {middle, middle, middle};
}

// Their text stands for all that results depend on, images, poses and gain aside: changed, it does
// every image of every folder anew.
Json settings_of(const Survey& survey,
                 const CorrectionOptions& options,
                 const std::optional<SurveyGain>& given) {
    const ResultFormat& format = options.run.format;
    Json json{{"aphotic", APHOTIC_VERSION},
              {survey.navigation ? "rig_sha256" : "map_sha256", survey.light.digest},
              {"camera_sha256", survey.light.camera_digest},
              {"keep_mosaic", options.keep_mosaic},
              {"gain", nullptr},
              {"gain_images", nullptr},
              {"middle", given ? given->middle : wanted_middle(survey, options)},
              {"least_light", options.limit.share},
              {"most_noise", options.limit.relative},
              {"read_noise", nullptr},
              {"electrons", options.limit.electrons_per_number},
              {"edge_px", options.edge_px},
              {"mask", format.mask},
              {"format", format.format},
              {"compression", name_of(format.compression)}};
    if (survey.navigation && survey.navigation->notes())
        json["navigation"] = to_json(*survey.navigation->notes());
    if (given) {
        json["gain"] = given->gain;
    } else {
        json["gain_images"] = options.gain_images;
    }
    if (format.srgb) json["encode"] = to_json(*format.srgb);
    if (survey.light.has_veil) json["veil"] = *survey.light.has_veil;
    if (options.read_noise) json["read_noise"] = *options.read_noise;
    json.update(to_json(survey.camera));
    json["rig_scale"] = nullptr;
    if (const auto& own = survey.light.rig_size)
        json["rig_scale"] = static_cast<double>(survey.light.size.width_px) / own->width_px;
    return json;
}

// By the user, as numbers or as the folder that has them.
std::optional<SurveyGain> given_gain(const Survey& survey,
                                     const CorrectionOptions& options,
                                     std::vector<Suspicion>& doubts) {
    if (!options.gain_from.empty())
        return gain_of_folder(options.gain_from, survey.light, survey.camera, doubts);
    const auto& given = options.gain;
    if (given.empty()) return std::nullopt;
    return SurveyGain{.gain = {given.front(), given[given.size() / 2], given.back()},
                      .middle = wanted_middle(survey, options)};
}

std::optional<SurveyGain> kept_in(const CorrectionOptions& options,
                                  const std::string& settings_sha256) {
    const fs::path notes = options.run.folder / kCorrectionNotes;
    return fs::exists(notes) ? kept_gain(read_text_file(notes), settings_sha256) : std::nullopt;
}

// A gain that is kept is not taken again, but the survey is looked at: it may have other images and
// another navigation by now.
void look_first(const Survey& survey,
                const CorrectionOptions& options,
                const std::optional<SurveyGain>& given,
                const RunWatch& watch,
                CorrectionReport& report) {
    const std::optional<SurveyGain> known =
        given ? given : kept_in(options, report.settings_sha256);
    const SurveyLook look = look_at(survey,
                                    {.gain_images = known ? 0 : options.gain_images,
                                     .least_light = options.limit.share,
                                     .jobs = options.run.jobs},
                                    watch);
    std::ranges::move(suspicions_of(survey.navigation), std::back_inserter(report.looks_wrong));
    std::ranges::move(suspicions(look.images, mosaic_of(look.images), survey.light.rig_altitude_m),
                      std::back_inserter(report.looks_wrong));
    report.not_checked = not_checked(look.images);
    report.looks = look.images;
    watch.looks_wrong(report.looks_wrong);
    report.gain = known ? *known : measured_gain(look, wanted_middle(survey, options));
}

// Of a gain by itself nobody knows how much light the survey's middle has.
bool is_middle_known(const CorrectionOptions& options, const SurveyGain& gain) {
    return !gain.images.empty() || options.middle;
}

Counts correct_image(const Survey& survey,
                     const CorrectionOptions& options,
                     const CorrectionReport& report,
                     const ImageFile& file) {
    const SurveyGain& gain = report.gain;
    const Sled sled = survey.sled_of(file);
    SurveyImage taken = read_survey_image(file.source, survey.camera);
    require_light_for(taken.raw, survey.light);
    NoiseLimit limit = options.limit;
    limit.read_noise = options.read_noise.value_or(taken.rounding);
    if (!is_middle_known(options, gain)) limit = {.share = options.limit.share};
    PerChannel at_exposure = gain.gain;
    for (double& channel : at_exposure) channel /= taken.exposure;
    const Correction correction{
        .gain = at_exposure, .middle = gain.middle, .levels = taken.levels, .limit = limit};
    CorrectedImage result = corrected(std::move(taken.raw), survey.light.map(sled), correction);
    if (is_bayer(result.image.mosaic) && !options.keep_mosaic) result = demosaiced(result);
    const std::vector<std::uint8_t> edges = survey.light.edges(sled, options.edge_px);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        result.doubts[i] |= edges[i] != 0 ? kEdge : std::uint8_t{0};
    }
    if (report.srgb) {
        const ResultFormat& format = options.run.format;
        write_srgb(options.run.folder, file, result, taken, *report.srgb, *format.srgb);
    }
    Counts counts =
        write_results(options.run.folder, file, std::move(result), taken, options.run.format);
    if (survey.camera.exposure_by != ExposureBy::Nothing) counts[kExposure] = taken.exposure;
    return counts;
}

ImageWork work_of(const Survey& survey,
                  const CorrectionOptions& options,
                  const CorrectionReport& report) {
    ImageWork work;
    work.inputs = [&](const ImageFile& file) {
        const Sled sled = survey.sled_of(file);
        return fmt::format("{} {} {} {} {}",
                           report.settings_sha256,
                           fmt::join(report.gain.gain, " "),
                           sled.altitude_m,
                           sled.pitch_rad,
                           sled.roll_rad);
    };
    work.make = [&](const ImageFile& file) { return correct_image(survey, options, report, file); };
    return work;
}

}  // namespace

Json to_json(const CorrectionReport& report) {
    Json json{{"settings", report.settings},
              {"settings_sha256", report.settings_sha256},
              {"gain", report.gain.gain},
              {"gain_from", report.gain.images},
              {"gain_folder", nullptr},
              {"looks_wrong", to_json(report.looks_wrong)},
              {"not_checked", report.not_checked}};
    if (report.srgb) json["srgb"] = to_json(*report.srgb);
    if (!report.gain.folder.empty()) json["gain_folder"] = report.gain.folder;
    if (!report.run) return json;
    json.update(to_json(*report.run));
    json["seconds"] = report.seconds;
    return json;
}

SrgbEncoding shown_as(const Survey& survey,
                      const CorrectionOptions& options,
                      const SurveyGain& gain) {
    std::optional<CameraToSrgb> camera;
    if (survey.light.to_srgb) camera = survey.light.to_srgb();
    std::optional<PerChannel> middle;
    if (is_middle_known(options, gain)) middle = gain.middle;
    // The floor was given the colour that it has by the lamps; in the light that reaches the camera
    // it has another, and only with that one is grey grey.
    PerChannel balance{1.0, 1.0, 1.0};
    const auto& by_lamps = survey.light.floor_colour;
    const auto& in_water = survey.light.floor_colour_in_water;
    if (middle && by_lamps && in_water && *middle == *by_lamps) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            if ((*by_lamps)[c] > 0.0) balance[c] = (*in_water)[c] / (*by_lamps)[c];
        }
        middle = in_water;
    }
    const auto& srgb = options.run.format.srgb;
    SrgbEncoding encoding = srgb_encoding(std::move(camera), middle, srgb ? srgb->stops : 0.0);
    encoding.balance = balance;
    return encoding;
}

CorrectionReport correct_survey(const Survey& survey,
                                const CorrectionOptions& options,
                                const RunWatch& watch) {
    const auto start = std::chrono::steady_clock::now();
    if (options.gain.size() == 2) {
        throw InputError("--gain: found 2 numbers; allowed: 1, or 3 for R, G and B");
    }
    if (options.gain.size() > 1 && survey.camera.mosaic == Mosaic::Mono) {
        throw InputError("--gain: found {} numbers; allowed: 1, of a mono camera",
                         options.gain.size());
    }
    const ResultFolder folder(options.run, survey.files);
    if (options.share.is_whole()) join_shares(survey.files, options.run);
    const fs::path notes = options.run.folder / kCorrectionNotes;
    CorrectionReport report;
    const std::optional<SurveyGain> given = given_gain(survey, options, report.looks_wrong);
    report.settings = settings_of(survey, options, given);
    report.settings_sha256 = sha256_of_text(report.settings.dump());
    look_first(survey, options, given, watch, report);
    if (options.run.format.srgb) report.srgb = shown_as(survey, options, report.gain);
    // Before the first image: also what an interrupted run leaves is no survey.
    write_text_file(notes, json_text(to_json(report)));
    report.run = run_images(share_of(survey.files, options.share),
                            options.run,
                            work_of(survey, options, report),
                            watch);
    const PlaneSize size = survey.light.size;
    report.run->pixels = static_cast<double>(report.run->corrected + report.run->kept) *
                         size.width_px * size.height_px;
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    write_text_file(notes, json_text(to_json(report)));
    if (options.report) {
        const std::vector<SheetImage> sheet = contact_sheet(survey, options, report);
        write_text_file(options.run.folder / kReportPage, correction_html(survey, report, sheet));
    }
    return report;
}

}  // namespace aphotic
