// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/scene_survey.h"

#include "plugin/library_paths.h"
#include "plugin/povray_log.h"
#include "plugin/process.h"
#include "plugin/scratch_folder.h"
#include "scene_gen/exposure.h"
#include "scene_gen/include_library.h"
#include "scene_gen/pov_scene.h"
#include "spectral/atomic_file.h"
#include "spectral/error.h"
#include "spectral/exr.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <list>
#include <optional>
#include <set>
#include <system_error>
#include <thread>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr auto kPollInterval = std::chrono::milliseconds(20);

// What the scene asked for, as aphotic.inc tells it.
struct Asked {
    std::set<std::string> reflectances;
    std::set<std::string> lamps;
    bool has_water = false;
    bool has_camera = false;
    bool has_port = false;
    int strobes = 0;
    int lights = 0;      // of ours
    int all_lights = 0;  // as POV-Ray counts them
};

class Survey {
  public:
    Survey(const PovRay& povray,
           const Rig& rig,
           const fs::path& scene_file,
           const SurveyOptions& options)
        : povray_(povray), rig_(rig), options_(options) {
        scene_.file = fs::absolute(scene_file).lexically_normal();
        if (!fs::is_regular_file(scene_.file)) {
            throw InputError(fmt::format("{}: found no such file; allowed: a POV-Ray scene",
                                         scene_file.string()));
        }
        for (const IncludeFile& file : include_library()) {
            write_text_file(folder_.path() / file.name, std::string(file.text));
        }
        scale_measurement();
    }

    UserScene run() {
        scene_.digest = digest_of_scene(scene_.file);
        const Asked asked = read_scene();
        require_ours(asked);
        has_water_ = asked.has_water;
        const std::vector<std::string> names(asked.reflectances.begin(), asked.reflectances.end());
        scene_.materials = scene_materials(names, rig_, scene_.file);
        measure(asked.strobes);
        return std::move(scene_);
    }

  private:
    struct Task {
        std::string name;
        int only_strobe;  // 0: all
        int width_px;
        int height_px;
    };
    struct Running {
        Task task;
        Process process;
    };

    void scale_measurement();
    [[nodiscard]] fs::path file_of(const Task& task, const char* ending) const {
        return folder_.path() / (task.name + ending);
    }
    [[nodiscard]] ProcessRequest request_for(const Task& task) const;
    void require_success(const Task& task, const ProcessEnd& end) const;
    void run_tasks(const std::vector<Task>& tasks);
    [[nodiscard]] Asked read_scene();
    void require_ours(const Asked& asked) const;
    void measure(int strobes);
    [[nodiscard]] std::vector<UserScene::Lit> lit_in(const Task& task) const;

    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(fmt::format("{}: {}", scene_.file.string(), what));
    }

    const PovRay& povray_;
    const Rig& rig_;
    const SurveyOptions& options_;
    ScratchFolder folder_;
    UserScene scene_;
    bool has_water_ = false;
    double attenuation_per_m_ = 1.0;
    int exposure_log2_ = 0;
};

// By the rig's own floor: one e-folding over its longest path, and a peak of 2^6, in the middle of
// what half floats hold. A scene may be a thousand times as bright or dark.
void Survey::scale_measurement() {
    constexpr int kPeakLog2 = 6;
    const PathRange paths = path_range(rig_);
    if (paths.longest_m > 0.0) attenuation_per_m_ = 1.0 / paths.longest_m;
    Rig white = rig_;
    white.water.multiple = 0.0;
    white.water.uniform_loss_per_m = 0.0;
    const double middle_nm = 0.5 * (rig_.camera.range.first_nm + rig_.camera.range.last_nm);
    const double flux = rig_.strobes.front().spectrum.at(middle_nm);
    const double reflectance = rig_.seafloor.reflectance.at(middle_nm);
    const double radiance = RadianceBound(white).at(middle_nm);
    if (radiance > 0.0 && flux * reflectance > 0.0) {
        exposure_log2_ = exposure_log2(radiance / (flux * reflectance), 1.0, kPeakLog2);
    }
}

ProcessRequest Survey::request_for(const Task& task) const {
    std::vector<std::string> arguments{path_option("+I", file_of(task, ".pov")),
                                       path_option("+O", file_of(task, ".exr")),
                                       path_option("+L", folder_.path()),
                                       fmt::format("+W{}", task.width_px),
                                       fmt::format("+H{}", task.height_px),
                                       "+WT1",
                                       "+GS"};
    for (const std::string& path : options_.library_paths) {
        arguments.push_back(path_option("+L", fs::absolute(path)));
    }
    for (const std::string& path : library_paths(scene_.file.parent_path(), povray_.version)) {
        arguments.push_back(path_option("+L", path));
    }
    return {.executable = povray_.executable,
            .arguments = std::move(arguments),
            .folder = scene_.file.parent_path(),
            .environment = {{"POVINI", (folder_.path() / "survey.ini").string()}},
            .log = file_of(task, ".log")};
}

void Survey::require_success(const Task& task, const ProcessEnd& end) const {
    if (end.succeeded()) return;
    const std::string said = error_in_log(read_text_file(file_of(task, ".log")));
    // The scene's fault when its parser says so, POV-Ray's otherwise.
    const std::string message = fmt::format("POV-Ray cannot read {} ({}){}{}",
                                            scene_.file.string(),
                                            end.words(),
                                            said.empty() ? "" : ":\n",
                                            said);
    if (said.find("Parse Error") != std::string::npos) throw InputError(message);
    throw RunError(message);
}

void Survey::run_tasks(const std::vector<Task>& tasks) {
    write_text_file(folder_.path() / "survey.ini", render_ini(rig_));
    std::list<Running> running;
    std::size_t started = 0;
    std::size_t done = 0;
    while (done < tasks.size()) {
        while (started < tasks.size() && running.size() < static_cast<std::size_t>(options_.jobs)) {
            const Task& task = tasks[started++];
            write_text_file(file_of(task, ".pov"),
                            survey_sdl(rig_,
                                       scene_.file.filename().string(),
                                       {.attenuation_per_m = attenuation_per_m_,
                                        .exposure_log2 = exposure_log2_,
                                        .only_strobe = task.only_strobe}));
            running.push_back({.task = task, .process = Process(request_for(task))});
        }
        for (auto at = running.begin(); at != running.end();) {
            const std::optional<ProcessEnd> end = at->process.poll();
            if (!end) {
                ++at;
                continue;
            }
            require_success(at->task, *end);
            at = running.erase(at);
            ++done;
            if (options_.progress) {
                options_.progress(static_cast<double>(done) / static_cast<double>(tasks.size()));
            }
        }
        std::this_thread::sleep_for(kPollInterval);
    }
}

Asked Survey::read_scene() {
    constexpr int kFew = 8;
    const Task task{.name = "scene", .only_strobe = 0, .width_px = kFew, .height_px = kFew};
    run_tasks({task});
    Asked asked;
    for (const std::string& said : statements_in_log(read_text_file(file_of(task, ".log")))) {
        const auto quoted = [&] {
            const std::size_t first = said.find('"');
            return said.substr(first + 1, said.rfind('"') - first - 1);
        };
        const auto number = [&] { return std::atoi(said.substr(said.rfind(' ') + 1).c_str()); };
        if (said.starts_with("aphotic: reflectance \"")) asked.reflectances.insert(quoted());
        if (said.starts_with("aphotic: lamp \"")) asked.lamps.insert(quoted());
        if (said == "aphotic: water") asked.has_water = true;
        if (said == "aphotic: camera") asked.has_camera = true;
        if (said == "aphotic: port") asked.has_port = true;
        if (said.starts_with("aphotic: strobes ")) asked.strobes = number();
        if (said.starts_with("aphotic: lights ")) asked.lights = number();
        if (said.starts_with("Light Sources: ")) asked.all_lights = number();
    }
    return asked;
}

void Survey::require_ours(const Asked& asked) const {
    if (asked.strobes == 0) {
        refuse(
            "found no strobe; allowed: Aphotic_Rig (), Aphotic_Rig_Strobes () or Aphotic_Strobe "
            "(...)");
    }
    if (asked.all_lights != asked.lights) {
        refuse(
            fmt::format("found {} light sources that are no strobes of aphotic.inc; allowed: none, "
                        "for their light would have no spectrum",
                        asked.all_lights - asked.lights));
    }
    if (!asked.has_water && !rig_.water.is_clear()) {
        refuse(
            "found no water; allowed: Aphotic_Water () or Aphotic_Rig (), or a rig whose water is "
            "clear (multiple = 0)");
    }
    if (!asked.has_port && rig_.camera.port) {
        refuse(
            "found no port, and the rig has one; allowed: Aphotic_Rig (), Aphotic_Rig_Camera () or "
            "Aphotic_Port (...), or a rig without [camera.port]");
    }
    for (const std::string& lamp : asked.lamps) {
        std::vector<std::string> known;
        for (const Strobe& strobe : rig_.strobes) known.push_back(short_name(strobe.spectrum));
        if (std::ranges::find(known, lamp) != known.end()) continue;
        refuse(
            fmt::format("found the lamp \"{}\"; allowed: the spectra of the rig's strobes, \"{}\"",
                        lamp,
                        fmt::join(std::set(known.begin(), known.end()), "\", \"")));
    }
}

std::vector<UserScene::Lit> Survey::lit_in(const Task& task) const {
    const std::vector<std::string> channels{"R", "G", "B"};
    const auto pixels =
        static_cast<std::size_t>(task.width_px) * static_cast<std::size_t>(task.height_px);
    std::vector<float> samples(channels.size() * pixels);
    ExrReader(file_of(task, ".exr")).read_rows(0, task.height_px, channels, samples);
    std::vector<UserScene::Lit> lit(pixels);
    const double any_path_m = has_water_ ? 0.0 : path_range(rig_).shortest_m;
    for (std::size_t i = 0; i < pixels; ++i) {
        const double bare = samples[i];
        const double dimmed = samples[pixels + i];
        const double raised = samples[2 * pixels + i];
        if (!(bare > 0.0) || !std::isfinite(bare)) continue;
        lit[i].radiance_per_flux = std::ldexp(bare, -exposure_log2_);
        const bool is_within = dimmed > 0.0 && std::isfinite(raised) && raised > dimmed;
        // Without water a path has no length that would count: the rig's own stands for it.
        if (!has_water_) lit[i].path_m = any_path_m;
        // Beyond what half floats hold: not a path to plan for.
        if (has_water_ && is_within)
            lit[i].path_m = std::log(raised / dimmed) / (2.0 * attenuation_per_m_);
    }
    return lit;
}

void Survey::measure(int strobes) {
    const int longer = std::max(rig_.camera.width_px, rig_.camera.height_px);
    const auto scaled = [&](int size_px) {
        return std::max(1, std::min(size_px, size_px * kSurveyPixels / longer));
    };
    std::vector<Task> tasks;
    for (int s = 1; s <= strobes; ++s) {
        tasks.push_back({.name = fmt::format("strobe_{}", s),
                         .only_strobe = s,
                         .width_px = scaled(rig_.camera.width_px),
                         .height_px = scaled(rig_.camera.height_px)});
    }
    run_tasks(tasks);
    for (const Task& task : tasks) {
        const std::vector<UserScene::Lit> lit = lit_in(task);
        scene_.pixels.resize(lit.size());
        for (std::size_t i = 0; i < lit.size(); ++i) {
            if (lit[i].path_m > 0.0) scene_.pixels[i].push_back(lit[i]);
        }
    }
    scene_.paths = paths_of(scene_.pixels);
    if (scene_.paths.longest_m == 0.0) {
        refuse(
            "found nothing in view that a strobe lights; allowed: a scene with something to see. "
            "Is the camera where it should be? plain povray shows it");
    }
}

}  // namespace

UserScene survey_scene(const PovRay& povray,
                       const Rig& rig,
                       const fs::path& scene_file,
                       const SurveyOptions& options) {
    return Survey(povray, rig, scene_file, options).run();
}

}  // namespace aphotic
