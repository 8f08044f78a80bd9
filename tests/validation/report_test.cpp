// SPDX-License-Identifier: BSD-3-Clause
#include "validation/report.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/page.h"
#include "support/png.h"
#include "support/refusal.h"
#include "support/small_report.h"
#include "support/temp_folder.h"
#include "validation/error_view.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <regex>
#include <utility>

namespace aphotic::report_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Json json_of(const ValidationReport& report) {
    const TempFolder folder;
    write_validation_json(report, folder.path() / "validation.json");
    return Json::parse(read_text_file(folder.path() / "validation.json"));
}

std::string page_of(const ValidationReport& report) {
    const TempFolder folder;
    write_validation_html(report, folder.path() / "report.html");
    return read_text_file(folder.path() / "report.html");
}

// The verdict.

TEST(ShareOfBound, IsInfiniteForWhatIsNotFinite) {
    Comparison comparison = comparison_of("R", 3e-4, 6e-4);
    EXPECT_DOUBLE_EQ(share_of_bound(comparison), 0.5);
    comparison.not_finite = 1;
    EXPECT_EQ(share_of_bound(comparison), kInfinity);
    EXPECT_EQ(share_of_bound(comparison_of("R", 0.0, 0.0)), 0.0);
    EXPECT_EQ(share_of_bound(comparison_of("R", 1e-9, 0.0)), kInfinity);
}

TEST(Report, HoldsWhenEveryComparisonDoes) {
    EXPECT_TRUE(small_report().holds());
    ValidationReport wavelength_fails = small_report();
    wavelength_fails.wavelengths[2].max_error = 6.0001e-4;
    EXPECT_FALSE(wavelength_fails.holds());
    ValidationReport channel_fails = small_report();
    channel_fails.channels[1].not_finite = 1;
    EXPECT_FALSE(channel_fails.holds());
}

TEST(Report, OfNothingDoesNotHold) {
    ValidationReport report = small_report();
    report.wavelengths.clear();
    report.channels.clear();
    EXPECT_FALSE(report.holds());
}

// R's error is the largest, but 550 nm is closer to its bound.
TEST(Report, NamesTheWorstAgainstItsBound) {
    EXPECT_EQ(small_report().worst().name, "550 nm");
    EXPECT_EQ(small_report().worst_channel(), 0U);
}

TEST(Report, NamesAChannelWhenItIsTheWorst) {
    ValidationReport report = small_report();
    report.channels[2].max_error = 7e-4;
    EXPECT_EQ(report.worst().name, "B");
    EXPECT_EQ(report.worst_channel(), 2U);
}

TEST(Report, NamesWhatIsNotFiniteBeforeAnyError) {
    ValidationReport report = small_report();
    report.channels[0].max_error = 1e6;
    report.wavelengths[0].not_finite = 3;
    EXPECT_EQ(report.worst().name, "454 nm");
}

// validation.json

TEST(ValidationJson, HoldsEveryNumberOfAComparison) {
    ValidationReport report = small_report();
    report.wavelengths[1].in_penumbrae = 300;
    report.wavelengths[1].max_error_of_penumbrae = 0.5;
    report.wavelengths[1].floor = 1e-7;
    report.wavelengths[1].under_floor = 4;
    report.channels[2].floor = 1e-9;
    report.channels[2].under_floor = 5;
    const Json json = json_of(report);
    ASSERT_EQ(json["wavelengths"].size(), 3U);
    ASSERT_EQ(json["channels"].size(), 3U);
    const Json& entry = json["wavelengths"][1];
    EXPECT_EQ(entry["lambda_nm"], 550.0);
    EXPECT_EQ(entry["name"], "550 nm");
    EXPECT_EQ(entry["holds"], true);
    EXPECT_EQ(entry["bound"], 6e-4);
    EXPECT_EQ(entry["max_error"], 4.8e-4);
    EXPECT_EQ(entry["column"], 7);
    EXPECT_EQ(entry["row"], 5);
    EXPECT_EQ(entry["percentile_999"], 0.9 * 4.8e-4);
    EXPECT_EQ(entry["rms_error"], 0.3 * 4.8e-4);
    EXPECT_EQ(entry["mean_error"], -0.01 * 4.8e-4);
    EXPECT_EQ(entry["compared"], 1190);
    EXPECT_EQ(entry["on_edges"], 10);
    EXPECT_EQ(entry["max_error_on_edges"], 0.25);
    EXPECT_EQ(entry["in_penumbrae"], 300);
    EXPECT_EQ(entry["max_error_of_penumbrae"], 0.5);
    EXPECT_EQ(entry["floor"], 1e-7);
    EXPECT_EQ(entry["under_floor"], 4);
    EXPECT_EQ(json["channels"][2]["floor"], 1e-9);
    EXPECT_EQ(json["channels"][2]["under_floor"], 5);
    EXPECT_EQ(entry["not_finite"], 0);
    EXPECT_EQ(json["channels"][0]["name"], "R");
    EXPECT_EQ(json["channels"][0]["max_error"], 5e-4);
}

TEST(ValidationJson, HoldsVerdictVersionsAndTimes) {
    const ValidationReport report = small_report();
    const Json json = json_of(report);
    EXPECT_EQ(json["holds"], true);
    EXPECT_EQ(json["worst"]["name"], "550 nm");
    EXPECT_EQ(json["worst"]["max_error"], 4.8e-4);
    EXPECT_EQ(json["worst"]["bound"], 6e-4);
    EXPECT_NEAR(json["worst"]["share_of_bound"], 0.8, 1e-15);
    EXPECT_EQ(json["rig"]["title"], "HabCam, 2 m above sand");
    EXPECT_EQ(json["rig"]["sha256"], report.rig.digest);
    EXPECT_EQ(json["image"]["width_px"], kReportWidth_px);
    EXPECT_EQ(json["versions"]["aphotic"], "1.2.3");
    EXPECT_EQ(json["versions"]["povray"], "3.7.0.10");
    EXPECT_EQ(json["frames"], 1);
    EXPECT_EQ(json["reference_wavelengths"], 398);
    EXPECT_EQ(json["jobs"], 2);
    EXPECT_EQ(json["time_s"]["render"], 12.25);
    EXPECT_EQ(json["time_s"]["integrate"], 0.5);
    EXPECT_EQ(json["time_s"]["trace"], 8.75);
}

TEST(ValidationJson, WritesNullForWhatIsNotFinite) {
    ValidationReport report = small_report();
    report.channels[0].max_error = kInfinity;
    report.channels[0].mean_error = kNaN;
    const Json json = json_of(report);
    EXPECT_EQ(json["holds"], false);
    EXPECT_EQ(json["worst"]["name"], "R");
    EXPECT_TRUE(json["worst"]["share_of_bound"].is_null());
    EXPECT_TRUE(json["channels"][0]["max_error"].is_null());
    EXPECT_TRUE(json["channels"][0]["mean_error"].is_null());
}

TEST(ValidationJson, ReadsBackAnyTitle) {
    ValidationReport report = small_report();
    report.rig.title = "\"quoted\" \\ <b>\n\x01 深海";
    EXPECT_EQ(json_of(report)["rig"]["title"], report.rig.title);
    report.rig.title = "not UTF-8: \xff";
    EXPECT_EQ(json_of(report)["rig"]["title"], "not UTF-8: �");
}

// report.html

TEST(ReportPage, HasEverySection) {
    const std::string page = page_of(small_report());
    for (const char* id : {"verdict",
                           "rig",
                           "images",
                           "error-map",
                           "profiles",
                           "profile-row",
                           "profile-column",
                           "numbers",
                           "made-with"})
        EXPECT_TRUE(contains(page, std::string("id=\"") + id + '"')) << id;
    const std::string words = words_of(page);
    for (const char* part : {"HabCam, 2 m above sand",
                             "pitch_deg  = 5.0",
                             "1.2° × 0.9°, or about 0.043 m × 0.032 m of a level floor",
                             "Relative error of channel R, the worst",
                             "Row 15",
                             "Column 20",
                             "1.2.3",
                             "3.7.0.10",
                             "12.25 s",
                             "0.50 s",
                             "8.75 s",
                             "398 wavelengths",
                             "1 frame for 3 wavelengths, 2 at once"})
        EXPECT_TRUE(contains(words, part)) << part;
}

TEST(ReportPage, SaysThatItHoldsAndHowClosely) {
    const std::string words = words_of(page_of(small_report()));
    EXPECT_TRUE(contains(words, "✓ Holds"));
    EXPECT_TRUE(contains(words, "all 6 comparisons"));
    EXPECT_TRUE(contains(words,
                         "Closest to its bound is 550 nm: its largest relative error is "
                         "4.80\xC2\xA0×\xC2\xA0"
                         "10⁻⁴, 0.800 times its bound of "
                         "6.00\xC2\xA0×\xC2\xA0"
                         "10⁻⁴, at column 7, row 5."))
        << words;
}

TEST(ReportPage, SaysThatItDoesNotHoldAndWhere) {
    ValidationReport report = small_report();
    report.channels[1].max_error = 0.5;
    report.wavelengths[0].max_error = 7e-4;
    const std::string words = words_of(page_of(report));
    EXPECT_TRUE(contains(words, "✗ Does not hold"));
    EXPECT_FALSE(contains(words, "✓ Holds"));
    EXPECT_TRUE(contains(words, "disagree in 2 of 6 comparisons"));
    EXPECT_TRUE(
        contains(words, "Worst is channel G: its largest relative error is 0.500, 714 times"))
        << words;
    report.wavelengths[2].not_finite = 12;
    EXPECT_TRUE(contains(words_of(page_of(report)), "Worst is 622 nm: 12 samples are not finite."));
}

// 40 x 30 pixels, by hand: 2 asin(sin(atan(40 * 6.45e-3 / 24)) / 1.343) = 0.92 degrees.
TEST(ReportPage, ShowsTheRigAsItWasReadAndItsFiles) {
    ValidationReport report = small_report();
    report.rig.toml = "title = \"a & b\"\n\n[sled]\n  altitude_m = 2 # <m>\n";
    report.rig.files = {{"lamp.csv", "12ab"}, {"sand.csv", "34cd"}, {"lamp.csv", "12ab"}};
    const std::string page = page_of(report);
    EXPECT_TRUE(contains(page,
                         "<pre>title = &quot;a &amp; b&quot;\n\n[sled]\n"
                         "  altitude_m = 2 # &lt;m&gt;\n</pre>"));
    EXPECT_TRUE(contains(words_of(page), "lamp.csvSHA-256 12ab\nsand.csvSHA-256 34cd\n\n"))
        << "each once";
    EXPECT_FALSE(contains(words_of(page), "in the water"));
    report.rig.camera.port = PortWindow{.glass = builtin_glass("bk7")};
    EXPECT_TRUE(contains(words_of(page_of(report)),
                         "1.2° × 0.9° in air, 0.9° × 0.7° in the water (at 560 nm), or about 0.032 "
                         "m × 0.024 m of a level floor"));
}

TEST(ReportPage, SaysWhichSceneTheReferenceDoesNotRead) {
    EXPECT_FALSE(contains(page_of(small_report()), "The reference does not read it"));
    ValidationReport report = small_report();
    report.scene_file = "my <reef>.pov";
    EXPECT_TRUE(contains(page_of(report),
                         "POV-Ray rendered \xE2\x81\xA8my &lt;reef&gt;.pov\xE2\x81\xA9, a scene"));
}

// 10 of 1200 pixels, and 300.
TEST(ReportPage, SaysHowManyPixelsHaveNoBoundAndHowFarTheyAreOff) {
    ValidationReport report = small_report();
    report.channels[1].in_penumbrae = 300;
    report.channels[1].max_error_of_penumbrae = 0.5;
    const std::string words = words_of(page_of(report));
    EXPECT_TRUE(contains(words,
                         "Up to 0.833 % of the pixels are on edges, which have no bound; the "
                         "largest relative error there is 0.250."))
        << words;
    EXPECT_TRUE(contains(words, "25.0 % are in the penumbrae of emitters")) << words;
    EXPECT_TRUE(contains(words, "differs by up to 0.500.")) << words;
    for (std::vector<Comparison>* comparisons : {&report.wavelengths, &report.channels}) {
        for (Comparison& one : *comparisons) one.on_edges = 0;
    }
    EXPECT_TRUE(contains(words_of(page_of(report)), "No pixel is on an edge."));
}

TEST(ReportPage, EscapesEveryNameOfTheRig) {
    ValidationReport report = small_report();
    const std::string evil = "</title></bdi><script>alert(\"1\" & '2')</script>\x01";
    report.rig.title = evil;
    report.rig.digest = evil;
    report.rig.toml = "# " + evil + "\n";
    report.rig.files = {{.name = evil, .sha256 = "1"}};
    report.scene_file = evil;
    report.aphotic_version = evil;
    report.povray_version = evil;
    for (Comparison& comparison : report.wavelengths) comparison.name = evil;
    for (Comparison& comparison : report.channels) comparison.name = evil;
    const std::string page = page_of(report);
    EXPECT_FALSE(contains(page, "<script"));
    EXPECT_FALSE(contains(page, "\x01"));
    EXPECT_FALSE(contains(page, "\"1\" &"));
    EXPECT_EQ(first_unbalanced(page), "");
    EXPECT_TRUE(contains(page,
                         "<h1>&lt;/title&gt;&lt;/bdi&gt;&lt;script&gt;alert(&quot;1&quot; "
                         "&amp; &#39;2&#39;)&lt;/script&gt;�</h1>"));
}

TEST(ReportPage, HoldsThreePicturesOfTheStatedSize) {
    const std::string page = page_of(small_report());
    const std::regex image(
        "<img class=\"[a-z ]+\" width=\"(\\d+)\" height=\"(\\d+)\" alt=\"[A-Za-z -]+\" "
        "src=\"data:image/png;base64,([A-Za-z0-9+/=]+)\"/>");
    std::vector<DecodedPng> pictures;
    for (auto it = std::sregex_iterator(page.begin(), page.end(), image);
         it != std::sregex_iterator();
         ++it) {
        pictures.push_back(decode_png(decode_base64((*it)[3].str())));
        EXPECT_EQ(pictures.back().width, kReportWidth_px);
        EXPECT_EQ(pictures.back().height, kReportHeight_px);
        EXPECT_EQ((*it)[1], std::to_string(kReportWidth_px));
        EXPECT_EQ((*it)[2], std::to_string(kReportHeight_px));
    }
    ASSERT_EQ(pictures.size(), 3U);
    EXPECT_EQ(pictures[2].pixels[report_sample(0, 3, 4)], 0xA3A19BU) << "grey on an edge";
    EXPECT_NE(pictures[2].pixels[report_sample(0, 4, 4)], 0xA3A19BU);
}

// An image twice as bright must look brighter: each picture has no exposure of its own.
TEST(ReportPage, ShowsBothImagesUnderOneExposure) {
    ValidationReport report = small_report();
    for (float& sample : report.rendered.samples) sample *= 0.25F;
    const std::string page = page_of(report);
    const std::regex source("base64,([A-Za-z0-9+/=]+)\"");
    auto it = std::sregex_iterator(page.begin(), page.end(), source);
    const DecodedPng rendered = decode_png(decode_base64((*it++)[1].str()));
    const DecodedPng traced = decode_png(decode_base64((*it)[1].str()));
    const std::size_t middle = report_sample(0, kReportWidth_px / 2, kReportHeight_px / 2);
    EXPECT_LT(rendered.pixels[middle] & 0xFFU, traced.pixels[middle] & 0xFFU);
}

// The largest picture that is shown pixel by pixel, over errors of pure noise, which cannot be
// compressed: the page can still be mailed.
TEST(ReportPage, OfALargeImageStaysSmall) {
    constexpr int kSide = kLargestPicture_px;
    constexpr std::size_t kMostBytes = 3'000'000;
    ValidationReport report = small_report();
    for (auto* image : {&report.rendered, &report.traced})
        *image = {.width_px = kSide, .height_px = kSide, .samples = {}};
    report.channel_errors.clear();
    std::uint32_t state = 1;
    for (int i = 0; i < kSide * kSide * kChannels; ++i) {
        const int from_middle =
            std::abs(i % kSide - kSide / 2) + std::abs(i / kSide % kSide - kSide / 2);
        const float signal = 1.0F / (1.0F + 1e-3F * static_cast<float>(from_middle));
        report.rendered.samples.push_back(signal);
        report.traced.samples.push_back(signal);
        state = state * 1664525U + 1013904223U;
        report.channel_errors.push_back(static_cast<float>(state >> 8U) * 0x1p-34F - 0x1p-11F);
    }
    EXPECT_LT(page_of(report).size(), kMostBytes);
}

// The profile.

double number_after(const std::string& text, std::string_view key, std::size_t from) {
    return std::stod(text.substr(text.find(key, from) + key.size()));
}

std::string drawing(const std::string& page, const std::string& id) {
    const std::size_t from = page.find("id=\"" + id + '"');
    return page.substr(from, page.find("</svg>", from) - from);
}

// Where the first label of that text stands.
std::pair<double, double> label_px(const std::string& svg,
                                   const std::string& anchor,
                                   const std::string& text) {
    const std::string end = "text-anchor=\"" + anchor + "\" class=\"tick\">" + text + "</text>";
    const std::size_t from = svg.rfind("<text", svg.find(end));
    return {number_after(svg, "x=\"", from), number_after(svg, "y=\"", from)};
}

std::vector<std::pair<double, double>> path_points(const std::string& svg, const std::string& id) {
    const std::size_t from = svg.find(" d=\"", svg.find("id=\"" + id + '"')) + 4;
    const std::string path = svg.substr(from, svg.find('"', from) - from);
    const std::regex point("[ML]([-0-9.]+) ([-0-9.]+)");
    std::vector<std::pair<double, double>> points;
    for (auto it = std::sregex_iterator(path.begin(), path.end(), point);
         it != std::sregex_iterator();
         ++it)
        points.emplace_back(std::stod((*it)[1]), std::stod((*it)[2]));
    return points;
}

constexpr double kDecimals = 0.11;  // coordinates are written to a tenth of a unit

// The tick labels say where a sample must be drawn: R is column / 40 along every row.
TEST(ReportProfile, OfARowIsDrawnWhereItsAxesSay) {
    const std::string svg = drawing(page_of(small_report()), "profile-row");
    const double x0 = label_px(svg, "middle", "0").first;
    const double x40 = label_px(svg, "middle", "40").first;
    const double y0 = label_px(svg, "end", "0").second;
    const double y_half = label_px(svg, "end", "0.5").second;
    const double label_below_line = 4.0;  // so that it is centred on the line
    const auto points = path_points(svg, "row-R-reference");
    ASSERT_EQ(points.size(), static_cast<std::size_t>(kReportWidth_px));
    for (int column = 0; column < kReportWidth_px; ++column) {
        const double signal = static_cast<double>(column) / kReportWidth_px;
        const auto [x, y] = points[static_cast<std::size_t>(column)];
        EXPECT_NEAR(x, x0 + (x40 - x0) * (column + 0.5) / 40.0, kDecimals) << column;
        EXPECT_NEAR(y, y0 - label_below_line + (y_half - y0) * signal / 0.5, 2.0 * kDecimals)
            << column;
    }
}

// R does not change along a column; G does, and is row / 30.
TEST(ReportProfile, OfAColumnGoesDownTheImage) {
    const std::string svg = drawing(page_of(small_report()), "profile-column");
    const auto red = path_points(svg, "column-R-rendered");
    const auto green = path_points(svg, "column-G-rendered");
    ASSERT_EQ(red.size(), static_cast<std::size_t>(kReportHeight_px));
    ASSERT_EQ(green.size(), static_cast<std::size_t>(kReportHeight_px));
    EXPECT_EQ(red.front().second, red.back().second);
    EXPECT_GT(green.front().second, green.back().second) << "larger is higher up";
    const double step = (green.back().second - green.front().second) / (kReportHeight_px - 1);
    for (std::size_t row = 0; row < green.size(); ++row)
        EXPECT_NEAR(green[row].second,
                    green.front().second + step * static_cast<double>(row),
                    2.0 * kDecimals);
}

// Edges have no error: the dots leave them out, the curves do not.
TEST(ReportProfile, LeavesEdgesOutOfTheErrors) {
    ValidationReport report = small_report();
    report.channel_errors[report_sample(1, 11, kReportHeight_px / 2)] =
        std::numeric_limits<float>::quiet_NaN();
    const std::string svg = drawing(page_of(report), "profile-row");
    EXPECT_EQ(path_points(svg, "row-R-dots").size(), static_cast<std::size_t>(kReportWidth_px));
    EXPECT_EQ(path_points(svg, "row-G-dots").size(), static_cast<std::size_t>(kReportWidth_px - 1));
    EXPECT_EQ(path_points(svg, "row-G-reference").size(),
              static_cast<std::size_t>(kReportWidth_px));
}

// Extremes that a sabotaged render may bring.

TEST(ReportPage, IsWrittenForEqualImages) {
    ValidationReport report = small_report();
    report.rendered = report.traced;
    std::ranges::fill(report.channel_errors, 0.0F);
    for (auto* list : {&report.wavelengths, &report.channels}) {
        for (Comparison& comparison : *list) comparison = comparison_of(comparison.name, 0.0, 6e-4);
    }
    const std::string page = page_of(report);
    EXPECT_FALSE(contains(page, "nan"));
    EXPECT_EQ(first_unbalanced(page), "");
}

TEST(ReportPage, IsWrittenForABlackImageAndForOneThatIsNotFinite) {
    ValidationReport report = small_report();
    std::ranges::fill(report.rendered.samples, 0.0F);
    std::ranges::fill(report.traced.samples, 0.0F);
    std::ranges::fill(report.channel_errors, -1.0F);
    EXPECT_EQ(first_unbalanced(page_of(report)), "");
    std::ranges::fill(report.rendered.samples, std::numeric_limits<float>::quiet_NaN());
    std::ranges::fill(report.traced.samples, std::numeric_limits<float>::infinity());
    std::ranges::fill(report.channel_errors, std::numeric_limits<float>::quiet_NaN());
    for (Comparison& channel : report.channels) {
        channel.not_finite = 1200;
        channel.max_error = 0.0;
        channel.rms_error = kInfinity;
    }
    const std::string page = page_of(report);
    EXPECT_EQ(first_unbalanced(page), "");
    EXPECT_TRUE(contains(words_of(page),
                         "1\xE2\x80\xAF"
                         "200 samples are not finite"));
}

// Both files.

TEST(Report, IsReproducible) {
    EXPECT_EQ(page_of(small_report()), page_of(small_report()));
    EXPECT_EQ(json_of(small_report()), json_of(small_report()));
}

TEST(Report, ThatCannotBeWrittenIsARunErrorThatNamesTheFile) {
    const TempFolder folder;
    for (const auto write : {write_validation_json, write_validation_html}) {
        const fs::path file = folder.path() / "missing" / "report";
        const std::string said = run_error_of([&] { write(small_report(), file); });
        EXPECT_TRUE(said.starts_with(file.string())) << said;
    }
}

}  // namespace
}  // namespace aphotic::report_test
