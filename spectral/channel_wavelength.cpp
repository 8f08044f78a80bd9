// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/channel_wavelength.h"

#include "base/number.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

constexpr std::array<std::pair<std::string_view, int>, 17> kPrefixes{{{"", 0},
                                                                      {"Y", 24},
                                                                      {"Z", 21},
                                                                      {"E", 18},
                                                                      {"P", 15},
                                                                      {"T", 12},
                                                                      {"G", 9},
                                                                      {"M", 6},
                                                                      {"k", 3},
                                                                      {"h", 2},
                                                                      {"da", 1},
                                                                      {"d", -1},
                                                                      {"c", -2},
                                                                      {"m", -3},
                                                                      {"u", -6},
                                                                      {"n", -9},
                                                                      {"p", -12}}};

std::optional<double> wavelength_nm(std::string_view part) {
    constexpr double kLight_nm_per_s = 299'792'458e9;
    constexpr double kNanometresPerMetre = 1e9;
    const bool is_frequency = part.ends_with("Hz");
    if (!is_frequency && !part.ends_with('m')) return std::nullopt;
    part.remove_suffix(is_frequency ? 2 : 1);
    std::string text(part);
    std::ranges::replace(text, ',', '.');
    if (text.empty() || text.find_first_of("0123456789.") != 0) return std::nullopt;
    std::string_view prefix(text);
    const auto number = read_leading_number<double>(prefix);
    if (!number || *number == 0.0) return std::nullopt;
    const auto found =
        std::ranges::find(kPrefixes, prefix, &std::pair<std::string_view, int>::first);
    if (found == kPrefixes.end()) return std::nullopt;
    const double value = *number * std::pow(10.0, found->second);
    return is_frequency ? kLight_nm_per_s / value : kNanometresPerMetre * value;
}

struct SpectralName {
    std::string_view quantity;
    std::vector<double> lambda_nm{};  // in reverse order
};

SpectralName spectral_name(std::string_view name) {
    SpectralName read{.quantity = name};
    for (;;) {
        const std::size_t point = read.quantity.rfind('.');
        if (point == std::string_view::npos) return read;
        const auto nm = wavelength_nm(read.quantity.substr(point + 1));
        if (!nm) return read;
        read.lambda_nm.push_back(*nm);
        read.quantity = read.quantity.substr(0, point);
    }
}

}  // namespace

bool is_same_spectral_channel(std::string_view a, std::string_view b) {
    const SpectralName one = spectral_name(a);
    const SpectralName other = spectral_name(b);
    const auto is_near = [](double x_nm, double y_nm) {
        return std::abs(x_nm - y_nm) <= kSameWavelength_nm;
    };
    return !one.lambda_nm.empty() && one.quantity == other.quantity &&
           std::ranges::equal(one.lambda_nm, other.lambda_nm, is_near);
}

}  // namespace aphotic
