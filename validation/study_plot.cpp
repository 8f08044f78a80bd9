// SPDX-License-Identifier: BSD-3-Clause
#include "validation/study_plot.h"

#include "report/html.h"
#include "report/label_place.h"
#include "report/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace aphotic {

namespace {

constexpr double kMarkRadius = 5.0;
constexpr double kRingRadius = 9.0;  // around the recommended one

// The number of its shape and of its colour; one that is not known looks like the last.
std::size_t subject_index(std::string_view subject) {
    const auto found = std::ranges::find(kStudySubjects, subject, &StudySubject::name);
    return std::min<std::size_t>(static_cast<std::size_t>(found - kStudySubjects.begin()),
                                 kStudySubjects.size() - 1);
}

// By subject, about the origin.
constexpr std::array<std::string_view, kStudySubjects.size()> kShapes{
    "M-5 0a5 5 0 1 0 10 0a5 5 0 1 0-10 0Z",
    "M-4.4-4.4H4.4V4.4H-4.4Z",
    "M0-6.2L5.4 3.1H-5.4Z",
    "M0-6.2L6.2 0L0 6.2L-6.2 0Z",
    "M0 6.2L5.4-3.1H-5.4Z",
    "M0-6.2L5.9-1.9L3.7 5.1H-3.7L-5.9-1.9Z",
    "M6.2 0L3.1 5.4H-3.1L-6.2 0L-3.1-5.4H3.1Z"};

std::string mark(
    std::string_view subject, bool hollow, double x, double y, std::string_view content) {
    const std::size_t index = subject_index(subject);
    return fmt::format(
        R"svg(<path class="dot{}" {} transform="translate({:.1f} {:.1f})" d="{}">{}</path>)svg",
        hollow ? " hollow" : "",
        svg_tone(index),
        x,
        y,
        kShapes.at(index),
        content);
}

// With some room at both ends.
SvgAxis axis_over(const ValueRange& range, int most_labels) {
    constexpr double kRoom = 1.15;
    if (range.is_empty()) return log_axis(1.0, 10.0);
    return log_axis(range.least / kRoom, range.most * kRoom, most_labels);
}

SvgPanel panel_of(const Study& study) {
    ValueRange times;
    ValueRange errors;
    if (study.tolerance > 0.0) errors.include(study.tolerance);
    for (const StudyMeasure& measure : study.measures) {
        if (!is_drawn(measure)) continue;
        times.include(measure.total_s());
        errors.include(measure.max_error());
    }
    SvgPanel panel{.left = kAxisWidth,
                   .top = 12.0,
                   .width = 800.0,
                   .height = 498.0,
                   .x = axis_over(times, 23),
                   .y = axis_over(errors, 7)};
    panel.x.title = "time [s]";
    panel.y.title = "largest error |e|";
    return panel;
}

// A measure that is drawn, where its mark is.
struct Dot {
    std::size_t index = 0;  // of the measure
    double x_px = 0.0;
    double y_px = 0.0;
    bool on_front = false;
    bool is_best = false;
};

std::vector<Dot> dots_of(const Study& study, const SvgPanel& panel) {
    const std::vector<bool> front = pareto_front(study.measures);
    const auto best = recommended(study.measures, study.tolerance);
    std::vector<Dot> dots;
    for (std::size_t i = 0; i < study.measures.size(); ++i) {
        if (!is_drawn(study.measures[i])) continue;
        dots.push_back({.index = i,
                        .x_px = panel.x_px(study.measures[i].total_s()),
                        .y_px = panel.y_px(study.measures[i].max_error()),
                        .on_front = front[i],
                        .is_best = best == i});
    }
    return dots;
}

// The box of a level or upright line.
LabelBox box_along(double x1, double y1, double x2, double y2) {
    constexpr double kHalf = 1.5;
    return {.left = std::min(x1, x2) - kHalf,
            .top = std::min(y1, y2) - kHalf,
            .right = std::max(x1, x2) + kHalf,
            .bottom = std::max(y1, y2) + kHalf};
}

// From the fastest on: level up to the next one's time, then down to its error.
std::vector<LabelBox> front_steps(std::vector<Dot> dots, std::string& svg) {
    std::erase_if(dots, [](const Dot& dot) { return !dot.on_front; });
    std::ranges::sort(dots, {}, &Dot::x_px);
    std::string path;
    std::vector<LabelBox> boxes;
    for (std::size_t i = 0; i < dots.size(); ++i) {
        const Dot& dot = dots[i];
        if (i == 0) {
            path = fmt::format("M{:.1f} {:.1f}", dot.x_px, dot.y_px);
            continue;
        }
        const Dot& last = dots[i - 1];
        path += fmt::format("H{:.1f}V{:.1f}", dot.x_px, dot.y_px);
        boxes.push_back(box_along(last.x_px, last.y_px, dot.x_px, last.y_px));
        boxes.push_back(box_along(dot.x_px, last.y_px, dot.x_px, dot.y_px));
    }
    svg += fmt::format(R"(<path class="front" d="{}"/>)", path);
    return boxes;
}

double clearance(const Dot& dot) {
    return dot.is_best ? kRingRadius + 5.0 : kMarkRadius + 5.0;
}

LabelBox box_around(const Dot& dot) {
    const double half = clearance(dot) - 3.0;
    return {.left = dot.x_px - half,
            .top = dot.y_px - half,
            .right = dot.x_px + half,
            .bottom = dot.y_px + half};
}

std::string marks(const Study& study, const std::vector<Dot>& dots) {
    std::string svg;
    for (const Dot& dot : dots) {
        const StudyMeasure& measure = study.measures[dot.index];
        if (dot.is_best) {
            svg += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{:.1f}" class="ring"/>)",
                               dot.x_px,
                               dot.y_px,
                               kRingRadius);
        }
        const std::string title = fmt::format("<title>{}: {:.3g} s, {}</title>",
                                              escaped(measure.setting.words),
                                              measure.total_s(),
                                              scientific(measure.max_error()));
        svg += mark(measure.setting.subject, measure.setting.bands > 0, dot.x_px, dot.y_px, title);
    }
    return svg;
}

// The recommended one first, then the front. Leaders lie under all words.
std::string labels(const Study& study,
                   std::vector<Dot> dots,
                   const SvgPanel& panel,
                   std::vector<LabelBox> taken) {
    constexpr double kMiddleToBaseline = 4.0;
    std::ranges::stable_sort(dots, std::ranges::greater{}, [](const Dot& dot) {
        return std::pair(dot.is_best, dot.on_front);
    });
    const LabelBox bounds{
        .left = panel.left, .top = panel.top, .right = panel.right(), .bottom = panel.bottom()};
    std::string leaders;
    std::string texts;
    for (const Dot& dot : dots) {
        const std::string& text = study.measures[dot.index].setting.name;
        const LabelPlace place = place_label(
            dot.x_px, dot.y_px, text_width(text, kLabelFont_px), clearance(dot), taken, bounds);
        taken.push_back(place.box);
        if (place.is_far) {
            leaders += svg_line(dot.x_px, dot.y_px, place.x_px, place.y_px, R"(class="leader")");
        }
        texts += svg_text(place.x_px,
                          place.y_px + kMiddleToBaseline,
                          place.anchor,
                          dot.on_front ? R"(class="label strong")" : R"(class="label")",
                          text);
    }
    return leaders + texts;
}

}  // namespace

bool is_drawn(const StudyMeasure& measure) {
    const auto has_logarithm = [](double value) { return value > 0.0 && std::isfinite(value); };
    return has_logarithm(measure.total_s()) && has_logarithm(measure.max_error());
}

std::string subject_mark(std::string_view subject, bool hollow) {
    return fmt::format(R"(<svg class="dot-key" viewBox="0 0 14 14">{}</svg>)",
                       mark(subject, hollow, 7.0, 7.0, ""));
}

std::string study_svg(const Study& study) {
    const SvgPanel panel = panel_of(study);
    const std::vector<Dot> dots = dots_of(study, panel);
    std::string svg = svg_axes(panel);
    std::vector<LabelBox> taken = front_steps(dots, svg);
    for (const Dot& dot : dots) taken.push_back(box_around(dot));
    if (study.tolerance > 0.0) {
        const double y = panel.y_px(study.tolerance);
        taken.push_back(box_along(panel.left, y, panel.right(), y));
        svg += svg_level(panel, study.tolerance, R"(class="bound")");
    }
    svg += marks(study, dots) + labels(study, dots, panel, taken);
    return svg_drawing("study-plot",
                       "largest error of each setting over its time",
                       panel.right() + 14.0,
                       panel.bottom() + kAxisHeight,
                       svg);
}

}  // namespace aphotic
