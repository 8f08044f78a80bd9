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

int most_cores = 0;  // 0: --jobs was not given

}  // namespace

int all_cores() {
    const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    return most_cores > 0 ? std::min(cores, most_cores) : cores;
}

void take_no_more_cores_than(int jobs) {
    most_cores = jobs;
}

void add_rig(CLI::App& app, std::string& file) {
    add_option(app, "RIG", file)->required();
}

CLI::Option* add_share(CLI::App& app, const std::string& name, WorkShare& share) {
    return add_read(app, name, share, parse_share);
}

void add_json(CLI::App& app, bool& json) {
    add_flag(app, "--json", json);
}

void add_preview_options(CLI::App& app, PreviewOptions& options) {
    static const std::map<std::string, PreviewWhite> kWhites{
        {"lamp", PreviewWhite::Lamp}, {"image", PreviewWhite::Image}, {"none", PreviewWhite::None}};
    constexpr double kMostStops = 20.0;
    const OptionGroup group(app, "Preview");
    add_option(app, "--preview-white", options.white)->transform(word_of(kWhites));
    add_option(app, "--preview-stops", options.stops)->check(in_range(-kMostStops, kMostStops));
}

void add_povray_options(CLI::App& app, std::string& povray, double& stall_timeout_s) {
    constexpr double kLeast_s = 0.5;
    constexpr double kMost_s = 1e6;
    const OptionGroup group(app, kPovRayOptions);
    add_option(app, "--povray", povray);
    add_option(app, "--stall-timeout", stall_timeout_s)->check(in_range(kLeast_s, kMost_s));
}

void add_wavelength_options(CLI::App& app, PlanningOptions& options) {
    add_rig(app, options.rig_file);
    add_strict_option(app, options.strict);
    const OptionGroup group(app, kWavelengthOptions);
    auto* tolerance =
        add_option(app, "--tolerance", options.plan.tolerance)->check(in_range(0.0, 1.0));
    auto* fitted = add_option(app, "--fitted", options.plan.fitted)
                       ->check(in_range(1, kMostFitted))
                       ->excludes(tolerance);
    auto* bands = add_option(app, "--bands", options.plan.bands)
                      ->check(in_range(1, kMostBands))
                      ->excludes(tolerance)
                      ->excludes(fitted);
    add_option(app, "--wavelengths", options.plan.wavelengths_nm)
        ->delimiter(',')
        ->excludes(bands)
        ->excludes(fitted)
        ->excludes(tolerance);
    add_range(app, "--paths-m", options.paths_m, in_range(kLeastPath_m, kMostPath_m));
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
    add_option(app, "--per-frame", options.plan.scene.wavelengths_per_frame)->check(in_range(1, 3));
    add_option(app, "--pixel-shift", options.plan.scene.pixel_shift)
        ->check(in_range(0.0, kMostShift_px));
    app.option_defaults()->group(kSceneOptions);
    add_option(app, "--scene", options.scene);
    add_option(app, "--library-path", options.library_paths);
    add_option(app, "--clock", options.clock)->check(in_range(-kMostClock, kMostClock));
    add_flag(app, "--unchecked", options.unchecked);
    app.option_defaults()->group(kPovRayOptions);
    add_option(app, "--veil", options.veil)
        ->check(CLI::IsMember(std::vector<std::string>(kVeilMakers.begin(), kVeilMakers.end())));
    add_option(app, "--veil-samples", options.veil_samples)->check(in_range(1, kMostVeilSamples));
    add_option(app, "--antialias", options.plan.scene.antialias)
        ->check(in_range(0, kMostAntialias));
    const auto take_format = [&options](const std::string& name) {
        const bool is_exr = name == kFrameFormatNames.front();
        options.plan.scene.format = is_exr ? FrameFormat::Exr : FrameFormat::Png16;
    };
    add_option_function<std::string>(app, "--frame-format", take_format)
        ->check(CLI::IsMember(
            std::vector<std::string>(kFrameFormatNames.begin(), kFrameFormatNames.end())));
    add_option(app, "--emitter-lamps", options.emitter_lamps)
        ->delimiter(',')
        ->expected(2)
        ->check(in_range(1, kMostLamps));
    add_option(app, "--povray-ini", options.povray_ini);
    add_povray_options(app, options.povray, options.stall_timeout_s);
}

}  // namespace aphotic::cli
