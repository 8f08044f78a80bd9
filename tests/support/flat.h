// SPDX-License-Identifier: BSD-3-Clause
//
// A spectrum without colour.
#pragma once

#include "spectral/spectrum.h"

namespace aphotic {

inline Spectrum flat(double value) {
    return {"flat", {300.0, 1100.0}, {value, value}};
}

}  // namespace aphotic
