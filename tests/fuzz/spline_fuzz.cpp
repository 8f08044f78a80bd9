// SPDX-License-Identifier: BSD-3-Clause
//
// Spectra from any text in POV-Ray's language, and the tables that they become.
#include "fuzz.h"
#include "spectral/spline_import.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto expect_sound = [](auto read) {
        aphotic::expect_result_or_placed_error("spectra.inc", read);
    };
    expect_sound([&] {
        const aphotic::SplineFile found =
            aphotic::parse_splines("spectra.inc", aphotic::text_of(data, size));
        for (const aphotic::SplineSpectrum& spectrum : found.spectra) {
            for (const auto role :
                 {aphotic::CurveRole::Reflectance, aphotic::CurveRole::LampSpectrum})
                expect_sound([&] {
                    static_cast<void>(aphotic::spline_table("spectra.inc", spectrum, role));
                });
        }
    });
    return 0;
}
