// SPDX-License-Identifier: BSD-3-Clause
#include "rig/rig_text.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "rig/rig_reader.h"

#include <toml++/toml.h>

#include <charconv>
#include <sstream>
#include <utility>

namespace aphotic {

struct RigText::Tree {
    toml::table table;
    std::string untouched;  // the text, as long as nothing was set
};

namespace {

std::vector<std::string> steps_of(std::string_view key) {
    std::vector<std::string> steps;
    for (std::size_t from = 0; from <= key.size();) {
        const std::size_t to = std::min(key.find('.', from), key.size());
        steps.emplace_back(key.substr(from, to - from));
        from = to + 1;
    }
    return steps;
}

// Of an array of tables: by its name, or by its number from 0 on.
toml::node* element(toml::array& array, const std::string& step) {
    for (toml::node& node : array) {
        if (toml::table* table = node.as_table(); table != nullptr) {
            if ((*table)["name"].value_or(std::string{}) == step) return table;
        }
    }
    std::size_t number = 0;
    const auto [end, fault] = std::from_chars(step.data(), step.data() + step.size(), number);
    const bool is_number = fault == std::errc{} && end == step.data() + step.size();
    return is_number && number < array.size() ? &array[number] : nullptr;
}

toml::node* child(toml::node& node, const std::string& step) {
    if (toml::table* table = node.as_table(); table != nullptr) return table->get(step);
    if (toml::array* array = node.as_array(); array != nullptr) return element(*array, step);
    return nullptr;
}

toml::node* find(toml::table& root, std::string_view key) {
    toml::node* node = &root;
    for (const std::string& step : steps_of(key)) {
        node = child(*node, step);
        if (node == nullptr) return nullptr;
    }
    return node;
}

// The table that holds the last step of the key, and that step.
std::pair<toml::table*, std::string> place(toml::table& root, std::string_view key) {
    std::vector<std::string> steps = steps_of(key);
    const std::string last = steps.back();
    steps.pop_back();
    toml::node* node = &root;
    for (const std::string& step : steps) {
        toml::node* next = child(*node, step);
        if (next == nullptr && node->is_table())
            next = &node->as_table()->insert(step, toml::table{}).first->second;
        if (next == nullptr)
            throw InputError("{}: found no '{}'; allowed: the rig's own", key, step);
        node = next;
    }
    if (!node->is_table()) throw InputError("{}: found no table to hold it", key);
    return {node->as_table(), last};
}

}  // namespace

RigText::RigText(const std::filesystem::path& file)
    : RigText(read_text_file(file), file.string(), file.parent_path()) {}

RigText::RigText(std::string_view toml, std::string name, std::filesystem::path folder)
    : name_(std::move(name)), folder_(std::move(folder)), tree_(std::make_unique<Tree>()) {
    static_cast<void>(parse_rig(toml, name_, folder_));  // whose messages are the better ones
    tree_->table = toml::parse(toml, name_);
    tree_->untouched = toml;
}

RigText::RigText(const RigText& other)
    : name_(other.name_), folder_(other.folder_), tree_(std::make_unique<Tree>(*other.tree_)) {}

RigText& RigText::operator=(const RigText& other) {
    *this = RigText(other);
    return *this;
}

RigText::RigText(RigText&&) noexcept = default;
RigText& RigText::operator=(RigText&&) noexcept = default;
RigText::~RigText() = default;

bool RigText::has(std::string_view key) const {
    return find(tree_->table, key) != nullptr;
}

std::optional<double> RigText::number(std::string_view key) const {
    const toml::node* node = find(tree_->table, key);
    return node == nullptr ? std::nullopt : node->value<double>();
}

void RigText::set(std::string_view key, double value) {
    const auto [table, last] = place(tree_->table, key);
    table->insert_or_assign(last, value);
    tree_->untouched.clear();
}

void RigText::set(std::string_view key, const std::string& value) {
    const auto [table, last] = place(tree_->table, key);
    table->insert_or_assign(last, value);
    tree_->untouched.clear();
}

void RigText::set(std::string_view key, const std::vector<double>& values) {
    const auto [table, last] = place(tree_->table, key);
    toml::array array;
    for (const double value : values) array.push_back(value);
    table->insert_or_assign(last, std::move(array));
    tree_->untouched.clear();
}

void RigText::erase(std::string_view key) {
    if (find(tree_->table, key) == nullptr) return;
    const auto [table, last] = place(tree_->table, key);
    table->erase(last);
    tree_->untouched.clear();
}

std::string RigText::text() const {
    if (!tree_->untouched.empty()) return tree_->untouched;
    std::ostringstream text;
    text << tree_->table << "\n";
    return text.str();
}

Rig RigText::rig() const {
    return parse_rig(text(), name_, folder_);
}

}  // namespace aphotic
