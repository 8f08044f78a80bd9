// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/refractive_index.h"

#include "base/error.h"
#include "base/number.h"
#include "spectral/curve_loader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace aphotic {
namespace {

constexpr double kNmPerUm = 1000.0;
constexpr std::size_t kQuanFryTerms = 10;

void require_between(
    std::string_view what, double found, double least, double most, std::string_view unit) {
    if (least <= found && found <= most) return;
    throw InputError("refractive index of seawater: {} found {} {}; allowed: {} to {}",
                     what,
                     found,
                     unit,
                     least,
                     most);
}

std::array<double, kQuanFryTerms> read_quan_fry() {
    const Table table = builtin_table("quan-fry-1995");
    std::array<double, kQuanFryTerms> n{};
    for (std::size_t i = 0; i < n.size(); ++i) n[i] = table.rows.at(i).fields.at(1);
    return n;
}

// Reads the number at the front of text and advances text past it.
double take_number(std::string_view& text) {
    return read_leading_number<double>(text).value_or(std::nan(""));
}

}  // namespace

double seawater_index(double lambda_nm, double salinity_psu, double temperature_c) {
    require_between(
        "wavelength", lambda_nm, kSeawaterIndexRange.first_nm, kSeawaterIndexRange.last_nm, "nm");
    require_between("salinity", salinity_psu, 0.0, 40.0, "psu");
    require_between("temperature", temperature_c, -2.0, 35.0, "C");
    static const auto kCoefficients = read_quan_fry();
    const auto& n = kCoefficients;
    const double s = salinity_psu;
    const double t = temperature_c;
    const double l = lambda_nm;
    return n[0] + (n[1] + n[2] * t + n[3] * t * t) * s + n[4] * t * t +
           (n[5] + n[6] * s + n[7] * t) / l + n[8] / (l * l) + n[9] / (l * l * l);
}

Glass::Glass(const Table& table)
    : name_(table.name),
      form_(table.text_of("form") == "poly" ? Form::Polynomial : Form::Sellmeier),
      range_(stated_range(table)) {
    for (const TableRow& row : table.rows) terms_.push_back({row.fields.at(1), row.fields.at(2)});
}

double Glass::index(double lambda_nm) const {
    if (!range_.contains(lambda_nm)) {
        throw InputError("refractive index of '{}' covers {} to {} nm and has no value at {} nm",
                         name_,
                         range_.first_nm,
                         range_.last_nm,
                         lambda_nm);
    }
    const double x = lambda_nm / kNmPerUm;
    double n2 = form_ == Form::Sellmeier ? 1.0 : 0.0;
    for (const Term& term : terms_) {
        n2 += form_ == Form::Sellmeier ? term.p * x * x / (x * x - term.q)
                                       : term.p * std::pow(x, term.q);
    }
    return std::sqrt(n2);
}

Glass builtin_glass(std::string_view name) {
    const std::vector<std::string> names = builtin_names("glass");
    if (std::find(names.begin(), names.end(), name) == names.end()) {
        throw InputError(
            "no built-in glass is named '{}'; allowed: {}", name, fmt::join(names, ", "));
    }
    return Glass(builtin_table(name));
}

WavelengthRange stated_range(const Table& table) {
    constexpr std::string_view kBetween = " to ";
    const std::string stated = table.text_of("range");
    std::string_view text = stated;
    WavelengthRange range;
    range.first_nm = take_number(text);
    const bool has_between = text.starts_with(kBetween);
    if (has_between) text.remove_prefix(kBetween.size());
    range.last_nm = take_number(text);
    if (!has_between || text != " nm" || !(range.first_nm < range.last_nm)) {
        throw InputError(
            "{}: found '# range: {}'; allowed: '# range: A to B nm'", table.name, stated);
    }
    return range;
}

}  // namespace aphotic
