// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/correction_run.h"

#include "base/atomic_file.h"
#include "base/json_text.h"
#include "base/sha256.h"
#include "base/stopwatch.h"
#include "base/words.h"
#include "survey/correct/contact_sheet.h"
#include "survey/correct/correction_page.h"

#include <fmt/format.h>

#include <utility>

namespace aphotic {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

// Their text covers everything that results depend on, except images, poses and what is learned.
Json settings_of(const Survey& survey,
                 const CorrectionOptions& options,
                 const Corrector& corrector) {
    const ResultFormat& format = options.run.format;
    Json json{{"aphotic", APHOTIC_VERSION}};
    json.update(corrector.settings());
    json["mask"] = format.mask;
    json["format"] = format.format;
    json["compression"] = name_of(kCompressions, format.compression);
    json.update(to_json(survey.camera));
    if (survey.navigation && survey.navigation->notes())
        json["navigation"] = to_json(*survey.navigation->notes());
    if (format.srgb) json["encode"] = to_json(*format.srgb);
    return json;
}

Counts correct_image(const Survey& survey,
                     const CorrectionOptions& options,
                     const CorrectionReport& report,
                     const Corrector& corrector,
                     const ImageFile& file) {
    const ImageRunOptions& run = options.run;
    SurveyImage taken = read_survey_image(file.source, survey.camera);
    corrector.judge(taken, file);
    CorrectedImage result = corrector.correct(taken, file);
    if (report.srgb) write_srgb(run.folder, file, result, taken, *report.srgb, *run.format.srgb);
    const float white = run.format.clips() ? corrector.white_of(taken) : 1.0F;
    if (white != 1.0F) {
        for (float& sample : result.image.samples) sample /= white;
    }
    const auto pixels = static_cast<double>(result.doubts.size());
    ExrAttributes more;
    if (!report.baseline.empty()) more = {{"aphotic:baseline", std::string(report.baseline)}};
    if (taken.light_share < 1.0)
        more.emplace_back("aphotic:light_share", fmt::format("{:.4g}", taken.light_share));
    Counts counts = write_results(run.folder, file, std::move(result), taken, run.format, more);
    if (survey.camera.exposure_by != ExposureBy::Nothing) counts[kExposure] = taken.exposure;
    if (taken.light_share < 1.0) {
        counts[kLightShare] = taken.light_share;
        counts[kStrobesOut] = static_cast<double>(taken.strobes_out);
    }
    counts[kPixels] = pixels;
    return counts;
}

std::string text_in(const fs::path& file) {
    return fs::exists(file) ? read_text_file(file) : "";
}

}  // namespace

Json to_json(const CorrectionReport& report) {
    const bool is_baseline = !report.baseline.empty();
    Json json;
    if (is_baseline) {
        json = {{"baseline", report.baseline},
                {"settings", report.settings},
                {"folder", report.folder},
                {"looks_wrong", to_json(report.looks_wrong)}};
    } else {
        json = {{"settings", report.settings},
                {"settings_sha256", report.settings_sha256},
                {"gain", report.gain.gain},
                {"gain_from", report.gain.images},
                {"gain_folder", nullptr},
                {"looks_wrong", to_json(report.looks_wrong)},
                {"not_checked", report.not_checked},
                {"pattern", to_json(report.pattern)}};
        if (!report.gain.folder.empty()) json["gain_folder"] = report.gain.folder;
    }
    if (report.srgb) json["srgb"] = to_json(*report.srgb);
    if (!report.run) return json;
    json.update(to_json(*report.run));
    if (!is_baseline) json["seconds"] = report.seconds;
    return json;
}

CorrectionReport correct_survey(const Survey& survey,
                                const CorrectionOptions& options,
                                const RunWatch& watch) {
    const Stopwatch clock;
    const fs::path& folder = options.run.folder;
    const std::unique_ptr<Corrector> corrector =
        options.baseline ? baseline_corrector(survey, options) : model_corrector(survey, options);
    require_results_apart(survey.files, options.run);
    const WorkFolder claimed(folder);
    if (options.share.is_whole()) join_shares(survey.files, options.run);
    CorrectionReport report{
        .baseline = options.baseline ? name_of(*options.baseline) : std::string_view(),
        .folder = folder.string(),
        .settings = settings_of(survey, options, *corrector)};
    report.settings_sha256 = sha256_of_text(report.settings.dump());
    const fs::path notes = folder / (options.baseline ? kBaselineNotes : kCorrectionNotes);
    corrector->look(text_in(notes), watch, report);
    // Before the first image, since the remains of an interrupted run are not a survey either.
    write_text_file(notes, json_text(to_json(report)));
    const ImageWork work{
        .inputs = [&,
                   common = sha256_of_text(fmt::format(
                       "{} {} {}", report.baseline, report.settings_sha256, corrector->learned()))](
                      const ImageFile& file) { return common + " " + corrector->pose_of(file); },
        .prepare = [&] { corrector->learn(watch); },
        .make =
            [&](const ImageFile& file) {
                return correct_image(survey, options, report, *corrector, file);
            },
        .strobes = survey.strobes.names};
    report.run = run_images(share_of(survey.files, options.share), options.run, work, watch);
    report.seconds = clock.seconds();
    write_text_file(notes, json_text(to_json(report)));
    if (options.report) {
        write_text_file(folder / kReportPage,
                        correction_html(survey, report, contact_sheet(survey, options, report)));
    }
    return report;
}

}  // namespace aphotic
