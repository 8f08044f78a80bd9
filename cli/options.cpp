// SPDX-License-Identifier: BSD-3-Clause
#include "cli/options.h"

#include "base/error.h"
#include "cli/rig_file.h"

#include <algorithm>
#include <map>
#include <thread>

namespace aphotic::cli {
namespace {

constexpr const char* kWavelengthOptions = "Wavelengths";
constexpr const char* kSceneOptions = "A POV-Ray scene of your own";
constexpr const char* kPovRayOptions = "POV-Ray";

int most_cores = 0;  // 0: --jobs was not said

}  // namespace

int all_cores() {
    const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    return most_cores > 0 ? std::min(cores, most_cores) : cores;
}

void take_no_more_cores_than(int jobs) {
    most_cores = jobs;
}

void add_rig(CLI::App& app, std::string& file) {
    app.add_option("RIG", file, "The rig file (TOML)")->required();
}

CLI::Option* add_share(CLI::App& app,
                       const std::string& name,
                       WorkShare& share,
                       const std::string& words) {
    return add_read(app, name, share, parse_share, words)->option_text("I/N");
}

void add_json(CLI::App& app, bool& json, const std::string& words) {
    app.add_flag("--json", json, words);
}

void add_preview_options(CLI::App& app, PreviewOptions& options) {
    static const std::map<std::string, PreviewWhite> kWhites{
        {"lamp", PreviewWhite::Lamp}, {"image", PreviewWhite::Image}, {"none", PreviewWhite::None}};
    constexpr double kMostStops = 20.0;
    const OptionGroup group(app, "Preview");
    app.add_option("--preview-white",
                   options.white,
                   "Show as grey the lamps' own light (lamp, the default), the image's mean "
                   "(image), or equal signals (none)")
        ->transform(word_of(kWhites))
        ->type_name("lamp|image|none");
    app.add_option("--preview-stops", options.stops, "Brighten the preview by 2^STOPS")
        ->check(in_range(-kMostStops, kMostStops))
        ->option_text("STOPS")
        ->capture_default_str();
}

void add_povray_options(CLI::App& app, std::string& povray, double& stall_timeout_s) {
    constexpr double kLeast_s = 0.5;
    constexpr double kMost_s = 1e6;
    const OptionGroup group(app, kPovRayOptions);
    app.add_option("--povray",
                   povray,
                   "Run this POV-Ray; by default $APHOTIC_POVRAY, or `povray` on the path")
        ->type_name("PROGRAM");
    app.add_option("--stall-timeout",
                   stall_timeout_s,
                   "Stop POV-Ray after S seconds without output or processor time")
        ->check(in_range(kLeast_s, kMost_s))
        ->option_text("S")
        ->capture_default_str();
}

void add_wavelength_options(CLI::App& app, PlanningOptions& options) {
    constexpr int kMostFitted = 48;
    constexpr int kMostBands = 100000;
    constexpr double kLeastPath_m = 1e-6;
    constexpr double kMostPath_m = 1e6;
    add_rig(app, options.rig_file);
    add_strict_option(app, options.strict);
    const OptionGroup group(app, kWavelengthOptions);
    auto* tolerance =
        app.add_option(
               "--tolerance",
               options.tolerance,
               "Largest relative error of any pixel's signal; fit as few wavelengths as keep it")
            ->check(in_range(0.0, 1.0))
            ->option_text("E")
            ->capture_default_str();
    auto* fitted =
        app.add_option(
               "--fitted", options.fitted, "Fit N wavelengths instead, whatever their error")
            ->check(in_range(1, kMostFitted))
            ->excludes(tolerance);
    auto* bands =
        app.add_option(
               "--bands",
               options.bands,
               "Split the camera's range into N equal bands instead, each sampled at its middle")
            ->check(in_range(1, kMostBands))
            ->excludes(tolerance)
            ->excludes(fitted);
    app.add_option("--wavelengths",
                   options.wavelengths_nm,
                   "Use these wavelengths (nm) instead, such as 478,576,638, and fit their weights")
        ->delimiter(',')
        ->excludes(bands)
        ->excludes(fitted)
        ->excludes(tolerance)
        ->option_text("LIST");
    app.add_option("--paths-m",
                   options.paths_m,
                   "Plan for paths of FROM to TO metres, lamp to floor to camera, such as 2,16: "
                   "one plan for several rigs. By default the paths that the rig sees")
        ->delimiter(',')
        ->expected(2)
        ->check(in_range(kLeastPath_m, kMostPath_m))
        ->option_text("FROM,TO");
    add_model_tolerance(app, options.model_tolerance);
}

void add_planning_options(CLI::App& app, PlanningOptions& options) {
    constexpr int kMostLamps = 64;
    constexpr int kMostAntialias = 9;
    constexpr int kMostVeilSamples = 100'000;
    constexpr double kMostShift_px = 100.0;
    constexpr double kMostClock = 1e6;
    add_wavelength_options(app, options);
    options.renders = true;
    const OptionGroup group(app, kWavelengthOptions);
    app.add_option("--per-frame", options.per_frame, "Render up to N wavelengths in one frame")
        ->check(in_range(1, 3))
        ->capture_default_str();
    app.add_option("--pixel-shift",
                   options.pixel_shift,
                   "Behind a port, let wavelengths share a frame if they land within PX pixels of "
                   "each other at the image's corner")
        ->check(in_range(0.0, kMostShift_px))
        ->option_text("PX")
        ->capture_default_str();
    app.option_defaults()->group(kSceneOptions);
    app.add_option("--scene",
                   options.scene,
                   "Render this scene, which includes aphotic.inc, instead of the rig's bare "
                   "floor; by default what the rig's `scene` names")
        ->type_name("FILE.pov");
    app.add_option("--library-path",
                   options.library_paths,
                   "Look for the scene's includes here too; repeatable")
        ->type_name("DIR");
    app.add_option("--clock",
                   options.clock,
                   "Set POV-Ray's clock in the scene; run once per animation frame")
        ->check(in_range(-kMostClock, kMostClock))
        ->option_text("C")
        ->capture_default_str();
    app.add_flag("--unchecked",
                 options.unchecked,
                 "Render a scene with radiosity, photons or its own media anyway; the result has "
                 "no error bound");
    app.option_defaults()->group(kPovRayOptions);
    app.add_option("--veil",
                   options.veil,
                   "What makes the light that the water scatters into the view: quadrature, or "
                   "povray, slow and with shadows in it")
        ->check(CLI::IsMember(std::vector<std::string>(kVeilMakers.begin(), kVeilMakers.end())))
        ->option_text("HOW")
        ->capture_default_str();
    app.add_option("--veil-samples",
                   options.veil_samples,
                   "With --veil povray, take N samples along each piece of a ray")
        ->check(in_range(1, kMostVeilSamples))
        ->capture_default_str();
    app.add_option("--antialias",
                   options.antialias,
                   "Trace N x N extra rays through each pixel: smooths edges, which then differ "
                   "from the reference; takes N x N times as long")
        ->check(in_range(0, kMostAntialias));
    app.add_option_function<std::string>(
           "--frame-format",
           [&options](const std::string& name) {
               options.format =
                   name == kFrameFormatNames.front() ? FrameFormat::Exr : FrameFormat::Png16;
           },
           "Let POV-Ray write frames as exr, or as png16 where it was built without OpenEXR: that "
           "clips, and dark corners have fewer digits")
        ->check(CLI::IsMember(
            std::vector<std::string>(kFrameFormatNames.begin(), kFrameFormatNames.end())))
        ->option_text("FORMAT")
        ->default_str(std::string(kFrameFormatNames.front()));
    app.add_option("--emitter-lamps",
                   options.emitter_lamps,
                   "Model an emitter as this many point lamps, such as 4,2; by default as many as "
                   "its distance requires")
        ->delimiter(',')
        ->expected(2)
        ->check(in_range(1, kMostLamps))
        ->option_text("ACROSS,ALONG");
    app.add_option("--povray-ini",
                   options.povray_ini,
                   "Pass on a POV-Ray setting that affects speed alone, such as Bounding_Method=2; "
                   "repeatable")
        ->type_name("KEY=VALUE");
    add_povray_options(app, options.povray, options.stall_timeout_s);
}

}  // namespace aphotic::cli
