// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/scene_survey.h"

#include "plugin/full_disk.h"
#include "plugin/interruption.h"
#include "plugin/library_paths.h"
#include "plugin/povray_log.h"
#include "plugin/process.h"
#include "plugin/scratch_folder.h"
#include "scene_gen/exposure.h"
#include "scene_gen/include_library.h"
#include "scene_gen/pov_scene.h"
#include "spectral/atomic_file.h"
#include "spectral/digest.h"
#include "spectral/error.h"
#include "spectral/exr.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <list>
#include <optional>
#include <set>
#include <thread>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

// What the scene asked for, as aphotic.inc tells it.
struct Asked {
    std::set<std::string> reflectances;
    std::set<std::string> lamps;
    bool has_water = false;
    bool has_camera = false;
    bool has_other_camera = false;
    bool has_port = false;
    int strobes = 0;
    int lights = 0;      // of ours, as it is called for them
    int all_lights = 0;  // as POV-Ray counts them
    // Of its statistics.
    bool has_radiosity = false;
    bool has_photons = false;
    bool has_media = false;
};

// The planes of a frame.
struct Picture {
    std::vector<float> red, green, blue;
};

class Survey {
  public:
    Survey(const PovRay& povray,
           const Rig& rig,
           const fs::path& scene_file,
           const SurveyOptions& options);
    UserScene run();

  private:
    struct Task {
        std::string name;
        SurveyFrame frame;
    };
    struct Running {
        Task task;
        Process process;
    };
    using Lit = std::vector<UserScene::Lit>;  // by pixel, of one strobe

    void scale_measurement();
    [[nodiscard]] fs::path file_of(const Task& task, const char* ending) const {
        return folder_.path() / (task.name + ending);
    }
    [[nodiscard]] ProcessRequest request_for(const Task& task) const;
    void require_success(const Task& task, const ProcessEnd& end) const;
    [[nodiscard]] std::optional<ProcessEnd> poll(Running& running) const;
    void run_tasks(const std::vector<Task>& tasks);
    [[nodiscard]] Picture picture_of(const Task& task) const;
    [[nodiscard]] Task plain_task() const;
    [[nodiscard]] Asked read_scene();
    void require_ours(const Asked& asked) const;
    void require_rigs_lamps(const Asked& asked) const;
    void require_what_is_bounded(const Asked& asked);
    void require_light_of_ours();
    void require_water_in_view(const Picture& through_water, const Picture& bare) const;
    void measure(int strobes);
    bool take_in(const Picture& picture, const SurveyFrame& frame, Lit& lit);
    void put_together(const std::vector<Lit>& strobes);

    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(fmt::format("{}: {}", scene_.file.string(), what));
    }

    const PovRay& povray_;
    const Rig& rig_;
    const SurveyOptions& options_;
    ScratchFolder folder_;
    UserScene scene_;
    int width_px_ = 1;
    int height_px_ = 1;
    bool has_water_ = false;
    bool is_too_bright_ = false;  // somewhere, for the exposure tried last
    double attenuation_per_m_ = 1.0;
    int exposure_log2_ = 0;
    std::string measured_;  // all samples, for the digest
};

// POV-Ray takes no other letters in the name of a file that it is to include.
bool is_plain_name(const std::string& name) {
    return std::ranges::all_of(
        name, [](unsigned char c) { return c >= ' ' && c < 0x7F && c != '"' && c != '\\'; });
}

Survey::Survey(const PovRay& povray,
               const Rig& rig,
               const fs::path& scene_file,
               const SurveyOptions& options)
    : povray_(povray), rig_(rig), options_(options) {
    scene_.file = fs::absolute(scene_file).lexically_normal();
    if (!fs::is_regular_file(scene_.file)) {
        throw InputError(
            fmt::format("{}: found no such file; allowed: a POV-Ray scene", scene_file.string()));
    }
    if (!is_plain_name(scene_.file.filename().string())) {
        refuse(
            "found a name that POV-Ray cannot include; allowed: ASCII letters, digits, blanks, and "
            "signs other than \" and \\");
    }
    scene_.files_digest = digest_of_scene(scene_.file);
    for (const IncludeFile& file : include_library()) {
        write_text_file(folder_.path() / file.name, std::string(file.text));
    }
    write_text_file(folder_.path() / "survey.ini", render_ini(rig_));
    const int longer = std::max(rig_.camera.width_px, rig_.camera.height_px);
    const auto scaled = [&](int size_px) {
        return std::max(1, std::min(size_px, size_px * kSurveyPixels / longer));
    };
    width_px_ = scaled(rig_.camera.width_px);
    height_px_ = scaled(rig_.camera.height_px);
    scale_measurement();
}

UserScene Survey::run() {
    const Asked asked = read_scene();
    require_ours(asked);
    require_rigs_lamps(asked);
    has_water_ = asked.has_water && !rig_.water.is_clear();
    const std::vector<std::string> names(asked.reflectances.begin(), asked.reflectances.end());
    scene_.materials = scene_materials(names, rig_, scene_.file);
    require_what_is_bounded(asked);
    require_light_of_ours();
    measure(asked.strobes);
    require_unchanged(scene_.file, scene_.files_digest);
    // What no listing of files finds, the pictures show.
    scene_.digest = sha256_of_text(scene_.files_digest + sha256_of_text(measured_));
    return std::move(scene_);
}

// By the rig's own floor: one e-folding over its longest path, and a peak of 2^6, in the middle of
// what half floats hold.
void Survey::scale_measurement() {
    constexpr int kPeakLog2 = 6;
    const PathRange paths = path_range(rig_);
    if (paths.longest_m > 0.0) attenuation_per_m_ = 1.0 / paths.longest_m;
    Rig clear = rig_;
    clear.water.multiple = 0.0;
    clear.water.uniform_loss_per_m = 0.0;
    const double middle_nm = 0.5 * (rig_.camera.range.first_nm + rig_.camera.range.last_nm);
    const double flux = rig_.strobes.front().spectrum.at(middle_nm);
    const double reflectance = rig_.seafloor.reflectance.at(middle_nm);
    const double radiance = RadianceBound(clear).at(middle_nm);
    if (radiance > 0.0 && flux * reflectance > 0.0) {
        exposure_log2_ = exposure_log2(radiance / (flux * reflectance), 1.0, kPeakLog2);
    }
}

// --- Running POV-Ray ----------------------------------------------------------------------------

ProcessRequest Survey::request_for(const Task& task) const {
    std::vector<std::string> arguments{path_option("+I", file_of(task, ".pov")),
                                       path_option("+O", file_of(task, ".exr")),
                                       path_option("+L", folder_.path()),
                                       fmt::format("+W{}", width_px_),
                                       fmt::format("+H{}", height_px_),
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
            .log = file_of(task, ".log"),
            .stall_s = options_.stall_s};
}

void Survey::require_success(const Task& task, const ProcessEnd& end) const {
    if (end.succeeded()) return;
    const std::string said = error_in_log(read_log(file_of(task, ".log")));
    const std::string message = fmt::format("POV-Ray cannot read {} ({}){}{}",
                                            scene_.file.string(),
                                            end.words(),
                                            said.empty() ? "" : ":\n",
                                            said);
    // The scene's fault when the parser says so, POV-Ray's otherwise.
    if (said.find("Parse Error") != std::string::npos) throw InputError(message);
    throw RunError(message + words_of_full_disk(folder_.path()));
}

std::optional<ProcessEnd> Survey::poll(Running& running) const {
    try {
        return running.process.poll();
    } catch (const RunError& error) {
        throw RunError(fmt::format("{}: {}", scene_.file.string(), error.what()));
    }
}

void Survey::run_tasks(const std::vector<Task>& tasks) {
    std::list<Running> running;
    std::size_t started = 0;
    std::size_t done = 0;
    while (done < tasks.size()) {
        throw_if_interrupted();
        while (started < tasks.size() && running.size() < static_cast<std::size_t>(options_.jobs)) {
            const Task& task = tasks[started++];
            write_text_file(file_of(task, ".pov"),
                            survey_sdl(rig_, scene_.file.filename().string(), task.frame));
            running.push_back({.task = task, .process = Process(request_for(task))});
        }
        for (auto at = running.begin(); at != running.end();) {
            const std::optional<ProcessEnd> end = poll(*at);
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

Picture Survey::picture_of(const Task& task) const {
    const auto pixels = static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_);
    const std::array<std::string, 3> channels{"R", "G", "B"};
    std::vector<float> samples(channels.size() * pixels);
    ExrReader(file_of(task, ".exr")).read_rows(0, height_px_, channels, samples);
    const auto plane = [&](std::size_t c) {
        const auto first = samples.begin() + static_cast<std::ptrdiff_t>(c * pixels);
        return std::vector<float>(first, first + static_cast<std::ptrdiff_t>(pixels));
    };
    return {.red = plane(0), .green = plane(1), .blue = plane(2)};
}

// --- What the scene asks for --------------------------------------------------------------------

// All strobes on, in clear water.
Survey::Task Survey::plain_task() const {
    return {.name = "plain", .frame = {.exposure_log2 = exposure_log2_}};
}

Asked Survey::read_scene() {
    const Task task = plain_task();
    run_tasks({task});
    Asked asked;
    for (const std::string& said : statements_in_log(read_log(file_of(task, ".log")))) {
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
        if (said.find("More than one camera") != std::string::npos) asked.has_other_camera = true;
        if (said.starts_with("aphotic: strobes ")) asked.strobes = number();
        if (said.starts_with("aphotic: lights ")) asked.lights = number();
        if (said.starts_with("Light Sources: ")) asked.all_lights = number();
        const auto counts = [&](std::string_view what) {
            return said.starts_with(what) && std::atoll(said.c_str() + what.size()) > 0;
        };
        asked.has_radiosity |= counts("Radiosity samples calculated:");
        asked.has_photons |= counts("Number of photons shot:");
        asked.has_media |= counts("Media Intervals:");
    }
    return asked;
}

void Survey::require_ours(const Asked& asked) const {
    if (asked.strobes == 0) {
        refuse(
            "found no strobe; allowed: Aphotic_Rig (), Aphotic_Rig_Strobes () or "
            "Aphotic_Strobe (...)");
    }
    if (!asked.has_camera || asked.has_other_camera) {
        refuse(
            fmt::format("found {}; allowed: Aphotic_Rig (), Aphotic_Rig_Camera () or "
                        "Aphotic_Camera (...), and no other",
                        asked.has_camera ? "a second camera" : "no camera of aphotic.inc"));
    }
    if (const int others = asked.all_lights - asked.lights; others != 0) {
        refuse(
            fmt::format("found {} no strobe of aphotic.inc; allowed: none, for such light has no "
                        "spectrum",
                        others == 1 ? "1 light source that is"
                                    : fmt::format("{} light sources that are", others)));
    }
    if (asked.lights > kMostLightsInMedia && !rig_.water.is_clear()) {
        refuse(fmt::format(
            "found {} cones of light; allowed: {}, which is what POV-Ray takes in water",
            asked.lights,
            kMostLightsInMedia));
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
}

void Survey::require_rigs_lamps(const Asked& asked) const {
    std::set<std::string> known;
    for (const Strobe& strobe : rig_.strobes) known.insert(short_name(strobe.spectrum));
    for (const std::string& lamp : asked.lamps) {
        if (known.contains(lamp)) continue;
        refuse(
            fmt::format("found the lamp \"{}\"; allowed: the spectra of the rig's strobes, \"{}\"",
                        lamp,
                        fmt::join(known, "\", \"")));
    }
}

// --- What its light is --------------------------------------------------------------------------

bool is_lit(float sample) {
    return sample > 0.0F;
}

// POV-Ray does not reckon with the water on the way from surface to surface, and draws samples
// where it gathers light.
void Survey::require_what_is_bounded(const Asked& asked) {
    const std::array<std::pair<bool, const char*>, 3> found{
        {{asked.has_radiosity, "radiosity"},
         {asked.has_photons, "photons"},
         {asked.has_media, "media of the scene's own"}}};
    for (const auto& [is_there, what] : found) {
        if (!is_there) continue;
        if (!options_.unchecked) {
            refuse(fmt::format(
                "found {}; allowed: none, for how far that is from the truth has no bound, or "
                "--unchecked, for an image without a promise",
                what));
        }
        scene_.no_promise.push_back(fmt::format("{}, which nothing bounds", what));
    }
}

// With all strobes off nothing may be bright; without water, channels differ by colours that are
// numbers; with water on the camera's leg alone, it must dim.
void Survey::require_light_of_ours() {
    const double K_per_m = attenuation_per_m_;
    const Task dark{.name = "dark", .frame = {.exposure_log2 = exposure_log2_, .only_strobe = -1}};
    const Task seen{.name = "seen",
                    .frame = {.attenuation_per_m = {K_per_m, K_per_m, K_per_m},
                              .exposure_log2 = exposure_log2_,
                              .dims_lamps = false}};
    run_tasks(has_water_ ? std::vector{dark, seen} : std::vector{dark});

    const Picture without = picture_of(dark);
    if (std::ranges::any_of(without.red, is_lit) || std::ranges::any_of(without.green, is_lit) ||
        std::ranges::any_of(without.blue, is_lit)) {
        refuse(
            "found light with all strobes off; allowed: none, for such light has no spectrum. Is "
            "there a finish with emission, a light_group, or a medium that glows?");
    }
    const Picture colours = picture_of(plain_task());
    if (colours.red != colours.green || colours.red != colours.blue) {
        scene_.no_promise.emplace_back(
            "colours by numbers, each another grey in every channel and no spectrum; "
            "Aphotic_Pigment gives it one");
    }
    if (has_water_ && std::ranges::any_of(colours.green, is_lit)) {
        require_water_in_view(picture_of(seen), colours);
    }
}

void Survey::require_water_in_view(const Picture& through_water, const Picture& bare) const {
    for (std::size_t i = 0; i < bare.green.size(); ++i) {
        if (is_lit(bare.green[i]) && through_water.green[i] < bare.green[i]) return;
    }
    refuse(
        "found no water between the camera and what it sees; allowed: a camera outside any object, "
        "or in a hollow one");
}

// Fills in what is not known yet of each pixel. Whether something is still to be known.
bool Survey::take_in(const Picture& picture, const SurveyFrame& frame, Lit& lit) {
    const double any_path_m = has_water_ ? 0.0 : path_range(rig_).shortest_m;
    bool is_missing = false;
    for (std::size_t i = 0; i < lit.size(); ++i) {
        const double bare = picture.red[i];
        const double dimmed = picture.green[i];
        const double raised = picture.blue[i];
        if (!(bare > 0.0)) continue;  // unlit, or behind everything
        UserScene::Lit& pixel = lit[i];
        is_too_bright_ |= !std::isfinite(bare);
        if (std::isfinite(bare) && pixel.radiance_per_flux == 0.0) {
            pixel.radiance_per_flux = std::ldexp(bare, -frame.exposure_log2);
        }
        if (pixel.path_m == 0.0) {
            const bool is_within = dimmed > 0.0 && std::isfinite(raised) && raised > dimmed;
            pixel.path_m = is_within ? measured_path_m(dimmed, raised, frame.attenuation_per_m[1])
                                     : any_path_m;
        }
        is_missing |= pixel.path_m == 0.0 || pixel.radiance_per_flux == 0.0;
    }
    return is_missing;
}

// A strobe is measured again where pixels were brighter than half floats hold, with less light, or
// their paths too long for the loss that was tried, with less loss.
void Survey::measure(int strobes) {
    constexpr int kMostTries = 6;
    constexpr double kLessLoss = 8.0;
    constexpr int kLessLightLog2 = 10;
    std::vector<Lit> lit(
        static_cast<std::size_t>(strobes),
        Lit(static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_)));
    std::vector<int> open;
    for (int s = 1; s <= strobes; ++s) open.push_back(s);
    double K_per_m = attenuation_per_m_;
    int exposure = exposure_log2_;
    for (int attempt = 0; attempt < kMostTries && !open.empty(); ++attempt) {
        std::vector<Task> tasks;
        for (const int s : open) {
            tasks.push_back({.name = fmt::format("strobe_{}_{}", s, attempt),
                             .frame = {.attenuation_per_m = {0.0, K_per_m, -K_per_m},
                                       .exposure_log2 = exposure,
                                       .only_strobe = s}});
        }
        run_tasks(tasks);
        std::vector<int> still_open;
        is_too_bright_ = false;
        for (const Task& task : tasks) {
            const Picture picture = picture_of(task);
            for (const auto* plane : {&picture.red, &picture.green, &picture.blue}) {
                measured_.append(reinterpret_cast<const char*>(plane->data()),
                                 plane->size() * sizeof(float));
            }
            const int s = task.frame.only_strobe;
            if (take_in(picture, task.frame, lit[static_cast<std::size_t>(s - 1)])) {
                still_open.push_back(s);
            }
        }
        open = std::move(still_open);
        if (is_too_bright_) {
            exposure -= kLessLightLog2;
        } else {
            K_per_m /= kLessLoss;
        }
    }
    put_together(lit);
}

void Survey::put_together(const std::vector<Lit>& strobes) {
    bool is_any_lit = false;
    scene_.pixels.resize(strobes.front().size());
    for (const Lit& lit : strobes) {
        for (std::size_t i = 0; i < lit.size(); ++i) {
            is_any_lit |= lit[i].radiance_per_flux > 0.0;
            if (lit[i].path_m > 0.0) scene_.pixels[i].push_back(lit[i]);
        }
    }
    scene_.paths = paths_of(scene_.pixels);
    if (scene_.paths.longest_m > 0.0) return;
    refuse(
        is_any_lit
            ? "found light that no water dims; allowed: water on its way. Are camera and strobes "
              "inside an object that is not hollow?"
            : "found nothing in view that a strobe lights; allowed: a scene with something to see. "
              "Is the camera where it should be? plain povray shows it");
}

}  // namespace

UserScene survey_scene(const PovRay& povray,
                       const Rig& rig,
                       const fs::path& scene_file,
                       const SurveyOptions& options) {
    return Survey(povray, rig, scene_file, options).run();
}

}  // namespace aphotic
