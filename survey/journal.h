// SPDX-License-Identifier: BSD-3-Clause
//
// What is done, noted as it is done, so that an interrupted run goes on where it stopped: one line
// of JSON for each piece of work, appended once its files are in their places.
//
// A line that an interruption cut short, or that is not ours, is passed over when the journal is
// read again; of several lines of one name the last counts. A piece of work counts as done while
// its digest, which stands for all that its result depends on, is the same, and its files are there
// in the size that was noted.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// What was counted in a piece of work, such as its doubtful pixels.
using Counts = std::map<std::string, double>;

struct JournalEntry {
    std::string digest;
    std::map<std::string, std::uintmax_t> file_bytes{};
    Counts counts;
};

// By the name of the piece of work.
[[nodiscard]] std::map<std::string, JournalEntry> parse_journal(std::string_view text);

// Its name in a folder of results.
inline constexpr std::string_view kJournal = "corrected.jsonl";
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

}  // namespace aphotic
