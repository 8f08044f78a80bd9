// SPDX-License-Identifier: BSD-3-Clause
//
// An image FAIR Digital Object, version 2: what an image set says of itself and of each image, as
// JSON or YAML,
//
//   image-set-header: {image-set-name: ..., image-license: ..., ...}      defaults of all images
//   image-set-items:  {a.tif: {image-datetime: ...}, b.tif: [{...}], ...}
//
// with an object for each image, or a list of them: of a video, or of a still image with one.
//
// YAML's anchors and aliases are written out as they are met, as far as a text of that size can
// want. Its plain scalars are null, booleans, numbers or else strings; dates are strings. Written
// again, the keys of an object are in alphabetical order, and strings of YAML in double quotes.
//
// marine-imaging.com/fair/ifdos; the JSON schema of version 2.2.1.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace aphotic {

using IfdoJson = nlohmann::json;  // sorted: a set may have a hundred thousand items

inline constexpr std::size_t kMostIfdo_bytes = std::size_t{256} << 20U;
// Lines, and values within them: yaml-cpp takes about a kilobyte for each.
inline constexpr std::size_t kMostYamlValues = 800'000;

struct Ifdo {
    std::string source;  // stands in messages
    bool is_yaml = false;
    IfdoJson set{};  // with both objects above

    [[nodiscard]] const IfdoJson& header() const { return set.at("image-set-header"); }
    [[nodiscard]] const IfdoJson& items() const { return set.at("image-set-items"); }
    // Of an image's object, else of the header; null when neither has it.
    [[nodiscard]] const IfdoJson& field(const IfdoJson& image, const std::string& key) const;
};

// Whether a text claims to be one.
[[nodiscard]] bool is_ifdo(std::string_view text);

// name stands in messages. What is none, nested deeper than kMostJsonDepth, longer than
// kMostIfdo_bytes, of more than kMostYamlValues in YAML, or longer than that could be when aliases
// are written out, is an InputError.
[[nodiscard]] Ifdo parse_ifdo(const std::string& name, std::string_view text);

// The object of a still image, given its item: the item itself or the only one of its list; null
// for none.
[[nodiscard]] const IfdoJson* still_image(const IfdoJson& item);

// As it came, JSON or YAML.
[[nodiscard]] std::string ifdo_text(const Ifdo& ifdo);

}  // namespace aphotic
