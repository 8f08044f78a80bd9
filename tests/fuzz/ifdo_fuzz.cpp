// SPDX-License-Identifier: BSD-3-Clause
//
// An iFDO from any text, the poses in it, and itself read again.
#include "fuzz.h"
#include "survey/navigation/navigation_ifdo.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text = aphotic::text_of(data, size);
    aphotic::expect_result_or_placed_error("set.yaml", [&] {
        const aphotic::Ifdo ifdo = aphotic::parse_ifdo("set.yaml", text);
        if (aphotic::parse_ifdo("again", aphotic::ifdo_text(ifdo)).set != ifdo.set) std::abort();
        const aphotic::Navigation navigation =
            aphotic::parse_navigation_ifdo("set.yaml", text, aphotic::Sled{.altitude_m = 2.0});
        try {
            static_cast<void>(navigation.pose_of("a.tif"));
        } catch (const aphotic::InputError&) {
            // Of one image, whose name its caller puts before it.
        }
    });
    return 0;
}
