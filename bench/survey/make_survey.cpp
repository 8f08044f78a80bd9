// SPDX-License-Identifier: BSD-3-Clause
//
// survey -o DIR --images N --seed S: a simulated survey, every image rendered by POV-Ray.
//
//   DIR/survey.json             what it was made with
//   DIR/navigation.txt          imagename alt pitch roll, a line for each image
//   DIR/navigation-rough.txt    the same with the errors of instruments (flight.h)
//   DIR/raw/000001.tif          what the camera's file holds: 12 bits in 16, RGGB, black level 64,
//                               one gain for the whole survey, shot and read noise
//   DIR/truth/000001.exr        the camera's signal before that: float R, G, B, no noise
//   DIR/card/000001.exr         of images with a chart: the signal of the bare grey card instead
//   DIR/plan/                   the frames' scenes (`aphotic generate`)
//
// Nothing of lightmap/ takes part. Given again it goes on where it stopped, and with more images
// it goes on from those that are there; with fewer, the navigation tells the first of them. With
// other settings it is refused.
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/progress.h"
#include "base/sha256.h"
#include "bench/survey/image_file.h"
#include "bench/survey/raw_camera.h"
#include "bench/survey/render.h"
#include "plugin/process.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <thread>

namespace aphotic::survey {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Options {
    std::string folder;
    std::string rig = APHOTIC_SOURCE_DIR "/scenes/survey/survey.toml";
    int images = 50;
    std::uint64_t seed = 1;
    bool noise = true;
    int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
};

// From straight down at kLowest_m to the corners at kHighest_m with all the pitch and roll there
// is, and a rock's height nearer.
constexpr const char* kPaths_m = "2.4,7.7";
// Nine serve them, grey and all that lies on the floor to 1e-3 (`aphotic plan`).
constexpr const char* kWavelengths = "9";
// The brightest of the grey card at the lowest altitude is at this share of the well: white sand
// there fills it.
constexpr double kCardShare = 0.25;

fs::path scene_of(const Options& options) {
    return fs::absolute(options.rig).parent_path() / "survey.pov";
}

Json settings_of(const Options& options) {
    return {{"rig_sha256", sha256_of_file(options.rig)},
            {"scene_sha256", sha256_of_file(scene_of(options))},
            {"seed", options.seed},
            {"noise", options.noise}};
}

// A folder holds one survey: images of two could not be told apart.
void require_same_survey(const fs::path& file, const Json& settings) {
    if (!fs::exists(file)) return;
    const Json found = Json::parse(read_text_file(file)).at("settings");
    if (found != settings) {
        throw InputError(
            fmt::format("{}: found a survey of other settings, {}; allowed: {}, or "
                        "another folder",
                        file.string(),
                        found.dump(),
                        settings.dump()));
    }
}

void generate_plan(const Options& options, const fs::path& plan) {
    if (fs::exists(manifest_path(plan))) return;
    constexpr double kPatience_s = 300.0;
    const fs::path log = plan.string() + ".log";
    const ProcessEnd end = run_process({.executable = APHOTIC_COMMAND,
                                        .arguments = {"generate",
                                                      fs::absolute(options.rig).string(),
                                                      "--scene",
                                                      scene_of(options).string(),
                                                      "--paths-m",
                                                      kPaths_m,
                                                      "--fitted",
                                                      kWavelengths,
                                                      "-o",
                                                      fs::absolute(plan).string()},
                                        .folder = fs::absolute(options.folder),
                                        .environment = {},
                                        .log = log},
                                       kPatience_s);
    if (!end.succeeded()) {
        throw RunError(
            fmt::format("aphotic generate failed ({}):\n{}", end.words(), read_text_file(log)));
    }
}

std::vector<Picture> pictures_of(const std::vector<Leg>& legs, const fs::path& folder) {
    std::vector<Picture> pictures;
    for (const Leg& leg : legs) {
        const std::string file = leg.name + ".exr";
        if (leg.has_chart) {
            pictures.push_back({.leg = leg, .floor = "card", .image = folder / "card" / file});
        }
        pictures.push_back({.leg = leg,
                            .floor = leg.has_chart ? "chart" : "natural",
                            .image = folder / "truth" / file});
    }
    return pictures;
}

// The camera's gain is set once: on the card at the lowest altitude.
Picture gain_picture(const fs::path& folder) {
    const Leg lowest{.image = 0, .name = "lowest", .altitude_m = kLowest_m};
    return {.leg = lowest, .floor = "card", .image = folder / "plan" / "lowest.exr"};
}

RawCamera camera_of(const fs::path& folder) {
    const CameraImage card = read_signals(gain_picture(folder).image);
    return {.full_signal =
                *std::max_element(card.samples.begin(), card.samples.end()) / kCardShare};
}

void expose(const std::vector<Leg>& legs, const Options& options, const RawCamera& camera) {
    const fs::path folder = options.folder;
    for (const Leg& leg : legs) {
        const fs::path raw = folder / "raw" / (leg.name + ".tif");
        if (fs::exists(raw)) continue;
        const CameraImage truth = read_signals(folder / "truth" / (leg.name + ".exr"));
        std::optional<std::uint64_t> noise;
        if (options.noise) noise = options.seed * 1000003U + static_cast<std::uint64_t>(leg.image);
        write_tiff(raw, truth.width_px, truth.height_px, raw_mosaic(truth, camera, noise));
    }
}

Json record_of(const Options& options, const Json& settings, const RawCamera& camera) {
    return {{"settings", settings},
            {"images", options.images},
            {"raw",
             {{"pattern", "RGGB"},
              {"black", camera.black},
              {"white", camera.white},
              {"full_signal", camera.full_signal},
              {"full_well_e", camera.full_well_e},
              {"read_noise_e", camera.read_noise_e}}}};
}

void make_survey(const Options& options) {
    const fs::path folder = options.folder;
    const Json settings = settings_of(options);
    for (const char* part : {"raw", "truth", "card"}) make_folder(folder / part);
    require_same_survey(folder / "survey.json", settings);
    write_text_file(folder / "survey.json", Json{{"settings", settings}}.dump(2) + "\n");
    generate_plan(options, folder / "plan");

    const std::vector<Leg> legs = flight(options.seed, options.images);
    std::vector<Picture> pictures = pictures_of(legs, folder);
    pictures.insert(pictures.begin(), gain_picture(folder));
    ProgressLine line;
    const RunOptions run{
        .jobs = options.jobs,
        .report =
            [&](const FrameProgress& done) {
                line.show(fmt::format("frame {} of {}", done.frames_done, done.frames), done.share);
            },
        .scene_folder = scene_of(options).parent_path()};
    render_pictures(find_povray(""), folder / "plan", pictures, run);

    const RawCamera camera = camera_of(folder);
    expose(legs, options, camera);
    write_text_file(folder / "navigation.txt", navigation(legs, ".tif"));
    write_text_file(folder / "navigation-rough.txt",
                    navigation(as_measured(legs, options.seed), ".tif"));
    write_text_file(folder / "survey.json", record_of(options, settings, camera).dump(2) + "\n");
    fmt::print("{}: {} images, {} with a chart\n",
               folder.string(),
               legs.size(),
               std::count_if(legs.begin(), legs.end(), [](const Leg& l) { return l.has_chart; }));
}

}  // namespace
}  // namespace aphotic::survey

int main(int argc, char** argv) {
    aphotic::survey::Options options;
    CLI::App app{"A simulated survey of the sea floor, every image rendered by POV-Ray."};
    app.add_option("-o,--output", options.folder, "the folder to write to")->required();
    app.add_option("--images", options.images, "how many")->check(CLI::Range(1, 999999));
    app.add_option("--seed", options.seed, "of all that is random");
    app.add_option("--rig",
                   options.rig,
                   "the rig, beside its survey.pov; camera and strobes where survey.toml has them, "
                   "for the plan serves these paths")
        ->check(CLI::ExistingFile)
        ->capture_default_str();
    app.add_flag("!--no-noise", options.noise, "raw images without shot and read noise");
    app.add_option("--jobs", options.jobs, "frames at a time")->check(CLI::PositiveNumber);
    try {
        app.parse(argc, argv);
        aphotic::survey::make_survey(options);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "survey: {}\n", error.what());
        return dynamic_cast<const aphotic::InputError*>(&error) != nullptr ? 2 : 3;
    }
    return 0;
}
