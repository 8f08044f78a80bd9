// SPDX-License-Identifier: BSD-3-Clause
//
// Better places for a rig's strobes: a search over a space (design_space.h) that improves the
// evenness, the signal to noise or the coverage of the floor's light (evenness.h), for the worst
// pose of an envelope.
//
//   goal       largest              at least keep times the start's
//   Evenness   U0                   signal to noise, coverage
//   Signal     signal to noise      U0, coverage
//   Coverage   coverage             U0, signal to noise
//
// Coverage is kept because U0 is blind to a small bright spot, which hardly moves the mean.
//
// The search (maximise.h) uses a small image, kSearched_px along its longer side, and few poses:
// the ends of each given range, and its middle. In water that scatters the signal to noise is that
// of kVeilSearched_px. Every design it evaluates counts, also those found on the way to other
// goals: a candidate is one that no other equals or beats in all figures.
//
// Designs are judged as the user gets them: the rig's text with its rounded numbers, read again, on
// an image of up to kJudged_px, at the ends and the middle of each range, in all combinations. The
// best of the search's candidates by that judgement is the design; if none is better than the start
// and keeps the required figures, it is the start: a design is never worse than its start.
//
// The front is the trade-off of evenness against signal: designs that no other beats in both, and
// that keep the coverage.
//
// Limits: a search does not prove that nothing is better; between the poses judged, figures may be
// worse than at them. The same request gives the same result, whatever the number of threads.
#pragma once

#include "lightmap/design_space.h"
#include "lightmap/evenness.h"
#include "lightmap/lightmap.h"
#include "rig/rig.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr int kSearched_px = 170;
inline constexpr int kVeilSearched_px = 12;
inline constexpr int kJudged_px = 512;

using Ends = std::array<double, 2>;  // the smaller first

struct Envelope {
    Ends altitude_m{};
    Ends pitch_rad{};
    Ends roll_rad{};
};

[[nodiscard]] Envelope envelope_of(const Sled& sled);
// Ends of all ranges, in all combinations, and the middle of all.
[[nodiscard]] std::vector<Sled> corner_poses(const Envelope& envelope);
// Ends and middles, in all combinations.
[[nodiscard]] std::vector<Sled> grid_poses(const Envelope& envelope);

enum class DesignGoal { Evenness, Signal, Coverage };
inline const std::map<std::string, DesignGoal> kDesignGoals{{"evenness", DesignGoal::Evenness},
                                                            {"signal", DesignGoal::Signal},
                                                            {"coverage", DesignGoal::Coverage}};

// By goal.
inline constexpr std::array<double LightFigures::*, 3> kGoalFigures{
    &LightFigures::evenness, &LightFigures::signal_to_noise, &LightFigures::coverage};
[[nodiscard]] constexpr double LightFigures::*figure_of(DesignGoal goal) {
    return kGoalFigures.at(static_cast<std::size_t>(goal));
}

struct DesignRequest {
    DesignFreedom freedom;
    Envelope envelope;
    DesignGoal goal = DesignGoal::Evenness;
    double keep = 1.0;
    double level = 0.5;  // of coverage
    int evaluations = 10000;
    std::uint64_t seed = 1;
    int threads = 1;
    std::function<void(int done, int of_all)> progress{};  // may be empty
};

// As judged.
struct JudgedPose {
    Sled sled;
    LightFigures figures;
};

struct Design {
    std::string toml;
    std::vector<StrobePlace> places;  // by strobe, as read again
    LightFigures figures;             // the worst of all poses
    std::vector<JudgedPose> poses{};
};

struct DesignResult {
    Design start;
    Design best;  // the start itself if nothing better was found
    bool is_better = false;
    std::vector<Design> front{};  // by signal, the least first
    int evaluations = 0;
    std::size_t numbers = 0;  // free ones
};

// For a rig with the bare floor. Throws InputError if the start is not allowed, or leaves pixels
// without light.
[[nodiscard]] DesignResult design(const RigText& text, const DesignRequest& request);

// The rig with an image this small, with the same view; unchanged if it is smaller.
[[nodiscard]] Rig with_longer_side(Rig rig, int longer_px);

}  // namespace aphotic
