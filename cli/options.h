// SPDX-License-Identifier: BSD-3-Clause
//
// Options that several commands share, each declared once. An option's first long name is the one
// in --help; the others are those of version 0.1.
#pragma once

#include "base/number.h"
#include "base/work_folder.h"
#include "cli/model_error.h"
#include "cli/option_words.h"
#include "image/preview.h"
#include "plugin/povray.h"
#include "rig/rig.h"
#include "scene_gen/render_plan.h"

#include <CLI/CLI.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace aphotic::cli {

// The number of threads that the command may use: one per core, or fewer by --jobs once that is
// parsed.
[[nodiscard]] int all_cores();
void take_no_more_cores_than(int jobs);

// Options added during its lifetime are listed under this heading of --help.
class OptionGroup {
  public:
    OptionGroup(CLI::App& app, const std::string& name) : app_(app) {
        app.option_defaults()->group(name);
    }
    ~OptionGroup() { app_.option_defaults()->group("Options"); }
    OptionGroup(const OptionGroup&) = delete;
    OptionGroup& operator=(const OptionGroup&) = delete;

  private:
    CLI::App& app_;
};

void add_rig(CLI::App& app, std::string& file);
void add_json(CLI::App& app, bool& json);

template <typename Path>
CLI::Option* add_output_folder(CLI::App& app, Path& folder) {
    return add_option(app, "--output", folder);
}

template <typename Count>
void add_jobs(CLI::App& app, Count& jobs) {
    constexpr int kMostJobs = 1024;
    add_option(app, "--jobs", jobs)
        ->check(in_range(1, kMostJobs))
        ->each([](const std::string& text) {
            if (const auto most = read_number<int>(text)) take_no_more_cores_than(*most);
        });
}

// LEAST,MOST, the lower first; where one number is enough, it is both.
template <typename Range>
CLI::Option* add_range(CLI::App& app,
                       const std::string& name,
                       Range& range,
                       const CLI::Validator& allowed,
                       int least_count = 2) {
    const auto take = [&range, name](const std::vector<double>& ends) {
        if (ends.front() > ends.back()) {
            throw CLI::ValidationError(
                name,
                fmt::format("found {},{}; allowed: the lower first", ends.front(), ends.back()));
        }
        range = {ends.front(), ends.back()};
    };
    return add_option_function<std::vector<double>>(app, name, take)
        ->delimiter(',')
        ->expected(least_count, 2)
        ->check(allowed);
}

// I/N, of work shared with other machines.
CLI::Option* add_share(CLI::App& app, const std::string& name, WorkShare& share);

void add_preview_options(CLI::App& app, PreviewOptions& options);

// The method for the veil of water that scatters.
inline constexpr std::array kVeilMakers{"quadrature", "povray"};

struct PlanningOptions {
    std::string rig_file;
    PlanRequest plan{};  // except fields that request_of() of planning.cpp sets
    std::vector<double> paths_m;
    std::vector<int> emitter_lamps;
    bool renders = false;  // otherwise a scene that the rig names is ignored
    std::string scene;
    std::vector<std::string> library_paths;
    bool unchecked = false;
    double clock = 0.0;
    std::optional<Sled> sled{};           // instead of the rig's
    std::vector<std::string> declared{};  // numbers for the probe, NAME=NUMBER
    std::string veil{kVeilMakers.front()};
    int veil_samples = kVeilSamples;
    std::vector<std::string> povray_ini;
    std::string povray;
    bool ignore_needs = false;
    double stall_timeout_s = kStall_s;
    double model_tolerance = kModelTolerance;
    bool strict = false;
};

// The POV-Ray executable, and the longest time without output.
void add_povray_options(CLI::App& app, std::string& povray, double& stall_timeout_s);

// The rig and its wavelengths, without POV-Ray.
void add_wavelength_options(CLI::App& app, PlanningOptions& options);

// These, and POV-Ray's settings for rendering.
void add_planning_options(CLI::App& app, PlanningOptions& options);

}  // namespace aphotic::cli
