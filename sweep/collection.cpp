// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/collection.h"

#include "base/atomic_file.h"
#include "base/json_text.h"
#include "image/any_image.h"
#include "report/html.h"
#include "report/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <utility>
#include <variant>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPreview = "preview.png";

// Quoted as RFC 4180 has it.
std::string cell_of(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

using Columns = std::vector<std::pair<std::string, std::string>>;  // name and cell

// The nesting of what was read is bounded (base/json_text.h).
// NOLINTNEXTLINE(misc-no-recursion)
void add_columns(const nlohmann::json& json, const std::string& name, Columns& columns) {
    constexpr std::size_t kMostText = 100;
    constexpr std::size_t kMostOfAList = 3;
    if (json.is_object()) {
        for (const auto& [key, value] : json.items())
            add_columns(value, name.empty() ? key : name + "." + key, columns);
    } else if (json.is_array() && !json.empty() && json[0].contains("key")) {
        for (nlohmann::json item : json) {  // a fit's numbers
            const auto key = item.at("key").get<std::string>();
            item.erase("key");
            add_columns(item, name + "." + key, columns);
        }
    } else if (json.is_array()) {
        const bool is_short = json.size() <= kMostOfAList &&
                              std::ranges::all_of(json, [](auto& x) { return x.is_number(); });
        for (std::size_t i = 0; is_short && i < json.size(); ++i)
            add_columns(json[i], fmt::format("{}.{}", name, i), columns);
    } else if (json.is_string()) {
        auto text = json.get<std::string>();
        if (text.size() <= kMostText) columns.emplace_back(name, std::move(text));
    } else if (!json.is_null()) {
        columns.emplace_back(name, json.dump());
    }
}

Columns answer_of(const Sweep& sweep, std::size_t number) {
    const fs::path file = task_folder(sweep, number) / "answer.json";
    Columns columns;
    add_columns(parse_json(read_text_file(file), file.string()), "", columns);
    return columns;
}

Columns own_columns(const Sweep& sweep, std::size_t number, const TaskStanding& standing) {
    const SweepTask task = task_of(sweep, number);
    Columns columns{{"task", fmt::to_string(number)}};
    const SweepPoint& point = sweep.points[task.point];
    for (std::size_t k = 0; k < point.size(); ++k)
        columns.emplace_back(sweep.file.vary[k].key, words_of(point[k]));
    if (sweep.file.shares > 1) columns.emplace_back("share", fmt::to_string(task.share + 1));
    columns.emplace_back("state", name_of(standing.state));
    const bool has_ended = !standing.result.digest.empty();
    columns.emplace_back("exit_status",
                         has_ended ? fmt::to_string(standing.result.exit_status) : "");
    columns.emplace_back("task_seconds",
                         has_ended ? fmt::format("{:.3f}", standing.result.seconds) : "");
    columns.emplace_back("message", standing.result.error);
    return columns;
}

std::string line_of(const std::vector<std::string>& cells) {
    std::vector<std::string> quoted;
    for (const std::string& cell : cells) quoted.push_back(cell_of(cell));
    return fmt::format("{}\n", fmt::join(quoted, ","));
}

// The longer side is that of the sheet.
struct SmallPicture {
    int width_px = 0;
    int height_px = 0;
    std::string jpeg{};
};

// The library writes files, not bytes.
SmallPicture small_picture(const fs::path& file, const fs::path& scratch) {
    constexpr int kSide_px = 320;
    constexpr int kQuality = 85;
    const AnyImage image = open_any_image(file);
    const PlaneSize from{image.width_px, image.height_px};
    const int longer = std::max({from.width_px, from.height_px, kSide_px});
    const PlaneSize to{std::max(1, from.width_px * kSide_px / longer),
                       std::max(1, from.height_px * kSide_px / longer)};
    std::vector<float> planes;
    for (std::size_t c = 0; c < image.channels.size(); ++c) {
        const std::vector<float> plane = resized(image.samples(c), from, to, "box");
        planes.insert(planes.end(), plane.begin(), plane.end());
    }
    const AtomicFile small(scratch / "thumbnail.jpg");
    write_any_image(small.temporary(),
                    {.width_px = to.width_px,
                     .height_px = to.height_px,
                     .channels = image.channels,
                     .planes = planes,
                     .type = SampleType::Bits8,
                     .is_srgb = true,
                     .jpeg_quality = kQuality});
    return {to.width_px, to.height_px, read_text_file(small.temporary())};
}

std::string caption_of(const Sweep& sweep, std::size_t number) {
    const SweepPoint& point = sweep.points[task_of(sweep, number).point];
    std::string caption = fmt::format("task {}", number);
    for (std::size_t k = 0; k < point.size(); ++k) {
        const double* value = std::get_if<double>(&point[k]);
        caption += fmt::format(", {} {}",
                               named(sweep.file.vary[k].key),
                               value != nullptr ? plain(*value) : named(words_of(point[k])));
    }
    return caption;
}

}  // namespace

std::vector<TaskStanding> standings_of(const Sweep& sweep) {
    std::vector<TaskStanding> standings;
    for (std::size_t number = 1; number <= sweep.tasks(); ++number)
        standings.push_back(standing_of(sweep, number));
    return standings;
}

std::size_t count_of(std::span<const TaskStanding> standings, TaskState state) {
    return static_cast<std::size_t>(std::ranges::count(standings, state, &TaskStanding::state));
}

std::string numbers_not_done(std::span<const TaskStanding> standings) {
    const auto is_done = [&](std::size_t i) {
        return i >= standings.size() || standings[i].state == TaskState::Done;
    };
    std::vector<std::string> ranges;
    for (std::size_t i = 0; i < standings.size(); ++i) {
        if (is_done(i)) continue;
        const std::size_t first = i;
        while (!is_done(i + 1)) ++i;
        ranges.push_back(first == i ? fmt::to_string(i + 1)
                                    : fmt::format("{}-{}", first + 1, i + 1));
    }
    return fmt::format("{}", fmt::join(ranges, ","));
}

std::string results_csv(const Sweep& sweep, std::span<const TaskStanding> standings) {
    std::vector<std::string> names;  // of the answers' columns, as they come
    std::map<std::string, std::size_t> places;
    std::vector<Columns> answers(standings.size());
    for (std::size_t i = 0; i < standings.size(); ++i) {
        if (standings[i].state == TaskState::Done) answers[i] = answer_of(sweep, i + 1);
        for (const auto& [name, cell] : answers[i]) {
            if (places.emplace(name, names.size()).second) names.push_back(name);
        }
    }
    std::string csv;
    for (std::size_t i = 0; i < standings.size(); ++i) {
        std::vector<std::string> head;
        std::vector<std::string> cells;
        for (const auto& [name, cell] : own_columns(sweep, i + 1, standings[i])) {
            head.push_back(name);
            cells.push_back(cell);
        }
        if (i == 0) {
            head.insert(head.end(), names.begin(), names.end());
            csv += line_of(head);
        }
        const std::size_t own = cells.size();
        cells.resize(own + names.size());
        for (const auto& [name, cell] : answers[i]) cells[own + places.at(name)] = cell;
        csv += line_of(cells);
    }
    return csv;
}

SweepSheet sweep_sheet(const Sweep& sweep, std::span<const TaskStanding> standings) {
    std::vector<std::size_t> pictured;
    for (std::size_t number = 1; number <= standings.size(); ++number) {
        if (standings[number - 1].state == TaskState::Done &&
            fs::exists(results_folder(sweep, number) / kPreview))
            pictured.push_back(number);
    }
    SweepSheet sheet{.pictures = std::min(pictured.size(), kMostOnSweepSheet)};
    PageFigures figures{.figures = {}, .are_small = true};
    for (std::size_t i = 0; i < sheet.pictures; ++i) {
        const std::size_t number = pictured[i * pictured.size() / sheet.pictures];
        const SmallPicture picture =
            small_picture(results_folder(sweep, number) / kPreview, sweep.folder);
        figures.figures.push_back({.pictures = {{.bytes = picture.jpeg,
                                                 .width_px = picture.width_px,
                                                 .height_px = picture.height_px,
                                                 .words = fmt::format("task {}", number),
                                                 .type = kJpeg}},
                                   .caption = caption_of(sweep, number)});
    }
    const std::string title = sweep.folder.filename().string();
    const std::size_t done = count_of(standings, TaskState::Done);
    sheet.html = page_html(
        {.kind = "sweep of " + sweep.file.command,
         .title = "Sweep: " + title,
         .heading = title,
         .is_good = done == standings.size(),
         .headline = fmt::format("{} of {} done", done, grouped_count(standings.size(), "task")),
         .said = {"Each preview has an exposure of its own: compare their evenness, and signals in "
                  "results.csv."},
         .sections = {{.id = "previews", .heading = "Previews", .parts = {std::move(figures)}}}});
    return sheet;
}

}  // namespace aphotic
