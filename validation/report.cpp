// SPDX-License-Identifier: BSD-3-Clause
#include "validation/report.h"

#include "base/atomic_file.h"
#include "base/json_text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cassert>
#include <limits>

namespace aphotic {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Comparison& comparison) {
    Json json = comparison_json(comparison);
    json.update({{"holds", comparison.holds()},
                 {"bound", comparison.bound},
                 {"in_penumbrae", comparison.in_penumbrae},
                 {"max_error_of_penumbrae", comparison.max_error_of_penumbrae},
                 {"floor", comparison.floor},
                 {"under_floor", comparison.under_floor}});
    return json;
}

Json json_of(const Estimate& estimate) {
    return {{"mean", estimate.mean}, {"standard_error", estimate.standard_error}};
}

Json json_of(const ModelCheck& model) {
    Json places = Json::array();
    for (const ModelPlace& place : model.places) {
        places.push_back({{"column", place.column},
                          {"row", place.row},
                          {"channel", kChannelNames[place.channel]},
                          {"lambda_nm", place.lambda_nm},
                          {"floor", place.floor},
                          {"veil", place.veil},
                          {"floor_of_all_orders", json_of(place.truth.floor)},
                          {"veil_of_all_orders", json_of(place.truth.veil)},
                          {"sum_of_all_orders", json_of(place.truth.sum)},
                          {"error", place.error()}});
    }
    return {{"paths", model.paths}, {"rms", model.rms()}, {"places", places}};
}

}  // namespace

double share_of_bound(const Comparison& comparison) {
    if (comparison.not_finite > 0) return std::numeric_limits<double>::infinity();
    if (comparison.max_error == 0.0) return 0.0;
    return comparison.max_error / comparison.bound;
}

std::vector<const Comparison*> ValidationReport::all() const {
    std::vector<const Comparison*> comparisons;
    for (const auto* list : {&wavelengths, &channels}) {
        for (const Comparison& one : *list) comparisons.push_back(&one);
    }
    return comparisons;
}

bool ValidationReport::holds() const {
    return !all().empty() && std::ranges::all_of(all(), &Comparison::holds);
}

const Comparison& ValidationReport::worst() const {
    const std::vector<const Comparison*> comparisons = all();
    assert(!comparisons.empty());
    return **std::ranges::max_element(
        comparisons, {}, [](const Comparison* one) { return share_of_bound(*one); });
}

std::size_t ValidationReport::worst_channel() const {
    assert(!channels.empty());
    return static_cast<std::size_t>(std::ranges::max_element(channels, {}, share_of_bound) -
                                    channels.begin());
}

EdgeSummary ValidationReport::edges() const {
    EdgeSummary sum;
    const double pixels = static_cast<double>(traced.width_px) * traced.height_px;
    for (const Comparison* one : all()) {
        sum.share = std::max(sum.share, static_cast<double>(one->on_edges) / pixels);
        sum.max_error = std::max(sum.max_error, one->max_error_on_edges);
        sum.share_in_penumbrae =
            std::max(sum.share_in_penumbrae, static_cast<double>(one->in_penumbrae) / pixels);
        sum.max_error_of_penumbrae =
            std::max(sum.max_error_of_penumbrae, one->max_error_of_penumbrae);
    }
    return sum;
}

std::string validation_json(const ValidationReport& report) {
    const Comparison& worst = report.worst();
    Json rig{{"title", report.rig.title}, {"sha256", report.rig.digest}};
    if (!report.scene_file.empty()) rig["scene"] = report.scene_file;
    Json wavelengths = Json::array();
    for (std::size_t i = 0; i < report.wavelengths.size(); ++i) {
        wavelengths.push_back({{"lambda_nm", report.lambda_nm[i]}});
        wavelengths.back().update(json_of(report.wavelengths[i]));
    }
    Json channels = Json::array();
    for (const Comparison& channel : report.channels) channels.push_back(json_of(channel));
    Json json{
        {"holds", report.holds()},
        {"worst",
         {{"name", worst.name},
          {"max_error", worst.max_error},
          {"bound", worst.bound},
          {"share_of_bound", share_of_bound(worst)},
          {"column", worst.column},
          {"row", worst.row},
          {"not_finite", worst.not_finite}}},
        {"rule",
         "e = (a - b) / max(|b|, floor), a: POV-Ray's image, b: the reference; holds: max |e| off "
         "the edges <= bound and every sample finite; in penumbrae b is of the render's own lamps"},
        {"rig", rig},
        {"image",
         {{"width_px", report.rendered.width_px}, {"height_px", report.rendered.height_px}}},
        {"wavelengths", wavelengths},
        {"channels", channels},
        {"lamp_signal", report.lamp_signal},
        {"reference_wavelengths", report.grid_size},
        {"frames", report.frames},
        {"jobs", report.jobs},
        {"versions", {{"aphotic", report.aphotic_version}, {"povray", report.povray_version}}},
        {"time_s",
         {{"render", report.render_s},
          {"integrate", report.integrate_s},
          {"trace", report.trace_s}}}};
    if (report.has_veil()) json["veil_in_the_middle"] = report.veil_share;
    if (!report.model.places.empty()) json["model"] = json_of(report.model);
    return json_text(json);
}

void write_validation_json(const ValidationReport& report, const std::filesystem::path& file) {
    write_text_file(file, validation_json(report));
}

}  // namespace aphotic
