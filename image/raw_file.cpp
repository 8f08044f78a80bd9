// SPDX-License-Identifier: BSD-3-Clause
#include "image/raw_file.h"

#include "base/words.h"
#include "image/any_image_part.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace aphotic {

bool is_raw_name(const std::filesystem::path& file) {
    static constexpr std::array<std::string_view, 4> kExtensions{".dng", ".cr2", ".nef", ".arw"};
    return std::ranges::find(kExtensions, lower_case(file.extension().string())) !=
           kExtensions.end();
}

RawFile open_raw_file(const std::filesystem::path& file) {
    using Open = void (*)(const std::filesystem::path&, RawFile&);
    RawFile raw;
    from_part<Open>("aphotic_open_raw_file")(file, raw);
    return raw;
}

}  // namespace aphotic
