// SPDX-License-Identifier: BSD-3-Clause
//
// When images were taken, from their names and from EXIF that exiftool wrote; against GNU date.
#include "survey/image_time.h"

#include "base/error.h"
#include "image/any_image.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::image_time_test {
namespace {

constexpr double kDouble_s = 5e-7;          // the step of a double around 1.7e9 is 2.4e-7
constexpr double kTime_s = 1709987696.789;  // date -u -d "2024-03-09 12:34:56.789" +%s.%N

template <typename Function>
std::string fault_of(Function function) {
    try {
        function();
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing was said";
}

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
        EXPECT_EQ(fault_of([&] { require_time_mask(mask); }), "nothing was said") << mask;
    const std::string allowed =
        "; allowed: YYYY, MM, DD, hh, mm, ss once each, fff for milliseconds, uuu for microseconds "
        "after it, x for any other character";
    const std::vector<std::pair<std::string, std::string>> wrong{
        {"", "which has no YYYY"},
        {"YYMMDDhhmmss", "which has not YYYY in one place"},
        {"YYYYMMDDhhmm", "which has no ss"},
        {"YYYYMMDDhhmmssxmm", "which has not mm in one place"},
        {"YYxYYMMDDhhmmss", "which has not YYYY in one place"},
        {"YYYYMMDDhhmmssf", "which has not fff in one place"},
        {"YYYYMMDDhhmmssuuu", "which has uuu without fff"}};
    for (const auto& one : wrong) {
        EXPECT_EQ(fault_of([&] { require_time_mask(one.first); }),
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
    tags["Exif:OffsetTime"] = "+02:00";
    EXPECT_NEAR(time_in_exif(tags).value_or(0.0), kTime_s - 7200.0, kDouble_s);
    tags["Exif:OffsetTimeOriginal"] = "-01:00";
    EXPECT_NEAR(time_in_exif(tags).value_or(0.0), kTime_s + 3600.0, kDouble_s);
    EXPECT_FALSE(time_in_exif({}).has_value());
    EXPECT_FALSE(time_in_exif({{"Exif:DateTimeOriginal", "    :  :     :  :  "}}).has_value());
    EXPECT_FALSE(time_in_exif({{"Exif:DateTimeOriginal", "1709987696"}}).has_value());
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
        EXPECT_NEAR(image_time_s(file, ""), kTime_s - 7200.0, kDouble_s) << name;
        EXPECT_EQ(header_of_image(file)["ImageDescription"], "lat=41.5") << name;
    }
}

TEST_F(TimeOfFiles, ANameCountsWhereThereIsNoExif) {
    EXPECT_NEAR(image_time_s(image("20120623.171552346.1219.png"), ""), 1340471752.346, kDouble_s);
    const std::filesystem::path file = image("c_20240309_123456.png");
    EXPECT_NEAR(image_time_s(file, "xxYYYYMMDDxhhmmss"), 1709987696.0, kDouble_s);
    EXPECT_EQ(fault_of([&] { static_cast<void>(image_time_s(file, "YYYYMMDDxhhmmss")); }),
              "its name has no time where --image-time YYYYMMDDxhhmmss has it");
    EXPECT_EQ(fault_of([&] { static_cast<void>(image_time_s(file, "")); }),
              "it tells no time: no DateTimeOriginal in its EXIF, and its name is not HabCam's; "
              "--image-time says where its name has the time");
    EXPECT_EQ(fault_of([&] { static_cast<void>(image_time_s(folder_.path() / "none.png", "")); }),
              "there is no such file any more");
}

}  // namespace
}  // namespace aphotic::image_time_test
