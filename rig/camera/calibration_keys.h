// SPDX-License-Identifier: BSD-3-Clause
//
// The keys and values of a calibration in YAML, JSON (which is YAML) or XML that its readers use.
// Everything else in the file is ignored. Names are compared without case: OpenCV wrote
// Camera_Matrix before it wrote camera_matrix.
//
// Endlessly nested values, aliases and further documents are an InputError.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct CalibrationValue {
    enum class Kind { Text, List, Map };
    Kind kind = Kind::Text;
    std::string name{};  // of the key; of an element in XML; empty in a list
    std::string text{};
    std::vector<CalibrationValue> values{};  // of a list or map
    std::size_t line = 0;
};

// A map. %YAML:1.0 of OpenCV and its tags are accepted.
[[nodiscard]] CalibrationValue parse_calibration_yaml(const std::string& file_name,
                                                      std::string_view text);

// The root element: a map of its elements.
[[nodiscard]] CalibrationValue parse_calibration_xml(const std::string& file_name,
                                                     std::string_view text);

// A map whose errors name file, line and key.
class CalibrationKeys {
  public:
    // Both must outlive it.
    CalibrationKeys(const std::string& file_name,
                    const CalibrationValue& map,
                    std::string path = "");

    [[nodiscard]] bool has(std::string_view key) const;
    [[nodiscard]] std::vector<std::string> names() const;

    [[nodiscard]] double number(std::string_view key) const;
    [[nodiscard]] double number_or(std::string_view key, double absent) const;
    // Pixels across or along an image: the key's number, or one of its numbers.
    [[nodiscard]] int size(std::string_view key) const { return size(key, number(key)); }
    [[nodiscard]] int size(std::string_view key, double pixels) const;
    // From a list, or from blank-separated words, as in XML.
    [[nodiscard]] std::vector<double> numbers(std::string_view key) const;
    [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count) const;
    [[nodiscard]] std::string word(std::string_view key,
                                   const std::vector<std::string>& allowed) const;
    [[nodiscard]] CalibrationKeys map(std::string_view key) const;

    [[noreturn]] void fail(std::string_view key, const std::string& what) const;

  private:
    [[nodiscard]] const CalibrationValue* find(std::string_view key) const;
    [[nodiscard]] const CalibrationValue& required(std::string_view key,
                                                   std::string_view allowed) const;
    [[nodiscard]] double finite(std::string_view key, std::string_view text) const;
    [[nodiscard]] std::string path_of(std::string_view key) const;

    const std::string& file_name_;
    const CalibrationValue& map_;
    std::string path_;
};

}  // namespace aphotic
