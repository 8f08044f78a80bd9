// SPDX-License-Identifier: BSD-3-Clause
//
// The page is well-formed XML too, as report.html is.
#include "base/number.h"
#include "report/html.h"
#include "validation/error_view.h"
#include "validation/study_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

namespace aphotic {
namespace {

// A subject that has no words here is its own heading.
StudySubject words_of(std::string_view subject) {
    const auto found = std::ranges::find(kStudySubjects, subject, &StudySubject::name);
    return found == kStudySubjects.end() ? StudySubject{subject, subject, ""} : *found;
}

std::string title_of(const Study& study) {
    return study.rig_title.empty() ? "Untitled rig" : study.rig_title;
}

// Three digits, or whole seconds.
std::string time_in_digits(double value_s) {
    return fmt::format("{:.{}f}", value_s, value_s < 10.0 ? 2 : value_s < 100.0 ? 1 : 0);
}

std::string seconds(double value_s) {
    return time_in_digits(value_s) + "\xC2\xA0s";  // a blank that does not break
}

std::string ratio_in_words(double ratio) {
    return fmt::format("{:.{}f}", ratio, ratio < 1.0 ? 2 : ratio < 100.0 ? 1 : 0);
}

// 10⁻³, 5 × 10⁻⁴, 0.05: as it was asked for, without digits that it never had.
std::string tolerance_in_words(double tolerance) {
    constexpr double kReadAsItIs = 0.0099;
    if (tolerance >= kReadAsItIs || !(tolerance > 0.0)) return plain(tolerance);
    const std::string text = fmt::format("{:.2e}", tolerance);
    const std::size_t split = text.find('e');
    const auto factor = read_number<double>(std::string_view(text).substr(0, split));
    return power_label(*factor, exponent_of(text));
}

// The recommendation.

std::string compared_with_customary(const Study& study, const StudyMeasure& best) {
    const StudyMeasure* customary = find_measure(study.measures, kCustomary);
    const auto ratio = time_ratio(study.measures, kCustomary, best.setting.name);
    if (customary == &best || !ratio) return "";
    const std::string words = escaped(customary->setting.words);
    if (*ratio < 1.0)
        return fmt::format(", {} times as long as {}", ratio_in_words(1.0 / *ratio), words);
    return fmt::format(", {} times as fast as {}", ratio_in_words(*ratio), words);
}

std::string recommendation(const Study& study) {
    const std::string tolerance = tolerance_in_words(study.tolerance);
    if (const auto index = recommended(study.measures, study.tolerance)) {
        const StudyMeasure& best = study.measures[*index];
        return fmt::format("For {} the cheapest setting is {}: {}, largest error {}{}.",
                           tolerance,
                           escaped(best.setting.words),
                           seconds(best.total_s()),
                           scientific(best.max_error()),
                           compared_with_customary(study, best));
    }
    const auto closest = std::ranges::min_element(study.measures, {}, &StudyMeasure::max_error);
    if (closest == study.measures.end()) return "Nothing was measured.";
    return fmt::format("No setting here keeps {}. The closest is {}: {}, largest error {}.",
                       tolerance,
                       escaped(closest->setting.words),
                       seconds(closest->total_s()),
                       scientific(closest->max_error()));
}

// What the customary ways cost against the baseline.
std::string customary_in_words(const Study& study) {
    const auto ratio = time_ratio(study.measures, kCustomary, kBaseline);
    if (!ratio) return "";
    const auto mono = time_ratio(study.measures, kCustomaryMono, kBaseline);
    return html_paragraph(fmt::format(
        "{} take {} times as long as {}{}.",
        escaped(find_measure(study.measures, kCustomary)->setting.words),
        ratio_in_words(*ratio),
        escaped(find_measure(study.measures, kBaseline)->setting.words),
        mono ? fmt::format(", with one wavelength a frame {} times", ratio_in_words(*mono)) : ""));
}

std::string verdict(const Study& study) {
    const bool found = recommended(study.measures, study.tolerance).has_value();
    return html_verdict(found, recommendation(study), customary_in_words(study));
}

std::string what_was_measured(const Study& study) {
    return html_paragraph(fmt::format(
        "{} of {}, {} × {} pixels, with Aphotic {} and POV-Ray {} on {}: the wall time of each, "
        "and how far its image is from the reference tracer’s over {}, which takes {} "
        "itself.{}",
        grouped_count(study.measures.size(), "setting"),
        user_text(title_of(study)),
        study.width_px,
        study.height_px,
        escaped(study.aphotic_version),
        escaped(study.povray_version),
        grouped_count(static_cast<std::size_t>(study.cores), "core"),
        grouped_count(study.grid_size, "wavelength"),
        seconds(study.trace_s),
        study.quick ? " A quick study: few settings, and few pixels over the rig’s field of view."
                    : ""));
}

// The plot.

// In the order in which they come.
std::vector<std::string> subjects_of(const Study& study) {
    std::vector<std::string> subjects;
    for (const StudyMeasure& measure : study.measures) {
        if (std::ranges::find(subjects, measure.setting.subject) == subjects.end())
            subjects.push_back(measure.setting.subject);
    }
    return subjects;
}

std::string legend(const Study& study) {
    std::string keys;
    for (const std::string& subject : subjects_of(study)) {
        keys += html_key(subject_mark(subject, false), escaped(words_of(subject).heading));
    }
    keys += html_key(subject_mark("wavelengths", true), "hollow: equal bands, filled: fitted");
    keys += html_stroke_key("front", "Pareto front");
    keys += html_stroke_key("bound", "tolerance");
    keys += html_key("◯", "recommended");
    return html_legend(keys);
}

std::string left_out(const Study& study) {
    const auto drawn = std::ranges::count_if(study.measures, is_drawn);
    const std::size_t missing = study.measures.size() - static_cast<std::size_t>(drawn);
    if (missing == 0) return "";
    return html_paragraph(
        fmt::format("{} not drawn: the error is 0 or not finite.",
                    grouped_count(missing, "setting") + (missing == 1 ? " is" : " are")));
}

std::string plot(const Study& study) {
    return legend(study) +
           fmt::format("<figure class=\"plot wide\">\n{}</figure>\n", study_svg(study)) +
           left_out(study);
}

// The table.

std::string edge_error(const StudyMeasure& measure) {
    const bool has_edges = std::ranges::any_of(
        measure.channels, [](const Comparison& channel) { return channel.on_edges > 0; });
    return has_edges ? scientific(measure.max_error_on_edges()) : "–";
}

constexpr std::string_view kColumns =
    "setting;wave\u00ADlengths;frames;render [s];integrate [s];time [s];×\u00A0baseline;"
    "largest error;99.9 %;off edges;on edges;";

HtmlRow table_row(const Study& study, std::size_t index, bool on_front) {
    const StudyMeasure& measure = study.measures[index];
    const auto ratio = time_ratio(study.measures, measure.setting.name, kBaseline);
    const bool is_best = recommended(study.measures, study.tolerance) == index;
    return {.style = is_best ? "best" : "",
            .cells = {escaped(measure.setting.words),
                      grouped(measure.wavelengths),
                      grouped(measure.frames),
                      time_in_digits(measure.render_s),
                      time_in_digits(measure.integrate_s),
                      time_in_digits(measure.total_s()),
                      ratio ? ratio_in_words(*ratio) : "–",
                      scientific(measure.max_error()),
                      scientific(measure.percentile_999()),
                      scientific(measure.max_error_off_edges()),
                      edge_error(measure),
                      is_best    ? "★ recommended"
                      : on_front ? "✓ front"
                                 : ""}};
}

std::string settings(const Study& study) {
    const std::vector<bool> front = pareto_front(study.measures);
    std::vector<HtmlRow> rows;
    for (std::size_t i = 0; i < study.measures.size(); ++i) {
        rows.push_back(table_row(study, i, front[i]));
    }
    std::vector<HtmlItem> subjects;
    for (const std::string& subject : subjects_of(study)) {
        const StudySubject words = words_of(subject);
        subjects.emplace_back(escaped(words.heading), words.words);
    }
    return html_table("measures", kColumns, rows) + html_list("subjects", subjects);
}

// How to read it.

std::string baseline_in_words(const Study& study) {
    const StudyMeasure* baseline = find_measure(study.measures, kBaseline);
    if (baseline == nullptr) return "";
    return fmt::format(" The baseline is {}.", escaped(baseline->setting.words));
}

std::string notes(const Study& study) {
    return error_rule("a pixel’s signal in a channel",
                      "the reference’s",
                      "what counts as black: 10⁻⁸ of the channel’s brightest") +
           html_paragraph(
               "Errors are of |<i>e</i>| in the worst of the three channels, over all pixels off "
               "the edges of beams, shadows and objects: the largest, the 99.9 percentile and the "
               "root mean square. "
               "No factor is fitted: the absolute scale is part of it. Pixels on the edge of a "
               "cone, which lie on both sides of it, are measured on their own.") +
           html_paragraph(
               "The time is POV-Ray’s and the integration’s, enlarging included, as a clock on "
               "the wall shows it. Seconds are this machine’s; ratios carry over better." +
               baseline_in_words(study)) +
           html_paragraph(
               "On the Pareto front are the settings that no other beats in both time and error. "
               "Along it, accuracy costs time; a setting above it never pays. The recommended "
               "setting is the fastest whose largest error is within the tolerance.") +
           html_paragraph(fmt::format("Rig: SHA-256 <code>{}</code>", escaped(study.rig_sha256)));
}

}  // namespace

std::string study_page(const Study& study) {
    return html_page(title_of(study) + ": accuracy against time",
                     html_header("accuracy against time",
                                 user_text(title_of(study)),
                                 verdict(study) + what_was_measured(study)) +
                         html_section("plot", "Error against time", plot(study)) +
                         html_section("settings", "Settings", settings(study)) +
                         html_section("reading", "How to read it", notes(study)));
}

}  // namespace aphotic
