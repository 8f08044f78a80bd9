// SPDX-License-Identifier: BSD-3-Clause
#include "validation/saved_measure.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_text.h"
#include "image/image_size.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

namespace aphotic {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// JSON has no infinity: null stands for it.
double number(const nlohmann::json& json, const char* name) {
    const nlohmann::json& value = json.at(name);
    return value.is_null() ? kUnbounded : value.get<double>();
}

std::size_t count(const nlohmann::json& json, const char* name) {
    return static_cast<std::size_t>(whole_number_at(json, name));
}

Comparison comparison_from(const nlohmann::json& json) {
    const auto pixel = [&](const char* name) {
        return static_cast<int>(whole_number_at(json, name, 0, kLargestImagePx - 1));
    };
    return {.name = json.at("name").get<std::string>(),
            .max_error = number(json, "max_error"),
            .column = pixel("column"),
            .row = pixel("row"),
            .percentile_999 = number(json, "percentile_999"),
            .rms_error = number(json, "rms_error"),
            .mean_error = number(json, "mean_error"),
            .compared = count(json, "compared"),
            .on_edges = count(json, "on_edges"),
            .max_error_on_edges = number(json, "max_error_on_edges"),
            .not_finite = count(json, "not_finite"),
            .bound = kUnbounded};
}

std::optional<StudyMeasure> measure_from(const nlohmann::json& json, const StudySetting& setting) {
    StudyMeasure measure{.setting = setting,
                         .wavelengths = count(json, "wavelengths"),
                         .frames = count(json, "frames"),
                         .promise = number(json, "promise"),
                         .render_s = json.at("render_s").get<double>(),
                         .integrate_s = json.at("integrate_s").get<double>(),
                         .channels = {}};
    const nlohmann::json& channels = json.at("channels");
    if (channels.size() != measure.channels.size()) return std::nullopt;
    std::ranges::transform(channels, measure.channels.begin(), comparison_from);
    return measure;
}

}  // namespace

Json setting_json(const StudySetting& setting) {
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

Json json_of_channels(const StudyMeasure& measure) {
    Json channels = Json::array();
    for (const Comparison& channel : measure.channels) channels.push_back(comparison_json(channel));
    return channels;
}

void save_measure(const StudyMeasure& measure,
                  const std::string& key,
                  const std::filesystem::path& file) {
    const Json json{{"key", key},
                    {"name", measure.setting.name},
                    {"wavelengths", measure.wavelengths},
                    {"frames", measure.frames},
                    {"promise", measure.promise},
                    {"render_s", measure.render_s},
                    {"integrate_s", measure.integrate_s},
                    {"channels", json_of_channels(measure)}};
    write_text_file(file, json_text(json));
}

std::optional<StudyMeasure> saved_measure(const StudySetting& setting,
                                          const std::string& key,
                                          const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) return std::nullopt;
    return parse_measure(read_text_file(file), setting, key);
}

std::optional<StudyMeasure> parse_measure(std::string_view text,
                                          const StudySetting& setting,
                                          const std::string& key) {
    try {
        const nlohmann::json json = parse_json(text, "measure");
        if (json.at("key").get<std::string>() != key) return std::nullopt;
        return measure_from(json, setting);
    } catch (const Json::exception&) {
        return std::nullopt;
    } catch (const InputError&) {
        return std::nullopt;
    }
}

}  // namespace aphotic
