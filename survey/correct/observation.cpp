// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/observation.h"

#include "base/degrees.h"
#include "base/error.h"
#include "base/in_order.h"
#include "base/offered.h"
#include "base/words.h"
#include "image/exr.h"
#include "survey/dropout_check.h"
#include "survey/first_look.h"
#include "survey/image_light.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

namespace aphotic {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

struct ChosenImage {
    ImageFile file;
    Sled sled;
    bool is_bad = false;
    LightCells cells{};  // of the first pass
};

// The image ready for averaging, and the cells of the original.
struct ReadImage {
    RawImage raw;
    LightCells cells;
};

// The images at the altitude, and the reasons for omitting the others.
struct Selection {
    std::vector<ChosenImage> images;
    std::size_t outside = 0;
    double nearest_m = std::numeric_limits<double>::infinity();  // to the altitude, outside
    std::vector<Skipped> skipped;
};

Selection selected(const Survey& survey, const ObservationOptions& options) {
    constexpr double kRounding_m = 1e-9;  // 2.1 lies within 0.1 of 2
    const GivenAngles known = survey.navigation->known();
    Selection selection;
    for (const ImageFile& file : survey.files) {
        try {
            Sled sled = survey.sled_of(file);
            if (!known.pitch) sled.pitch_rad = kNotKnown;
            if (!known.roll) sled.roll_rad = kNotKnown;
            const double off_m = std::abs(sled.altitude_m - options.altitude_m);
            if (off_m > options.within_m + kRounding_m) {
                ++selection.outside;
                selection.nearest_m = std::min(selection.nearest_m, off_m - 0.5 * kRounding_m);
            } else {
                selection.images.push_back({.file = file, .sled = sled});
            }
        } catch (const InputError& error) {
            selection.skipped.push_back({.image = file.source.string(), .why = error.what()});
        }
    }
    return selection;
}

// Goes through the images in order, and drops unusable ones from the selection.
struct Pass {
    const Survey& survey;
    const ObservationOptions& options;
    const RunWatch& watch;
    Selection& selection;
    RawImage like{};  // the first image's size and mosaic, without its samples

    // use(image); from, to: the progress over all passes at this one's beginning and end.
    template <typename Use>
    void run(const Use& use, double from, double to) {
        std::vector<ChosenImage>& images = selection.images;
        in_order(
            images.size(),
            static_cast<int>(options.jobs),
            [&](std::size_t i) { return read(images[i].file); },
            [&](std::size_t i, const ReadImage& read) {
                const RawImage& image = read.raw;
                if (like.width_px == 0) {
                    like = {.width_px = image.width_px,
                            .height_px = image.height_px,
                            .mosaic = image.mosaic};
                }
                require_like(image, like, "like the first image");
                use(image);
                images[i].cells = read.cells;
                const auto done = static_cast<double>(i + 1) / static_cast<double>(images.size());
                watch.progress("averaging", from + (to - from) * done);
            },
            [&](std::size_t i, const std::string& why) {
                selection.skipped.push_back({.image = images[i].file.source.string(), .why = why});
                images[i].is_bad = true;
            });
        std::erase_if(images, [](const ChosenImage& image) { return image.is_bad; });
    }

    // Omits pixels whose own depth is unknown or not at the altitude.
    void leave_out_relief(const ImageFile& file, RawImage& raw) const {
        const DepthMap map = depth_map_of(survey, file, {raw.width_px, raw.height_px});
        for (std::size_t i = 0; i < raw.samples.size(); ++i) {
            const double off_m = std::abs(static_cast<double>(map.depth_m[i % map.depth_m.size()]) -
                                          options.altitude_m);
            if (!(off_m <= options.within_m))
                raw.samples[i] = std::numeric_limits<float>::quiet_NaN();
        }
    }

    [[nodiscard]] ReadImage read(const ImageFile& file) const {
        SurveyImage taken = read_survey_image(file.source, survey.camera);
        LightCells cells = light_cells(taken, {}, file);
        take_off_black(taken);
        if (std::ranges::any_of(taken.raw.samples, [](float s) { return std::isinf(s); }))
            throw InputError("a sample is infinite");
        if (options.normalise) divide_by_own_mean(taken.raw);
        if (survey.depth) leave_out_relief(file, taken.raw);
        return {.raw = std::move(taken.raw), .cells = std::move(cells)};
    }
};

// Drops images with less light than the others, by their level, after a pass has read all; returns
// their number.
std::size_t drop_unlit(const Survey& survey, Selection& selection, Observation& observation) {
    if (survey.dropouts == Dropouts::Ignore) return 0;
    std::vector<LightCells> cells;
    for (const ChosenImage& image : selection.images) cells.push_back(image.cells);
    const DropoutScales scales = learned(cells);
    return std::erase_if(selection.images, [&](const ChosenImage& image) {
        const Dropout found = judged(image.cells, scales);
        const std::string name = image.file.source.string();
        if (found.is_dark) {
            selection.skipped.push_back({.image = name, .why = why_dark(found)});
        } else if (found.is_any()) {
            observation.marked.push_back({.image = name, .share = found.share});
        }
        return found.is_any();
    });
}

// Repeated if a first pass finds images to be dropped.
template <typename Drop>
Observed running_mean(Pass& pass, const Drop& drop) {
    std::optional<RunningMean> mean;
    const auto run = [&] {
        mean.reset();
        pass.run(
            [&](const RawImage& image) {
                if (!mean) mean.emplace(image.samples.size());
                mean->add(image.samples);
            },
            0.0,
            1.0);
    };
    run();
    if (drop() > 0) run();
    return mean ? mean->observed() : Observed{};
}

void append(std::vector<float>& to, const std::vector<float>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

// A first pass finds which images are usable.
template <typename Drop>
Observed average_by_bands(Pass& pass,
                          Selection& selection,
                          const ObservationOptions& options,
                          const Drop& drop) {
    constexpr double kFirstPass = 0.1;
    std::size_t samples = 0;
    pass.run([&](const RawImage& image) { samples = image.samples.size(); }, 0.0, kFirstPass);
    drop();
    const std::size_t band = samples_in_memory(selection.images.size(), options.memory_mb);
    const auto share = [&](std::size_t at) {
        return kFirstPass +
               (1.0 - kFirstPass) * static_cast<double>(at) / static_cast<double>(samples);
    };
    Observed observed;
    for (std::size_t first = 0; first < samples; first += band) {
        const std::size_t many = std::min(band, samples - first);
        std::vector<std::vector<float>> images;
        const std::size_t skipped = selection.skipped.size();
        pass.run(
            [&](const RawImage& image) {
                const auto from = image.samples.begin() + static_cast<std::ptrdiff_t>(first);
                images.emplace_back(from, from + static_cast<std::ptrdiff_t>(many));
            },
            share(first),
            share(first + many));
        if (selection.skipped.size() > skipped) {
            throw RunError("{}: changed while being read: {}",
                           selection.skipped.back().image,
                           selection.skipped.back().why);
        }
        const Observed part =
            average_of(images, options.average, options.trim, static_cast<int>(options.jobs));
        append(observed.average, part.average);
        append(observed.standard_error, part.standard_error);
        append(observed.count, part.count);
    }
    return observed;
}

void require_images(const Selection& selection, const ObservationOptions& options) {
    if (!selection.images.empty()) return;
    const std::string others = selection.outside > 0 ? fmt::format("; the nearest is {} m off",
                                                                   at_least(selection.nearest_m))
                                                     : "";
    const std::string first = selection.skipped.empty()
                                  ? ""
                                  : fmt::format("; skipped: {}, the first: {}: {}",
                                                selection.skipped.size(),
                                                selection.skipped.front().image,
                                                selection.skipped.front().why);
    throw InputError("no usable image within {} m of {} m{}{}",
                     options.within_m,
                     options.altitude_m,
                     others,
                     first);
}

Sled mean_sled(const std::vector<ChosenImage>& images) {
    Sled mean;
    const auto count = static_cast<double>(images.size());
    for (const ChosenImage& image : images) {
        mean.altitude_m += image.sled.altitude_m / count;
        mean.pitch_rad += image.sled.pitch_rad / count;
        mean.roll_rad += image.sled.roll_rad / count;
    }
    return mean;
}

double noise_of(const Observed& observed) {
    double squares = 0.0;
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < observed.average.size(); ++i) {
        if (std::isnan(observed.standard_error[i])) continue;
        squares += std::pow(observed.standard_error[i], 2.0);
        sum += observed.average[i];
        count += 1.0;
    }
    return count > 0.0 ? std::sqrt(squares / count) / (sum / count) : kNotKnown;
}

std::vector<float> planes_of(const Observed& observed, const RawImage& like, bool is_demosaiced) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> planes =
        is_demosaiced && is_bayer(like.mosaic)
            ? demosaiced(observed.average, like.width_px, like.height_px, like.mosaic)
            : by_channel(observed.average, like, kNone);
    append(planes, by_channel(observed.count, like, 0.0F));
    append(planes, by_channel(observed.standard_error, like, kNone));
    return planes;
}

}  // namespace

Observation observe(const Survey& survey,
                    const ObservationOptions& options,
                    const RunWatch& watch) {
    Selection selection = selected(survey, options);
    Observation observation;
    observation.average = options.average;
    std::vector<ImageFile> files;
    for (const ChosenImage& image : selection.images) files.push_back(image.file);
    observation.looks_wrong =
        suspicions_of(files, survey.camera, survey.navigation, options.jobs, watch);
    Pass pass{survey, options, watch, selection};
    const auto drop = [&] { return drop_unlit(survey, selection, observation); };
    const Observed observed = options.average == Average::Mean
                                  ? running_mean(pass, drop)
                                  : average_by_bands(pass, selection, options, drop);
    for (const Skipped& one : selection.skipped) watch.skipped(one);
    for (const MarkedImage& one : observation.marked) watch.marked(one);
    require_images(selection, options);
    observation.width_px = pass.like.width_px;
    observation.height_px = pass.like.height_px;
    observation.planes = planes_of(observed, pass.like, options.demosaic);
    observation.images = selection.images.size();
    observation.outside = selection.outside;
    observation.sled = mean_sled(selection.images);
    observation.relative_error = noise_of(observed);
    observation.skipped = std::move(selection.skipped);
    return observation;
}

nlohmann::ordered_json to_json(const Observation& observation,
                               const std::filesystem::path& map_file) {
    return {{"map", map_file.string()},
            {"average", name_of(kAverages, observation.average)},
            {"images", observation.images},
            {"outside", observation.outside},
            {"altitude_m", observation.sled.altitude_m},
            {"pitch_deg", observation.sled.pitch_rad / kRadiansPerDegree},
            {"roll_deg", observation.sled.roll_rad / kRadiansPerDegree},
            {"relative_error", observation.relative_error},
            {"skipped", to_json(observation.skipped)},
            {"dropouts", to_json(observation.marked)},
            {"looks_wrong", to_json(observation.looks_wrong)}};
}

void write_observation(const std::filesystem::path& map_file, const Observation& observation) {
    std::vector<std::string> channels;
    for (const std::string_view prefix : {"", "count.", "stderr."}) {
        for (const std::string_view name : kChannelNames)
            channels.push_back(fmt::format("{}{}", prefix, name));
    }
    const Sled& sled = observation.sled;
    write_exr(map_file,
              observation.width_px,
              observation.height_px,
              std::move(channels),
              observation.planes,
              {{"aphotic:version", APHOTIC_VERSION},
               {"aphotic:average", name_of(kAverages, observation.average)},
               {"aphotic:images", fmt::format("{}", observation.images)},
               {"aphotic:altitude_m", fmt::format("{}", sled.altitude_m)},
               {"aphotic:pitch_deg", fmt::format("{}", sled.pitch_rad / kRadiansPerDegree)},
               {"aphotic:roll_deg", fmt::format("{}", sled.roll_rad / kRadiansPerDegree)}});
}

}  // namespace aphotic
