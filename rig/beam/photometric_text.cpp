// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/photometric_text.h"

#include "base/csv.h"
#include "base/degrees.h"
#include "base/error.h"
#include "base/number.h"
#include "base/printable.h"

#include <fmt/format.h>
#include <boost/locale/utf.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace aphotic {

namespace {

using Utf8 = boost::locale::utf::utf_traits<char>;

bool is_utf8(std::string_view text) {
    for (auto at = text.begin(); at != text.end();) {
        if (!boost::locale::utf::is_valid_codepoint(Utf8::decode(at, text.end()))) return false;
    }
    return true;
}

double turned_into_circle(double deg) {
    const double within = std::fmod(deg, 360.0);
    return within < 0.0 ? within + 360.0 : within;
}

void sort_by_angle(std::vector<TurnPlane>& planes) {
    std::ranges::sort(planes, {}, &TurnPlane::at_deg);
}

}  // namespace

std::string utf8_of(std::string_view text) {
    text = without_byte_order_mark(text);
    if (is_utf8(text)) return std::string(text);
    std::string result;
    for (const char c : text)
        Utf8::encode(static_cast<unsigned char>(c), std::back_inserter(result));
    return result;
}

std::string shown_word(std::string_view word) {
    return fmt::format("'{}'", excerpt(word));
}

FileNumber number_of(const std::string& file,
                     std::size_t line,
                     std::string_view word,
                     std::string_view what) {
    const std::optional<double> value = finite_number(word);
    if (!value) {
        fail_at_line(file,
                     line,
                     fmt::format("{}: found {}; allowed: a finite number", what, shown_word(word)));
    }
    return {.value = *value, .line = line};
}

void fail_number(const std::string& file,
                 const FileNumber& number,
                 std::string_view what,
                 std::string_view allowed) {
    fail_at_line(
        file, number.line, fmt::format("{}: found {}; allowed: {}", what, number.value, allowed));
}

std::size_t count_of(const std::string& file,
                     const FileNumber& number,
                     std::string_view what,
                     std::size_t least,
                     std::size_t most) {
    const double value = number.value;
    const bool is_count = value >= static_cast<double>(least) &&
                          value <= static_cast<double>(most) && value == std::floor(value);
    if (!is_count) {
        fail_number(file, number, what, fmt::format("a whole number from {} to {}", least, most));
    }
    return static_cast<std::size_t>(value);
}

double above_zero(const std::string& file, const FileNumber& number, std::string_view what) {
    if (!(number.value > 0.0)) fail_number(file, number, what, "above 0");
    return number.value;
}

double intensity_of(const std::string& file,
                    const FileNumber& number,
                    std::string_view what,
                    double factor) {
    if (number.value < 0.0) fail_number(file, number, what, "0 or more");
    const double intensity = number.value * factor;
    if (!std::isfinite(intensity)) {
        fail_number(file,
                    number,
                    what,
                    fmt::format("up to {:.3g}, since the file's factors multiply it by {:.3g}",
                                std::numeric_limits<double>::max() / factor,
                                factor));
    }
    return intensity;
}

double product_of_factors(const std::string& file, const FileNumber& last, double others) {
    const double product = others * last.value;
    if (!std::isnormal(product)) {
        fail_number(
            file,
            last,
            "a factor of all intensities",
            fmt::format("one whose product with the others, {:.3g}, is from {:.3g} to {:.3g}",
                        others,
                        std::numeric_limits<double>::min(),
                        std::numeric_limits<double>::max()));
    }
    return product;
}

void check_angles(const std::string& file,
                  const std::vector<FileNumber>& angles_deg,
                  std::string_view what,
                  double least_deg,
                  double most_deg) {
    double next_deg = least_deg;
    for (const FileNumber& angle : angles_deg) {
        if (angle.value < least_deg || angle.value > most_deg) {
            fail_number(file, angle, what, fmt::format("{} to {} degrees", least_deg, most_deg));
        }
        if (angle.value < next_deg) {
            fail_number(
                file, angle, what, fmt::format("increasing angles, here {} or more", next_deg));
        }
        next_deg = angle.value + kLeastAngleStep_deg;
    }
}

std::vector<TurnPlane> mirrored(std::vector<TurnPlane> planes, double mirror_deg) {
    const std::size_t given = planes.size();
    for (std::size_t i = 0; i < given; ++i) {
        const double image_deg = turned_into_circle(2.0 * mirror_deg - planes[i].at_deg);
        planes[i].at_deg = turned_into_circle(planes[i].at_deg);
        const bool is_its_own_image =
            std::abs(image_deg - planes[i].at_deg) < 0.5 * kLeastAngleStep_deg;
        if (!is_its_own_image) planes.push_back({image_deg, planes[i].intensity});
    }
    sort_by_angle(planes);
    return planes;
}

bool closes_evenly(const std::vector<FileNumber>& angles_deg) {
    constexpr double kEven_deg = 1e-3;  // files round a third of a degree to three digits
    const double last_step = 360.0 - angles_deg.back().value;
    for (std::size_t i = 1; i < angles_deg.size(); ++i) {
        const double step = angles_deg[i].value - angles_deg[i - 1].value;
        if (std::abs(step - last_step) > kEven_deg) return false;
    }
    return angles_deg.size() > 1 && last_step > 0.0;
}

void set_turn(BeamTable& table, std::vector<TurnPlane> planes) {
    sort_by_angle(planes);
    if (planes.back().at_deg == 360.0) planes.pop_back();
    if (planes.front().at_deg != 0.0) {
        const TurnPlane& last = planes.back();
        const TurnPlane& first = planes.front();
        const double before = 360.0 - last.at_deg;
        const double share = before / (before + first.at_deg);
        TurnPlane seam{0.0, {}};
        for (std::size_t i = 0; i < first.intensity.size(); ++i) {
            seam.intensity.push_back((1.0 - share) * last.intensity[i] +
                                     share * first.intensity[i]);
        }
        planes.insert(planes.begin(), std::move(seam));
    }
    planes.push_back({360.0, planes.front().intensity});
    table.angles = TableAngles::TypeC;
    table.horizontal_rad.clear();
    table.intensity.clear();
    for (const TurnPlane& plane : planes) {
        table.horizontal_rad.push_back(radians_of(plane.at_deg));
        table.intensity.insert(
            table.intensity.end(), plane.intensity.begin(), plane.intensity.end());
    }
}

double radians_of(double deg) {
    return deg * kRadiansPerDegree;
}

std::vector<double> radians_of(const std::vector<FileNumber>& angles_deg) {
    std::vector<double> angles_rad;
    for (const FileNumber& angle : angles_deg) angles_rad.push_back(radians_of(angle.value));
    return angles_rad;
}

std::string degrees_text(double angle_rad) {
    const double near_deg = angle_rad * kDegreesPerRadian;
    for (int digits = 1; digits <= std::numeric_limits<double>::max_digits10; ++digits) {
        const double deg = *finite_number(fmt::format("{:.{}g}", near_deg, digits));
        if (radians_of(deg) == angle_rad) return fmt::format("{}", deg);
    }
    // In places, doubles in degrees are finer than in radians, and the division may be off by a
    // step or two.
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::array<double, 2> around{near_deg, near_deg};
    for (int step = 0; step < 4; ++step) {
        around = {std::nextafter(around[0], -kInfinity), std::nextafter(around[1], kInfinity)};
        for (const double deg : around) {
            if (radians_of(deg) == angle_rad) return fmt::format("{}", deg);
        }
    }
    return fmt::format("{}", near_deg);
}

}  // namespace aphotic
