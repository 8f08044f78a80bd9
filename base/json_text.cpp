// SPDX-License-Identifier: BSD-3-Clause
#include "base/json_text.h"

#include "base/error.h"
#include "base/printable.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

namespace aphotic {
namespace {

// The depth, without building values; and duplicate keys in an object, of which the library
// silently keeps the last.
struct Survey final : nlohmann::json_sax<nlohmann::json> {
    std::vector<std::set<std::string>> open{};  // the keys of open objects
    std::optional<std::string> twice{};
    int depth = 0;
    int deepest = 0;

    bool start_object(std::size_t) override {
        open.emplace_back();
        return start_array(0);
    }
    bool end_object() override {
        open.pop_back();
        return end_array();
    }
    bool key(string_t& name) override {
        if (!open.back().insert(name).second && !twice) twice = name;
        return true;
    }
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_array(std::size_t) override {
        deepest = std::max(deepest, ++depth);
        return true;
    }
    bool end_array() override {
        --depth;
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) override {
        return false;
    }
};

}  // namespace

nlohmann::json parse_json(std::string_view text, const std::string& what) {
    Survey survey;
    const bool is_valid = nlohmann::json::sax_parse(text, &survey);
    if (survey.deepest > kMostJsonDepth) {
        throw InputError("{}: found values nested {} deep; allowed: up to {}",
                         what,
                         survey.deepest,
                         kMostJsonDepth);
    }
    if (!is_valid) throw InputError(what + ": not valid JSON");
    if (survey.twice)
        throw InputError("{}: duplicate key '{}' in an object", what, excerpt(*survey.twice));
    return nlohmann::json::parse(text);
}

std::string json_text(const nlohmann::ordered_json& json) {
    constexpr int kIndent = 2;
    const std::string dumped =
        json.dump(kIndent, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    // Escapes control characters that JSON does not: U+007F, and U+0080 to U+009F.
    std::string text;
    for (std::size_t i = 0; i < dumped.size(); ++i) {
        const auto byte = static_cast<unsigned char>(dumped[i]);
        const auto next = static_cast<unsigned char>(i + 1 < dumped.size() ? dumped[i + 1] : ' ');
        const bool is_upper = byte == 0xC2 && next < 0xA0;
        if (byte != 0x7F && !is_upper) {
            text += dumped[i];
            continue;
        }
        text += fmt::format("\\u00{:02x}", is_upper ? next : byte);
        if (is_upper) ++i;
    }
    return text;
}

bool is_whole_number(const nlohmann::json& value, std::int64_t least, std::int64_t most) {
    if (!value.is_number_integer()) return false;
    const auto number = value.get<double>();
    return number >= static_cast<double>(least) && number <= static_cast<double>(most);
}

std::int64_t whole_number_at(const nlohmann::json& object,
                             const std::string& key,
                             std::int64_t least,
                             std::int64_t most) {
    const nlohmann::json& value = object.at(key);
    if (is_whole_number(value, least, most)) return value.get<std::int64_t>();
    throw InputError("{}: found {}; allowed: a whole number from {} to {}",
                     key,
                     excerpt(value.dump()),
                     least,
                     most);
}

}  // namespace aphotic
