// SPDX-License-Identifier: BSD-3-Clause
#include "survey/first_look.h"

#include "base/error.h"
#include "base/in_order.h"
#include "base/parallel.h"
#include "base/words.h"
#include "image/any_image.h"
#include "image/image_size.h"
#include "image/raw_file.h"
#include "survey/dropout_check.h"
#include "survey/image_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace aphotic {
namespace {

// In the order of the whole file's pattern, as for --bayer.
std::array<double, 4> sites_of_file(const SurveyImage& taken) {
    const std::array<double, 4> medians = site_medians(taken.raw, taken.levels.black);
    std::array<double, 4> of_file{};
    for (int site = 0; site < 4; ++site) {
        const int row = (site / 2 + taken.crop.top_px) % 2;
        const int column = (site % 2 + taken.crop.left_px) % 2;
        of_file[size_of(2 * row + column)] = medians[size_of(site)];
    }
    return of_file;
}

// The appearance in images, veil included.
Lightmap as_signal(Lightmap map) {
    map.samples = signal_of(map);
    map.veil.clear();
    return map;
}

// Whether the file declares its numbers to be for display: a camera's JPEG, or any image whose Exif
// or profile names sRGB. Otherwise it is linear, as raw images are.
bool says_srgb(const std::filesystem::path& file) {
    if (is_raw_name(file)) return false;
    const std::string extension = lower_case(file.extension().string());
    if (extension == ".jpg" || extension == ".jpeg") return true;
    if (extension == ".exr") return false;
    try {
        const auto header = header_of_image(file);
        const auto has = [&](const char* name, std::string_view word) {
            const auto found = header.find(name);
            return found != header.end() && found->second.find(word) != std::string::npos;
        };
        return has("Exif:ColorSpace", "1") || has("ICCProfile:profile_description", "sRGB");
    } catch (const InputError&) {
        return false;
    }
}

// In a unit that is the same for files with the same Exif numbers; empty if there are none.
std::optional<double> stated_exposure(const ShotExposure& shot) {
    if (!shot.time_s && !shot.iso && !shot.f_number) return std::nullopt;
    const double stop = shot.f_number.value_or(1.0);
    return shot.time_s.value_or(1.0) * shot.iso.value_or(1.0) / (stop * stop);
}

ImageLook look_at_image(const ImageFile& file, const Survey& survey, double least_light) {
    ImageLook look;
    look.name = file.name.string();
    const bool has_light = static_cast<bool>(survey.light.map);
    const std::optional<Sled> sled = has_light ? sled_of(survey, file) : std::nullopt;
    const SurveyImage taken = read_survey_image(file.source, survey.camera);
    look.top = top_of(taken.raw, taken.rounding > 0.0);
    look.white = taken.levels.white;
    look.mosaic = shifted(taken.raw.mosaic, taken.crop.left_px, taken.crop.top_px);
    if (is_bayer(look.mosaic)) look.sites = sites_of_file(taken);
    look.cells = light_cells(taken, survey, file);
    if (!has_light) return look;
    require_light_for(taken.raw, survey.light);
    const Lightmap map = as_signal(light_of(survey, file, 0).map);
    if (const auto other = other_depth(survey, file)) {
        const auto like = [&](const Lightmap& one) {
            return likeness(taken.raw, taken.levels, map, as_signal(one));
        };
        look.depth_m = other->depth_m;
        if (other->by_other_convention)
            look.as_other_convention = like(*other->by_other_convention);
        if (other->plane) look.as_plane = like(*other->plane);
        look.altitude_m = look.depth_m;
    }
    if (survey.navigation && sled) look.altitude_m = sled->altitude_m;
    look.quotient = middle_quotient(taken.raw, map, taken.levels, least_light);
    for (double& quotient : look.quotient) quotient /= taken.exposure;
    look.map_mean = means_of(map);
    look.frame = frame_look(taken.raw, taken.levels, map);
    look.says_srgb = says_srgb(file.source);
    if (taken.tags) look.stated_exposure = stated_exposure(exposure_of(*taken.tags));
    if (const auto other =
            survey.light.map_as_radians ? survey.light.map_as_radians(*sled) : std::nullopt) {
        look.as_radians = likeness(taken.raw, taken.levels, map, as_signal(*other));
    }
    return look;
}

// Learns how the images differ, and omits those that lack light; with one exposure per image,
// brings the rest to a common one.
void judge_looks(const Survey& survey, SurveyLook& look) {
    const bool has_levels = survey.camera.exposure_by == ExposureBy::Model;
    if (survey.dropouts == Dropouts::Ignore && !has_levels) return;
    std::vector<LightCells> cells;
    for (const ImageLook& one : look.images) cells.push_back(one.cells);
    look.scales = learned(cells, has_levels);
    look.doubt = doubt_of_rig(cells, survey, look.scales);
    std::vector<ImageLook> lit;
    for (ImageLook& one : look.images) {
        const Dropout found = judged(one.cells, look.scales);
        if (found.is_any() && survey.dropouts != Dropouts::Ignore) continue;
        one.level = found.level;
        if (has_levels)
            for (double& quotient : one.quotient) quotient /= std::exp(found.level);
        lit.push_back(std::move(one));
    }
    look.images = std::move(lit);
}

// Of more images of a large survey, the chance level of a fixed pattern is lower.
std::vector<LightCells> cells_of_more(const Survey& survey,
                                      const LookRequest& request,
                                      const RunWatch& watch) {
    const std::size_t files = survey.files.size();
    const auto share = static_cast<std::size_t>(kPatternShare * static_cast<double>(files));
    const std::size_t count =
        share > request.most_images ? std::min(share, kMostPatternImages) : std::size_t{0};
    std::vector<LightCells> cells;
    in_order(
        count,
        static_cast<int>(request.jobs),
        [&](std::size_t i) {
            const ImageFile& file = survey.files[i * files / count];
            const SurveyImage taken = read_survey_image(file.source, survey.camera);
            require_light_for(taken.raw, survey.light);
            return light_cells(taken, survey, file);
        },
        [&](std::size_t i, LightCells one) {
            cells.push_back(std::move(one));
            watch.progress("looking for a fixed pattern",
                           static_cast<double>(i + 1) / static_cast<double>(count));
        },
        // The image is reported when its turn comes.
        [](std::size_t, const std::string&) {});
    return cells;
}

FixedPattern pattern_of(std::span<const ImageLook> looks,
                        std::vector<LightCells> more,
                        const DropoutScales& scales) {
    std::erase_if(more, [&](const LightCells& one) {
        const Dropout found = judged(one, scales);
        return found.is_dark || found.is_any();
    });
    if (more.size() < looks.size()) {
        more.clear();
        for (const ImageLook& look : looks) more.push_back(look.cells);
    }
    if (more.size() < kEnoughImages) return {};
    std::vector<std::vector<float>> residuals;
    for (const LightCells& cells : more) {
        const CellPlane residual = residual_of(cells);
        residuals.emplace_back(residual.begin(), residual.end());
    }
    return fixed_pattern(residuals, size_of(more.front().side));
}

// The files to examine, in order, and whether each contributes to the gain.
struct Choice {
    std::size_t file = 0;
    bool is_for_gain = false;
};

std::vector<Choice> chosen(std::size_t files, const LookRequest& request) {
    std::map<std::size_t, bool> chosen;
    const auto spread = [&](std::size_t most, bool is_for_gain) {
        const std::size_t count = std::min(most, files);
        for (std::size_t i = 0; i < count; ++i) chosen[i * files / count] = is_for_gain;
    };
    if (request.gain_images < request.most_images) spread(request.most_images, false);
    spread(request.gain_images, true);
    std::vector<Choice> choices;
    for (const auto& [file, is_for_gain] : chosen) choices.push_back({file, is_for_gain});
    return choices;
}

}  // namespace

SurveyLook look_at(const Survey& survey, const LookRequest& request, const RunWatch& watch) {
    LookRequest wanted = request;
    // In a few images, floor patterns hide the tilts.
    if (survey.light.map_as_radians) wanted.most_images *= 2;
    const std::vector<Choice> choices = chosen(survey.files.size(), wanted);
    std::vector<std::optional<ImageLook>> looks(choices.size());
    std::vector<std::string> whys(choices.size());
    std::size_t count = 0;
    std::mutex mutex;
    parallel_for(choices.size(), request.jobs, [&](std::size_t i, std::size_t) {
        try {
            looks[i] = look_at_image(survey.files[choices[i].file], survey, request.least_light);
            looks[i]->is_for_gain = choices[i].is_for_gain;
        } catch (const InputError& error) {
            whys[i] = error.what();  // the image is reported when its turn comes, if it does
        }
        const std::scoped_lock lock(mutex);
        watch.progress("examining the survey",
                       static_cast<double>(++count) / static_cast<double>(choices.size()));
    });
    SurveyLook result{.count = choices.size()};
    for (std::size_t i = 0; i < choices.size(); ++i) {
        if (looks[i]) {
            result.images.push_back(std::move(*looks[i]));
        } else if (result.first_why.empty()) {
            result.first_why =
                fmt::format("{}: {}", survey.files[choices[i].file].name.string(), whys[i]);
        }
    }
    judge_looks(survey, result);
    if (survey.light.map)
        result.pattern =
            pattern_of(result.images, cells_of_more(survey, wanted, watch), result.scales);
    return result;
}

std::string SurveyLook::none_can_be(std::string_view done) const {
    return count == 1 ? fmt::format("the only image examined cannot be {}; {}", done, first_why)
                      : fmt::format(
                            "none of the {} images examined can be {}; {}", count, done, first_why);
}

std::vector<Suspicion> suspicions_of(const std::optional<Navigation>& navigation) {
    std::vector<Suspicion> found;
    if (!navigation) return found;
    for (const std::string& warning : navigation->warnings())
        found.push_back({.about = std::string(kAboutNavigation), .what = warning});
    return found;
}

std::vector<Suspicion> suspicions_of(const std::vector<ImageFile>& files,
                                     const CameraNumbers& camera,
                                     const std::optional<Navigation>& navigation,
                                     std::size_t jobs,
                                     const RunWatch& watch,
                                     DropoutScales* scales) {
    const SurveyLook look = look_at({.files = files, .camera = camera}, {.jobs = jobs}, watch);
    if (look.images.empty() && look.count > 0) {
        throw InputError("{}", look.none_can_be("read"));
    }
    if (scales != nullptr) *scales = look.scales;
    std::vector<Suspicion> found = suspicions_of(navigation);
    std::ranges::move(suspicions(look.images, mosaic_of(look.images)), std::back_inserter(found));
    watch.looks_wrong(found);
    return found;
}

}  // namespace aphotic
