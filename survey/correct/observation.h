// SPDX-License-Identifier: BSD-3-Clause
//
// A survey's images from one altitude, averaged (average.h) into their shared pattern of light: the
// source paper's section 3.2.
//
// A mean reads each image once, whatever their number. A median or a trimmed mean needs all samples
// of a place at once: it reads every image once for each band of samples, as many as fit in memory
// for all images.
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

struct ObservationOptions {
    double altitude_m = 0.0;
    double within_m = 0.1;  // tolerance of an image's altitude
    Average average = Average::Mean;
    double trim = 0.1;        // the share of samples that a trimmed mean omits at either end
    bool normalise = false;   // divide each image by its own mean first
    bool demosaic = false;    // interpolate the channels that a mosaic's sites do not see
    double memory_mb = 1000;  // for the images that a median or a trimmed mean holds at a time
    std::size_t jobs = std::max(1U, std::thread::hardware_concurrency());
};

struct Observation {
    int width_px = 0;
    int height_px = 0;
    // R, G, B; the number of images for each; the standard error of each. NaN: never observed.
    std::vector<float> planes;
    Average average = Average::Mean;
    std::size_t images = 0;
    std::size_t outside = 0;  // images at other altitudes
    Sled sled;                // the mean; an angle missing from the navigation is NaN
    // The root mean square of the standard errors over the mean of the map: the remaining noise.
    double relative_error = std::numeric_limits<double>::quiet_NaN();
    std::vector<Skipped> skipped;       // including those without light
    std::vector<MarkedImage> marked{};  // with less light than the others, omitted
    std::vector<Suspicion> looks_wrong;
};

// map_file: where the map was written.
[[nodiscard]] nlohmann::ordered_json to_json(const Observation& observation,
                                             const std::filesystem::path& map_file);

// The survey needs navigation; its light is not used. An InputError if no image is usable.
[[nodiscard]] Observation observe(const Survey& survey,
                                  const ObservationOptions& options,
                                  const RunWatch& watch);

// As an EXR with the channels R, G, B, count.R ..., stderr.R ....
void write_observation(const std::filesystem::path& map_file, const Observation& observation);

}  // namespace aphotic
