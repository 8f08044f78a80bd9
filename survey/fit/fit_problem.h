// SPDX-License-Identifier: BSD-3-Clause
//
// What a fit looks for: which numbers of a rig are free, where the search begins, within which
// bounds, and how far from there each may plausibly be.
#pragma once

#include "rig/file/rig_text.h"
#include "survey/fit/fit_light.h"

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr std::size_t kMostParts = 40;

struct FitOptions {
    FitBeamKind beam = FitBeamKind::Table;
    // Of a table; none: kMostParts, or of many images as many as they tell (fit_parts.h).
    std::optional<std::size_t> parts{};
    bool has_beam_each = false;  // each strobe its own
    // beam, aim, power, water, vignetting, floor, altitude, attitude, gain, or the key of a number;
    // none: the first six, as far as they can be told. floor is its brightness, which in water that
    // scatters the veil tells. Its colour is free besides, unless the channels' gains are: these
    // two cannot be parted.
    std::optional<std::vector<std::string>> free{};
    // Standard deviations of what the navigation tells, image by image.
    double altitude_error_m = 0.02;
    double attitude_error_rad = 0.0087;
    int threads = 1;
};

// The group of the colour's numbers, which nobody asks for.
inline constexpr const char* kFloorColour = "the floor's colour";

// A number that is free: where it begins, how far from there it may plausibly be, its bounds.
struct FreeNumber {
    FitNumber number;
    std::string key;
    double plausible = 1.0;
    double least = -std::numeric_limits<double>::infinity();
    double most = std::numeric_limits<double>::infinity();
    double per_unit = 1.0;  // the key's, of the state's
    std::string group;      // as it is asked for
    double start = 0.0;
};

struct FitProblem {
    FitState state;
    std::vector<FreeNumber> free;

    [[nodiscard]] std::vector<FitNumber> numbers() const;
    // x: the numbers, each over what is plausible. Where they began, where they are, and the state
    // where they are these.
    [[nodiscard]] Eigen::VectorXd start() const;
    [[nodiscard]] Eigen::VectorXd now() const;
    [[nodiscard]] FitState at(const double* x) const;
    [[nodiscard]] Eigen::VectorXd plausible() const;
};

// Shares, then numbers.
[[nodiscard]] Eigen::VectorXd values_of(const Eigen::VectorXd& shares, const FitProblem& problem);

// How far off the axis a beam's table goes, and what a block spans, by which cones are softened.
struct FitAngles {
    double widest_rad = 0.0;
    double block_rad = 0.0;
};
// An InputError for a word that is none.
[[nodiscard]] FitProblem fit_problem(const RigText& text,
                                     const FitOptions& options,
                                     const FitAngles& angles);

// Words of FitOptions::free of which the problem has nothing free.
[[nodiscard]] std::vector<std::string> words_fixed_in(const FitProblem& problem);

}  // namespace aphotic
