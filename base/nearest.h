// SPDX-License-Identifier: BSD-3-Clause
//
// The known name that a user probably meant, for messages: the one with the least Levenshtein
// distance (insertions, deletions, substitutions), ignoring case. Empty if even that one differs in
// half the wanted name's length or more. Ties go to the first. A known name that starts with the
// wanted one (three letters or more) has priority, since the unit is probably missing.
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
