// SPDX-License-Identifier: BSD-3-Clause
//
// Work on every image of a survey, some at a time, that can be stopped at any moment and given
// again: what is done is noted in the folder of results as it is done (work_folder.h), and an image
// that cannot be used costs no other.
//
// An image is left as it is when its source (size and time) and all that its result depends on are
// what was noted, and its files are there in the noted size.
#pragma once

#include "base/work_folder.h"
#include "survey/correct/result_files.h"
#include "survey/images/image_files.h"
#include "survey/run_watch.h"

#include <nlohmann/json_fwd.hpp>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace aphotic {

struct ImageRunOptions {
    std::filesystem::path folder;  // of the results
    ResultFormat format;
    std::size_t jobs = std::max(1U, std::thread::hardware_concurrency());
};

// An InputError when two images would have one result, or a result would take the place of one of
// the images.
void require_results_apart(const std::vector<ImageFile>& files, const ImageRunOptions& options);

// Results that shares of the images (base/work_folder.h) left below the folder, taken into it with
// their notes: the run that follows finds them done, and does what no share has. Returns how many
// images it took. A RunError where this machine still works on a share. What stays of the shares'
// folders is what is not ours.
std::size_t join_shares(const std::vector<ImageFile>& files, const ImageRunOptions& options);

// Of the file as it is now: size and time. An InputError when it vanished since it was listed: one
// bad image.
[[nodiscard]] std::string state_of(const std::filesystem::path& image);

// An InputError that these throw is of one image, which is skipped.
struct ImageWork {
    // All that the image's result depends on, the image itself aside.
    std::function<std::string(const ImageFile& file)> inputs;
    // Before the first image that is not done yet, if there is one.
    std::function<void()> prepare = [] {};
    // Reads the image and writes its results; what it counted is noted. Called by several threads.
    std::function<Counts(const ImageFile& file)> make;
    std::vector<std::string> strobes{};  // by whose names dropouts are told
};

struct RunOutcome {
    std::size_t corrected = 0;
    std::size_t kept = 0;
    std::vector<Skipped> skipped;     // in the order of the images
    std::vector<MarkedImage> marked;  // in the order of the images
    Counts counts;                    // of all that are done
    double pixels = 0.0;              // of these

    [[nodiscard]] double doubtful_share(std::string_view doubt) const;
};
[[nodiscard]] nlohmann::ordered_json to_json(const RunOutcome& outcome);

// Of one image, noted with what was counted in it: times that of the reference.
inline constexpr const char* kExposure = "relative_exposure";

// And of one that less than all strobes lit: the share of the light, and bits of those that were
// out.
inline constexpr const char* kLightShare = "light_share";
inline constexpr const char* kStrobesOut = "strobes_out";

// pixels: the sum of what was counted under kPixels.
inline constexpr const char* kPixels = "pixels";
[[nodiscard]] RunOutcome run_images(const std::vector<ImageFile>& files,
                                    const ImageRunOptions& options,
                                    const ImageWork& work,
                                    const RunWatch& watch);

}  // namespace aphotic
