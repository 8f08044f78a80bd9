// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/probe.h"

#include "base/atomic_file.h"
#include "base/disk_space.h"
#include "base/error.h"
#include "base/interruption.h"
#include "base/number.h"
#include "base/sha256.h"
#include "image/exr.h"
#include "plugin/library_paths.h"
#include "plugin/povray_log.h"
#include "plugin/process.h"
#include "plugin/scratch_folder.h"
#include "scene_gen/exposure.h"
#include "scene_gen/include_library.h"
#include "scene_gen/pov_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <thread>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

// The scene's requests, as reported by aphotic.inc.
struct Asked {
    std::set<std::string> reflectances;
    std::set<std::string> lamps;
    bool has_water = false;
    bool has_camera = false;
    bool has_other_camera = false;
    bool has_port = false;
    int strobes = 0;
    int lights = 0;      // ours, from the macros' calls
    int all_lights = 0;  // as counted by POV-Ray
    // From its statistics.
    bool has_radiosity = false;
    bool has_photons = false;
    bool has_media = false;
};

// The planes of a frame.
struct Picture {
    std::vector<float> red, green, blue;
};

// Runs of POV-Ray besides those for each strobe.
constexpr std::size_t kOnceForAll = 2;

// Pixels beyond half floats are measured again with this much less light.
constexpr int kMostTries = 8;
constexpr int kLessLightLog2 = 10;

// The number of strobes' pixels that an attempt left without a path or brightness, and why.
struct Unmeasured {
    std::size_t too_bright = 0;  // for half floats
    std::size_t too_far = 0;     // for the loss tried
    std::size_t too_near = 0;    // the loss has too little effect
    std::size_t too_faint = 0;   // for half floats

    [[nodiscard]] std::size_t not_faint() const { return too_bright + too_far + too_near; }
    [[nodiscard]] std::size_t count() const { return not_faint() + too_faint; }
};

// The files in a scene's folder, and the time when each was written.
std::map<fs::path, fs::file_time_type> written_files(const fs::path& folder) {
    std::map<fs::path, fs::file_time_type> files;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        if (entry.is_regular_file(ignored)) files[entry.path()] = entry.last_write_time(ignored);
    }
    return files;
}

// POV-Ray allows no other letters in the name of an included file.
bool is_plain_name(const std::string& name) {
    return std::ranges::all_of(
        name, [](unsigned char c) { return c >= ' ' && c < 0x7F && c != '"' && c != '\\'; });
}

bool is_lit(float sample) {
    return sample > 0.0F;
}

class SceneProbe {
  public:
    SceneProbe(const PovRay& povray,
               const Rig& rig,
               const fs::path& scene_file,
               const ProbeOptions& options)
        : povray_(povray), rig_(rig), options_(options) {
        scene_.file.path = fs::absolute(scene_file).lexically_normal();
        if (!fs::is_regular_file(scene_.file.path)) {
            throw InputError("{}: found no such file; allowed: a POV-Ray scene",
                             scene_file.string());
        }
        if (!is_plain_name(scene_.file.path.filename().string())) {
            refuse(
                "found a name that POV-Ray cannot include; allowed: ASCII letters, digits, spaces, "
                "and signs other than \" and \\");
        }
        scene_.file = scene_file_at(scene_.file.path);
        for (const IncludeFile& file : include_library()) {
            write_text_file(folder_.path() / file.name, std::string(file.text));
        }
        SceneOptions settings;
        settings.ini_lines = options_.ini_lines;
        write_text_file(folder_.path() / "probe.ini", render_ini(rig_, settings));
        const int longer = std::max(rig_.camera.width_px, rig_.camera.height_px);
        const auto scaled = [&](int size_px) {
            return std::max(1, std::min(size_px, size_px * kProbePixels / longer));
        };
        width_px_ = scaled(rig_.camera.width_px);
        height_px_ = scaled(rig_.camera.height_px);
        scale_measurement();
        tasks_known_ = kOnceForAll + rig_.strobes.size();
    }

    UserScene run() {
        const Asked asked = read_scene();
        require_ours(asked);
        require_rigs_lamps(asked);
        has_water_ = asked.has_water && !rig_.water.is_clear();
        const std::vector<std::string> names(asked.reflectances.begin(), asked.reflectances.end());
        scene_.materials = scene_materials(names, rig_, scene_.file.path);
        require_what_is_bounded(asked);
        tasks_known_ = tasks_done_ + kOnceForAll - 1 + static_cast<std::size_t>(asked.strobes);
        require_light_of_ours();
        measure(asked.strobes);
        require_unchanged(scene_.file);
        // Changes that no listing of files finds are visible in the pictures.
        scene_.digest = sha256_of_text(scene_.file.digest + sha256_of_text(measured_));
        return std::move(scene_);
    }

  private:
    struct Task {
        std::string name;
        ProbeFrame frame;
    };
    struct Running {
        Task task;
        Process process;
    };
    using Lit = std::vector<UserScene::Lit>;  // by pixel, of one strobe

    [[nodiscard]] fs::path file_of(const Task& task, const char* ending) const {
        return folder_.path() / (task.name + ending);
    }

    template <typename... T>
    [[noreturn]] void refuse(fmt::format_string<T...> what, T&&... with) const {
        throw InputError(
            "{}: {}", scene_.file.path.string(), fmt::format(what, std::forward<T>(with)...));
    }

    // From the rig's own floor: one e-folding over its longest path, and a peak of 2^6, in the
    // middle of the half floats' range.
    void scale_measurement() {
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

    // --- Running POV-Ray ------------------------------------------------------------------------

    [[nodiscard]] ProcessRequest request_for(const Task& task) const {
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
        for (const std::string& path :
             library_paths(scene_.file.path.parent_path(), povray_.version)) {
            arguments.push_back(path_option("+L", path));
        }
        return {.executable = povray_.executable,
                .arguments = std::move(arguments),
                .folder = scene_.file.path.parent_path(),
                .environment = {{"POVINI", (folder_.path() / "probe.ini").string()}},
                .log = file_of(task, ".log"),
                .stall_s = options_.stall_s};
    }

    // POV-Ray's messages without temporary files: the includes, and the lines around the scene,
    // where it detects unclosed parts of the scene.
    [[nodiscard]] std::string in_users_files(std::string said, const Task& task) const {
        const std::string around = fmt::format("File '{}' line ", file_of(task, ".pov").string());
        const std::string scene = scene_.file.path.filename().string();
        for (auto at = said.find(around); at != std::string::npos; at = said.find(around, at + 1)) {
            const auto digits = said.find_first_not_of("0123456789", at + around.size());
            said.replace(at, digits - at, fmt::format("At the end of '{}'", scene));
        }
        const std::string folder = folder_.path().string() + "/";
        for (auto at = said.find(folder); at != std::string::npos; at = said.find(folder, at)) {
            said.erase(at, folder.size());
        }
        return said;
    }

    void require_success(const Task& task, const ProcessEnd& end) const {
        if (end.succeeded()) return;
        const std::string said =
            in_users_files(error_in_log(read_log(file_of(task, ".log"))), task);
        const auto fail = [&]<typename Error>(const std::string& more) {
            throw Error("POV-Ray cannot read {} ({}){}{}{}",
                        scene_.file.path.string(),
                        end.words(),
                        said.empty() ? "" : ":\n",
                        said.c_str(),
                        more.c_str());
        };
        // The scene's fault if the parser reports it, POV-Ray's otherwise.
        if (said.find("Parse Error") != std::string::npos) fail.operator()<InputError>("");
        fail.operator()<RunError>(words_of_full_disk(folder_.path()));
    }

    [[nodiscard]] std::optional<ProcessEnd> poll(Running& running) const {
        try {
            return running.process.poll();
        } catch (const RunError& error) {
            throw RunError("{}: {}", scene_.file.path.string(), error.what());
        }
    }

    void run_tasks(const std::vector<Task>& tasks) {
        const std::size_t jobs =
            scene_.file.writes_files ? 1 : static_cast<std::size_t>(options_.jobs);
        std::list<Running> running;
        std::size_t started = 0;
        std::size_t done = 0;
        while (done < tasks.size()) {
            throw_if_interrupted();
            while (started < tasks.size() && running.size() < jobs) {
                const Task& task = tasks[started++];
                write_text_file(file_of(task, ".pov"),
                                probe_sdl(rig_, scene_.file.path.filename().string(), task.frame));
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
                ++tasks_done_;
                if (options_.progress) {
                    options_.progress(static_cast<double>(tasks_done_) /
                                      static_cast<double>(std::max(tasks_done_, tasks_known_)));
                }
            }
            std::this_thread::sleep_for(kPollInterval);
        }
    }

    [[nodiscard]] Picture picture_of(const Task& task) const {
        const auto pixels =
            static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_);
        static const std::array<std::string, 3> kRgb{"R", "G", "B"};
        const std::vector<float> samples = ExrReader(file_of(task, ".exr")).planes(kRgb);
        const auto plane = [&](std::size_t c) {
            const auto first = samples.begin() + static_cast<std::ptrdiff_t>(c * pixels);
            return std::vector<float>(first, first + static_cast<std::ptrdiff_t>(pixels));
        };
        return {.red = plane(0), .green = plane(1), .blue = plane(2)};
    }

    // --- The scene's requests -------------------------------------------------------------------

    // All strobes on, in clear water.
    [[nodiscard]] Task plain_task() const {
        return {.name = "plain", .frame = {.exposure_log2 = exposure_log2_}};
    }

    [[nodiscard]] Asked read_scene() {
        const Task task = plain_task();
        const fs::path folder = scene_.file.path.parent_path();
        const auto before = written_files(folder);
        run_tasks({task});
        scene_.file.writes_files |= written_files(folder) != before;
        const std::string digest = digest_of_scene(scene_.file.path);
        if (digest != scene_.file.digest) {
            // It wrote a file that it names. Now that this file exists, the scene is in its final
            // state.
            scene_.file.digest = digest;
            run_tasks({task});
        }
        Asked asked;
        for (const std::string& said : statements_in_log(read_log(file_of(task, ".log")))) {
            const auto quoted = [&] {
                const std::size_t first = said.find('"');
                return said.substr(first + 1, said.rfind('"') - first - 1);
            };
            const auto number = [&] {
                return read_number<int>(std::string_view(said).substr(said.rfind(' ') + 1))
                    .value_or(0);
            };
            if (said.starts_with("aphotic: reflectance \"")) asked.reflectances.insert(quoted());
            if (said.starts_with("aphotic: lamp \"")) asked.lamps.insert(quoted());
            if (said == "aphotic: water") asked.has_water = true;
            if (said == "aphotic: camera") asked.has_camera = true;
            if (said == "aphotic: port") asked.has_port = true;
            if (said.find("More than one camera") != std::string::npos)
                asked.has_other_camera = true;
            if (said.starts_with("aphotic: strobes ")) asked.strobes = number();
            if (said.starts_with("aphotic: lights ")) asked.lights = number();
            if (said.starts_with("Light Sources: ")) asked.all_lights = number();
            const auto counts = [&](std::string_view what) {
                if (!said.starts_with(what)) return false;
                std::string_view rest = std::string_view(said).substr(what.size());
                rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
                return read_leading_number<long long>(rest).value_or(0) > 0;
            };
            asked.has_radiosity |= counts("Radiosity samples calculated:");
            asked.has_photons |= counts("Number of photons shot:");
            asked.has_media |= counts("Media Intervals:");
        }
        return asked;
    }

    void require_ours(const Asked& asked) const {
        if (asked.strobes == 0) {
            refuse(
                "found no strobe; allowed: Aphotic_Rig (), Aphotic_Rig_Strobes () or "
                "Aphotic_Strobe (...)");
        }
        if (!asked.has_camera || asked.has_other_camera) {
            refuse(
                "found {}; allowed: Aphotic_Rig (), Aphotic_Rig_Camera () or Aphotic_Camera (...), "
                "and no other",
                asked.has_camera ? "a second camera" : "no camera of aphotic.inc");
        }
        if (const int others = asked.all_lights - asked.lights; others != 0) {
            refuse("found {} not from aphotic.inc; allowed: none, since such light has no spectrum",
                   others == 1 ? "1 light source that is"
                               : fmt::format("{} light sources that are", others));
        }
        if (asked.lights > kMostLightsInMedia && !rig_.water.is_clear()) {
            refuse("found {} cones of light; allowed: {}, POV-Ray's limit in water",
                   asked.lights,
                   kMostLightsInMedia);
        }
        if (!asked.has_water && !rig_.water.is_clear()) {
            refuse(
                "found no water; allowed: Aphotic_Water () or Aphotic_Rig (), or a rig whose water "
                "is clear (multiple = 0)");
        }
        if (!asked.has_port && rig_.camera.port) {
            refuse(
                "found no port, and the rig has one; allowed: Aphotic_Rig (), Aphotic_Rig_Camera "
                "() or Aphotic_Port (...), or a rig without [camera.port]");
        }
    }

    void require_rigs_lamps(const Asked& asked) const {
        std::set<std::string> known;
        for (const Strobe& strobe : rig_.strobes) known.insert(strobe.spectrum.short_name());
        for (const std::string& lamp : asked.lamps) {
            if (known.contains(lamp)) continue;
            refuse("found the lamp \"{}\"; allowed: the spectra of the rig's strobes, \"{}\"",
                   lamp,
                   fmt::join(known, "\", \""));
        }
    }

    // --- The scene's light ----------------------------------------------------------------------

    // POV-Ray ignores the water between surfaces, and draws samples where it gathers light.
    void require_what_is_bounded(const Asked& asked) {
        const std::array<std::pair<bool, const char*>, 3> found{
            {{asked.has_radiosity, "radiosity"},
             {asked.has_photons, "photons"},
             {asked.has_media, "the scene's own media"}}};
        for (const auto& [is_there, what] : found) {
            if (!is_there) continue;
            if (!options_.unchecked) {
                refuse(
                    "found {}; not supported: its error cannot be bounded; use --unchecked to "
                    "render without a promise",
                    what);
            }
            scene_.no_promise.push_back(fmt::format("{}: its error cannot be bounded", what));
        }
        has_radiosity_ = asked.has_radiosity;
    }

    // In one frame: with all strobes off, nothing may be bright in green and blue; with water on
    // the camera's leg only, red must be attenuated. The water is so thin that only light from
    // beyond all water, such as a sky, is lost.
    void require_light_of_ours() {
        constexpr double kLittle = 0x1p-4;
        const double K_per_m = has_water_ ? kLittle * attenuation_per_m_ : 0.0;
        const Task seen{.name = "seen",
                        .frame = {.attenuation_per_m = {K_per_m, K_per_m, K_per_m},
                                  .exposure_log2 = exposure_log2_,
                                  .strobes = {1.0, 0.0, 0.0},
                                  .is_coarse_in_radiosity = has_radiosity_,
                                  .dims_lamps = false}};
        run_tasks({seen});

        const Picture bare = picture_of(plain_task());
        const Picture through_water = picture_of(seen);
        if (std::ranges::any_of(through_water.green, is_lit) ||
            std::ranges::any_of(through_water.blue, is_lit)) {
            refuse(
                "found light with all strobes off; allowed: none, since such light has no "
                "spectrum. Is there a finish with emission, a light_group, or a medium that "
                "glows?");
        }
        if (has_water_ && std::ranges::any_of(bare.red, is_lit)) {
            require_water_in_view(through_water, bare);
        }
        require_no_light_under_0(bare);
        if (has_own_colours(through_water)) {
            scene_.no_promise.emplace_back("numeric colours have no spectrum; use Aphotic_Pigment");
        }
    }

    void require_water_in_view(const Picture& through_water, const Picture& bare) const {
        for (std::size_t i = 0; i < bare.red.size(); ++i) {
            if (is_lit(bare.red[i]) && through_water.red[i] < bare.red[i]) return;
        }
        refuse(
            "found no water between the camera and what it sees; allowed: a camera outside any "
            "object, or in a hollow one");
    }

    void require_no_light_under_0(const Picture& bare) const {
        for (const auto* plane : {&bare.red, &bare.green, &bare.blue}) {
            const auto least = std::ranges::min_element(*plane);
            if (!(*least < 0.0F)) continue;
            const auto pixel = static_cast<int>(least - plane->begin());
            refuse(
                "found light of {:.3g}, where the brightest is {:.3g}, at column {}, row {} of {} "
                "x {}; allowed: 0 or more. Is there a colour below 0?",
                *least,
                *std::ranges::max_element(*plane),
                pixel % width_px_,
                pixel / width_px_,
                width_px_,
                height_px_);
        }
    }

    // Without water, channels differ by colours given as numbers; a sky's are behind it. Where all
    // three exceed half floats, they are compared with less light.
    [[nodiscard]] bool has_own_colours(const Picture& through_water) {
        Task task = plain_task();
        for (int attempt = 0; attempt < kMostTries; ++attempt) {
            if (attempt > 0) {
                task.name = fmt::format("plain_{}", attempt);
                task.frame.exposure_log2 -= kLessLightLog2;
                task.frame.is_coarse_in_radiosity = has_radiosity_;
                run_tasks({task});
            }
            const Picture bare = picture_of(task);
            bool is_known = true;
            for (std::size_t i = 0; i < bare.red.size(); ++i) {
                if (has_water_ && through_water.red[i] == 0.0F) continue;
                if (bare.red[i] == bare.green[i] && bare.red[i] == bare.blue[i]) {
                    is_known &= std::isfinite(bare.red[i]);
                } else {
                    return true;
                }
            }
            if (is_known) return false;
        }
        return true;
    }

    // Fills in the unknown values of each pixel, and counts those that remain unknown.
    void take_in(const Picture& picture, const ProbeFrame& frame, Lit& lit, Unmeasured& left) {
        constexpr double kLeastNormal = 0x1p-14;      // below it half floats lose digits
        constexpr double kLeastThatCounts = 0x1p-20;  // 1e-8 of the intended peak
        constexpr double kLeastLoss = 0x1p-5;         // determines the path to 3 % with half floats
        const auto& [little_per_m, loss_per_m, gain_per_m] = frame.attenuation_per_m;
        for (std::size_t i = 0; i < lit.size(); ++i) {
            const double bare = picture.red[i];
            const double dimmed = picture.green[i];
            const double raised = picture.blue[i];
            UserScene::Lit& pixel = lit[i];
            if (pixel.path_m > 0.0 || !(bare > 0.0))
                continue;  // known; or unlit, or behind everything
            if (!std::isfinite(bare)) {
                ++left.too_bright;
                continue;
            }
            if (has_water_) {
                if (bare < 2.0 * kLeastNormal) {
                    left.too_faint += bare < kLeastThatCounts && is_any_measured_ ? 0 : 1;
                    continue;
                }
                if (dimmed < kLeastNormal) {
                    ++left.too_far;
                    continue;
                }
                // Over a mirror's endless path, the gain makes the void infinite.
                const double path_m =
                    std::isfinite(raised)
                        ? measured_path_m(dimmed, raised, loss_per_m - gain_per_m)
                        : measured_path_m(dimmed, bare, loss_per_m - little_per_m);
                if (!(path_m * loss_per_m >= kLeastLoss)) {
                    ++left.too_near;
                    continue;
                }
                pixel.path_m = path_m;
            } else {
                pixel.path_m = path_range(rig_).shortest_m;
            }
            pixel.radiance_per_flux =
                std::ldexp(bare * std::exp(little_per_m * pixel.path_m), -frame.exposure_log2);
            is_any_measured_ = true;
        }
    }

    // A strobe is measured again with less or more light if pixels were too bright or faint for
    // half floats, or with another loss if their paths were too long or short for the one tried.
    void measure(int strobes) {
        constexpr double kLessLoss = 8.0;
        constexpr double kMoreLoss = 32.0;
        // Attenuates objects in view by less than half floats resolve, and removes light from
        // behind all water.
        constexpr double kLittleLoss = 0x1p-10;
        std::vector<Lit> lit(
            static_cast<std::size_t>(strobes),
            Lit(static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_)));
        std::vector<int> open;
        for (int s = 1; s <= strobes; ++s) open.push_back(s);
        double K_per_m = attenuation_per_m_;
        double K_largest_per_m = attenuation_per_m_;
        int exposure = exposure_log2_;
        Unmeasured left;
        std::size_t dry = 0;  // pixels that a strobe lights, of the strobe that lights the most
        for (int attempt = 0; attempt < kMostTries && !open.empty(); ++attempt) {
            std::vector<Task> tasks;
            for (const int s : open) {
                tasks.push_back(
                    {.name = fmt::format("strobe_{}_{}", s, attempt),
                     .frame = {.attenuation_per_m = {kLittleLoss * K_per_m, K_per_m, -K_per_m},
                               .exposure_log2 = exposure,
                               .only_strobe = s,
                               .is_coarse_in_radiosity = has_radiosity_}});
            }
            tasks_known_ = tasks_done_ + tasks.size();
            run_tasks(tasks);
            std::vector<int> still_open;
            left = {};
            dry = 0;
            for (const Task& task : tasks) {
                const Picture picture = picture_of(task);
                for (const auto* plane : {&picture.red, &picture.green, &picture.blue}) {
                    measured_.append(reinterpret_cast<const char*>(plane->data()),
                                     plane->size() * sizeof(float));
                }
                const int s = task.frame.only_strobe;
                const Unmeasured before = left;
                take_in(picture, task.frame, lit[static_cast<std::size_t>(s - 1)], left);
                if (left.count() > before.count()) still_open.push_back(s);
                dry = std::max(dry, left.not_faint() - before.not_faint());
            }
            open = std::move(still_open);
            if (left.too_bright > 0) {
                exposure -= kLessLightLog2;
            } else if (left.too_far > 0) {
                K_per_m /= kLessLoss;
            } else if (left.too_near > 0) {
                K_largest_per_m *= kMoreLoss;
                K_per_m = K_largest_per_m;
            } else {
                exposure += kLessLightLog2;
                K_per_m = attenuation_per_m_;
            }
        }
        if (dry > 0) require_no_dry_light(dry);
        put_together(lit);
    }

    // If there is no promise anyway, this also voids it.
    void require_no_dry_light(std::size_t pixels) {
        const std::string what =
            fmt::format("light that passes through no water, in {} of {} pixels",
                        pixels,
                        width_px_ * height_px_);
        if (scene_.no_promise.empty()) {
            refuse(
                "found {}; allowed: water on its path. Are camera and strobes inside an object "
                "that is not hollow?",
                what);
        }
        scene_.no_promise.push_back(what);
    }

    void put_together(const std::vector<Lit>& strobes) {
        scene_.pixels.resize(strobes.front().size());
        for (const Lit& lit : strobes) {
            for (std::size_t i = 0; i < lit.size(); ++i) {
                if (lit[i].path_m > 0.0) scene_.pixels[i].push_back(lit[i]);
            }
        }
        scene_.paths = paths_of(scene_.pixels);
        if (scene_.paths.longest_m > 0.0) return;
        refuse(
            "found nothing in view that a strobe lights; allowed: a scene with something to see. "
            "Is the camera where it should be? plain povray shows it");
    }

    const PovRay& povray_;
    const Rig& rig_;
    const ProbeOptions& options_;
    ScratchFolder folder_;
    UserScene scene_;
    int width_px_ = 1;
    int height_px_ = 1;
    bool has_water_ = false;
    double attenuation_per_m_ = 1.0;
    int exposure_log2_ = 0;
    std::string measured_;        // all samples, for the digest
    bool has_radiosity_ = false;  // unchecked
    bool is_any_measured_ = false;
    std::size_t tasks_done_ = 0;
    std::size_t tasks_known_ = 0;  // including pending ones, as far as known
};

}  // namespace

UserScene probe_scene(const PovRay& povray,
                      const Rig& rig,
                      const fs::path& scene_file,
                      const ProbeOptions& options) {
    require_openexr(povray, "which the probe of a scene of your own needs");
    return SceneProbe(povray, rig, scene_file, options).run();
}

}  // namespace aphotic
