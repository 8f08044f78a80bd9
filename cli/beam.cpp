// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic beam RIG:NAME|FILE: a beam's data sheet, its plot, the beam as a file for other programs,
// and the sharp cones that fit it best.
#include "rig/beam/beam.h"

#include "base/degrees.h"
#include "base/error.h"
#include "base/json_text.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/rig_file.h"
#include "cli/terminal.h"
#include "report/plot.h"
#include "rig/beam/beam_figures.h"
#include "rig/beam/cone_fit.h"
#include "spectral/lamp_flux.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace aphotic::cli {

namespace {

constexpr int kMostFittedCones = 20;
constexpr double kThousandLumens = 1000.0;

struct BeamCommandOptions {
    std::string name;
    std::string plot;
    std::string export_file;
    int cones = 0;
    bool json = false;
};

// A strobe of the rig with this beam.
struct BeamUser {
    std::string name;
    std::optional<double> luminous_flux_lm;
};

struct ShownBeam {
    BeamCommandOptions options;
    Beam beam;
    std::vector<BeamUser> users;
    std::optional<double> stated_lm;  // in the file
    BeamFigures figures;
    std::optional<ConeFit> fit;
    std::optional<double> export_error;
};

// For a file: a lamp of the flux that it states.
void take_file(const std::string& file, ShownBeam& shown) {
    if (rig_settings()) throw InputError("--set: found with {}; allowed: with a rig", file);
    const PhotometricFile read = read_photometric_file(file);
    if (largest_intensity(read.table) == 0.0) {
        throw InputError("{}: found no light in it; allowed: some", file);
    }
    shown.beam = scaled_to_flux({.name = file, .cones = {}, .pattern = normalised(read.table)});
    const bool is_candela = !file.ends_with(".csv");
    std::optional<double> flux_lm;
    if (is_candela) flux_lm = table_flux(read.table);
    if (flux_lm && !std::isfinite(*flux_lm))
        throw InputError(fmt::format("{}: found a flux of more lumens than 1.8e308", file));
    shown.users.push_back({.name = "the file's lamp", .luminous_flux_lm = flux_lm});
    shown.stated_lm = read.luminous_flux_lm;
}

void take_beam_of_rig(const std::string& file, const std::string& name, ShownBeam& shown) {
    const Rig rig = read_rig_as_set(file);
    std::vector<std::string> names;
    for (const Strobe& strobe : rig.strobes) {
        names.push_back(strobe.beam.name);
        if (strobe.beam.name != name) continue;
        shown.beam = strobe.beam;
        shown.users.push_back({.name = strobe.name, .luminous_flux_lm = {}});
        if (!strobe.is_absolute) continue;
        shown.users.back().luminous_flux_lm = strobe.power * luminous_flux_lm(strobe.spectrum);
    }
    if (!shown.users.empty()) return;
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    throw InputError(
        "{}: found no strobe with the beam '{}'; allowed: {}", file, name, fmt::join(names, ", "));
}

std::string kind_of(const Beam& beam) {
    std::string kind = "cones";
    if (const auto* table = std::get_if<BeamTable>(&beam.pattern)) {
        constexpr std::array kTypes{"A", "B", "C"};
        kind = fmt::format("a table of {} x {} directions, type {}",
                           table->vertical_rad.size(),
                           table->horizontal_rad.size(),
                           kTypes.at(static_cast<std::size_t>(table->angles)));
    } else if (std::holds_alternative<BeamOptics>(beam.pattern)) {
        kind = "a diffuser behind a lens";
    } else {
        kind = fmt::format("{} cone{}", beam.cones.size(), beam.cones.size() == 1 ? "" : "s");
    }
    if (!beam.window) return kind + ", in water";
    return fmt::format("{}, measured in air, in water behind a window of index {:.4f}",
                       kind,
                       beam.window->glass_index);
}

nlohmann::ordered_json to_json(const ShownBeam& shown) {
    const auto& [options, beam, users, stated_lm, figures, fit, export_error] = shown;
    nlohmann::ordered_json json{{"beam", beam.name},
                                {"kind", kind_of(beam)},
                                {"flux", figures.flux},
                                {"largest_per_sr", figures.largest_per_sr},
                                {"fwhm_along_deg", figures.fwhm_along_rad * kDegreesPerRadian},
                                {"fwhm_across_deg", figures.fwhm_across_rad * kDegreesPerRadian},
                                {"widest_deg", figures.widest_rad * kDegreesPerRadian}};
    for (const BeamUser& user : users) {
        nlohmann::ordered_json lamp{{"name", user.name}};
        if (user.luminous_flux_lm) {
            lamp["luminous_flux_lm"] = *user.luminous_flux_lm;
            lamp["largest_cd"] = *user.luminous_flux_lm * figures.largest_per_sr;
        }
        json["lamps"].push_back(lamp);
    }
    if (stated_lm) json["stated_luminous_flux_lm"] = *stated_lm;
    if (fit) {
        json["cones_error"] = fit->error;
        for (const Cone& cone : fit->cones) {
            json["cones"].push_back({{"part", cone.part},
                                     {"half_angle_deg", cone.half_angle_rad * kDegreesPerRadian},
                                     {"weight", cone.weight}});
        }
    }
    if (export_error) json["export_error"] = *export_error;
    return json;
}

void print(const ShownBeam& shown) {
    const auto& [options, beam, users, stated_lm, figures, fit, export_error] = shown;
    say("{}: {}\n", beam.name, kind_of(beam));
    say("  flux                {:.6g} of the lamp's\n", figures.flux);
    say("  largest intensity   {:.6g} per sr\n", figures.largest_per_sr);
    say("  width at half       {:.2f} degrees along, {:.2f} across\n",
        figures.fwhm_along_rad * kDegreesPerRadian,
        figures.fwhm_across_rad * kDegreesPerRadian);
    say("  light               up to {:.1f} degrees off the axis\n",
        figures.widest_rad * kDegreesPerRadian);
    for (const BeamUser& user : users) {
        if (!user.luminous_flux_lm) continue;
        say("  {:<19} {:.6g} lm, {:.6g} cd at most\n",
            user.name,
            *user.luminous_flux_lm,
            *user.luminous_flux_lm * figures.largest_per_sr);
    }
    if (stated_lm) say("  the file states     {:.6g} lm\n", *stated_lm);
    if (fit) {
        say("  fit of {} sharp cone{}, {:.1f} % rms error:\ncones = [\n",
            fit->cones.size(),
            fit->cones.size() == 1 ? "" : "s",
            100.0 * fit->error);
        for (const Cone& cone : fit->cones) {
            say("  {{ part = \"{}\", half_angle_deg = {:g}, weight = {:.6g} }},\n",
                cone.part,
                cone.half_angle_rad * kDegreesPerRadian,
                cone.weight);
        }
        say("]\n");
    }
    if (export_error) {
        say("  {}: between its nodes within {:.2g} of the largest intensity\n",
            options.export_file,
            *export_error);
    }
}

// The two planes over the angle, and as polar plots.
void plot(const Beam& beam, const std::string& file) {
    constexpr int kSteps = 1800;
    constexpr double kStep_deg = 0.1;
    Plot cartesian{.title = beam.name,
                   .x_label = "angle off the axis [degrees]",
                   .y_label = "intensity [1/sr]",
                   .curves = {}};
    Plot polar{.title = "as thrown, axis up",
               .x_label = "intensity times the sine [1/sr]",
               .y_label = "intensity times the cosine [1/sr]",
               .curves = {},
               .equal_axes = true};
    for (const BeamPlane plane : {BeamPlane::Along, BeamPlane::Across}) {
        const bool is_along = plane == BeamPlane::Along;
        PlotCurve over_angle{.label = is_along ? "along" : "across",
                             .x = {},
                             .y = {},
                             .tone = is_along ? 0U : 1U,
                             .dashed = !is_along};
        PlotCurve thrown = over_angle;
        for (int i = -kSteps; i <= kSteps; ++i) {
            const double theta_rad = i * kStep_deg * kRadiansPerDegree;
            const double intensity = intensity_in_plane(beam, plane, theta_rad);
            if (std::abs(i) <= kSteps / 2) {
                over_angle.x.push_back(i * kStep_deg);
                over_angle.y.push_back(intensity);
            }
            thrown.x.push_back(intensity * std::sin(theta_rad));
            thrown.y.push_back(intensity * std::cos(theta_rad));
        }
        cartesian.curves.push_back(std::move(over_angle));
        polar.curves.push_back(std::move(thrown));
    }
    write_plots(std::vector<Plot>{cartesian, polar}, file);
}

// For the first lamp of known flux; otherwise for 1000 lumens.
double exported_flux_lm(const std::vector<BeamUser>& users) {
    for (const BeamUser& user : users) {
        if (user.luminous_flux_lm) return *user.luminous_flux_lm;
    }
    return kThousandLumens;
}

ExitStatus show_beam(const BeamCommandOptions& options) {
    ShownBeam shown;
    shown.options = options;
    const std::size_t colon = options.name.rfind(':');
    if (is_photometric_file_name(options.name)) {
        take_file(options.name, shown);
    } else if (colon != std::string::npos) {
        take_beam_of_rig(options.name.substr(0, colon), options.name.substr(colon + 1), shown);
    } else {
        throw InputError("found '{}'; allowed: RIG:NAME, a beam of a rig, or a {} file",
                         options.name,
                         kPhotometricEndings);
    }
    shown.figures = figures_of(shown.beam);
    if (options.cones > 0) shown.fit = fit_cones(shown.beam, options.cones);
    if (!options.plot.empty()) plot(shown.beam, options.plot);
    if (!options.export_file.empty()) {
        const ExportedBeam file = exported(shown.beam, exported_flux_lm(shown.users));
        write_photometric_file(file.file, options.export_file);
        shown.export_error = file.error;
    }
    if (options.json) {
        say_text(json_text(to_json(shown)));
    } else {
        print(shown);
    }
    return kDone;
}

}  // namespace

Action configure_beam(CLI::App& app) {
    const auto options = std::make_shared<BeamCommandOptions>();
    add_option(app, "RIG:NAME|FILE", options->name)->required();
    add_option(app, "--plot", options->plot);
    add_option(app, "--export", options->export_file);
    add_option(app, "--fit-cones", options->cones)->check(in_range(1, kMostFittedCones));
    add_json(app, options->json);
    return [options] { return show_beam(*options); };
}

}  // namespace aphotic::cli
