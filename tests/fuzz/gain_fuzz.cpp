// SPDX-License-Identifier: BSD-3-Clause
//
// The gain in the notes of a corrected survey, from any text: what is not ours tells of none, so
// every text is taken. A gain that comes of it is one to multiply with.
#include "fuzz.h"
#include "survey/gain.h"

#include <cmath>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto kept = aphotic::kept_gain(aphotic::text_of(data, size), "digest");
    if (!kept) return 0;
    for (const double gain : kept->gain) {
        if (!std::isfinite(gain) || gain <= 0.0) std::abort();
    }
    return 0;
}
