// SPDX-License-Identifier: BSD-3-Clause
//
// The format in which POV-Ray writes frames, and what it holds of a sample s:
//
//   exr     half floats        s within 2^-11 of itself, from 2^-14 to 65504
//   png16   16-bit integers    s within 2^-17 of 1, from 0 to 1: of itself within 2^-11 from 2^-6
//   on
//
// A frame's digits begin at 2^held_log2. png16 is for a POV-Ray that was built without OpenEXR: it
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
