// SPDX-License-Identifier: BSD-3-Clause
//
// The format in which POV-Ray writes frames, and its precision for a sample s:
//
//   exr     half floats        s within 2^-11 of itself, from 2^-14 to 65504
//   png16   16-bit integers    s within 2^-17, from 0 to 1; within 2^-11 of itself from 2^-6 on
//
// A frame has full precision from 2^held_log2. png16 is for a POV-Ray built without OpenEXR: it
// clips, and dark corners have fewer digits.
#pragma once

#include "image/frame_check.h"

#include <array>
#include <string_view>

namespace aphotic {

enum class FrameFormat { Exr, Png16 };
inline constexpr std::array<std::string_view, 2> kFrameFormatNames{"exr", "png16"};

[[nodiscard]] constexpr int held_log2(FrameFormat format) {
    constexpr int kPng16Log2 = -6;
    return format == FrameFormat::Exr ? kSmallestNormalHalfLog2 : kPng16Log2;
}

}  // namespace aphotic
