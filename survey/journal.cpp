// SPDX-License-Identifier: BSD-3-Clause
#include "survey/journal.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

std::string line_of(const std::string& name, const JournalEntry& entry) {
    const nlohmann::json line{{"name", name},
                              {"digest", entry.digest},
                              {"files", entry.file_bytes},
                              {"counts", entry.counts}};
    return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

// A line that was cut short, or that is not ours, tells of nothing.
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

}  // namespace aphotic
