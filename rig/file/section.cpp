// SPDX-License-Identifier: BSD-3-Clause
#include "rig/file/section.h"

#include "base/csv.h"
#include "base/nearest.h"
#include "base/printable.h"

#include <sstream>

namespace aphotic {
namespace {

// As the user wrote it: 0.1 and not 0.10000000000000001, and on one line.
std::string shown(const toml::node& node) {
    if (node.is_table()) return "a table";
    if (const auto* array = node.as_array()) {
        std::vector<std::string> items;
        for (const toml::node& item : *array) items.push_back(shown(item));
        return fmt::format("[{}]", fmt::join(items, ", "));
    }
    if (const auto real = node.value_exact<double>()) return fmt::format("{}", *real);
    std::ostringstream text;
    node.visit([&](const auto& leaf) { text << leaf; });
    return excerpt(text.str());
}

}  // namespace

std::string allowed_number(Bounds bounds) {
    return fmt::format("a number from {} to {}", bounds.least, bounds.most);
}

void Section::fail(const toml::node& node, std::string_view key, const std::string& what) const {
    throw InputError("{}:{}: {}: {}", file_, line(node), name_of(key), what);
}

void Section::found_but(std::string_view key, const std::string& allowed) const {
    const toml::node& node = *table_.get(key);
    fail(node, key, fmt::format("found {}; allowed: {}", shown(node), allowed));
}

bool Section::has(std::string_view key) {
    if (!is_known(key)) known_.emplace_back(key);
    return table_.contains(key);
}

const toml::node& Section::required(std::string_view key, const std::string& allowed) {
    if (has(key)) return *table_.get(key);
    // Most often the key is present, but misspelt.
    for (const auto& [name, node] : table_) {
        if (is_known(name.str())) continue;
        if (nearest_name(name.str(), std::array{std::string(key)}).empty()) continue;
        fail(node, name.str(), fmt::format("is not a known key; did you mean '{}'?", key));
    }
    fail(table_, key, "is missing; allowed: " + allowed);
}

double Section::number(std::string_view key, Bounds bounds) {
    const toml::node& node = required(key, allowed_number(bounds));
    if (!is_within(node, bounds)) found_but(key, allowed_number(bounds));
    return *node.value<double>();
}

std::string Section::text(std::string_view key, const std::string& allowed) {
    const toml::node& node = required(key, allowed);
    if (!node.is_string()) found_but(key, allowed);
    return one_line(node, key);
}

std::vector<std::string> Section::texts(std::string_view key, const std::string& allowed) {
    const toml::array* array = required(key, allowed).as_array();
    if (array == nullptr) found_but(key, allowed);
    require_few(key, array->size());
    std::vector<std::string> all;
    for (const toml::node& node : *array) {
        if (!node.is_string()) found_but(key, allowed);
        all.push_back(one_line(node, key));
    }
    return all;
}

void Section::require_few(std::string_view key, std::size_t count) const {
    if (count <= kMostOfAKind) return;
    fail(*table_.get(key), key, fmt::format("found {}; allowed: up to {}", count, kMostOfAKind));
}

std::string Section::word(std::string_view key, const std::vector<std::string>& words) {
    const std::string allowed = fmt::format("\"{}\"", fmt::join(words, "\" or \""));
    std::string found = text(key, allowed);
    if (std::find(words.begin(), words.end(), found) == words.end()) found_but(key, allowed);
    return found;
}

Section Section::section(std::string_view key, const std::string& allowed) {
    const toml::node& node = required(key, allowed);
    if (!node.is_table()) found_but(key, allowed);
    return {*node.as_table(), name_of(key), file_};
}

std::vector<Section> Section::sections(std::string_view key, const std::string& allowed) {
    const toml::array* array = required(key, allowed).as_array();
    if (array == nullptr || array->empty()) found_but(key, allowed);
    require_few(key, array->size());
    std::vector<Section> all;
    for (std::size_t i = 0; i < array->size(); ++i) {
        const toml::table* table = (*array)[i].as_table();
        if (table == nullptr) found_but(key, allowed);
        all.emplace_back(*table, fmt::format("{}[{}]", name_of(key), i), file_);
    }
    return all;
}

std::vector<std::string> Section::keys() const {
    std::vector<std::string> all;
    for (const auto& [key, node] : table_) all.emplace_back(key.str());
    return all;
}

void Section::refuse_unknown_keys() const {
    for (const auto& [key, node] : table_) {
        const std::string_view name = key.str();
        if (is_known(name)) continue;
        const std::string nearest = nearest_name(name, known_);
        const std::string hint =
            nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
        fail(node,
             name,
             fmt::format("is not a known key{} Known keys: {}",
                         hint.empty() ? "." : hint,
                         fmt::join(known_, ", ")));
    }
}

void Section::refuse_keys_but(std::string_view known) {
    const auto keys = comma_fields(known);
    known_.assign(keys.begin(), keys.end());
    refuse_unknown_keys();
}

std::string_view Section::refuse_both(std::initializer_list<std::string_view> keys) {
    std::string_view first;
    for (const std::string_view key : keys) {
        if (!has(key)) continue;
        if (!first.empty())
            fail_at(key, fmt::format("found together with '{}'; allowed: one of them", first));
        first = key;
    }
    return first;
}

void Section::require_one_line(const toml::node& node,
                               std::string_view key,
                               std::string_view text) const {
    if (has_control_characters(text)) {
        fail(
            node,
            key,
            fmt::format("found '{}'; allowed: a string without control characters", excerpt(text)));
    }
    if (text.size() > kMostTextBytes) {
        fail(node,
             key,
             fmt::format(
                 "found a string of {} bytes; allowed: up to {}", text.size(), kMostTextBytes));
    }
}

std::string Section::one_line(const toml::node& node, std::string_view key) const {
    std::string text = *node.value<std::string>();
    require_one_line(node, key, text);
    return text;
}

bool Section::is_within(const toml::node& node, Bounds bounds) {
    if (!node.is_number()) return false;
    const auto value = node.value<double>();  // empty: an integer that no double holds
    return value && *value >= bounds.least && *value <= bounds.most;  // false for NaN
}

std::string Section::name_of(std::string_view key) const {
    const std::string name = printable(key);
    return path_.empty() ? name : fmt::format("{}.{}", path_, name);
}

}  // namespace aphotic
