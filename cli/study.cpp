// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic study RIG -o DIR: settings of a render tried side by side, their time here and their
// error against the reference.
#include "validation/study.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/progress.h"
#include "base/sha256.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/needs_check.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/planning.h"
#include "cli/rendering.h"
#include "image/any_image.h"
#include "image/exr.h"
#include "rig/rig_reader.h"
#include "scene_gen/scene_set.h"
#include "spectral/integrator.h"
#include "validation/saved_measure.h"
#include "validation/tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>
#include <tuple>
#include <utility>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// A 16-bit PNG ends at 1: the brightest pixel stays under a half, whatever the bound's margin.
constexpr int kPngPeakLog2 = -1;

struct StudyCommandOptions {
    std::string rig_file;
    std::string folder;
    std::string povray;
    double stall_timeout_s = kStall_s;
    double tolerance = 1e-3;
    bool quick = false;
    bool json = false;
    bool ignore_needs = false;
};

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Reference {
    CameraImage image;
    std::vector<unsigned char> on_edge;
    std::size_t grid_size = 0;
    double trace_s = 0.0;
};

// The time of a trace is kept in its image: a study that goes on later does not trace again.
// Nothing when the image is of something else, or not as we wrote it.
std::optional<std::pair<CameraImage, double>> kept_trace(const fs::path& file,
                                                         const std::string& key) {
    if (!fs::exists(file)) return std::nullopt;
    try {
        const ExrReader traced(file);
        if (traced.attribute("aphotic:key") != key) return std::nullopt;
        const std::string trace_s = traced.attribute("aphotic:trace_s");
        return std::pair(read_signals(file), std::stod(trace_s));
    } catch (const RunError&) {
        return std::nullopt;
    } catch (const std::logic_error&) {  // of stod
        return std::nullopt;
    }
}

Reference reference_of(const Rig& rig, const fs::path& folder, const std::string& key, int cores) {
    const Tracer tracer(rig, {.signals = true, .planes_nm = {}, .threads = cores});
    Reference reference{
        .image = {}, .on_edge = tracer.on_edges(rig.camera.range), .grid_size = tracer.grid_size()};
    const fs::path file = folder / "image.exr";
    if (auto kept = kept_trace(file, key)) {
        std::tie(reference.image, reference.trace_s) = std::move(*kept);
        return reference;
    }
    make_folder(folder);
    const auto start = Clock::now();
    constexpr int kRows = 32;
    const int height_px = rig.camera.height_px;
    std::vector<std::vector<double>> blocks;
    ProgressLine line;
    for (int row = 0; row < height_px; row += kRows) {
        blocks.push_back(tracer.rows(row, std::min(kRows, height_px - row)));
        line.show("tracing", static_cast<double>(row) / height_px);
    }
    reference.trace_s = seconds_since(start);
    OutputImages images(
        folder,
        rig.camera.width_px,
        height_px,
        {},
        {{"aphotic:key", key}, {"aphotic:trace_s", fmt::format("{}", reference.trace_s)}});
    for (const std::vector<double>& block : blocks) {
        const auto rows = static_cast<int>(block.size()) / kChannels / rig.camera.width_px;
        images.write_rows(rows, {block.begin(), block.end()});
    }
    reference.image = images.finish();
    return reference;
}

Rig shrunk(Rig rig, int shrink) {
    rig.camera.width_px /= shrink;
    rig.camera.height_px /= shrink;
    rig.camera.pixel_pitch_m *= shrink;
    return rig;
}

RenderPlan plan_for(const Rig& rig, const StudySetting& setting) {
    PlanRequest request;
    if (setting.fitted > 0) request.fitted = setting.fitted;
    if (setting.bands > 0) request.bands = setting.bands;
    request.scene.wavelengths_per_frame = setting.per_frame;
    request.scene.soft_edges = setting.one_soft_lamp;
    if (setting.png) request.scene.peak_log2 = kPngPeakLog2;
    return plan_render(rig, request);
}

// In POV-Ray's settings, which must hold the line.
void change_setting(std::string& ini, const std::string& line, const std::string& to) {
    const std::size_t at = ini.find(line + "\n");
    if (at == std::string::npos) throw std::logic_error("no such line: " + line);
    ini.replace(at, line.size(), to);
}

// Makes a float EXR of the 16-bit PNG beside it: POV-Ray adds a format's ending to a foreign name.
void png_to_exr(const fs::path& file) {
    const fs::path png_file = file.string() + ".png";
    const AnyImage png = open_any_image(png_file);
    const std::vector<std::string> channels{"R", "G", "B"};
    std::vector<float> samples;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const std::vector<float> plane = png.samples(c);
        if (std::ranges::max(plane) >= 1.0F) {
            throw RunError(fmt::format("{}: a pixel is clipped", png_file.string()));
        }
        samples.insert(samples.end(), plane.begin(), plane.end());
    }
    ExrWriter exr(file, png.width_px, png.height_px, channels, {});
    exr.write_rows(png.height_px, samples);
    exr.finish();
    fs::remove(png_file);
}

CameraImage enlarged(const CameraImage& image, const Rig& rig, const std::string& filter) {
    const PlaneSize from{.width_px = image.width_px, .height_px = image.height_px};
    const PlaneSize to{.width_px = rig.camera.width_px, .height_px = rig.camera.height_px};
    CameraImage large{.width_px = to.width_px, .height_px = to.height_px, .samples = {}};
    const std::size_t plane = image.samples.size() / kChannels;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto first = image.samples.begin() + static_cast<std::ptrdiff_t>(c * plane);
        const std::vector<float> result =
            resized({first, first + static_cast<std::ptrdiff_t>(plane)}, from, to, filter);
        large.samples.insert(large.samples.end(), result.begin(), result.end());
    }
    return large;
}

// Pixels that the setting mixes with what lies beyond an edge.
std::vector<unsigned char> blurred_edges(const Rig& rig, const StudySetting& setting) {
    // The widest filter, lanczos3, reaches three pixels of the small image.
    constexpr double kReach_px = 4.0;
    const Tracer tracer(rig, {.signals = false, .planes_nm = {}});
    return tracer.on_edges(rig.camera.range, setting.shrink > 1 ? kReach_px * setting.shrink : 1.0);
}

// Renders the setting in the folder, from nothing, and takes the folder away again.
StudyMeasure measure(const Rig& rig,
                     const StudySetting& setting,
                     const Reference& reference,
                     const PovRay& povray,
                     double stall_s,
                     const fs::path& folder) {
    fs::remove_all(folder);
    const Rig small = shrunk(rig, setting.shrink);
    const RenderPlan plan = plan_for(small, setting);
    SceneSet set = make_scene_set(small, plan);
    RunOptions options{.jobs = setting.jobs, .report = {}, .stall_s = stall_s};
    if (setting.antialias) {
        change_setting(set.ini,
                       "Antialias=off",
                       "Antialias=on\nSampling_Method=2\nAntialias_Threshold=0.01\n"
                       "Antialias_Depth=3\nJitter=off");
    }
    if (setting.png) {
        change_setting(set.ini, "Output_File_Type=E", "Output_File_Type=N\nBits_Per_Color=16");
        options.convert = png_to_exr;
    }
    const RenderedFrames frames = render_frames(povray, folder, set, options);

    const auto start = Clock::now();
    CameraImage image = integrate_signals(folder, frames.result.manifest, folder);
    if (setting.shrink > 1) image = enlarged(image, rig, setting.filter);
    StudyMeasure measure{.setting = setting,
                         .wavelengths = plan.wavelengths.size(),
                         .frames = set.scenes.size(),
                         .promise = plan.promise(),
                         .render_s = frames.povray_s,
                         .integrate_s = seconds_since(start)};
    measure.channels =
        compare_signals(image,
                        reference.image,
                        measure.blurs_edges() ? blurred_edges(rig, setting) : reference.on_edge);
    fs::remove_all(folder);
    return measure;
}

std::string key_of(const Study& study, const StudySetting& s) {
    return sha256_of_text(fmt::format("{} {} {} {} {} {} {}/{}/{}/{}/{}/{}/{}/{}/{}/{}",
                                      study.rig_sha256,
                                      study.width_px,
                                      study.height_px,
                                      study.aphotic_version,
                                      study.povray_version,
                                      study.cores,
                                      s.name,
                                      s.fitted,
                                      s.bands,
                                      s.per_frame,
                                      s.shrink,
                                      s.filter,
                                      s.one_soft_lamp,
                                      s.png,
                                      s.antialias,
                                      s.jobs));
}

void print_study(const Study& study, const fs::path& folder) {
    const std::vector<bool> front = pareto_front(study.measures);
    fmt::print("{}: {} x {} pixels, {} on {}\n",
               study.rig_title,
               study.width_px,
               study.height_px,
               counted(study.measures.size(), "setting"),
               counted(static_cast<std::size_t>(study.cores), "core"));
    fmt::print("  {:<48} {:>6} {:>8} {:>10} {:>10} {:>10}\n",
               "",
               "frames",
               "time (s)",
               "max |e|",
               "off edges",
               "on edges");
    for (std::size_t i = 0; i < study.measures.size(); ++i) {
        const StudyMeasure& m = study.measures[i];
        fmt::print("{} {:<48} {:6} {:8.2f} {:10.2e} {:10.2e} {:10.2e}\n",
                   front[i] ? "*" : " ",
                   m.setting.words,
                   m.frames,
                   m.total_s(),
                   m.max_error(),
                   m.max_error_off_edges(),
                   m.max_error_on_edges());
    }
    fmt::print("  * on the Pareto front: no other is as fast and as right\n");
    const auto best = recommended(study.measures, study.tolerance);
    if (best) {
        fmt::print("  for {}: {}\n", study.tolerance, study.measures[*best].setting.words);
    } else {
        fmt::print("  for {}: none of these\n", study.tolerance);
    }
    fmt::print("  {}/study.html, study.csv, study.json\n", folder.string());
}

// Of the setting that has most. Behind a port each wavelength may take a frame of its own.
DiskNeeds needs_of_renders(const Rig& rig, const std::vector<StudySetting>& settings, int cores) {
    int wavelengths = 0;
    int frames = 0;
    for (const StudySetting& s : settings) {
        const int count = std::max(s.fitted, s.bands);
        wavelengths = std::max(wavelengths, count);
        const int per_frame = rig.camera.port ? 1 : s.per_frame;
        frames = std::max(frames, (count + per_frame - 1) / per_frame);
    }
    return study_needs({.width_px = rig.camera.width_px,
                        .height_px = rig.camera.height_px,
                        .wavelengths = static_cast<std::size_t>(wavelengths)},
                       static_cast<std::size_t>(frames),
                       cores);
}

ExitStatus study_rig(const StudyCommandOptions& options) {
    const fs::path folder = options.folder;
    Rig rig = read_rig(options.rig_file);
    if (!rig.scene.empty()) {
        throw InputError(
            fmt::format("{}: scene: found {}; allowed: none, for a study is of the rig's "
                        "own floor, which the reference knows",
                        options.rig_file,
                        rig.scene.string()));
    }
    if (options.quick) rig = quick_rig(std::move(rig));
    const PovRay povray = find_povray(options.povray);
    Study study{.rig_title = rig.title,
                .rig_sha256 = rig.digest,
                .width_px = rig.camera.width_px,
                .height_px = rig.camera.height_px,
                .aphotic_version = APHOTIC_VERSION,
                .povray_version = povray.version,
                .cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency())),
                .quick = options.quick,
                .tolerance = options.tolerance};
    const std::vector<StudySetting> settings = study_settings(rig, options.quick, study.cores);
    require_room(needs_of_renders(rig, settings, study.cores), folder, options.ignore_needs);
    set_exr_threads(study.cores);
    const FolderLock lock = claim_folder(folder);
    make_folder(folder / "settings");
    const Reference reference =
        reference_of(rig, folder / "reference", key_of(study, {}), study.cores);
    study.grid_size = reference.grid_size;
    study.trace_s = reference.trace_s;

    for (const StudySetting& setting : settings) {
        const fs::path file = folder / "settings" / (setting.name + ".json");
        const std::string key = key_of(study, setting);
        std::optional<StudyMeasure> measured = saved_measure(setting, key, file);
        if (!measured) {
            fmt::print(stderr,
                       "{} of {}: {}\n",
                       study.measures.size() + 1,
                       settings.size(),
                       setting.words);
            measured = measure(rig,
                               setting,
                               reference,
                               povray,
                               options.stall_timeout_s,
                               folder / "settings" / setting.name);
            save_measure(*measured, key, file);
        }
        study.measures.push_back(std::move(*measured));
    }
    write_study(study, folder);
    if (options.json) {
        fmt::print("{}", read_text_file(folder / "study.json"));
    } else {
        print_study(study, folder);
    }
    return kDone;
}

Action configure_study(CLI::App& app) {
    const auto options = std::make_shared<StudyCommandOptions>();
    add_rig(app, options->rig_file);
    add_output_folder(app, options->folder)->required();
    app.add_option("--tolerance",
                   options->tolerance,
                   "Recommend the fastest setting within this relative error")
        ->check(in_range(0.0, 1.0))
        ->option_text("E")
        ->capture_default_str();
    app.add_flag("--quick",
                 options->quick,
                 "Try only the settings that matter most, small enough for two minutes");
    add_needs_option(app, options->ignore_needs);
    add_json(app, options->json, "Print study.json");
    add_povray_options(app, options->povray, options->stall_timeout_s);
    app.footer(
        "Interrupted, it continues with the settings not yet measured when run again. Leave the "
        "machine alone meanwhile: the times are wall times.");
    return [options] { return study_rig(*options); };
}

}  // namespace

const Command kStudy{"study",
                     kCheckCommands,
                     "Measure how accuracy trades for time on this machine",
                     configure_study};

}  // namespace aphotic::cli
