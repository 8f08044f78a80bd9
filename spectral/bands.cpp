// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/bands.h"

#include "base/error.h"

namespace aphotic {

std::vector<WeightedWavelength> equal_bands(const Sensor& sensor,
                                            WavelengthRange range,
                                            int count) {
    const double width_nm = (range.last_nm - range.first_nm) / count;
    std::vector<WeightedWavelength> bands;
    for (int j = 0; j < count; ++j) {
        WeightedWavelength w{.lambda_nm = range.first_nm + (j + 0.5) * width_nm};
        for (int c = 0; c < kChannels; ++c) {
            w.weight[static_cast<std::size_t>(c)] = width_nm * sensor.response(c, w.lambda_nm);
        }
        bands.push_back(w);
    }
    return bands;
}

void require_wavelengths(WavelengthRange range, std::span<const double> lambda_nm) {
    for (std::size_t j = 0; j < lambda_nm.size(); ++j) {
        // Closer wavelengths would have the same channel names.
        constexpr double kLeastStepNm = 1e-5;
        const bool increases = j == 0 || lambda_nm[j] >= lambda_nm[j - 1] + kLeastStepNm;
        if (increases && range.contains(lambda_nm[j])) continue;
        throw InputError(
            "wavelengths: found {} nm at position {}; allowed: increasing wavelengths from {} to "
            "{} nm",
            lambda_nm[j],
            j + 1,
            range.first_nm,
            range.last_nm);
    }
}

}  // namespace aphotic
