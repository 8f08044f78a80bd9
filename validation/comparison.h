// SPDX-License-Identifier: BSD-3-Clause
//
// The difference between two images, sample by sample, absolute scale included.
//
//   e_i = (a_i - b_i) / max(|b_i|, floor)
//
// a      the image under test         b  the reference
// floor  the level of black: below it, differences are relative to the floor, so that a
//        rounding error of black is not an infinite error
//
// Reported are, for |e|, the largest and its place, the 99.9 percentile (nearest rank) and the root
// mean square; and the mean of e, with its sign. No factor is fitted here; scaling.h does that.
//
// Samples on edges, where rounding decides on which side a pixel's centre falls, are counted and
// measured separately. For those in penumbrae (validation.h), the number is reported, and the
// difference of a from the emitters themselves, which no bound covers. A comparison holds if the
// largest |e| off the edges is within the bound, all samples are finite, on edges too, and at least
// one is off the edges. Samples never observed, as in an average of images, are only counted.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <span>
#include <string>

namespace aphotic {

struct Comparison {
    std::string name;  // such as "550 nm" or "R"
    double max_error = 0.0;
    int column = 0;  // of max_error
    int row = 0;
    double percentile_999 = 0.0;
    double rms_error = 0.0;
    double mean_error = 0.0;  // signed
    std::size_t compared = 0;
    std::size_t on_edges = 0;
    double max_error_on_edges = 0.0;
    std::size_t in_penumbrae = 0;  // among those compared
    double max_error_of_penumbrae = 0.0;
    std::size_t unobserved = 0;
    std::size_t not_finite = 0;  // samples of a or b that are NaN or inf, edges included
    double bound = 0.0;
    double floor = 0.0;
    std::size_t under_floor = 0;  // samples compared whose |b| is below the floor

    [[nodiscard]] bool holds() const {
        return compared > 0 && not_finite == 0 && max_error <= bound;
    }
};

// The mark of a sample that is compared separately.
inline constexpr unsigned char kOnEdge = 1;
inline constexpr unsigned char kUnobserved = 2;

// The planes are rows of width_px samples. marks: 0 or one of these for each; may be empty.
[[nodiscard]] Comparison compare_planes(std::string name,
                                        std::span<const float> a,
                                        std::span<const double> b,
                                        int width_px,
                                        std::span<const unsigned char> marks,
                                        double floor,
                                        double bound);

// The errors and counts by their names.
[[nodiscard]] nlohmann::ordered_json comparison_json(const Comparison& comparison);

// e of one sample; NaN if either is not finite.
[[nodiscard]] double relative_error(double a, double b, double floor);

}  // namespace aphotic
