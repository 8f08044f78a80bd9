// SPDX-License-Identifier: BSD-3-Clause
//
// A page for people as plain data: its heading, warnings, sections of text, tables, figures and
// plots, and its origin. Only page_html() converts it to markup.
//
// All text is plain, with arbitrary characters, and is escaped here. Drawings are <svg> as written
// by svg.h and plot.h, which escape their own labels. Names chosen by users are named() within a
// sentence, so that their direction of writing does not affect it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace aphotic {

[[nodiscard]] std::string named(std::string_view text);

inline constexpr std::string_view kPng = "image/png";
inline constexpr std::string_view kJpeg = "image/jpeg";

// An embedded picture, the value of src="...", from a file's bytes.
[[nodiscard]] std::string data_uri(std::string_view picture, std::string_view type = kPng);

enum class PageTone { None, Good, Bad };

struct PageRow {
    std::vector<std::string> cells{};
    PageTone tone = PageTone::None;
};

// The first column names the rows; a column without a heading is for marks.
struct PageTable {
    std::vector<std::string> columns{};
    std::vector<PageRow> rows{};
};

// Terms and their meanings.
using PageList = std::vector<std::pair<std::string, std::string>>;

struct PagePicture {
    std::string bytes{};
    int width_px = 0;
    int height_px = 0;
    std::string words{};  // for readers who do not see it
    std::string_view type = kPng;
    std::optional<std::pair<double, double>> ring{};  // around this share of its width and height
};

// Pictures side by side, with one caption.
struct PageFigure {
    std::vector<PagePicture> pictures{};
    std::string caption{};
};

// Side by side: two in a row, or as many as fit.
struct PageFigures {
    std::vector<PageFigure> figures{};
    bool are_small = false;
};

struct PagePlot {
    std::string svg{};
};

// The key of a plot or a map: drawings or characters, and their meanings.
struct PageKey {
    std::string svg{};  // from stroke_key() and similar functions, or a character
    std::string words{};
};
using PageLegend = std::vector<PageKey>;

[[nodiscard]] PageKey stroke_key(std::string_view style, std::string words);  // style: as in svg.h
[[nodiscard]] PageKey swatch_key(std::uint32_t colour, std::string words);    // 0xRRGGBB

struct PageHeading {
    std::string text{};
};

// Preformatted lines, such as a rig's.
struct PageSource {
    std::string text{};
};

// A string is a paragraph.
using PagePart = std::variant<std::string,
                              PageHeading,
                              PageTable,
                              PageList,
                              PageFigures,
                              PagePlot,
                              PageLegend,
                              PageSource>;

struct PageSection {
    std::string id{};  // lower case letters, digits and -
    std::string heading{};
    std::vector<PagePart> parts{};
};

struct Page {
    std::string kind{};   // such as "validation"
    std::string title{};  // of the window; the heading if empty
    std::string heading{};
    bool is_good = true;              // green or red
    std::string headline{};           // the result in a sentence
    std::vector<std::string> said{};  // further sentences
    std::vector<std::string> warnings{};
    std::vector<PageSection> sections{};  // those without parts are omitted
};

// The origin shown on a program's pages: set once, before its first page. Pages made by callers of
// the library show none.
struct PageOrigin {
    std::string command{};  // line
    std::string version{};
    std::string date{};
};
void set_page_origin(PageOrigin origin);

// A self-contained file, well-formed as HTML and as XML, which a browser forbids to run or fetch
// anything. The same page and origin give the same bytes.
[[nodiscard]] std::string page_html(const Page& page);

}  // namespace aphotic
