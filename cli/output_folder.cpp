// SPDX-License-Identifier: BSD-3-Clause
#include "cli/output_folder.h"

#include "base/atomic_file.h"

#include <system_error>

namespace aphotic::cli {

namespace fs = std::filesystem;

FolderLock claim_folder(const fs::path& folder) {
    make_folder(folder);
    FolderLock lock(folder, FolderUse::Write);
    for (const char* part :
         {"", "povray", "povray/frames", "povray/logs", "reference", "settings"}) {
        remove_abandoned_files(folder / part);
    }
    return lock;
}

FolderLock claim_tree(const fs::path& folder) {
    FolderLock lock = claim_folder(folder);
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_directory()) remove_abandoned_files(entry.path());
    }
    return lock;
}

std::vector<FolderLock> claim_folders(const fs::path& written, const fs::path& read) {
    std::vector<FolderLock> locks;
    locks.push_back(claim_folder(written));
    std::error_code ignored;
    if (!fs::equivalent(written, read, ignored)) locks.emplace_back(read, FolderUse::Read);
    return locks;
}

}  // namespace aphotic::cli
