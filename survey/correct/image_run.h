// SPDX-License-Identifier: BSD-3-Clause
//
// Work on every image of a survey, several at a time, which can be interrupted at any moment and
// restarted: finished images are recorded in the folder of results (work_folder.h), and an unusable
// image does not affect the others.
//
// An image is left unchanged if its source (size and time) and everything that its result depends
// on are as recorded, and its files exist in the recorded size.
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

// An InputError if two images would have one result, or if a result would overwrite one of the
// images.
void require_results_apart(const std::vector<ImageFile>& files, const ImageRunOptions& options);

// Moves results that shares of the images (base/work_folder.h) left below the folder into it, with
// their notes: the next run treats them as done, and does the remaining ones. Returns the number of
// images moved. A RunError if this machine is still working on a share. Other files stay in the
// shares' folders.
std::size_t join_shares(const std::vector<ImageFile>& files, const ImageRunOptions& options);

// The file's current size and time. An InputError if it vanished since it was listed: one bad
// image.
[[nodiscard]] std::string state_of(const std::filesystem::path& image);

// An InputError thrown by these concerns one image, which is skipped.
struct ImageWork {
    // Everything that the image's result depends on, except the image itself.
    std::function<std::string(const ImageFile& file)> inputs;
    // Called before the first unfinished image, if any.
    std::function<void()> prepare = [] {};
    // Reads the image and writes its results; its counts are recorded. Called from several threads.
    std::function<Counts(const ImageFile& file)> make;
    std::vector<std::string> strobes{};  // names for reporting dropouts
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

// Recorded with an image's counts: its exposure relative to the reference.
inline constexpr const char* kExposure = "relative_exposure";

// For a dropout also: the share of the light, and bits of the strobes that were out.
inline constexpr const char* kLightShare = "light_share";
inline constexpr const char* kStrobesOut = "strobes_out";

// pixels: the sum of what was counted under kPixels.
inline constexpr const char* kPixels = "pixels";
[[nodiscard]] RunOutcome run_images(const std::vector<ImageFile>& files,
                                    const ImageRunOptions& options,
                                    const ImageWork& work,
                                    const RunWatch& watch);

}  // namespace aphotic
