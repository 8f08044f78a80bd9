// SPDX-License-Identifier: BSD-3-Clause
//
// Corrects a survey's images by a model of their light (correction.h), or by one of the baselines
// (baseline.h), for comparison. Both learn from the survey, then correct image by image;
// correction_run.h applies it to all images.
//
// The model learns its gain from some images. A baseline that learns reads the whole survey before
// it corrects the first image, and again if an image is added, changed or removed: its pattern then
// differs, and all images are corrected again.
//
// Results of a baseline:
//
//   exr        the camera's own numbers less the black level
//   tiff, png  the same as a share of the white level less the black level
//
// Its masks mark saturated, black and clipped pixels. A mosaic's other channels are interpolated
// after the correction.
#pragma once

#include "base/work_folder.h"
#include "survey/correct/baseline.h"
#include "survey/correct/image_run.h"
#include "survey/correction.h"
#include "survey/first_look.h"
#include "survey/survey.h"

#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// The gain of a survey: one number per channel, with which its median becomes the requested value
// (correction.h). A folder keeps its gain while its settings stay, so that later images match the
// others.

struct SurveyGain {
    PerChannel gain{};
    PerChannel middle{};
    std::vector<std::string> images{};  // from which it was derived; empty if it was given
    std::string folder{};               // from which it was taken; empty: this survey's own
};

// The median of the middle quotients of the images examined. An InputError if there is none.
[[nodiscard]] SurveyGain measured_gain(const SurveyLook& look, const PerChannel& middle);

// The gain in the text of a folder's correction.json. Empty if the text has other settings, or is
// not as correct_survey() wrote it, such as a gain that is not a finite number above 0. Empty also
// for a survey that looked wrong, since it may have been repaired.
[[nodiscard]] std::optional<SurveyGain> kept_gain(std::string_view text,
                                                  const nlohmann::ordered_json& settings);

// The gain and the middle of another survey, from the correction.json in its folder of results, for
// a survey in this light: dives with one gain can be compared. An InputError if there is none, or
// if it is from another camera. Other differences are added to the doubts.
[[nodiscard]] SurveyGain gain_of_folder(const std::filesystem::path& folder,
                                        const LightAt& light,
                                        const CameraNumbers& camera,
                                        std::vector<Suspicion>& doubts);
// The same from the text of that file.
[[nodiscard]] SurveyGain gain_of_notes(std::string_view text,
                                       const std::string& folder,
                                       const LightAt& light,
                                       const CameraNumbers& camera,
                                       std::vector<Suspicion>& doubts);

// The channel factors that make the median of some of the survey's images, evenly spread over its
// files, grey; 1 if none has light in every channel.
[[nodiscard]] PerChannel grey_balance(const Survey& survey, double grey, std::size_t jobs);

// The balance in the text of a folder's baseline.json. Empty if the text has other settings, or no
// numbers above 0.
[[nodiscard]] std::optional<PerChannel> kept_balance(std::string_view text,
                                                     const nlohmann::ordered_json& settings);

struct CorrectionOptions {
    ImageRunOptions run{};  // for a share of the images, its own folder
    WorkShare share{};      // of the images to correct; learning uses all
    bool report = false;    // also write report.html (correction_page.h)

    std::optional<Baseline> baseline{};  // empty: the model
    BaselineOptions of_baselines{};

    // For the model.
    std::vector<double> gain{};  // one for all channels, or three; empty: derived from the survey
    std::filesystem::path gain_from{};  // a folder of results to take it from; empty: none
    std::optional<double> middle{};     // empty: the floor's colour, or grey if it is unknown
    std::size_t gain_images = 16;
    NoiseLimit limit{};
    std::optional<double> read_noise{};  // empty: the rounding of the file's numbers
    bool keep_mosaic = false;
    int edge_px = 2;
};

struct CorrectionReport {
    std::string_view baseline{};  // its name; empty: the model
    std::string folder;
    nlohmann::ordered_json settings;
    std::string settings_sha256{};
    SurveyGain gain{};                   // of the model
    std::optional<SrgbEncoding> srgb{};  // empty: linear only
    std::vector<ImageLook> looks{};      // for the model: images examined before correction
    std::vector<Suspicion> looks_wrong{};
    FixedPattern pattern{};           // of the same images, by cells (dropouts.h)
    std::string not_checked{};        // what was not checked, and why; or empty
    std::optional<RunOutcome> run{};  // empty: the run has not ended
    double seconds = 0.0;
};

class Corrector {
  public:
    Corrector() = default;
    Corrector(const Corrector&) = delete;
    Corrector& operator=(const Corrector&) = delete;
    virtual ~Corrector() = default;

    // Everything that results depend on, except images, poses, the camera, formats and what is
    // learned.
    [[nodiscard]] virtual nlohmann::ordered_json settings() const = 0;

    // Before anything is written: examines some images, reports to the watch what looks wrong, and
    // completes the report, which already has its settings. earlier: the notes of the previous run
    // in this folder, or empty; with the same settings, what was learned then is still valid.
    virtual void look(const std::string& earlier,
                      const RunWatch& watch,
                      CorrectionReport& report) = 0;

    // What was learned, or the inputs to it; and an image's pose as far as it matters. An
    // InputError for an image without one.
    [[nodiscard]] virtual std::string learned() const = 0;
    [[nodiscard]] virtual std::string pose_of(const ImageFile& file) const = 0;

    // Called before the first image to be corrected, if any.
    virtual void learn(const RunWatch& /*watch*/) {}

    // Whether the strobes fired (survey/dropout_check.h): recorded in the image. An InputError for
    // an image without light.
    virtual void judge(SurveyImage& taken, const ImageFile& file) const = 0;

    // Takes the raw image after that check. Called from several threads; an InputError concerns
    // this image only.
    [[nodiscard]] virtual CorrectedImage correct(SurveyImage& taken,
                                                 const ImageFile& file) const = 0;

    // The divisor of samples if the format's range ends at 1.
    [[nodiscard]] virtual float white_of(const SurveyImage& /*taken*/) const { return 1.0F; }
};

// Both hold references to the survey and the options, which must outlive them. An InputError for
// gains that are not one or three numbers, or that are missing from the other survey's folder; or
// for a baseline that needs altitudes and a survey without navigation.
[[nodiscard]] std::unique_ptr<Corrector> model_corrector(const Survey& survey,
                                                         const CorrectionOptions& options);
[[nodiscard]] std::unique_ptr<Corrector> baseline_corrector(const Survey& survey,
                                                            const CorrectionOptions& options);

// How images corrected by the model are shown, whether or not they are also written that way.
[[nodiscard]] SrgbEncoding shown_as(const Survey& survey,
                                    const CorrectionOptions& options,
                                    const SurveyGain& gain);

}  // namespace aphotic
