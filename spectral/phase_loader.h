// SPDX-License-Identifier: BSD-3-Clause
//
// Phase functions by name or from a file:
//
//   angle_deg,phase_function_per_sr        0 to 180, increasing; 0 or more, of any scale
//
// The built-in ones are 'petzold' (the average particle), 'petzold-clear', 'petzold-coast' and
// 'petzold-harbour', which include the water's scattering, and 'sea-water', a formula.
#pragma once

#include "spectral/curve_loader.h"
#include "spectral/phase_function.h"

#include <span>
#include <string>
#include <vector>

namespace aphotic {

[[nodiscard]] std::span<const BuiltinTable> builtin_phase_tables();
[[nodiscard]] std::vector<std::string> builtin_phase_names();

// Throws InputError for an unknown name, and with the line for an invalid table.
[[nodiscard]] PhaseFunction builtin_phase(const std::string& name);
[[nodiscard]] PhaseFunction phase_of(const Table& table);

}  // namespace aphotic
