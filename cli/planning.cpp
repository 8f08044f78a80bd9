// SPDX-License-Identifier: BSD-3-Clause
#include "cli/planning.h"

#include "scene_gen/rig_reader.h"
#include "spectral/error.h"

#include <fmt/format.h>

namespace aphotic::cli {

void add_wavelength_options(CLI::App& app, PlanningOptions& options) {
    constexpr int kMostBands = 100000;
    app.add_option("RIG", options.rig_file, "the rig file (TOML)")->required();
    auto* bands =
        app.add_option(
               "--bands", options.bands, "equal bands over the sensor's range, each at its middle")
            ->check(CLI::Range(1, kMostBands))
            ->capture_default_str();
    app.add_option(
           "--wavelengths", options.wavelengths_nm, "wavelengths in nm, such as 478,576,638")
        ->delimiter(',')
        ->excludes(bands);
}

void add_planning_options(CLI::App& app, PlanningOptions& options) {
    constexpr int kMostLamps = 64;
    add_wavelength_options(app, options);
    app.add_option("--per-frame",
                   options.per_frame,
                   "wavelengths that share a frame, one a channel; behind a port always 1")
        ->check(CLI::Range(1, 3))
        ->capture_default_str();
    app.add_option(
           "--emitter-lamps",
           options.emitter_lamps,
           "point lamps that stand for an emitter, across,along, such as 4,2; by default as "
           "many as the distance asks for")
        ->delimiter(',')
        ->expected(2)
        ->check(CLI::Range(1, kMostLamps));
}

PlannedWavelengths plan_wavelengths(const PlanningOptions& options) {
    Rig rig = read_rig(options.rig_file);
    const Camera& camera = rig.camera;
    std::vector<WeightedWavelength> wavelengths =
        options.wavelengths_nm.empty()
            ? equal_bands(camera.sensor, camera.range, options.bands)
            : listed_wavelengths(camera.sensor, camera.range, options.wavelengths_nm);
    return {.rig = std::move(rig), .wavelengths = std::move(wavelengths)};
}

PlannedRender plan_render(const PlanningOptions& options) {
    PlannedWavelengths planned = plan_wavelengths(options);
    SceneOptions scene_options{.wavelengths_per_frame = options.per_frame,
                               .emitter_lamps = std::nullopt};
    if (!options.emitter_lamps.empty()) {
        scene_options.emitter_lamps = {.across = options.emitter_lamps[0],
                                       .along = options.emitter_lamps[1]};
    }
    try {
        SceneSet scenes = make_scene_set(planned.rig, planned.wavelengths, scene_options);
        return {.rig = std::move(planned.rig), .scenes = std::move(scenes)};
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", options.rig_file, error.what()));
    }
}

}  // namespace aphotic::cli
