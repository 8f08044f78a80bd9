// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/band_sdl.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace aphotic {

namespace {

constexpr std::size_t kMostNameLetters = 60;  // in aphotic.inc
constexpr std::size_t kRoomForANumber = 6;

std::string array_sdl(std::string_view name, const std::vector<std::string>& elements) {
    return fmt::format("#declare {} = array[{}] {{{}}}\n",
                       name,
                       elements.size(),
                       fmt::format("{}", fmt::join(elements, ", ")));
}

std::string spectra_sdl(std::string_view kind,
                        const std::vector<NamedSpectrum>& spectra,
                        const Channels& lambda_nm,
                        bool is_black) {
    std::vector<std::string> names;
    std::vector<std::string> values;
    for (const NamedSpectrum& named : spectra) {
        names.push_back(sdl_text(named.name));
        Channels value{};
        for (std::size_t c = 0; c < value.size(); ++c) {
            if (!is_black) value[c] = named.spectrum.at(lambda_nm[c]);
        }
        values.push_back(sdl_vector(value));
    }
    return array_sdl(fmt::format("Aphotic_{}_Names", kind), names) +
           array_sdl(fmt::format("Aphotic_{}_Values", kind), values);
}

}  // namespace

std::string scene_name(std::string_view name) {
    return sdl_letters(name).substr(0, kMostNameLetters);
}

std::vector<NamedSpectrum> named(std::span<const Spectrum> spectra) {
    std::vector<NamedSpectrum> names;
    for (const Spectrum& spectrum : spectra) {
        // The name as POV-Ray reads it: two files that differ only in accents have the same one.
        const std::string name = scene_name(spectrum.short_name());
        int same_name = 1;
        bool is_there = false;
        for (const NamedSpectrum& other : names) {
            if (scene_name(other.spectrum.short_name()) != name) continue;
            is_there |= other.spectrum.short_name() == spectrum.short_name() &&
                        is_same_curve(other.spectrum, spectrum);
            ++same_name;
        }
        if (is_there) continue;
        names.push_back(
            {.name =
                 same_name == 1
                     ? name
                     : fmt::format(
                           "{} {}", name.substr(0, kMostNameLetters - kRoomForANumber), same_name),
             .spectrum = spectrum});
    }
    return names;
}

const std::string& name_of(const Spectrum& spectrum, std::span<const NamedSpectrum> names) {
    for (const NamedSpectrum& named : names) {
        if (named.spectrum.short_name() == spectrum.short_name() &&
            is_same_curve(named.spectrum, spectrum)) {
            return named.name;
        }
    }
    throw InputError("{}: has no name in the scene", spectrum.name());
}

std::string band_sdl(const Band& band) {
    std::string sdl = fmt::format("#declare Aphotic_Band_Version = {};\n", kBandVersion);
    const auto declare = [&](std::string_view name, const std::string& value) {
        sdl += fmt::format("#declare Aphotic_{} = {};\n", name, value);
    };
    declare("Lambda", sdl_vector(band.lambda_nm));
    declare("Exposure", sdl_vector(band.exposure));
    declare("Attenuation", sdl_vector(band.attenuation_per_m));
    declare("Water_Index", sdl_number(band.water_index));
    if (!band.glasses.empty()) {
        std::vector<std::string> names;
        std::vector<std::string> indices;
        for (const GlassIndex& glass : band.glasses) {
            names.push_back(sdl_text(glass.name));
            indices.push_back(sdl_number(glass.index));
        }
        sdl +=
            array_sdl("Aphotic_Glass_Names", names) + array_sdl("Aphotic_Glass_Indices", indices);
    }
    if (band.scattering) {
        const BandScattering& scattering = *band.scattering;
        declare("Scattering", sdl_vector(scattering.per_m));
        if (scattering.eccentricity) declare("Eccentricity", sdl_number(*scattering.eccentricity));
        declare("Samples", fmt::format("{}", scattering.samples));
        declare("Sight", sdl_number(scattering.sight_m));
        if (scattering.cuts_edges) declare("Cut_Edges", "true");
    }
    return sdl + spectra_sdl("Lamp", band.lamps, band.lambda_nm, false) +
           spectra_sdl(
               "Reflectance", band.reflectances, band.lambda_nm, band.scattering.has_value());
}

}  // namespace aphotic
