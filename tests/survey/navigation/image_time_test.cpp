// SPDX-License-Identifier: BSD-3-Clause
//
// When images were taken, from their names and from EXIF that exiftool wrote; against GNU date.
#include "survey/navigation/image_time.h"

#include "base/error.h"
#include "image/any_image.h"
#include "support/refusal.h"
#include "support/temp_folder.h"
#include "survey/navigation/navigation_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::image_time_test {
namespace {

constexpr double kDouble_s = 5e-7;          // the step of a double around 1.7e9 is 2.4e-7
constexpr double kTime_s = 1709987696.789;  // date -u -d "2024-03-09 12:34:56.789" +%s.%N

TEST(ImageTime, AMaskReadsAName) {
    const auto time = [](const std::string& name, const std::string& mask) {
        const auto found = time_by_mask(name, mask);
        return found ? *found : 0.0;
    };
    EXPECT_NEAR(time("PR_20240309_123456_789_LC16", "xxxYYYYMMDDxhhmmssxfff"), kTime_s, kDouble_s);
    EXPECT_NEAR(
        time("cam2024-03-09T12h34m56.789", "xxxYYYYxMMxDDxhhxmmxssxfff"), kTime_s, kDouble_s);
    EXPECT_NEAR(time("123456.20240309", "hhmmssxYYYYMMDD"), 1709987696.0, kDouble_s);
    EXPECT_NEAR(time("20240309123456789250", "YYYYMMDDhhmmssfffuuu"), kTime_s + 250e-6, kDouble_s);
    for (const char* name : {"",
                             "20240309",
                             "20240309_12345x",
                             "20241309_123456",
                             "20240309_253456",
                             "2O240309_123456"})
        EXPECT_FALSE(time_by_mask(name, "YYYYMMDDxhhmmss").has_value()) << name;
}

TEST(ImageTime, AMaskHasEachPartOnce) {
    for (const char* mask : {"YYYYMMDDhhmmss", "xYYYYxMMxDDxhhmmssxfff", "hhmmssYYYYMMDDfffuuu"})
        EXPECT_EQ(refusal_of([&] { require_time_mask(mask); }), "nothing was said") << mask;
    const std::string allowed =
        "; allowed: YYYY, MM, DD, hh, mm, ss once each, fff for milliseconds, uuu for microseconds "
        "after it, x for any other character";
    const std::vector<std::pair<std::string, std::string>> wrong{
        {"", "which has no YYYY"},
        {"YYMMDDhhmmss", "in which YYYY is split"},
        {"YYYYMMDDhhmm", "which has no ss"},
        {"YYYYMMDDhhmmssxmm", "in which mm is split"},
        {"YYxYYMMDDhhmmss", "in which YYYY is split"},
        {"YYYYMMDDhhmmssf", "in which fff is split"},
        {"YYYYMMDDhhmmssuuu", "which has uuu without fff"}};
    for (const auto& one : wrong) {
        EXPECT_EQ(refusal_of([&] { require_time_mask(one.first); }),
                  "found '" + one.first + "', " + one.second + allowed);
    }
}

// date -u -d "2012-06-23 17:15:52.346" +%s.%N
TEST(ImageTime, HabCamsNamesHaveTheirTime) {
    for (const char* name : {"20120623.171552346.1219.tif", "UNQ.20120623.171552346.1219"}) {
        const auto time_s = time_in_habcam_name(name);
        ASSERT_TRUE(time_s.has_value()) << name;
        EXPECT_NEAR(*time_s, 1340471752.346, kDouble_s) << name;
    }
    for (const char* name :
         {"201207.0001.tif", "20121323.171552346.1.tif", "120120623.171552346.1"})
        EXPECT_FALSE(time_in_habcam_name(name).has_value()) << name;
}

TEST(ImageTime, ExifHasPartsOfASecondAndAZone) {
    using Tags = std::map<std::string, std::string>;
    Tags tags{{"Exif:DateTimeOriginal", "2024:03:09 12:34:56"}};
    EXPECT_NEAR(time_in_exif(tags).value_or(0.0), 1709987696.0, kDouble_s);
    tags["Exif:SubsecTimeOriginal"] = "789 ";
    EXPECT_NEAR(time_in_exif(tags).value_or(0.0), kTime_s, kDouble_s);
    // That of the file's last change.
    tags["Exif:OffsetTime"] = "+02:00";
    EXPECT_NEAR(time_in_exif(tags).value_or(0.0), kTime_s, kDouble_s);
    for (const char* blank : {"", "      ", "   :  "}) {
        tags["Exif:OffsetTimeOriginal"] = blank;
        EXPECT_NEAR(time_in_exif(tags).value_or(0.0), kTime_s, kDouble_s) << blank;
    }
    tags["Exif:OffsetTimeOriginal"] = "-01:00";
    EXPECT_NEAR(time_in_exif(tags).value_or(0.0), kTime_s + 3600.0, kDouble_s);
    tags["Exif:SubsecTimeOriginal"] = "05";
    EXPECT_NEAR(time_in_exif(tags).value_or(0.0), kTime_s + 3600.0 - 0.739, kDouble_s);
    tags["Exif:OffsetTimeOriginal"] = "CEST";
    EXPECT_EQ(refusal_of([&] { return time_in_exif(tags); }),
              "OffsetTimeOriginal: found 'CEST'; allowed: Z, or hours and minutes such as +02:00");
    EXPECT_FALSE(time_in_exif({}).has_value());
    EXPECT_FALSE(time_in_exif({{"Exif:DateTimeOriginal", "    :  :     :  :  "}}).has_value());
    EXPECT_FALSE(time_in_exif({{"Exif:DateTimeOriginal", "1709987696"}}).has_value());
}

// A grey TIFF of one pixel whose Exif has these texts, by tag (TIFF 6.0, Exif 2.31).
std::string tiff_with_exif(const std::map<std::uint16_t, std::string>& texts) {
    std::string bytes("II*\0\x08\0\0\0", 8);
    const auto add = [&](std::uint64_t number, unsigned length) {
        for (unsigned i = 0; i < length; ++i)
            bytes += static_cast<char>((number >> (8U * i)) & 0xFFU);
    };
    const auto entry =
        [&](std::uint16_t tag, std::uint16_t type, std::size_t count, std::size_t value) {
            add(tag, 2);
            add(type, 2);
            add(count, 4);
            add(value, 4);
        };
    const std::array<std::array<std::uint16_t, 2>, 7> shorts{
        {{256, 1}, {257, 1}, {258, 8}, {259, 1}, {262, 1}, {277, 1}, {278, 1}}};
    constexpr std::size_t kEntries = 10;
    constexpr std::size_t kExif = 8 + 2 + 12 * kEntries + 4;
    std::size_t place = kExif + 2 + 12 * texts.size() + 4;  // of the pixel, then of the texts
    add(kEntries, 2);
    for (const auto& [tag, value] : shorts) {
        if (tag == 277) entry(273, 4, 1, place);  // StripOffsets
        entry(tag, 3, 1, value);
    }
    entry(279, 4, 1, 1);        // StripByteCounts
    entry(34665, 4, 1, kExif);  // Exif
    add(0, 4);
    add(texts.size(), 2);
    ++place;
    for (const auto& [tag, text] : texts) {
        if (text.size() < 4) {
            add(tag, 2);
            add(2, 2);
            add(text.size() + 1, 4);
            bytes += text + std::string(4 - text.size(), '\0');
            continue;
        }
        entry(tag, 2, text.size() + 1, place);
        place += text.size() + 1;
    }
    add(0, 4);
    bytes += '\x80';
    for (const auto& [tag, text] : texts) {
        if (text.size() >= 4) bytes += text + '\0';
    }
    return bytes;
}

class TimeOfFiles : public testing::Test {
  protected:
    [[nodiscard]] std::filesystem::path image(const std::string& name) const {
        const std::filesystem::path file = folder_.path() / name;
        const std::vector<float> plane(48, 0.5F);
        write_any_image(file, {.width_px = 8, .height_px = 6, .channels = {"Y"}, .planes = plane});
        return file;
    }

    TempFolder folder_;
};

TEST_F(TimeOfFiles, ExiftoolsTimeIsRead) {
    if (std::system("exiftool -ver > /dev/null 2>&1") != 0) GTEST_SKIP() << "no exiftool here";
    for (const char* name : {"a.tif", "a.jpg", "a.png"}) {
        const std::filesystem::path file = image(name);
        const std::string command =
            "exiftool -q -overwrite_original -DateTimeOriginal='2024:03:09 12:34:56' "
            "-SubSecTimeOriginal=789 -OffsetTimeOriginal=+02:00 -ImageDescription='lat=41.5' '" +
            file.string() + "'";
        ASSERT_EQ(std::system(command.c_str()), 0);
        EXPECT_NEAR(image_time(file, "").time_s, kTime_s - 7200.0, kDouble_s) << name;
        EXPECT_EQ(header_of_image(file)["ImageDescription"], "lat=41.5") << name;
    }
}

constexpr std::uint16_t kDateTimeOriginal = 0x9003;
constexpr std::uint16_t kOffsetTime = 0x9010;
constexpr std::uint16_t kOffsetTimeOriginal = 0x9011;
constexpr std::uint16_t kSubSecTimeOriginal = 0x9291;

TEST_F(TimeOfFiles, AZoneOfTheFileAloneIsSaid) {
    const std::filesystem::path file = folder_.path() / "a.tif";
    const auto time = [&](std::map<std::uint16_t, std::string> texts) {
        texts[kDateTimeOriginal] = "2024:03:09 12:34:56";
        write_file(file, tiff_with_exif(texts));
        return image_time(file, "");
    };
    const double whole_s = kTime_s - 0.789;
    const ImageTime of_file = time({{kOffsetTime, "+02:00"}, {kOffsetTimeOriginal, "   :  "}});
    EXPECT_NEAR(of_file.time_s, whole_s, kDouble_s);
    EXPECT_TRUE(of_file.lacks_zone);
    const ImageTime of_shot = time({{kOffsetTime, "+01:00"}, {kOffsetTimeOriginal, "+02:00"}});
    EXPECT_NEAR(of_shot.time_s, whole_s - 7200.0, kDouble_s);
    EXPECT_FALSE(of_shot.lacks_zone);
    const ImageTime of_none = time({{kSubSecTimeOriginal, "05"}});
    EXPECT_NEAR(of_none.time_s, whole_s + 0.05, kDouble_s);
    EXPECT_FALSE(of_none.lacks_zone);
    // Of a track, the survey is told.
    write_file(
        file,
        tiff_with_exif({{kDateTimeOriginal, "2024:03:09 12:34:56"}, {kOffsetTime, "+02:00"}}));
    const Navigation track =
        parse_navigation("time,altitude_m\n2024-03-09 12:34:56,2\n2024-03-09 12:34:57,3\n",
                         {.source = "nav"},
                         {{.source = file, .name = "a.tif"}},
                         nullptr);
    EXPECT_EQ(track.pose_of(file).sled.altitude_m, 2.0);
    ASSERT_EQ(track.warnings().size(), 1U);
    EXPECT_TRUE(track.warnings().front().starts_with("nav: the times of 1 image are taken as UTC"))
        << track.warnings().front();
}

TEST_F(TimeOfFiles, ANameCountsWhereThereIsNoExif) {
    EXPECT_NEAR(
        image_time(image("20120623.171552346.1219.png"), "").time_s, 1340471752.346, kDouble_s);
    const std::filesystem::path file = image("c_20240309_123456.png");
    EXPECT_NEAR(image_time(file, "xxYYYYMMDDxhhmmss").time_s, 1709987696.0, kDouble_s);
    EXPECT_EQ(refusal_of([&] { return image_time(file, "YYYYMMDDxhhmmss"); }),
              "its name has no time where --image-time YYYYMMDDxhhmmss expects it");
    EXPECT_EQ(refusal_of([&] { return image_time(file, ""); }),
              "it has no time: no DateTimeOriginal in its EXIF, and its name is not HabCam's; "
              "--image-time gives the time's place in its name");
    EXPECT_EQ(refusal_of([&] { return image_time(folder_.path() / "none.png", ""); }),
              "the file no longer exists");
}

}  // namespace
}  // namespace aphotic::image_time_test
