// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correction.h"

#include "base/error.h"
#include "base/upper_median.h"
#include "image/image_size.h"
#include "lightmap/cone_edge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace aphotic {
namespace {

std::span<const float> plane_of(const std::vector<float>& samples, int channel) {
    const std::size_t pixels = samples.size() / kChannels;
    return std::span(samples).subspan(size_of(channel) * pixels, pixels);
}

std::span<const float> plane_of(const Lightmap& map, int channel) {
    return plane_of(map.samples, channel);
}

// Samples of one channel in a row; in a mosaic, every other pixel at most.
struct Run {
    int channel;
    std::size_t sample;  // of the raw image
    std::size_t pixel;   // of the map and the mask
    std::size_t step;
    std::size_t count;
};

template <typename Work>
void for_each_run(const RawImage& raw, const Work& work) {
    const std::size_t width = size_of(raw.width_px);
    for (int row = 0; row < raw.height_px; ++row) {
        const std::size_t pixel = size_of(row) * width;
        if (raw.mosaic == Mosaic::None) {
            for (int c = 0; c < kChannels; ++c) {
                work(Run{c, size_of(c) * raw.pixels() + pixel, pixel, 1, width});
            }
            continue;
        }
        for (const int first : {0, 1}) {
            const std::size_t start = pixel + size_of(first);
            work(Run{channel_at(raw.mosaic, first, row),
                     start,
                     start,
                     2,
                     (width + 1 - size_of(first)) / 2});
        }
    }
}

void require_finite(const std::vector<float>& samples, int width_px, std::string_view what) {
    const auto found =
        std::ranges::find_if(samples, [](float sample) { return !std::isfinite(sample); });
    if (found == samples.end()) return;
    const auto index = found - samples.begin();
    throw InputError("{} is {} at sample {}, {}; allowed: finite numbers",
                     what,
                     *found,
                     index % width_px,
                     index / width_px);
}

float brightest(const Lightmap& map, int channel) {
    return std::ranges::max(plane_of(map, channel));
}

// h of a pixel. A channel whose map is 0 there is ignored, as between an observed mosaic's sites.
float held_share(const std::array<std::span<const float>, kChannels>& lights,
                 const std::array<float, kChannels>& least,
                 std::size_t pixel) {
    float share = 1.0F;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const float light = lights[c][pixel];
        share = light > 0.0F ? std::min(share, light / least[c]) : share;
    }
    return share;
}

}  // namespace

double least_signal(const NoiseLimit& limit, double veil) {
    const double q = limit.electrons_per_number > 0.0 ? 1.0 / limit.electrons_per_number : 0.0;
    const double most2 = limit.relative * limit.relative;
    const double dark = limit.read_noise * limit.read_noise + q * veil;
    return (q + std::sqrt(q * q + 4.0 * most2 * dark)) / (2.0 * most2);
}

CorrectedImage corrected(RawImage raw, const Lightmap& map, const Correction& correction) {
    require_size(raw, map.width_px, map.height_px, "like the map");
    require_finite(raw.samples, raw.width_px, "the image");
    const std::size_t pixels = raw.pixels();
    CorrectedImage result{.image = std::move(raw), .doubts = std::vector<std::uint8_t>(pixels)};
    const bool has_veil = !map.veil.empty();
    std::array<double, kChannels> exposure{};
    std::array<float, kChannels> least{};
    std::array<float, kChannels> gain{};
    for (int c = 0; c < kChannels; ++c) {
        const std::size_t i = size_of(c);
        exposure[i] = correction.middle[i] / correction.gain[i];
        const double most_veil =
            has_veil ? exposure[i] * std::ranges::max(plane_of(map.veil, c)) : 0.0;
        const double signal = least_signal(correction.limit, most_veil);
        const double held = std::max(correction.limit.share * brightest(map, c),
                                     signal * correction.gain[i] / correction.middle[i]);
        const bool is_lit = held > 0.0;
        least[i] =
            is_lit ? std::max(static_cast<float>(held), std::numeric_limits<float>::min()) : 1.0F;
        // Where a channel's map is all black, its samples carry no information.
        gain[i] = is_lit ? static_cast<float>(correction.gain[i]) : 0.0F;
    }
    const std::array<std::span<const float>, kChannels> lights{
        plane_of(map, 0), plane_of(map, 1), plane_of(map, 2)};
    for_each_run(result.image, [&](const Run& run) {
        const float black = correction.levels.black;
        const float white = correction.levels.white;
        const float floor = least[size_of(run.channel)];
        const float scale = gain[size_of(run.channel)];
        const float* const light = lights[size_of(run.channel)].data() + run.pixel;
        float* const samples = result.image.samples.data() + run.sample;
        std::uint8_t* const doubts = result.doubts.data() + run.pixel;
        const float* const veil =
            has_veil ? plane_of(map.veil, run.channel).data() + run.pixel : nullptr;
        const auto of_veil = static_cast<float>(exposure[size_of(run.channel)]);
        for (std::size_t n = 0; n < run.count; ++n) {
            const std::size_t i = n * run.step;
            const float held = held_share(lights, least, run.pixel + i);
            const float taken = samples[i];
            const float dark = veil != nullptr ? black + of_veil * veil[i] : black;
            samples[i] = scale * ((taken - dark) * held / std::max(light[i], held * floor));
            const int doubt = (held < 1.0F || light[i] < floor ? kDark : 0) |
                              (taken >= white ? kSaturated : 0) | (taken <= dark ? kBlack : 0);
            doubts[i] |= static_cast<std::uint8_t>(doubt);
        }
    });
    require_finite(result.image.samples, result.image.width_px, "the corrected image");
    return result;
}

CorrectedImage demosaiced(const CorrectedImage& corrected) {
    const RawImage& mosaic = corrected.image;
    CorrectedImage result{
        .image = {.width_px = mosaic.width_px,
                  .height_px = mosaic.height_px,
                  .mosaic = Mosaic::None,
                  .samples =
                      demosaiced(mosaic.samples, mosaic.width_px, mosaic.height_px, mosaic.mosaic)},
        .doubts = corrected.doubts};
    spread(result.doubts, mosaic.width_px, 1);
    return result;
}

PerChannel middle_quotient(const RawImage& raw,
                           const Lightmap& map,
                           const SensorLevels& levels,
                           double share) {
    require_size(raw, map.width_px, map.height_px, "like the map");
    require_finite(raw.samples, raw.width_px, "the image");
    std::array<std::vector<float>, kChannels> quotients;
    std::array<float, kChannels> least{};
    for (int c = 0; c < kChannels; ++c) {
        least[size_of(c)] = static_cast<float>(share) * brightest(map, c);
        quotients[size_of(c)].reserve(raw.pixels());
    }
    for_each_run(raw, [&](const Run& run) {
        const float* const light = plane_of(map, run.channel).data() + run.pixel;
        const float* const from = raw.samples.data() + run.sample;
        for (std::size_t n = 0; n < run.count; ++n) {
            const std::size_t i = n * run.step;
            const bool is_good = from[i] > levels.black && from[i] < levels.white &&
                                 light[i] > 0.0F && light[i] >= least[size_of(run.channel)];
            if (is_good) {
                quotients[size_of(run.channel)].push_back((from[i] - levels.black) / light[i]);
            }
        }
    });
    PerChannel medians{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        medians[c] = upper_median(quotients[c]);
    }
    if (raw.mosaic == Mosaic::Mono) medians.fill(medians[0]);
    return medians;
}

}  // namespace aphotic
