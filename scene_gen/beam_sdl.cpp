// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/beam_sdl.h"

#include "base/degrees.h"
#include "scene_gen/sdl.h"

#include <fmt/format.h>

#include <algorithm>

namespace aphotic {

std::size_t light_count(const Beam& beam) {
    return beam.cones.size();
}

std::string beam_sdl(const Beam& beam) {
    const std::vector<Beam> parts = parts_of(beam);
    const bool has_exponents =
        std::ranges::any_of(beam.cones, [](const Cone& cone) { return cone.exponent != 1.0; });
    std::string sdl = fmt::format("array[{}][{}] {{\n", parts.size(), has_exponents ? 3 : 2);
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const Cone& cone = beam.cones[k];
        sdl += fmt::format("      {{{}, {}{}}}{}   // {}\n",
                           sdl_number(cone.half_angle_rad * kDegreesPerRadian),
                           sdl_number(flux_of(parts[k])),
                           has_exponents ? ", " + sdl_number(cone.exponent) : "",
                           k + 1 == parts.size() ? "" : ",",
                           sdl_comment(cone.part));
    }
    return sdl + "   }";
}

}  // namespace aphotic
