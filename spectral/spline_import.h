// SPDX-License-Identifier: BSD-3-Clause
//
// Spectra that POV-Ray users share in its scene language: splines over wavelength, as for Lightsys,
// and the arrays of SpectralRender, whose 36 values are at 380, 390, ... 730 nm.
//
//   #declare RS_Clay = spline { linear_spline  380, 0.021  400, <0.03, 0.03, 0.03>  730, 8.4/100 }
//   #declare D_Clay  = array[36] { 0.021, 0.024, ... }
//
// Parsed as by POV-Ray 3.7: comments nest, most commas may be missing, a number may be a sum,
// difference, product or quotient of numbers (so "400 -0.5" is 399.5), knots are sorted. POV-Ray
// lets a second knot at one wavelength replace the first; we refuse it. No directive is executed:
// the contents of an #if count whatever its condition, and a spectrum filled by a loop or a macro
// is refused.
//
// Our tables are straight lines between knots, and so is POV-Ray's linear_spline (its default), up
// to its last knots, outside which POV-Ray holds it constant and we have no value. Of a
// cubic_spline, natural_spline or quadratic_spline only the knots are used. POV-Ray's curves pass
// through them too, except that the first and last knot of a cubic_spline are only its tangents.
//
// Every error is an InputError "file:line: what was found; allowed: ...".
#pragma once

#include "spectral/spectrum.h"
#include "spectral/table.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// Wide enough for any camera, and too narrow for micrometres, angstroms and wave numbers.
inline constexpr WavelengthRange kSplineRange{200.0, 2500.0};

struct SplineKnot {
    std::size_t line = 0;  // in the file, from 1
    double lambda_nm = 0.0;
    double value = 0.0;
};

struct SplineSpectrum {
    std::string identifier;
    std::size_t line = 0;
    std::string form;               // linear_spline and so on, or array[36]
    std::vector<SplineKnot> knots;  // two or more, wavelengths increasing

    [[nodiscard]] bool is_linear() const { return form == "linear_spline" || form == "array[36]"; }
};

struct SplineFile {
    std::vector<SplineSpectrum> spectra;       // one or more, in the file's order
    std::vector<std::size_t> anonymous_lines;  // of splines without a name, which are skipped
};

// only: a shell pattern such as D_CC_*; spectra whose identifier does not match are skipped.
// file_name is for messages.
[[nodiscard]] SplineFile parse_splines(const std::string& file_name,
                                       std::string_view text,
                                       const std::string& only = "*");

// D_Macbeth_01 becomes d-macbeth-01.csv.
[[nodiscard]] std::string spline_table_name(const std::string& identifier);

// The spectrum as a CSV file's text. The role is Reflectance or LampSpectrum, in relative power.
[[nodiscard]] std::string spline_table(const std::string& file_name,
                                       const SplineSpectrum& spectrum,
                                       CurveRole role);

}  // namespace aphotic
