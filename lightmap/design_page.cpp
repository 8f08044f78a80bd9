// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/design_page.h"

#include "base/degrees.h"
#include "image/preview.h"
#include "report/html.h"
#include "report/page.h"
#include "report/svg.h"
#include "rig/file/rig_reader.h"
#include "rig/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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

// Bright pixels over the mean in steps of a tenth, whose borders are contours: for the least even
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
    for (std::size_t s = 0; s < design.places.size(); ++s) {
        shown.strobes[s].position_m = design.places[s].position_m;
        shown.strobes[s].axis = design.places[s].axis;
        shown.strobes[s].power = design.places[s].power;
    }
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

std::vector<PagePart> front(const DesignResult& result) {
    constexpr double kWidth = 760.0;
    constexpr double kHeight = 420.0;
    constexpr double kMargin = 16.0;
    constexpr int kTicks = 6;
    const LightFigures& start = result.start.figures;
    const auto signal_of_start = [&](const LightFigures& f) {
        return f.signal_to_noise / start.signal_to_noise;
    };
    std::vector<double> x;
    std::vector<double> y;
    for (const Design& one : result.front) {
        x.push_back(signal_of_start(one.figures));
        y.push_back(one.figures.evenness);
    }
    const std::array<double, 1> start_x{1.0};
    const std::array<double, 1> start_y{start.evenness};
    const std::array<double, 1> best_x{signal_of_start(result.best.figures)};
    const std::array<double, 1> best_y{result.best.figures.evenness};
    ValueRange xs;
    ValueRange ys;
    xs.include(x);
    xs.include(start_x);
    ys.include(y);
    ys.include(start_y);
    SvgPanel panel{.left = kAxisWidth,
                   .top = kMargin,
                   .width = kWidth - kAxisWidth - kMargin,
                   .height = kHeight - kAxisHeight - kMargin,
                   .x = linear_axis_around(xs.least, xs.most, kTicks),
                   .y = linear_axis_around(ys.least, ys.most, kTicks)};
    panel.x.title = "signal to noise of the worst pixel (start = 1)";
    panel.y.title = "evenness U₀";
    const auto dots =
        [&](std::span<const double> at, std::span<const double> of, std::size_t tone) {
            return svg_dots(
                panel,
                at,
                of,
                fmt::format("class=\"dots\" style=\"stroke-width: 9px\" {}", svg_tone(tone)));
        };
    constexpr std::size_t kFrontTone = 0;
    constexpr std::size_t kStartTone = 1;
    constexpr std::size_t kBestTone = 2;
    const std::string elements = svg_axes(panel) + svg_curve(panel, x, y, "class=\"front\"") +
                                 dots(x, y, kFrontTone) + dots(start_x, start_y, kStartTone) +
                                 dots(best_x, best_y, kBestTone);
    return {
        "Designs that no other beats in both: more even light, or more of it. --keep chooses among "
        "them.",
        PageLegend{dot_key(kFrontTone, "front"),
                   dot_key(kStartTone, "start"),
                   dot_key(kBestTone, "design")},
        PagePlot{
            svg_drawing("trade-plot", "evenness over signal to noise", kWidth, kHeight, elements)}};
}

// From above, forward up: the strobes, and a line along each aim, halfway to the floor.
std::string plan_of(const Rig& rig, const DesignResult& result) {
    constexpr double kSide = 520.0;
    constexpr double kRoom = 40.0;
    constexpr double kHalf = 0.5;
    double reach_m = 0.0;
    std::string elements;
    const auto aim_of = [&](const StrobePlace& place) {
        return Eigen::Vector3d(place.position_m + kHalf * rig.sled.altitude_m * place.axis);
    };
    for (const Design* design : {&result.start, &result.best}) {
        for (const StrobePlace& place : design->places) {
            for (const Eigen::Vector3d& at : {place.position_m, aim_of(place)})
                reach_m = std::max(reach_m, at.head<2>().cwiseAbs().maxCoeff());
        }
    }
    std::vector<std::array<double, 2>> corners;
    const double width = rig.camera.width_px;
    const double height = rig.camera.height_px;
    const Plane floor = floor_plane(rig.sled);
    for (const auto& [column, row] : {std::array{0.0, 0.0},
                                      std::array{width, 0.0},
                                      std::array{width, height},
                                      std::array{0.0, height}}) {
        const WaterRay ray = pixel_ray(rig, column, row, rig.camera.range.first_nm);
        const auto distance_m = distance_to(floor, ray);
        if (!distance_m) continue;
        const Eigen::Vector3d point_m = ray.origin_m + *distance_m * ray.direction;
        corners.push_back({point_m.x(), point_m.y()});
        reach_m = std::max(reach_m, point_m.head<2>().cwiseAbs().maxCoeff());
    }
    const double px_per_m = (kHalf * kSide - kRoom) / reach_m;
    const auto x_px = [&](double starboard_m) { return kHalf * kSide + px_per_m * starboard_m; };
    const auto y_px = [&](double forward_m) { return kHalf * kSide - px_per_m * forward_m; };
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto& a = corners[i];
        const auto& b = corners[(i + 1) % corners.size()];
        elements += svg_line(x_px(a[1]), y_px(a[0]), x_px(b[1]), y_px(b[0]), R"(class="guide")");
    }
    constexpr std::array<std::size_t, 2> kPlanTones{1, 2};
    const std::array<const Design*, 2> both{&result.start, &result.best};
    for (std::size_t i = 0; i < both.size(); ++i) {
        const std::string tone = svg_tone(kPlanTones.at(i));
        for (std::size_t s = 0; s < both.at(i)->places.size(); ++s) {
            const StrobePlace& place = both.at(i)->places[s];
            const Eigen::Vector3d& at = place.position_m;
            const Eigen::Vector3d to = aim_of(place);
            elements += svg_line(
                x_px(at.y()), y_px(at.x()), x_px(to.y()), y_px(to.x()), R"(class="curve" )" + tone);
            elements += fmt::format(
                R"(<path stroke-linecap="round" class="dots" style="stroke-width: 11px" {} d="M{:.1f} {:.1f}h0"/>)",
                tone,
                x_px(at.y()),
                y_px(at.x()));
            if (i == 1)
                elements += svg_text(x_px(at.y()) + 9.0,
                                     y_px(at.x()) - 7.0,
                                     SvgAnchor::Start,
                                     R"(class="label")",
                                     rig.strobes[s].name);
        }
    }
    return svg_drawing("plan", "the strobes from above", kSide, kSide, elements);
}

std::vector<PagePart> strobes(const Rig& rig, const DesignResult& result) {
    PageTable table{.columns = {"strobe",
                                "position at start (m)",
                                "position (m)",
                                "direction at start",
                                "direction",
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
                       vector(was.axis),
                       vector(is.axis),
                       was.power > 0.0 ? fmt::format("{:.3f}", is.power / was.power) : "none"}});
    }
    return {std::move(table),
            "From above, forward up: the start in red, the design in green, each with a line along "
            "its aim, half the altitude long; dashed, what the camera sees of the floor.",
            PagePlot{plan_of(rig, result)}};
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
