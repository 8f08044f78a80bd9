// SPDX-License-Identifier: BSD-3-Clause
//
// A file of patches from any text.
#include "fuzz.h"
#include "validation/patch_file.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    aphotic::expect_result_or_placed_error("patches.csv", [&] {
        static_cast<void>(aphotic::parse_patches("patches.csv", aphotic::text_of(data, size)));
    });
    return 0;
}
