// SPDX-License-Identifier: BSD-3-Clause
//
// Both renderers at the extremes: what a rig may ask for and a sled never does, each case held
// against the answer in long double (exact_light.h).
//
//   e = (a - b) / max(|b|, floor)       a a renderer's value, b the answer
//
// floor, what counts as black: for POV-Ray what its frames can hold (validation.h), and in any case
// the smallest normal float, which is what images hold; for the tracer kTracedFloor.
//
// The cases stand in extremes.toml, each an ordinary rig with one value changed, and what is
// expected of it. A case is as expected, or the table is wrong: there is no third way.
#pragma once

#include "rig/rig.h"
#include "validation/validation.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// The tracer's bounds of |e|: a double's rounding, through sums and exponentials, and for the
// signals its spectral grid's (tracer.h).
inline constexpr double kTracedRadianceBound = 1e-11;
inline constexpr double kTracedSignalBound = 2e-8;
// Where the water scatters: kVeilTolerance, and the rounding of distances of 100 m beside
// kVeilBeside_m.
inline constexpr double kTracedVeilBound = 1e-8;
// The tracer's light ends where the water has left e^-700 of it (tracer.h); the rest is for the
// brightest lamps that a rig may have.
inline constexpr double kTracedFloor = 1e-280;

enum class StressAnswer {
    Holds,    // every error within its bound, and something to be seen
    Faint,    // the same, but all that there is to be seen is under a floor
    Black,    // the same, and both images are zero throughout
    Refused,  // the program says why not
    Grows     // an image, finite, out of bounds
};
[[nodiscard]] std::string_view answer_word(StressAnswer answer);

// extremes.toml, as it travels inside the library.
struct StressSheet {
    std::string_view name;
    std::string_view text;
};
[[nodiscard]] std::span<const StressSheet> stress_sheet();

struct StressTable {
    std::string file;
    std::string text;
};

struct StressCase {
    std::string group;    // such as "water"
    std::string extreme;  // what is changed, in words
    std::string value;    // and to what
    std::string name;     // a folder's, unique
    std::string rig;      // TOML
    std::vector<StressTable> tables;
    std::optional<int> peak_log2;        // of the frames' exposure, if not the usual
    std::vector<double> wavelengths_nm;  // none: as a render plans them
    StressAnswer expected = StressAnswer::Holds;
    std::vector<std::string> says;  // one of these stands in the words of a refusal
};

// width_px: of every image whose size is not what the case is about; the field of view stays.
[[nodiscard]] std::vector<StressCase> stress_cases(int width_px);

struct StressFound {
    StressCase asked;
    StressAnswer answer = StressAnswer::Holds;
    std::string said;              // why it was refused
    double peak = 0.0;             // largest radiance of the answer, over pixels and wavelengths
    double povray_radiance = 0.0;  // largest |e|, off the edges
    double povray_signal = 0.0;
    double promise = 0.0;  // the plan's, of the worst channel
    double traced_radiance = 0.0;
    double traced_signal = 0.0;
    std::size_t on_edges = 0;

    // A refusal for another reason, such as a POV-Ray that fails, is not.
    [[nodiscard]] bool as_expected() const;
};

// How a case is rendered through POV-Ray: its rig, its name's folder. Throws InputError where a
// render does.
using StressRender = std::function<RenderedImages(
    const Rig& rig, const StressCase& asked, const std::filesystem::path& folder)>;

// Writes the case's rig into the folder, reads it as a user's, renders, traces, and compares.
[[nodiscard]] StressFound measure_stress(const StressCase& asked,
                                         const std::filesystem::path& folder,
                                         const StressRender& render);

// All cases, each in the folder of its name: as many at a time as keep the cores busy, for a case
// mostly waits for POV-Ray, which starts by sleeping. progress: cases done.
[[nodiscard]] std::vector<StressFound> measure_stress(
    std::span<const StressCase> cases,
    const std::filesystem::path& folder,
    int cores,
    const StressRender& render,
    const std::function<void(std::size_t)>& progress);

[[nodiscard]] std::string stress_json(std::span<const StressFound> found);
// stress.json, and stress.md with a table for people.
void write_stress(std::span<const StressFound> found, const std::filesystem::path& folder);

}  // namespace aphotic
