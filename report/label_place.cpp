// SPDX-License-Identifier: BSD-3-Clause
#include "report/label_place.h"

#include <algorithm>
#include <array>
#include <limits>

namespace aphotic {
namespace {

struct Direction {
    double x = 0.0;
    double y = 0.0;
    SvgAnchor anchor = SvgAnchor::Start;
};

// In the order of liking. Above and below are a little farther: a text is higher than its anchor.
constexpr std::array<Direction, 8> kDirections{{{1.0, 0.0, SvgAnchor::Start},
                                                {-1.0, 0.0, SvgAnchor::End},
                                                {0.0, -1.3, SvgAnchor::Middle},
                                                {0.0, 1.3, SvgAnchor::Middle},
                                                {0.8, -0.9, SvgAnchor::Start},
                                                {0.8, 0.9, SvgAnchor::Start},
                                                {-0.8, -0.9, SvgAnchor::End},
                                                {-0.8, 0.9, SvgAnchor::End}}};
// Times the clearance.
constexpr std::array<double, 7> kDistances{1.0, 1.6, 2.4, 3.4, 4.6, 6.0, 7.6};
constexpr double kFar = 1.7;

LabelBox box_of(const LabelPlace& place, double width) {
    const double left = place.anchor == SvgAnchor::Start    ? place.x_px
                        : place.anchor == SvgAnchor::Middle ? place.x_px - width / 2.0
                                                            : place.x_px - width;
    return {.left = left,
            .top = place.y_px - kLabelHeight / 2.0,
            .right = left + width,
            .bottom = place.y_px + kLabelHeight / 2.0};
}

bool is_within(const LabelBox& box, const LabelBox& bounds) {
    return box.left >= bounds.left && box.right <= bounds.right && box.top >= bounds.top &&
           box.bottom <= bounds.bottom;
}

}  // namespace

double overlap(const LabelBox& a, const LabelBox& b) {
    const double width = std::min(a.right, b.right) - std::max(a.left, b.left);
    const double height = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
    return width > 0.0 && height > 0.0 ? width * height : 0.0;
}

LabelPlace place_label(double x_px,
                       double y_px,
                       double width,
                       double clearance,
                       std::span<const LabelBox> taken,
                       const LabelBox& bounds) {
    LabelPlace best;
    double least = std::numeric_limits<double>::infinity();
    for (const double distance : kDistances) {
        for (const Direction& direction : kDirections) {
            LabelPlace place{.x_px = x_px + distance * clearance * direction.x,
                             .y_px = y_px + distance * clearance * direction.y,
                             .anchor = direction.anchor,
                             .is_far = distance > kFar};
            place.box = box_of(place, width);
            // What is cut off is worse than what is covered.
            double covered = is_within(place.box, bounds) ? 0.0 : 1e6;
            for (const LabelBox& box : taken) covered += overlap(place.box, box);
            if (covered < least) {
                least = covered;
                best = place;
            }
        }
    }
    return best;
}

}  // namespace aphotic
