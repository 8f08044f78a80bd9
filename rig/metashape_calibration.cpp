// SPDX-License-Identifier: BSD-3-Clause
#include "rig/metashape_calibration.h"

#include <fmt/format.h>

namespace aphotic {

CameraCalibration read_metashape_calibration(const CalibrationKeys& keys) {
    const auto or_zero = [&](std::string_view key) { return keys.number_or(key, 0.0); };
    for (const std::string_view key : {"p3", "p4"}) {
        if (or_zero(key) != 0.0) keys.fail(key, fmt::format("found {}; allowed: 0", or_zero(key)));
    }
    CameraCalibration made{.width_px = keys.size("width"), .height_px = keys.size("height")};
    LensModel& lens = made.lens;
    lens.is_fisheye = keys.word("projection", {"frame", "fisheye"}) == "fisheye";
    const double f = keys.number("f");
    lens.focal_px = {f + or_zero("b1"), f};
    lens.centre_px = {0.5 * made.width_px + or_zero("cx"), 0.5 * made.height_px + or_zero("cy")};
    lens.skew_px = or_zero("b2");
    lens.radial = {or_zero("k1"), or_zero("k2"), or_zero("k3"), or_zero("k4")};
    lens.tangential = {or_zero("p2"), or_zero("p1")};
    return made;
}

}  // namespace aphotic
