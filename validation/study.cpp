// SPDX-License-Identifier: BSD-3-Clause
#include "validation/study.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_text.h"
#include "spectral/sensor.h"
#include "validation/saved_measure.h"
#include "validation/study_page.h"
#include "validation/validation.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
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

StudySetting plain_setting(const char* kind, int count, int cores) {
    StudySetting setting;
    setting.name = fmt::format("{}-{}", kind, count);
    setting.subject = "wavelengths";
    setting.jobs = cores;
    return setting;
}

StudySetting fitted_setting(int count, int cores) {
    StudySetting setting = plain_setting("fitted", count, cores);
    setting.words = fmt::format("{} fitted wavelengths", count);
    setting.fitted = count;
    return setting;
}

StudySetting bands_setting(int count, int cores) {
    StudySetting setting = plain_setting("bands", count, cores);
    setting.words = fmt::format("{} equal bands", count);
    setting.bands = count;
    return setting;
}

// A setting that differs from another in what it is about.
StudySetting varied(StudySetting setting,
                    std::string subject,
                    std::string_view suffix,
                    std::string_view words) {
    setting.subject = std::move(subject);
    setting.name += fmt::format("-{}", suffix);
    setting.words += fmt::format(", {}", words);
    return setting;
}

StudySetting one_a_frame(const StudySetting& base) {
    StudySetting setting = varied(base, "packing", "mono", "one a frame");
    setting.per_frame = 1;
    return setting;
}

StudySetting one_job(const StudySetting& base) {
    StudySetting setting = varied(base, "jobs", "jobs-1", "one job");
    setting.jobs = 1;
    return setting;
}

StudySetting one_soft_lamp(const StudySetting& base) {
    StudySetting setting = varied(base, "emitters", "soft", "one soft lamp");
    setting.one_soft_lamp = true;
    return setting;
}

StudySetting png_frames(const StudySetting& base) {
    StudySetting setting = varied(base, "frames", "png", "16-bit PNG");
    setting.png = true;
    return setting;
}

StudySetting antialiased(const StudySetting& base) {
    StudySetting setting = varied(base, "antialiasing", "antialias", "antialiased");
    setting.antialias = true;
    return setting;
}

// None where the image's size does not divide.
std::vector<StudySetting> shrunk_settings(const Rig& rig,
                                          const StudySetting& base,
                                          int shrink,
                                          std::span<const char* const> filters) {
    if (rig.camera.width_px % shrink != 0 || rig.camera.height_px % shrink != 0) return {};
    const char* size = shrink == 2 ? "half" : "quarter";
    std::vector<StudySetting> settings;
    for (const char* filter : filters) {
        settings.push_back(varied(base,
                                  "resolution",
                                  fmt::format("{}-{}", size, filter),
                                  fmt::format("{} size, {}", size, filter)));
        settings.back().shrink = shrink;
        settings.back().filter = filter;
    }
    return settings;
}

void append(std::vector<StudySetting>& settings, std::vector<StudySetting> more) {
    std::ranges::move(more, std::back_inserter(settings));
}

std::vector<StudySetting> quick_settings(const Rig& rig, int cores) {
    static constexpr std::array<const char*, 1> kFilters{"lanczos3"};
    const StudySetting base = fitted_setting(3, cores);
    std::vector<StudySetting> settings{
        base, fitted_setting(6, cores), bands_setting(6, cores), bands_setting(12, cores)};
    append(settings, shrunk_settings(rig, base, 2, kFilters));
    if (has_emitter(rig)) settings.push_back(one_soft_lamp(base));
    settings.push_back(png_frames(base));
    return settings;
}

std::vector<StudySetting> full_settings(const Rig& rig, int cores) {
    static constexpr std::array<const char*, 3> kFilters{"triangle", "catmull-rom", "lanczos3"};
    const StudySetting base = fitted_setting(3, cores);
    std::vector<StudySetting> settings{base, fitted_setting(6, cores), fitted_setting(9, cores)};
    for (const int count : {3, 6, 9, 12, 18, 24, 36, 48, 72})
        settings.push_back(bands_setting(count, cores));
    settings.push_back(one_a_frame(base));
    settings.push_back(one_a_frame(bands_setting(36, cores)));
    append(settings, shrunk_settings(rig, base, 2, kFilters));
    append(settings, shrunk_settings(rig, base, 4, kFilters));
    if (has_emitter(rig)) settings.push_back(one_soft_lamp(base));
    settings.push_back(png_frames(base));
    settings.push_back(antialiased(base));
    if (cores > 1) settings.push_back(one_job(bands_setting(12, cores)));
    return settings;
}

// Measures.

bool is_measured(const Comparison& channel) {
    return channel.compared > 0 && channel.not_finite == 0;
}

double worst(const std::array<Comparison, 3>& channels, double Comparison::*error) {
    double largest = 0.0;
    for (const Comparison& channel : channels)
        largest = std::max(largest, is_measured(channel) ? channel.*error : kInfinity);
    return largest;
}

bool beats(const StudyMeasure& a, const StudyMeasure& b) {
    const bool as_good = a.total_s() <= b.total_s() && a.max_error() <= b.max_error();
    return as_good && (a.total_s() < b.total_s() || a.max_error() < b.max_error());
}

// study.csv

// RFC 4180: quotes where the text would end the field.
std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

using Columns = std::vector<std::pair<std::string, std::string>>;

Columns columns_of(const StudySetting& setting) {
    return {{"name", setting.name},
            {"subject", setting.subject},
            {"words", setting.words},
            {"fitted", fmt::format("{}", setting.fitted)},
            {"bands", fmt::format("{}", setting.bands)},
            {"per_frame", fmt::format("{}", setting.per_frame)},
            {"shrink", fmt::format("{}", setting.shrink)},
            {"filter", setting.filter},
            {"one_soft_lamp", fmt::format("{}", setting.one_soft_lamp)},
            {"png", fmt::format("{}", setting.png)},
            {"antialias", fmt::format("{}", setting.antialias)},
            {"jobs", fmt::format("{}", setting.jobs)}};
}

std::string ratio_to_baseline(const Study& study, const StudyMeasure& measure) {
    const auto ratio = time_ratio(study.measures, measure.setting.name, kBaseline);
    return ratio ? fmt::format("{}", *ratio) : "";
}

// By measure, every column with its name.
Columns columns_of(const Study& study, const StudyMeasure& measure, bool on_front) {
    Columns columns = columns_of(measure.setting);
    const auto add = [&](const std::string& name, double value) {
        columns.emplace_back(name, fmt::format("{}", value));
    };
    columns.emplace_back("wavelengths", fmt::format("{}", measure.wavelengths));
    columns.emplace_back("frames", fmt::format("{}", measure.frames));
    columns.emplace_back("promise",
                         measure.promise_applies() ? fmt::format("{}", measure.promise) : "");
    add("render_s", measure.render_s);
    add("integrate_s", measure.integrate_s);
    add("total_s", measure.total_s());
    columns.emplace_back("time_ratio", ratio_to_baseline(study, measure));
    add("max_error", measure.max_error());
    add("percentile_999", measure.percentile_999());
    add("rms_error", measure.rms_error());
    add("max_error_off_edges", measure.max_error_off_edges());
    add("max_error_on_edges", measure.max_error_on_edges());
    for (std::size_t c = 0; c < measure.channels.size(); ++c) {
        add(fmt::format("max_error_{}", kChannelNames[c]), measure.channels[c].max_error);
        add(fmt::format("mean_error_{}", kChannelNames[c]), measure.channels[c].mean_error);
    }
    columns.emplace_back("on_front", fmt::format("{}", on_front));
    return columns;
}

std::string csv_line(const Columns& columns, std::string Columns::value_type::*part) {
    std::string line;
    for (const auto& column : columns) {
        if (!line.empty()) line += ',';
        line += csv_field(column.*part);
    }
    return line + '\n';
}

std::string csv_of(const Study& study) {
    const std::vector<bool> front = pareto_front(study.measures);
    // The header stands even over no rows.
    std::string csv = csv_line(columns_of(study, {}, false), &Columns::value_type::first);
    for (std::size_t i = 0; i < study.measures.size(); ++i) {
        csv +=
            csv_line(columns_of(study, study.measures[i], front[i]), &Columns::value_type::second);
    }
    return csv;
}

// study.json

Json json_of(const StudySetting& setting) {
    return {{"fitted", setting.fitted},
            {"bands", setting.bands},
            {"per_frame", setting.per_frame},
            {"shrink", setting.shrink},
            {"filter", setting.filter},
            {"one_soft_lamp", setting.one_soft_lamp},
            {"png", setting.png},
            {"antialias", setting.antialias},
            {"jobs", setting.jobs}};
}

Json ratio_of(const Study& study, std::string_view name) {
    const auto ratio = time_ratio(study.measures, name, kBaseline);
    return ratio ? Json(*ratio) : Json();
}

Json json_of(const Study& study, const StudyMeasure& measure, bool on_front) {
    return {{"name", measure.setting.name},
            {"subject", measure.setting.subject},
            {"words", measure.setting.words},
            {"setting", json_of(measure.setting)},
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

}  // namespace

std::vector<StudySetting> study_settings(const Rig& rig, bool quick, int cores) {
    return quick ? quick_settings(rig, cores) : full_settings(rig, cores);
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
    camera.width_px = std::max(1, camera.width_px / divisor);
    camera.height_px = std::max(1, camera.height_px / divisor);
    camera.pixel_pitch_m *= divisor;
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

double StudyMeasure::max_error_off_edges() const {
    return worst(channels, &Comparison::max_error);
}

double StudyMeasure::percentile_999() const {
    return worst(channels, &Comparison::percentile_999);
}

double StudyMeasure::rms_error() const {
    return worst(channels, &Comparison::rms_error);
}

double StudyMeasure::max_error_on_edges() const {
    return worst(channels, &Comparison::max_error_on_edges);
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
