// SPDX-License-Identifier: BSD-3-Clause
#include "cli/journal.h"

#include "spectral/atomic_file.h"
#include "spectral/error.h"
#include "spectral/json_text.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <sstream>

namespace aphotic::cli {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

std::string line_of(const Json& entry) {
    return entry.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

bool is_entry(const Json& entry) {
    return entry.is_object() && entry.contains("name") && entry["name"].is_string() &&
           entry.contains("digest") && entry.contains("files") && entry["files"].is_object() &&
           entry.contains("what");
}

// A line that was cut short, or that is not ours, tells of nothing.
std::optional<Json> entry_of(const std::string& line) {
    try {
        Json entry = parse_json(line, "journal");
        return is_entry(entry) ? std::optional(std::move(entry)) : std::nullopt;
    } catch (const InputError&) {
        return std::nullopt;
    }
}

}  // namespace

Journal::Journal(fs::path file) : file_(std::move(file)) {
    if (fs::exists(file_)) {
        std::istringstream lines(read_text_file(file_));
        for (std::string line; std::getline(lines, line);) {
            if (std::optional<Json> entry = entry_of(line)) {
                const auto name = entry->at("name").get<std::string>();
                entries_.insert_or_assign(name, std::move(*entry));
            }
        }
    }
    std::string text;
    for (const auto& [name, entry] : entries_) text += line_of(entry);
    write_text_file(file_, text);
    out_.open(file_, std::ios::app | std::ios::binary);
}

bool Journal::is_done(const std::string& name, const std::string& digest) const {
    const auto found = entries_.find(name);
    if (found == entries_.end() || found->second["digest"] != digest) return false;
    for (const auto& [file, size] : found->second["files"].items()) {
        std::error_code error;
        const auto bytes = fs::file_size(file_.parent_path() / file, error);
        if (error || size != bytes) return false;
    }
    return true;
}

Json Journal::noted(const std::string& name) const {
    const auto found = entries_.find(name);
    return found == entries_.end() ? Json() : found->second["what"];
}

void Journal::note(const std::string& name,
                   const std::string& digest,
                   const std::vector<fs::path>& files,
                   const Json& what) {
    Json entry{{"name", name}, {"digest", digest}, {"files", Json::object()}, {"what", what}};
    for (const fs::path& file : files) {
        entry["files"][file.string()] = fs::file_size(file_.parent_path() / file);
    }
    out_ << line_of(entry) << std::flush;
    if (!out_) {
        throw RunError(
            fmt::format("{}: cannot be written: {}", file_.string(), std::strerror(errno)));
    }
    entries_.insert_or_assign(name, std::move(entry));
}

}  // namespace aphotic::cli
