// SPDX-License-Identifier: BSD-3-Clause
//
// What a sweep's file says: a command, a rig, and which of the rig's keys take which values.
//
//   command   = "render"                      # render, trace, lightmap, validate, correct or fit
//   rig       = "habcam.toml"
//   arguments = ["--tolerance", "1e-3"]       # the command's own
//
//   [[vary]]
//   key    = "water.multiple"
//   values = [0.5, 1, 2]
//
//   [[vary]]
//   key   = "strobe.fore.aim.tilt_deg"
//   range = [20, 30, 5]                       # first, last, step: 20, 25, 30
//
//   [[vary]]
//   key     = "sled.altitude_m"
//   between = [1, 4]                          # of a Latin hypercube, see samples and seed
//
// Lists and ranges are combined, each value with each; all keys with `between` together are one
// Latin hypercube of `samples` points: of as many equal parts of each key's interval, each holds
// one point, which the seed draws. The last key changes first, and the hypercube before all others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace aphotic {

// What a key of a rig may be set to.
using SweepValue = std::variant<double, std::string, std::vector<double>>;

struct SweptKey {
    std::string key;
    std::vector<SweepValue> values{};
    std::vector<double> between{};  // two ends, in place of values
};

struct SweepFile {
    std::string command;
    std::filesystem::path rig;  // found beside the sweep's file, as all that arguments name is
    std::vector<std::string> images{};  // of correct and fit
    std::vector<std::string> arguments{};
    int cores = 1;   // of each task
    int shares = 1;  // of each survey's images: of correct
    std::vector<SweptKey> vary{};
    int samples = 0;
    std::uint64_t seed = 1;
};

inline constexpr std::size_t kMostTasks = 20000;

// name: of the file, in messages. Throws InputError.
[[nodiscard]] SweepFile parse_sweep_file(std::string_view toml, const std::string& name);

// The values of each point, in the order of the keys.
using SweepPoint = std::vector<SweepValue>;
[[nodiscard]] std::vector<SweepPoint> points_of(const SweepFile& sweep);

// As a table's cell has it: numbers with the fewest digits that give them back, those of a list
// with blanks between them.
[[nodiscard]] std::string words_of(const SweepValue& value);

}  // namespace aphotic
