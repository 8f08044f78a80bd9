// SPDX-License-Identifier: BSD-3-Clause
//
// A tabulated curve over wavelength, linear between its knots and undefined outside them.
//
//   f(lambda) = f_i + (f_{i+1} - f_i) (lambda - lambda_i) / (lambda_{i+1} - lambda_i)
//
// lambda  wavelength [nm], lambda_i strictly increasing
// f       any quantity, in the unit that the curve's owner defines
//
// f(lambda_i) = f_i exactly. Nothing is extrapolated: a wavelength outside [first_nm, last_nm] is
// an InputError that names the curve.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

// A closed interval of wavelengths.
struct WavelengthRange {
    double first_nm = 0.0;
    double last_nm = 0.0;

    [[nodiscard]] bool contains(double lambda_nm) const {
        return first_nm <= lambda_nm && lambda_nm <= last_nm;
    }
};

// The table that a curve came from.
struct CurveSource {
    std::string table;          // a built-in table's name, or a file's path
    std::string file_sha256{};  // empty: built in

    [[nodiscard]] bool is_file() const { return !file_sha256.empty(); }
};

class Spectrum {
  public:
    // name identifies the curve in messages, such as "water absorption 'pope-fry-1997'". source:
    // empty for a computed curve. Throws InputError unless there are at least two knots, all finite
    // and increasing.
    Spectrum(std::string name,
             std::vector<double> lambda_nm,
             std::vector<double> values,
             std::optional<CurveSource> source = {});

    [[nodiscard]] double at(double lambda_nm) const;

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const std::optional<CurveSource>& source() const { return source_; }
    // The name that the user knows: the built-in table's, or the file's without its folder; for a
    // computed curve, its own.
    [[nodiscard]] std::string short_name() const;
    [[nodiscard]] WavelengthRange range() const;
    [[nodiscard]] std::span<const double> lambda_nm() const { return lambda_nm_; }
    [[nodiscard]] std::span<const double> values() const { return values_; }

  private:
    std::string name_;
    std::vector<double> lambda_nm_;
    std::vector<double> values_;
    std::optional<CurveSource> source_;
};

// The same knots and values, ignoring names.
[[nodiscard]] bool is_same_curve(const Spectrum& a, const Spectrum& b);

// Their product.
[[nodiscard]] double product_at(std::span<const Spectrum> curves, double lambda_nm);

// The range that all curves cover; first_nm > last_nm if there is none.
[[nodiscard]] WavelengthRange common_range(std::span<const Spectrum* const> curves);

// Throws InputError unless every curve covers range. The message names each curve that does not,
// the missing part, and a range_nm that works.
void require_cover(std::span<const Spectrum* const> curves, WavelengthRange range);

// The wavelengths at which any of the curves bends, plus the ends of range, sorted, without
// duplicates: between neighbours every curve is a straight line.
[[nodiscard]] std::vector<double> union_of_knots(std::span<const Spectrum* const> curves,
                                                 WavelengthRange range);

}  // namespace aphotic
