// SPDX-License-Identifier: BSD-3-Clause
#include "report/page.h"

#include "support/page.h"

#include <gtest/gtest.h>

namespace aphotic::page_test {
namespace {

// One of every part, with the same text wherever there is one.
Page page_of(const std::string& text) {
    return {
        .kind = text,
        .title = text,
        .heading = text,
        .headline = text,
        .said = {text},
        .warnings = {text},
        .sections = {
            {.id = "all",
             .heading = text,
             .parts = {text,
                       PageHeading{text},
                       PageTable{.columns = {text}, .rows = {{.cells = {text, text}}}},
                       PageList{{text, text}},
                       PageFigures{.figures = {{.pictures = {{.words = text}}, .caption = text}}},
                       PageLegend{stroke_key("bound", text), swatch_key(0, text)},
                       PageSource{text}}}}};
}

TEST(Page, HoldsAnyTextAsText) {
    const std::string evil = "</title></pre>\"><script>alert('1' & 2)</script>\x01";
    const std::string page = page_html(page_of(evil));
    EXPECT_EQ(first_unbalanced(page), "");
    EXPECT_FALSE(contains(page, "<script"));
    EXPECT_FALSE(contains(page, "'1' &"));
    EXPECT_FALSE(contains(page, "\x01"));
    std::size_t count = 0;
    const std::string safe = "&lt;script&gt;alert(&#39;1&#39; &amp; 2)&lt;/script&gt;�";
    for (std::size_t at = page.find(safe); at != std::string::npos; at = page.find(safe, at + 1))
        ++count;
    EXPECT_EQ(count, 19U) << "each text of the page, once";
}

TEST(Page, LetsABrowserNeitherRunNorFetch) {
    const std::string page = page_html(page_of("text"));
    EXPECT_TRUE(contains(page, "default-src 'none'; img-src data:"));
    for (const char* what : {"<script", "<link", "url(", "@import", "href="})
        EXPECT_FALSE(contains(page, what)) << what;
    EXPECT_TRUE(contains(page, "src=\"data:image/png;base64,"));
}

TEST(Page, SaysItsAnswerItsWarningsAndItsNumbers) {
    Page page{
        .kind = "kind",
        .heading = "HabCam",
        .headline = "All is well",
        .sections = {
            {.id = "numbers",
             .heading = "Numbers",
             .parts = {PageTable{.columns = {"row", "a \"b\"", ""},
                                 .rows = {{.cells = {"x", "1", "✓"}, .tone = PageTone::Good}}}}},
            {.id = "nothing", .heading = "Nothing", .parts = {}}}};
    std::string html = page_html(page);
    EXPECT_TRUE(contains(html, "<title>HabCam</title>")) << html;
    EXPECT_TRUE(contains(html, "verdict holds"));
    EXPECT_TRUE(contains(html, "<th>row</th><th>a &quot;b&quot;</th><th class=\"mark\"></th>"));
    EXPECT_TRUE(contains(html,
                         "<tr class=\"holds\"><th scope=\"row\">x</th><td>1</td>"
                         "<td class=\"mark\">✓</td></tr>"));
    EXPECT_FALSE(contains(html, "Warnings"));
    EXPECT_FALSE(contains(html, "Nothing")) << "a section without parts";
    page.is_good = false;
    page.warnings = {"the lamps are off", "so is the camera"};
    html = page_html(page);
    EXPECT_TRUE(contains(html, "verdict fails"));
    EXPECT_TRUE(contains(html, "<p>the lamps are off</p>\n<p>so is the camera</p>"));
}

TEST(Page, KeepsTheLinesOfASource) {
    const auto shown = [](const std::string& text) {
        return page_html({.sections = {{.id = "s", .heading = "S", .parts = {PageSource{text}}}}});
    };
    EXPECT_TRUE(contains(shown("a <b>\r\n  c & d\n\nlast"),
                         "<pre>a &lt;b&gt;\n  c &amp; d\n\nlast\n</pre>"));
    EXPECT_TRUE(contains(shown(""), "<pre></pre>"));
}

// A small PNG shows its pixels as squares; a ring is at a share of width and height.
TEST(Page, ShowsPicturesBesideEachOther) {
    const PagePicture small{.bytes = "1", .width_px = 20, .height_px = 10, .ring = {{0.25, 0.5}}};
    const PagePicture large{.bytes = "2", .width_px = 800, .height_px = 400};
    const std::string html = page_html(
        {.sections = {
             {.id = "s",
              .heading = "S",
              .parts = {PageFigures{.figures = {{.pictures = {small, large}, .caption = "both"},
                                                {.pictures = {large}}}}}}}});
    EXPECT_TRUE(contains(html, R"(class="picture squares" width="20" height="10")")) << html;
    EXPECT_TRUE(contains(html, R"(class="picture" width="800" height="400")"));
    EXPECT_TRUE(contains(html, R"(style="left: 25.00%; top: 50.00%")"));
    EXPECT_TRUE(contains(html, "<div class=\"pair\">"));
    EXPECT_TRUE(contains(html, "<div class=\"duo\">"));
    EXPECT_TRUE(contains(html, "<figcaption>both</figcaption>"));
}

TEST(Page, SaysWhoMadeIt) {
    EXPECT_FALSE(contains(page_html({}), "made-by"));
    set_page_origin({.command = "aphotic study 'a <b>'", .version = "1.2", .date = "2026-01-02"});
    const std::string html = page_html({});
    set_page_origin({});
    EXPECT_TRUE(contains(html, "<dd>aphotic study &#39;a &lt;b&gt;&#39;</dd>")) << html;
    EXPECT_TRUE(contains(html, "<dd>1.2</dd>"));
    EXPECT_TRUE(contains(html, "<dd>2026-01-02</dd>"));
}

// First strong isolate, pop directional isolate.
TEST(Named, SetsANameApartThatCannotEndIt) {
    const std::string begin = "\xE2\x81\xA8";
    const std::string end = "\xE2\x81\xA9";
    EXPECT_EQ(named("深海"), begin + "深海" + end);
    EXPECT_EQ(named(end + "a" + end), begin + "a" + end);
}

}  // namespace
}  // namespace aphotic::page_test
