// SPDX-License-Identifier: BSD-3-Clause
//
// Refractive indices of seawater and of port materials, all relative to air.
//
// Seawater:
//   n(S, T, l) = n0 + (n1 + n2 T + n3 T^2) S + n4 T^2 + (n5 + n6 S + n7 T) / l
//              + n8 / l^2 + n9 / l^3
//   S  salinity [psu]    T  temperature [C]    l  wavelength [nm]    n0..n9 'quan-fry-1995'
//   Fitted to 400-700 nm, 0-35 psu, 0-30 C at atmospheric pressure, to about 1.5e-5.
//   Used here for 200-1100 nm, where Huibers found it to hold for water, 0-40 psu (n is
//   linear in S) and -2-35 C, the range found in the sea. Outside: InputError.
//   X. Quan and E. S. Fry, Applied Optics 34(18), 3477-3480 (1995).
//   P. D. T. Huibers, Applied Optics 36(16), 3785-3787 (1997).
//
// Glass, x wavelength [um], in the range that the glass's table states. Outside: InputError.
//   sellmeier   n^2 = 1 + sum of p_i x^2 / (x^2 - q_i)     q [um^2]
//   poly        n^2 = sum of p_i x^q_i
//   Sources: in the tables, `aphotic data NAME`.
#pragma once

#include "spectral/spectrum.h"
#include "spectral/table.h"

#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

inline constexpr WavelengthRange kSeawaterIndexRange{200.0, 1100.0};

[[nodiscard]] double seawater_index(double lambda_nm, double salinity_psu, double temperature_c);

class Glass {
  public:
    // Columns term, p, q; comments "# form: sellmeier" or "poly" and "# range: A to B nm".
    explicit Glass(const Table& table);

    [[nodiscard]] double index(double lambda_nm) const;
    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] WavelengthRange range() const { return range_; }

  private:
    enum class Form { Sellmeier, Polynomial };
    struct Term {
        double p;
        double q;
    };

    std::string name_;
    Form form_ = Form::Sellmeier;
    std::vector<Term> terms_;
    WavelengthRange range_;
};

// bk7, fused-silica, sapphire, pmma, polycarbonate.
[[nodiscard]] Glass builtin_glass(std::string_view name);

// The range that a built-in table states in "# range: A to B nm".
[[nodiscard]] WavelengthRange stated_range(const Table& table);

}  // namespace aphotic
