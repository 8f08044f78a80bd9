// SPDX-License-Identifier: BSD-3-Clause
#include "base/work_folder.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/number.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>
#include <optional>
#include <regex>
#include <sstream>
#include <system_error>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

// From /proc/locks, whose lines read "1: FLOCK  ADVISORY  WRITE 1234 00:2f:567 0 EOF": process,
// device, inode. 0 stands for a process that is not visible to us.
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

std::string line_of(const std::string& name, const JournalEntry& entry) {
    const nlohmann::json line{{"name", name},
                              {"digest", entry.digest},
                              {"files", entry.file_bytes},
                              {"counts", entry.counts}};
    return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

// A truncated or foreign line is ignored.
std::optional<std::pair<std::string, JournalEntry>> entry_of(const std::string& line) {
    try {
        const nlohmann::json read = parse_json(line, "journal");
        JournalEntry entry{.digest = read.at("digest").get<std::string>(),
                           .counts = read.at("counts").get<Counts>()};
        for (const auto& [file, bytes] : read.at("files").items()) {
            if (!bytes.is_number_unsigned()) return std::nullopt;
            entry.file_bytes[file] = bytes.get<std::uintmax_t>();
        }
        return std::pair(read.at("name").get<std::string>(), std::move(entry));
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    } catch (const InputError&) {
        return std::nullopt;
    }
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder, FolderUse use)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (descriptor_ < 0) return;
    const int operation = (use == FolderUse::Write ? LOCK_EX : LOCK_SH) | LOCK_NB;
    if (::flock(descriptor_, operation) == 0 || errno != EWOULDBLOCK) return;
    const std::string holder = holder_of(descriptor_);
    ::close(descriptor_);
    throw RunError("{}: this folder is in use by another aphotic{}; allowed: one at a time",
                   folder.string(),
                   holder.empty() ? "" : fmt::format(" (process {})", holder));
}

FolderLock::~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

FolderLock claim_folder(const fs::path& folder) {
    make_folder(folder);
    FolderLock lock(folder, FolderUse::Write);
    remove_abandoned_files(folder);
    std::error_code ignored;
    for (fs::recursive_directory_iterator entry(
             folder, fs::directory_options::skip_permission_denied, ignored);
         !ignored && entry != fs::recursive_directory_iterator();
         entry.increment(ignored)) {
        if (entry->is_directory(ignored)) remove_abandoned_files(entry->path());
        ignored.clear();
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

WorkFolder::WorkFolder(const fs::path& folder)
    : folder_(folder), is_new_(!fs::exists(folder)), lock_(claim_folder(folder)) {}

WorkFolder::~WorkFolder() {
    std::error_code ignored;  // as when it is not empty
    if (is_new_) fs::remove(folder_, ignored);
}

std::map<std::string, JournalEntry> parse_journal(std::string_view text) {
    std::map<std::string, JournalEntry> entries;
    std::istringstream lines{std::string(text)};
    for (std::string line; std::getline(lines, line);) {
        if (auto entry = entry_of(line)) {
            entries.insert_or_assign(std::move(entry->first), std::move(entry->second));
        }
    }
    return entries;
}

Journal::Journal(fs::path file) : file_(std::move(file)) {
    if (fs::exists(file_)) entries_ = parse_journal(read_text_file(file_, kMostJournal_bytes));
    std::string text;
    for (const auto& [name, entry] : entries_) text += line_of(name, entry);
    write_text_file(file_, text);
    out_.open(file_, std::ios::app | std::ios::binary);
}

bool Journal::is_done(const std::string& name,
                      const std::string& digest,
                      const std::vector<fs::path>& files) const {
    const auto found = entries_.find(name);
    if (found == entries_.end() || found->second.digest != digest) return false;
    const auto& noted = found->second.file_bytes;
    return std::ranges::all_of(files, [&](const fs::path& file) {
        std::error_code error;
        const auto bytes = fs::file_size(file_.parent_path() / file, error);
        const auto of_file = noted.find(file.string());
        return !error && of_file != noted.end() && of_file->second == bytes;
    });
}

Counts Journal::counts(const std::string& name) const {
    const auto found = entries_.find(name);
    return found == entries_.end() ? Counts() : found->second.counts;
}

void Journal::note(const std::string& name,
                   const std::string& digest,
                   const std::vector<fs::path>& files,
                   const Counts& counts) {
    JournalEntry entry{.digest = digest, .counts = counts};
    for (const fs::path& file : files) {
        entry.file_bytes[file.string()] = fs::file_size(file_.parent_path() / file);
    }
    out_ << line_of(name, entry) << std::flush;
    if (!out_) {
        throw RunError("{}: cannot be written: {}", file_.string(), std::strerror(errno));
    }
    entries_.insert_or_assign(name, std::move(entry));
}

WorkShare parse_share(std::string_view text) {
    const std::size_t slash = std::min(text.find('/'), text.size());
    const auto number = read_number<std::size_t>(text.substr(0, slash));
    const auto of = read_number<std::size_t>(text.substr(std::min(slash + 1, text.size())));
    if (number && of && *number >= 1 && *number <= *of && *of <= kMostShares) return {*number, *of};
    throw InputError("found {}; allowed: I/N, such as 2/4, with I from 1 to N and N up to {}",
                     text,
                     kMostShares);
}

fs::path share_folder(const fs::path& folder, WorkShare share) {
    return share.is_whole() ? folder
                            : folder / fmt::format("share-{}-of-{}", share.number, share.of);
}

std::vector<fs::path> share_folders(const fs::path& folder) {
    static const std::regex kName(R"(share-\d+-of-\d+)");
    std::vector<fs::path> found;
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
        if (entry.is_directory() && std::regex_match(entry.path().filename().string(), kName))
            found.push_back(entry.path());
    }
    std::ranges::sort(found);
    return found;
}

void remove_joined(const fs::path& share, const std::vector<fs::path>& files) {
    std::error_code ignored;
    for (const fs::path& file : files) fs::remove(share / file, ignored);
    std::vector<fs::path> folders{share};
    for (const auto& entry : fs::recursive_directory_iterator(share)) {
        if (entry.is_directory()) folders.push_back(entry.path());
    }
    // Inner folders before outer ones.
    std::ranges::sort(folders, std::greater());
    for (const fs::path& folder : folders) fs::remove(folder, ignored);
}

}  // namespace aphotic
