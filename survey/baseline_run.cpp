// SPDX-License-Identifier: BSD-3-Clause
#include "survey/baseline_run.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/in_order.h"
#include "base/json_text.h"
#include "base/sha256.h"
#include "survey/first_look.h"
#include "survey/gain.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

std::string_view name_of(Baseline baseline) {
    return kBaselineNames[static_cast<std::size_t>(baseline)];
}

// Of all corrections, also what this one does not use.
Json settings_of(const Survey& survey, const BaselineRunOptions& options) {
    const BaselineOptions& baseline = options.settings;
    const ResultFormat& format = options.run.format;
    Json json{{"aphotic", APHOTIC_VERSION},
              {"sigma", baseline.sigma},
              {"low", baseline.low},
              {"high", baseline.high},
              {"tiles", baseline.tiles},
              {"clip", baseline.clip},
              {"order", baseline.order},
              {"bin_m", baseline.bin_m},
              {"mask", format.mask},
              {"format", format.format},
              {"compression", name_of(format.compression)}};
    json.update(to_json(survey.camera));
    if (survey.navigation && survey.navigation->notes())
        json["navigation"] = to_json(*survey.navigation->notes());
    if (format.srgb) json["encode"] = to_json(*format.srgb);
    return json;
}

// A folder keeps its own, so that images that come later fit the others.
std::optional<SrgbEncoding> encoding_of(const Survey& survey,
                                        const BaselineRunOptions& options,
                                        const Json& settings) {
    if (!options.run.format.srgb) return std::nullopt;
    SrgbEncoding encoding =
        srgb_encoding(std::nullopt, std::nullopt, options.run.format.srgb->stops);
    const fs::path notes = options.run.folder / kBaselineNotes;
    std::optional<PerChannel> kept;
    if (fs::exists(notes)) kept = kept_balance(read_text_file(notes), settings.dump());
    encoding.balance = kept ? *kept : grey_balance(survey, kMiddleGrey, options.run.jobs);
    return encoding;
}

class BaselineWork {
  public:
    BaselineWork(const Survey& survey,
                 const BaselineRunOptions& options,
                 const std::optional<SrgbEncoding>& srgb,
                 const RunWatch& watch)
        : survey_(survey),
          options_(options),
          srgb_(srgb),
          watch_(watch),
          corrector_(options.baseline, options.settings) {}

    [[nodiscard]] ImageWork work(const std::string& settings) {
        const std::string common =
            fmt::format("{} {} {} {}",
                        name_of(options_.baseline),
                        settings,
                        fmt::join(srgb_ ? srgb_->balance : PerChannel{}, " "),
                        corrector_.learns() ? state_of_survey() : "");
        return {.inputs =
                    [this, digest = sha256_of_text(common)](const ImageFile& file) {
                        return fmt::format("{} {}", digest, altitude_m(file));
                    },
                .prepare = [this] { learn(); },
                .make = [this](const ImageFile& file) { return make(file); }};
    }

  private:
    [[nodiscard]] double altitude_m(const ImageFile& file) const {
        return corrector_.needs_altitude() ? survey_.sled_of(file).altitude_m : 0.0;
    }

    // Of all that is learned from.
    [[nodiscard]] std::string state_of_survey() const {
        std::string all;
        for (const ImageFile& file : survey_.files) {
            try {
                all += fmt::format("{} {}\n", state_of(file.source), altitude_m(file));
            } catch (const InputError& error) {
                all += fmt::format("{}\n", error.what());
            }
        }
        return all;
    }

    [[nodiscard]] SurveyImage read_light(const ImageFile& file) const {
        SurveyImage taken = read_survey_image(file.source, survey_.camera);
        take_off_black(taken);
        if (!std::ranges::all_of(taken.raw.samples, [](float s) { return std::isfinite(s); })) {
            throw InputError("a sample is infinite or not a number");
        }
        return taken;
    }

    void learn() {
        for (int pass = 1; pass <= corrector_.passes(); ++pass) {
            learn(corrector_.passes() == 1 ? "learning" : fmt::format("learning, pass {}", pass));
            corrector_.end_pass(options_.run.jobs);
        }
    }

    void learn(const std::string& what) {
        const std::size_t count = survey_.files.size();
        in_order(
            count,
            static_cast<int>(options_.run.jobs),
            [&](std::size_t i) { return read_light(survey_.files[i]).raw; },
            [&](std::size_t i, const RawImage& image) {
                if (first_.width_px == 0) {
                    first_ = {.width_px = image.width_px,
                              .height_px = image.height_px,
                              .mosaic = image.mosaic};
                }
                require_like(image, first_, "as the first image");
                corrector_.learn(image, altitude_m(survey_.files[i]));
                watch_.progress(what, static_cast<double>(i + 1) / static_cast<double>(count));
            },
            [&](std::size_t i, const std::string& why) {
                not_learned_.emplace(survey_.files[i].name, why);
            });
    }

    [[nodiscard]] Counts make(const ImageFile& file) const {
        const auto found = not_learned_.find(file.name);
        if (found != not_learned_.end()) throw InputError(found->second);
        const SurveyImage taken = read_light(file);
        const RawImage& light = taken.raw;
        CorrectedImage result{.image = corrector_.corrected(light, altitude_m(file)),
                              .doubts = doubts_of(taken)};
        if (is_bayer(light.mosaic)) result = demosaiced(result);
        if (srgb_) {
            const SrgbFormat& format = *options_.run.format.srgb;
            write_srgb(options_.run.folder, file, result, taken, *srgb_, format);
        }
        if (options_.run.format.clips()) {
            const float white = white_of(taken);
            for (float& sample : result.image.samples) sample /= white;
        }
        Counts counts =
            write_results(options_.run.folder,
                          file,
                          std::move(result),
                          taken,
                          options_.run.format,
                          {{"aphotic:baseline", std::string(name_of(options_.baseline))}});
        if (survey_.camera.exposure_by != ExposureBy::Nothing) counts[kExposure] = taken.exposure;
        counts[kPixels] = static_cast<double>(light.pixels());
        return counts;
    }

    // Over the black level, at the reference exposure: what is saturated at longer ones is not
    // white.
    [[nodiscard]] static float white_of(const SurveyImage& taken) {
        const float white = taken.levels.white * static_cast<float>(taken.exposure);
        if (std::isfinite(white) && white > 0.0F) return white;
        throw InputError(
            "--white-level: found {} over the black level; allowed: over 0, or --format exr",
            white);
    }

    [[nodiscard]] static std::vector<std::uint8_t> doubts_of(const SurveyImage& taken) {
        const std::size_t pixels = taken.raw.pixels();
        std::vector<std::uint8_t> doubts(pixels);
        for (std::size_t i = 0; i < taken.raw.samples.size(); ++i) {
            const float sample = taken.raw.samples[i];
            const bool is_saturated = sample >= taken.levels.white;
            doubts[i % pixels] |= static_cast<std::uint8_t>((is_saturated ? kSaturated : 0) |
                                                            (sample <= 0.0F ? kBlack : 0));
        }
        return doubts;
    }

    const Survey& survey_;
    const BaselineRunOptions& options_;
    const std::optional<SrgbEncoding>& srgb_;
    const RunWatch& watch_;
    BaselineCorrector corrector_;
    RawImage first_;                               // learned; its samples aside
    std::map<fs::path, std::string> not_learned_;  // by the image's name, and why
};

}  // namespace

Json to_json(const BaselineReport& report) {
    Json json{{"baseline", report.baseline},
              {"settings", report.settings},
              {"folder", report.folder},
              {"looks_wrong", to_json(report.looks_wrong)}};
    if (report.srgb) json["srgb"] = to_json(*report.srgb);
    if (report.run) json.update(to_json(*report.run));
    return json;
}

BaselineReport correct_by_baseline(const Survey& survey,
                                   const BaselineRunOptions& options,
                                   const RunWatch& watch) {
    if (needs_altitude(options.baseline) && !survey.navigation) {
        throw InputError("{}: needs --nav, for the altitude of each image",
                         name_of(options.baseline));
    }
    const ResultFolder folder(options.run, survey.files);
    const fs::path notes = options.run.folder / kBaselineNotes;
    BaselineReport report{.baseline = name_of(options.baseline),
                          .settings = settings_of(survey, options),
                          .folder = options.run.folder.string()};
    report.looks_wrong =
        suspicions_of(survey.files, survey.camera, survey.navigation, options.run.jobs, watch);
    report.srgb = encoding_of(survey, options, report.settings);
    // Before the first image: also what an interrupted run leaves is no survey.
    write_text_file(notes, json_text(to_json(report)));
    BaselineWork work(survey, options, report.srgb, watch);
    report.run = run_images(survey.files, options.run, work.work(report.settings.dump()), watch);
    write_text_file(notes, json_text(to_json(report)));
    return report;
}

}  // namespace aphotic
