// SPDX-License-Identifier: BSD-3-Clause
//
// A folder of our own among the temporary ones, gone when the object is.
#pragma once

#include <filesystem>

namespace aphotic {

class ScratchFolder {
  public:
    // Throws RunError when none can be made.
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace aphotic
