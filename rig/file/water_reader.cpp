// SPDX-License-Identifier: BSD-3-Clause
#include "rig/file/water_reader.h"

#include "spectral/natural_water.h"
#include "spectral/phase_loader.h"

#include <algorithm>
#include <array>

namespace aphotic {
namespace {

constexpr Bounds kMultiple{0.0, 1e6};
constexpr Bounds kLossPerM{0.0, 1e6};
constexpr Bounds kSalinityPsu{0.0, 40.0};
constexpr Bounds kTemperatureC{-2.0, 35.0};
constexpr Bounds kChlorophyll{kLeastChlorophyll, kMostChlorophyll};
constexpr Bounds kCdomPerM{0.0, 1e3};
constexpr Bounds kParticles{0.0, 1e3};
constexpr Bounds kMeanCosine{-0.99, 0.99};
constexpr Bounds kBackscatterRatio{kLeastBackscatter, kMostBackscatter};
constexpr Bounds kParticleIndex{1.001, 2.0};
constexpr Bounds kSizeSlope{3.01, 5.0};

PhaseFunction read_formula(Section section) {
    section.refuse_both({"henyey_greenstein", "fournier_forand"});
    PhaseFunction phase;
    if (section.has("henyey_greenstein")) {
        phase = {.name = "henyey-greenstein",
                 .kind = HenyeyGreenstein{section.number("henyey_greenstein", kMeanCosine)}};
    } else {
        Section formula = section.section(
            "fournier_forand", "{ backscatter_ratio = ... } or { index = ..., slope = ... }");
        if (formula.has("backscatter_ratio")) {
            phase = fournier_forand(formula.number("backscatter_ratio", kBackscatterRatio));
        } else {
            const double index = formula.number("index", kParticleIndex);
            phase = {.name = "fournier-forand",
                     .kind = FournierForand{.index = index,
                                            .slope = formula.number("slope", kSizeSlope)}};
        }
        formula.refuse_unknown_keys();
    }
    section.refuse_unknown_keys();
    return phase;
}

PhaseFunction read_phase(Section& section, RigFiles& files, const std::string& absent) {
    if (!section.has("phase")) return builtin_phase(absent);
    const std::string allowed =
        "a built-in phase function's name, a .csv file beside the rig, { henyey_greenstein = ... } "
        "or { fournier_forand = ... }";
    const toml::node& node = section.required("phase", allowed);
    if (node.is_table()) return read_formula(section.section("phase", allowed));
    const std::string name = section.text("phase", allowed);
    if (!names_a_file(name)) return section.at_key("phase", [&] { return builtin_phase(name); });
    const Table table = files.table(section, "phase", name);
    return section.at_key("phase", [&] { return phase_of(table); });
}

// c - a at the wavelengths of both.
Spectrum scattering_of(const Section& section, const Spectrum& c, const Spectrum& a) {
    const std::array<const Spectrum*, 2> both{&c, &a};
    const WavelengthRange common = common_range(both);
    if (common.first_nm >= common.last_nm)
        section.fail_at("attenuation",
                        "covers no wavelength of the absorption; allowed: the same range");
    const std::vector<double> knots_nm = union_of_knots(both, common);
    std::vector<double> values;
    for (const double nm : knots_nm) {
        values.push_back(c.at(nm) - a.at(nm));
        if (values.back() >= 0.0) continue;
        section.fail_at("attenuation",
                        fmt::format("found {}/m at {} nm, less than the absorption {}/m; allowed: "
                                    "no less, since attenuation is absorption plus scattering",
                                    c.at(nm),
                                    nm,
                                    a.at(nm)));
    }
    return {"water scattering", knots_nm, std::move(values)};
}

void read_tables(Section& section, RigFiles& files, Water& water) {
    if (section.has("scattering")) {
        const std::string allowed =
            "a .csv file beside the rig, or \"sea-water\" for the scattering of water itself";
        if (section.text("scattering", allowed) == "sea-water") {
            if (section.has("phase"))
                section.fail_at("phase",
                                "found with pure sea water, whose phase function is known; "
                                "allowed: with particles");
            water.scatterers.push_back(seawater_scatterer(water.salinity_psu, water.temperature_c));
            return;
        }
        Spectrum b = files.curves(section, "scattering", CurveRole::WaterScattering).front();
        water.scatterers.push_back({std::move(b), read_phase(section, files, "petzold")});
    } else if (section.has("attenuation")) {
        const Spectrum c =
            files.curves(section, "attenuation", CurveRole::WaterAttenuation).front();
        water.scatterers.push_back({scattering_of(section, c, water.absorption_per_m),
                                    read_phase(section, files, "petzold")});
    }
}

void read_constituents(Section& section, RigFiles& files, Water& water) {
    Constituents constituents{
        .chlorophyll_mg_m3 = section.number("chlorophyll_mg_m3", kChlorophyll),
        .particles = section.number_or("particles", kParticles, 1.0)};
    if (section.has("cdom_440_per_m"))
        constituents.cdom_440_per_m = section.number("cdom_440_per_m", kCdomPerM);
    take_constituents(constituents, water);
    if (section.has("phase")) water.scatterers.back().phase = read_phase(section, files, "");
}

void read_type(Section& section, RigFiles& files, Water& water) {
    const std::vector<Spectrum> curves = files.curves(section, "type", CurveRole::WaterType);
    take_type(curves[0], curves[1], read_phase(section, files, "petzold"), water);
}

}  // namespace

Water read_water(Section section, RigFiles& files) {
    section.refuse_both({"type", "chlorophyll_mg_m3", "absorption"});
    section.refuse_both({"type", "chlorophyll_mg_m3", "scattering", "attenuation"});
    Water water{.absorption_per_m =
                    files.curve(section, "absorption", CurveRole::WaterAbsorption, "pope-fry-1997"),
                .multiple = section.number_or("multiple", kMultiple, 1.0),
                .uniform_loss_per_m = section.number_or("uniform_loss_per_m", kLossPerM, 0.0),
                .salinity_psu = section.number_or("salinity_psu", kSalinityPsu, 35.0),
                .temperature_c = section.number_or("temperature_c", kTemperatureC, 10.0)};
    if (section.has("type")) {
        read_type(section, files, water);
    } else if (section.has("chlorophyll_mg_m3")) {
        read_constituents(section, files, water);
    } else {
        read_tables(section, files, water);
    }
    // Known keys, but not for this water.
    for (const char* key : {"cdom_440_per_m", "particles"}) {
        if (section.has(key) && !section.has("chlorophyll_mg_m3"))
            section.fail_at(key, "found without chlorophyll_mg_m3; allowed: together with it");
    }
    if (section.has("phase") && water.scatterers.empty())
        section.fail_at("phase",
                        "found for water that does not scatter; allowed: with type, "
                        "chlorophyll_mg_m3, scattering or attenuation");
    section.refuse_unknown_keys();
    return water;
}

}  // namespace aphotic
