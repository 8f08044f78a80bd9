// SPDX-License-Identifier: BSD-3-Clause
//
// The images of a survey that were taken at one altitude, averaged (average.h) into the pattern of
// light that they share: the source paper's section 3.2.
//
// A mean takes each image once, whatever their number. A median or a trimmed mean needs all samples
// of a place at once: it reads every image once for each band of samples, as many as fit in memory
// of all images.
#pragma once

#include "survey/correct/average.h"
#include "survey/run_watch.h"
#include "survey/survey.h"

#include <nlohmann/json_fwd.hpp>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace aphotic {

inline const std::map<std::string, Average> kAverages{
    {"mean", Average::Mean}, {"median", Average::Median}, {"trimmed", Average::Trimmed}};
[[nodiscard]] std::string name_of(Average average);

struct ObservationOptions {
    double altitude_m = 0.0;
    double within_m = 0.1;  // an image may be off it
    Average average = Average::Mean;
    double trim = 0.1;        // the share of samples that a trimmed mean leaves out at either end
    bool normalise = false;   // divide each image by its own mean first
    bool demosaic = false;    // fill in the channels that a mosaic's sites do not see
    double memory_mb = 1000;  // for the images that a median or a trimmed mean holds at a time
    std::size_t jobs = std::max(1U, std::thread::hardware_concurrency());
};

struct Observation {
    int width_px = 0;
    int height_px = 0;
    // R, G, B; of each the number of images; of each the standard error. NaN: never observed.
    std::vector<float> planes;
    Average average = Average::Mean;
    std::size_t images = 0;
    std::size_t outside = 0;  // of the altitude
    Sled sled;                // the mean; an angle that the navigation does not tell is NaN
    // The root mean square of the standard errors over the mean of the map: what noise is left.
    double relative_error = std::numeric_limits<double>::quiet_NaN();
    std::vector<Skipped> skipped;       // those without light among them
    std::vector<MarkedImage> marked{};  // of less light than the others, left out
    std::vector<Suspicion> looks_wrong;
};

// map_file: where the map was written.
[[nodiscard]] nlohmann::ordered_json to_json(const Observation& observation,
                                             const std::filesystem::path& map_file);

// The survey has a navigation; its light is not asked for. An InputError when no image can be used.
[[nodiscard]] Observation observe(const Survey& survey,
                                  const ObservationOptions& options,
                                  const RunWatch& watch);

// As an EXR with the channels R, G, B, count.R ..., stderr.R ....
void write_observation(const std::filesystem::path& map_file, const Observation& observation);

}  // namespace aphotic
