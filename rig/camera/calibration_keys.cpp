// SPDX-License-Identifier: BSD-3-Clause
#include "rig/camera/calibration_keys.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "base/printable.h"
#include "base/words.h"
#include "image/image_size.h"
#include "rig/beam/photometric_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>
#include <pugixml.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace aphotic {

namespace {

using Kind = CalibrationValue::Kind;

// A calibration has four levels.
constexpr std::size_t kMostLevels = 16;

void require_shallow(const std::string& file_name, std::size_t line, std::size_t level) {
    if (level <= kMostLevels) return;
    fail_at_line(
        file_name, line, "found values nested more than {} deep; allowed: less", kMostLevels);
}

std::size_t line_of(const YAML::Mark& mark) {
    return mark.is_null() ? 1 : static_cast<std::size_t>(mark.line) + 1;
}

// Reads the one document of a file. Aliases, which no calibration has, would let a few bytes expand
// to any number of values.
class YamlReader : public YAML::EventHandler {
  public:
    explicit YamlReader(const std::string& file_name) : file_name_(file_name) {}

    [[nodiscard]] const CalibrationValue& root() const { return root_; }

    void OnDocumentStart(const YAML::Mark& mark) override {
        if (has_document_)
            fail_at_line(file_name_, line_of(mark), "found a second document; allowed: one");
        has_document_ = true;
    }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { add_text(mark, ""); }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
        fail_at_line(file_name_, line_of(mark), "found an alias; allowed: plain values");
    }
    void OnScalar(const YAML::Mark& mark,
                  const std::string&,
                  YAML::anchor_t,
                  const std::string& text) override {
        add_text(mark, text);
    }
    void OnSequenceStart(const YAML::Mark& mark,
                         const std::string&,
                         YAML::anchor_t,
                         YAML::EmitterStyle::value) override {
        open(mark, Kind::List);
    }
    void OnSequenceEnd() override { close(); }
    void OnMapStart(const YAML::Mark& mark,
                    const std::string&,
                    YAML::anchor_t,
                    YAML::EmitterStyle::value) override {
        open(mark, Kind::Map);
    }
    void OnMapEnd() override { close(); }

  private:
    struct Open {
        CalibrationValue value;
        std::optional<std::string> key{};  // of a map: that of the next value
    };

    void open(const YAML::Mark& mark, Kind kind) {
        open_.push_back({.value = {.kind = kind, .line = line_of(mark)}});
        require_shallow(file_name_, line_of(mark), open_.size());
    }
    void close() {
        CalibrationValue value = std::move(open_.back().value);
        open_.pop_back();
        add(std::move(value));
    }
    void add_text(const YAML::Mark& mark, const std::string& text) {
        add({.text = text, .line = line_of(mark)});
    }
    void add(CalibrationValue value) {
        if (open_.empty()) {
            root_ = std::move(value);
            return;
        }
        auto& [parent, key] = open_.back();
        if (parent.kind == Kind::Map && !key) {
            key = std::move(value.text);
            return;
        }
        value.name = key.value_or("");
        key.reset();
        parent.values.push_back(std::move(value));
    }

    const std::string& file_name_;
    bool has_document_ = false;
    std::vector<Open> open_;
    CalibrationValue root_;
};

// Line numbers of offsets requested in increasing order.
class LineCount {
  public:
    explicit LineCount(std::string_view text) : text_(text) {}

    std::size_t at(std::ptrdiff_t offset) {
        const auto end = std::clamp(static_cast<std::size_t>(offset), counted_, text_.size());
        line_ += static_cast<std::size_t>(
            std::ranges::count(text_.substr(counted_, end - counted_), '\n'));
        counted_ = end;
        return line_;
    }

  private:
    std::string_view text_;
    std::size_t counted_ = 0;
    std::size_t line_ = 1;
};

CalibrationValue value_of(const pugi::xml_node& element,
                          LineCount& lines,
                          const std::string& file_name,
                          std::size_t level) {
    CalibrationValue value;
    value.name = element.name();
    value.line = lines.at(element.offset_debug());
    require_shallow(file_name, value.line, level);
    value.text = element.text().get();
    for (const pugi::xml_node& child : element.children()) {
        if (child.type() != pugi::node_element) continue;
        value.kind = Kind::Map;
        value.values.push_back(value_of(child, lines, file_name, level + 1));
    }
    return value;
}

}  // namespace

CalibrationValue parse_calibration_yaml(const std::string& file_name, std::string_view text) {
    YamlReader reader(file_name);
    try {
        std::istringstream stream{std::string(text)};
        YAML::Parser parser(stream);
        while (parser.HandleNextDocument(reader)) {
        }
    } catch (const YAML::Exception& error) {
        fail_at_line(file_name, line_of(error.mark), "not valid YAML: {}", printable(error.msg));
    }
    if (reader.root().kind != Kind::Map) {
        throw InputError(
            "{}: found no keys; allowed: a camera calibration in YAML, JSON or XML, or COLMAP's "
            "cameras.txt",
            file_name);
    }
    return reader.root();
}

CalibrationValue parse_calibration_xml(const std::string& file_name, std::string_view text) {
    pugi::xml_document document;
    const pugi::xml_parse_result result =
        document.load_buffer(text.data(),
                             text.size(),
                             pugi::parse_default | pugi::parse_trim_pcdata,
                             pugi::encoding_utf8);
    LineCount lines(text);
    if (!result)
        fail_at_line(file_name, lines.at(result.offset), "not valid XML: {}", result.description());
    return value_of(document.document_element(), lines, file_name, 1);
}

CalibrationKeys::CalibrationKeys(const std::string& file_name,
                                 const CalibrationValue& map,
                                 std::string path)
    : file_name_(file_name), map_(map), path_(std::move(path)) {}

std::string CalibrationKeys::path_of(std::string_view key) const {
    return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

void CalibrationKeys::fail(std::string_view key, const std::string& what) const {
    const CalibrationValue* value = find(key);
    const std::size_t line = value == nullptr ? map_.line : value->line;
    fail_at_line(file_name_, line, "{}: {}", path_of(key), what);
}

const CalibrationValue* CalibrationKeys::find(std::string_view key) const {
    const CalibrationValue* found = nullptr;
    const std::string wanted = lower_case(std::string(key));
    for (const CalibrationValue& value : map_.values) {
        if (lower_case(value.name) != wanted) continue;
        if (found != nullptr) {
            fail_at_line(file_name_, value.line, "{}: duplicate key; allowed: once", path_of(key));
        }
        found = &value;
    }
    return found;
}

bool CalibrationKeys::has(std::string_view key) const {
    return find(key) != nullptr;
}

std::vector<std::string> CalibrationKeys::names() const {
    std::vector<std::string> all;
    for (const CalibrationValue& value : map_.values) all.push_back(value.name);
    return all;
}

const CalibrationValue& CalibrationKeys::required(std::string_view key,
                                                  std::string_view allowed) const {
    const CalibrationValue* value = find(key);
    if (value == nullptr) fail(key, fmt::format("is missing; allowed: {}", allowed));
    return *value;
}

double CalibrationKeys::finite(std::string_view key, std::string_view text) const {
    const std::optional<double> number = finite_number(text);
    if (!number) fail(key, fmt::format("found {}; allowed: a finite number", shown_word(text)));
    return *number;
}

double CalibrationKeys::number(std::string_view key) const {
    const CalibrationValue& value = required(key, "a number");
    if (value.kind != Kind::Text) fail(key, "found several values; allowed: a number");
    return finite(key, value.text);
}

double CalibrationKeys::number_or(std::string_view key, double absent) const {
    return has(key) ? number(key) : absent;
}

int CalibrationKeys::size(std::string_view key, double pixels) const {
    if (pixels < 1.0 || pixels > kLargestImagePx || pixels != std::floor(pixels)) {
        fail(
            key,
            fmt::format("found {}; allowed: a whole number from 1 to {}", pixels, kLargestImagePx));
    }
    return static_cast<int>(pixels);
}

std::vector<double> CalibrationKeys::numbers(std::string_view key) const {
    const CalibrationValue& value = required(key, "a list of numbers");
    if (value.kind == Kind::Map) fail(key, "found keys; allowed: a list of numbers");
    std::vector<double> all;
    for (const std::string_view word : words_in(value.text)) all.push_back(finite(key, word));
    for (const CalibrationValue& item : value.values) {
        if (item.kind != Kind::Text) fail(key, "found nested lists; allowed: numbers");
        all.push_back(finite(key, item.text));
    }
    return all;
}

std::vector<double> CalibrationKeys::numbers(std::string_view key, std::size_t count) const {
    std::vector<double> all = numbers(key);
    if (all.size() != count)
        fail(key, fmt::format("found {}; allowed: {}", counted(all.size(), "number"), count));
    return all;
}

std::string CalibrationKeys::word(std::string_view key,
                                  const std::vector<std::string>& allowed) const {
    const CalibrationValue& value = required(key, fmt::format("{}", fmt::join(allowed, ", ")));
    if (value.kind != Kind::Text || std::ranges::find(allowed, value.text) == allowed.end()) {
        fail(
            key,
            fmt::format("found {}; allowed: {}", shown_word(value.text), fmt::join(allowed, ", ")));
    }
    return value.text;
}

CalibrationKeys CalibrationKeys::map(std::string_view key) const {
    const CalibrationValue& value = required(key, "keys and values");
    if (value.kind != Kind::Map) {
        fail(key, fmt::format("found {}; allowed: keys and values", shown_word(value.text)));
    }
    return {file_name_, value, path_of(key)};
}

}  // namespace aphotic
