// SPDX-License-Identifier: BSD-3-Clause
#include "validation/traced_vignetting.h"

#include <cmath>

namespace aphotic {

double traced_vignetting(const Camera& camera,
                         double column,
                         double row,
                         const Eigen::Matrix<long double, 3, 1>& sight) {
    if (!camera.vignetting) return 1.0;
    const long double tangent_squared =
        (sight.x() * sight.x() + sight.y() * sight.y()) / (sight.z() * sight.z());
    if (const auto* radial = std::get_if<RadialVignetting>(&*camera.vignetting)) {
        double right = column - camera.width_px / 2.0;
        double down = row - camera.height_px / 2.0;
        if (camera.lens) {
            right = column - camera.lens->centre_px.x();
            down = row - camera.lens->centre_px.y();
        }
        const double p =
            std::hypot(right, down) / std::hypot(camera.width_px, camera.height_px) * 2;
        return 1.0 + radial->a[0] * std::pow(p, 2) + radial->a[1] * std::pow(p, 4) +
               radial->a[2] * std::pow(p, 6);
    }
    if (const auto* table = std::get_if<TabulatedVignetting>(&*camera.vignetting)) {
        const double angle_rad = static_cast<double>(std::atan(std::sqrt(tangent_squared)));
        std::size_t row_of = 0;
        while (row_of + 2 < table->angles_rad.size() && table->angles_rad[row_of + 1] < angle_rad)
            ++row_of;
        const double from_rad = table->angles_rad[row_of];
        const double slope = (table->factors[row_of + 1] - table->factors[row_of]) /
                             (table->angles_rad[row_of + 1] - from_rad);
        return table->factors[row_of] + slope * (angle_rad - from_rad);
    }
    // cos^4 = 1 / (1 + tan^2)^2
    return static_cast<double>(1.0L / ((1.0L + tangent_squared) * (1.0L + tangent_squared)));
}

}  // namespace aphotic
