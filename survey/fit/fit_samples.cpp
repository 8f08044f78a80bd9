// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_samples.h"

#include "base/degrees.h"
#include "base/error.h"
#include "base/in_order.h"
#include "base/number.h"
#include "base/upper_median.h"
#include "image/exr.h"
#include "survey/dropout_check.h"
#include "survey/first_look.h"
#include "survey/fit/block_planes.h"
#include "survey/image_light.h"
#include "survey/images/survey_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace aphotic {
namespace {

// Of one block and channel.
struct Mean {
    double sum = 0.0;
    std::size_t count = 0;
    std::size_t saturated = 0;
    std::size_t sites = 0;

    [[nodiscard]] float signal() const {
        const auto all = static_cast<double>(sites);
        const bool is_told = count > 0 && 2 * count >= sites &&
                             static_cast<double>(saturated) <= kMostSaturated * all;
        return is_told ? static_cast<float>(sum / static_cast<double>(count))
                       : std::numeric_limits<float>::quiet_NaN();
    }
};

// Colours at every pixel: the sites of a mosaic's colours are half a pixel off the middle of a
// block, to either side, which would bias the mean of a slope.
RawImage of_all_colours(const RawImage& raw) {
    if (!is_bayer(raw.mosaic)) return raw;
    return {.width_px = raw.width_px,
            .height_px = raw.height_px,
            .samples = demosaiced(raw.samples, raw.width_px, raw.height_px, raw.mosaic)};
}

// f(mean, sample) of every sample within a block.
template <typename F>
void for_blocks(const RawImage& raw,
                const FitPlaces& places,
                std::vector<Mean>& means,
                const F& f) {
    const std::size_t across = places.across();
    const std::size_t down = places.down();
    const auto width = static_cast<std::size_t>(raw.width_px);
    for (int plane = 0; plane < raw.planes(); ++plane) {
        for (int row = 0; row < raw.height_px; ++row) {
            const auto j = static_cast<std::size_t>(row / places.block_px);
            if (j >= down) break;
            const float* samples = &raw.samples[static_cast<std::size_t>(plane) * raw.pixels() +
                                                static_cast<std::size_t>(row) * width];
            for (int column = 0; column < raw.width_px; ++column) {
                const auto i = static_cast<std::size_t>(column / places.block_px);
                if (i >= across) break;
                const int channel =
                    raw.mosaic == Mosaic::None ? plane : channel_at(raw.mosaic, column, row);
                f(means[(j * across + i) * kChannels + static_cast<std::size_t>(channel)],
                  samples[column]);
            }
        }
    }
}

void average(const RawImage& raw, float white, const FitPlaces& places, FitImage& image) {
    std::vector<Mean> means(places.size() * kChannels);
    double saturated = 0.0;
    for_blocks(raw, places, means, [&](Mean& mean, float sample) {
        ++mean.sites;
        if (!(sample >= white)) return;
        ++mean.saturated;
        saturated += 1.0;
    });
    for_blocks(of_all_colours(raw), places, means, [](Mean& mean, float sample) {
        if (!std::isfinite(sample)) return;
        mean.sum += sample;
        ++mean.count;
    });
    for (const Mean& mean : means) image.signal.push_back(mean.signal());
    image.saturated_share = saturated / static_cast<double>(raw.samples.size());
}

// The image's floor, and a substitute for its pose if that is unknown.
void put_floor(const Survey& survey,
               const ImageFile& file,
               const FitPlaces& places,
               const Rig& rig,
               FitImage& image) {
    const std::optional<Sled> sled = sled_of(survey, file);
    if (survey.depth) image.planes = block_planes(relief_of(survey, file).relief, places, rig);
    std::vector<double> depths_m;
    for (const Plane& plane : image.planes)
        if (std::isfinite(plane.point_m.z())) depths_m.push_back(plane.point_m.z());
    if (2 * depths_m.size() < image.planes.size()) {
        throw InputError(
            "found {} of {} blocks with one plane that every strobe lights; allowed: half or more",
            depths_m.size(),
            image.planes.size());
    }
    image.sled = sled ? *sled : Sled{.altitude_m = upper_median(depths_m)};
}

double number_of(const ExrReader& reader, const std::string& name, const std::string& map) {
    const std::string text = reader.attribute(name);
    const auto value = read_number<double>(text);
    if (!value || !std::isfinite(*value)) {
        throw InputError(
            "{}: {}: found '{}'; allowed: a number, as `aphotic observe` writes if the navigation "
            "has it",
            map,
            name,
            excerpt(text));
    }
    return *value;
}

// A mosaic's map has red at only a quarter of the pixels.
void require_every_channel(const FitImage& image, const std::string& map) {
    for (std::size_t c = 0; c < kChannels; ++c) {
        bool is_told = false;
        for (std::size_t k = c; k < image.signal.size(); k += kChannels)
            is_told = is_told || std::isfinite(image.signal[k]);
        if (is_told) continue;
        throw InputError(
            "{}: found {} at too few pixels of every block; allowed: at half of one's pixels or "
            "more, as `aphotic observe --demosaic` writes",
            map,
            kChannelNames[c]);
    }
}

FitImage image_of_map(ExrReader& reader,
                      const std::string& map,
                      const Camera& camera,
                      const FitPlaces& places) {
    const std::vector<std::string> names{kChannelNames.begin(), kChannelNames.end()};
    const std::vector<std::string> channels = reader.channels();
    for (const std::string& name : names) {
        if (std::ranges::find(channels, name) == channels.end())
            throw InputError("{}: has no channel {}; needed: R, G, B", map, name);
    }
    RawImage raw{.width_px = reader.width_px(), .height_px = reader.height_px()};
    naming(map,
           [&] { require_size(raw, camera.width_px, camera.height_px, "like the rig's camera"); });
    raw.samples = reader.planes(names);
    FitImage image{
        .name = map,
        .sled = {.altitude_m = number_of(reader, "aphotic:altitude_m", map),
                 .pitch_rad = number_of(reader, "aphotic:pitch_deg", map) / kDegreesPerRadian,
                 .roll_rad = number_of(reader, "aphotic:roll_deg", map) / kDegreesPerRadian}};
    average(raw, std::numeric_limits<float>::infinity(), places, image);
    require_every_channel(image, map);
    const bool is_mono = camera.sensor.is_mono();
    // For a mono camera all three are equal, and count once.
    for (std::size_t k = 0; k < image.signal.size() && is_mono; ++k)
        if (k % kChannels > 0) image.signal[k] = std::numeric_limits<float>::quiet_NaN();
    return image;
}

// Omits images that not all strobes lit. files: by image, the survey's.
void leave_lit(const Survey& survey,
               const std::vector<LightCells>& cells,
               const std::vector<std::size_t>& files,
               FitSamples& samples,
               const RunWatch& watch) {
    if (survey.dropouts == Dropouts::Ignore) return;
    DropoutScales scales = learned(cells);
    if (const auto doubt = doubt_of_rig(cells, survey, scales)) {
        watch.looks_wrong({*doubt});
        samples.looks_wrong.push_back(*doubt);
    }
    std::vector<FitImage> lit;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const Dropout found = judged(cells[i], scales);
        const std::string name = survey.files[files[i]].source.string();
        if (found.is_dark) {
            samples.skipped.push_back({.image = name, .why = why_dark(found)});
            watch.skipped(samples.skipped.back());
        } else if (found.is_any()) {
            samples.marked.push_back(marked(name, survey.strobes.names, found.share, found.out));
            watch.marked(samples.marked.back());
        } else {
            lit.push_back(std::move(samples.images[i]));
        }
    }
    samples.images = std::move(lit);
}

}  // namespace

FitPlaces fit_places(int width_px, int height_px, int blocks_across) {
    // Even, so that every block of a mosaic holds the same number of sites of each kind.
    int block_px = std::max(1, width_px / std::max(1, blocks_across));
    if (block_px > 1) block_px -= block_px % 2;
    return {.width_px = width_px, .height_px = height_px, .block_px = block_px};
}

FitSamples samples_of_images(const Survey& survey,
                             const Rig& rig,
                             int blocks_across,
                             std::size_t jobs,
                             const RunWatch& watch) {
    FitSamples samples;
    const PlaneSize size{rig.camera.width_px, rig.camera.height_px};
    samples.places = fit_places(size.width_px, size.height_px, blocks_across);
    samples.mosaic = survey.camera.mosaic.value_or(Mosaic::None);
    CameraNumbers numbers = survey.camera;
    expect(numbers, size, "like the rig's camera");
    samples.looks_wrong = suspicions_of(survey.files, numbers, survey.navigation, jobs, watch);
    std::vector<LightCells> cells;
    std::vector<std::size_t> files;  // by image
    const auto skip = [&](std::size_t i, const std::string& why) {
        samples.skipped.push_back({.image = survey.files[i].source.string(), .why = why});
        watch.skipped(samples.skipped.back());
    };
    in_order(
        survey.files.size(),
        static_cast<int>(jobs),
        [&](std::size_t i) {
            FitImage image{.name = survey.files[i].name.string(), .sled = {}};
            put_floor(survey, survey.files[i], samples.places, rig, image);
            SurveyImage taken = read_survey_image(survey.files[i].source, numbers);
            LightCells lit = light_cells(taken, survey, survey.files[i]);
            take_off_black(taken);
            average(taken.raw, taken.levels.white, samples.places, image);
            return std::pair(std::move(image), std::move(lit));
        },
        [&](std::size_t i, std::pair<FitImage, LightCells> read) {
            samples.images.push_back(std::move(read.first));
            cells.push_back(std::move(read.second));
            files.push_back(i);
            watch.progress("reading",
                           static_cast<double>(i + 1) / static_cast<double>(survey.files.size()));
        },
        skip);
    leave_lit(survey, cells, files, samples, watch);
    if (samples.images.empty()) {
        throw InputError("no usable image; the first: {}",
                         samples.skipped.empty() ? "none" : samples.skipped.front().why);
    }
    return samples;
}

FitSamples samples_of_maps(const std::vector<std::string>& maps,
                           const Camera& camera,
                           int blocks_across) {
    FitSamples samples;
    samples.are_maps = true;
    samples.places = fit_places(camera.width_px, camera.height_px, blocks_across);
    for (const std::string& map : maps)
        samples.images.push_back(from_named_exr(map, [&](ExrReader& reader) {
            return image_of_map(reader, map, camera, samples.places);
        }));
    return samples;
}

}  // namespace aphotic
