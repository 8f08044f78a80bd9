// SPDX-License-Identifier: BSD-3-Clause
//
// Times from any mask, the text's first line, and any name and EXIF, the rest.
#include "base/error.h"
#include "fuzz.h"
#include "survey/navigation/image_time.h"
#include "survey/navigation/time_text.h"

#include <algorithm>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text = aphotic::text_of(data, size);
    const std::string mask = text.substr(0, text.find('\n'));
    const std::string name = text.substr(std::min(text.size(), mask.size() + 1));
    aphotic::expect_result_or_placed_error("mask", [&] {
        aphotic::naming("mask", [&] { aphotic::require_time_mask(mask); });
        if (const auto time_s = aphotic::time_by_mask(name, mask))
            static_cast<void>(aphotic::utc_text(*time_s));
    });
    static_cast<void>(aphotic::time_in_habcam_name(name.substr(0, 255)));  // as long as a name is
    static_cast<void>(aphotic::time_in_exif({{"Exif:DateTimeOriginal", name}}));
    if (const auto time_s = aphotic::unix_time_s(name))
        static_cast<void>(aphotic::utc_text(*time_s));
    return 0;
}
