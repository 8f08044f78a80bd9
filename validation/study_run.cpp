// SPDX-License-Identifier: BSD-3-Clause
#include "validation/study_run.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/number.h"
#include "base/sha256.h"
#include "image/any_image.h"
#include "image/exr.h"
#include "rig/lens.h"
#include "spectral/integrator.h"
#include "validation/saved_measure.h"
#include "validation/traced_images.h"
#include "validation/tracer.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string key_of(const Study& study, const StudySetting& setting) {
    return sha256_of_text(fmt::format("{} {} {} {} {} {} {} {}",
                                      study.rig_sha256,
                                      study.width_px,
                                      study.height_px,
                                      study.aphotic_version,
                                      study.povray_version,
                                      study.cores,
                                      setting.name,
                                      setting_json(setting).dump()));
}

struct StudyReference {
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
        const auto trace_s = read_number<double>(traced.attribute("aphotic:trace_s"));
        if (!trace_s) return std::nullopt;
        return std::pair(read_signals(file), *trace_s);
    } catch (const RunError&) {
        return std::nullopt;
    }
}

StudyReference study_reference(const Rig& rig,
                               const fs::path& folder,
                               const Study& study,
                               const StudyHands& hands) {
    const std::string key = key_of(study, {});
    const Tracer tracer(rig, {.signals = true, .planes_nm = {}, .threads = study.cores});
    StudyReference reference{
        .image = {}, .on_edge = tracer.on_edges(rig.camera.range), .grid_size = tracer.grid_size()};
    const fs::path file = folder / "image.exr";
    if (auto kept = kept_trace(file, key)) {
        std::tie(reference.image, reference.trace_s) = std::move(*kept);
        return reference;
    }
    make_folder(folder);
    const auto start = Clock::now();
    const std::vector<double> signals =
        trace_signals(tracer, [&](double share) { hands.progress("tracing", share); });
    reference.trace_s = seconds_since(start);
    OutputImages images(
        folder,
        rig.camera.width_px,
        rig.camera.height_px,
        {},
        {{"aphotic:key", key}, {"aphotic:trace_s", fmt::format("{}", reference.trace_s)}});
    images.write_rows(rig.camera.height_px, {signals.begin(), signals.end()});
    reference.image = images.finish();
    return reference;
}

Rig shrunk(Rig rig, int shrink) {
    enlarge_pixels(rig.camera, shrink, rig.camera.width_px / shrink, rig.camera.height_px / shrink);
    return rig;
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
                     const StudyReference& reference,
                     const fs::path& folder,
                     const StudyHands& hands) {
    fs::remove_all(folder);
    const StudyFrames frames = hands.render(shrunk(rig, setting.shrink), setting, folder);
    const auto start = Clock::now();
    CameraImage image = integrate_signals(folder, frames.manifest, folder);
    if (setting.shrink > 1) image = enlarged(image, rig, setting.filter);
    StudyMeasure measure{.setting = setting,
                         .wavelengths = frames.manifest.wavelengths.size(),
                         .frames = frames.manifest.frames.size(),
                         .promise = frames.promise,
                         .render_s = frames.render_s,
                         .integrate_s = seconds_since(start)};
    measure.channels =
        compare_signals(image,
                        reference.image,
                        measure.blurs_edges() ? blurred_edges(rig, setting) : reference.on_edge);
    fs::remove_all(folder);
    return measure;
}

}  // namespace

void run_study(Study& study,
               const Rig& rig,
               const std::vector<StudySetting>& settings,
               const fs::path& folder,
               const StudyHands& hands) {
    make_folder(folder / "settings");
    const StudyReference reference = study_reference(rig, folder / "reference", study, hands);
    study.grid_size = reference.grid_size;
    study.trace_s = reference.trace_s;
    for (const StudySetting& setting : settings) {
        const fs::path file = folder / "settings" / (setting.name + ".json");
        const std::string key = key_of(study, setting);
        std::optional<StudyMeasure> measured = saved_measure(setting, key, file);
        if (!measured) {
            hands.begins(setting, study.measures.size());
            measured = measure(rig, setting, reference, folder / "settings" / setting.name, hands);
            save_measure(*measured, key, file);
        }
        study.measures.push_back(std::move(*measured));
    }
}

}  // namespace aphotic
