// SPDX-License-Identifier: BSD-3-Clause
//
// Small rigs for designs: clear water, a mirror's symmetry fore and aft, beams that fall as a power
// of the cosine.
#pragma once

#include "rig/file/rig_text.h"
#include "rig/rig.h"

#include <fmt/format.h>

#include <string>

namespace aphotic {

inline std::string design_rig_text(const std::string& strobes, double exponent = 1.0) {
    return fmt::format(R"(title = "é"  # not ASCII
[sled]
altitude_m = 2.0
[camera]
resolution = [32, 24]
pixel_pitch_um = 274.0
focal_length_mm = 12.0
range_nm = [400, 700]
response = "nikon-d5100"
[water]
multiple = 0.0
[seafloor]
[beam.round]
cones = [{{ part = "all", half_angle_deg = 90.0, weight = 1.0, exponent = {} }}]
{})",
                       exponent,
                       strobes);
}

inline std::string design_strobe(const std::string& name,
                                 const std::string& position_m,
                                 const std::string& more) {
    return fmt::format(
        "[[strobe]]\nname = \"{}\"\nposition_m = {}  # where {} is\nbeam = "
        "\"round\"\n{}\n",
        name,
        position_m,
        name,
        more);
}

// Two strobes that look down, one nearer than the other.
inline std::string two_strobes(const std::string& aim = "direction = [0, 0, 1]") {
    return design_strobe("fore", "[0.3, 0.0, 0.0]", aim) +
           design_strobe("aft", "[-0.6, 0.0, 0.0]", aim);
}

inline RigText text_of(const Rig& rig) {
    return {rig.toml, "rig.toml", {}};
}

inline Rig design_rig(const std::string& strobes, double exponent = 1.0) {
    return RigText(design_rig_text(strobes, exponent), "rig.toml", {}).rig();
}

}  // namespace aphotic
