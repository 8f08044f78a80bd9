// SPDX-License-Identifier: BSD-3-Clause
//
// One table of a rig file, as its readers access it: every key by name, its type and bounds
// checked, and at the end an error for any key that was not read. Every error is an InputError
// "file:line: key: what was found; allowed: ...".
#pragma once

#include "base/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>
#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// The limit for each of strobes, beams, cones of a beam, materials, objects. The work for one grows
// with all the others.
inline constexpr std::size_t kMostOfAKind = 1024;

// Enough for any title or file name; POV-Ray also reads it within a comment.
inline constexpr std::size_t kMostTextBytes = 1000;

struct Bounds {
    double least;
    double most;
};

[[nodiscard]] std::string allowed_number(Bounds bounds);

// One table of the rig file, with its position and the record of keys that were read.
class Section {
  public:
    Section(const toml::table& table, std::string path, const std::string& file)
        : table_(table), path_(std::move(path)), file_(file) {}

    [[noreturn]] void fail(const toml::node& node,
                           std::string_view key,
                           const std::string& what) const;

    [[noreturn]] void fail_at(std::string_view key, const std::string& what) const {
        fail(*table_.get(key), key, what);
    }

    [[noreturn]] void found_but(std::string_view key, const std::string& allowed) const;

    [[nodiscard]] bool has(std::string_view key);

    [[nodiscard]] const toml::node& required(std::string_view key, const std::string& allowed);

    [[nodiscard]] double number(std::string_view key, Bounds bounds);

    [[nodiscard]] double number_or(std::string_view key, Bounds bounds, double absent) {
        return has(key) ? number(key, bounds) : absent;
    }

    template <std::size_t n>
    [[nodiscard]] std::array<double, n> numbers(std::string_view key, Bounds bounds) {
        const std::string allowed =
            fmt::format("an array of {} numbers, each from {} to {}", n, bounds.least, bounds.most);
        const toml::array* array = required(key, allowed).as_array();
        if (array == nullptr || array->size() != n) found_but(key, allowed);
        std::array<double, n> values{};
        for (std::size_t i = 0; i < n; ++i) {
            if (!is_within((*array)[i], bounds)) found_but(key, allowed);
            values[i] = *(*array)[i].template value<double>();
        }
        return values;
    }

    [[nodiscard]] Eigen::Vector3d vector_or(
        std::string_view key,
        Bounds bounds,
        const Eigen::Vector3d& absent = Eigen::Vector3d::Zero()) {
        return has(key) ? Eigen::Vector3d(numbers<3>(key, bounds).data()) : absent;
    }

    [[nodiscard]] std::string text(std::string_view key, const std::string& allowed);

    [[nodiscard]] std::string text_or(std::string_view key,
                                      const std::string& allowed,
                                      std::string absent) {
        return has(key) ? text(key, allowed) : absent;
    }

    [[nodiscard]] std::vector<std::string> texts(std::string_view key, const std::string& allowed);

    void require_few(std::string_view key, std::size_t count) const;

    // One of a few words.
    [[nodiscard]] std::string word(std::string_view key, const std::vector<std::string>& words);

    [[nodiscard]] Section section(std::string_view key, const std::string& allowed);

    // The tables of an array, which may not be empty.
    [[nodiscard]] std::vector<Section> sections(std::string_view key, const std::string& allowed);

    [[nodiscard]] std::vector<std::string> keys() const;

    // Call after reading every known key.
    void refuse_unknown_keys() const;

    // Call before reading any key: if another key is present instead of a required one, the message
    // then names the cause.
    void refuse_keys_but(std::string_view known);  // separated by commas

    // The one of these keys that is there, or empty: alternative ways to give one value.
    std::string_view refuse_both(std::initializer_list<std::string_view> keys);

    // Runs read(), and prefixes any InputError with file, line and key.
    template <typename Read>
    [[nodiscard]] auto at_key(std::string_view key, Read read) const {
        try {
            return read();
        } catch (const InputError& error) {
            const toml::node* node = table_.get(key);
            fail(node == nullptr ? table_ : *node, key, error.what());
        }
    }

    // Strings of a rig are copied to scenes, settings, pages and messages, where a newline or an
    // escape would have a meaning.
    void require_one_line(const toml::node& node,
                          std::string_view key,
                          std::string_view text) const;

  private:
    [[nodiscard]] std::string one_line(const toml::node& node, std::string_view key) const;

    static bool is_within(const toml::node& node, Bounds bounds);

    [[nodiscard]] bool is_known(std::string_view key) const {
        return std::find(known_.begin(), known_.end(), key) != known_.end();
    }

    static std::size_t line(const toml::node& node) {
        return std::max<std::size_t>(1, node.source().begin.line);
    }

    [[nodiscard]] std::string name_of(std::string_view key) const;

    const toml::table& table_;
    std::string path_;
    const std::string& file_;
    std::vector<std::string> known_;
};

}  // namespace aphotic
