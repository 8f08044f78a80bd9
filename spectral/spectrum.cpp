// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/spectrum.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <utility>

namespace aphotic {
namespace {

bool all_finite(const std::vector<double>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

// The parts of range outside covered: "380 to 400 nm and 720 to 780 nm".
std::string gap_text(WavelengthRange covered, WavelengthRange range) {
    if (covered.last_nm < range.first_nm || covered.first_nm > range.last_nm) return "all";
    std::string text;
    if (covered.first_nm > range.first_nm) {
        text = fmt::format("{} to {} nm", range.first_nm, covered.first_nm);
    }
    if (covered.last_nm < range.last_nm) {
        if (!text.empty()) text += " and ";
        text += fmt::format("{} to {} nm", covered.last_nm, range.last_nm);
    }
    return text;
}

// A suggestion for the rig: the covered part of range, or else the whole covered range.
std::string remedy_text(WavelengthRange common, WavelengthRange range) {
    if (!(common.first_nm < common.last_nm)) {
        return "no range_nm works, since these curves have no wavelengths in common";
    }
    WavelengthRange both{std::max(common.first_nm, range.first_nm),
                         std::min(common.last_nm, range.last_nm)};
    if (!(both.first_nm < both.last_nm)) both = common;
    return fmt::format("range_nm = [{}, {}] works", both.first_nm, both.last_nm);
}

}  // namespace

Spectrum::Spectrum(std::string name,
                   std::vector<double> lambda_nm,
                   std::vector<double> values,
                   std::optional<CurveSource> source)
    : name_(std::move(name)),
      lambda_nm_(std::move(lambda_nm)),
      values_(std::move(values)),
      source_(std::move(source)) {
    if (lambda_nm_.size() != values_.size()) {
        throw InputError(
            "{}: {} wavelengths but {} values", name_, lambda_nm_.size(), values_.size());
    }
    if (lambda_nm_.size() < 2) {
        throw InputError("{}: found {} knots; a curve needs 2 or more", name_, lambda_nm_.size());
    }
    if (!all_finite(lambda_nm_) || !all_finite(values_)) {
        throw InputError("{}: found a number that is not finite", name_);
    }
    const auto fall =
        std::adjacent_find(lambda_nm_.begin(), lambda_nm_.end(), std::greater_equal<>());
    if (fall != lambda_nm_.end()) {
        throw InputError(
            "{}: wavelength {} nm follows {} nm; allowed: increasing", name_, fall[1], fall[0]);
    }
}

double Spectrum::at(double lambda_nm) const {
    if (!range().contains(lambda_nm)) {
        throw InputError("{} covers {} to {} nm and has no value at {} nm",
                         name_,
                         range().first_nm,
                         range().last_nm,
                         lambda_nm);
    }
    // The last knot belongs to the last interval.
    const auto above = std::upper_bound(lambda_nm_.begin(), lambda_nm_.end() - 1, lambda_nm);
    const auto i = static_cast<std::size_t>(above - lambda_nm_.begin());
    const double t = (lambda_nm - lambda_nm_[i - 1]) / (lambda_nm_[i] - lambda_nm_[i - 1]);
    return std::lerp(values_[i - 1], values_[i], t);
}

std::string Spectrum::short_name() const {
    return source_ ? std::filesystem::path(source_->table).filename().string() : name_;
}

WavelengthRange Spectrum::range() const {
    return {lambda_nm_.front(), lambda_nm_.back()};
}

double product_at(std::span<const Spectrum> curves, double lambda_nm) {
    double value = 1.0;
    for (const Spectrum& curve : curves) value *= curve.at(lambda_nm);
    return value;
}

WavelengthRange common_range(std::span<const Spectrum* const> curves) {
    // Without curves nothing is bounded.
    WavelengthRange common{-std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::infinity()};
    for (const Spectrum* curve : curves) {
        common.first_nm = std::max(common.first_nm, curve->range().first_nm);
        common.last_nm = std::min(common.last_nm, curve->range().last_nm);
    }
    return common;
}

void require_cover(std::span<const Spectrum* const> curves, WavelengthRange range) {
    if (!(range.first_nm <= range.last_nm)) {
        throw InputError("the range {} to {} nm is empty; allowed: first below last",
                         range.first_nm,
                         range.last_nm);
    }
    std::string faults;
    for (const Spectrum* curve : curves) {
        const WavelengthRange covered = curve->range();
        if (covered.contains(range.first_nm) && covered.contains(range.last_nm)) continue;
        const std::string fault = fmt::format(
            "{} covers {} to {} nm, which leaves {} of the range {} to {} nm without a value; ",
            curve->name(),
            covered.first_nm,
            covered.last_nm,
            gap_text(covered, range),
            range.first_nm,
            range.last_nm);
        // Strobes may share a lamp, which is reported once.
        if (faults.find(fault) == std::string::npos) faults += fault;
    }
    if (!faults.empty()) throw InputError(faults + remedy_text(common_range(curves), range));
}

std::vector<double> union_of_knots(std::span<const Spectrum* const> curves, WavelengthRange range) {
    std::vector<double> knots{range.first_nm, range.last_nm};
    for (const Spectrum* curve : curves) {
        for (const double lambda_nm : curve->lambda_nm()) {
            if (range.contains(lambda_nm)) knots.push_back(lambda_nm);
        }
    }
    std::sort(knots.begin(), knots.end());
    knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
    return knots;
}

bool is_same_curve(const Spectrum& a, const Spectrum& b) {
    return std::ranges::equal(a.lambda_nm(), b.lambda_nm()) &&
           std::ranges::equal(a.values(), b.values());
}

}  // namespace aphotic
