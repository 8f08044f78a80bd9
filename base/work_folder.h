// SPDX-License-Identifier: BSD-3-Clause
//
// A folder for long work: one run at a time, which continues where an interrupted run stopped,
// alone or as one of several shares.
//
// Lock: the kernel's own (flock) on the folder itself. There is no lock file, a read-only folder
// can be locked too, and the lock ends with its process, however that ends. A kernel's locks are
// local: two machines in one network folder do not exclude each other.
//
// Journal: finished work, one line of JSON per piece, appended once its files are in place. A line
// that was truncated by an interruption, or is not ours, is skipped when the journal is read; of
// several lines with the same name, the last one counts. A piece of work counts as done if its
// digest, which covers everything its result depends on, is the same, and its files exist with the
// recorded sizes.
//
// Share: 2/4 is every fourth piece, starting at the second. Neighbouring pieces, such as a dive's
// images, take about the same time, so these shares do too. A share writes to its own folder,
// DIR/share-2-of-4, to which no other task writes. The same work without a share collects the
// results from there.
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
    Write,  // exclusive
};

class FolderLock {
  public:
    // Does not wait: a RunError names the folder and, if the kernel reports it, the process that
    // holds the lock. If the folder is missing, or its file system has no locks, nothing is locked.
    FolderLock(const std::filesystem::path& folder, FolderUse use);
    ~FolderLock();
    FolderLock(FolderLock&& other) noexcept;
    FolderLock& operator=(FolderLock&&) = delete;

  private:
    int descriptor_;
};

// Creates the folder and locks it during the lock's lifetime, and removes partly written files of
// killed runs in it and in the folders below.
[[nodiscard]] FolderLock claim_folder(const std::filesystem::path& folder);

// The same for a run that also reads another folder, which must not change in the meantime; it may
// be the same folder.
[[nodiscard]] std::vector<FolderLock> claim_folders(const std::filesystem::path& written,
                                                    const std::filesystem::path& read);

// The same for work that writes only much later: failure to make the folder is detected early. It
// is removed again if it remains empty.
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

// Counts from a piece of work, such as its doubtful pixels.
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
    // Reads the journal, if there is one, and rewrites it without outdated lines.
    explicit Journal(std::filesystem::path file);

    // Files are next to the journal or below.
    [[nodiscard]] bool is_done(const std::string& name,
                               const std::string& digest,
                               const std::vector<std::filesystem::path>& files) const;

    // Null if there is no entry of that name.
    [[nodiscard]] Counts counts(const std::string& name) const;

    // Not thread-safe. A RunError if it cannot be written.
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

// From "2/4". Throws InputError.
[[nodiscard]] WorkShare parse_share(std::string_view text);

template <typename Piece>
[[nodiscard]] std::vector<Piece> share_of(const std::vector<Piece>& all, WorkShare share) {
    std::vector<Piece> own;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (share.has(i)) own.push_back(all[i]);
    }
    return own;
}

// The folder of the whole work.
[[nodiscard]] std::filesystem::path share_folder(const std::filesystem::path& folder,
                                                 WorkShare share);

// Existing folders of all shares, sorted by name.
[[nodiscard]] std::vector<std::filesystem::path> share_folders(const std::filesystem::path& folder);

// Removes these files from a share's folder, and then the folder and its subfolders if they are
// empty.
void remove_joined(const std::filesystem::path& share,
                   const std::vector<std::filesystem::path>& files);

}  // namespace aphotic
