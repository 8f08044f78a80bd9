// SPDX-License-Identifier: BSD-3-Clause
//
// The journal of a corrected survey from any text: what is not ours is passed over, so every text
// is taken.
#include "base/work_folder.h"
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static_cast<void>(aphotic::parse_journal(aphotic::text_of(data, size)));
    return 0;
}
