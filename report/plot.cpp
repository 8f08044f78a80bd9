// SPDX-License-Identifier: BSD-3-Clause
#include "report/plot.h"

#include "base/atomic_file.h"
#include "base/error.h"

#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

namespace aphotic {

namespace {

constexpr double kWidth = 960.0;
constexpr double kHeight = 600.0;
constexpr double kPixelsPerUnit = 2.0;  // of the PNG
constexpr double kEdge = 28.0;          // free margin around everything
constexpr double kTitleSize = 19.0;
constexpr double kLabelSize = 15.0;
constexpr double kTickSize = 13.5;
constexpr double kPointLabelSize = 12.0;
constexpr double kLegendRow = 24.0;
constexpr double kLegendSample = 26.0;
constexpr double kPointRadius = 4.0;
constexpr double kPointLabelGap = 3.0;                 // from the circle, and from the frame
constexpr double kPointLabelRim = 3.0;                 // half of it shows
constexpr int kPointLabelRows = 6;                     // up and down in search of a free place
constexpr double kPointLabelRowCost = 40.0;            // as much as that area covered
constexpr std::array<double, 2> kCurveDash{7.0, 6.0};  // the round ends lengthen each dash
constexpr std::array<double, 2> kMarkDash{4.0, 4.0};
constexpr int kWantedTicksX = 8;
constexpr int kWantedTicksY = 6;
constexpr double kDecadesWithAllLabels = 3.5;  // of a logarithmic x axis
constexpr PlotColour kInk{0.13, 0.15, 0.18};
constexpr PlotColour kGrid{0.88, 0.89, 0.91};
constexpr PlotColour kFineGrid{0.945, 0.95, 0.955};
constexpr PlotColour kMark{0.56, 0.57, 0.60};

struct SurfaceDeleter {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct ContextDeleter {
    void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using SurfacePtr = std::unique_ptr<cairo_surface_t, SurfaceDeleter>;
using ContextPtr = std::unique_ptr<cairo_t, ContextDeleter>;

struct Tick {
    double value = 0.0;
    std::string label;  // empty: a fine grid line of a logarithmic axis
};

struct Axis {
    double first = 0.0;
    double last = 0.0;
    bool log = false;
    std::vector<Tick> ticks;

    // 0 at first, 1 at last.
    [[nodiscard]] double fraction(double value) const {
        if (log) return std::log(value / first) / std::log(last / first);
        return (value - first) / (last - first);
    }
};

struct Point {
    double x, y;
};

struct Box {
    double left, top, right, bottom;
};

struct Panel {
    const Plot& plot;
    Axis x_axis;
    Axis y_axis;
    Box box{};

    [[nodiscard]] double across(double x) const {
        return box.left + x_axis.fraction(x) * (box.right - box.left);
    }
    [[nodiscard]] double down(double y) const {
        return box.bottom - y_axis.fraction(y) * (box.bottom - box.top);
    }
};

// 1, 2 or 5 times a power of ten, so that about wanted steps fill the span.
double round_step(double span, int wanted) {
    const double rough = span / wanted;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (rough <= factor * power * 1.0001) return factor * power;
    }
    return 10.0 * power;
}

void add_linear_ticks(Axis& axis, double step) {
    const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
    const double largest = std::max(std::abs(axis.first), std::abs(axis.last));
    const bool plain = decimals <= 6 && largest < 1e6;
    const double from = std::ceil(axis.first / step - 1e-6);
    const double to = std::floor(axis.last / step + 1e-6);
    for (double i = from; i <= to; i += 1.0) {
        const double value = i * step + 0.0;  // + 0.0 turns -0 into 0
        axis.ticks.push_back(
            {value, plain ? fmt::format("{:.{}f}", value, decimals) : fmt::format("{:g}", value)});
    }
}

Axis linear_x_axis(double least, double most) {
    if (least == most) {
        least -= 1.0;
        most += 1.0;
    }
    Axis axis{least, most, false, {}};
    add_linear_ticks(axis, round_step(most - least, kWantedTicksX));
    return axis;
}

// At 1, 2 and 5 times the powers of ten, as long as their labels find room.
void add_log_ticks(Axis& axis) {
    const double first = std::floor(std::log10(axis.first));
    const double last = std::ceil(std::log10(axis.last));
    const bool label_all = std::log10(axis.last / axis.first) <= kDecadesWithAllLabels;
    const double label_every = std::ceil((last - first) / kWantedTicksX);
    for (double exponent = first; exponent <= last; exponent += 1.0) {
        for (const double factor : {1.0, 2.0, 5.0}) {
            const double value = factor * std::pow(10.0, exponent);
            const bool outside = value < axis.first || value > axis.last;
            if (outside || (factor > 1.0 && label_every > 1.0)) continue;
            const bool labelled =
                label_all || (factor == 1.0 && std::fmod(exponent, label_every) == 0.0);
            axis.ticks.push_back({value, labelled ? fmt::format("{:g}", value) : ""});
        }
    }
}

Axis log_x_axis(double least, double most) {
    if (least == most) {
        least /= 2.0;
        most *= 2.0;
    }
    Axis axis{least, most, true, {}};
    add_log_ticks(axis);
    if (axis.ticks.size() < 3) {  // the range lies between two of them
        axis.ticks.clear();
        add_linear_ticks(axis, round_step(most - least, kWantedTicksX));
    }
    return axis;
}

Axis linear_y_axis(double least, double most) {
    if (least >= 0.0 && least <= 0.5 * most) least = 0.0;
    if (least == most) {
        const double room = least == 0.0 ? 1.0 : 0.1 * std::abs(least);
        least -= room;
        most += room;
    }
    const double step = round_step(most - least, kWantedTicksY);
    Axis axis{
        step * std::floor(least / step + 1e-6), step * std::ceil(most / step - 1e-6), false, {}};
    add_linear_ticks(axis, step);
    return axis;
}

Axis log_y_axis(double least, double most) {
    const double first = std::floor(std::log10(least) + 1e-9);
    const double last = std::max(first + 1.0, std::ceil(std::log10(most) - 1e-9));
    Axis axis{std::pow(10.0, first), std::pow(10.0, last), true, {}};
    const double label_every = std::ceil((last - first) / kWantedTicksY);
    for (double exponent = first; exponent <= last; exponent += 1.0) {
        const double decade = std::pow(10.0, exponent);
        const bool labelled = std::fmod(exponent - first, label_every) == 0.0;
        axis.ticks.push_back({decade, labelled ? fmt::format("{:g}", decade) : ""});
        if (exponent == last || label_every > 1.0) continue;
        for (int i = 2; i < 10; ++i) axis.ticks.push_back({i * decade, ""});
    }
    return axis;
}

std::size_t size_of(const PlotCurve& curve) {
    return std::min(curve.x.size(), curve.y.size());
}

bool drawable(const PlotCurve& curve, std::size_t i, const Plot& plot) {
    const double x = curve.x[i], y = curve.y[i];
    return std::isfinite(x) && std::isfinite(y) && (!plot.log_x || x > 0.0) &&
           (!plot.log_y || y > 0.0);
}

Panel panel_of(const Plot& plot) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double least_x = kInfinity, most_x = -kInfinity;
    double least_y = kInfinity, most_y = -kInfinity;
    for (const PlotCurve& curve : plot.curves) {
        for (std::size_t i = 0; i < size_of(curve); ++i) {
            if (!drawable(curve, i, plot)) continue;
            least_x = std::min(least_x, curve.x[i]);
            most_x = std::max(most_x, curve.x[i]);
            least_y = std::min(least_y, curve.y[i]);
            most_y = std::max(most_y, curve.y[i]);
        }
    }
    if (least_x > most_x) {
        throw InputError(fmt::format("plot '{}': found no point that can be drawn", plot.title));
    }
    return {plot,
            plot.log_x ? log_x_axis(least_x, most_x) : linear_x_axis(least_x, most_x),
            plot.log_y ? log_y_axis(least_y, most_y) : linear_y_axis(least_y, most_y)};
}

void set_colour(cairo_t* context, PlotColour colour) {
    cairo_set_source_rgb(context, colour.red, colour.green, colour.blue);
}

void set_font(cairo_t* context, double size, bool bold = false) {
    cairo_select_font_face(context,
                           "sans-serif",
                           CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context, size);
}

double text_width(cairo_t* context, const std::string& text) {
    cairo_text_extents_t extents;
    cairo_text_extents(context, text.c_str(), &extents);
    return extents.x_advance;
}

// The font in this size, or smaller when the text would be wider than the room. In small steps,
// because letters fitted to whole pixels do not shrink in proportion.
void set_fitting_font(
    cairo_t* context, double size, const std::string& text, double room, bool bold = false) {
    set_font(context, size, bold);
    while (size > 1.0 && text_width(context, text) > room) {
        size *= 0.98;
        set_font(context, size, bold);
    }
}

// align: 0 text starts at x, 0.5 is centred on it, 1 ends there.
void show_text(cairo_t* context, double x, double y, double align, const std::string& text) {
    cairo_move_to(context, x - align * text_width(context, text), y);
    cairo_show_text(context, text.c_str());
}

void draw_line(cairo_t* context, double x0, double y0, double x1, double y1) {
    cairo_move_to(context, x0, y0);
    cairo_line_to(context, x1, y1);
    cairo_stroke(context);
}

void draw_circle(cairo_t* context, Point centre) {
    cairo_new_path(context);
    cairo_arc(context, centre.x, centre.y, kPointRadius, 0.0, 2.0 * std::numbers::pi);
    cairo_fill(context);
}

void set_dash(cairo_t* context, std::span<const double> dash) {
    cairo_set_dash(context, dash.data(), static_cast<int>(dash.size()), 0.0);
}

double widest_tick(cairo_t* context, const Axis& axis) {
    set_font(context, kTickSize);
    double widest = 0.0;
    for (const Tick& tick : axis.ticks) {
        widest = std::max(widest, text_width(context, tick.label));
    }
    return widest;
}

double draw_title(cairo_t* context, const Plot& plot, double left, double right) {
    set_fitting_font(context, kTitleSize, plot.title, right - left, true);
    set_colour(context, kInk);
    const double baseline = kEdge + 0.75 * kTitleSize;
    show_text(context, left, baseline, 0.0, plot.title);
    return baseline + 18.0;
}

// The style of a curve's line, for the panel and for the legend.
void set_pen(cairo_t* context, const PlotCurve& curve, double width) {
    set_colour(context, curve.colour);
    cairo_set_line_width(context, width);
    set_dash(context,
             curve.dashed ? std::span<const double>(kCurveDash) : std::span<const double>{});
}

void draw_sample(cairo_t* context, const PlotCurve& curve, double x, double y) {
    cairo_save(context);
    set_pen(context, curve, 3.0);
    if (curve.points) {
        draw_circle(context, {x + kLegendSample / 2.0, y});
    } else {
        draw_line(context, x, y, x + kLegendSample, y);
    }
    cairo_restore(context);
}

// Samples and labels in rows below top; returns where the plot may begin.
double draw_legend(cairo_t* context, const Plot& plot, double left, double right, double top) {
    set_font(context, kLabelSize);
    double x = left;
    double baseline = top;
    for (const PlotCurve& curve : plot.curves) {
        if (curve.label.empty()) continue;
        const double entry = kLegendSample + 8.0 + text_width(context, curve.label) + 24.0;
        const bool starts_row = baseline == top;
        if (starts_row || x + entry > right + 24.0) {
            x = left;
            baseline += starts_row ? 14.0 : kLegendRow;
        }
        draw_sample(context, curve, x, baseline - 5.0);
        set_colour(context, kInk);
        show_text(context, x + kLegendSample + 8.0, baseline, 0.0, curve.label);
        x += entry;
    }
    return baseline == top ? top : baseline + 16.0;
}

void draw_x_axis(cairo_t* context, const Panel& panel) {
    const Box& box = panel.box;
    set_font(context, kTickSize);
    cairo_set_line_width(context, 1.0);
    for (const Tick& tick : panel.x_axis.ticks) {
        const double x = panel.across(tick.value);
        set_colour(context, tick.label.empty() ? kFineGrid : kGrid);
        draw_line(context, x, box.top, x, box.bottom);
        if (tick.label.empty()) continue;
        set_colour(context, kInk);
        draw_line(context, x, box.bottom, x, box.bottom + 5.0);
        show_text(context, x, box.bottom + 21.0, 0.5, tick.label);
    }
    set_colour(context, kInk);
    set_fitting_font(context, kLabelSize, panel.plot.x_label, box.right - box.left);
    const double middle = (box.left + box.right) / 2.0;
    show_text(context, middle, kHeight - kEdge + 4.0, 0.5, panel.plot.x_label);
}

void draw_y_axis(cairo_t* context, const Panel& panel) {
    const Box& box = panel.box;
    set_font(context, kTickSize);
    cairo_set_line_width(context, 1.0);
    for (const Tick& tick : panel.y_axis.ticks) {
        const double y = panel.down(tick.value);
        set_colour(context, tick.label.empty() ? kFineGrid : kGrid);
        draw_line(context, box.left, y, box.right, y);
        if (tick.label.empty()) continue;
        set_colour(context, kInk);
        draw_line(context, box.left - 5.0, y, box.left, y);
        show_text(context, box.left - 9.0, y + 0.36 * kTickSize, 1.0, tick.label);
    }
    set_colour(context, kInk);
    // Into the panel above or below it must not reach.
    set_fitting_font(context, kLabelSize, panel.plot.y_label, box.bottom - box.top);
    cairo_save(context);
    cairo_translate(context, kEdge + 4.0, (box.top + box.bottom) / 2.0);
    cairo_rotate(context, -std::numbers::pi / 2.0);
    show_text(context, 0.0, 0.0, 0.5, panel.plot.y_label);
    cairo_restore(context);
}

void draw_marks(cairo_t* context, const Panel& panel) {
    cairo_save(context);
    set_colour(context, kMark);
    cairo_set_line_width(context, 1.0);
    set_dash(context, kMarkDash);
    for (const double mark : panel.plot.marks_x) {
        const bool inside = mark >= panel.x_axis.first && mark <= panel.x_axis.last;
        if (!inside) continue;
        const double x = panel.across(mark);
        draw_line(context, x, panel.box.top, x, panel.box.bottom);
    }
    cairo_restore(context);
}

// Where the curve's points come to lie; nothing for one that cannot be drawn.
std::vector<std::optional<Point>> places_of(const PlotCurve& curve, const Panel& panel) {
    std::vector<std::optional<Point>> places(size_of(curve));
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!drawable(curve, i, panel.plot)) continue;
        places[i] = Point{panel.across(curve.x[i]), panel.down(curve.y[i])};
    }
    return places;
}

void draw_curve(cairo_t* context, const PlotCurve& curve, const Panel& panel) {
    cairo_save(context);
    set_pen(context, curve, 2.2);
    cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
    cairo_new_path(context);
    bool pen_down = false;
    for (const auto& place : places_of(curve, panel)) {
        if (place) {
            if (!pen_down) cairo_move_to(context, place->x, place->y);
            cairo_line_to(context, place->x, place->y);  // a lone point shows as well
        }
        pen_down = place.has_value();
    }
    cairo_stroke(context);
    cairo_restore(context);
}

void draw_points(cairo_t* context, const PlotCurve& curve, const Panel& panel) {
    set_colour(context, curve.colour);
    for (const auto& place : places_of(curve, panel)) {
        if (place) draw_circle(context, *place);
    }
}

void draw_frame(cairo_t* context, const Box& box) {
    set_colour(context, kInk);
    cairo_set_line_width(context, 1.0);
    cairo_rectangle(context, box.left, box.top, box.right - box.left, box.bottom - box.top);
    cairo_stroke(context);
}

Box around(Point centre, double half_width, double half_height) {
    return {centre.x - half_width,
            centre.y - half_height,
            centre.x + half_width,
            centre.y + half_height};
}

double shared_area(const Box& a, const Box& b) {
    const double width = std::min(a.right, b.right) - std::max(a.left, b.left);
    const double height = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
    return std::max(0.0, width) * std::max(0.0, height);
}

// Moved by no more than it takes to lie in the panel.
Box moved_inside(const Box& box, const Box& panel) {
    const double dx = std::max(panel.left + kPointLabelGap - box.left, 0.0) -
                      std::max(box.right - panel.right + kPointLabelGap, 0.0);
    const double dy = std::max(panel.top + kPointLabelGap - box.top, 0.0) -
                      std::max(box.bottom - panel.bottom + kPointLabelGap, 0.0);
    return {box.left + dx, box.top + dy, box.right + dx, box.bottom + dy};
}

// A line as a row of small boxes, so that labels find room beside it.
void add_line(std::vector<Box>& taken, Point from, Point to) {
    constexpr double kStep = 3.0;
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    const double steps = std::max(1.0, std::ceil(length / kStep));
    for (double i = 0.0; i <= steps; i += 1.0) {
        const double t = i / steps;
        taken.push_back(around(
            {std::lerp(from.x, to.x, t), std::lerp(from.y, to.y, t)}, kStep / 2.0, kStep / 2.0));
    }
}

std::vector<Box> taken_by_curves(const Panel& panel) {
    constexpr double kRoom = kPointRadius + kPointLabelGap;
    std::vector<Box> taken;
    for (const PlotCurve& curve : panel.plot.curves) {
        std::optional<Point> before;
        for (const auto& place : places_of(curve, panel)) {
            if (place && curve.points) taken.push_back(around(*place, kRoom, kRoom));
            if (place && before && !curve.points) add_line(taken, *before, *place);
            before = place;
        }
    }
    return taken;
}

struct LabelPlace {
    Box box{};
    int row = 0;  // away from the point's own
};

struct PointLabel {
    std::string text;
    Point point;
    LabelPlace place;
};

// Right, left, above or below the point and then ever farther above and below: the place where
// distance and what it covers cost least, the first of equals.
LabelPlace label_place(
    Point point, double width, double height, const Panel& panel, const std::vector<Box>& taken) {
    const double beside = kPointRadius + kPointLabelGap + width / 2.0;
    const double above = kPointRadius + kPointLabelGap + height / 2.0;
    LabelPlace best;
    double least = std::numeric_limits<double>::infinity();
    const auto consider = [&](int row, double side) {
        const Point centre{point.x + side * beside, point.y + row * above};
        const Box box = moved_inside(around(centre, width / 2.0, height / 2.0), panel.box);
        double cost = kPointLabelRowCost * std::abs(row);
        for (const Box& other : taken) cost += shared_area(box, other);
        if (cost >= least) return;
        least = cost;
        best = {box, std::abs(row)};
    };
    for (const double side : {1.0, -1.0}) consider(0, side);
    for (int row = 1; row <= kPointLabelRows; ++row) {
        for (const double side : {1.0, -1.0, 0.0}) {
            consider(-row, side);
            consider(row, side);
        }
    }
    return best;
}

// From the circle to its label, where they are far apart.
void draw_leader(cairo_t* context, Point point, const Box& label) {
    const double dx = std::clamp(point.x, label.left, label.right) - point.x;
    const double dy = std::clamp(point.y, label.top, label.bottom) - point.y;
    const double free = 1.0 - kPointRadius / std::max(kPointRadius, std::hypot(dx, dy));
    set_colour(context, kMark);
    cairo_set_line_width(context, 1.0);
    draw_line(context,
              point.x + (1.0 - free) * dx,
              point.y + (1.0 - free) * dy,
              point.x + dx,
              point.y + dy);
}

PointLabel placed_label(cairo_t* context,
                        const std::string& text,
                        Point point,
                        const Panel& panel,
                        const std::vector<Box>& taken) {
    const double room = panel.box.right - panel.box.left - 2.0 * kPointLabelGap;
    set_fitting_font(context, kPointLabelSize, text, room);
    cairo_font_extents_t font;
    cairo_font_extents(context, &font);
    const double height = font.ascent + font.descent;
    return {text, point, label_place(point, text_width(context, text), height, panel, taken)};
}

std::vector<PointLabel> placed_labels(cairo_t* context, const Panel& panel) {
    std::vector<PointLabel> labels;
    std::vector<Box> taken = taken_by_curves(panel);
    for (const PlotCurve& curve : panel.plot.curves) {
        const auto places = places_of(curve, panel);
        for (std::size_t i = 0; i < std::min(places.size(), curve.point_labels.size()); ++i) {
            const std::string& text = curve.point_labels[i];
            if (!places[i] || text.empty()) continue;
            labels.push_back(placed_label(context, text, *places[i], panel, taken));
            Box box = labels.back().place.box;
            box.left -= kPointLabelGap;  // so that two labels in a row do not read as one
            box.right += kPointLabelGap;
            taken.push_back(box);
        }
    }
    return labels;
}

void draw_point_label(cairo_t* context, const PointLabel& label) {
    const Box& box = label.place.box;
    set_fitting_font(context, kPointLabelSize, label.text, box.right - box.left);
    cairo_font_extents_t font;
    cairo_font_extents(context, &font);
    const double baseline = box.bottom - font.descent;
    // A white rim, for what the label could not move aside for.
    cairo_set_source_rgb(context, 1.0, 1.0, 1.0);
    cairo_set_line_width(context, kPointLabelRim);
    cairo_move_to(context, box.left, baseline);
    cairo_text_path(context, label.text.c_str());
    cairo_stroke(context);
    set_colour(context, kInk);
    show_text(context, box.left, baseline, 0.0, label.text);
}

void draw_point_labels(cairo_t* context, const Panel& panel) {
    const std::vector<PointLabel> labels = placed_labels(context, panel);
    for (const PointLabel& label : labels) {
        if (label.place.row > 1) draw_leader(context, label.point, label.place.box);
    }
    for (const PointLabel& label : labels) draw_point_label(context, label);
}

void draw_panel(cairo_t* context, Panel& panel, double left) {
    const Plot& plot = panel.plot;
    panel.box.left = left;
    panel.box.right = kWidth - kEdge;
    panel.box.bottom = kHeight - kEdge - kLabelSize - 26.0;
    const double below_title = draw_title(context, plot, left, panel.box.right);
    panel.box.top = draw_legend(context, plot, left, panel.box.right, below_title);
    draw_x_axis(context, panel);
    draw_y_axis(context, panel);
    draw_marks(context, panel);
    for (const PlotCurve& curve : plot.curves) {
        if (!curve.points) draw_curve(context, curve, panel);
    }
    draw_frame(context, panel.box);
    // After the frame, so that circles at the ends of the axes stay whole.
    for (const PlotCurve& curve : plot.curves) {
        if (curve.points) draw_points(context, curve, panel);
    }
    draw_point_labels(context, panel);
}

void draw(cairo_t* context, std::vector<Panel>& panels) {
    cairo_set_source_rgb(context, 1.0, 1.0, 1.0);
    cairo_paint(context);
    double widest = 0.0;  // the same for all panels, so that their frames are aligned
    for (const Panel& panel : panels) widest = std::max(widest, widest_tick(context, panel.y_axis));
    for (Panel& panel : panels) {
        draw_panel(context, panel, kEdge + kLabelSize + 16.0 + widest);
        cairo_translate(context, 0.0, kHeight);
    }
}

void require_success(cairo_status_t status, const std::filesystem::path& file) {
    if (status == CAIRO_STATUS_SUCCESS) return;
    throw RunError(
        fmt::format("{}: cannot be drawn: {}", file.string(), cairo_status_to_string(status)));
}

cairo_status_t append_bytes(void* bytes, const unsigned char* data, unsigned int size) {
    static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), size);
    return CAIRO_STATUS_SUCCESS;
}

double height_of(const std::vector<Panel>& panels) {
    return kHeight * static_cast<double>(panels.size());
}

std::string png_of(std::vector<Panel>& panels, const std::filesystem::path& file) {
    const SurfacePtr surface(
        cairo_image_surface_create(CAIRO_FORMAT_RGB24,
                                   static_cast<int>(kWidth * kPixelsPerUnit),
                                   static_cast<int>(height_of(panels) * kPixelsPerUnit)));
    const ContextPtr context(cairo_create(surface.get()));
    cairo_scale(context.get(), kPixelsPerUnit, kPixelsPerUnit);
    draw(context.get(), panels);
    require_success(cairo_status(context.get()), file);
    std::string bytes;
    require_success(cairo_surface_write_to_png_stream(surface.get(), append_bytes, &bytes), file);
    return bytes;
}

std::string svg_of(std::vector<Panel>& panels, const std::filesystem::path& file) {
    std::string bytes;
    const SurfacePtr surface(
        cairo_svg_surface_create_for_stream(append_bytes, &bytes, kWidth, height_of(panels)));
    const ContextPtr context(cairo_create(surface.get()));
    draw(context.get(), panels);
    require_success(cairo_status(context.get()), file);
    cairo_surface_finish(surface.get());
    require_success(cairo_surface_status(surface.get()), file);
    return bytes;
}

}  // namespace

void write_plots(std::span<const Plot> panels, const std::filesystem::path& file) {
    const std::string extension = file.extension().string();
    if (extension != ".png" && extension != ".svg") {
        throw InputError(
            fmt::format("{}: found a plot file that ends in '{}'; allowed: .png or .svg",
                        file.string(),
                        extension));
    }
    if (panels.empty()) {
        throw InputError(
            fmt::format("{}: found no panel to draw; allowed: one or more", file.string()));
    }
    std::vector<Panel> drawn;
    for (const Plot& plot : panels) drawn.push_back(panel_of(plot));
    write_text_file(file, extension == ".png" ? png_of(drawn, file) : svg_of(drawn, file));
}

void write_plot(const Plot& plot, const std::filesystem::path& file) {
    write_plots({&plot, 1}, file);
}

}  // namespace aphotic
