// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/corrector.h"

#include "base/error.h"
#include "base/in_order.h"
#include "base/words.h"
#include "survey/dropout_check.h"
#include "survey/first_look.h"

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

class BaselineRun : public Corrector {
  public:
    BaselineRun(const Survey& survey, const CorrectionOptions& options)
        : survey_(survey),
          options_(options),
          method_(*options.baseline, options.of_baselines),
          level_alone_{.files = {}, .camera = survey.camera, .dropouts = survey.dropouts} {}

    // For all baselines, including options that this one does not use.
    [[nodiscard]] Json settings() const override {
        const BaselineOptions& own = options_.of_baselines;
        return {{"sigma", own.sigma},
                {"low", own.low},
                {"high", own.high},
                {"tiles", own.tiles},
                {"clip", own.clip},
                {"order", own.order},
                {"bin_m", own.bin_m},
                {"dropouts", name_of(kDropoutWords, survey_.dropouts)}};
    }

    // A folder keeps its balance, so that later images match the others.
    void look(const std::string& earlier,
              const RunWatch& watch,
              CorrectionReport& report) override {
        report.looks_wrong = suspicions_of(
            survey_.files, survey_.camera, survey_.navigation, options_.run.jobs, watch, &scales_);
        const auto& format = options_.run.format.srgb;
        if (!format) return;
        const auto kept = kept_balance(earlier, report.settings);
        balance_ = kept ? *kept : grey_balance(survey_, kMiddleGrey, options_.run.jobs);
        report.srgb = srgb_encoding(std::nullopt, std::nullopt, format->stops);
        report.srgb->balance = balance_;
    }

    // Covers all inputs to the learning.
    [[nodiscard]] std::string learned() const override {
        std::string all = fmt::format("{}\n", fmt::join(balance_, " "));
        if (!method_.learns()) return all;
        for (const ImageFile& file : survey_.files) {
            try {
                all += fmt::format("{} {}\n", state_of(file.source), altitude_m(file));
            } catch (const InputError& error) {
                all += fmt::format("{}\n", error.what());
            }
        }
        return all;
    }

    [[nodiscard]] std::string pose_of(const ImageFile& file) const override {
        return fmt::to_string(altitude_m(file));
    }

    void learn(const RunWatch& watch) override {
        for (int pass = 1; pass <= method_.passes(); ++pass) {
            learn(watch,
                  method_.passes() == 1 ? "learning" : fmt::format("learning, pass {}", pass));
            method_.end_pass(options_.run.jobs);
        }
    }

    void judge(SurveyImage& taken, const ImageFile& file) const override {
        aphotic::judge(taken, level_alone_, file, scales_);
    }

    [[nodiscard]] CorrectedImage correct(SurveyImage& taken, const ImageFile& file) const override {
        const auto found = not_learned_.find(file.name);
        if (found != not_learned_.end()) throw InputError(found->second);
        leave_light(taken);
        CorrectedImage result{.image = method_.corrected(taken.raw, altitude_m(file)),
                              .doubts = doubts_of(taken)};
        return is_bayer(taken.raw.mosaic) ? demosaiced(result) : result;
    }

    // Above the black level, at the reference exposure: samples saturated at longer exposures are
    // not white.
    [[nodiscard]] float white_of(const SurveyImage& taken) const override {
        const float white = taken.levels.white * static_cast<float>(taken.exposure);
        if (std::isfinite(white) && white > 0.0F) return white;
        throw InputError(
            "--white-level: found {} above the black level; allowed: above 0, or --format exr",
            white);
    }

  private:
    [[nodiscard]] double altitude_m(const ImageFile& file) const {
        return method_.needs_altitude() ? survey_.sled_of(file).altitude_m : 0.0;
    }

    static void leave_light(SurveyImage& taken) {
        take_off_black(taken);
        if (!std::ranges::all_of(taken.raw.samples, [](float s) { return std::isfinite(s); })) {
            throw InputError("a sample is infinite or not a number");
        }
    }

    void learn(const RunWatch& watch, const std::string& what) {
        const std::size_t count = survey_.files.size();
        in_order(
            count,
            static_cast<int>(options_.run.jobs),
            [&](std::size_t i) {
                SurveyImage taken = read_survey_image(survey_.files[i].source, survey_.camera);
                judge(taken, survey_.files[i]);
                leave_light(taken);
                return taken;
            },
            [&](std::size_t i, const SurveyImage& taken) {
                const RawImage& image = taken.raw;
                if (first_.width_px == 0) {
                    first_ = {.width_px = image.width_px,
                              .height_px = image.height_px,
                              .mosaic = image.mosaic};
                }
                require_like(image, first_, "like the first image");
                const double height_m = altitude_m(survey_.files[i]);
                if (taken.light_share == 1.0) method_.learn(image, height_m);
                watch.progress(what, static_cast<double>(i + 1) / static_cast<double>(count));
            },
            [&](std::size_t i, const std::string& why) {
                not_learned_.emplace(survey_.files[i].name, why);
            });
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
    const CorrectionOptions& options_;
    BaselineCorrector method_;
    Survey level_alone_;
    DropoutScales scales_;
    PerChannel balance_{};
    RawImage first_;                               // the first learned, without its samples
    std::map<fs::path, std::string> not_learned_;  // by the image's name, and why
};

}  // namespace

std::unique_ptr<Corrector> baseline_corrector(const Survey& survey,
                                              const CorrectionOptions& options) {
    if (needs_altitude(*options.baseline) && !survey.navigation) {
        throw InputError("{}: needs --nav, for the altitude of each image",
                         name_of(*options.baseline));
    }
    return std::make_unique<BaselineRun>(survey, options);
}

}  // namespace aphotic
