// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/table.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "base/printable.h"
#include "base/sha256.h"
#include "base/words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <boost/locale/utf.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace aphotic {
namespace {

struct RoleRule {
    CurveRole role;
    std::string_view name;
    std::vector<std::string> headers;
    double max_value;
};

const std::vector<RoleRule>& role_rules() {
    using enum CurveRole;
    constexpr double kAny = std::numeric_limits<double>::infinity();
    static const std::vector<RoleRule> kRules{
        {WaterAbsorption, "water absorption", {"wavelength_nm,absorption_per_m"}, kAny},
        {WaterScattering, "water scattering", {"wavelength_nm,scattering_per_m"}, kAny},
        {WaterAttenuation, "water attenuation", {"wavelength_nm,attenuation_per_m"}, kAny},
        {WaterType, "water type", {"wavelength_nm,absorption_per_m,scattering_per_m"}, kAny},
        {LampSpectrum,
         "lamp spectrum",
         {"wavelength_nm,relative_power", "wavelength_nm,radiant_flux_w_per_nm"},
         kAny},
        {Reflectance, "reflectance", {"wavelength_nm,reflectance"}, 1.0},
        {SensorResponse, "sensor response", {"wavelength_nm,red,green,blue"}, kAny},
        {FilterTransmittance, "filter transmittance", {"wavelength_nm,red,green,blue"}, 1.0},
        {QuantumEfficiency, "quantum efficiency", {"wavelength_nm,quantum_efficiency"}, 1.0},
        {ColourMatching, "colour matching", {"wavelength_nm,xbar,ybar,zbar"}, kAny}};
    return kRules;
}

const RoleRule& rule_of(CurveRole role) {
    return *std::ranges::find(role_rules(), role, &RoleRule::role);
}

bool is_utf8_text(std::string_view line) {
    using Utf8 = boost::locale::utf::utf_traits<char>;
    for (auto at = line.begin(); at != line.end();) {
        const auto point = Utf8::decode(at, line.end());
        if (!boost::locale::utf::is_valid_codepoint(point)) return false;
        if (point < 0x20 && point != '\t' && point != '\r') return false;
    }
    return true;
}

double parse_field(const Table& table,
                   std::size_t line,
                   const std::string& column,
                   std::string_view field) {
    const auto number = read_number<double>(field);
    if (!number || !std::isfinite(*number)) {
        fail_at_line(table.name,
                     line,
                     "{}: found '{}'; allowed: a finite decimal number",
                     column,
                     excerpt(field));
    }
    return *number;
}

void take_comment(Table& table, std::string_view comment) {
    const std::size_t colon = comment.find(':');
    if (colon == std::string_view::npos) return;
    const std::string_view key = trimmed(comment.substr(0, colon));
    const std::string_view text = trimmed(comment.substr(colon + 1));
    if (!key.empty()) table.metadata.emplace(key, text);
}

void take_header(Table& table, std::size_t line, const std::vector<std::string_view>& fields) {
    table.header_line = line;
    table.columns.assign(fields.begin(), fields.end());
    std::set<std::string> seen;
    for (const std::string& column : table.columns) {
        if (column.empty()) fail_at_line(table.name, line, "found a column without a name");
        const bool starts_like_a_name = std::isalpha(static_cast<unsigned char>(column[0])) != 0;
        if (!starts_like_a_name) {
            fail_at_line(
                table.name,
                line,
                "found '{}' where a header row such as wavelength_nm,reflectance is expected",
                excerpt(column));
        }
        if (!seen.insert(column).second) {
            fail_at_line(table.name, line, "duplicate column '{}'", excerpt(column));
        }
    }
}

void take_row(Table& table, std::size_t line, const std::vector<std::string_view>& fields) {
    if (fields.size() != table.columns.size()) {
        fail_at_line(table.name,
                     line,
                     "found {} fields; allowed: {}, as in the header row",
                     fields.size(),
                     table.columns.size());
    }
    TableRow row{line, {}};
    for (std::size_t i = 0; i < fields.size(); ++i) {
        row.fields.push_back(parse_field(table, line, table.columns[i], fields[i]));
    }
    table.rows.push_back(std::move(row));
}

void take_line(Table& table, std::size_t line, std::string_view text) {
    if (!is_utf8_text(text)) {
        fail_at_line(table.name, line, "found bytes that are not text; allowed: UTF-8");
    }
    const std::string_view content = trimmed(text);
    if (content.empty()) return;
    if (content.front() == '#') {
        take_comment(table, content.substr(1));
    } else if (table.columns.empty()) {
        take_header(table, line, comma_fields(content));
    } else {
        take_row(table, line, comma_fields(content));
    }
}

std::string header_of(const Table& table) {
    return fmt::format("{}", fmt::join(table.columns, ","));
}

bool header_fits(const Table& table, const RoleRule& rule) {
    return std::ranges::count(rule.headers, header_of(table)) > 0;
}

// K_d by its name: kd, Kd(490), K_d_per_m; not kdye.
bool names_daylights_loss(std::string_view words) {
    const std::string text = lower_case(std::string(words));
    const auto is_letter = [&](std::size_t i) {
        return i < text.size() && std::isalpha(static_cast<unsigned char>(text[i])) != 0;
    };
    for (const std::string_view name : {"kd", "k_d"}) {
        for (std::size_t at = text.find(name); at != std::string::npos;
             at = text.find(name, at + 1)) {
            const bool begins = at == 0 || !is_letter(at - 1);
            if (begins && !is_letter(at + name.size())) return true;
        }
    }
    return text.find("diffuse attenuation") != std::string::npos ||
           text.find("diffuse_attenuation") != std::string::npos;
}

bool is_of_water(CurveRole role) {
    return role == CurveRole::WaterAbsorption || role == CurveRole::WaterScattering ||
           role == CurveRole::WaterAttenuation || role == CurveRole::WaterType;
}

constexpr std::string_view kDaylightsLoss =
    "K_d, the diffuse attenuation of daylight, is neither absorption nor beam attenuation: "
    "docs/reference/water.md";

// This mistake is the most common one, and no image shows it, so it is reported if the table's own
// text indicates it. Titles are not checked, since they may name the data that a table was derived
// from.
void refuse_daylights_loss(const Table& table, const RoleRule& rule) {
    if (!is_of_water(rule.role)) return;
    for (const std::string& column : table.columns) {
        if (!names_daylights_loss(column)) continue;
        fail_at_line(table.name,
                     table.header_line,
                     "found the column {}; allowed for {}: {}. {}",
                     column,
                     rule.name,
                     rule.headers.front(),
                     kDaylightsLoss);
    }
    for (const char* key : {"quantity", "role"}) {
        const std::string words = table.text_of(key);
        if (!names_daylights_loss(words)) continue;
        fail_at_line(table.name,
                     table.header_line,
                     "found the {} '{}' over the column {}; allowed: {}. {}",
                     key,
                     excerpt(words),
                     excerpt(table.columns.back()),
                     rule.name,
                     kDaylightsLoss);
    }
}

void check_header(const Table& table, const RoleRule& rule) {
    refuse_daylights_loss(table, rule);
    if (header_fits(table, rule)) return;
    fail_at_line(table.name,
                 table.header_line,
                 "found the header row {}; allowed for {}: {}",
                 header_of(table),
                 rule.name,
                 fmt::join(rule.headers, " or "));
}

void check_wavelengths(const Table& table) {
    double last_nm = 0.0;
    for (const TableRow& row : table.rows) {
        const double lambda_nm = row.fields[0];
        if (!(lambda_nm > last_nm)) {
            fail_at_line(
                table.name,
                row.line,
                "wavelength_nm: found {}; allowed: above {}, since wavelengths must increase",
                lambda_nm,
                last_nm);
        }
        last_nm = lambda_nm;
    }
}

void check_values(const Table& table, const RoleRule& rule) {
    for (const TableRow& row : table.rows) {
        for (std::size_t i = 1; i < row.fields.size(); ++i) {
            const double value = row.fields[i];
            if (value >= 0.0 && value <= rule.max_value) continue;
            const bool bounded = std::isfinite(rule.max_value);
            fail_at_line(table.name,
                         row.line,
                         "{}: found {}; allowed: {}",
                         table.columns[i],
                         value,
                         bounded ? fmt::format("0 to {}", rule.max_value) : "0 or more");
        }
    }
}

std::vector<double> column_of(const Table& table, std::size_t column) {
    std::vector<double> numbers;
    for (const TableRow& row : table.rows) numbers.push_back(row.fields[column]);
    return numbers;
}

}  // namespace

std::string Table::text_of(const std::string& key) const {
    const auto found = metadata.find(key);
    return found == metadata.end() ? std::string() : found->second;
}

Table parse_table(const std::string& name, std::string_view text) {
    Table table;
    table.name = name;
    const std::size_t lines = for_each_line(
        text, [&](std::size_t line, std::string_view words) { take_line(table, line, words); });
    if (table.columns.empty()) fail_at_line(name, lines + 1, "the file ends without a header row");
    if (table.rows.empty()) fail_at_line(name, lines + 1, "the file ends without a row of numbers");
    return table;
}

Table read_table(const std::filesystem::path& file) {
    const std::string text = read_text_file(file, kMostTableBytes);
    Table table = parse_table(file.string(), text);
    table.file_sha256 = sha256_of_text(text);
    return table;
}

std::string_view role_name(CurveRole role) {
    return rule_of(role).name;
}

std::optional<CurveRole> role_named(std::string_view name) {
    const auto found = std::ranges::find(role_rules(), name, &RoleRule::name);
    return found == role_rules().end() ? std::nullopt : std::optional(found->role);
}

std::vector<Spectrum> curves_of(const Table& table, CurveRole role) {
    const RoleRule& rule = rule_of(role);
    check_header(table, rule);
    check_wavelengths(table);
    check_values(table, rule);
    if (table.rows.size() < 2) {
        fail_at_line(table.name, table.rows.back().line, "found 1 row; a curve needs 2 or more");
    }
    const std::vector<double> lambda_nm = column_of(table, 0);
    std::vector<Spectrum> curves;
    for (std::size_t i = 1; i < table.columns.size(); ++i) {
        std::string name = fmt::format("{} '{}'", rule.name, table.name);
        if (table.columns.size() > 2) name += fmt::format(" ({})", table.columns[i]);
        curves.emplace_back(std::move(name),
                            lambda_nm,
                            column_of(table, i),
                            CurveSource{.table = table.name, .file_sha256 = table.file_sha256});
    }
    return curves;
}

std::vector<CurveRole> roles_of(const Table& table) {
    std::vector<CurveRole> roles;
    std::vector<std::string> headers;
    std::optional<InputError> fault;
    for (const RoleRule& rule : role_rules()) {
        for (const auto& header : rule.headers) {
            headers.push_back(fmt::format("{} ({})", header, rule.name));
        }
        if (!header_fits(table, rule)) continue;
        try {
            static_cast<void>(curves_of(table, rule.role));
            roles.push_back(rule.role);
        } catch (const InputError& error) {
            if (!fault) fault = error;
        }
    }
    if (!roles.empty()) return roles;
    if (fault) throw *fault;
    refuse_daylights_loss(table, rule_of(CurveRole::WaterAbsorption));
    fail_at_line(table.name,
                 table.header_line,
                 "found the header row {}; allowed: {}",
                 header_of(table),
                 fmt::join(headers, ", "));
}

}  // namespace aphotic
