// SPDX-License-Identifier: BSD-3-Clause
//
// A rig from any text. What it names is looked up among the shipped scenes.
#include "fuzz.h"
#include "rig/file/rig_reader.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    aphotic::expect_result_or_placed_error("rig.toml", [&] {
        static_cast<void>(aphotic::parse_rig(
            aphotic::text_of(data, size), "rig.toml", APHOTIC_SOURCE_DIR "/scenes"));
    });
    return 0;
}
