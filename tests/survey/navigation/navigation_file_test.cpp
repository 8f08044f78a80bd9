// SPDX-License-Identifier: BSD-3-Clause
//
// Navigation in the forms that surveys have it in. The lines are as the formats' own writers make
// them (their sources are named in navigation_columns.h); the poses follow from them by hand.
#include "survey/navigation/navigation_file.h"

#include "base/error.h"
#include "image/any_image.h"
#include "support/has.h"
#include "support/refusal.h"
#include "support/scene_rig.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>

namespace aphotic::navigation_file_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kRounding = 1e-12;

// HabCam's own rig is pitched by 5 degrees.
const Sled kRigSled = habcam().sled;

Navigation parsed(std::string_view text,
                  NavigationOptions options = {},
                  const std::vector<ImageFile>& files = {}) {
    const Rig rig = habcam();
    options.source = "nav";
    return parse_navigation(text, options, files, &rig);
}

std::string refusal(std::string_view text, const NavigationOptions& options = {}) {
    return refusal_of([&] { return parsed(text, options); });
}

void expect_sled(const Sled& found, double altitude_m, double pitch_deg, double roll_deg) {
    EXPECT_NEAR(found.altitude_m, altitude_m, kRounding);
    EXPECT_NEAR(found.pitch_rad, pitch_deg * kDegree, kRounding);
    EXPECT_NEAR(found.roll_rad, roll_deg * kDegree, kRounding);
}

std::string fault_of_image(const Navigation& navigation, const std::string& image) {
    return refusal_of([&] { return navigation.pose_of(image); });
}

constexpr std::string_view kOplab =
    "relative_path,northing [m],easting [m],depth [m],roll [deg],pitch [deg],heading "
    "[deg],altitude "
    "[m],timestamp [s],latitude [deg],longitude [deg],x_velocity [m/s],y_velocity [m/s],z_velocity "
    "[m/s],vehicle_std_x [m],vehicle_std_y [m],vehicle_std_z [m]\n"
    "image/LC/20240309_123456_789.tif,10.1,-3.2,61.2,-0.3,4.8,181.2,2.05,1709987696.789,40.61,"
    "-67.12,0.5,0,0,0.1,0.1,0.1\n"
    "image/LC/20240309_123457_789.tif,10.6,-3.2,61.2,-0.2,4.7,181.2,None,1709987697.789,40.61,"
    "-67.12,0.5,0,0,0.1,0.1,0.1\n";

TEST(NavigationFile, OplabsCsv) {
    const Navigation nav = parsed(kOplab);
    expect_sled(nav.pose_of("20240309_123456_789.tif").sled, 2.05, 4.8, -0.3);
    EXPECT_EQ(fault_of_image(nav, "20240309_123457_789.tif"),
              "nav:3: altitude_m: found no number; allowed: 0.001 to 10000");
    EXPECT_EQ(words_of(*nav.notes()),
              "oplab's CSV: image 'relative_path', altitude_m 'altitude [m]', pitch_deg 'pitch "
              "[deg]', roll_deg 'roll [deg]'; metres, degrees; altitude: along the axis");
}

// Where the vehicle was is read where it is asked for; what is no number is no fault of the pose.
TEST(NavigationFile, PlacesAreReadOnRequest) {
    EXPECT_TRUE(std::isnan(parsed(kOplab).pose_of("20240309_123456_789.tif").place.east_m));
    const Navigation nav = parsed(kOplab, {.has_places = true});
    const Place& place = nav.pose_of("20240309_123456_789.tif").place;
    EXPECT_EQ(place.north_m, 10.1);
    EXPECT_EQ(place.east_m, -3.2);
    EXPECT_EQ(place.depth_m, 61.2);
    EXPECT_NEAR(place.heading_rad, 181.2 * kDegree, kRounding);
    EXPECT_TRUE(nav.tells_depth());
    EXPECT_TRUE(has(words_of(*nav.notes()),
                    "east_m 'easting [m]', north_m 'northing [m]', heading_deg 'heading [deg]', "
                    "depth_m 'depth [m]'"));
    const Navigation own =
        parsed("image,altitude_m,X,Y,heading_deg\na,2,500000.5,none,90\n",
               {.columns = {{"east_m", "X"}, {"north_m", "Y"}}, .has_places = true});
    EXPECT_EQ(own.pose_of("a").place.east_m, 500000.5);
    EXPECT_TRUE(std::isnan(own.pose_of("a").place.north_m));
    EXPECT_FALSE(own.tells_depth());
    EXPECT_TRUE(has(refusal("image,altitude_m,depth [cm]\na,2,6100\n",
                            {.columns = {{"depth_m", "depth [cm]"}}}),
                    "the column 'depth [cm]' is in cm; allowed: metres"));
}

TEST(NavigationFile, BiiglesCsvInAnyLetterCaseAndByOtherNames) {
    const Navigation nav = parsed(
        "filename,taken_at,lng,lat,gps_altitude,distance_to_ground,area,yaw\n"
        "a.jpg,2016-12-19 12:27:00,52.220,28.123,-1500,10.5,2.6,180\n"
        "b.jpg,2016-12-19 12:27:01,52.220,28.123,-1500,,2.6,180\n");
    EXPECT_EQ(nav.pose_of("a.jpg").sled.altitude_m, 10.5);
    EXPECT_EQ(nav.pose_of("a.jpg").sled.pitch_rad, kRigSled.pitch_rad);
    EXPECT_FALSE(nav.given().pitch || nav.given().roll);
    EXPECT_NE(fault_of_image(nav, "b.jpg"), "nothing was said");
    const Navigation sub = parsed(
        "file,SUB_datetime,SUB_altitude,SUB_distance,SUB_heading\n"
        "a.jpg,2016-12-19 12:27:00,-1500,3.5,180\n");
    EXPECT_EQ(sub.pose_of("a.jpg").sled.altitude_m, 3.5);
    EXPECT_EQ(sub.notes()->format, "BIIGLE's CSV");
}

// Of several formats' names in one table each is what it is in its own.
TEST(NavigationFile, NamesOfColumnsMayBeMixed) {
    const Navigation nav = parsed(
        "Image,Altitude [m],Pitch [deg],Roll (deg),SUB_datetime\na.tif,2.05,4.8,-0.3,2024\n");
    expect_sled(nav.pose_of("a.tif").sled, 2.05, 4.8, -0.3);
}

TEST(NavigationFile, AUnitInAColumnsNameIsNotIgnored) {
    EXPECT_EQ(refusal("image,alt [cm]\na,205\n", {.columns = {{"altitude_m", "alt [cm]"}}}),
              "nav:1: the column 'alt [cm]' is in cm; allowed: metres");
    const std::string text = "image,altitude_m,pitch [rad],roll_rad\na,2,0.1,0.2\n";
    const ColumnNames given{{"pitch_deg", "pitch [rad]"}, {"roll_deg", "roll_rad"}};
    EXPECT_EQ(refusal(text, {.columns = given}),
              "nav:1: the column 'pitch [rad]' is in rad; allowed: degrees, or --angles-in rad");
    const Navigation nav = parsed(text, {.columns = given, .angles_in = AngleUnit::Radians});
    EXPECT_DOUBLE_EQ(nav.pose_of("a").sled.pitch_rad, 0.1);
}

// As PANGAEA gives its tables out.
TEST(NavigationFile, PangaeasTabFiles) {
    const std::string before =
        "/* DATA DESCRIPTION:\nCitation:\tA, B (2023): Seafloor images, "
        "https://doi.org/10.1594/PANGAEA.0\nParameter(s):\tDATE/TIME (Date/Time)\n*/\n";
    const std::string table =
        "Event\tDate/Time\tLatitude\tFile name\tAltitude [m]\tHeight [m]\tPitch [deg]\t"
        "Roll [deg]\n"
        "SO268\t2019-03-01T12:00:00\t11.9\ta.jpg\t-4100\t2.05\t4.8\t-0.3\n";
    EXPECT_EQ(refusal(before + table),
              "nav:5: found the columns Event,Date/Time,Latitude,File name,Altitude [m],Height [m]"
              ",Pitch [deg],Roll [deg], of PANGAEA's tab file; needed: 'altitude_m' (is it "
              "'Altitude [m]'?), or --columns altitude_m=NAME; 'Altitude [m]' is relative to the "
              "sea level");
    const Navigation nav = parsed(before + table, {.columns = {{"altitude_m", "Height [m]"}}});
    expect_sled(nav.pose_of("a.jpg").sled, 2.05, 4.8, -0.3);
    EXPECT_EQ(nav.notes()->format, "PANGAEA's tab file");
}

// As Matisse's DataPreprocessingWizard writes them.
TEST(NavigationFile, MatissesDim2) {
    const Navigation nav = parsed(
        "0;09/03/2024;12:34:56.789;photo;photo;a.jpg;45.1234567890;-3.2;1700.123;2.050;181.20;-0.30"
        ";4.80;;;;;;;;;;;;;;;;;\n"
        "0;09/03/2024;12:34:57.789;photo;photo;b.jpg;45.1234567890;-3.2;1700.123;2.0");
    expect_sled(nav.pose_of("a.jpg").sled, 2.05, 4.8, -0.3);
    EXPECT_EQ(fault_of_image(nav, "b.jpg"), "nav:2: found 10 fields; allowed: 30");
    EXPECT_EQ(nav.notes()->format, "Matisse's .dim2");
}

// A height over the sea is none over the floor.
TEST(NavigationFile, AltitudesOverTheSeaAreNotTaken) {
    EXPECT_EQ(refusal("filename,lng,lat,gps_altitude\na.jpg,52.2,28.1,-1500\n"),
              "nav:1: found the columns filename,lng,lat,gps_altitude; needed: 'altitude_m', or "
              "--columns altitude_m=NAME; 'gps_altitude' is relative to the sea level");
    EXPECT_TRUE(has(refusal("filename,SUB_altitude\na.jpg,-1500\n"), "'SUB_altitude' is relative"));
    EXPECT_TRUE(has(refusal("key,pose.dep\na,1500\n"), "'pose.dep' is relative"));
}

TEST(NavigationFile, SquidlesNavdata) {
    const Navigation nav = parsed(
        "key,pose.lat,pose.lon,pose.dep,pose.alt,timestamp_start,pose.data.northing_m,"
        "pose.data.easting_m,pose.data.roll,pose.data.pitch,pose.data.heading\n"
        "PR_1,-43.1,147.2,61.2,2.05,2024-03-09 12:34:56.789000,1,2,-0.3,4.8,181\n");
    expect_sled(nav.pose_of("PR_1.png").sled, 2.05, 4.8, -0.3);
    EXPECT_EQ(nav.notes()->format, "SQUIDLE+'s CSV");
    const Navigation level = parsed("key,pose.alt\nPR_1,2.5\n");
    EXPECT_EQ(level.pose_of("PR_1.png").sled.altitude_m, 2.5);
    EXPECT_FALSE(level.given().roll);
}

TEST(NavigationFile, HabCamsImgWithAndWithoutAHeader) {
    const std::string header =
        "imagename,lat,lon,head,pitch,roll,alt1,alt2,depth,s,t,o2,cdom,chlorophyll,backscatter,"
        "therm\n";
    const std::string line =
        "201207.0001.tif,40.61,-67.12,181.2,-4.8,0.3,2.05,2.11,61.2,32.5,8.1,nan,1,2,3,0\n";
    for (const std::string& start : {header, "#" + header, std::string()}) {
        const Navigation nav = parsed(start + line);
        expect_sled(nav.pose_of("201207.0001.tif").sled, 2.05, -4.8, 0.3);
        EXPECT_EQ(nav.size(), 1U);
        EXPECT_EQ(nav.notes()->format, "HabCam's .img");
        const Navigation other = parsed(start + line, {.columns = {{"altitude_m", "alt2"}}});
        expect_sled(other.pose_of("201207.0001.tif").sled, 2.11, -4.8, 0.3);
    }
}

TEST(NavigationFile, AnyOtherByItsColumns) {
    const std::string text =
        "photo,alt [m],theta,phi\n"
        "a.tif,2.05,0.1,-0.2\n";
    const ColumnNames columns{
        {"image", "photo"}, {"altitude_m", "alt [m]"}, {"pitch_deg", "theta"}, {"roll_deg", "phi"}};
    const NavigationOptions options{.columns = columns, .angles_in = AngleUnit::Radians};
    const Navigation nav = parsed(text, options);
    const Sled& sled = nav.pose_of("a.tif").sled;
    EXPECT_EQ(sled.altitude_m, 2.05);
    EXPECT_EQ(sled.pitch_rad, 0.1);
    EXPECT_EQ(sled.roll_rad, -0.2);
    const nlohmann::ordered_json notes = to_json(*nav.notes());
    EXPECT_EQ(notes["columns"]["altitude_m"], "alt [m]");
    EXPECT_EQ(notes["angles_in"], "rad");
    EXPECT_EQ(
        refusal(text, {.columns = {{"image", "photos"}}}),
        "nav:1: found the columns photo,alt [m],theta,phi; needed by --columns: 'photos' (is it "
        "'photo'?)");
    EXPECT_EQ(
        refusal(text, {.columns = {{"altitude_m", "alt [m]"}}}),
        "nav:1: found the columns photo,alt [m],theta,phi; needed: 'image' or 'timestamp', or "
        "--columns image=NAME");
    EXPECT_EQ(refusal("a.tif 2 0 0\n", {.columns = {{"altitude_m", "b"}}}),
              "nav:1: found no header row; needed by --columns");
}

// --- Over time -------------------------------------------------------------------------------

std::vector<ImageFile> images(const std::vector<std::string>& names) {
    std::vector<ImageFile> files;
    for (const std::string& name : names) files.push_back({.source = name, .name = name});
    return files;
}

constexpr std::string_view kMask = "xYYYYMMDDxhhmmssxfff";

TEST(NavigationFile, ATrackIsJoinedByTheImagesTimes) {
    const auto files = images({"c20240309_120000_500.tif",
                               "c20240309_120001_000.tif",
                               "c20240309_120004_000.tif",
                               "c20240309_110000_000.tif",
                               "c2024.tif"});
    const NavigationOptions options{.time_mask = std::string(kMask)};
    for (const char* text : {"time,altitude_m,pitch_deg,roll_deg\n"
                             "2024-03-09 12:00:00.000,2.0,4,-1\n"
                             "2024-03-09T12:00:01Z,3.0,6,1\n"
                             "2024-03-09 12:00:05,3.0,6,1\n",
                             "timestamp [s],altitude [m],pitch [deg],roll [deg],depth [m]\n"
                             "1709985605,3.0,6,1,9\n"
                             "1709985600,2.0,4,-1,9\n"
                             "1709985601.0,3.0,6,1,9\n"}) {
        const Navigation nav = parsed(text, options, files);
        expect_sled(nav.pose_of("c20240309_120000_500.tif").sled, 2.5, 5.0, 0.0);
        expect_sled(nav.pose_of("c20240309_120001_000.tif").sled, 3.0, 6.0, 1.0);
        EXPECT_TRUE(has(fault_of_image(nav, "c20240309_120004_000.tif"), "in a gap of 4 s"));
        EXPECT_TRUE(
            has(fault_of_image(nav, "c20240309_110000_000.tif"), "3600 s before the first"));
        EXPECT_EQ(fault_of_image(nav, "c2024.tif"),
                  "nav: its name has no time where --image-time xYYYYMMDDxhhmmssxfff expects it");
    }
    NavigationOptions late = options;
    late.clock_offset_s = 3600.0;
    late.longest_gap_s = 4.0;
    const Navigation nav =
        parsed("time,altitude_m\n1709985600,2\n1709985601,3\n1709985605,4\n", late, files);
    EXPECT_EQ(nav.pose_of("c20240309_110000_000.tif").sled.altitude_m, 2.0);
    EXPECT_EQ(words_of(*nav.notes()),
              "Aphotic's CSV: time, altitude_m; metres, degrees; altitude: along the axis; images' "
              "times: names' by "
              "xYYYYMMDDxhhmmssxfff, +3600 s, gaps up to 4 s");
}

// Between 2 m and an altimeter's 0 or 99 there is no altitude.
TEST(NavigationFile, LinesOfATrackThatNoSledCanHaveMakeAGap) {
    const auto files = images({"c20240309_120000_500.tif", "c20240309_120003_500.tif"});
    NavigationOptions options{.time_mask = std::string(kMask), .most_altitude_m = 50.0};
    const std::string text =
        "timestamp,altitude_m\n1709985600,2\n1709985601,0\n1709985602,None\n1709985603,2.5\n"
        "1709985604,2.7\nnoon,2\n1709985602.5,99\n";
    const Navigation nav = parsed(text, options, files);
    EXPECT_EQ(fault_of_image(nav, "c20240309_120000_500.tif"),
              "nav: the image's time, 2024-03-09T12:00:00.500Z, is in a gap of 3 s, between lines "
              "2 and 5; allowed by --longest-gap-s: 2");
    EXPECT_NEAR(nav.pose_of("c20240309_120003_500.tif").sled.altitude_m, 2.6, kRounding);
    EXPECT_EQ(nav.notes()->times->lines_left_out, 4U);
    EXPECT_EQ(
        refusal("time,altitude_m\nnoon,2\nmidnight,3\n", options),
        "nav:2: the first of 2 lines, none of which can be used: time: found 'noon'; allowed: "
        "seconds since 1970, or a time such as 2024-03-09 12:34:56.789");
    EXPECT_EQ(
        refusal("time,altitude_m\n1,0\n", options),
        "nav:2: the first of 1 lines, none of which can be used: altitude_m: found 0; allowed: "
        "0.001 to 10000");
    EXPECT_EQ(refusal("time,altitude_m\n"), "nav:2: the file ends without a line of a pose");
}

TEST(NavigationFile, ATracksTimeMayHaveAnotherFormatsName) {
    const std::string image = "c20240309_120000_500.tif";
    const Navigation track =
        parsed("SUB_datetime;altitude_m\n2024-03-09 12:00:00;2\n09.03.2024 12:00:01;3\n",
               {.time_mask = std::string(kMask)},
               images({image}));
    EXPECT_EQ(track.pose_of(image).sled.altitude_m, 2.5);
}

// Images of two folders may have one name; the table that names none has a pose for each.
TEST(NavigationFile, OfATrackImagesAreKnownByTheirPaths) {
    const auto files = images({"port/c20240309_120000_000.tif", "star/c20240309_120000_000.tif"});
    const Navigation nav = parsed(
        "time,altitude_m\n1709985600,2\n1709985601,3\n", {.time_mask = std::string(kMask)}, files);
    EXPECT_EQ(nav.pose_of("port/c20240309_120000_000.tif").sled.altitude_m, 2.0);
    EXPECT_EQ(nav.pose_of("star/c20240309_120000_000.tif").sled.altitude_m, 2.0);
}

TEST(NavigationFile, ColumnsMayAskForTimesInsteadOfNames) {
    const Navigation nav = parsed(
        kOplab, {.columns = {{"time", "timestamp [s]"}}}, images({"20240309.123456789.1.tif"}));
    EXPECT_NE(fault_of_image(nav, "20240309.123456789.1.tif"), "nothing was said");  // no such file
    EXPECT_TRUE(nav.notes()->times.has_value());
}

TEST(NavigationFile, TimesThatAreSaidInVainAreRefused) {
    EXPECT_EQ(refusal("a.tif 2 0 0\n", {.clock_offset_s = 1.0}),
              "nav: --clock-offset-s found, but its poses are of images and not of times; allowed "
              "with poses over time, which --columns time=COLUMN selects");
    EXPECT_TRUE(
        refusal(kOplab, {.time_mask = std::string(kMask)}).starts_with("nav: --image-time"));
}

// --- In the images' tags ---------------------------------------------------------------------

class TagsOfImages : public testing::Test {
  protected:
    void write(const std::string& name, const std::string& description) {
        const std::filesystem::path file = folder_.path() / name;
        const std::vector<float> plane(48, 0.5F);
        write_any_image(file,
                        {.width_px = 8,
                         .height_px = 6,
                         .channels = {"Y"},
                         .planes = plane,
                         .description = description});
        files_.push_back({.source = file, .name = name});
    }

    [[nodiscard]] Navigation read(NavigationOptions options = {}) const {
        const Rig rig = habcam();
        options.source = "tags";
        return read_navigation(options, files_, &rig);
    }

    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_.path() / name).string();
    }

    TempFolder folder_;
    std::vector<ImageFile> files_;
};

TEST_F(TagsOfImages, HabCamsAreReadFromTiffPngAndJpeg) {
    const std::string tags =
        "lat=40.612345,lon=-67.123456,hdg=181.20,pitch=-4.80,roll=0.30,alt0=2.05,alt1=2.11,"
        "depth=61.20,c=,t=,O2=,cdom=1,fluor=2,scatter=3,therm=4,ph1=,ph2=,fath=";
    for (const char* name : {"a.tif", "a.png", "a.jpg"}) write(name, tags);
    const Navigation nav = read();
    for (const char* name : {"a.tif", "a.png", "a.jpg"})
        expect_sled(nav.pose_of(path(name)).sled, 2.05, -4.8, 0.3);
    EXPECT_EQ(words_of(*nav.notes()),
              "HabCam's tags: altitude_m 'alt0', pitch_deg 'pitch', roll_deg 'roll'; metres, "
              "degrees; altitude: along "
              "the axis");
    const Navigation other = read({.columns = {{"altitude_m", "alt1"}}});
    expect_sled(other.pose_of(path("a.tif")).sled, 2.11, -4.8, 0.3);
    EXPECT_EQ(refusal_of([&] {
                  return read({.columns = {{"image", "c"}}});
              }),
              "--columns: found 'image'; allowed with --nav tags: altitude_m, pitch_deg, roll_deg");
}

TEST_F(TagsOfImages, AnImageWithoutThemCostsItselfAlone) {
    write("a.tif", "pitch=0,roll=0,alt0=2.05");
    write("b.tif", "");
    write("c.tif", "a fish");
    write("d.tif", "pitch=0,roll=0,alt0=");
    write("e.tif", "pitch=0,roll=zero,alt0=2");
    write_file(path("f.tif"), "no image");
    files_.push_back({.source = path("f.tif"), .name = "f"});
    files_.push_back({.source = path("g.tif"), .name = "g"});
    const Navigation nav = read();
    expect_sled(nav.pose_of(path("a.tif")).sled, 2.05, 0.0, 0.0);
    EXPECT_EQ(fault_of_image(nav, path("b.tif")), "tags: it has no ImageDescription");
    EXPECT_EQ(fault_of_image(nav, path("c.tif")),
              "tags: found the ImageDescription 'a fish'; needed in it: alt0=NUMBER");
    EXPECT_EQ(fault_of_image(nav, path("d.tif")),
              "tags: altitude_m: found no number; allowed: 0.001 to 10000");
    EXPECT_EQ(fault_of_image(nav, path("e.tif")), "tags: roll: found 'zero'; allowed: a number");
    EXPECT_TRUE(has(fault_of_image(nav, path("f.tif")), "cannot be read"));
    EXPECT_EQ(fault_of_image(nav, path("g.tif")), "tags: the file no longer exists");
}

// --- What altitudes are, and where the camera is -----------------------------------------------

TEST(NavigationFile, HeightsBecomeAltitudesAlongTheAxis) {
    const std::string text = "image,altitude_m,pitch_deg,roll_deg\na,2,30,0\nb,0,30,0\n";
    const Navigation nav =
        parsed(text, {.altitude_is = AltitudeIs::Plumb, .altitude_offset_m = 1.0});
    expect_sled(nav.pose_of("a").sled, 3.0 / std::cos(30.0 * kDegree), 30.0, 0.0);
    // An altimeter's 0 is no altitude, whatever is added.
    EXPECT_EQ(fault_of_image(nav, "b"), "nav:3: altitude_m: found 0; allowed: 0.001 to 10000");
    EXPECT_EQ(words_of(*nav.notes()),
              "Aphotic's CSV: image, altitude_m, pitch_deg, roll_deg; metres, degrees; altitude: "
              "the vertical height, "
              "+1 m");
}

TEST(NavigationFile, TheRigsMountingCountsAndOptionsComeBeforeIt) {
    Rig rig = habcam();
    rig.mounting = {.altitude_is = AltitudeIs::Plumb,
                    .altitude_offset_m = 0.5,
                    .position_m = {0.0, 0.0, 0.5},
                    .roll_pitch_yaw_rad = {0.0, 60.0 * kDegree, 0.0}};
    const std::string text = "image,altitude_m,pitch_deg,roll_deg\na,2,0,0\nb,2,40,0\n";
    const Navigation nav = parse_navigation(text, {.source = "nav"}, {}, &rig);
    expect_sled(nav.pose_of("a").sled, 4.0, 60.0, 0.0);
    EXPECT_EQ(fault_of_image(nav, "b"),
              "nav:3: the camera looks 10 degrees above the horizon; allowed: below it, to see the "
              "floor");
    EXPECT_EQ(words_of(*nav.notes()),
              "Aphotic's CSV: image, altitude_m, pitch_deg, roll_deg; metres, degrees; altitude: "
              "the vertical height, "
              "+0.5 m; camera at [0, 0, 0.5] m, turned by [0, 60, 0] degrees");
    const NavigationOptions options{.source = "nav", .altitude_offset_m = 0.0};
    expect_sled(parse_navigation(text, options, {}, &rig).pose_of("a").sled, 3.0, 60.0, 0.0);
    EXPECT_EQ(
        refusal_of([&] { return parse_navigation("image,altitude_m\na,2\n", options, {}, &rig); }),
        "nav: has no pitch and roll; needed, since the rig's position_m and orientation_deg place "
        "the camera on the vehicle");
}

TEST(NavigationFile, WithoutAttitudesHeightsNeedARig) {
    const std::string text = "image,altitude_m,roll_deg\na,2,0\n";
    const NavigationOptions options{.source = "nav", .altitude_is = AltitudeIs::Nearest};
    EXPECT_EQ(refusal_of([&] { return parse_navigation(text, options, {}, nullptr); }),
              "nav: has no pitch; needed by --altitude-is nearest, or a --rig that has them");
    const Rig rig = habcam();
    const Navigation nav = parse_navigation(text, options, {}, &rig);
    EXPECT_NEAR(nav.pose_of("a").sled.altitude_m, 2.0 / std::cos(rig.sled.pitch_rad), kRounding);
}

}  // namespace
}  // namespace aphotic::navigation_file_test
