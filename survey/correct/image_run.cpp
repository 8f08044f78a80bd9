// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/image_run.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/sha256.h"
#include "survey/dropout_check.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

// The file itself, with links resolved; for circular links, their own path.
fs::path place_of(const fs::path& file) {
    std::error_code circle;
    fs::path place = fs::weakly_canonical(file, circle);
    return circle ? fs::absolute(file).lexically_normal() : place;
}

// Two coincide if an image lies in a folder named like that of the encoded results.
void require_separate_results(const std::vector<ImageFile>& files, const ImageRunOptions& options) {
    std::map<fs::path, const ImageFile*> makers;
    for (const ImageFile& file : files) {
        for (const fs::path& result : results_of(file, options.format)) {
            const auto [other, is_new] = makers.emplace(result, &file);
            if (is_new) continue;
            throw InputError("{} and {} would both become {}",
                             other->second->source.string(),
                             file.source.string(),
                             (options.folder / result).string());
        }
    }
}

void require_sources_stay(const std::vector<ImageFile>& files, const ImageRunOptions& options) {
    std::set<fs::path> sources;
    for (const ImageFile& file : files) sources.insert(place_of(file.source));
    for (const ImageFile& file : files) {
        for (const fs::path& result : results_of(file, options.format)) {
            const fs::path written = options.folder / result;
            if (!sources.contains(place_of(written))) continue;
            throw InputError(
                "{}: would be overwritten by the result; allowed: another place for -o",
                written.string());
        }
    }
}

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
    remove_joined(share, {kJournal, kCorrectionNotes, kBaselineNotes, kReportPage});
    return count;
}

}  // namespace

void require_results_apart(const std::vector<ImageFile>& files, const ImageRunOptions& options) {
    require_separate_results(files, options);
    require_sources_stay(files, options);
}

std::size_t join_shares(const std::vector<ImageFile>& files, const ImageRunOptions& options) {
    const std::vector<fs::path> shares = share_folders(options.folder);
    if (shares.empty()) return 0;
    Journal journal(options.folder / kJournal);
    std::size_t count = 0;
    for (const fs::path& share : shares) count += join_share(share, files, options, journal);
    return count;
}

std::string state_of(const fs::path& image) {
    require_file(image);
    std::error_code size_error;
    std::error_code time_error;
    const auto size = fs::file_size(image, size_error);
    const auto time = fs::last_write_time(image, time_error).time_since_epoch().count();
    if (size_error) throw InputError(size_error.message());
    if (time_error) throw InputError(time_error.message());
    return fmt::format("{} {}", size, time);
}

nlohmann::ordered_json to_json(const std::vector<Skipped>& skipped) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Skipped& one : skipped) json.push_back({{"image", one.image}, {"why", one.why}});
    return json;
}

double RunOutcome::doubtful_share(std::string_view doubt) const {
    const auto count = counts.find(std::string(doubt));
    return pixels > 0.0 && count != counts.end() ? count->second / pixels : 0.0;
}

nlohmann::ordered_json to_json(const RunOutcome& outcome) {
    nlohmann::ordered_json json{{"corrected", outcome.corrected},
                                {"kept", outcome.kept},
                                {"skipped", to_json(outcome.skipped)},
                                {"dropouts", to_json(outcome.marked)}};
    for (const auto& [name, bit, words] : kDoubts) {
        json["doubtful"][std::string(name)] = outcome.doubtful_share(name);
    }
    return json;
}

RunOutcome run_images(const std::vector<ImageFile>& files,
                      const ImageRunOptions& options,
                      const ImageWork& work,
                      const RunWatch& watch) {
    struct Task {
        std::size_t file;
        std::string digest;
    };
    Journal journal(options.folder / kJournal);
    RunOutcome outcome;
    std::vector<Task> tasks;
    std::vector<std::string> whys(files.size());
    const auto skip = [&](std::size_t i, const std::string& why) {
        whys[i] = why;
        watch.skipped({files[i].source.string(), why});
    };
    for (std::size_t i = 0; i < files.size(); ++i) {
        try {
            std::string digest =
                sha256_of_text(work.inputs(files[i]) + " " + state_of(files[i].source));
            const auto results = results_of(files[i], options.format);
            if (journal.is_done(files[i].name.string(), digest, results)) {
                ++outcome.kept;
            } else {
                tasks.push_back({i, std::move(digest)});
            }
        } catch (const InputError& error) {
            skip(i, error.what());
        }
    }
    if (!tasks.empty()) work.prepare();
    std::size_t count = files.size() - tasks.size();
    std::mutex mutex;
    parallel_for(tasks.size(), options.jobs, [&](std::size_t t, std::size_t) {
        const ImageFile& file = files[tasks[t].file];
        std::optional<Counts> counts;
        std::string why;
        try {
            counts = work.make(file);
        } catch (const InputError& error) {
            why = error.what();
        }
        const std::scoped_lock lock(mutex);
        if (counts) {
            const auto results = results_of(file, options.format);
            journal.note(file.name.string(), tasks[t].digest, results, *counts);
            ++outcome.corrected;
        } else {
            skip(tasks[t].file, why);
        }
        ++count;
        watch.progress(fmt::format("{} of {} images", count, files.size()),
                       static_cast<double>(count) / static_cast<double>(files.size()));
    });
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (!whys[i].empty()) {
            outcome.skipped.push_back({files[i].source.string(), whys[i]});
            continue;
        }
        const Counts counts = journal.counts(files[i].name.string());
        for (const auto& [what, number] : counts) outcome.counts[what] += number;
        if (!counts.contains(kLightShare)) continue;
        outcome.marked.push_back(marked(files[i].source.string(),
                                        work.strobes,
                                        counts.at(kLightShare),
                                        static_cast<std::uint64_t>(counts.at(kStrobesOut))));
        watch.marked(outcome.marked.back());
    }
    outcome.pixels = outcome.counts[kPixels];
    return outcome;
}

}  // namespace aphotic
