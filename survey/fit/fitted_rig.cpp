// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fitted_rig.h"

#include "base/atomic_file.h"
#include "base/degrees.h"
#include "base/number.h"
#include "rig/beam/beam_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace aphotic {
namespace {

namespace fs = std::filesystem;

// To more digits than any fit determines, and not 120.00000000000001.
double rounded(double value) {
    constexpr int kDigits = 12;
    return rounded_to_digits(value, kDigits);
}

// A beam of its own, since other strobes may use the rig's.
void add_beam(const FitBeam& fit,
              const FitBeam::Fitted& fitted,
              const std::string& name,
              const RigText& rig,
              const std::string& was,
              const fs::path& folder,
              RigText& text) {
    const std::string key = "beam." + name;
    text.erase(key);
    if (fit.kind() == FitBeamKind::Table) {
        const std::string file = fmt::format("{}-beam.csv", name);
        PhotometricFile photometry;
        photometry.table = std::get<BeamTable>(fitted.beam.pattern);
        write_text_file(folder / file, "# source: aphotic fit\n" + beam_csv_text(photometry, file));
        text.set(key + ".table", file);
        return;
    }
    if (fit.kind() == FitBeamKind::Cosine) {
        const double half = std::acos(std::pow(0.5, 1.0 / fit.coefficients().front()));
        text.set(key + ".fwhm_deg", rounded(2.0 * half * kDegreesPerRadian));
        return;
    }
    text.copy(rig, "beam." + was, key);
    if (const auto* optics = std::get_if<BeamOptics>(&fitted.beam.pattern)) {
        text.set(key + ".focal_length_mm", rounded(kMillimetres * optics->focal_length_m));
        text.set(key + ".distance_mm", rounded(kMillimetres * optics->distance_m));
    } else if (text.has(key + ".cones")) {
        text.erase(key + ".weights");  // shares of the flux now
        for (std::size_t k = 0; k < fitted.beam.cones.size(); ++k)
            text.set(fmt::format("{}.cones.{}.weight", key, k), fitted.beam.cones[k].weight);
    }
}

// Beams of the rig that no strobe uses any more.
void erase_orphans(const Rig& rig, RigText& text) {
    for (const Strobe& strobe : rig.strobes) {
        const std::string& name = strobe.beam.name;
        const bool is_used = std::ranges::any_of(rig.strobes, [&](const Strobe& other) {
            return text.word("strobe." + other.name + ".beam") == name;
        });
        if (!is_used && text.has("beam." + name)) text.erase("beam." + name);
    }
}

void set_strobes(const RigText& rig_text,
                 const Rig& rig,
                 const FitState& state,
                 const fs::path& folder,
                 RigText& text) {
    std::vector<FitBeam::Fitted> beams;
    for (const FitBeam& beam : state.beams) beams.push_back(beam.fitted());
    const std::vector<double> powers = powers_in(state, rig);
    std::vector<bool> is_written(beams.size(), false);
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        const Strobe& strobe = rig.strobes[s];
        const std::string key = "strobe." + strobe.name;
        const std::size_t b = state.beam_of[s];
        if (state.beams[b].kind() != FitBeamKind::Held) {
            const std::string name = beams.size() == 1 ? "fitted" : fmt::format("fitted-{}", b + 1);
            if (!is_written[b])
                add_beam(state.beams[b], beams[b], name, rig_text, strobe.beam.name, folder, text);
            is_written[b] = true;
            text.set(key + ".beam", name);
        }
        if (strobe.power > 0.0 && powers[s] != strobe.power) {
            const std::string unit = power_key(rig_text, strobe.name);
            const double told = rig_text.number(unit).value_or(1.0);
            text.set(unit, rounded(told * powers[s] / strobe.power));
        }
        if (state.aim_rad[s][0] == 0.0 && state.aim_rad[s][1] == 0.0) continue;
        const Eigen::Vector3d axis = aimed_axis(rig, state.aim_rad[s], s);
        text.erase(key + ".aim");
        text.set(key + ".direction", std::vector<double>{axis.x(), axis.y(), axis.z()});
    }
    erase_orphans(rig, text);
}

void set_floor(const Spectrum& was, double brightness, const fs::path& folder, RigText& text) {
    if (brightness == 1.0) return;
    std::string csv = "# source: aphotic fit\nwavelength_nm,reflectance\n";
    for (std::size_t i = 0; i < was.values().size(); ++i) {
        csv +=
            fmt::format("{},{}\n", was.lambda_nm()[i], std::min(1.0, brightness * was.values()[i]));
    }
    write_text_file(folder / kFittedFloor, csv);
    text.set("seafloor.reflectance", kFittedFloor);
}

}  // namespace

void write_fitted_rig(const RigText& rig_text, const FitResult& result, const fs::path& folder) {
    const Rig rig = rig_text.rig();
    RigText text = rig_text;
    rig_text.copy_files(folder);
    const FitState& state = result.state;
    set_strobes(rig_text, rig, state, folder, text);
    set_floor(rig.seafloor.reflectance, state.floor_brightness, folder, text);
    for (const WaterNumber& number : state.water) text.set(number.key, number.value);
    if (!state.vignetting.empty()) {
        text.erase("camera.vignetting");
        if (state.vignetting.size() == 1)
            text.set("camera.vignetting.cosine", rounded(state.vignetting.front()));
        else
            text.set("camera.vignetting.radial", state.vignetting);
    }
    if (state.offset.altitude_m != 0.0) {
        text.set("sled.altitude_offset_m",
                 rig.mounting.altitude_offset_m + state.offset.altitude_m);
    }
    if (state.offset.pitch_rad != 0.0 || state.offset.roll_rad != 0.0) {
        const Eigen::Vector3d turn =
            rig.mounting.roll_pitch_yaw_rad +
            Eigen::Vector3d(state.offset.roll_rad, state.offset.pitch_rad, 0.0);
        text.set("camera.orientation_deg",
                 std::vector<double>{rounded(turn.x() * kDegreesPerRadian),
                                     rounded(turn.y() * kDegreesPerRadian),
                                     rounded(turn.z() * kDegreesPerRadian)});
    }
    const std::string toml = text.text();
    // Ensures that the result can be read.
    static_cast<void>(RigText(toml, kFittedRig, folder));
    write_text_file(folder / kFittedRig,
                    "# By `aphotic fit`; its errors are in fit.json.\n" + toml);
}

}  // namespace aphotic
