// SPDX-License-Identifier: BSD-3-Clause
#include "survey/survey_correction.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/sha256.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <mutex>
#include <system_error>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

fs::path result_of(const SurveyFile& file, const ResultOptions& options) {
    return file.name.string() + (options.format == "tiff" ? ".tif" : "." + options.format);
}

// Samples that the format cannot hold are marked; the writer clips them.
void mark_clipped(CorrectedImage& result) {
    const std::size_t pixels = result.doubts.size();
    for (std::size_t first = 0; first < result.image.samples.size(); first += pixels) {
        for (std::size_t i = 0; i < pixels; ++i) {
            const float sample = result.image.samples[first + i];
            const bool is_clipped = sample < 0.0F || sample > 1.0F;
            result.doubts[i] |= is_clipped ? kClipped : std::uint8_t{0};
        }
    }
}

fs::path mask_of(const SurveyFile& file) {
    return file.name.string() + ".mask.png";
}

// By pixels, for each kind.
Counts doubts_in(const std::vector<std::uint8_t>& doubts) {
    Counts counts;
    for (const auto& [name, bit] : kDoubts) {
        counts[std::string(name)] = static_cast<double>(
            std::ranges::count_if(doubts, [bit = bit](std::uint8_t d) { return (d & bit) != 0; }));
    }
    return counts;
}

// The whole work on an image; what is noted of it.
Counts correct_image(const SurveyFile& file,
                     const Sled& sled,
                     const Survey& survey,
                     const ResultOptions& options,
                     const SurveyGain& gain) {
    SurveyImage taken = read_survey_image(file.source, survey.camera);
    const PlaneSize size = survey.light.size;
    require_size(taken.raw, size.width_px, size.height_px, "as the map has");
    NoiseLimit limit = options.limit;
    limit.read_noise = options.read_noise.value_or(taken.rounding);
    if (!options.limits_noise) limit = {.share = options.limit.share};
    const Correction correction{
        .gain = gain.gain, .middle = gain.middle, .levels = taken.levels, .limit = limit};
    CorrectedImage result = corrected(std::move(taken.raw), survey.light.map(sled), correction);
    if (result.image.mosaic != Mosaic::None && !options.keep_mosaic) result = demosaiced(result);
    const std::vector<std::uint8_t> edges = survey.light.edges(sled, options.edge_px);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        result.doubts[i] |= edges[i] != 0 ? kEdge : std::uint8_t{0};
    }
    if (options.format != "exr") mark_clipped(result);
    make_folder((options.folder / file.name).parent_path());
    if (options.mask) write_mask(options.folder / mask_of(file), result, options.compression);
    write_corrected(
        options.folder / result_of(file, options), result.image, taken, options.compression);
    return doubts_in(result.doubts);
}

// Of the file as it is now. An InputError when it vanished since it was listed: one bad image.
std::string state_of(const fs::path& image) {
    require_file(image);
    std::error_code size_error;
    std::error_code time_error;
    const auto size = fs::file_size(image, size_error);
    const auto time = fs::last_write_time(image, time_error).time_since_epoch().count();
    if (size_error) throw InputError(size_error.message());
    if (time_error) throw InputError(time_error.message());
    return fmt::format("{} {}", size, time);
}

// Of all that an image's result depends on.
std::string digest_of(const SurveyFile& file,
                      const Sled& sled,
                      const std::string& settings_sha256,
                      const SurveyGain& gain) {
    return sha256_of_text(fmt::format("{} {} {} {} {} {}",
                                      settings_sha256,
                                      fmt::join(gain.gain, " "),
                                      sled.altitude_m,
                                      sled.pitch_rad,
                                      sled.roll_rad,
                                      state_of(file.source)));
}

}  // namespace

std::vector<fs::path> results_of(const SurveyFile& file, const ResultOptions& options) {
    std::vector<fs::path> files{result_of(file, options)};
    if (options.mask) files.push_back(mask_of(file));
    return files;
}

Outcome correct_survey(const Survey& survey,
                       const SurveyGain& gain,
                       const ResultOptions& options,
                       const std::string& settings_sha256,
                       Journal& journal) {
    Outcome outcome;
    std::vector<std::string> whys(survey.files.size());
    std::size_t count = 0;
    std::mutex mutex;
    ProgressLine line;
    parallel_for(survey.files.size(), options.jobs, [&](std::size_t i, std::size_t) {
        const SurveyFile& file = survey.files[i];
        const std::string name = file.name.string();
        try {
            const Sled sled = survey.light.pose(file.source);
            const std::string digest = digest_of(file, sled, settings_sha256, gain);
            const std::vector<fs::path> results = results_of(file, options);
            std::unique_lock lock(mutex);
            if (journal.is_done(name, digest, results)) {
                ++outcome.kept;
            } else {
                lock.unlock();
                const Counts doubts = correct_image(file, sled, survey, options, gain);
                lock.lock();
                journal.note(name, digest, results, doubts);
                ++outcome.corrected;
            }
        } catch (const InputError& error) {
            const std::scoped_lock lock(mutex);
            whys[i] = error.what();
            line.wipe();
            print_skipped(file.source, whys[i]);
        }
        const std::scoped_lock lock(mutex);
        ++count;
        line.show(fmt::format("{} of {} images", count, survey.files.size()),
                  static_cast<double>(count) / static_cast<double>(survey.files.size()));
    });
    for (std::size_t i = 0; i < whys.size(); ++i) {
        if (whys[i].empty()) {
            outcome.done.push_back(survey.files[i].name.string());
        } else {
            outcome.skipped.push_back({survey.files[i].source.string(), whys[i]});
        }
    }
    return outcome;
}

}  // namespace aphotic
