// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation/ifdo.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/number.h"
#include "base/printable.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace aphotic {
namespace {

constexpr const char* kSetHeader = "image-set-header";
constexpr const char* kSetItems = "image-set-items";

IfdoJson plain_scalar(const std::string& text) {
    static constexpr std::array<std::string_view, 5> kNull{"", "~", "null", "Null", "NULL"};
    static constexpr std::array<std::string_view, 3> kTrue{"true", "True", "TRUE"};
    static constexpr std::array<std::string_view, 3> kFalse{"false", "False", "FALSE"};
    const auto is_in = [&](const auto& words) {
        return std::ranges::find(words, text) != words.end();
    };
    if (is_in(kNull)) return nullptr;
    if (is_in(kTrue)) return true;
    if (is_in(kFalse)) return false;
    std::string_view digits = text;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    // Such as 007, which readers may take as octal, as a number, or as a name.
    const std::size_t first = digits.starts_with('-') ? 1 : 0;
    const bool is_padded = digits.size() > first + 1 && digits[first] == '0' &&
                           digits[first + 1] >= '0' && digits[first + 1] <= '9';
    if (is_padded) return text;
    if (const auto whole = read_number<std::int64_t>(digits)) return *whole;
    if (const auto real = read_number<double>(digits); real && std::isfinite(*real)) return *real;
    return text;
}

// YAML as JSON.
class Converter {
  public:
    Converter(const std::string& name, std::size_t most_values) : name_(name), left_(most_values) {}

    [[nodiscard]] IfdoJson json_of(const YAML::Node& node, int depth = 0) {
        if (depth > kMostJsonDepth) fail(node, "it is nested too deeply");
        if (left_ == 0) fail(node, "its aliases expand to more than the file could hold");
        --left_;
        switch (node.Type()) {
            case YAML::NodeType::Scalar:
                return node.Tag() == "?" ? plain_scalar(node.Scalar()) : IfdoJson(node.Scalar());
            case YAML::NodeType::Sequence: {
                IfdoJson list = IfdoJson::array();
                for (const YAML::Node& one : node) list.push_back(json_of(one, depth + 1));
                return list;
            }
            case YAML::NodeType::Map: {
                IfdoJson object = IfdoJson::object();
                for (const auto& entry : node) {
                    const YAML::Node& key = entry.first;
                    if (!key.IsScalar()) fail(key, "a key is not a string");
                    if (object.contains(key.Scalar()))
                        fail(key, fmt::format("duplicate key '{}'", excerpt(key.Scalar())));
                    object[key.Scalar()] = json_of(entry.second, depth + 1);
                }
                return object;
            }
            default:
                return nullptr;
        }
    }

  private:
    [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const {
        fail_at_line(name_, static_cast<std::size_t>(node.Mark().line) + 1, what);
    }

    const std::string& name_;
    std::size_t left_;
};

// JSON must be UTF-8.
void require_utf8(const std::string& name, std::string_view text) {
    try {
        (void)IfdoJson(text).dump();
    } catch (const IfdoJson::type_error&) {
        throw InputError("{}: found bytes that are not UTF-8", name);
    }
}

// Checked before any are built.
void require_few_values(const std::string& name, std::string_view text) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool is_item = text[i] == '-' && text.substr(i + 1).starts_with(' ');
        if (is_item || std::string_view("\n\r,[{").find(text[i]) != std::string_view::npos) ++count;
    }
    if (count <= kMostYamlValues) return;
    throw InputError(
        "{}: found {} lines and values of YAML; allowed: up to {}; an iFDO in JSON may have more",
        name,
        count,
        kMostYamlValues);
}

IfdoJson json_of_yaml(const std::string& name, std::string_view text) {
    // Without aliases a value takes at least two characters; these limits leave room for aliases.
    constexpr std::size_t kMostValuesOfLetter = 4;
    constexpr std::size_t kAnyway = 1000;
    require_few_values(name, text);
    require_utf8(name, text);
    try {
        return Converter(name, kAnyway + kMostValuesOfLetter * text.size())
            .json_of(YAML::Load(std::string(text)));
    } catch (const YAML::Exception& error) {
        const int line = error.mark.is_null() ? 0 : error.mark.line;
        fail_at_line(name, static_cast<std::size_t>(line) + 1, printable(error.msg));
    }
}

// Fields have other names and meanings in other versions.
void require_version(const Ifdo& ifdo) {
    const auto version = ifdo.header().find("image-set-ifdo-version");
    if (version == ifdo.header().end()) return;
    const std::string words = version->is_string() ? version->get<std::string>() : version->dump();
    if (words.starts_with("v2.") || words.starts_with("2.")) return;
    throw InputError("{}: image-set-ifdo-version: found {}; allowed: v2.0.0 and later, below v3",
                     ifdo.source,
                     excerpt(words));
}

void emit(YAML::Emitter& out, const IfdoJson& value) {
    if (value.is_object()) {
        out << YAML::BeginMap;
        for (const auto& [key, of_key] : value.items()) {
            out << YAML::Key << key << YAML::Value;
            emit(out, of_key);
        }
        out << YAML::EndMap;
    } else if (value.is_array()) {
        const bool is_flat = std::ranges::none_of(value, &IfdoJson::is_structured);
        out << (is_flat ? YAML::Flow : YAML::Block) << YAML::BeginSeq;
        for (const IfdoJson& one : value) emit(out, one);
        out << YAML::EndSeq;
    } else if (value.is_string()) {
        out << YAML::DoubleQuoted << value.get<std::string>();
    } else if (value.is_null()) {
        out << YAML::Null;
    } else {
        out << value.dump();  // a number, true or false
    }
}

}  // namespace

const IfdoJson& Ifdo::field(const IfdoJson& image, const std::string& key) const {
    static const IfdoJson kNone;
    for (const IfdoJson* object : {&image, &header()}) {
        if (const auto found = object->find(key); found != object->end() && !found->is_null())
            return *found;
    }
    return kNone;
}

bool is_ifdo(std::string_view text) {
    return text.find(kSetHeader) != std::string_view::npos &&
           text.find(kSetItems) != std::string_view::npos;
}

Ifdo parse_ifdo(const std::string& name, std::string_view text) {
    if (text.size() > kMostIfdo_bytes) {
        throw InputError(
            "{}: found {} bytes; allowed: up to {}", name, text.size(), kMostIfdo_bytes);
    }
    text = without_byte_order_mark(text);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    Ifdo ifdo{.source = name, .is_yaml = first == std::string_view::npos || text[first] != '{'};
    ifdo.set = ifdo.is_yaml ? json_of_yaml(name, text) : parse_json(text, name);
    for (const char* key : {kSetHeader, kSetItems}) {
        const bool is_there = ifdo.set.is_object() && ifdo.set.contains(key);
        if (is_there && ifdo.set[key].is_object()) continue;
        throw InputError("{}: {}: found {}; allowed: an object, as in an iFDO of version 2",
                         name,
                         key,
                         is_there ? ifdo.set[key].type_name() : "none");
    }
    require_version(ifdo);
    return ifdo;
}

const IfdoJson* still_image(const IfdoJson& item) {
    if (item.is_object()) return &item;
    return item.is_array() && item.size() == 1 && item[0].is_object() ? &item[0] : nullptr;
}

std::string ifdo_text(const Ifdo& ifdo) {
    if (!ifdo.is_yaml) return json_text(ifdo.set);
    YAML::Emitter out;
    emit(out, ifdo.set);
    return std::string(out.c_str()) + "\n";
}

}  // namespace aphotic
