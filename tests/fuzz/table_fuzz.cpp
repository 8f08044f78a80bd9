// SPDX-License-Identifier: BSD-3-Clause
//
// A table from any text, and the curves of it in every role.
#include "fuzz.h"
#include "spectral/table.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto expect_sound = [](auto read) {
        aphotic::expect_result_or_placed_error("table.csv", read);
    };
    expect_sound([&] {
        const aphotic::Table table =
            aphotic::parse_table("table.csv", aphotic::text_of(data, size));
        for (const aphotic::CurveRole role : aphotic::kCurveRoles) {
            expect_sound([&] { static_cast<void>(aphotic::curves_of(table, role)); });
        }
        static_cast<void>(aphotic::roles_of(table));
    });
    return 0;
}
