// SPDX-License-Identifier: BSD-3-Clause
//
// The known name that a user probably meant, for messages: the one with the least Levenshtein
// distance (insertions, deletions, substitutions), letter case aside. Empty when even that one
// differs in half of the wanted name's length or more. Of equals, the first. A known name that
// begins with the wanted one (three letters or more) comes before all: the unit was left off.
//
// V. I. Levenshtein, "Binary codes capable of correcting deletions, insertions, and reversals",
// Soviet Physics Doklady 10(8), 707-710 (1966).
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace aphotic {

[[nodiscard]] std::string nearest_name(std::string_view wanted, std::span<const std::string> known);

}  // namespace aphotic
