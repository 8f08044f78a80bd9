// SPDX-License-Identifier: BSD-3-Clause
#include "base/nearest.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <numeric>
#include <vector>

namespace aphotic {
namespace {

bool same_letter(char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) ==
           std::tolower(static_cast<unsigned char>(b));
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
    // row[j]: distance between the part of a seen so far and the first j letters of b.
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t substituted = diagonal + (same_letter(a[i], b[j]) ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, substituted});
        }
    }
    return row.back();
}

}  // namespace

std::string nearest_name(std::string_view wanted, std::span<const std::string> known) {
    // The most common mistake is a missing unit.
    constexpr std::size_t kLeastPrefix = 3;
    for (const std::string& name : known) {
        if (wanted.size() >= kLeastPrefix && name.starts_with(wanted)) return name;
    }
    std::string nearest;
    std::size_t least = wanted.size();
    for (const std::string& name : known) {
        const std::size_t distance = edit_distance(wanted, name);
        if (2 * distance < wanted.size() && distance < least) {
            least = distance;
            nearest = name;
        }
    }
    return nearest;
}

}  // namespace aphotic
