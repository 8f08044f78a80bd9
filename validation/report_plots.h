// SPDX-License-Identifier: BSD-3-Clause
//
// The plots of a report, each a whole <svg>.
#pragma once

#include "validation/report.h"

#include <string>
#include <string_view>

namespace aphotic {

// A line of pixels through the middle of the image: row height / 2, or column width / 2.
enum class ProfileLine { Row, Column };

// The number of the profile's row or column.
[[nodiscard]] int profile_index(const ValidationReport& report, ProfileLine line);

// For each channel both renderers over each other, and beneath them the relative error.
[[nodiscard]] std::string profile_svg(const ValidationReport& report, ProfileLine line);

// Largest, 99.9 percentile and root mean square over wavelength, and of the channels, with the
// bounds, on a logarithmic axis. What is 0 is not drawn.
[[nodiscard]] std::string errors_svg(const ValidationReport& report);

// The colours of an error map from -scale to +scale. id: of the drawing, on its page.
[[nodiscard]] std::string colour_bar_svg(double scale, std::string_view id);

}  // namespace aphotic
