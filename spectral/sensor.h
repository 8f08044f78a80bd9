// SPDX-License-Identifier: BSD-3-Clause
//
// The camera's response to spectral radiance.
//
//   S_c = integral of L(lambda) Q_c(lambda) d lambda
//
//   energy response    Q_c = q_c
//   quantum response   Q_c = q_c lambda / (h c)            photons per joule
//   filter and sensor  Q_c = f_c eta lambda / (h c)        electrons per joule
//   mono               Q_c = eta lambda / (h c)            the same in all three channels
//
// S_c     signal of channel c
// L       spectral radiance
// q_c     response table; its owner states whether it is per energy or per photon
// f_c     transmittance of the channel's filter                 [1]
// eta     quantum efficiency of the sensor behind the filters   [1]
// lambda  wavelength; nm in the interface, m in the formula
// h, c    Planck constant 6.62607015e-34 J s, speed of light 299792458 m/s, both exact
//         (SI Brochure, 9th edition, BIPM 2019)
//
// Nothing else scales S. Linear sensors only: no saturation, no noise.
#pragma once

#include "image/camera_image.h"
#include "spectral/spectrum.h"

#include <optional>
#include <string_view>
#include <vector>

namespace aphotic {

enum class ResponseKind { Energy, Quantum };

class Sensor {
  public:
    // One response per channel, in the order of kChannelNames. Throws InputError unless there
    // are three.
    Sensor(std::vector<Spectrum> responses, ResponseKind kind);

    [[nodiscard]] static Sensor filtered(std::vector<Spectrum> filters,
                                         Spectrum quantum_efficiency);

    // Without filters: red, green and blue are equal.
    [[nodiscard]] static Sensor mono(const Spectrum& quantum_efficiency);
    [[nodiscard]] bool is_mono() const { return is_mono_; }

    // Q_c. Throws InputError outside range().
    [[nodiscard]] double response(int channel, double lambda_nm) const;

    // All tables behind the responses, for range checks and knots; valid during the sensor's
    // lifetime.
    [[nodiscard]] std::vector<const Spectrum*> curves() const;

    // The wavelengths that all of them cover.
    [[nodiscard]] WavelengthRange range() const;

  private:
    std::vector<Spectrum> responses_;
    std::optional<Spectrum> quantum_efficiency_;
    ResponseKind kind_;
    bool is_mono_ = false;
};

// A built-in camera; its table states its kind.
[[nodiscard]] Sensor builtin_sensor(std::string_view name);

}  // namespace aphotic
