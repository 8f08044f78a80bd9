// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/beam_sdl.h"

#include "base/degrees.h"
#include "scene_gen/sdl.h"

#include <fmt/format.h>

namespace aphotic {

std::size_t light_count(const Beam& beam) {
    return beam.cones.size();
}

std::string beam_sdl(const Beam& beam) {
    std::string sdl = fmt::format("array[{}][2] {{\n", beam.cones.size());
    const std::vector<Beam> parts = parts_of(beam);
    for (std::size_t k = 0; k < parts.size(); ++k) {
        sdl += fmt::format("      {{{}, {}}}{}   // {}\n",
                           sdl_number(beam.cones[k].half_angle_rad * kDegreesPerRadian),
                           sdl_number(flux_of(parts[k])),
                           k + 1 == parts.size() ? "" : ",",
                           sdl_comment(beam.cones[k].part));
    }
    return sdl + "   }";
}

}  // namespace aphotic
