// SPDX-License-Identifier: BSD-3-Clause
#include "report/page.h"

#include "report/html.h"
#include "report/page_style.h"
#include "report/svg.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <cstddef>

namespace aphotic {
namespace {

PageOrigin& page_origin() {
    static PageOrigin origin;
    return origin;
}

std::string_view style_of(PageTone tone) {
    return tone == PageTone::Good ? "holds" : tone == PageTone::Bad ? "fails" : "";
}

std::string html_of(const std::string& paragraph) {
    return fmt::format("<p>{}</p>\n", escaped(paragraph));
}

std::string html_of(const PageHeading& heading) {
    return fmt::format("<h3>{}</h3>\n", escaped(heading.text));
}

std::string html_of(const PageTable& table) {
    const auto cell = [&](std::string_view tag, std::size_t column, const std::string& text) {
        const bool is_mark = column < table.columns.size() && table.columns[column].empty();
        return fmt::format(
            "<{0}{1}>{2}</{0}>", tag, is_mark ? R"( class="mark")" : "", escaped(text));
    };
    std::string head;
    for (std::size_t i = 0; i < table.columns.size(); ++i) head += cell("th", i, table.columns[i]);
    std::string body;
    for (const PageRow& row : table.rows) {
        body += fmt::format("<tr class=\"{}\"><th scope=\"row\">{}</th>",
                            style_of(row.tone),
                            escaped(row.cells.front()));
        for (std::size_t i = 1; i < row.cells.size(); ++i) body += cell("td", i, row.cells[i]);
        body += "</tr>\n";
    }
    return fmt::format(
        "<div class=\"wide\"><table>\n<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody>\n"
        "</table></div>\n",
        head,
        body);
}

std::string html_of(const PageList& list) {
    std::string items;
    for (const auto& [term, meaning] : list)
        items += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped(term), escaped(meaning));
    return fmt::format("<dl>\n{}</dl>\n", items);
}

std::string html_of(const PagePicture& picture) {
    constexpr int kSmall_px = 400;
    const bool shows_pixels = picture.width_px < kSmall_px && picture.type == kPng;
    std::string image =
        fmt::format(R"(<img class="picture{}" width="{}" height="{}" alt="{}" src="{}"/>)",
                    shows_pixels ? " squares" : "",
                    picture.width_px,
                    picture.height_px,
                    escaped(picture.words),
                    data_uri(picture.bytes, picture.type));
    if (!picture.ring) return image;
    return fmt::format(
        R"(<div class="map">{}<i class="worst" style="left: {:.2f}%; top: {:.2f}%"></i></div>)",
        image,
        100.0 * picture.ring->first,
        100.0 * picture.ring->second);
}

std::string html_of(const PageFigure& figure) {
    std::string pictures;
    for (const PagePicture& picture : figure.pictures) pictures += html_of(picture);
    if (figure.pictures.size() > 1) {
        pictures = fmt::format(
            "<div class=\"duo{}\">{}</div>", figure.pictures.size() > 2 ? " trio" : "", pictures);
    }
    if (figure.caption.empty()) return fmt::format("<figure>{}</figure>\n", pictures);
    return fmt::format(
        "<figure>{}<figcaption>{}</figcaption></figure>\n", pictures, escaped(figure.caption));
}

std::string html_of(const PageFigures& figures) {
    std::string content;
    for (const PageFigure& figure : figures.figures) content += html_of(figure);
    if (figures.figures.size() == 1 && !figures.are_small) return content;
    return fmt::format(
        "<div class=\"{}\">\n{}</div>\n", figures.are_small ? "sheet" : "pair", content);
}

std::string html_of(const PagePlot& plot) {
    return fmt::format("<figure class=\"plot wide\">\n{}</figure>\n", plot.svg);
}

std::string html_of(const PageLegend& legend) {
    std::string keys;
    for (const PageKey& key : legend)
        keys += fmt::format("<span class=\"key\">{} {}</span>\n", key.svg, escaped(key.words));
    return fmt::format("<p class=\"legend\">\n{}</p>\n", keys);
}

std::string html_of(const PageSource& source) {
    std::string lines;
    for (std::string_view rest = source.text; !rest.empty();) {
        const std::size_t end = rest.find('\n');
        std::string_view line = rest.substr(0, end);
        if (line.ends_with('\r')) line.remove_suffix(1);
        lines += escaped(line) + '\n';
        rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
    return "<pre>" + lines + "</pre>\n";
}

std::string html_of(const PageSection& section) {
    if (section.parts.empty()) return "";
    std::string content;
    for (const PagePart& part : section.parts)
        content += std::visit([](const auto& one) { return html_of(one); }, part);
    return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n\n",
                       section.id,
                       escaped(section.heading),
                       content);
}

PageSection warnings_of(const Page& page) {
    PageSection section{.id = "warnings", .heading = "Warnings"};
    for (const std::string& warning : page.warnings) section.parts.emplace_back(warning);
    return section;
}

PageSection made_by(const PageOrigin& origin) {
    PageSection section{.id = "made-by", .heading = "Made by"};
    PageList list;
    for (const auto& [name, value] : {std::pair("command line", origin.command),
                                      std::pair("Aphotic", origin.version),
                                      std::pair("date", origin.date)}) {
        if (!value.empty()) list.emplace_back(name, value);
    }
    if (!list.empty()) section.parts.emplace_back(std::move(list));
    return section;
}

std::string small_drawing(std::string_view style, int width, std::string_view element) {
    return fmt::format(R"(<svg class="{}" viewBox="0 0 {} 12">{}</svg>)", style, width, element);
}

}  // namespace

std::string named(std::string_view text) {
    // First strong isolate to pop directional isolate, U+2068 and U+2069; a name must not end it.
    constexpr std::string_view kIsolate = "\xE2\x81\xA8";
    constexpr std::string_view kPop = "\xE2\x81\xA9";
    std::string inner(text);
    for (std::size_t at = inner.find(kPop); at != std::string::npos; at = inner.find(kPop, at))
        inner.erase(at, kPop.size());
    return fmt::format("{}{}{}", kIsolate, inner, kPop);
}

std::string data_uri(std::string_view picture, std::string_view type) {
    std::vector<unsigned char> base64(4 * ((picture.size() + 2) / 3) + 1);  // and a terminating 0
    const int length = EVP_EncodeBlock(base64.data(),
                                       reinterpret_cast<const unsigned char*>(picture.data()),
                                       static_cast<int>(picture.size()));
    return fmt::format("data:{};base64,", type) +
           std::string(base64.begin(), base64.begin() + static_cast<std::ptrdiff_t>(length));
}

PageKey stroke_key(std::string_view style, std::string words) {
    return {small_drawing("stroke", 34, fmt::format(R"(<path class="{}" d="M2 6L32 6"/>)", style)),
            std::move(words)};
}

PageKey swatch_key(std::uint32_t colour, std::string words) {
    return {
        small_drawing(
            "swatch", 12, fmt::format(R"(<rect width="12" height="12" fill="#{:06x}"/>)", colour)),
        std::move(words)};
}

void set_page_origin(PageOrigin origin) {
    page_origin() = std::move(origin);
}

std::string page_html(const Page& page) {
    std::string said;
    for (const std::string& paragraph : page.said) said += html_of(paragraph);
    std::string content = html_of(warnings_of(page));
    for (const PageSection& section : page.sections) content += html_of(section);
    content += html_of(made_by(page_origin()));
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n"
        "<meta charset=\"utf-8\"/>\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
        "img-src data:; style-src 'unsafe-inline'\"/>\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
        "<title>{}</title>\n<style>\n\n{}\n{}</style>\n</head>\n<body>\n<main>\n"
        "<header>\n<p class=\"eyebrow\">Aphotic · {}</p>\n<h1>{}</h1>\n"
        "<div class=\"verdict {}\" id=\"verdict\">\n<p "
        "class=\"word\">{}</p>\n{}</div>\n</header>\n\n"
        "{}</main>\n</body>\n</html>\n",
        escaped(page.title.empty() ? page.heading : page.title),
        style_sheets()[0].css,
        style_sheets()[1].css,
        escaped(page.kind),
        escaped(page.heading),
        page.is_good ? "holds" : "fails",
        escaped(page.headline),
        said,
        content);
}

}  // namespace aphotic
