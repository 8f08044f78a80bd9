// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic data [NAME]: list the built-in tables, show, plot or export one of them, or check a
// user's table.
#include "base/csv.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/terminal.h"
#include "report/plot.h"
#include "report/svg.h"
#include "spectral/curve_loader.h"
#include "spectral/refractive_index.h"
#include "spectral/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

namespace aphotic::cli {
namespace {

constexpr double kIndexStep_nm = 2.0;                 // of a plotted refractive index
constexpr WavelengthRange kIndexPlot{300.0, 1100.0};  // the range used by cameras and lamps
constexpr double kPlotSalinity_psu = 35.0;
constexpr double kPlotTemperature_c = 10.0;

// In this order; others follow in their own order.
constexpr std::string_view kMetadataKeys =
    "title,role,quantity,unit,kind,form,formula,range,source,obtained,uncertainty,terms";

struct DataCommandOptions {
    std::string name;
    bool csv = false;
    bool json = false;
    std::string plot_file;
};

struct Entry {
    Table table;
    std::string role;  // of a user's table: all possible roles
    WavelengthRange range;
};

Entry entry_of(Table table) {
    if (!names_a_file(table.name)) {
        const WavelengthRange range = stated_range(table);
        std::string role = table.text_of("role");
        return {std::move(table), std::move(role), range};
    }
    std::vector<std::string_view> roles;
    for (const CurveRole role : roles_of(table)) roles.push_back(role_name(role));
    const WavelengthRange range{table.rows.front().fields[0], table.rows.back().fields[0]};
    return {std::move(table), fmt::format("{}", fmt::join(roles, " or ")), range};
}

std::string range_text(WavelengthRange range) {
    return fmt::format("{} to {}", range.first_nm, range.last_nm);
}

std::string csv_of(const Table& table) {
    std::string text = fmt::format("{}\n", fmt::join(table.columns, ","));
    for (const TableRow& row : table.rows) {
        text += fmt::format("{}\n", fmt::join(row.fields, ","));
    }
    return text;
}

nlohmann::json summary_of(const Entry& entry) {
    return {{"name", entry.table.name},
            {"role", entry.role},
            {"quantity", entry.table.text_of("quantity")},
            {"unit", entry.table.text_of("unit")},
            {"range_nm", {entry.range.first_nm, entry.range.last_nm}},
            {"rows", entry.table.rows.size()},
            {"title", entry.table.text_of("title")}};
}

nlohmann::json to_json(const Entry& entry) {
    nlohmann::json json = summary_of(entry);
    json["metadata"] = entry.table.metadata;
    json["columns"] = entry.table.columns;
    json["values"] = nlohmann::json::array();
    for (const TableRow& row : entry.table.rows) json["values"].push_back(row.fields);
    return json;
}

nlohmann::json to_json(const std::vector<Entry>& entries) {
    nlohmann::json json = nlohmann::json::array();
    for (const Entry& entry : entries) json.push_back(summary_of(entry));
    return json;
}

// Columns padded to their widest cell; the last one is not.
void print_aligned(const std::vector<std::vector<std::string>>& lines) {
    std::vector<std::size_t> widths(lines.front().size(), 0);
    for (const auto& line : lines) {
        for (std::size_t i = 0; i < line.size(); ++i) {
            widths[i] = std::max(widths[i], line[i].size());
        }
    }
    for (const auto& line : lines) {
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            say("{:<{}}  ", line[i], widths[i]);
        }
        say("{}\n", line.back());
    }
}

void print(const std::vector<Entry>& entries) {
    std::vector<std::vector<std::string>> lines{
        {"NAME", "ROLE", "RANGE (nm)", "ROWS", "QUANTITY", "TITLE"}};
    for (const Entry& entry : entries) {
        lines.push_back({entry.table.name,
                         entry.role,
                         range_text(entry.range),
                         fmt::format("{}", entry.table.rows.size()),
                         entry.table.text_of("quantity"),
                         entry.table.text_of("title")});
    }
    print_aligned(lines);
}

void print(const Entry& entry) {
    const Table& table = entry.table;
    std::vector<std::vector<std::string>> lines{{"name:", table.name}};
    if (names_a_file(table.name)) {
        lines.push_back({"fits:", entry.role});
        lines.push_back({"covers:", range_text(entry.range) + " nm"});
    }
    const auto in_order = comma_fields(kMetadataKeys);
    for (const std::string_view known : in_order) {
        const std::string key(known);
        if (!table.text_of(key).empty()) lines.push_back({key + ":", table.text_of(key)});
    }
    for (const auto& [key, text] : table.metadata) {
        if (std::ranges::count(in_order, key) == 0) lines.push_back({key + ":", text});
    }
    print_aligned(lines);
    say("\n");
    std::vector<std::vector<std::string>> values{table.columns};
    for (const TableRow& row : table.rows) {
        values.emplace_back();
        for (const double field : row.fields) values.back().push_back(fmt::format("{}", field));
    }
    print_aligned(values);
}

std::string axis_label(const Table& table) {
    const std::string quantity = table.text_of("quantity");
    const std::string unit = table.text_of("unit");
    if (quantity.empty()) return table.columns.size() == 2 ? table.columns[1] : "value";
    return unit.empty() || unit == "1" ? quantity : fmt::format("{} ({})", quantity, unit);
}

std::string title_of(const Table& table) {
    const std::string title = table.text_of("title");
    return title.empty() ? table.name : title;
}

Plot curve_plot(const Table& table, CurveRole role) {
    Plot plot{title_of(table),
              "wavelength (nm)",
              axis_label(table),
              {},
              role == CurveRole::WaterAbsorption};  // it spans more than two decades
    for (const Spectrum& curve : curves_of(table, role)) {
        const std::size_t column = plot.curves.size() + 1;
        const bool alone = table.columns.size() == 2;
        plot.curves.push_back({alone ? "" : table.columns[column],
                               {curve.lambda_nm().begin(), curve.lambda_nm().end()},
                               {curve.values().begin(), curve.values().end()},
                               alone ? 0 : kChannelTones.at(column - 1)});
    }
    return plot;
}

// n over wavelength, from the formula with these coefficients.
template <typename Index>
Plot index_plot(const Entry& entry, const std::string& title, const Index& index) {
    PlotCurve curve;
    const double first_nm = std::max(entry.range.first_nm, kIndexPlot.first_nm);
    const double last_nm = std::min(entry.range.last_nm, kIndexPlot.last_nm);
    for (double lambda_nm = first_nm; lambda_nm <= last_nm; lambda_nm += kIndexStep_nm) {
        curve.x.push_back(lambda_nm);
        curve.y.push_back(index(lambda_nm));
    }
    return {title, "wavelength (nm)", "refractive index, relative to air", {curve}, false};
}

Plot plot_of(const Entry& entry) {
    if (names_a_file(entry.table.name)) {
        return curve_plot(entry.table, roles_of(entry.table).front());
    }
    if (const auto role = role_named(entry.role)) return curve_plot(entry.table, *role);
    const std::string title = title_of(entry.table);
    if (entry.role == "glass") {
        const Glass glass(entry.table);
        return index_plot(
            entry, title, [&glass](double lambda_nm) { return glass.index(lambda_nm); });
    }
    const std::string state =
        fmt::format("{}; {} psu, {} C", title, kPlotSalinity_psu, kPlotTemperature_c);
    return index_plot(entry, state, [](double lambda_nm) {
        return seawater_index(lambda_nm, kPlotSalinity_psu, kPlotTemperature_c);
    });
}

ExitStatus show_data(const DataCommandOptions& options) {
    if (options.name.empty()) {
        std::vector<Entry> entries;
        for (const BuiltinTable& builtin : builtin_tables()) {
            entries.push_back(entry_of(builtin_table(builtin.name)));
        }
        show(entries, options.json);
        return kDone;
    }
    const Entry entry = entry_of(names_a_file(options.name) ? read_table(options.name)
                                                            : builtin_table(options.name));
    if (!options.plot_file.empty()) write_plots(std::array{plot_of(entry)}, options.plot_file);
    if (options.csv) {
        say_text(csv_of(entry.table));
    } else if (options.json || options.plot_file.empty()) {
        show(entry, options.json);
    } else {
        say("wrote {}\n", options.plot_file);
    }
    return kDone;
}

}  // namespace

Action configure_data(CLI::App& app) {
    const auto options = std::make_shared<DataCommandOptions>();
    auto* name = add_option(app, "NAME", options->name);
    auto* csv = add_flag(app, "--csv", options->csv);
    add_flag(app, "--json", options->json)->excludes(csv);
    add_option(app, "--plot", options->plot_file)->needs(name);
    csv->needs(name);
    return [options] { return show_data(*options); };
}

}  // namespace aphotic::cli
