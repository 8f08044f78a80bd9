// SPDX-License-Identifier: BSD-3-Clause
//
// Tags that one program wrote, carried by ours, read by that program again.
#include "image/image_tags.h"

#include "base/error.h"
#include "image/any_image.h"
#include "support/dng.h"
#include "support/exiftool.h"
#include "support/tiff.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace aphotic::image_tags_test {
namespace {

constexpr int kWidth = 16;
constexpr int kHeight = 12;
// A second of arc's ten thousandth: what exiftool writes of a position.
constexpr double kArc_deg = 1e-6;

void write_grey(const std::filesystem::path& file, const SharedTags& tags) {
    const std::vector<float> plane(kWidth * kHeight, 0.25F);
    write_any_image(file,
                    {.width_px = kWidth,
                     .height_px = kHeight,
                     .channels = {"Y"},
                     .planes = plane,
                     .type = SampleType::Bits8,
                     .tags = tags});
}

// What photogrammetry and Marimba read, and what only the source's own pixels make true.
void tag(const std::filesystem::path& file) {
    tag_by_exiftool(file,
                    {"-GPSLatitude=41.5123456",
                     "-GPSLatitudeRef=N",
                     "-GPSLongitude=70.5",
                     "-GPSLongitudeRef=W",
                     "-GPSAltitude=55.5",
                     "-GPSAltitudeRef#=1",
                     "-GPSDateStamp=2012:07:01",
                     "-DateTimeOriginal=2012:07:01 12:13:14",
                     "-SubSecTimeOriginal=678",
                     "-OffsetTimeOriginal=+00:00",
                     "-FocalLength=16.5",
                     "-SerialNumber=AB123",
                     "-ImageUniqueID=0123456789abcdef0123456789abcdef",
                     "-ExposureTime=1/250",
                     "-ISO=400",
                     "-FNumber=5.6",
                     "-Make=Acme",
                     "-Model=Deep 1",
                     "-Orientation#=1",
                     "-UserComment={\"a\":1}",
                     "-ExifIFD:ColorSpace#=1",
                     "-ExifImageWidth=4000",
                     "-XMP-dc:Creator=Jane Doe",
                     "-XMP-dc:Rights=CC BY",
                     "-XMP-dc:Identifier=id7",
                     "-IPTC:Keywords=sand"});
}

void expect_tags(const nlohmann::json& found, const std::string& of) {
    const std::map<std::string, nlohmann::json> words{
        {"GPS:GPSLatitudeRef", "N"},
        {"GPS:GPSLongitudeRef", "W"},
        {"GPS:GPSAltitudeRef", 1},
        {"GPS:GPSDateStamp", "2012:07:01"},
        {"ExifIFD:DateTimeOriginal", "2012:07:01 12:13:14"},
        {"ExifIFD:OffsetTimeOriginal", "+00:00"},
        {"ExifIFD:SubSecTimeOriginal", 678},
        {"ExifIFD:SerialNumber", "AB123"},
        {"ExifIFD:ImageUniqueID", "0123456789abcdef0123456789abcdef"},
        {"ExifIFD:FocalLength", 16.5},
        {"ExifIFD:ExposureTime", 0.004},
        {"ExifIFD:ISO", 400},
        {"ExifIFD:FNumber", 5.6},
        {"ExifIFD:UserComment", "{\"a\":1}"},
        {"IFD0:Make", "Acme"},
        {"IFD0:Model", "Deep 1"},
        {"IFD0:Orientation", 1},
        {"XMP-dc:Creator", "Jane Doe"},
        {"XMP-dc:Rights", "CC BY"},
        {"XMP-dc:Identifier", "id7"},
        {"IPTC:Keywords", "sand"}};
    for (const auto& [name, value] : words) {
        ASSERT_TRUE(found.contains(name)) << of << ": " << name << "\n" << found.dump(1);
        EXPECT_EQ(found.at(name), value) << of << ": " << name;
    }
    EXPECT_NEAR(found.at("GPS:GPSLatitude").get<double>(), 41.5123456, kArc_deg) << of;
    EXPECT_NEAR(found.at("GPS:GPSLongitude").get<double>(), 70.5, kArc_deg) << of;
    EXPECT_EQ(found.at("GPS:GPSAltitude"), 55.5) << of;
    EXPECT_FALSE(found.contains("ExifIFD:ExifImageWidth")) << of << ": another image's size";
    EXPECT_FALSE(found.contains("ExifIFD:ColorSpace")) << of << ": another image's colours";
}

TEST(ImageTags, GoFromEveryFormatToEveryFormatAsExiftoolFindsThem) {
    if (!has_exiftool()) GTEST_SKIP() << "needs exiftool";
    const TempFolder folder;
    for (const char* from : {"from.tif", "from.png", "from.jpg"}) {
        write_grey(folder.path() / from, nullptr);
        tag(folder.path() / from);
        const SharedTags tags = read_image_tags(folder.path() / from);
        ASSERT_TRUE(tags) << from;
        for (const char* to : {"to.tif", "to.png", "to.jpg"}) {
            write_grey(folder.path() / to, tags);
            expect_tags(tags_by_exiftool(folder.path() / to), std::string(from) + " " + to);
            const AnyImage image = open_any_image(folder.path() / to);
            const std::vector<float> samples = image.planes();
            constexpr float kStep = 1.0F / 255.0F;
            EXPECT_TRUE(
                std::ranges::all_of(samples, [&](float s) { return std::abs(s - 0.25F) <= kStep; }))
                << from << " " << to;
        }
        const ShotExposure exposure = exposure_of(*tags);
        EXPECT_DOUBLE_EQ(exposure.time_s.value(), 0.004) << from;
        EXPECT_DOUBLE_EQ(exposure.iso.value(), 400.0) << from;
        EXPECT_DOUBLE_EQ(exposure.f_number.value(), 5.6) << from;
    }
}

TEST(ImageTags, AsWordsForFormatsOfNoTags) {
    if (!has_exiftool()) GTEST_SKIP() << "needs exiftool";
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "a.tif";
    write_grey(file, nullptr);
    tag(file);
    std::map<std::string, std::string> words;
    for (const auto& [name, value] : words_of(*read_image_tags(file))) words[name] = value;
    EXPECT_EQ(words["Exif.Photo.SubSecTimeOriginal"], "678");
    EXPECT_EQ(words["Exif.GPSInfo.GPSLongitude"], "70/1 30/1 0/1");
    EXPECT_EQ(words["Xmp.dc.creator"], "Jane Doe");
}

TEST(ImageTags, OfAnExposureAsExiftoolFindsThem) {
    if (!has_exiftool()) GTEST_SKIP() << "needs exiftool";
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "a.tif";
    write_grey(file, tags_of({.time_s = 0.0025, .iso = 400.0, .f_number = 5.6}));
    const nlohmann::json found = tags_by_exiftool(file);
    EXPECT_EQ(found.at("ExifIFD:ExposureTime"), 0.0025);
    EXPECT_EQ(found.at("ExifIFD:ISO"), 400);
    EXPECT_EQ(found.at("ExifIFD:FNumber"), 5.6);
}

// The ends of what a rig may tell.
TEST(ImageTags, OfAnExposureComeBack) {
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "a.tif";
    for (const ShotExposure& shot : {ShotExposure{.time_s = 1e-7, .iso = 1.0, .f_number = 0.1},
                                     ShotExposure{.time_s = 1000.0, .iso = 1e7, .f_number = 1000.0},
                                     ShotExposure{.f_number = 2.8}}) {
        write_grey(file, tags_of(shot));
        const ShotExposure found = exposure_of(*read_image_tags(file));
        EXPECT_EQ(found.time_s, shot.time_s);
        EXPECT_EQ(found.iso, shot.iso);
        EXPECT_EQ(found.f_number, shot.f_number);
    }
    EXPECT_EQ(tags_of({}), nullptr);
}

TEST(ImageTags, TheSameTagsAreTheSameBytes) {
    if (!has_exiftool()) GTEST_SKIP() << "needs exiftool";
    const TempFolder folder;
    for (const char* name : {"a.tif", "a.png", "a.jpg"}) {
        const std::filesystem::path file = folder.path() / name;
        write_grey(file, nullptr);
        tag(file);
        const SharedTags tags = read_image_tags(file);
        write_grey(folder.path() / ("1" + std::string(name)), tags);
        write_grey(folder.path() / ("2" + std::string(name)), tags);
        EXPECT_EQ(read_text_file(folder.path() / ("1" + std::string(name))),
                  read_text_file(folder.path() / ("2" + std::string(name))))
            << name;
    }
}

TEST(ImageTags, ThereAreNoneWhereThereAreNoneOrNoneCanBeRead) {
    const TempFolder folder;
    const auto none_in = [&](const std::string& name, const std::string& bytes) {
        write_file(folder.path() / name, bytes);
        EXPECT_EQ(read_image_tags(folder.path() / name), nullptr) << name;
    };
    none_in("words.tif", "this is no image");
    none_in("empty.jpg", "");
    none_in("described.tif", tiff_of({1, 2, 3, 4}, 2, 2, "its words go another way"));
    none_in("cut.tif", tiff_of({1, 2, 3, 4}, 2, 2, "", true).substr(0, 40));
    EXPECT_EQ(read_image_tags(folder.path() / "none.png"), nullptr);
}

TEST(ImageTags, WhatIsNoImageTakesNone) {
    const TempFolder folder;
    write_file(folder.path() / "a.dng",
               dng_of({.width = 2, .height = 2, .samples = {1, 2, 3, 4}, .exposure_ms = 4}));
    const SharedTags tags = read_image_tags(folder.path() / "a.dng");
    ASSERT_TRUE(tags);
    EXPECT_EQ(exposure_of(*tags).time_s, 0.004);
    EXPECT_EQ(exposure_of(*tags).iso, std::nullopt);
    std::vector<unsigned char> none(100, ' ');
    EXPECT_THROW(add_image_tags("b.tif", none, tags), RunError);
}

}  // namespace
}  // namespace aphotic::image_tags_test
