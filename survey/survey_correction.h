// SPDX-License-Identifier: BSD-3-Clause
//
// A survey's images, each divided by the map of its own light and written. What is done is noted
// as it is done, and an image that cannot be corrected costs no other.
#pragma once

#include "survey/journal.h"
#include "survey/survey_gain.h"
#include "survey/survey_image.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace aphotic {

inline constexpr std::array<std::pair<std::string_view, std::uint8_t>, 5> kDoubts{
    {{"dark", kDark},
     {"saturated", kSaturated},
     {"black", kBlack},
     {"edge", kEdge},
     {"clipped", kClipped}}};

struct ResultOptions {
    std::filesystem::path folder;
    NoiseLimit limit;
    std::optional<double> read_noise;  // none: what the file's numbers are rounded by
    // Of a gain by itself nobody knows how much light the survey's middle has.
    bool limits_noise = true;
    bool keep_mosaic = false;
    int edge_px = 2;
    bool mask = false;
    std::string format = "tiff";
    Compression compression = Compression::Fast;
    std::size_t jobs = std::max(1U, std::thread::hardware_concurrency());
};

// The files that are made of an image, below the folder.
[[nodiscard]] std::vector<std::filesystem::path> results_of(const SurveyFile& file,
                                                            const ResultOptions& options);

struct Outcome {
    std::size_t corrected = 0;
    std::size_t kept = 0;
    std::vector<Skipped> skipped;  // in the order of the images
    std::vector<std::string> done;
};

// settings_sha256 stands for all that the results depend on, images, poses and gain aside. Each of
// options.jobs threads holds one image, its map and its result.
[[nodiscard]] Outcome correct_survey(const Survey& survey,
                                     const SurveyGain& gain,
                                     const ResultOptions& options,
                                     const std::string& settings_sha256,
                                     Journal& journal);

}  // namespace aphotic
