// SPDX-License-Identifier: BSD-3-Clause
#include "validation/study.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/number.h"
#include "base/sha256.h"
#include "base/stopwatch.h"
#include "image/exr.h"
#include "report/html.h"
#include "report/page.h"
#include "report/plot.h"
#include "rig/camera/lens.h"
#include "spectral/integrator.h"
#include "spectral/sensor.h"
#include "validation/comparison.h"
#include "validation/tracer.h"
#include "validation/validation.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The numbers of a measure by their names in JSON and CSV.
struct NamedNumber {
    const char* name;
    double StudyMeasure::*number;
};
constexpr std::array kNumbers{NamedNumber{"promise", &StudyMeasure::promise},
                              NamedNumber{"render_s", &StudyMeasure::render_s},
                              NamedNumber{"integrate_s", &StudyMeasure::integrate_s},
                              NamedNumber{"max_error", &StudyMeasure::max_error},
                              NamedNumber{"percentile_999", &StudyMeasure::percentile_999},
                              NamedNumber{"rms_error", &StudyMeasure::rms_error},
                              NamedNumber{"max_error_on_edges", &StudyMeasure::max_error_on_edges}};

// The subject of a study: measures of another subject are not reused.
Json subject_of(const Study& study) {
    return {{"rig", {{"title", study.rig_title}, {"sha256", study.rig_sha256}}},
            {"image", {{"width_px", study.width_px}, {"height_px", study.height_px}}},
            {"versions", {{"aphotic", study.aphotic_version}, {"povray", study.povray_version}}},
            {"cores", study.cores}};
}

bool beats(const StudyMeasure& a, const StudyMeasure& b) {
    const bool as_good = a.total_s() <= b.total_s() && a.max_error <= b.max_error;
    return as_good && (a.total_s() < b.total_s() || a.max_error < b.max_error);
}

// The reference.

struct StudyReference {
    CameraImage image;
    std::vector<unsigned char> on_edge;
};

// The time of a trace is stored in its image, so that a resumed study does not trace again. Empty
// if the image has another subject, or was not written by us.
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

StudyReference study_reference(Study& study,
                               const Rig& rig,
                               const fs::path& folder,
                               const StudyHands& hands) {
    const std::string key = sha256_of_text(subject_of(study).dump());
    const Tracer tracer(rig, {.signals = true, .planes_nm = {}, .threads = study.cores});
    study.grid_size = tracer.grid_size();
    std::vector<unsigned char> on_edge = tracer.on_edges(rig.camera.range);
    if (auto kept = kept_trace(folder / "image.exr", key)) {
        study.trace_s = kept->second;
        return {std::move(kept->first), std::move(on_edge)};
    }
    make_folder(folder);
    const Stopwatch watch;
    const std::vector<double> signals = tracer.rows(
        0, rig.camera.height_px, [&](double share) { hands.progress("tracing", share); });
    study.trace_s = watch.seconds();
    OutputImages images(
        folder,
        rig.camera.width_px,
        rig.camera.height_px,
        {},
        {{"aphotic:key", key}, {"aphotic:trace_s", fmt::format("{}", study.trace_s)}});
    images.write_rows(rig.camera.height_px, {signals.begin(), signals.end()});
    return {images.finish(), std::move(on_edge)};
}

// Renders the setting in the folder, from scratch, and removes the folder afterwards.
StudyMeasure measure(const StudySetting& setting,
                     std::size_t index,
                     const StudyReference& reference,
                     const fs::path& folder,
                     const StudyHands& hands) {
    fs::remove_all(folder);
    const StudyFrames frames = hands.render(index, folder);
    const Stopwatch watch;
    const CameraImage image = integrate_signals(folder, frames.manifest, folder);
    StudyMeasure measure{.setting = setting,
                         .wavelengths = frames.manifest.wavelengths.size(),
                         .frames = frames.manifest.frames.size(),
                         .promise = frames.promise,
                         .render_s = frames.render_s,
                         .integrate_s = watch.seconds()};
    measure_errors(image, reference.image, reference.on_edge, measure);
    fs::remove_all(folder);
    return measure;
}

// The files.

Json json_of(const StudyMeasure& measure, bool on_front) {
    Json json{{"name", measure.setting.name},
              {"words", measure.setting.words},
              {"equal_bands", measure.setting.equal_bands},
              {"wavelengths", measure.wavelengths},
              {"frames", measure.frames},
              {"time_s", measure.total_s()},
              {"on_front", on_front}};
    for (const NamedNumber& one : kNumbers) {
        const double value = measure.*one.number;
        json[one.name] = std::isfinite(value) ? Json(value) : Json();
    }
    return json;
}

StudyMeasure measure_of(const nlohmann::json& json) {
    StudyMeasure measure{
        .setting = {.name = json.at("name").get<std::string>(),
                    .words = json.at("words").get<std::string>(),
                    .equal_bands = json.at("equal_bands").get<bool>()},
        .wavelengths = static_cast<std::size_t>(whole_number_at(json, "wavelengths")),
        .frames = static_cast<std::size_t>(whole_number_at(json, "frames"))};
    for (const NamedNumber& one : kNumbers) {
        const nlohmann::json& value = json.at(one.name);
        measure.*one.number = value.is_null() ? kInfinity : value.get<double>();
    }
    return measure;
}

// The measures of study.json; names and words have no commas.
std::string study_csv(const Study& study) {
    const Json json = Json::parse(study_json(study));
    std::string head;
    std::string rows;
    for (const Json& measure : json.at("measures")) {
        head.clear();
        for (const auto& [name, value] : measure.items()) {
            head += (head.empty() ? "" : ",") + name;
            rows += name == measure.items().begin().key() ? "" : ",";
            rows += value.is_string() ? value.get<std::string>()
                    : value.is_null() ? "inf"
                                      : value.dump();
        }
        rows += '\n';
    }
    return head + '\n' + rows;
}

PlotCurve curve_of(const Study& study, bool equal_bands) {
    std::vector<const StudyMeasure*> drawn;
    for (const StudyMeasure& m : study.measures) {
        const bool has_logarithm = m.max_error > 0.0 && std::isfinite(m.max_error);
        if (m.setting.equal_bands == equal_bands && has_logarithm) drawn.push_back(&m);
    }
    std::ranges::sort(drawn, {}, &StudyMeasure::total_s);
    PlotCurve curve{.label = equal_bands ? "equal bands" : "fitted wavelengths",
                    .x = {},
                    .y = {},
                    .tone = equal_bands ? std::size_t{1} : std::size_t{0}};
    for (const StudyMeasure* m : drawn) {
        curve.x.push_back(m->total_s());
        curve.y.push_back(m->max_error);
        curve.points.push_back(fmt::format("{}", m->wavelengths));
    }
    return curve;
}

std::vector<PagePart> plot_of(const Study& study) {
    Plot plot{.title = "Largest error over time",
              .x_label = "time [s]",
              .y_label = "largest error |e|",
              .curves = {},
              .log_y = true};
    for (const bool equal_bands : {false, true}) {
        PlotCurve curve = curve_of(study, equal_bands);
        if (!curve.x.empty()) plot.curves.push_back(std::move(curve));
    }
    if (plot.curves.empty()) return {};
    return {"Each point is a setting, named by its number of wavelengths.",
            PagePlot{page_plot("time-plot", {&plot, 1}, 480.0)}};
}

PageTable table_of(const Study& study) {
    PageTable table{.columns = {"setting",
                                "wavelengths",
                                "frames",
                                "time [s]",
                                "× first",
                                "promised",
                                "largest error",
                                "99.9 %",
                                "rms",
                                "on edges",
                                ""}};
    const std::vector<bool> front = pareto_front(study.measures);
    for (std::size_t i = 0; i < study.measures.size(); ++i) {
        const StudyMeasure& m = study.measures[i];
        table.rows.push_back(
            {.cells = {m.setting.words,
                       grouped(m.wavelengths),
                       grouped(m.frames),
                       fmt::format("{:.2f}", m.total_s()),
                       fmt::format("{:.2f}", m.total_s() / study.measures.front().total_s()),
                       scientific(m.promise),
                       scientific(m.max_error),
                       scientific(m.percentile_999),
                       scientific(m.rms_error),
                       scientific(m.max_error_on_edges),
                       front[i] ? "✓ front" : ""}});
    }
    return table;
}

Page page_of(const Study& study) {
    const std::string title = study.rig_title.empty() ? "Untitled rig" : study.rig_title;
    return {.kind = "accuracy against time",
            .title = title + ": accuracy against time",
            .heading = title,
            .headline = fmt::format("{} of {} × {} pixels",
                                    grouped_count(study.measures.size(), "setting"),
                                    study.width_px,
                                    study.height_px),
            .said = {fmt::format(
                "With Aphotic {} and POV-Ray {} on {}: the wall time of each, and how far its "
                "image is from the reference’s over {}, which took {:.1f} s itself.",
                study.aphotic_version,
                study.povray_version,
                grouped_count(static_cast<std::size_t>(study.cores), "core"),
                grouped_count(study.grid_size, "wavelength"),
                study.trace_s)},
            .sections = {
                {.id = "time", .heading = "Error against time", .parts = plot_of(study)},
                {.id = "settings",
                 .heading = "Settings",
                 .parts = {table_of(study),
                           "Errors are e = (a − b) / max(|b|, b₀): a a pixel’s signal, b the "
                           "reference’s, b₀ 10⁻⁸ of the channel’s brightest, in the worst channel "
                           "and off the edges of beams, shadows and objects, except in the column "
                           "of edges. Time is POV-Ray’s and the integration’s. A setting is on the "
                           "Pareto front if no other beats it in both time and largest error.",
                           "Rig: SHA-256 " + study.rig_sha256}}}};
}

}  // namespace

Rig quick_rig(Rig rig) {
    // The reference is slower for an emitter's many lamps and behind a port.
    constexpr int kMostPixels = 350'000;
    constexpr int kMostSlowPixels = 90'000;
    const bool has_emitter = std::ranges::any_of(
        rig.strobes, [](const Strobe& strobe) { return strobe.emitter.has_value(); });
    const int most = has_emitter || rig.camera.port ? kMostSlowPixels : kMostPixels;
    Camera& camera = rig.camera;
    const auto too_large = [&](int d) {
        return std::int64_t{camera.width_px / d} * (camera.height_px / d) > most;
    };
    int least = 1;
    while (too_large(least)) ++least;
    // A divisor of both sizes preserves the field of view exactly; it is accepted if at most twice
    // as coarse.
    int divisor = least;
    for (int d = 2 * least; d >= least; --d) {
        if (camera.width_px % d == 0 && camera.height_px % d == 0) divisor = d;
    }
    enlarge_pixels(camera,
                   divisor,
                   std::max(1, camera.width_px / divisor),
                   std::max(1, camera.height_px / divisor));
    return rig;
}

void measure_errors(const CameraImage& image,
                    const CameraImage& reference,
                    std::span<const unsigned char> on_edge,
                    StudyMeasure& measure) {
    const std::size_t pixels = reference.samples.size() / kChannels;
    if (image.width_px != reference.width_px || image.height_px != reference.height_px ||
        image.samples.size() != reference.samples.size() ||
        !(on_edge.empty() || on_edge.size() == pixels)) {
        throw std::logic_error("measure_errors: images of different sizes");
    }
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto a = std::span(image.samples).subspan(c * pixels, pixels);
        const auto plane = std::span(reference.samples).subspan(c * pixels, pixels);
        const std::vector<double> b(plane.begin(), plane.end());
        const double brightest = b.empty() ? 0.0 : std::ranges::max(b);
        const Comparison found = compare_planes(std::string(kChannelNames[c]),
                                                a,
                                                b,
                                                reference.width_px,
                                                on_edge,
                                                kBlackShare * brightest,
                                                kInfinity);
        const bool is_measured = found.compared > 0 && found.not_finite == 0;
        const auto take = [&](double StudyMeasure::*to, double error) {
            measure.*to = std::max(measure.*to, is_measured ? error : kInfinity);
        };
        take(&StudyMeasure::max_error, found.max_error);
        take(&StudyMeasure::percentile_999, found.percentile_999);
        take(&StudyMeasure::rms_error, found.rms_error);
        take(&StudyMeasure::max_error_on_edges, found.max_error_on_edges);
    }
}

std::vector<bool> pareto_front(std::span<const StudyMeasure> measures) {
    std::vector<bool> front;
    for (const StudyMeasure& measure : measures) {
        const bool beaten = std::ranges::any_of(
            measures, [&](const StudyMeasure& other) { return beats(other, measure); });
        front.push_back(!beaten && std::isfinite(measure.max_error));
    }
    return front;
}

void run_study(Study& study,
               const Rig& rig,
               const std::vector<StudySetting>& settings,
               const fs::path& folder,
               const StudyHands& hands) {
    const fs::path file = folder / "study.json";
    const StudyReference reference = study_reference(study, rig, folder / "reference", hands);
    std::vector<StudyMeasure> kept;
    if (fs::exists(file)) kept = measures_in(read_text_file(file), study);
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const auto measured = std::ranges::find(
            kept, settings[i].name, [](const StudyMeasure& one) { return one.setting.name; });
        if (measured != kept.end()) {
            study.measures.push_back(*measured);
            continue;
        }
        study.measures.push_back(
            measure(settings[i], i, reference, folder / "settings" / settings[i].name, hands));
        // Including those still to be measured, so that an interruption loses none of them.
        Study so_far = study;
        so_far.measures.insert(so_far.measures.end(), kept.begin(), kept.end());
        write_text_file(file, study_json(so_far));
    }
}

std::string study_json(const Study& study) {
    Json json = subject_of(study);
    json["rule"] =
        "e = (a - b) / max(|b|, black), a: a pixel's signal, b: the reference's, black: 1e-8 of "
        "the channel's brightest; errors are of |e| in the worst channel, off the edges unless "
        "said otherwise";
    json["reference"] = {{"wavelengths", study.grid_size}, {"time_s", study.trace_s}};
    const std::vector<bool> front = pareto_front(study.measures);
    json["measures"] = Json::array();
    for (std::size_t i = 0; i < study.measures.size(); ++i)
        json["measures"].push_back(json_of(study.measures[i], front[i]));
    return json_text(json);
}

std::vector<StudyMeasure> measures_in(std::string_view text, const Study& study) {
    try {
        const nlohmann::json json = parse_json(text, "study");
        const nlohmann::json subject(subject_of(study));
        for (const auto& [name, value] : subject.items()) {
            if (json.at(name) != value) return {};
        }
        std::vector<StudyMeasure> measures;
        for (const nlohmann::json& one : json.at("measures")) measures.push_back(measure_of(one));
        return measures;
    } catch (const nlohmann::json::exception&) {
        return {};
    } catch (const InputError&) {
        return {};
    }
}

void write_study(const Study& study, const fs::path& folder) {
    write_text_file(folder / "study.csv", study_csv(study));
    write_text_file(folder / "study.json", study_json(study));
    write_text_file(folder / "study.html", page_html(page_of(study)));
}

}  // namespace aphotic
