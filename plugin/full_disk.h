// SPDX-License-Identifier: BSD-3-Clause
//
// Whether a disk was full while POV-Ray wrote to it. POV-Ray 3.7 ends well all the same when it
// cannot write its image or its log, so that what is seen of it is something else.
#pragma once

#include <filesystem>
#include <string>

namespace aphotic {

// A line to stand below another message, or nothing: "\nDIR: No space left on device: 3 KiB are
// left".
[[nodiscard]] std::string words_of_full_disk(const std::filesystem::path& folder);

}  // namespace aphotic
