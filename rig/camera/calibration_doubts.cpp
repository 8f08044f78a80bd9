// SPDX-License-Identifier: BSD-3-Clause
#include "rig/camera/calibration_doubts.h"

#include "base/degrees.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aphotic {
namespace {

using Eigen::Vector2d;

std::string doubt_of_centre(const LensModel& lens, const Vector2d& size_px) {
    constexpr double kUsualShare = 0.2;
    const Vector2d middle_px = 0.5 * size_px;
    const Vector2d off = (lens.centre_px - middle_px).cwiseAbs().cwiseQuotient(size_px);
    if (off.maxCoeff() <= kUsualShare) return "";
    // 0, or 0.5 if a tool's first pixel is at 0, or a fraction of the image.
    const bool is_in_corner = lens.centre_px.cwiseAbs().maxCoeff() <= 1.5;
    return fmt::format(
        "principal point: found {:g}, {:g} in an image of {:g} x {:g}; usual: near the middle, "
        "{:g}, {:g}{}",
        lens.centre_px.x(),
        lens.centre_px.y(),
        size_px.x(),
        size_px.y(),
        middle_px.x(),
        middle_px.y(),
        is_in_corner ? "; is it relative to the middle, a fraction of the image's size, or missing?"
                     : "; are the calibration and the images of the same size?");
}

std::string doubt_of_aspect(const LensModel& lens) {
    constexpr double kMostRatio = 2.0;
    const double ratio = lens.focal_px.x() / lens.focal_px.y();
    if (std::max(ratio, 1.0 / ratio) <= kMostRatio) return "";
    return fmt::format(
        "focal lengths: found {:g} and {:g} pixels; usual: equal within a few per cent",
        lens.focal_px.x(),
        lens.focal_px.y());
}

std::string doubt_of_field(const LensModel& lens, double width_px) {
    constexpr double kLeast_deg = 2.0;
    constexpr double kMost_deg = 150.0;
    constexpr double kMostOfFisheye_deg = 200.0;
    const double across = width_px / lens.focal_px.x();
    const double field_deg =
        (lens.is_fisheye ? across : 2.0 * std::atan(0.5 * across)) * kDegreesPerRadian;
    const double most_deg = lens.is_fisheye ? kMostOfFisheye_deg : kMost_deg;
    if (field_deg >= kLeast_deg && field_deg <= most_deg) return "";
    return fmt::format(
        "focal length: found {:g} pixels, a field of view of {:.3g} degrees across {:g} pixels; "
        "usual: {:g} to {:g} degrees; is it in millimetres?",
        lens.focal_px.x(),
        field_deg,
        width_px,
        kLeast_deg,
        most_deg);
}

}  // namespace

std::vector<std::string> calibration_doubts(const LensModel& lens, int width_px, int height_px) {
    std::vector<std::string> doubts{doubt_of_centre(lens, Vector2d(width_px, height_px)),
                                    doubt_of_aspect(lens),
                                    doubt_of_field(lens, width_px)};
    std::erase(doubts, "");
    return doubts;
}

}  // namespace aphotic
