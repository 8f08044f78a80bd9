// SPDX-License-Identifier: BSD-3-Clause
//
// What a sweep's tasks read beside their rigs, as a text that differs once it does:
//
//   images, and files that arguments name      by name, size and time of last change, as make(1)
//                                              looks at them: a survey is too large to be read
//   a scene, and what it #includes by names    by content
//   of files beside it
//
// What is not there counts as nothing: the command will say so.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace aphotic {

struct SweepInputs {
    std::filesystem::path home;  // where relative paths start
    std::vector<std::string> images{};
    std::vector<std::string> arguments{};
    std::filesystem::path scene{};  // none: none
    std::filesystem::path folder;   // the sweep's own, whose images are results
};

[[nodiscard]] std::string state_of(const SweepInputs& inputs);

}  // namespace aphotic
