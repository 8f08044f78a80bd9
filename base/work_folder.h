// SPDX-License-Identifier: BSD-3-Clause
//
// A folder that long work writes to: one run at a time, which goes on where an interrupted one
// stopped, alone or as one of several shares.
//
// Lock. The kernel's own (flock) on the folder itself: no file of ours lies in the user's way, a
// read-only folder can be locked too, and it is gone with the process that holds it, however that
// ended. A kernel locks for itself alone: two machines in one network folder are not kept apart.
//
// Journal. What is done, noted as it is done: one line of JSON for each piece of work, appended
// once its files are in their places. A line that an interruption cut short, or that is not ours,
// is passed over when the journal is read again; of several lines of one name the last counts. A
// piece of work counts as done while its digest, which stands for all that its result depends on,
// is the same, and its files are there in the size that was noted.
//
// Share. 2/4 is of each four pieces the second. Neighbours, such as the images of a dive, take
// alike long, and so do shares of this kind. What a share makes goes to a folder of its own,
// DIR/share-2-of-4, which no other task writes to. The same work without a share takes it from
// there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

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

// The folder, made, taken from all other runs until the lock goes, and rid of what killed ones left
// half written in it and in the folders below.
[[nodiscard]] FolderLock claim_folder(const std::filesystem::path& folder);

// The same for a run that also reads what stands in another folder, which is not to change
// meanwhile; it may be the same one.
[[nodiscard]] std::vector<FolderLock> claim_folders(const std::filesystem::path& written,
                                                    const std::filesystem::path& read);

// The same for work that has nothing to write until much later: a folder that cannot be made is
// found out before. It goes again where nothing came of it.
class WorkFolder {
  public:
    explicit WorkFolder(const std::filesystem::path& folder);
    ~WorkFolder();
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

  private:
    std::filesystem::path folder_;
    bool is_new_;
    FolderLock lock_;
};

// What was counted in a piece of work, such as its doubtful pixels.
using Counts = std::map<std::string, double>;

struct JournalEntry {
    std::string digest;
    std::map<std::string, std::uintmax_t> file_bytes{};
    Counts counts;
};

// By the name of the piece of work.
[[nodiscard]] std::map<std::string, JournalEntry> parse_journal(std::string_view text);

inline constexpr std::size_t kMostJournal_bytes = std::size_t{4} << 30U;  // ten million images

class Journal {
  public:
    // Reads the journal, if there is one, and writes it anew without what no longer counts.
    explicit Journal(std::filesystem::path file);

    // Files are beside the journal or below.
    [[nodiscard]] bool is_done(const std::string& name,
                               const std::string& digest,
                               const std::vector<std::filesystem::path>& files) const;

    // None when there is nothing of that name.
    [[nodiscard]] Counts counts(const std::string& name) const;

    // Not for several threads at once. A RunError when it cannot be written.
    void note(const std::string& name,
              const std::string& digest,
              const std::vector<std::filesystem::path>& files,
              const Counts& counts);

  private:
    std::filesystem::path file_;
    std::map<std::string, JournalEntry> entries_;
    std::ofstream out_;
};

struct WorkShare {
    std::size_t number = 1;  // from 1
    std::size_t of = 1;

    [[nodiscard]] bool is_whole() const { return of == 1; }
    // piece: counted from 0.
    [[nodiscard]] bool has(std::size_t piece) const { return piece % of == number - 1; }
};

inline constexpr std::size_t kMostShares = 100000;

// Of "2/4". Throws InputError.
[[nodiscard]] WorkShare parse_share(std::string_view text);

template <typename Piece>
[[nodiscard]] std::vector<Piece> share_of(const std::vector<Piece>& all, WorkShare share) {
    std::vector<Piece> own;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (share.has(i)) own.push_back(all[i]);
    }
    return own;
}

// The folder itself, of all the work.
[[nodiscard]] std::filesystem::path share_folder(const std::filesystem::path& folder,
                                                 WorkShare share);

// Those that are there, of whatever shares, sorted by name.
[[nodiscard]] std::vector<std::filesystem::path> share_folders(const std::filesystem::path& folder);

// Removes these files of a share's folder, and then it and all folders in it that are empty.
void remove_joined(const std::filesystem::path& share,
                   const std::vector<std::filesystem::path>& files);

}  // namespace aphotic
