// SPDX-License-Identifier: BSD-3-Clause
//
// The tags of an image from any description: a pose, or its fault on one line.
#include "fuzz.h"
#include "survey/navigation/navigation_file.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    aphotic::ImagePose pose;
    aphotic::read_tags(pose,
                       aphotic::text_of(data, size),
                       aphotic::tag_names({{"altitude_m", "alt1"}}),
                       aphotic::AngleUnit::Degrees);
    if (pose.fault.find('\n') != std::string::npos) std::abort();
    return 0;
}
