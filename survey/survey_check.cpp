// SPDX-License-Identifier: BSD-3-Clause
#include "survey/survey_check.h"

#include "base/upper_median.h"
#include "image/image_size.h"

#include <fmt/format.h>
#include <Eigen/Core>
#include <Eigen/QR>
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
constexpr double kPerCent = 100.0;

constexpr double kNearTop = 0.9;
constexpr double kLeastTop = 64.0;  // at least six whole numbers lie between 0.9 of it and it
constexpr double kFewNumbers = 64.0;
constexpr double kPile = 10.0;
constexpr double kPileShare = 1e-4;
constexpr double kPileLeast = 16.0;  // samples: in a small image, one is a large share

constexpr double kGreenSites = 0.1;
constexpr double kOtherSites = 0.25;

// Altitudes that vary less count as one: an altimeter's own noise is some centimetres, and a slope
// over noise is 0.
constexpr double kSpread_m = 0.05;
// Standard deviation of logarithms: maps that vary less count as equal. Rounding is far below, and
// floors vary by more.
constexpr double kSpread = 0.01;
constexpr double kSlope = 0.5;
constexpr double kTurned = 1.0;  // a slope of 1 - kTurned is reversed
constexpr double kStandardErrors = 5.0;
constexpr double kGains = 100.0;
constexpr double kLikeness = 0.5;
constexpr double kLikeAltitudes = 0.5;
// Fewer than for other lines: sleds whose tilts are all so small are rare, and the floors' own
// patterns leave 16 images in degrees an error of a fourth.
constexpr double kErrorsOfAttitude = 3.0;
// Of 16 images in two groups, floors leave a step of one stop an error of a fifth.
constexpr double kErrorsOfExposure = 3.0;

constexpr double kOtherUnit = 2.5;
constexpr double kEncoded = 1.0 / 2.2;
constexpr double kGamma = 0.13;
constexpr double kLinear = 0.75;
constexpr double kFallOff = 0.1;
constexpr double kEven = 0.2;
constexpr double kOffset = 0.01;
constexpr double kVaried = 4.0;
constexpr double kMostOfDarkest = 0.5;
constexpr double kBlockNoise = 0.1;  // by which b may exceed the darkest block, due to noise

constexpr int kLookBlocksAcross = 16;
constexpr int kBlocksDown = 12;
constexpr std::size_t kBlocks = std::size_t{kLookBlocksAcross} * kBlocksDown;

// Sums over a block's samples.
struct Block {
    double image = 0.0;  // over black
    std::array<double, 2> maps{};
    double samples = 0.0;
};

// For one channel, from the samples that count; a mono camera's are green.
template <typename Counts>
std::vector<Block> blocks_of(const RawImage& raw,
                             const SensorLevels& levels,
                             std::size_t channel,
                             const std::array<const Lightmap*, 2>& maps,
                             const Counts& counts) {
    std::vector<Block> blocks(kBlocks);
    const bool is_plane = raw.planes() == 1;
    const std::size_t of_map = channel * raw.pixels();
    for (int row = 0; row < raw.height_px; ++row) {
        for (int column = 0; column < raw.width_px; ++column) {
            const std::size_t site =
                is_bayer(raw.mosaic) ? size_of(channel_at(raw.mosaic, column, row)) : kGreenChannel;
            if (is_plane && site != channel) continue;
            const std::size_t pixel = size_of(row) * size_of(raw.width_px) + size_of(column);
            const float sample = raw.samples[is_plane ? pixel : of_map + pixel];
            if (!counts(sample)) continue;
            Block& block = blocks[size_of(row * kBlocksDown / raw.height_px) * kLookBlocksAcross +
                                  size_of(column * kLookBlocksAcross / raw.width_px)];
            block.image += static_cast<double>(sample - levels.black);
            for (std::size_t m = 0; m < maps.size(); ++m)
                block.maps[m] += static_cast<double>(maps[m]->samples[of_map + pixel]);
            block.samples += 1.0;
        }
    }
    return blocks;
}

struct Line {
    double slope = 0.0;
    double error = std::numeric_limits<double>::infinity();  // standard error of the slope
};

// Of products of deviations from the means.
Likeness sums_of(const std::vector<double>& x, const std::vector<double>& y) {
    if (x.empty()) return {};
    const auto less_mean = [](const std::vector<double>& numbers) -> Eigen::ArrayXd {
        const Eigen::Map<const Eigen::ArrayXd> all(numbers.data(), std::ssize(numbers));
        return all - all.mean();
    };
    const Eigen::ArrayXd dx = less_mean(x);
    const Eigen::ArrayXd dy = less_mean(y);
    return {.xx = dx.square().sum(),
            .xy = (dx * dy).sum(),
            .blocks = x.size(),
            .yy = dy.square().sum()};
}

// Logarithms of pairs.
struct LogPairs {
    std::vector<double> x{};
    std::vector<double> y{};

    void add(double one, double other) {
        x.push_back(std::log(one));
        y.push_back(std::log(other));
    }
    [[nodiscard]] Likeness likeness() const { return sums_of(x, y); }
};

// y = slope x + const by least squares; unknown if the points are too few or too close together.
Line line_through(const std::vector<double>& x, const std::vector<double>& y) {
    if (x.size() < kEnoughImages) return {};
    const Likeness sums = sums_of(x, y);
    if (!(sums.xx > kSpread * kSpread * static_cast<double>(x.size()))) return {};
    const double slope = sums.xy / sums.xx;
    const auto freedom = static_cast<double>(x.size() - 2);
    return {slope, std::sqrt(std::max(0.0, sums.yy - slope * sums.xy) / freedom / sums.xx)};
}

// One slope for all images, each weighted by the variation of its x; its error from the differences
// between images. Unknown if the images are too few, or if x varies too little over all of them.
Line line_of_all(std::span<const ImageLook> looks, const auto& likeness_of, double least_spread) {
    double xx = 0.0;
    double xy = 0.0;
    std::size_t count = 0;
    std::size_t blocks = 0;
    for (const ImageLook& look : looks) {
        const Likeness& one = likeness_of(look);
        xx += one.xx;
        xy += one.xy;
        blocks += one.blocks;
        if (one.xx > 0.0) ++count;
    }
    if (count < kEnoughImages || !(xx > least_spread * least_spread * static_cast<double>(blocks)))
        return {};
    const double slope = xy / xx;
    double squares = 0.0;
    for (const ImageLook& look : looks)
        squares += std::pow(likeness_of(look).xy - slope * likeness_of(look).xx, 2.0);
    return {slope, std::sqrt(squares) / xx};
}

bool has_light(const ImageLook& look) {
    const auto is_light = [](double value) { return std::isfinite(value) && value > 0.0; };
    return std::ranges::all_of(look.quotient, is_light) &&
           std::ranges::all_of(look.map_mean, is_light);
}

// Those with light in every channel, to which lines are fitted.
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
         .what = fmt::format("{:.2g} % of the samples are {:g}, the largest number of all, as when "
                             "a sensor saturates{}",
                             kPerCent * share,
                             all.top,
                             std::isfinite(white) ? fmt::format("; the white level is {:g}", white)
                                                  : "; there is no white level")});
}

double ratio_of(double a, double b) {
    return std::max(a, b) / std::min(a, b);
}

bool check_greens(std::span<const ImageLook> looks, Mosaic mosaic, std::vector<Suspicion>& found) {
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
    if (greens.empty()) return false;
    const double green = double{upper_median(greens)} - 1.0;
    const double other = double{upper_median(others)} - 1.0;
    if (green < kGreenSites || other > kOtherSites * green) return false;
    found.push_back({.about = "bayer",
                     .what = fmt::format("the two sites that {} makes green differ by {:.0f} %, "
                                         "the other two by {:.1f} %: the pattern is {}",
                                         mosaic_name(mosaic),
                                         kPerCent * green,
                                         kPerCent * other,
                                         is_green_beside ? "GRBG or GBRG" : "RGGB or BGGR")});
    return true;
}

std::string range_of(std::span<const ImageLook> looks) {
    const auto [lowest, highest] = std::ranges::minmax(looks, {}, &ImageLook::altitude_m);
    return fmt::format("{:g} to {:g} m", *lowest.altitude_m, *highest.altitude_m);
}

// Logarithms of one channel over the images: of the light, and of the images themselves.
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

struct AltitudeUnit {
    std::string_view name;
    double metres;
};
constexpr std::array kAltitudeUnits{AltitudeUnit{"millimetres", 1e-3},
                                    AltitudeUnit{"centimetres", 1e-2},
                                    AltitudeUnit{"decimetres", 0.1},
                                    AltitudeUnit{"feet", 0.3048},
                                    AltitudeUnit{"fathoms", 1.8288},
                                    AltitudeUnit{"kilometres", 1e3}};

// A wrong unit, or a wrong column.
bool check_unit(std::span<const ImageLook> looks,
                std::optional<double> rig_altitude_m,
                std::vector<Suspicion>& found) {
    if (!rig_altitude_m || looks.empty() || !has_altitudes(looks)) return false;
    std::vector<float> altitudes_m;
    for (const ImageLook& look : looks) altitudes_m.push_back(static_cast<float>(*look.altitude_m));
    const double ratio = double{upper_median(altitudes_m)} / *rig_altitude_m;
    const auto is_near = [](double r) { return r <= kOtherUnit && r >= 1.0 / kOtherUnit; };
    if (is_near(ratio)) return false;
    std::string unit = "; no unit of length makes them agree: another column or rig?";
    double nearest = kOtherUnit;
    for (const AltitudeUnit& one : kAltitudeUnits) {
        const double other = std::max(ratio * one.metres, 1.0 / (ratio * one.metres));
        if (!(other < nearest)) continue;
        nearest = other;
        unit = fmt::format("; {:.3g} times if they are in {}", ratio * one.metres, one.name);
    }
    found.push_back({.about = "altitude",
                     .what = fmt::format("the images' altitudes, {}, are {:.3g} times the rig's "
                                         "sled.altitude_m, {:g} m, in the middle; usual: up to "
                                         "{:g} times either way{}",
                                         range_of(looks),
                                         ratio,
                                         *rig_altitude_m,
                                         kOtherUnit,
                                         unit)});
    return true;
}

// The power of the maps' light that the images' brightness follows: over the images, and within
// each.
struct Powers {
    Line over;
    Line within;
};
Powers powers_of(std::span<const ImageLook> looks, bool has_line) {
    Powers powers;
    if (has_line) {
        const auto [maps, images] = brightness_of(looks, kGreenChannel);
        powers.over = line_through(maps, images);
    }
    powers.within = line_of_all(
        looks,
        [](const ImageLook& look) -> const Likeness& { return look.frame.to_map; },
        kFallOff);
    return powers;
}

bool is_known(const Line& line) {
    return std::isfinite(line.error);
}

// Near to this power, and certainly less than 1.
bool is_near(const Line& line, double power, double within) {
    return is_known(line) && std::abs(line.slope - power) <= within &&
           1.0 - line.slope >= kStandardErrors * line.error;
}

bool check_encoding(std::span<const ImageLook> looks,
                    const Powers& powers,
                    std::vector<Suspicion>& found) {
    const Line& line = is_known(powers.over) ? powers.over : powers.within;
    const bool is_said = !looks.empty() && std::ranges::all_of(looks, &ImageLook::says_srgb);
    const auto is_linear = [](const Line& one) { return is_known(one) && one.slope >= kLinear; };
    const bool is_denied = is_linear(powers.over) || is_linear(powers.within);
    const bool is_seen = is_near(powers.within, kEncoded, kGamma) && is_known(powers.over) &&
                         std::abs(powers.over.slope - kEncoded) <= 2.0 * kGamma;
    if (!is_seen && (!is_said || is_denied)) return false;
    std::string what = "the images look gamma-encoded, as a camera's JPEG is";
    if (is_known(line)) {
        what += fmt::format(
            ": brightness goes as the light to the power {:.2g}; expected: 1 for raw images; 0.45 "
            "for sRGB",
            line.slope);
    }
    if (is_said) what += "; their files are tagged as sRGB";
    found.push_back({.about = "encoding", .what = what + ". Pass raw images"});
    return true;
}

bool check_corrected(const Powers& powers, std::vector<Suspicion>& found) {
    const bool is_even_over = !is_known(powers.over) || is_near(powers.over, 0.0, 2 * kEven);
    if (!is_near(powers.within, 0.0, kEven) || !is_even_over) return false;
    found.push_back(
        {.about = "corrected",
         .what = fmt::format("the images are even where the maps fall off: brightness goes as the "
                             "light to the power {:.2g} within them; expected: 1. Are they "
                             "corrected already?",
                             powers.within.slope)});
    return true;
}

// For one channel of an image.
struct Darkness {
    std::size_t channel = 0;
    double darkest = 0.0;  // d
    double median = 0.0;   // q
    double share = 0.0;    // rho
};

struct Offset {
    double b = 0.0;
    double error = std::numeric_limits<double>::infinity();
};

// d = b (1 - phi_c rho) + phi_c rho q by least squares, each row divided by its d since errors are
// relative; the phi that multiplies b is that of the previous step.
Offset offset_of(const std::vector<Darkness>& all, std::size_t images) {
    constexpr int kRefinements = 4;
    // The channels of an image show one floor: they count as one observation.
    const double freedom = static_cast<double>(images) - 4.0;
    if (all.empty() || freedom < 1.0) return {};
    Eigen::Vector4d fit(0.0, 1.0, 1.0, 1.0);
    Offset offset;
    for (int step = 0; step < kRefinements; ++step) {
        Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(std::ssize(all), 4);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto& [channel, d, q, rho] = all[i];
            const auto c = static_cast<Eigen::Index>(1 + channel);
            const auto row = static_cast<Eigen::Index>(i);
            rows(row, 0) = (1.0 - fit(c) * rho) / d;
            rows(row, c) = rho * q / d;
        }
        const Eigen::VectorXd ones = Eigen::VectorXd::Ones(rows.rows());
        const Eigen::Matrix4d normal = rows.transpose() * rows;
        // For a mono camera, two channels have no row.
        const Eigen::Matrix4d inverse = normal.completeOrthogonalDecomposition().pseudoInverse();
        fit = inverse * (rows.transpose() * ones);
        offset = {.b = fit(0),
                  .error = std::sqrt((ones - rows * fit).squaredNorm() / freedom * inverse(0, 0))};
    }
    return offset;
}

bool check_below_black(std::span<const ImageLook> looks, std::vector<Suspicion>& found) {
    std::vector<float> lowest;
    double brightest = 0.0;
    for (const ImageLook& look : looks) {
        lowest.push_back(static_cast<float>(std::ranges::min(look.frame.darkest)));
        brightest = std::max(brightest, std::ranges::max(look.frame.median));
    }
    if (lowest.empty()) return false;
    const double below = -double{upper_median(lowest)};
    if (!(brightest > 0.0) || below < kOffset * brightest) return false;
    found.push_back({.about = "black-level",
                     .what = fmt::format("the darkest part of most images is {:.3g} below the "
                                         "black level, which is too high: light is not negative",
                                         below)});
    return true;
}

bool check_black(std::span<const ImageLook> looks, std::vector<Suspicion>& found) {
    if (looks.size() < kEnoughImages) return false;
    std::vector<Darkness> all;
    double least = std::numeric_limits<double>::infinity();
    double brightest = 0.0;
    for (const ImageLook& look : looks) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            const Darkness one{.channel = c,
                               .darkest = look.frame.darkest[c],
                               .median = look.frame.median[c],
                               .share = look.frame.map_share[c]};
            if (one.median == 0.0) continue;                               // a mono camera
            if (!(one.darkest > 0.0) || !(one.share > 0.0)) return false;  // it reaches black
            least = std::min(least, one.darkest);
            brightest = std::max(brightest, one.median);
            all.push_back(one);
        }
    }
    const Offset offset = offset_of(all, looks.size());
    const double b = offset.b;
    const double error = offset.error;
    // If the light hardly varies, anything fits as an offset.
    const auto is_varied = [&](std::size_t c) {
        double dimmest = std::numeric_limits<double>::infinity();
        double most = 0.0;
        for (const Darkness& one : all) {
            if (one.channel != c) continue;
            dimmest = std::min(dimmest, one.median - b);
            most = std::max(most, one.median - b);
        }
        return most > kVaried * dimmest;
    };
    if (!(is_varied(0) || is_varied(1) || is_varied(2)) || !(b >= kStandardErrors * error) ||
        b < kOffset * brightest || b < kMostOfDarkest * least || b > (1.0 + kBlockNoise) * least) {
        return false;
    }
    found.push_back(
        {.about = "black-level",
         .what = fmt::format("no part of any image is darker than {:.3g}, whatever the light: an "
                             "offset that light does not explain. Is the black level missing?",
                             least)});
    return true;
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

// The slope if the images are like the other map (1) and unlike their own (0); otherwise empty.
std::optional<double> like_other(std::span<const ImageLook> looks, Likeness ImageLook::*other) {
    const auto [slope, error] = line_of_all(
        looks, [other](const ImageLook& look) -> const Likeness& { return look.*other; }, kSpread);
    const bool is_like = slope >= std::max(kLikeness, kErrorsOfAttitude * error) &&
                         slope <= 1.0 + std::max(1.0 - kLikeness, kErrorsOfAttitude * error);
    return is_like ? std::optional(slope) : std::nullopt;
}

void check_attitude(std::span<const ImageLook> looks, std::vector<Suspicion>& found) {
    const std::optional<double> slope = like_other(looks, &ImageLook::as_radians);
    if (!slope) return;
    found.push_back(
        {.about = "attitude",
         .what = fmt::format("pitch and roll are all within {} degrees, and the images match the "
                             "angles read as radians ({:.2g}; 0 for degrees). Are they in radians?",
                             kSmall_deg,
                             *slope)});
}

// The correlation of the logarithms of altitudes and of the maps' depths; NaN if they are few.
double likeness_of_altitudes(std::span<const ImageLook> looks) {
    Eigen::ArrayX2d both(std::ssize(looks), 2);
    Eigen::Index count = 0;
    for (const ImageLook& look : looks) {
        if (!look.depth_m || !look.altitude_m) continue;
        both.row(count++) << std::log(*look.depth_m), std::log(*look.altitude_m);
    }
    if (count < static_cast<Eigen::Index>(kEnoughImages))
        return std::numeric_limits<double>::quiet_NaN();
    both.conservativeResize(count, 2);
    both.rowwise() -= both.colwise().mean().eval();
    const Eigen::Array2d spread = both.square().colwise().mean().sqrt();
    if (spread(1) < kSpread) return std::numeric_limits<double>::quiet_NaN();
    return (both.col(0) * both.col(1)).mean() / spread.prod();
}

void check_depth(std::span<const ImageLook> looks, std::vector<Suspicion>& found) {
    const auto tell = [&](std::string what) { found.push_back({"depth", std::move(what)}); };
    const double likeness = likeness_of_altitudes(looks);
    if (const auto other = like_other(looks, &ImageLook::as_other_convention)) {
        tell(
            fmt::format("the images match the other depth convention ({:.2g}; 0 for the one used). "
                        "Is --depth-is wrong?",
                        *other));
    } else if (const auto plane = like_other(looks, &ImageLook::as_plane)) {
        tell(
            fmt::format("the images match the navigation's plane better than their depth maps "
                        "({:.2g}; 0 for the maps). Do the maps, or the places over the "
                        "mesh, belong to other images?",
                        *plane));
    } else if (likeness < kLikeAltitudes) {
        tell(
            fmt::format("the depths of maps do not go with the navigation's altitudes "
                        "(correlation {:.2g}). Do the maps, or the places over the mesh, belong to "
                        "other images?",
                        likeness));
    }
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
    std::ranges::transform(site_planes(raw), medians.begin(), [&](SitePlane& site) {
        return double{upper_median(site.samples)} - static_cast<double>(black);
    });
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
    const auto is_lit = [&](float s) { return s > levels.black && s < levels.white; };
    LogPairs pairs;
    for (const Block& block : blocks_of(raw, levels, kGreenChannel, {&map, &other}, is_lit)) {
        const auto [light, of_other] = block.maps;
        if (light > 0.0 && of_other > 0.0) pairs.add(of_other / light, block.image / light);
    }
    return pairs.likeness();
}

FrameLook frame_look(const RawImage& raw, const SensorLevels& levels, const Lightmap& map) {
    const auto is_under_white = [&](float s) { return s < levels.white; };
    FrameLook look;
    LogPairs pairs;
    for (std::size_t c = 0; c < kChannels; ++c) {
        std::vector<float> images;
        std::vector<float> maps;
        double darkest = std::numeric_limits<double>::infinity();
        double map_there = 0.0;
        for (const Block& block : blocks_of(raw, levels, c, {&map, &map}, is_under_white)) {
            if (block.samples == 0.0) continue;
            const double image = block.image / block.samples;
            const double light = block.maps[0] / block.samples;
            images.push_back(static_cast<float>(image));
            maps.push_back(static_cast<float>(light));
            if (image < darkest) darkest = image, map_there = light;
            if (c == kGreenChannel && image > 0.0 && light > 0.0) pairs.add(light, image);
        }
        if (images.empty()) continue;
        look.darkest[c] = darkest;
        look.median[c] = double{upper_median(images)};
        look.map_share[c] = map_there / double{upper_median(maps)};
    }
    look.to_map = pairs.likeness();
    return look;
}

std::optional<Suspicion> turned_brightness(std::span<const ImageLook> looks) {
    const Brightness green = brightness_of(lit(looks), kGreenChannel);
    if (!is_turned(line_through(green.light, green.images))) return std::nullopt;
    return Suspicion{.about = "altitude",
                     .what = "brightness " + words_of_turned(green) +
                             ": poses of other images, or a wrong altitude column"};
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
        // A pattern with red and blue swapped is the same pattern shifted by a column and a row.
        what += fmt::format("; --bayer {} corrects this", mosaic_name(shifted(mosaic, 1, 1)));
    }
    return Suspicion{.about = "bayer", .what = std::move(what)};
}

std::vector<Suspicion> suspicions(std::span<const ImageLook> looks,
                                  Mosaic mosaic,
                                  std::optional<double> rig_altitude_m) {
    std::vector<Suspicion> found;
    check_white(looks, found);
    const bool is_pattern_wrong = is_bayer(mosaic) && check_greens(looks, mosaic, found);
    const std::vector<ImageLook> lit_looks = lit(looks);
    const std::size_t before = found.size();
    const bool has_line = has_altitudes(lit_looks) && !is_one_altitude(lit_looks);
    const Powers powers = powers_of(lit_looks, has_line);
    // The first problem found explains the symptoms of the others.
    if (!check_unit(looks, rig_altitude_m, found) && !check_below_black(looks, found) &&
        !check_black(lit_looks, found) && !check_encoding(lit_looks, powers, found) &&
        !check_corrected(powers, found)) {
        if (has_line) check_altitude(lit_looks, found);
        check_gains(lit_looks, found);
    }
    // At wrong altitudes colours vary wrongly, too; and with greens for red or blue.
    if (has_line && found.size() == before && !is_pattern_wrong) {
        if (const auto swapped = red_for_blue(lit_looks, mosaic)) found.push_back(*swapped);
    }
    check_attitude(looks, found);
    check_depth(looks, found);
    return found;
}

nlohmann::ordered_json to_json(const std::vector<Suspicion>& suspicions) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Suspicion& one : suspicions)
        json.push_back({{"about", one.about}, {"what", one.what}});
    return json;
}

std::optional<Suspicion> exposure_doubt(std::span<const ImageLook> looks, ExposureBy by) {
    if (is_told_by_exif(by)) return std::nullopt;
    constexpr double kOff = 0.2;
    const bool has_levels = by == ExposureBy::Model;
    std::vector<double> exposures;
    std::vector<double> levels;
    for (const ImageLook& look : looks) {
        const double quotient = look.quotient[kGreenChannel];
        if (!look.stated_exposure || !(*look.stated_exposure > 0.0)) continue;
        if (!has_levels && !(quotient > 0.0)) continue;
        exposures.push_back(std::log(*look.stated_exposure));
        levels.push_back(has_levels ? look.level : std::log(quotient));
    }
    const Line line = line_through(exposures, levels);
    if (!has_levels) {
        if (!is_known(line) || line.slope < 0.5 || line.slope < kErrorsOfExposure * line.error)
            return std::nullopt;
        return Suspicion{.about = "exposure",
                         .what = fmt::format("the Exif exposures vary {:.3g}-fold, and brightness "
                                             "over that of the light goes as their power {:.2g}: "
                                             "--exposure exif takes them into account",
                                             fold_of(exposures),
                                             line.slope)};
    }
    if (std::abs(line.slope - 1.0) < std::max(kOff, kStandardErrors * line.error))
        return std::nullopt;
    return Suspicion{.about = "exposure",
                     .what = fmt::format("the Exif exposures vary {:.3g}-fold, but the images' "
                                         "levels go as their power {:.2g}; expected: 1",
                                         fold_of(exposures),
                                         line.slope)};
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
    return fmt::format("altitudes, red for blue: {} images, all at one altitude ({})",
                       lit_looks.size(),
                       range_of(lit_looks));
}

}  // namespace aphotic
