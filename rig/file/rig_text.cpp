// SPDX-License-Identifier: BSD-3-Clause
#include "rig/file/rig_text.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/number.h"
#include "rig/file/rig_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>
#include <utility>

namespace aphotic {
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

// An element of an array of tables, by its name, or by its number from 0.
const toml::node* element(const toml::array& array, const std::string& step) {
    for (const toml::node& node : array) {
        if (const toml::table* table = node.as_table(); table != nullptr) {
            if ((*table)["name"].value_or(std::string{}) == step) return table;
        }
    }
    const auto number = read_number<std::size_t>(step);
    return number && *number < array.size() ? &array[*number] : nullptr;
}

const toml::node* child(const toml::node& node, const std::string& step) {
    if (const toml::table* table = node.as_table(); table != nullptr) return table->get(step);
    if (const toml::array* array = node.as_array(); array != nullptr) return element(*array, step);
    return nullptr;
}

const toml::node* find(const toml::table& root, std::string_view key) {
    const toml::node* node = &root;
    for (const std::string& step : steps_of(key)) {
        node = child(*node, step);
        if (node == nullptr) return nullptr;
    }
    return node;
}

std::string names_in(const toml::array& array) {
    std::string names;
    for (const toml::node& item : array) {
        const toml::table* table = item.as_table();
        const auto name = table == nullptr ? std::nullopt : (*table)["name"].value<std::string>();
        if (name) names += *name + ", ";
    }
    return fmt::format("{}0 to {}", names, array.size() - 1);
}

// A whole number gets a decimal point, since some keys take no integers.
std::string toml_of(double value) {
    std::string text = fmt::format("{}", value == 0.0 ? 0.0 : value);
    if (text.find_first_of(".en") == std::string::npos) text += ".0";
    return text;
}

std::string toml_of(const std::string& value) {
    std::ostringstream text;
    text << toml::value<std::string>(value);
    return text.str();
}

template <typename F>
void for_tables(toml::node& node, const F& f) {
    if (toml::table* table = node.as_table(); table != nullptr) {
        f(*table);
        for (auto&& [key, value] : *table) for_tables(value, f);
    } else if (toml::array* array = node.as_array(); array != nullptr) {
        for (toml::node& item : *array) for_tables(item, f);
    }
}

// A value on a single line, with tables in braces.
std::string toml_of(const toml::node& node) {
    toml::table pair{{"key", node}};
    pair.is_inline(true);
    for_tables(*pair.get("key"), [](toml::table& table) { table.is_inline(true); });
    std::ostringstream text;
    text << pair;
    constexpr std::string_view kBefore = "{ key = ";
    constexpr std::string_view kAfter = " }";
    return text.str().substr(kBefore.size(), text.str().size() - kBefore.size() - kAfter.size());
}

std::string toml_key(const std::string& step) {
    const bool is_bare = !step.empty() && std::ranges::all_of(step, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-';
    });
    return is_bare ? step : toml_of(step);
}

// Bytes of a text from first up to last.
struct TextRange {
    std::size_t first = 0;
    std::size_t last = 0;
};

// The position of a text's nodes.
class TextPlaces {
  public:
    explicit TextPlaces(std::string_view text) : text_(text) {
        for (std::size_t i = 0; i < text.size(); ++i) {
            if (text[i] == '\n') lines_.push_back(i + 1);
        }
    }

    [[nodiscard]] TextRange of(const toml::source_region& region) const {
        return {byte_of(region.begin), byte_of(region.end)};
    }
    // From the start of the key itself, including tables' names before it.
    [[nodiscard]] TextRange of(const toml::key& key, const toml::node& value) const {
        std::size_t first = byte_of(key.source().begin);
        const std::size_t line = lines_[key.source().begin.line - 1];
        while (first > line && is_of_key(text_[first - 1])) --first;
        return {first, byte_of(value.source().end)};
    }
    // The position after its line's end; for the last line, the text's end.
    [[nodiscard]] std::size_t end_of_line(std::size_t at) const {
        return std::min(text_.find('\n', at), text_.size() - 1) + 1;
    }
    [[nodiscard]] std::size_t begin_of_line(std::size_t at) const {
        return *std::prev(std::ranges::upper_bound(lines_, at));
    }
    [[nodiscard]] bool is_header(const toml::node& table) const {
        const std::size_t at = byte_of(table.source().begin);
        return at < text_.size() && text_[at] == '[';
    }

  private:
    static bool is_of_key(char c) {
        return std::string_view(" \t,{[\n").find(c) == std::string_view::npos;
    }

    // The parser counts lines, and code points along a line, from 1.
    [[nodiscard]] std::size_t byte_of(const toml::source_position& place) const {
        constexpr unsigned char kContinued = 0x80;
        constexpr unsigned char kContinuedMask = 0xC0;
        const auto is_continued = [&](std::size_t i) {
            return (static_cast<unsigned char>(text_[i]) & kContinuedMask) == kContinued;
        };
        std::size_t at = lines_[place.line - 1];
        for (toml::source_index column = 1; column < place.column; ++column) {
            ++at;
            while (at < text_.size() && is_continued(at)) ++at;
        }
        return std::min(at, text_.size());
    }

    std::string_view text_;
    std::vector<std::size_t> lines_{0};
};

// [table], or [[table]] for each of several.
bool has_headers(const toml::node& node, const TextPlaces& places) {
    if (const toml::array* array = node.as_array(); array != nullptr) {
        const toml::table* first = array->empty() ? nullptr : array->front().as_table();
        return first != nullptr && !first->is_inline();
    }
    return node.is_table() && !node.as_table()->is_inline() && places.is_header(*node.as_table());
}

// The ends of all values under a table's own header or within its braces, not under a header of
// their own; 0 if there are none.
std::size_t last_end(const toml::table& table, const TextPlaces& places) {
    std::size_t end = 0;
    for (auto&& [key, value] : table) {
        if (has_headers(value, places)) continue;
        const toml::table* inner = value.as_table();
        const bool is_dotted = inner != nullptr && !inner->is_inline();
        end = std::max(end, is_dotted ? last_end(*inner, places) : places.of(value.source()).last);
    }
    return end;
}

// [beam.narrow] also makes a table `beam`, which has no lines of its own.
bool has_no_place(const toml::table& table) {
    return std::ranges::any_of(table, [&](const auto& entry) {
        return entry.second.is_table() && entry.second.source().begin == table.source().begin;
    });
}

// The text with one more key in the table: the root, or one with a header or braces.
std::string with_key(std::string text,
                     const toml::table& table,
                     bool is_root,
                     const std::string& key,
                     const std::string& value) {
    const TextPlaces places(text);
    const std::string pair = fmt::format("{} = {}", key, value);
    const std::size_t last = last_end(table, places);
    const TextRange own = places.of(table.source());
    if (table.is_inline()) {
        return last == 0 ? text.insert(own.last - 1, fmt::format(" {} ", pair))
                         : text.insert(last, ", " + pair);
    }
    if (is_root && last == 0) return text.insert(0, pair + "\n");
    std::size_t at = places.end_of_line(last == 0 ? own.last : last);
    if (text[at - 1] != '\n') text.insert(at++, "\n");
    return text.insert(at, pair + "\n");
}

// Whole lines if nothing else is on them, including a list's mark.
TextRange with_its_surroundings(const std::string& text, TextRange range) {
    const TextPlaces places(text);
    const std::size_t begin = places.begin_of_line(range.first);
    const std::size_t end = places.end_of_line(range.last);
    const std::string_view before(text.data() + begin, range.first - begin);
    const std::string_view after(text.data() + range.last, end - range.last);
    const auto is_blank = [](std::string_view part) {
        const std::size_t at = part.find_first_not_of(" \t\r\n");
        return at == std::string_view::npos || part[at] == '#';
    };
    if (is_blank(before) && is_blank(after)) return {begin, end};
    const std::size_t comma = text.find_first_not_of(" \t\r\n", range.last);
    if (comma != std::string::npos && text[comma] == ',')
        return {range.first, text.find_first_not_of(" \t", comma + 1)};
    const std::size_t earlier = text.find_last_not_of(" \t\r\n", range.first - 1);
    if (text[earlier] == ',') return {earlier, range.last};
    return range;
}

// A table without braces spans many lines, each of which is removed separately.
void add_ranges(const toml::key& key,
                const toml::node& node,
                const TextPlaces& places,
                std::vector<TextRange>& ranges) {
    const toml::table* table = node.as_table();
    if (table == nullptr || table->is_inline()) {
        ranges.push_back(places.of(key, node));
        return;
    }
    if (places.is_header(*table)) ranges.push_back(places.of(table->source()));
    for (auto&& [name, inner] : *table) add_ranges(name, inner, places, ranges);
}

}  // namespace

RigText::RigText(const std::filesystem::path& file)
    : RigText(read_text_file(file), file.string(), file.parent_path()) {}

RigText::RigText(std::string_view toml, std::string name, std::filesystem::path folder)
    : text_(toml), name_(std::move(name)), folder_(std::move(folder)) {
    static_cast<void>(rig());  // throws if the text is not a rig's
}

bool RigText::has(std::string_view key) const {
    const toml::table root = toml::parse(text_);
    return find(root, key) != nullptr;
}

std::optional<double> RigText::number(std::string_view key) const {
    const toml::table root = toml::parse(text_);
    const toml::node* node = find(root, key);
    return node == nullptr ? std::nullopt : node->value<double>();
}

std::optional<std::string> RigText::word(std::string_view key) const {
    const toml::table root = toml::parse(text_);
    const toml::node* node = find(root, key);
    return node == nullptr ? std::nullopt : node->value<std::string>();
}

void RigText::put(std::string_view key, const std::string& value) {
    const toml::table root = toml::parse(text_);
    const TextPlaces places(text_);
    std::vector<std::string> steps = steps_of(key);
    std::vector<const toml::node*> nodes{&root};  // on the path, as far as it exists
    while (nodes.size() <= steps.size()) {
        const toml::node* next = child(*nodes.back(), steps[nodes.size() - 1]);
        if (next == nullptr) break;
        nodes.push_back(next);
    }
    if (nodes.size() > steps.size()) {
        const toml::table* table = nodes.back()->as_table();
        if (has_headers(*nodes.back(), places) || (table != nullptr && !table->is_inline()))
            throw InputError("{}: found a table; allowed: a key with a value", key);
        const TextRange range = places.of(nodes.back()->source());
        text_.replace(range.first, range.last - range.first, value);
        return;
    }
    if (const toml::array* array = nodes.back()->as_array())
        throw InputError(
            "{}: found no '{}'; allowed: {}", key, steps[nodes.size() - 1], names_in(*array));
    if (!nodes.back()->is_table()) throw InputError("{}: found no table to hold it", key);
    // a.b.c = 1 makes tables that have neither header nor braces: their keys go next to it.
    const auto is_dotted = [&](const toml::table& table) {
        return !table.is_inline() && !places.is_header(table);
    };
    while (nodes.size() > 1 && is_dotted(*nodes.back()->as_table())) nodes.pop_back();

    for (std::string& step : steps) step = toml_key(step);
    const toml::table& table = *nodes.back()->as_table();
    const std::size_t known = nodes.size() - 1;
    const bool needs_header = known == 0 ? steps.size() > 1 : has_no_place(table);
    if (!needs_header) {
        const auto first = steps.begin() + static_cast<std::ptrdiff_t>(known);
        const std::string rest = fmt::format("{}", fmt::join(first, steps.end(), "."));
        text_ = with_key(text_, table, known == 0, rest, value);
        return;
    }
    const std::string last = steps.back();
    steps.pop_back();
    if (!text_.ends_with('\n')) text_ += '\n';
    text_ += fmt::format("\n[{}]\n{} = {}\n", fmt::join(steps, "."), last, value);
}

void RigText::set(std::string_view key, double value) {
    put(key, toml_of(value));
}

void RigText::set(std::string_view key, const std::string& value) {
    put(key, toml_of(value));
}

void RigText::set(std::string_view key, const std::vector<double>& values) {
    std::vector<std::string> parts;
    for (const double value : values) parts.push_back(toml_of(value));
    put(key, fmt::format("[{}]", fmt::join(parts, ", ")));
}

void RigText::set_toml(std::string_view key, std::string_view value) {
    const auto is_one_value = [](const toml::table& table) {
        return table.size() == 1 && table.contains("key");
    };
    try {
        const toml::table table = toml::parse(fmt::format("key = {}", value));
        if (is_one_value(table)) return put(key, toml_of(*table.get("key")));
    } catch (const toml::parse_error&) {  // a word
    }
    put(key, toml_of(std::string(value)));
}

void RigText::erase(std::string_view key) {
    const toml::table root = toml::parse(text_);
    if (find(root, key) == nullptr) return;
    const std::size_t dot = key.rfind('.');
    const toml::table* table = &root;
    if (dot != std::string_view::npos) table = find(root, key.substr(0, dot))->as_table();
    if (table == nullptr) throw InputError("{}: found no table to hold it", key);
    std::vector<TextRange> ranges;
    const auto entry = table->find(key.substr(dot + 1));
    add_ranges(entry->first, entry->second, TextPlaces(text_), ranges);
    // From the end, so that earlier positions stay valid.
    std::ranges::sort(ranges, std::ranges::greater(), &TextRange::first);
    for (const TextRange& range : ranges) {
        const TextRange all = with_its_surroundings(text_, range);
        text_.erase(all.first, all.last - all.first);
    }
}

void RigText::copy(const RigText& rig, std::string_view table, std::string_view place) {
    const toml::table root = toml::parse(rig.text_);
    const toml::node* node = find(root, table);
    if (node == nullptr || !node->is_table())
        throw InputError("{}: found no table; allowed: one in the rig", table);
    erase(place);
    for (auto&& [key, value] : *node->as_table())
        put(fmt::format("{}.{}", place, std::string_view(key)), toml_of(value));
}

void RigText::copy_files(const std::filesystem::path& folder) const {
    for (const RigFile& file : rig().files) {
        const std::filesystem::path from = folder_ / file.name;
        const std::filesystem::path to = folder / file.name;
        if (exists(to) && equivalent(from, to)) continue;
        if (to.has_parent_path()) make_folder(to.parent_path());
        write_text_file(to, read_text_file(from));
    }
}

Rig RigText::rig() const {
    return parse_rig(text_, name_, folder_);
}

}  // namespace aphotic
