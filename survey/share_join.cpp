// SPDX-License-Identifier: BSD-3-Clause
#include "survey/share_join.h"

#include "base/atomic_file.h"
#include "base/folder_lock.h"
#include "base/share.h"
#include "survey/journal.h"

#include <algorithm>
#include <map>
#include <string>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

std::size_t join_share(const fs::path& share,
                       const std::vector<ImageFile>& files,
                       const ImageRunOptions& options,
                       Journal& journal) {
    const FolderLock lock(share, FolderUse::Write);
    if (!fs::exists(share / kJournal)) return 0;
    const std::map<std::string, JournalEntry> done =
        parse_journal(read_text_file(share / kJournal, kMostJournal_bytes));
    std::size_t count = 0;
    for (const ImageFile& file : files) {
        const auto entry = done.find(file.name.string());
        if (entry == done.end()) continue;
        const std::vector<fs::path> results = results_of(file, options.format);
        const bool are_there = std::ranges::all_of(
            results, [&](const fs::path& result) { return fs::exists(share / result); });
        if (!are_there) continue;
        for (const fs::path& result : results) {
            make_folder((options.folder / result).parent_path());
            fs::rename(share / result, options.folder / result);
        }
        journal.note(entry->first, entry->second.digest, results, entry->second.counts);
        ++count;
    }
    remove_joined(share, {kJournal, kCorrectionNotes, kReportPage});
    return count;
}

}  // namespace

std::size_t join_shares(const std::vector<ImageFile>& files, const ImageRunOptions& options) {
    const std::vector<fs::path> shares = share_folders(options.folder);
    if (shares.empty()) return 0;
    Journal journal(options.folder / kJournal);
    std::size_t count = 0;
    for (const fs::path& share : shares) count += join_share(share, files, options, journal);
    return count;
}

}  // namespace aphotic
