// SPDX-License-Identifier: BSD-3-Clause
//
// A manifest from any text.
#include "fuzz.h"
#include "spectral/manifest.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    aphotic::expect_result_or_placed_error("manifest.json", [&] {
        const aphotic::Manifest manifest =
            aphotic::parse_manifest("manifest.json", aphotic::text_of(data, size));
        for (std::size_t c = 0; c < aphotic::kChannels; ++c) static_cast<void>(manifest.black(c));
    });
    return 0;
}
