// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/corrector.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/parallel.h"
#include "base/upper_median.h"
#include "base/words.h"
#include "survey/dropout_check.h"
#include "survey/image_light.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace aphotic {

using Json = nlohmann::ordered_json;

namespace {

bool is_number(double number) {
    return std::isfinite(number) && number > 0.0;
}

// Parses correct_survey()'s notes. An nlohmann exception for anything else.
std::optional<SurveyGain> gain_in(const nlohmann::json& notes) {
    SurveyGain noted{.gain = notes.at("gain").get<PerChannel>(),
                     .middle = notes.at("settings").at("middle").get<PerChannel>(),
                     .images = notes.at("gain_from").get<std::vector<std::string>>()};
    const bool is_gain =
        std::ranges::all_of(noted.gain, is_number) && std::ranges::all_of(noted.middle, is_number);
    return is_gain ? std::optional(noted) : std::nullopt;
}

// For the digests of cameras and rigs; with one map for all, there is no rig_sha256.
std::string text_in(const nlohmann::json& settings, const char* key) {
    const auto found = settings.find(key);
    return found != settings.end() && found->is_string() ? found->get<std::string>() : "";
}

void compare_light(const nlohmann::json& settings,
                   const LightAt& light,
                   const std::string& folder,
                   std::vector<Suspicion>& doubts) {
    const bool has_rig = settings.contains("rig_sha256");
    const std::string camera = text_in(settings, "camera_sha256");
    if (has_rig == light.camera_digest.empty()) {
        throw InputError("--gain-from: {}: was corrected with {}; allowed: results with {}",
                         folder,
                         has_rig ? "--rig" : "--map",
                         has_rig ? "--map" : "--rig");
    }
    if (camera != light.camera_digest) {
        throw InputError(
            "--gain-from: {}: the rig there has a camera with another response; allowed: results "
            "of the same camera",
            folder);
    }
    if (text_in(settings, has_rig ? "rig_sha256" : "map_sha256") != light.digest) {
        doubts.push_back(
            {"gain-from",
             folder + (has_rig ? ": made with a different rig" : ": made with a different map")});
    }
}

// A gain is valid for numbers between these.
void compare_levels(const nlohmann::json& settings,
                    const CameraNumbers& camera,
                    const std::string& folder,
                    std::vector<Suspicion>& doubts) {
    const nlohmann::json here = to_json(camera);
    for (const char* level : {"black_level", "white_level"}) {
        const nlohmann::json there = settings.value(level, nlohmann::json());
        if (there == here.value(level, nlohmann::json())) continue;
        doubts.push_back(
            {"gain-from",
             fmt::format("{}: the {} there is {}, here {}",
                         folder,
                         level,
                         there.is_null() ? "the file's" : there.dump(),
                         here.value(level, nlohmann::json()).is_null() ? "the file's"
                                                                       : here.at(level).dump())});
    }
}

// A warning about the navigation, such as a track that still grows, does not concern the gain; and
// medians hardly depend on a pattern.
bool looked_wrong(const nlohmann::json& notes) {
    return std::ranges::any_of(notes.at("looks_wrong"), [](const nlohmann::json& one) {
        const auto about = one.at("about").get<std::string>();
        return about != kAboutNavigation && about != kAboutPattern;
    });
}

// What notes with these settings contain; empty for others, or for notes that correct_survey() did
// not write.
template <typename Kept, typename Find>
std::optional<Kept> kept_of(std::string_view text,
                            const nlohmann::ordered_json& settings,
                            const Find& found_in) {
    try {
        const nlohmann::json notes = parse_json(text, "notes");
        if (notes.at("settings") != nlohmann::json(settings)) return std::nullopt;
        return found_in(notes);
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    } catch (const InputError&) {
        return std::nullopt;
    }
}

}  // namespace

SurveyGain measured_gain(const SurveyLook& look, const PerChannel& middle) {
    if (look.images.empty()) {
        throw InputError("{}", look.none_can_be("corrected"));
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
            "no gain can be derived from these images: of {} examined, none has light and a map in "
            "every channel; allowed: --gain{}{}",
            look.count,
            look.first_why.empty() ? "" : "; ",
            look.first_why);
    }
    for (std::size_t c = 0; c < kChannels; ++c)
        gain.gain[c] = gain.middle[c] / upper_median(quotients[c]);
    return gain;
}

std::optional<SurveyGain> kept_gain(std::string_view text, const nlohmann::ordered_json& settings) {
    return kept_of<SurveyGain>(text, settings, [](const nlohmann::json& notes) {
        return looked_wrong(notes) ? std::nullopt : gain_in(notes);
    });
}

SurveyGain gain_of_notes(std::string_view text,
                         const std::string& folder,
                         const LightAt& light,
                         const CameraNumbers& camera,
                         std::vector<Suspicion>& doubts) {
    const std::string where = fmt::format("--gain-from: {}: {}", folder, kCorrectionNotes);
    std::optional<SurveyGain> gain;
    try {
        const nlohmann::json notes = parse_json(text, where);
        gain = gain_in(notes);
        if (gain) {
            compare_light(notes.at("settings"), light, folder, doubts);
            compare_levels(notes.at("settings"), camera, folder, doubts);
        }
        if (looked_wrong(notes)) {
            doubts.push_back({"gain-from", folder + ": its own survey looked wrong"});
        }
    } catch (const nlohmann::json::exception&) {
        gain.reset();
    }
    if (!gain) {
        throw InputError("{}: contains no gain; allowed: as `correct` wrote it", where);
    }
    gain->folder = folder;
    return *gain;
}

SurveyGain gain_of_folder(const std::filesystem::path& folder,
                          const LightAt& light,
                          const CameraNumbers& camera,
                          std::vector<Suspicion>& doubts) {
    const std::filesystem::path file = folder / kCorrectionNotes;
    if (!std::filesystem::exists(file)) {
        throw InputError("--gain-from: {}: contains no {}; allowed: a folder that `correct` wrote",
                         folder.string(),
                         kCorrectionNotes);
    }
    return gain_of_notes(read_text_file(file), folder.string(), light, camera, doubts);
}

PerChannel grey_balance(const Survey& survey, double grey, std::size_t jobs) {
    constexpr std::size_t kImages = 16;
    const std::size_t count = std::min(kImages, survey.files.size());
    std::vector<PerChannel> middles(count);  // 0 for those that cannot be read
    parallel_for(count, jobs, [&](std::size_t i, std::size_t) {
        try {
            const SurveyImage taken = read_survey_image(
                survey.files[i * survey.files.size() / count].source, survey.camera);
            const RawImage& raw = taken.raw;
            const Lightmap even{.width_px = raw.width_px,
                                .height_px = raw.height_px,
                                .samples = std::vector<float>(kChannels * raw.pixels(), 1.0F)};
            middles[i] = middle_quotient(raw, even, taken.levels, 0.0);
        } catch (const InputError&) {
            // The image is reported when its turn comes.
        }
    });
    std::erase_if(middles, [](const PerChannel& m) { return !std::ranges::all_of(m, is_number); });
    PerChannel balance{1.0, 1.0, 1.0};
    for (std::size_t c = 0; c < kChannels && !middles.empty(); ++c) {
        std::vector<double> of_channel;
        for (const PerChannel& middle : middles) of_channel.push_back(middle[c]);
        balance[c] = grey / upper_median(of_channel);
    }
    return balance;
}

std::optional<PerChannel> kept_balance(std::string_view text,
                                       const nlohmann::ordered_json& settings) {
    return kept_of<PerChannel>(text, settings, [](const nlohmann::json& notes) {
        const auto balance = notes.at("srgb").at("balance").get<PerChannel>();
        return std::ranges::all_of(balance, is_number) ? std::optional(balance) : std::nullopt;
    });
}

namespace {

PerChannel wanted_middle(const Survey& survey, const CorrectionOptions& options) {
    constexpr double kGrey = 0.2;
    if (!options.middle && survey.light.floor_colour) return *survey.light.floor_colour;
    const double middle = options.middle.value_or(kGrey);
    return {middle, middle, middle};
}

// The user's gain, as numbers or from a folder of results.
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

// With a given gain, the light of the survey's median is unknown.
bool is_middle_known(const CorrectionOptions& options, const SurveyGain& gain) {
    return !gain.images.empty() || options.middle;
}

// Other errors of the light leave a pattern as well.
std::optional<Suspicion> pattern_doubt(const FixedPattern& pattern,
                                       bool has_rig,
                                       std::span<const Suspicion> others) {
    const bool has_cause = std::ranges::any_of(
        others, [](const Suspicion& one) { return one.about != kAboutNavigation; });
    if (has_cause || !pattern.is_too_large()) return std::nullopt;
    return Suspicion{std::string(kAboutPattern),
                     words_of(pattern) + (has_rig ? ": the light differs from the rig's; `aphotic "
                                                    "fit` finds a rig that explains the images"
                                                  : ": the light differs from the map's")};
}

class ModelCorrector : public Corrector {
  public:
    ModelCorrector(const Survey& survey, const CorrectionOptions& options)
        : survey_(survey), options_(options), given_(given_gain(survey, options, doubts_)) {}

    // Changing these texts invalidates the images in every folder.
    [[nodiscard]] Json settings() const override {
        const LightAt& light = survey_.light;
        Json json{{has_rig() ? "rig_sha256" : "map_sha256", light.digest},
                  {"camera_sha256", light.camera_digest},
                  {"keep_mosaic", options_.keep_mosaic},
                  {"gain", nullptr},
                  {"gain_images", nullptr},
                  {"middle", given_ ? given_->middle : wanted_middle(survey_, options_)},
                  {"least_light", options_.limit.share},
                  {"most_noise", options_.limit.relative},
                  {"read_noise", nullptr},
                  {"electrons", options_.limit.electrons_per_number},
                  {"edge_px", options_.edge_px},
                  {"dropouts", name_of(kDropoutWords, survey_.dropouts)},
                  {"rig_scale", nullptr}};
        if (given_)
            json["gain"] = given_->gain;
        else
            json["gain_images"] = options_.gain_images;
        if (options_.read_noise) json["read_noise"] = *options_.read_noise;
        if (const auto& own = light.rig_size)
            json["rig_scale"] = static_cast<double>(light.size.width_px) / own->width_px;
        if (light.has_veil) json["veil"] = *light.has_veil;
        if (light.veil_tolerance) json["tolerance"] = *light.veil_tolerance;
        if (survey_.depth) json["depth"] = to_json(*survey_.depth);
        return json;
    }

    // A stored gain is not derived again, but the survey is still examined: its images and
    // navigation may have changed.
    void look(const std::string& earlier,
              const RunWatch& watch,
              CorrectionReport& report) override {
        const std::optional<SurveyGain> known =
            given_ ? given_ : kept_gain(earlier, report.settings);
        const SurveyLook look = look_at(survey_,
                                        {.gain_images = known ? 0 : options_.gain_images,
                                         .least_light = options_.limit.share,
                                         .jobs = options_.run.jobs},
                                        watch);
        report.looks_wrong = doubts_;
        std::ranges::move(suspicions_of(survey_.navigation),
                          std::back_inserter(report.looks_wrong));
        std::ranges::move(
            suspicions(look.images, mosaic_of(look.images), survey_.light.rig_altitude_m),
            std::back_inserter(report.looks_wrong));
        if (look.doubt) report.looks_wrong.push_back(*look.doubt);
        if (const auto doubt = exposure_doubt(look.images, survey_.camera.exposure_by))
            report.looks_wrong.push_back(*doubt);
        report.pattern = look.pattern;
        if (const auto doubt = pattern_doubt(look.pattern, has_rig(), report.looks_wrong))
            report.looks_wrong.push_back(*doubt);
        scales_ = look.scales;
        report.not_checked = not_checked(look.images);
        report.looks = look.images;
        watch.looks_wrong(report.looks_wrong);
        gain_ = known ? *known : measured_gain(look, wanted_middle(survey_, options_));
        report.gain = gain_;
        if (options_.run.format.srgb) report.srgb = shown_as(survey_, options_, gain_);
    }

    [[nodiscard]] std::string learned() const override {
        return fmt::format("{}", fmt::join(gain_.gain, " "));
    }

    [[nodiscard]] std::string pose_of(const ImageFile& file) const override {
        return light_inputs(survey_, file);
    }

    void judge(SurveyImage& taken, const ImageFile& file) const override {
        require_light_for(taken.raw, survey_.light);
        aphotic::judge(taken, survey_, file, scales_);
    }

    [[nodiscard]] CorrectedImage correct(SurveyImage& taken, const ImageFile& file) const override {
        const bool is_wanted = survey_.dropouts == Dropouts::Correct;
        const ImageLight light = light_of(
            survey_, file, options_.edge_px, is_wanted ? taken.strobes_out : std::uint64_t{0});
        NoiseLimit limit = options_.limit;
        limit.read_noise = options_.read_noise.value_or(taken.rounding);
        if (!is_middle_known(options_, gain_)) limit = {.share = options_.limit.share};
        PerChannel at_exposure = gain_.gain;
        for (double& channel : at_exposure) channel /= taken.exposure;
        const Correction correction{
            .gain = at_exposure, .middle = gain_.middle, .levels = taken.levels, .limit = limit};
        CorrectedImage result = corrected(std::move(taken.raw), light.map, correction);
        if (is_bayer(result.image.mosaic) && !options_.keep_mosaic) result = demosaiced(result);
        for (std::size_t i = 0; i < light.edges.size(); ++i)
            result.doubts[i] |= light.edges[i] != 0 ? kEdge : std::uint8_t{0};
        for (std::size_t i = 0; i < light.filled.size(); ++i)
            result.doubts[i] |= light.filled[i] != 0 ? kRange : std::uint8_t{0};
        return result;
    }

  private:
    [[nodiscard]] bool has_rig() const { return survey_.navigation || survey_.depth; }

    const Survey& survey_;
    const CorrectionOptions& options_;
    std::vector<Suspicion> doubts_;  // about the given gain
    std::optional<SurveyGain> given_;
    SurveyGain gain_;
    DropoutScales scales_;
};

}  // namespace

std::unique_ptr<Corrector> model_corrector(const Survey& survey, const CorrectionOptions& options) {
    if (options.gain.size() == 2) {
        throw InputError("--gain: found 2 numbers; allowed: 1, or 3 for R, G and B");
    }
    if (options.gain.size() > 1 && survey.camera.mosaic == Mosaic::Mono) {
        throw InputError("--gain: found {} numbers; allowed: 1, of a mono camera",
                         options.gain.size());
    }
    return std::make_unique<ModelCorrector>(survey, options);
}

SrgbEncoding shown_as(const Survey& survey,
                      const CorrectionOptions& options,
                      const SurveyGain& gain) {
    std::optional<CameraToSrgb> camera;
    if (survey.light.to_srgb) camera = survey.light.to_srgb();
    std::optional<PerChannel> middle;
    if (is_middle_known(options, gain)) middle = gain.middle;
    // The floor was given its colour under the lamps; in the light that reaches the camera its
    // colour differs, and only that colour makes grey neutral.
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

}  // namespace aphotic
