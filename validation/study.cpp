// SPDX-License-Identifier: BSD-3-Clause
#include "validation/study.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_text.h"
#include "rig/lens.h"
#include "spectral/sensor.h"
#include "validation/saved_measure.h"
#include "validation/validation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace aphotic {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool has_emitter(const Rig& rig) {
    return std::ranges::any_of(rig.strobes,
                               [](const Strobe& strobe) { return strobe.emitter.has_value(); });
}

// Settings.

StudySetting fitted_setting(int count, int cores) {
    return {.name = fmt::format("fitted-{}", count),
            .subject = "wavelengths",
            .words = fmt::format("{} fitted wavelengths", count),
            .fitted = count,
            .jobs = cores};
}

StudySetting bands_setting(int count, int cores) {
    return {.name = fmt::format("bands-{}", count),
            .subject = "wavelengths",
            .words = fmt::format("{} equal bands", count),
            .bands = count,
            .jobs = cores};
}

// A setting that differs from another in what it is about.
template <typename Value>
StudySetting varied(StudySetting setting,
                    std::string_view subject,
                    std::string_view suffix,
                    std::string_view words,
                    Value StudySetting::*what,
                    const Value& value) {
    setting.subject = subject;
    setting.name += fmt::format("-{}", suffix);
    setting.words += fmt::format(", {}", words);
    setting.*what = value;
    return setting;
}

StudySetting one_a_frame(const StudySetting& base) {
    return varied(base, "packing", "mono", "one a frame", &StudySetting::per_frame, 1);
}

// None where the image's size does not divide.
void add_shrunk(std::vector<StudySetting>& settings,
                const Rig& rig,
                int shrink,
                std::initializer_list<std::string> filters) {
    if (rig.camera.width_px % shrink != 0 || rig.camera.height_px % shrink != 0) return;
    const char* size = shrink == 2 ? "half" : "quarter";
    for (const std::string& filter : filters) {
        settings.push_back(varied(settings.front(),
                                  "resolution",
                                  fmt::format("{}-{}", size, filter),
                                  fmt::format("{} size, {}", size, filter),
                                  &StudySetting::filter,
                                  filter));
        settings.back().shrink = shrink;
    }
}

void add_coarse_lamps_and_frames(std::vector<StudySetting>& settings, const Rig& rig) {
    const StudySetting base = settings.front();
    if (has_emitter(rig)) {
        settings.push_back(
            varied(base, "emitters", "soft", "one soft lamp", &StudySetting::one_soft_lamp, true));
    }
    settings.push_back(varied(base, "frames", "png", "16-bit PNG", &StudySetting::png, true));
}

// Measures.

bool beats(const StudyMeasure& a, const StudyMeasure& b) {
    const bool as_good = a.total_s() <= b.total_s() && a.max_error() <= b.max_error();
    return as_good && (a.total_s() < b.total_s() || a.max_error() < b.max_error());
}

// study.json

Json ratio_of(const Study& study, std::string_view name) {
    const auto ratio = time_ratio(study.measures, name, kBaseline);
    return ratio ? Json(*ratio) : Json();
}

Json json_of(const Study& study, const StudyMeasure& measure, bool on_front) {
    return {{"name", measure.setting.name},
            {"subject", measure.setting.subject},
            {"words", measure.setting.words},
            {"setting", setting_json(measure.setting)},
            {"wavelengths", measure.wavelengths},
            {"frames", measure.frames},
            {"promise", measure.promise_applies() ? Json(measure.promise) : Json()},
            {"time_s",
             {{"render", measure.render_s},
              {"integrate", measure.integrate_s},
              {"total", measure.total_s()}}},
            {"time_ratio", ratio_of(study, measure.setting.name)},
            {"on_front", on_front},
            {"max_error", measure.max_error()},
            {"percentile_999", measure.percentile_999()},
            {"rms_error", measure.rms_error()},
            {"max_error_off_edges", measure.max_error_off_edges()},
            {"max_error_on_edges", measure.max_error_on_edges()},
            {"channels", json_of_channels(measure)}};
}

Json measures_of(const Study& study) {
    const std::vector<bool> front = pareto_front(study.measures);
    Json measures = Json::array();
    for (std::size_t i = 0; i < study.measures.size(); ++i)
        measures.push_back(json_of(study, study.measures[i], front[i]));
    return measures;
}

Json json_of(const Study& study) {
    const auto best = recommended(study.measures, study.tolerance);
    return {
        {"rig", {{"title", study.rig_title}, {"sha256", study.rig_sha256}}},
        {"image", {{"width_px", study.width_px}, {"height_px", study.height_px}}},
        {"versions", {{"aphotic", study.aphotic_version}, {"povray", study.povray_version}}},
        {"cores", study.cores},
        {"quick", study.quick},
        {"rule",
         "e = (a - b) / max(|b|, black), a: a pixel's signal, b: the reference's, black: 1e-8 "
         "of the channel's brightest; errors are of |e| in the worst channel, off the cones' "
         "edges unless said otherwise"},
        {"reference", {{"wavelengths", study.grid_size}, {"time_s", study.trace_s}}},
        {"tolerance", study.tolerance},
        {"recommended", best ? Json(study.measures[*best].setting.name) : Json()},
        {"time_ratios",
         {{fmt::format("{} / {}", kCustomary, kBaseline), ratio_of(study, kCustomary)},
          {fmt::format("{} / {}", kCustomaryMono, kBaseline), ratio_of(study, kCustomaryMono)}}},
        {"measures", measures_of(study)}};
}

// study.csv

// RFC 4180: quotes where the text would end the field.
std::string csv_field(const Json& value) {
    if (value.is_null()) return "";
    if (value.is_number_float()) return fmt::format("{}", value.get<double>());
    if (!value.is_string()) return value.dump();
    const auto& text = value.get_ref<const std::string&>();
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

// A measure of study.json in one row: settings by their names, times as render_s, and of each
// channel the largest and the mean error.
Json flat(const Json& measure) {
    Json row;
    for (const auto& [name, value] : measure.items()) {
        if (name == "setting") {
            row.update(value);
        } else if (name == "time_s") {
            for (const auto& [part, time_s] : value.items()) row[part + "_s"] = time_s;
        } else if (name == "channels") {
            for (const Json& channel : value) {
                for (const std::string quantity : {"max_error", "mean_error"}) {
                    row[quantity + "_" + channel["name"].get<std::string>()] = channel[quantity];
                }
            }
        } else {
            row[name] = value;
        }
    }
    return row;
}

std::string csv_of(const Study& study) {
    const auto line = [](const std::vector<std::string>& fields) {
        return fmt::format("{}\n", fmt::join(fields, ","));
    };
    std::string csv;
    for (const Json& measure : measures_of(study)) {
        std::vector<std::string> names;
        std::vector<std::string> fields;
        const Json row = flat(measure);
        for (const auto& [name, value] : row.items()) {
            names.push_back(name);
            fields.push_back(csv_field(value));
        }
        if (csv.empty()) csv = line(names);
        csv += line(fields);
    }
    return csv;
}

}  // namespace

std::vector<StudySetting> study_settings(const Rig& rig, bool quick, int cores) {
    std::vector<StudySetting> settings{fitted_setting(3, cores), fitted_setting(6, cores)};
    if (quick) {
        for (const int count : {6, 12}) settings.push_back(bands_setting(count, cores));
        add_shrunk(settings, rig, 2, {"lanczos3"});
        add_coarse_lamps_and_frames(settings, rig);
        return settings;
    }
    settings.push_back(fitted_setting(9, cores));
    for (const int count : {3, 6, 9, 12, 18, 24, 36, 48, 72}) {
        settings.push_back(bands_setting(count, cores));
    }
    settings.push_back(one_a_frame(settings.front()));
    settings.push_back(one_a_frame(bands_setting(36, cores)));
    for (const int shrink : {2, 4}) {
        add_shrunk(settings, rig, shrink, {"triangle", "catmull-rom", "lanczos3"});
    }
    add_coarse_lamps_and_frames(settings, rig);
    settings.push_back(varied(settings.front(),
                              "antialiasing",
                              "antialias",
                              "antialiased",
                              &StudySetting::antialias,
                              true));
    if (cores > 1) {
        settings.push_back(
            varied(bands_setting(12, cores), "jobs", "jobs-1", "one job", &StudySetting::jobs, 1));
    }
    return settings;
}

Rig quick_rig(Rig rig) {
    // The reference is slower for an emitter's many lamps and behind a port.
    constexpr int kMostPixels = 350'000;
    constexpr int kMostSlowPixels = 90'000;
    const int most = has_emitter(rig) || rig.camera.port ? kMostSlowPixels : kMostPixels;
    Camera& camera = rig.camera;
    const auto too_large = [&](int d) {
        return std::int64_t{camera.width_px / d} * (camera.height_px / d) > most;
    };
    int least = 1;
    while (too_large(least)) ++least;
    // A divisor of both sizes keeps the field of view exactly, but not at any price: twice as
    // coarse is the most.
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

bool StudyMeasure::promise_applies() const {
    return setting.shrink == 1 && !setting.one_soft_lamp && !setting.png && !setting.antialias;
}

bool StudyMeasure::blurs_edges() const {
    return setting.shrink > 1 || setting.one_soft_lamp || setting.antialias;
}

double StudyMeasure::max_error() const {
    return blurs_edges() ? std::max(max_error_off_edges(), max_error_on_edges())
                         : max_error_off_edges();
}

double StudyMeasure::worst(double Comparison::*error) const {
    double largest = 0.0;
    for (const Comparison& channel : channels) {
        const bool is_measured = channel.compared > 0 && channel.not_finite == 0;
        largest = std::max(largest, is_measured ? channel.*error : kInfinity);
    }
    return largest;
}

std::array<Comparison, 3> compare_signals(const CameraImage& image,
                                          const CameraImage& reference,
                                          std::span<const unsigned char> on_edge) {
    const std::size_t pixels = reference.samples.size() / kChannels;
    if (image.width_px != reference.width_px || image.height_px != reference.height_px ||
        image.samples.size() != reference.samples.size() ||
        !(on_edge.empty() || on_edge.size() == pixels)) {
        throw std::logic_error("compare_signals: images of different sizes");
    }
    std::array<Comparison, 3> channels{};
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const auto a = std::span(image.samples).subspan(c * pixels, pixels);
        const auto plane = std::span(reference.samples).subspan(c * pixels, pixels);
        const std::vector<double> b(plane.begin(), plane.end());
        const double brightest = b.empty() ? 0.0 : std::ranges::max(b);
        channels[c] = compare_planes(std::string(kChannelNames[c]),
                                     a,
                                     b,
                                     reference.width_px,
                                     on_edge,
                                     kBlackShare * brightest,
                                     kInfinity);
    }
    return channels;
}

std::vector<bool> pareto_front(std::span<const StudyMeasure> measures) {
    std::vector<bool> front;
    for (const StudyMeasure& measure : measures) {
        const bool beaten = std::ranges::any_of(
            measures, [&](const StudyMeasure& other) { return beats(other, measure); });
        front.push_back(!beaten && std::isfinite(measure.max_error()));
    }
    return front;
}

std::optional<std::size_t> recommended(std::span<const StudyMeasure> measures, double tolerance) {
    // Of equally fast ones the most accurate.
    const auto key = [&](std::size_t i) {
        return std::tuple(measures[i].total_s(), measures[i].max_error());
    };
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < measures.size(); ++i) {
        const bool keeps = measures[i].max_error() <= tolerance;
        if (keeps && (!best || key(i) < key(*best))) best = i;
    }
    return best;
}

const StudyMeasure* find_measure(std::span<const StudyMeasure> measures, std::string_view name) {
    const auto found = std::ranges::find_if(
        measures, [&](const StudyMeasure& measure) { return measure.setting.name == name; });
    return found == measures.end() ? nullptr : &*found;
}

std::optional<double> time_ratio(std::span<const StudyMeasure> measures,
                                 std::string_view name,
                                 std::string_view other) {
    const StudyMeasure* a = find_measure(measures, name);
    const StudyMeasure* b = find_measure(measures, other);
    if (a == nullptr || b == nullptr || !(b->total_s() > 0.0)) return std::nullopt;
    return a->total_s() / b->total_s();
}

void write_study(const Study& study, const std::filesystem::path& folder) {
    write_text_file(folder / "study.csv", csv_of(study));
    write_text_file(folder / "study.json", json_text(json_of(study)));
    write_text_file(folder / "study.html", study_page(study));
}

}  // namespace aphotic
