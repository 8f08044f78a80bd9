// SPDX-License-Identifier: BSD-3-Clause
#include "base/folder_lock.h"

#include "base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <regex>
#include <string>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

// From /proc/locks, whose lines read "1: FLOCK  ADVISORY  WRITE 1234 00:2f:567 0 EOF": process,
// device, inode. 0 stands for a process that we cannot see.
std::string holder_of(int descriptor) {
    struct stat folder {};
    if (::fstat(descriptor, &folder) != 0) return "";
    const std::regex line(fmt::format(R"(FLOCK +ADVISORY +\w+ +([1-9]\d*) +{:02x}:{:02x}:{} )",
                                      major(folder.st_dev),
                                      minor(folder.st_dev),
                                      folder.st_ino));
    std::ifstream locks("/proc/locks");
    std::smatch found;
    for (std::string text; std::getline(locks, text);) {
        if (std::regex_search(text, found, line)) return found[1].str();
    }
    return "";
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder, FolderUse use)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (descriptor_ < 0) return;
    const int operation = (use == FolderUse::Write ? LOCK_EX : LOCK_SH) | LOCK_NB;
    if (::flock(descriptor_, operation) == 0 || errno != EWOULDBLOCK) return;
    const std::string holder = holder_of(descriptor_);
    ::close(descriptor_);
    throw RunError("{}: another aphotic is at work in this folder{}; allowed: one at a time",
                   folder.string(),
                   holder.empty() ? "" : fmt::format(" (process {})", holder));
}

FolderLock::~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

}  // namespace aphotic
