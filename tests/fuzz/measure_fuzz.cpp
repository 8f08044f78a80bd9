// SPDX-License-Identifier: BSD-3-Clause
//
// A study's file from any text: what is not ours has no measures, so every text is taken.
#include "fuzz.h"
#include "validation/study.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static_cast<void>(aphotic::measures_in(
        aphotic::text_of(data, size),
        {.rig_title = "HabCam", .width_px = 680, .height_px = 512, .aphotic_version = "1"}));
    return 0;
}
