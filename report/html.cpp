// SPDX-License-Identifier: BSD-3-Clause
#include "report/html.h"

#include "base/number.h"
#include "report/page_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace aphotic {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD
constexpr std::string_view kMinus = "−";                   // U+2212
constexpr std::string_view kTimes = "\xC2\xA0×\xC2\xA0";   // between blanks that do not break
constexpr std::string_view kNarrowBlank = "\xE2\x80\xAF";  // U+202F, does not break

std::string with_minus(const std::string& number) {
    return number.starts_with('-') ? std::string(kMinus) + number.substr(1) : number;
}

std::string superscript(int number) {
    static constexpr std::array<std::string_view, 10> kDigits{
        "⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string result;
    for (const char digit : fmt::format("{}", number)) {
        if (digit == '-') {
            result += "⁻";
        } else {
            result += kDigits[static_cast<std::size_t>(digit - '0')];
        }
    }
    return result;
}

// The second byte of U+0080 to U+009F, which follow 0xC2 in UTF-8.
bool is_upper_control(unsigned char first, unsigned char second) {
    return first == 0xC2 && second >= 0x80 && second < 0xA0;
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : ' ');
        if (byte == '<') {
            result += "&lt;";
        } else if (byte == '>') {
            result += "&gt;";
        } else if (byte == '&') {
            result += "&amp;";
        } else if (byte == '"') {
            result += "&quot;";
        } else if (byte == '\'') {
            result += "&#39;";
        } else if (byte == '\n' || byte == '\t' || byte == '\r') {
            result += ' ';
        } else if (byte < 0x20 || byte == 0x7F) {
            result += kReplacement;
        } else if (is_upper_control(byte, next)) {
            result += kReplacement;
            ++i;
        } else {
            result += text[i];
        }
    }
    return result;
}

std::string user_text(std::string_view text) {
    return "<bdi>" + escaped(text) + "</bdi>";
}

std::string scientific(double value) {
    if (std::isnan(value)) return "not a number";
    if (std::isinf(value)) return value > 0.0 ? "∞" : std::string(kMinus) + "∞";
    if (value == 0.0) return "0";
    // Through text, so that 9.999e-5 is rounded to 1.00e-4 before the exponent is read.
    const std::string text = fmt::format("{:.2e}", value);
    const std::size_t split = text.find('e');
    const int exponent = exponent_of(text);
    if (exponent >= -2 && exponent < 3)
        return with_minus(fmt::format("{:.{}f}", value, 2 - exponent));
    return fmt::format(
        "{}{}10{}", with_minus(text.substr(0, split)), kTimes, superscript(exponent));
}

int exponent_of(std::string_view text) {
    std::string_view digits = text.substr(text.find('e') + 1);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    return read_number<int>(digits).value();
}

std::string power_label(double factor, int exponent) {
    if (factor == 1.0) return "10" + superscript(exponent);
    return fmt::format("{}{}10{}", plain(factor), kTimes, superscript(exponent));
}

std::string plain(double value) {
    return with_minus(fmt::format("{:.6g}", value == 0.0 ? 0.0 : value));
}

std::string grouped_count(std::size_t count, std::string_view noun) {
    return fmt::format("{} {}{}", grouped(count), noun, count == 1 ? "" : "s");
}

std::string grouped(std::size_t count) {
    std::string digits = fmt::format("{}", count);
    for (auto i = static_cast<std::ptrdiff_t>(digits.size()) - 3; i > 0; i -= 3)
        digits.insert(static_cast<std::size_t>(i), kNarrowBlank);
    return digits;
}

std::string html_paragraph(std::string_view content) {
    return fmt::format("<p>{}</p>\n", content);
}

std::string html_section(std::string_view id, std::string_view heading, std::string_view content) {
    return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n\n", id, heading, content);
}

std::string html_header(std::string_view kind, std::string_view heading, std::string_view content) {
    return fmt::format(
        "<header>\n<p class=\"eyebrow\">Aphotic · {}</p>\n<h1>{}</h1>\n{}</header>\n\n",
        kind,
        heading,
        content);
}

std::string html_verdict(bool holds, std::string_view word, std::string_view content) {
    return fmt::format(
        "<div class=\"verdict {}\" id=\"verdict\">\n<p class=\"word\">{}</p>\n{}</div>\n",
        holds ? "holds" : "fails",
        word,
        content);
}

std::string html_key(std::string_view drawing, std::string_view words) {
    return fmt::format("<span class=\"key\">{} {}</span>\n", drawing, words);
}

std::string html_stroke_key(std::string_view style, std::string_view words) {
    return html_key(
        fmt::format(
            R"(<svg class="stroke" viewBox="0 0 34 12"><path class="{}" d="M2 6L32 6"/></svg>)",
            style),
        words);
}

std::string html_legend(std::string_view keys) {
    return fmt::format("<p class=\"legend\">\n{}</p>\n", keys);
}

std::string html_source(std::string_view text) {
    std::string lines;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        std::string_view line = text.substr(0, end);
        if (line.ends_with('\r')) line.remove_suffix(1);
        lines += escaped(line) + '\n';
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    return "<pre>" + lines + "</pre>\n";
}

std::string html_list(std::string_view id, std::span<const HtmlItem> items) {
    std::string list;
    for (const auto& [term, meaning] : items)
        list += fmt::format("<dt>{}</dt><dd>{}</dd>\n", term, meaning);
    return fmt::format("<dl id=\"{}\">\n{}</dl>\n", id, list);
}

std::string html_table(std::string_view id,
                       std::string_view columns,
                       std::span<const HtmlRow> rows) {
    std::vector<std::string_view> marks;  // by column
    std::string head;
    for (std::size_t from = 0; from <= columns.size();) {
        const std::size_t to = std::min(columns.find(';', from), columns.size());
        const std::string_view heading = columns.substr(from, to - from);
        from = to + 1;
        marks.push_back(heading.empty() ? R"( class="mark")" : "");
        head += fmt::format("<th{}>{}</th>", marks.back(), escaped(heading));
    }
    std::string body;
    for (const HtmlRow& row : rows) {
        body +=
            fmt::format("<tr class=\"{}\"><th scope=\"row\">{}</th>", row.style, row.cells.front());
        for (std::size_t i = 1; i < row.cells.size(); ++i)
            body += fmt::format("<td{}>{}</td>", marks.at(i), row.cells[i]);
        body += "</tr>\n";
    }
    return fmt::format(
        "<div class=\"wide\"><table id=\"{}\">\n<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody>\n"
        "</table></div>\n",
        id,
        head,
        body);
}

std::string html_page(std::string_view title, std::string_view content) {
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n"
        "<meta charset=\"utf-8\"/>\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
        "img-src data:; style-src 'unsafe-inline'\"/>\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
        "<title>{}</title>\n<style>\n{}{}</style>\n</head>\n<body>\n<main>\n{}</main>\n</body>\n"
        "</html>\n",
        escaped(title),
        kSvgStyle,
        kPageStyle,
        content);
}

}  // namespace aphotic
