// SPDX-License-Identifier: BSD-3-Clause
//
// What corrects a survey's images: by a model of their light (correction.h), or without one, by one
// of the ways of baseline.h, for comparison. Both learn from the survey, then correct image by
// image; correction_run.h does the work on all of them.
//
// The model learns its gain from some images. A baseline that learns reads the whole
// survey before it corrects the first image, and again when an image comes, changes or goes: its
// pattern is another one then, and all images are corrected anew.
//
// What comes of a baseline:
//
//   exr        the camera's own numbers less the black level
//   tiff, png  the same as a share of the white level less the black level
//
// Its masks know saturated, black and clipped pixels. A mosaic's other channels are filled in after
// the correction.
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

// The gain of a survey: one number a channel, with which its middle comes out as asked
// (correction.h). A folder keeps its gain while its settings stay, so that images that come later
// fit the others.

struct SurveyGain {
    PerChannel gain{};
    PerChannel middle{};
    std::vector<std::string> images{};  // that it was taken from; none when it was given
    std::string folder{};               // whose gain it is; empty: this survey's own
};

// The median of the middle quotients of the images that were looked at. An InputError when there is
// none.
[[nodiscard]] SurveyGain measured_gain(const SurveyLook& look, const PerChannel& middle);

// The gain that the text of a folder's correction.json tells of. None when the text is of other
// settings, or not as correct_survey() wrote it: a gain that is no finite number above 0 among it.
// Nor of a survey that looked wrong: it may be mended since.
[[nodiscard]] std::optional<SurveyGain> kept_gain(std::string_view text,
                                                  const nlohmann::ordered_json& settings);

// The gain and the middle of another survey, from the correction.json in its folder of results, for
// a survey in this light: dives that share one gain can be compared. An InputError when there is
// none, or when it is of another camera. What else differs is added to the doubts.
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

// What scales the camera's channels so that the median of some of the survey's images, in its files
// evenly spread, is grey; 1 where none has light in every channel.
[[nodiscard]] PerChannel grey_balance(const Survey& survey, double grey, std::size_t jobs);

// The balance that the text of a folder's baseline.json tells of. None when the text is of other
// settings, or no numbers over 0.
[[nodiscard]] std::optional<PerChannel> kept_balance(std::string_view text,
                                                     const nlohmann::ordered_json& settings);

struct CorrectionOptions {
    ImageRunOptions run{};  // of a share: its own folder
    WorkShare share{};      // of the images that are corrected; what is learned is of all
    bool report = false;    // also write report.html, a page to look at (correction_page.h)

    std::optional<Baseline> baseline{};  // none: by the model
    BaselineOptions of_baselines{};

    // Of the model.
    std::vector<double> gain{};  // one for all channels, or three; none: taken from the survey
    std::filesystem::path gain_from{};  // a folder of results that has one; empty: none
    std::optional<double> middle{};     // none: the floor's colour, grey where nobody knows it
    std::size_t gain_images = 16;
    NoiseLimit limit{};
    std::optional<double> read_noise{};  // none: what the file's numbers are rounded by
    bool keep_mosaic = false;
    int edge_px = 2;
};

struct CorrectionReport {
    std::string_view baseline{};  // its name; empty: by the model
    std::string folder;
    nlohmann::ordered_json settings;
    std::string settings_sha256{};
    SurveyGain gain{};                   // of the model
    std::optional<SrgbEncoding> srgb{};  // none: linear alone
    std::vector<ImageLook> looks{};      // of the model: at images before the first was corrected
    std::vector<Suspicion> looks_wrong{};
    std::string not_checked{};        // and why; or empty
    std::optional<RunOutcome> run{};  // none: it has not ended
    double seconds = 0.0;
};

class Corrector {
  public:
    Corrector() = default;
    Corrector(const Corrector&) = delete;
    Corrector& operator=(const Corrector&) = delete;
    virtual ~Corrector() = default;

    // All that results depend on, but for images, poses, the camera, formats and what is learned.
    [[nodiscard]] virtual nlohmann::ordered_json settings() const = 0;

    // Before anything is written: looks at some images, tells the watch what looks wrong, and
    // completes the report, whose settings are there. earlier: the notes of the run before in this
    // folder, or empty; of the same settings, what was learned then still holds.
    virtual void look(const std::string& earlier,
                      const RunWatch& watch,
                      CorrectionReport& report) = 0;

    // What was learned, or from what; and of an image, its pose as far as it matters. An InputError
    // of that one image where it has none.
    [[nodiscard]] virtual std::string learned() const = 0;
    [[nodiscard]] virtual std::string pose_of(const ImageFile& file) const = 0;

    // Before the first image that is to be corrected, if there is one.
    virtual void learn(const RunWatch& /*watch*/) {}

    // Whether the strobes fired (survey/dropout_check.h): noted in the image. An InputError of one
    // without light.
    virtual void judge(SurveyImage& taken, const ImageFile& file) const = 0;

    // Takes the raw image, judged. Called by several threads; an InputError is of this one image.
    [[nodiscard]] virtual CorrectedImage correct(SurveyImage& taken,
                                                 const ImageFile& file) const = 0;

    // What a sample is divided by where the format ends at 1.
    [[nodiscard]] virtual float white_of(const SurveyImage& /*taken*/) const { return 1.0F; }
};

// Both hold the survey and the options, which outlive them. The InputErrors: of gains that are not
// one or three numbers, or that the other survey's folder does not tell; of a baseline that needs
// altitudes and a survey without navigation.
[[nodiscard]] std::unique_ptr<Corrector> model_corrector(const Survey& survey,
                                                         const CorrectionOptions& options);
[[nodiscard]] std::unique_ptr<Corrector> baseline_corrector(const Survey& survey,
                                                            const CorrectionOptions& options);

// How images that the model corrected are shown, whether or not they are also written so.
[[nodiscard]] SrgbEncoding shown_as(const Survey& survey,
                                    const CorrectionOptions& options,
                                    const SurveyGain& gain);

}  // namespace aphotic
