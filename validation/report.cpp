// SPDX-License-Identifier: BSD-3-Clause
#include "validation/report.h"

#include "base/atomic_file.h"
#include "base/json_text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cassert>
#include <limits>
#include <stdexcept>
#include <string>

namespace aphotic {
namespace {

using Json = nlohmann::ordered_json;

bool is_better(const Comparison& a, const Comparison& b) {
    return share_of_bound(a) < share_of_bound(b);
}

Json json_of(const Comparison& comparison) {
    return {{"name", comparison.name},
            {"holds", comparison.holds()},
            {"bound", comparison.bound},
            {"max_error", comparison.max_error},
            {"column", comparison.column},
            {"row", comparison.row},
            {"percentile_999", comparison.percentile_999},
            {"rms_error", comparison.rms_error},
            {"mean_error", comparison.mean_error},
            {"compared", comparison.compared},
            {"on_edges", comparison.on_edges},
            {"max_error_on_edges", comparison.max_error_on_edges},
            {"in_penumbrae", comparison.in_penumbrae},
            {"max_error_of_penumbrae", comparison.max_error_of_penumbrae},
            {"floor", comparison.floor},
            {"under_floor", comparison.under_floor},
            {"not_finite", comparison.not_finite}};
}

Json wavelengths_of(const ValidationReport& report) {
    Json list = Json::array();
    for (std::size_t i = 0; i < report.wavelengths.size(); ++i) {
        Json entry{{"lambda_nm", report.lambda_nm[i]}};
        entry.update(json_of(report.wavelengths[i]));
        list.push_back(std::move(entry));
    }
    return list;
}

Json rig_of(const ValidationReport& report) {
    Json rig{{"title", report.rig.title}, {"sha256", report.rig.digest}};
    if (!report.scene_file.empty()) rig["scene"] = report.scene_file;
    return rig;
}

Json channels_of(const ValidationReport& report) {
    Json list = Json::array();
    for (const Comparison& channel : report.channels) list.push_back(json_of(channel));
    return list;
}

}  // namespace

double share_of_bound(const Comparison& comparison) {
    if (comparison.not_finite > 0) return std::numeric_limits<double>::infinity();
    if (comparison.max_error == 0.0) return 0.0;
    return comparison.max_error / comparison.bound;
}

bool ValidationReport::holds() const {
    const auto holds = [](const Comparison& comparison) { return comparison.holds(); };
    return !(wavelengths.empty() && channels.empty()) && std::ranges::all_of(wavelengths, holds) &&
           std::ranges::all_of(channels, holds);
}

const Comparison& ValidationReport::worst() const {
    assert(!(wavelengths.empty() && channels.empty()));
    if (channels.empty()) return *std::ranges::max_element(wavelengths, is_better);
    const Comparison& channel = channels[worst_channel()];
    if (wavelengths.empty()) return channel;
    const Comparison& wavelength = *std::ranges::max_element(wavelengths, is_better);
    return is_better(wavelength, channel) ? channel : wavelength;
}

std::size_t ValidationReport::worst_channel() const {
    assert(!channels.empty());
    return static_cast<std::size_t>(std::ranges::max_element(channels, is_better) -
                                    channels.begin());
}

EdgeSummary ValidationReport::edges() const {
    EdgeSummary all;
    const double pixels = static_cast<double>(traced.width_px) * traced.height_px;
    const auto take_in = [&](const Comparison& one) {
        all.share = std::max(all.share, static_cast<double>(one.on_edges) / pixels);
        all.max_error = std::max(all.max_error, one.max_error_on_edges);
        all.share_in_penumbrae =
            std::max(all.share_in_penumbrae, static_cast<double>(one.in_penumbrae) / pixels);
        all.max_error_of_penumbrae =
            std::max(all.max_error_of_penumbrae, one.max_error_of_penumbrae);
    };
    std::ranges::for_each(wavelengths, take_in);
    std::ranges::for_each(channels, take_in);
    return all;
}

void ValidationReport::check() const {
    const auto require = [](bool holds, const char* what) {
        if (!holds) throw std::logic_error(std::string("ValidationReport: ") + what);
    };
    const auto samples = static_cast<std::size_t>(traced.width_px) *
                         static_cast<std::size_t>(traced.height_px) * kChannels;
    require(lambda_nm.size() == wavelengths.size(), "one lambda_nm a wavelength");
    require(channels.size() == kChannels, "one comparison a channel");
    require(samples > 0 && traced.samples.size() == samples, "samples of the traced image");
    require(rendered.width_px == traced.width_px && rendered.height_px == traced.height_px &&
                rendered.samples.size() == samples,
            "both images of one size");
    require(channel_errors.size() == samples, "one error a sample");
}

std::string validation_json(const ValidationReport& report) {
    report.check();
    const Comparison& worst = report.worst();
    const Json json{
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
        {"rig", rig_of(report)},
        {"image",
         {{"width_px", report.rendered.width_px}, {"height_px", report.rendered.height_px}}},
        {"wavelengths", wavelengths_of(report)},
        {"channels", channels_of(report)},
        {"lamp_signal", report.lamp_signal},
        {"reference_wavelengths", report.grid_size},
        {"frames", report.frames},
        {"jobs", report.jobs},
        {"versions", {{"aphotic", report.aphotic_version}, {"povray", report.povray_version}}},
        {"time_s",
         {{"render", report.render_s},
          {"integrate", report.integrate_s},
          {"trace", report.trace_s}}}};
    return json_text(json);
}

void write_validation_json(const ValidationReport& report, const std::filesystem::path& file) {
    write_text_file(file, validation_json(report));
}

}  // namespace aphotic
