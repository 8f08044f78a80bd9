// SPDX-License-Identifier: BSD-3-Clause
//
// A navigation file from any text, and the pose of an image that may be in it.
#include "fuzz.h"
#include "survey/navigation_csv.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    aphotic::expect_result_or_placed_error("survey.csv", [&] {
        const aphotic::Navigation navigation = aphotic::parse_navigation_csv(
            "survey.csv", aphotic::text_of(data, size), aphotic::Sled{.altitude_m = 2.0});
        try {
            static_cast<void>(navigation.pose_of("201207.0001.tif"));
        } catch (const aphotic::InputError&) {
            // Of one image, whose name its caller puts before it.
        }
    });
    return 0;
}
