// SPDX-License-Identifier: BSD-3-Clause
//
// The folder that a command writes to: made, locked, and rid of what killed runs left half written.
#pragma once

#include "base/folder_lock.h"

#include <filesystem>
#include <vector>

namespace aphotic::cli {

// Until the lock goes no other command takes the folder.
[[nodiscard]] FolderLock claim_folder(const std::filesystem::path& folder);

// The same with all folders below, where a command makes them as it goes.
[[nodiscard]] FolderLock claim_tree(const std::filesystem::path& folder);

// The same for a command that also reads what stands in another folder, which is not to change
// meanwhile; it may be the same one.
[[nodiscard]] std::vector<FolderLock> claim_folders(const std::filesystem::path& written,
                                                    const std::filesystem::path& read);

}  // namespace aphotic::cli
