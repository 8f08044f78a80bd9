// SPDX-License-Identifier: BSD-3-Clause
//
// Where the labels of a plot's points go: beside their point, covering neither each other nor
// anything else that is drawn. The nearest such place is taken; where there is none, the one that
// covers least. Which label comes first is the caller's choice: it has the better place.
#pragma once

#include "report/svg.h"

#include <span>
#include <vector>

namespace aphotic {

struct LabelBox {
    double left = 0.0;
    double top = 0.0;
    double right = 0.0;
    double bottom = 0.0;
};

// The area that both cover; 0 when they are apart.
[[nodiscard]] double overlap(const LabelBox& a, const LabelBox& b);

struct LabelPlace {
    double x_px = 0.0;  // of the text's anchor
    double y_px = 0.0;  // of the text's middle
    SvgAnchor anchor = SvgAnchor::Start;
    bool is_far = false;  // a line should lead to it
    LabelBox box{};
};

// A text of that width beside the point, no closer than `clearance`, within `bounds` and off what
// is taken.
[[nodiscard]] LabelPlace place_label(double x_px,
                                     double y_px,
                                     double width,
                                     double clearance,
                                     std::span<const LabelBox> taken,
                                     const LabelBox& bounds);

// What is kept free for a label.
inline constexpr double kLabelFont_px = 11.0;
inline constexpr double kLabelHeight = 12.0;

}  // namespace aphotic
