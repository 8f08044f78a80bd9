// SPDX-License-Identifier: BSD-3-Clause
#include "survey/survey_check.h"

#include "base/upper_median.h"
#include "image/image_size.h"

#include <fmt/format.h>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace aphotic {
namespace {

constexpr std::size_t kRed = 0;
constexpr std::size_t kGreenChannel = 1;
constexpr std::size_t kBlue = 2;
constexpr double kPercent = 100.0;

constexpr double kNearTop = 0.9;
constexpr double kLeastTop = 64.0;  // six whole numbers and more lie between 0.9 of it and it
constexpr double kFewNumbers = 64.0;
constexpr double kPile = 10.0;
constexpr double kPileShare = 1e-4;
constexpr double kPileLeast = 16.0;  // samples: in a small image one is a large share

constexpr double kGreen = 0.1;
constexpr double kOtherSites = 0.25;

// Altitudes that vary less are one altitude: an altimeter's own noise is some centimetres, and a
// slope over noise is 0.
constexpr double kSpread_m = 0.05;
// Of logarithms, as a standard deviation: maps that vary less are alike. Rounding is far below, and
// floors vary by more.
constexpr double kSpread = 0.01;
constexpr double kSlope = 0.5;
constexpr double kTurned = 1.0;  // a slope of 1 - kTurned has turned round
constexpr double kStandardErrors = 5.0;
constexpr double kGains = 100.0;
constexpr double kLikeness = 0.5;

struct Line {
    double slope = 0.0;
    double error = std::numeric_limits<double>::infinity();  // standard, of the slope
};

// Of products, each less its mean.
struct Sums {
    double xx = 0.0;
    double xy = 0.0;
    double yy = 0.0;
};

Sums sums_of(const std::vector<double>& x, const std::vector<double>& y) {
    if (x.empty()) return {};
    const auto less_mean = [](const std::vector<double>& numbers) -> Eigen::ArrayXd {
        const Eigen::Map<const Eigen::ArrayXd> all(numbers.data(), std::ssize(numbers));
        return all - all.mean();
    };
    const Eigen::ArrayXd dx = less_mean(x);
    const Eigen::ArrayXd dy = less_mean(y);
    return {.xx = dx.square().sum(), .xy = (dx * dy).sum(), .yy = dy.square().sum()};
}

// y = slope x + const by least squares; no line of too few points, or of points too near each
// other.
Line line_through(const std::vector<double>& x, const std::vector<double>& y) {
    if (x.size() < kEnoughImages) return {};
    const Sums sums = sums_of(x, y);
    if (!(sums.xx > kSpread * kSpread * static_cast<double>(x.size()))) return {};
    const double slope = sums.xy / sums.xx;
    const auto freedom = static_cast<double>(x.size() - 2);
    return {slope, std::sqrt(std::max(0.0, sums.yy - slope * sums.xy) / freedom / sums.xx)};
}

bool has_light(const ImageLook& look) {
    const auto is_light = [](double value) { return std::isfinite(value) && value > 0.0; };
    return std::ranges::all_of(look.quotient, is_light) &&
           std::ranges::all_of(look.map_mean, is_light);
}

// Those with light in every channel, of which lines are laid.
std::vector<ImageLook> lit(std::span<const ImageLook> looks) {
    std::vector<ImageLook> lit;
    std::ranges::copy_if(looks, std::back_inserter(lit), has_light);
    return lit;
}

bool has_altitudes(std::span<const ImageLook> looks) {
    return std::ranges::all_of(looks,
                               [](const ImageLook& look) { return look.altitude_m.has_value(); });
}

bool is_one_altitude(std::span<const ImageLook> looks) {
    std::vector<double> altitudes_m;
    for (const ImageLook& look : looks) altitudes_m.push_back(look.altitude_m.value_or(0.0));
    const auto count = static_cast<double>(looks.size());
    return sums_of(altitudes_m, altitudes_m).xx <= kSpread_m * kSpread_m * count;
}

double fold_of(const std::vector<double>& logarithms) {
    const auto [least, most] = std::ranges::minmax_element(logarithms);
    return std::exp(*most - *least);
}

void check_white(std::span<const ImageLook> looks, std::vector<Suspicion>& found) {
    TopNumber all;
    float white = 0.0F;
    double samples = 0.0;
    for (const ImageLook& look : looks) {
        samples += look.top.samples;
        if (look.top.top < all.top) continue;
        if (look.top.top > all.top) all = {.top = look.top.top, .numbers = look.top.numbers};
        all.at_top += look.top.at_top;
        all.just_below += look.top.just_below;
        white = look.white;
    }
    const double share = all.at_top / samples;
    if (all.top < kLeastTop || all.top >= static_cast<double>(white) || all.at_top < kPileLeast ||
        share < kPileShare || all.at_top < kPile * all.just_below / all.numbers) {
        return;
    }
    found.push_back(
        {.about = "white-level",
         .what = fmt::format("{:.2g} % of the samples are {:g}, the largest number of all, as "
                             "where a sensor is saturated{}",
                             kPercent * share,
                             all.top,
                             std::isfinite(white) ? fmt::format("; the white level is {:g}", white)
                                                  : "; there is no white level")});
}

double ratio_of(double a, double b) {
    return std::max(a, b) / std::min(a, b);
}

void check_greens(std::span<const ImageLook> looks, Mosaic mosaic, std::vector<Suspicion>& found) {
    const bool is_green_beside = channel_at(mosaic, 1, 0) == static_cast<int>(kGreenChannel);
    std::vector<float> greens;
    std::vector<float> others;
    for (const ImageLook& look : looks) {
        if (!look.sites || std::ranges::any_of(*look.sites, [](double s) { return !(s > 0.0); })) {
            continue;
        }
        const std::array<double, 4>& site = *look.sites;
        const double beside = ratio_of(site[1], site[2]);
        const double across = ratio_of(site[0], site[3]);
        greens.push_back(static_cast<float>(is_green_beside ? beside : across));
        others.push_back(static_cast<float>(is_green_beside ? across : beside));
    }
    if (greens.empty()) return;
    const double green = double{upper_median(greens)} - 1.0;
    const double other = double{upper_median(others)} - 1.0;
    if (green < kGreen || other > kOtherSites * green) return;
    found.push_back({.about = "bayer",
                     .what = fmt::format("the two sites that {} makes green differ by {:.0f} %, "
                                         "the other two by {:.1f} %: the pattern is {}",
                                         mosaic_name(mosaic),
                                         kPercent * green,
                                         kPercent * other,
                                         is_green_beside ? "GRBG or GBRG" : "RGGB or BGGR")});
}

Mosaic with_red_for_blue(Mosaic mosaic) {
    switch (mosaic) {
        case Mosaic::Rggb:
            return Mosaic::Bggr;
        case Mosaic::Bggr:
            return Mosaic::Rggb;
        case Mosaic::Grbg:
            return Mosaic::Gbrg;
        case Mosaic::Gbrg:
            return Mosaic::Grbg;
        case Mosaic::None:
        case Mosaic::Mono:
            break;
    }
    return mosaic;
}

std::string range_of(std::span<const ImageLook> looks) {
    const auto [lowest, highest] = std::ranges::minmax(looks, {}, &ImageLook::altitude_m);
    return fmt::format("{:g} to {:g} m", *lowest.altitude_m, *highest.altitude_m);
}

// Logarithms of a channel over the images: of their light, and of themselves.
struct Brightness {
    std::vector<double> light;
    std::vector<double> images;
};
Brightness brightness_of(std::span<const ImageLook> looks, std::size_t channel) {
    Brightness of;
    for (const ImageLook& look : looks) {
        of.light.push_back(std::log(look.map_mean[channel]));
        of.images.push_back(of.light.back() + std::log(look.quotient[channel]));
    }
    return of;
}

bool is_turned(const Line& line) {
    return 1.0 - line.slope >= std::max(kTurned, kStandardErrors * line.error);
}

std::string words_of_turned(const Brightness& of) {
    return fmt::format(
        "varies {:.3g}-fold over the images' altitudes where the rig's light varies "
        "{:.3g}-fold the other way",
        fold_of(of.images),
        fold_of(of.light));
}

void check_altitude(std::span<const ImageLook> looks, std::vector<Suspicion>& found) {
    const auto [maps, images] = brightness_of(looks, kGreenChannel);
    const Line line = line_through(maps, images);
    if (std::abs(line.slope - 1.0) < std::max(kSlope, kStandardErrors * line.error)) return;
    found.push_back({.about = "altitude",
                     .what = fmt::format(
                         "brightness varies {:.3g}-fold where the maps vary {:.3g}-fold ({}; slope "
                         "{:.2g}, expected 1). Wrong altitude column, or exposure not constant?",
                         fold_of(images),
                         fold_of(maps),
                         range_of(looks),
                         line.slope)});
}

void check_gains(std::span<const ImageLook> looks, std::vector<Suspicion>& found) {
    if (looks.empty()) return;
    PerChannel gain{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        std::vector<float> quotients;
        for (const ImageLook& look : looks) {
            quotients.push_back(static_cast<float>(std::log(look.quotient[c])));
        }
        gain[c] = std::exp(-double{upper_median(quotients)});
    }
    const auto [least, most] = std::ranges::minmax(gain);
    if (most <= kGains * least) return;
    const bool has_poses = has_altitudes(looks);
    found.push_back(
        {.about = has_poses ? "altitude" : "map",
         .what = fmt::format("{} and the images differ in colour: R, G and B need gains of {:.3g}, "
                             "{:.3g} and {:.3g}. Wrong {}water or camera response?",
                             has_poses ? fmt::format("the maps at {}", range_of(looks)) : "the map",
                             1.0,
                             gain[kGreenChannel] / gain[kRed],
                             gain[kBlue] / gain[kRed],
                             has_poses ? "altitude column, " : "")});
}

void check_attitude(std::span<const ImageLook> looks, std::vector<Suspicion>& found) {
    double xx = 0.0;
    double xy = 0.0;
    std::size_t count = 0;
    for (const ImageLook& look : looks) {
        xx += look.as_radians.xx;
        xy += look.as_radians.xy;
        if (look.as_radians.xx > 0.0) ++count;
    }
    if (count < kEnoughImages) return;
    const double slope = xy / xx;
    double squares = 0.0;
    for (const ImageLook& look : looks) {
        squares += std::pow(look.as_radians.xy - slope * look.as_radians.xx, 2.0);
    }
    if (slope < std::max(kLikeness, kStandardErrors * std::sqrt(squares) / xx)) return;
    found.push_back(
        {.about = "attitude",
         .what = fmt::format("pitch and roll are all within {} degrees, and the images match the "
                             "angles read as radians ({:.2g}; 0 for degrees). Are they in radians?",
                             kSmall_deg,
                             slope)});
}

}  // namespace

Mosaic mosaic_of(std::span<const ImageLook> looks) {
    return looks.empty() ? Mosaic::None : looks.front().mosaic;
}

TopNumber top_of(const RawImage& raw, bool is_whole_numbers) {
    TopNumber top{.samples = static_cast<double>(raw.samples.size())};
    for (const float sample : raw.samples) {
        if (std::isfinite(sample)) top.top = std::max(top.top, static_cast<double>(sample));
    }
    const auto most = static_cast<float>(top.top);
    const auto near = static_cast<float>(kNearTop * top.top);
    for (const float sample : raw.samples) {
        if (sample == most) top.at_top += 1.0;
        if (sample >= near && sample < most) top.just_below += 1.0;
    }
    top.numbers = is_whole_numbers ? std::ceil((1.0 - kNearTop) * top.top) : kFewNumbers;
    return top;
}

std::array<double, 4> site_medians(const RawImage& raw, float black) {
    std::array<double, 4> medians{};
    for (int site = 0; site < 4; ++site) {
        std::vector<float> samples;
        samples.reserve(raw.pixels() / 4 + 1);
        for (int row = site / 2; row < raw.height_px; row += 2) {
            for (int column = site % 2; column < raw.width_px; column += 2) {
                samples.push_back(
                    raw.samples[size_of(row) * size_of(raw.width_px) + size_of(column)]);
            }
        }
        medians[size_of(site)] = double{upper_median(samples)} - static_cast<double>(black);
    }
    return medians;
}

PerChannel means_of(const Lightmap& map) {
    PerChannel means{};
    const std::size_t pixels = map.samples.size() / size_of(kChannels);
    const float* sample = map.samples.data();
    for (double& mean : means) {
        mean = std::accumulate(sample, sample + pixels, 0.0) / static_cast<double>(pixels);
        sample += pixels;
    }
    return means;
}

Likeness likeness(const RawImage& raw,
                  const SensorLevels& levels,
                  const Lightmap& map,
                  const Lightmap& other) {
    constexpr int kAcross = 16;
    constexpr int kDown = 12;
    struct Block {
        double image = 0.0;
        double map = 0.0;
        double other = 0.0;
    };
    std::vector<Block> blocks(size_of(kAcross) * size_of(kDown));
    const std::size_t green = kGreenChannel * raw.pixels();
    const bool is_mosaic = is_bayer(raw.mosaic);
    for (int row = 0; row < raw.height_px; ++row) {
        for (int column = 0; column < raw.width_px; ++column) {
            const bool is_green = !is_mosaic || channel_at(raw.mosaic, column, row) ==
                                                    static_cast<int>(kGreenChannel);
            const std::size_t pixel = size_of(row) * size_of(raw.width_px) + size_of(column);
            const float sample = raw.samples[raw.planes() == 1 ? pixel : green + pixel];
            if (!is_green || !(sample > levels.black && sample < levels.white)) continue;
            Block& block = blocks[size_of(row * kDown / raw.height_px) * size_of(kAcross) +
                                  size_of(column * kAcross / raw.width_px)];
            block.image += static_cast<double>(sample - levels.black);
            block.map += static_cast<double>(map.samples[green + pixel]);
            block.other += static_cast<double>(other.samples[green + pixel]);
        }
    }
    std::vector<double> x;
    std::vector<double> y;
    for (const Block& block : blocks) {
        if (!(block.map > 0.0 && block.other > 0.0)) continue;
        x.push_back(std::log(block.other / block.map));
        y.push_back(std::log(block.image / block.map));
    }
    const Sums sums = sums_of(x, y);
    if (!(sums.xx > kSpread * kSpread * static_cast<double>(x.size()))) return {};
    return {.xx = sums.xx, .xy = sums.xy};
}

std::optional<Suspicion> turned_brightness(std::span<const ImageLook> looks) {
    const Brightness green = brightness_of(lit(looks), kGreenChannel);
    if (!is_turned(line_through(green.light, green.images))) return std::nullopt;
    return Suspicion{.about = "altitude",
                     .what = "brightness " + words_of_turned(green) +
                             ": poses of other images, or another altitude column"};
}

std::optional<Suspicion> red_for_blue(std::span<const ImageLook> looks, Mosaic mosaic) {
    const std::vector<ImageLook> lit_looks = lit(looks);
    const Brightness green = brightness_of(lit_looks, kGreenChannel);
    const Brightness blue = brightness_of(lit_looks, kBlue);
    Brightness ratio = brightness_of(lit_looks, kRed);
    for (std::size_t i = 0; i < lit_looks.size(); ++i) {
        ratio.light[i] -= blue.light[i];
        ratio.images[i] -= blue.images[i];
    }
    if (!is_turned(line_through(ratio.light, ratio.images)) ||
        line_through(green.light, green.images).slope < kSlope)
        return std::nullopt;
    std::string what = "red over blue " + words_of_turned(ratio) + ": red and blue are swapped";
    if (is_bayer(mosaic)) {
        what += fmt::format("; --bayer {} puts them right", mosaic_name(with_red_for_blue(mosaic)));
    }
    return Suspicion{.about = "bayer", .what = std::move(what)};
}

std::vector<Suspicion> suspicions(std::span<const ImageLook> looks, Mosaic mosaic) {
    std::vector<Suspicion> found;
    check_white(looks, found);
    if (is_bayer(mosaic)) check_greens(looks, mosaic, found);
    const std::vector<ImageLook> lit_looks = lit(looks);
    const std::size_t before = found.size();
    const bool has_line = has_altitudes(lit_looks) && !is_one_altitude(lit_looks);
    if (has_line) check_altitude(lit_looks, found);
    check_gains(lit_looks, found);
    // At other altitudes colours change otherwise, too.
    if (has_line && found.size() == before) {
        if (const auto swapped = red_for_blue(lit_looks, mosaic)) found.push_back(*swapped);
    }
    check_attitude(looks, found);
    return found;
}

nlohmann::ordered_json to_json(const std::vector<Suspicion>& suspicions) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Suspicion& one : suspicions)
        json.push_back({{"about", one.about}, {"what", one.what}});
    return json;
}

std::string not_checked(std::span<const ImageLook> looks) {
    const std::vector<ImageLook> lit_looks = lit(looks);
    if (!has_altitudes(lit_looks)) return {};
    if (lit_looks.size() < kEnoughImages) {
        return fmt::format("altitudes, red for blue, radians: {} image{} with light; needed: {}",
                           lit_looks.size(),
                           lit_looks.size() == 1 ? "" : "s",
                           kEnoughImages);
    }
    if (!is_one_altitude(lit_looks)) return {};
    return fmt::format("altitudes, red for blue: {} images, all of one altitude ({})",
                       lit_looks.size(),
                       range_of(lit_looks));
}

}  // namespace aphotic
