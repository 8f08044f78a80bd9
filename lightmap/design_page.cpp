// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/design_files.h"

#include "base/degrees.h"
#include "image/preview.h"
#include "report/html.h"
#include "report/page.h"
#include "report/plot.h"
#include "rig/file/rig_reader.h"
#include "rig/geometry.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

constexpr int kShown_px = 480;
constexpr double kPercentOf = 100.0;

std::string gain_of(double start, double now) {
    const double gain = kPercentOf * (now / start - 1.0);
    return fmt::format("{}{:.3g} %", gain < 0.0 ? "−" : "+", std::abs(gain));
}

std::string pose_text(const Sled& sled) {
    return fmt::format("{} m, pitch {}°, roll {}°",
                       plain(sled.altitude_m),
                       plain(sled.pitch_rad * kDegreesPerRadian),
                       plain(sled.roll_rad * kDegreesPerRadian));
}

std::string headline(const DesignResult& result) {
    const LightFigures& start = result.start.figures;
    const LightFigures& best = result.best.figures;
    if (!result.is_better) return "Nothing better than the start was found";
    return fmt::format("Evenness {:.3f} in place of {:.3f}, worst signal to noise {}",
                       best.evenness,
                       start.evenness,
                       gain_of(start.signal_to_noise, best.signal_to_noise));
}

PageTable figures(const DesignRequest& request, const DesignResult& result) {
    const LightFigures& start = result.start.figures;
    const LightFigures& best = result.best.figures;
    PageTable table{.columns = {"figure", "start", "design", "gain"}};
    const auto add = [&](std::string name, double before, double after) {
        table.rows.push_back({.cells = {std::move(name),
                                        fmt::format("{:.4g}", before),
                                        fmt::format("{:.4g}", after),
                                        gain_of(before, after)}});
    };
    add("evenness U₀, least over mean", start.evenness, best.evenness);
    add("diversity, least over most", start.diversity, best.diversity);
    add(fmt::format("coverage, share of pixels over {} of the brightest", plain(request.level)),
        start.coverage,
        best.coverage);
    add("signal to noise of the worst pixel (start = 1)",
        1.0,
        best.signal_to_noise / start.signal_to_noise);
    return table;
}

// Brightness over the mean in steps of a tenth, whose borders are contours, for the least even
// channel.
std::string steps_png(const Lightmap& map) {
    constexpr double kSteps = 10.0;   // of the mean
    constexpr double kWhitest = 2.0;  // times the mean
    constexpr double kGreys = 255.0;
    const std::size_t plane = map.samples.size() / kChannels;
    std::span<const float> shown;
    double least_even = 2.0;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const std::span<const float> channel = std::span(map.samples).subspan(c * plane, plane);
        const double evenness = figures_of_plane(channel, {}, 0.0).evenness;
        if (evenness <= 0.0 || evenness >= least_even) continue;
        least_even = evenness;
        shown = channel;
    }
    double sum = 0.0;
    for (const float g : shown) sum += g;
    const double mean = sum / static_cast<double>(plane);
    std::vector<std::uint32_t> pixels(plane);
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const double step = std::floor(kSteps * static_cast<double>(shown[i]) / mean) / kSteps;
        const auto grey =
            static_cast<std::uint32_t>(std::lround(kGreys * std::min(1.0, step / kWhitest)));
        pixels[i] = grey << 16U | grey << 8U | grey;
    }
    return png_of(pixels, map.width_px, map.height_px);
}

Lightmap shown_map(const Rig& rig, const Design& design, const Sled& sled) {
    Rig shown = with_longer_side(rig, kShown_px);
    for (std::size_t s = 0; s < design.places.size(); ++s) put(design.places[s], shown.strobes[s]);
    return LightmapMaker(shown, paths_of(shown, {sled}), {.error = 1e-3}).map(sled);
}

PageFigures pair_of(std::string before, std::string after, int width_px, int height_px) {
    PageFigures pair;
    for (auto& [png, words] :
         {std::pair(std::move(before), "Start"), std::pair(std::move(after), "Design")}) {
        pair.figures.push_back(
            {.pictures =
                 {{.bytes = png, .width_px = width_px, .height_px = height_px, .words = words}},
             .caption = words});
    }
    return pair;
}

std::vector<PagePart> light(const Rig& rig, const DesignResult& result) {
    // The start's own worst pose, for both.
    const auto worst = std::ranges::min_element(
        result.start.poses, {}, [](const JudgedPose& pose) { return pose.figures.evenness; });
    const Lightmap before = shown_map(rig, result.start, worst->sled);
    const Lightmap after = shown_map(rig, result.best, worst->sled);
    const auto image = [](const Lightmap& map) {
        return CameraImage{map.width_px, map.height_px, signal_of(map)};
    };
    const auto scale =
        preview_scale(image(before), {1.0, 1.0, 1.0}, {.white = PreviewWhite::Image});
    return {fmt::format("At {}, where the start is least even. First as the camera sees it, both "
                        "under one exposure; then the least even channel over its mean, black to "
                        "white from 0 to 2 in steps of 0.1.",
                        pose_text(worst->sled)),
            pair_of(preview_png(image(before), scale),
                    preview_png(image(after), scale),
                    before.width_px,
                    before.height_px),
            pair_of(steps_png(before), steps_png(after), before.width_px, before.height_px)};
}

constexpr std::size_t kStartTone = 1;
constexpr std::size_t kBestTone = 2;

std::vector<PagePart> front(const DesignResult& result) {
    constexpr double kHeight = 420.0;
    const auto place_of = [&](const Design& one, std::string name, std::size_t tone) {
        return PlotCurve{.label = std::move(name),
                         .x = {one.figures.signal_to_noise / result.start.figures.signal_to_noise},
                         .y = {one.figures.evenness},
                         .tone = tone,
                         .dots = true};
    };
    PlotCurve all{.label = "front", .x = {}, .y = {}, .dots = true};
    for (const Design& one : result.front) {
        const PlotCurve place = place_of(one, "", 0);
        all.x.push_back(place.x.front());
        all.y.push_back(place.y.front());
    }
    PlotCurve line = all;
    line.label.clear();
    line.dots = false;
    const Plot plot{.title = "evenness over signal to noise",
                    .x_label = "signal to noise of the worst pixel (start = 1)",
                    .y_label = "evenness U₀",
                    .curves = {line,
                               all,
                               place_of(result.start, "start", kStartTone),
                               place_of(result.best, "design", kBestTone)}};
    return {
        "Designs that no other beats in both: more even light, or more of it. --keep chooses among "
        "them.",
        PagePlot{page_plot("trade-plot", {&plot, 1}, kHeight)}};
}

using Points = std::vector<Eigen::Vector3d>;

// Where the edge of the view meets the floor.
Points seen_floor(const Rig& rig) {
    const double width = rig.camera.width_px;
    const double height = rig.camera.height_px;
    const Plane floor = floor_plane(rig.sled);
    Points corners;
    for (const auto& [column, row] : {std::array{0.0, 0.0},
                                      std::array{width, 0.0},
                                      std::array{width, height},
                                      std::array{0.0, height}}) {
        const WaterRay ray = pixel_ray(rig, column, row, rig.camera.range.first_nm);
        if (const auto distance_m = distance_to(floor, ray))
            corners.push_back(ray.origin_m + *distance_m * ray.direction);
    }
    return corners;
}

// Which way the sled's x forward, y starboard and z down are drawn, to the right and up.
struct SledView {
    const char* id;
    Plot plot;  // without curves
    Eigen::Vector3d right;
    Eigen::Vector3d up;

    void add(PlotCurve& curve, const Eigen::Vector3d& point) const {
        curve.x.push_back(right.dot(point));
        curve.y.push_back(up.dot(point));
    }
};

// The strobes, and a line along each aim, halfway to the floor.
PagePlot places_seen(const Rig& rig, const DesignResult& result, const SledView& view) {
    constexpr double kHeight = 560.0;
    constexpr double kHalf = 0.5;
    constexpr std::size_t kFloorTone = 6;
    const Eigen::Vector3d gap = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    Plot plot = view.plot;
    plot.equal_axes = true;
    PlotCurve floor{
        .label = "the floor in view", .x = {}, .y = {}, .tone = kFloorTone, .dashed = true};
    Points corners = seen_floor(rig);
    if (!corners.empty()) corners.push_back(corners.front());
    for (const Eigen::Vector3d& corner : corners) view.add(floor, corner);
    plot.curves.push_back(std::move(floor));
    for (const Design* design : {&result.start, &result.best}) {
        const bool is_start = design == &result.start;
        PlotCurve aims{.label = is_start ? "start" : "design",
                       .x = {},
                       .y = {},
                       .tone = is_start ? kStartTone : kBestTone};
        PlotCurve places{.label = "", .x = {}, .y = {}, .tone = aims.tone, .dots = true};
        for (std::size_t s = 0; s < design->places.size(); ++s) {
            const StrobePlace& place = design->places[s];
            view.add(aims, place.position_m);
            view.add(aims, place.position_m + kHalf * rig.sled.altitude_m * place.axis);
            view.add(aims, gap);
            view.add(places, place.position_m);
            if (!is_start) places.points.push_back(rig.strobes[s].name);
        }
        plot.curves.insert(plot.curves.end(), {std::move(aims), std::move(places)});
    }
    return {page_plot(view.id, {&plot, 1}, kHeight)};
}

// "26.0° to 180°": from straight down, towards that bearing from the bow, clockwise.
std::string tilt_text(const Eigen::Vector3d& axis) {
    constexpr double kTurn_deg = 360.0;
    constexpr double kStraight_deg = 0.05;
    const double tilt_deg = std::acos(std::clamp(axis.z(), -1.0, 1.0)) * kDegreesPerRadian;
    if (tilt_deg < kStraight_deg) return "0.0°";
    const double bearing_deg = std::atan2(axis.y(), axis.x()) * kDegreesPerRadian;
    return fmt::format(
        "{:.1f}° to {:.0f}°", tilt_deg, std::fmod(std::round(bearing_deg) + kTurn_deg, kTurn_deg));
}

std::vector<PagePart> strobes(const Rig& rig, const DesignResult& result) {
    PageTable table{.columns = {"strobe",
                                "position at start (m)",
                                "position (m)",
                                "tilt at start",
                                "tilt",
                                "power (start = 1)"}};
    const auto vector = [](const Eigen::Vector3d& v) {
        return fmt::format("{:.3f}, {:.3f}, {:.3f}", v.x(), v.y(), v.z());
    };
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        const StrobePlace& was = result.start.places[s];
        const StrobePlace& is = result.best.places[s];
        table.rows.push_back(
            {.cells = {rig.strobes[s].name,
                       vector(was.position_m),
                       vector(is.position_m),
                       tilt_text(was.axis),
                       tilt_text(is.axis),
                       was.power > 0.0 ? fmt::format("{:.3f}", is.power / was.power) : "none"}});
    }
    const SledView above{.id = "above",
                         .plot = {.title = "the strobes from above",
                                  .x_label = "starboard (m)",
                                  .y_label = "forward (m)",
                                  .curves = {}},
                         .right = Eigen::Vector3d::UnitY(),
                         .up = Eigen::Vector3d::UnitX()};
    const SledView side{.id = "side",
                        .plot = {.title = "the strobes from starboard",
                                 .x_label = "forward (m)",
                                 .y_label = "up (m)",
                                 .curves = {}},
                        .right = Eigen::Vector3d::UnitX(),
                        .up = -Eigen::Vector3d::UnitZ()};
    return {
        std::move(table),
        "Tilts are from straight down, towards a bearing clockwise from the bow. Drawn from above "
        "and from starboard: each strobe with a line along its aim, half the altitude long.",
        places_seen(rig, result, above),
        places_seen(rig, result, side)};
}

PageTable poses(const DesignResult& result) {
    PageTable table{.columns = {"pose",
                                "evenness at start",
                                "evenness",
                                "signal to noise",
                                "coverage at start",
                                "coverage"}};
    for (std::size_t i = 0; i < result.best.poses.size(); ++i) {
        const LightFigures& was = result.start.poses[i].figures;
        const LightFigures& is = result.best.poses[i].figures;
        table.rows.push_back({.cells = {pose_text(result.best.poses[i].sled),
                                        fmt::format("{:.3f}", was.evenness),
                                        fmt::format("{:.3f}", is.evenness),
                                        gain_of(was.signal_to_noise, is.signal_to_noise),
                                        fmt::format("{:.3f}", was.coverage),
                                        fmt::format("{:.3f}", is.coverage)}});
    }
    return table;
}

}  // namespace

std::string design_html(const Rig& rig, const DesignRequest& request, const DesignResult& result) {
    return page_html(
        {.kind = "designed light",
         .title = "Design: " + rig.title,
         .heading = rig.title,
         .is_good = result.is_better,
         .headline = headline(result),
         .said = {fmt::format(
             "The worst of {}; {}, {} evaluated.",
             grouped_count(result.best.poses.size(), "pose"),
             grouped_count(result.numbers, "free number"),
             grouped_count(static_cast<std::size_t>(result.evaluations), "design"))},
         .sections = {{.id = "figures", .heading = "Gain", .parts = {figures(request, result)}},
                      {.id = "light", .heading = "Light on the floor", .parts = light(rig, result)},
                      {.id = "trade", .heading = "The trade", .parts = front(result)},
                      {.id = "strobes", .heading = "The strobes", .parts = strobes(rig, result)},
                      {.id = "poses", .heading = "Over the envelope", .parts = {poses(result)}},
                      {.id = "rig",
                       .heading = "The designed rig",
                       .parts = {PageSource{result.best.toml}}}}});
}

}  // namespace aphotic
