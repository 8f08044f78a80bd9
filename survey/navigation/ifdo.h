// SPDX-License-Identifier: BSD-3-Clause
//
// An image FAIR Digital Object, version 2: the metadata of an image set and of each image, as JSON
// or YAML,
//
//   image-set-header: {image-set-name: ..., image-license: ..., ...}      defaults of all images
//   image-set-items:  {a.tif: {image-datetime: ...}, b.tif: [{...}], ...}
//
// with an object for each image, or a list of them: for a video, or for a still image with a single
// one.
//
// YAML's anchors and aliases are expanded as they are met, up to what a text of that size can need.
// Its plain scalars are null, booleans, numbers or else strings; dates are strings. When written,
// an object's keys are in alphabetical order, and YAML strings in double quotes.
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
    std::string source;  // for messages
    bool is_yaml = false;
    IfdoJson set{};  // with both objects above

    [[nodiscard]] const IfdoJson& header() const { return set.at("image-set-header"); }
    [[nodiscard]] const IfdoJson& items() const { return set.at("image-set-items"); }
    // From the image's object, otherwise from the header; null if neither has it.
    [[nodiscard]] const IfdoJson& field(const IfdoJson& image, const std::string& key) const;
};

// Whether a text claims to be an iFDO.
[[nodiscard]] bool is_ifdo(std::string_view text);

// name is for messages. An InputError if it is not an iFDO, is nested deeper than kMostJsonDepth,
// longer than kMostIfdo_bytes, has more than kMostYamlValues in YAML, or would be longer than its
// size allows when aliases are expanded.
[[nodiscard]] Ifdo parse_ifdo(const std::string& name, std::string_view text);

// The object of a still image, given its item: the item itself or the only object of its list;
// otherwise null.
[[nodiscard]] const IfdoJson* still_image(const IfdoJson& item);

// In its original format, JSON or YAML.
[[nodiscard]] std::string ifdo_text(const Ifdo& ifdo);

}  // namespace aphotic
