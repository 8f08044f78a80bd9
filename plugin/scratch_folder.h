// SPDX-License-Identifier: BSD-3-Clause
//
// A temporary folder, removed with the object, also after an interruption. Only SIGKILL leaves it.
#pragma once

#include "base/interruption.h"

#include <filesystem>

namespace aphotic {

class ScratchFolder {
  public:
    // Throws RunError if it cannot be made.
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    InterruptionHold hold_;
    std::filesystem::path path_;
};

}  // namespace aphotic
