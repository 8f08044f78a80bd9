// SPDX-License-Identifier: BSD-3-Clause
//
// A band: the data on a frame's wavelengths, one in each channel, that plugin/include/aphotic.inc
// requires before it is included. Everything that depends on wavelength enters a scene this way.
#pragma once

#include "scene_gen/sdl.h"
#include "spectral/spectrum.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// The version of aphotic.inc for which bands are written.
inline constexpr int kBandVersion = 1;

// A spectrum with its name in the scene.
struct NamedSpectrum {
    std::string name;
    Spectrum spectrum;
};

// The name that a scene can use: sdl_letters, as many as aphotic.inc allows.
[[nodiscard]] std::string scene_name(std::string_view name);

// The distinct spectra, with their short names as a scene can write them; if different ones share a
// name, the later ones get a number.
[[nodiscard]] std::vector<NamedSpectrum> named(std::span<const Spectrum> spectra);

// The spectrum's name in that list.
[[nodiscard]] const std::string& name_of(const Spectrum& spectrum,
                                         std::span<const NamedSpectrum> names);

struct GlassIndex {
    std::string name;
    double index;
};

// For a frame that shows only the veil: everything else is black.
struct BandScattering {
    Channels per_m{};                    // of light scattered by the phase function
    std::optional<double> eccentricity;  // Henyey and Greenstein's g; empty: Rayleigh's
    int samples = 1;
    double sight_m = 0.0;     // the length up to which a ray is sampled in one piece
    bool cuts_edges = false;  // apart from the edges of cones
};

struct Band {
    Channels lambda_nm{};
    Channels exposure{};  // factor on radiance
    Channels attenuation_per_m{};
    double water_index = 1.0;           // relative to air
    std::vector<GlassIndex> glasses{};  // relative to air; empty without a port
    std::vector<NamedSpectrum> lamps;
    std::vector<NamedSpectrum> reflectances;
    std::optional<BandScattering> scattering{};
};

[[nodiscard]] std::string band_sdl(const Band& band);

}  // namespace aphotic
