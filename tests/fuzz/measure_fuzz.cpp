// SPDX-License-Identifier: BSD-3-Clause
//
// A saved measure of a study from any text: what is not ours tells of none, so every text is taken.
#include "fuzz.h"
#include "validation/saved_measure.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static_cast<void>(aphotic::parse_measure(
        aphotic::text_of(data, size), aphotic::StudySetting{.name = "fitted-3"}, "key"));
    return 0;
}
