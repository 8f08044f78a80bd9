// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/plot.h"

#include "spectral/atomic_file.h"
#include "spectral/error.h"

#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
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
constexpr double kLegendRow = 24.0;
constexpr double kLegendSample = 26.0;
constexpr int kWantedTicksX = 8;
constexpr int kWantedTicksY = 6;
constexpr PlotColour kInk{0.13, 0.15, 0.18};
constexpr PlotColour kGrid{0.88, 0.89, 0.91};
constexpr PlotColour kFineGrid{0.945, 0.95, 0.955};

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

struct Box {
    double left, top, right, bottom;
};

// 1, 2 or 5 times a power of ten, so that about wanted steps fill the span.
double nice_step(double span, int wanted) {
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

Axis x_axis(double least, double most) {
    if (least == most) {
        least -= 1.0;
        most += 1.0;
    }
    Axis axis{least, most, false, {}};
    add_linear_ticks(axis, nice_step(most - least, kWantedTicksX));
    return axis;
}

Axis linear_y_axis(double least, double most) {
    if (least >= 0.0 && least <= 0.5 * most) least = 0.0;
    if (least == most) {
        const double room = least == 0.0 ? 1.0 : 0.1 * std::abs(least);
        least -= room;
        most += room;
    }
    const double step = nice_step(most - least, kWantedTicksY);
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

bool drawable(double x, double y, bool log_y) {
    return std::isfinite(x) && std::isfinite(y) && (!log_y || y > 0.0);
}

std::pair<Axis, Axis> axes_of(const Plot& plot) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double least_x = kInfinity, most_x = -kInfinity;
    double least_y = kInfinity, most_y = -kInfinity;
    for (const PlotCurve& curve : plot.curves) {
        for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i) {
            if (!drawable(curve.x[i], curve.y[i], plot.log_y)) continue;
            least_x = std::min(least_x, curve.x[i]);
            most_x = std::max(most_x, curve.x[i]);
            least_y = std::min(least_y, curve.y[i]);
            most_y = std::max(most_y, curve.y[i]);
        }
    }
    if (least_x > most_x) {
        throw InputError(fmt::format("plot '{}': found no point that can be drawn", plot.title));
    }
    return {x_axis(least_x, most_x),
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

double widest_tick(cairo_t* context, const Axis& axis) {
    set_font(context, kTickSize);
    double widest = 0.0;
    for (const Tick& tick : axis.ticks) {
        widest = std::max(widest, text_width(context, tick.label));
    }
    return widest;
}

double draw_title(cairo_t* context, const Plot& plot, double left, double right) {
    set_font(context, kTitleSize, true);
    const double width = text_width(context, plot.title);
    if (width > right - left) {
        set_font(context, kTitleSize * (right - left) / width, true);
    }
    set_colour(context, kInk);
    const double baseline = kEdge + 0.75 * kTitleSize;
    show_text(context, left, baseline, 0.0, plot.title);
    return baseline + 18.0;
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
        set_colour(context, curve.colour);
        cairo_set_line_width(context, 3.0);
        draw_line(context, x, baseline - 5.0, x + kLegendSample, baseline - 5.0);
        set_colour(context, kInk);
        show_text(context, x + kLegendSample + 8.0, baseline, 0.0, curve.label);
        x += entry;
    }
    return baseline == top ? top : baseline + 16.0;
}

void draw_x_axis(cairo_t* context, const Axis& axis, const Box& box, const std::string& label) {
    set_font(context, kTickSize);
    cairo_set_line_width(context, 1.0);
    for (const Tick& tick : axis.ticks) {
        const double x = box.left + axis.fraction(tick.value) * (box.right - box.left);
        set_colour(context, kGrid);
        draw_line(context, x, box.top, x, box.bottom);
        set_colour(context, kInk);
        draw_line(context, x, box.bottom, x, box.bottom + 5.0);
        show_text(context, x, box.bottom + 21.0, 0.5, tick.label);
    }
    set_font(context, kLabelSize);
    show_text(context, (box.left + box.right) / 2.0, kHeight - kEdge + 4.0, 0.5, label);
}

void draw_y_axis(cairo_t* context, const Axis& axis, const Box& box, const std::string& label) {
    set_font(context, kTickSize);
    cairo_set_line_width(context, 1.0);
    for (const Tick& tick : axis.ticks) {
        const double y = box.bottom - axis.fraction(tick.value) * (box.bottom - box.top);
        set_colour(context, tick.label.empty() ? kFineGrid : kGrid);
        draw_line(context, box.left, y, box.right, y);
        if (tick.label.empty()) continue;
        set_colour(context, kInk);
        draw_line(context, box.left - 5.0, y, box.left, y);
        show_text(context, box.left - 9.0, y + 0.36 * kTickSize, 1.0, tick.label);
    }
    set_font(context, kLabelSize);
    cairo_save(context);
    cairo_translate(context, kEdge + 4.0, (box.top + box.bottom) / 2.0);
    cairo_rotate(context, -std::numbers::pi / 2.0);
    show_text(context, 0.0, 0.0, 0.5, label);
    cairo_restore(context);
}

void draw_curve(cairo_t* context,
                const PlotCurve& curve,
                const Axis& x_axis,
                const Axis& y_axis,
                const Box& box) {
    set_colour(context, curve.colour);
    cairo_set_line_width(context, 2.2);
    cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
    cairo_new_path(context);
    bool pen_down = false;
    for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i) {
        if (!drawable(curve.x[i], curve.y[i], y_axis.log)) {
            pen_down = false;
            continue;
        }
        const double x = box.left + x_axis.fraction(curve.x[i]) * (box.right - box.left);
        const double y = box.bottom - y_axis.fraction(curve.y[i]) * (box.bottom - box.top);
        if (pen_down) {
            cairo_line_to(context, x, y);
        } else {
            cairo_move_to(context, x, y);
            cairo_line_to(context, x, y);  // so that a lone point shows
        }
        pen_down = true;
    }
    cairo_stroke(context);
}

void draw(cairo_t* context, const Plot& plot) {
    const auto [x_axis, y_axis] = axes_of(plot);
    cairo_set_source_rgb(context, 1.0, 1.0, 1.0);
    cairo_paint(context);
    Box box{};
    box.left = kEdge + kLabelSize + 16.0 + widest_tick(context, y_axis);
    box.right = kWidth - kEdge;
    box.bottom = kHeight - kEdge - kLabelSize - 26.0;
    const double below_title = draw_title(context, plot, box.left, box.right);
    box.top = draw_legend(context, plot, box.left, box.right, below_title);
    draw_x_axis(context, x_axis, box, plot.x_label);
    draw_y_axis(context, y_axis, box, plot.y_label);
    for (const PlotCurve& curve : plot.curves) draw_curve(context, curve, x_axis, y_axis, box);
    set_colour(context, kInk);
    cairo_set_line_width(context, 1.0);
    cairo_rectangle(context, box.left, box.top, box.right - box.left, box.bottom - box.top);
    cairo_stroke(context);
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

std::string png_of(const Plot& plot, const std::filesystem::path& file) {
    const SurfacePtr surface(
        cairo_image_surface_create(CAIRO_FORMAT_RGB24,
                                   static_cast<int>(kWidth * kPixelsPerUnit),
                                   static_cast<int>(kHeight * kPixelsPerUnit)));
    const ContextPtr context(cairo_create(surface.get()));
    cairo_scale(context.get(), kPixelsPerUnit, kPixelsPerUnit);
    draw(context.get(), plot);
    require_success(cairo_status(context.get()), file);
    std::string bytes;
    require_success(cairo_surface_write_to_png_stream(surface.get(), append_bytes, &bytes), file);
    return bytes;
}

std::string svg_of(const Plot& plot, const std::filesystem::path& file) {
    std::string bytes;
    const SurfacePtr surface(
        cairo_svg_surface_create_for_stream(append_bytes, &bytes, kWidth, kHeight));
    const ContextPtr context(cairo_create(surface.get()));
    draw(context.get(), plot);
    require_success(cairo_status(context.get()), file);
    cairo_surface_finish(surface.get());
    require_success(cairo_surface_status(surface.get()), file);
    return bytes;
}

}  // namespace

void write_plot(const Plot& plot, const std::filesystem::path& file) {
    const std::string extension = file.extension().string();
    if (extension == ".png") {
        write_text_file(file, png_of(plot, file));
    } else if (extension == ".svg") {
        write_text_file(file, svg_of(plot, file));
    } else {
        throw InputError(
            fmt::format("{}: found a plot file that ends in '{}'; allowed: .png or .svg",
                        file.string(),
                        extension));
    }
}

}  // namespace aphotic
