// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/design_files.h"

#include "base/degrees.h"
#include "image/preview.h"
#include "report/html.h"
#include "report/page.h"
#include "report/svg.h"
#include "rig/file/rig_reader.h"
#include "rig/geometry.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

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

// Which way the sled's x forward, y starboard and z down are drawn, to the right and down.
struct SledView {
    const char* id;
    const char* name;
    Eigen::Vector3d right;
    Eigen::Vector3d down;
};

// A drawing, to scale, of the elements added to it.
class SledDrawing {
  public:
    SledDrawing(const SledView& view, const Points& shown) : view_(view) {
        Eigen::AlignedBox2d box;
        for (const Eigen::Vector3d& point : shown) box.extend(flat(point));
        px_per_m_ = (kSide - 2.0 * kRoom) / box.sizes().maxCoeff();
        middle_ = box.center();
    }

    void add_line(const Eigen::Vector3d& from,
                  const Eigen::Vector3d& to,
                  const std::string& style) {
        const Eigen::Vector2d a = px(from);
        const Eigen::Vector2d b = px(to);
        elements_ += svg_line(a.x(), a.y(), b.x(), b.y(), style);
    }
    void add_dot(const Eigen::Vector3d& at, const std::string& tone) {
        elements_ += fmt::format(
            R"(<path stroke-linecap="round" class="dots" style="stroke-width: 11px" {} d="M{:.1f} {:.1f}h0"/>)",
            tone,
            px(at).x(),
            px(at).y());
    }
    void add_label(const Eigen::Vector3d& at, const std::string& text) {
        const Eigen::Vector2d place = px(at) + Eigen::Vector2d(9.0, -7.0);
        elements_ += svg_text(place.x(), place.y(), SvgAnchor::Start, R"(class="label")", text);
    }
    [[nodiscard]] std::string svg() const {
        return svg_drawing(view_.id, view_.name, kSide, kSide, elements_);
    }

  private:
    static constexpr double kSide = 520.0;
    static constexpr double kRoom = 40.0;

    [[nodiscard]] Eigen::Vector2d flat(const Eigen::Vector3d& point) const {
        return {view_.right.dot(point), view_.down.dot(point)};
    }
    [[nodiscard]] Eigen::Vector2d px(const Eigen::Vector3d& point) const {
        return Eigen::Vector2d::Constant(0.5 * kSide) + px_per_m_ * (flat(point) - middle_);
    }

    SledView view_;
    double px_per_m_ = 0.0;
    Eigen::Vector2d middle_;
    std::string elements_;
};

// The strobes, and a line along each aim, halfway to the floor.
std::string places_seen(const Rig& rig, const DesignResult& result, const SledView& view) {
    constexpr double kHalf = 0.5;
    constexpr std::array<std::size_t, 2> kPlaceTones{1, 2};
    const std::array<const Design*, 2> both{&result.start, &result.best};
    const auto aim_of = [&](const StrobePlace& place) {
        return Eigen::Vector3d(place.position_m + kHalf * rig.sled.altitude_m * place.axis);
    };
    const Points floor = seen_floor(rig);
    Points shown = floor;
    for (const Design* design : both) {
        for (const StrobePlace& place : design->places)
            shown.insert(shown.end(), {place.position_m, aim_of(place)});
    }
    SledDrawing drawing(view, shown);
    for (std::size_t i = 0; i < floor.size(); ++i)
        drawing.add_line(floor[i], floor[(i + 1) % floor.size()], R"(class="guide")");
    for (std::size_t i = 0; i < both.size(); ++i) {
        const std::string tone = svg_tone(kPlaceTones.at(i));
        for (const StrobePlace& place : both.at(i)->places) {
            drawing.add_line(place.position_m, aim_of(place), R"(class="curve" )" + tone);
            drawing.add_dot(place.position_m, tone);
        }
    }
    for (std::size_t s = 0; s < result.best.places.size(); ++s)
        drawing.add_label(result.best.places[s].position_m, rig.strobes[s].name);
    return drawing.svg();
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
                         .name = "the strobes from above",
                         .right = Eigen::Vector3d::UnitY(),
                         .down = -Eigen::Vector3d::UnitX()};
    const SledView side{.id = "side",
                        .name = "the strobes from starboard",
                        .right = Eigen::Vector3d::UnitX(),
                        .down = Eigen::Vector3d::UnitZ()};
    return {
        std::move(table),
        "Tilts are from straight down, towards a bearing clockwise from the bow. Drawn from above, "
        "bow up, and from starboard, bow right: the start in red, the design in green, each with "
        "a line along its aim, half the altitude long; dashed, the floor in view.",
        PagePlot{places_seen(rig, result, above)},
        PagePlot{places_seen(rig, result, side)}};
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
