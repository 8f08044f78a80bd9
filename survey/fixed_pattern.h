// SPDX-License-Identifier: BSD-3-Clause
//
// The part of images' residuals that stays in place from image to image. Floors move past, so a
// pattern that does not is an error of the light: of beams, aims, powers, lens or black level.
//
//   r_i = log(observed / expected)  of image i, by place          d = r(neighbour) - r
//
//   w = 3 / (2 + (d - D)^2 / sigma^2)     D = sum w d / sum w     over images, for each pair
//
// sigma  from the median of |d|, for a t of two degrees of freedom: edges of patches count little
//
// The pattern is the field f of mean 0 whose differences are closest to D, weighted by sum w. By
// chance, floors leave a pattern too. It is estimated from the same images, each with the sign of
// its d drawn at random, kDraws times, and a D of each draw: what they have in common cancels, and
// texture stays as rough and as correlated as it is. A pattern exceeds chance if it is larger than
// that of every draw.
//
// Limits: it shows neither the overall level nor an error that varies with the pose. Less than
// about ten images have too few signs to exceed chance.
//
// E. J. G. Pitman, "Significance tests which may be applied to samples from any populations",
// J. R. Stat. Soc. Suppl. 4, 1937, 119 (random signs).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr double kMedianOfT2 = 0.8165;  // of |t|, with two degrees of freedom
inline constexpr int kDraws = 200;
// Smaller patterns are tolerated even if they exceed chance.
inline constexpr double kMostPattern = 0.02;

struct FixedPattern {
    std::size_t images = 0;
    std::vector<float> logarithm{};  // by place; NaN: unseen
    double rms = 0.0;
    double by_chance = 0.0;       // rms over the draws
    double most_by_chance = 0.0;  // the largest draw

    [[nodiscard]] bool exceeds_chance() const { return rms > most_by_chance; }
    // Without the part that chance explains.
    [[nodiscard]] double excess() const {
        return std::sqrt(std::max(0.0, rms * rms - by_chance * by_chance));
    }
    [[nodiscard]] bool is_too_large() const { return exceeds_chance() && excess() > kMostPattern; }
};

// "a fixed pattern of 8.4 % over 16 images, where floors alone leave 1.2 %"; empty for no images.
[[nodiscard]] std::string words_of(const FixedPattern& pattern);

// Null for no images.
[[nodiscard]] nlohmann::ordered_json to_json(const FixedPattern& pattern);

// residuals: of each image row by row, `across` in a row; NaN: unseen.
[[nodiscard]] FixedPattern fixed_pattern(std::span<const std::vector<float>> residuals,
                                         std::size_t across);

}  // namespace aphotic
