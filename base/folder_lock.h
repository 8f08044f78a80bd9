// SPDX-License-Identifier: BSD-3-Clause
//
// One run at a time in an output folder.
//
// The lock is the kernel's own (flock) on the folder itself: no file of ours lies in the user's
// way, a read-only folder can be locked too, and it is gone with the process that holds it, however
// that ended. A kernel locks for itself alone: two machines in one network folder are not kept
// apart.
#pragma once

#include <filesystem>

namespace aphotic {

enum class FolderUse {
    Read,   // others may read as well
    Write,  // nobody else may
};

class FolderLock {
  public:
    // Does not wait: a RunError names the folder and, where the kernel tells it, the process that
    // has it. Where the folder is missing, or its file system knows no locks, nothing is locked.
    FolderLock(const std::filesystem::path& folder, FolderUse use);
    ~FolderLock();
    FolderLock(FolderLock&& other) noexcept;
    FolderLock& operator=(FolderLock&&) = delete;

  private:
    int descriptor_;
};

}  // namespace aphotic
