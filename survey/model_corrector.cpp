// SPDX-License-Identifier: BSD-3-Clause
#include "survey/corrector.h"

#include "base/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace aphotic {

using Json = nlohmann::ordered_json;

namespace {

PerChannel wanted_middle(const Survey& survey, const CorrectionOptions& options) {
    constexpr double kGrey = 0.2;
    if (!options.middle && survey.light.floor_colour) return *survey.light.floor_colour;
    const double middle = options.middle.value_or(kGrey);
    return {middle, middle, middle};
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

// Of a gain by itself nobody knows how much light the survey's middle has.
bool is_middle_known(const CorrectionOptions& options, const SurveyGain& gain) {
    return !gain.images.empty() || options.middle;
}

class ModelCorrector : public Corrector {
  public:
    ModelCorrector(const Survey& survey, const CorrectionOptions& options)
        : survey_(survey), options_(options), given_(given_gain(survey, options, doubts_)) {}

    // Their text, changed, does every image of every folder anew.
    [[nodiscard]] Json settings() const override {
        const LightAt& light = survey_.light;
        Json json{{survey_.navigation ? "rig_sha256" : "map_sha256", light.digest},
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
                  {"rig_scale", nullptr}};
        if (given_)
            json["gain"] = given_->gain;
        else
            json["gain_images"] = options_.gain_images;
        if (options_.read_noise) json["read_noise"] = *options_.read_noise;
        if (const auto& own = light.rig_size)
            json["rig_scale"] = static_cast<double>(light.size.width_px) / own->width_px;
        if (light.has_veil) json["veil"] = *light.has_veil;
        return json;
    }

    // A gain that is kept is not taken again, but the survey is looked at: it may have other images
    // and another navigation by now.
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
        const Sled sled = survey_.sled_of(file);
        return fmt::format("{} {} {}", sled.altitude_m, sled.pitch_rad, sled.roll_rad);
    }

    [[nodiscard]] CorrectedImage correct(SurveyImage& taken, const ImageFile& file) const override {
        const Sled sled = survey_.sled_of(file);
        require_light_for(taken.raw, survey_.light);
        NoiseLimit limit = options_.limit;
        limit.read_noise = options_.read_noise.value_or(taken.rounding);
        if (!is_middle_known(options_, gain_)) limit = {.share = options_.limit.share};
        PerChannel at_exposure = gain_.gain;
        for (double& channel : at_exposure) channel /= taken.exposure;
        const Correction correction{
            .gain = at_exposure, .middle = gain_.middle, .levels = taken.levels, .limit = limit};
        CorrectedImage result =
            corrected(std::move(taken.raw), survey_.light.map(sled), correction);
        if (is_bayer(result.image.mosaic) && !options_.keep_mosaic) result = demosaiced(result);
        const std::vector<std::uint8_t> edges = survey_.light.edges(sled, options_.edge_px);
        for (std::size_t i = 0; i < edges.size(); ++i) {
            result.doubts[i] |= edges[i] != 0 ? kEdge : std::uint8_t{0};
        }
        return result;
    }

  private:
    const Survey& survey_;
    const CorrectionOptions& options_;
    std::vector<Suspicion> doubts_;  // about what is given
    std::optional<SurveyGain> given_;
    SurveyGain gain_;
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

}  // namespace aphotic
