// SPDX-License-Identifier: BSD-3-Clause
#include "rig/rig_reader.h"

#include "base/error.h"
#include "base/printable.h"
#include "rig/calibration_file.h"
#include "rig/geometry_signature.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace aphotic::rig_reader_test {
namespace {

namespace fs = std::filesystem;

constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 1e-15;  // a few units in the last place of numbers near 1

// The least that a rig must say. Errors are told by line: keep the lines' numbers in mind.
constexpr std::string_view kMinimal =
    /*  1 */
    "[sled]\n"
    /*  2 */
    "altitude_m = 2.5\n"
    /*  3 */
    "[camera]\n"
    /*  4 */
    "resolution = [1360, 1024]\n"
    /*  5 */
    "pixel_pitch_um = 6.45\n"
    /*  6 */
    "focal_length_mm = 12\n"
    /*  7 */
    "range_nm = [400, 700]\n"
    /*  8 */
    "response = \"nikon-d5100\"\n"
    /*  9 */
    "[water]\n"
    /* 10 */
    "[seafloor]\n"
    /* 11 */
    "[beam.wide]\n"
    /* 12 */
    "cones = [{ part = \"all\", half_angle_deg = 90, weight = 1 }]\n"
    /* 13 */
    "[[strobe]]\n"
    /* 14 */
    "name = \"fore\"\n"
    /* 15 */
    "position_m = [0.5, 0, 0]\n"
    /* 16 */
    "aim = { tilt_deg = 26, toward = \"axis\" }\n"
    /* 17 */ "beam = \"wide\"\n";

constexpr std::string_view kPort =
    "[camera.port]\n"
    "shape = \"flat\"\n"
    "distance_mm = 50.0\n"
    "thickness_mm = 12.0\n"
    "glass = \"bk7\"\n";

// The minimal rig with one line in place of another, such as with(2, "altitude_m = 3"). Added
// lines go after it, an empty text takes it out without moving the others.
std::string with(int line, std::string_view text) {
    std::string result;
    std::size_t start = 0;
    for (int n = 1; start < kMinimal.size(); ++n) {
        const std::size_t end = kMinimal.find('\n', start) + 1;
        result +=
            n == line ? std::string(text) + "\n" : std::string(kMinimal.substr(start, end - start));
        start = end;
    }
    return result;
}

std::string minimal_and(std::string_view text) {
    return std::string(kMinimal) + std::string(text);
}

Rig parse(std::string_view toml) {
    return parse_rig(toml, "rig.toml", ".");
}

std::string error_of(std::string_view toml, const fs::path& folder = ".") {
    try {
        static_cast<void>(parse_rig(toml, "rig.toml", folder));
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

void expect_vector(const Eigen::Vector3d& found, const Eigen::Vector3d& wanted) {
    EXPECT_LE((found - wanted).norm(), kRounding)
        << "found " << found.transpose() << "; wanted " << wanted.transpose();
}

// --- What a good rig becomes -----------------------------------------------------------------

TEST(RigReader, ReadsTheMinimalRigIntoSi) {
    const Rig rig = parse(kMinimal);
    EXPECT_EQ(rig.sled.altitude_m, 2.5);
    EXPECT_EQ(rig.camera.width_px, 1360);
    EXPECT_EQ(rig.camera.height_px, 1024);
    EXPECT_NEAR(rig.camera.pixel_pitch_m, 6.45e-6, kRounding * 6.45e-6);
    EXPECT_NEAR(rig.camera.focal_length_m, 0.012, kRounding * 0.012);
    EXPECT_EQ(rig.camera.range.first_nm, 400.0);
    EXPECT_EQ(rig.camera.range.last_nm, 700.0);
    ASSERT_EQ(rig.strobes.size(), 1U);
    EXPECT_EQ(rig.strobes[0].name, "fore");
    expect_vector(rig.strobes[0].position_m, {0.5, 0.0, 0.0});
    EXPECT_EQ(rig.strobes[0].beam.name, "wide");
    ASSERT_EQ(rig.strobes[0].beam.cones.size(), 1U);
    EXPECT_EQ(rig.strobes[0].beam.cones[0].part, "all");
    EXPECT_NEAR(rig.strobes[0].beam.cones[0].half_angle_rad, kPi / 2.0, kRounding);
    EXPECT_EQ(rig.strobes[0].beam.cones[0].weight, 1.0);
}

TEST(RigReader, FillsInTheDefaults) {
    const Rig rig = parse(kMinimal);
    EXPECT_EQ(rig.title, "rig") << "the file's name without its extension";
    EXPECT_EQ(rig.sled.pitch_rad, 0.0);
    EXPECT_EQ(rig.sled.roll_rad, 0.0);
    EXPECT_FALSE(rig.camera.port.has_value());
    EXPECT_EQ(rig.water.absorption_per_m.name(), "water absorption 'pope-fry-1997'");
    EXPECT_EQ(rig.water.multiple, 1.0);
    EXPECT_EQ(rig.water.uniform_loss_per_m, 0.0);
    EXPECT_EQ(rig.water.salinity_psu, 35.0);
    EXPECT_EQ(rig.water.temperature_c, 10.0);
    EXPECT_EQ(rig.seafloor.reflectance.name(), "reflectance 'sand'");
    EXPECT_EQ(rig.seafloor.phong, 0.0);
    EXPECT_EQ(rig.seafloor.phong_size, 40.0);
    EXPECT_EQ(rig.strobes[0].beam.weights, ConeWeights::Flux);
    EXPECT_EQ(rig.strobes[0].spectrum.name(), "lamp spectrum 'xenon-flash'");
    EXPECT_EQ(rig.strobes[0].power, 1.0);
    EXPECT_FALSE(rig.strobes[0].emitter.has_value());
    EXPECT_TRUE(rig.materials.empty());
}

TEST(RigReader, TakesTheRangeOfTheResponseWhenNoneIsGiven) {
    std::string rig = with(7, "");
    rig.replace(rig.find("[water]"), 7, "[water]\nabsorption = \"pure-2016\"");
    EXPECT_EQ(parse(rig).camera.range.first_nm, 380.0);  // the table's ends
    EXPECT_EQ(parse(rig).camera.range.last_nm, 780.0);
}

TEST(RigReader, ConvertsDegreesToRadians) {
    const Rig rig = parse(with(2, "altitude_m = 2\npitch_deg = 30\nroll_deg = -45"));
    EXPECT_NEAR(rig.sled.pitch_rad, kPi / 6.0, kRounding);
    EXPECT_NEAR(rig.sled.roll_rad, -kPi / 4.0, kRounding);
    const Rig narrow =
        parse(with(12, "cones = [{ part = \"x\", half_angle_deg = 60, weight = 0.5 }]"));
    EXPECT_NEAR(narrow.strobes[0].beam.cones[0].half_angle_rad, kPi / 3.0, kRounding);
}

TEST(RigReader, ReadsWhatNavigationIsTakenFor) {
    const Mounting none = parse(kMinimal).mounting;
    EXPECT_EQ(none.altitude_is, AltitudeIs::Axis);
    EXPECT_EQ(none.altitude_offset_m, 0.0);
    EXPECT_EQ(none.position_m, Eigen::Vector3d::Zero());
    EXPECT_EQ(none.roll_pitch_yaw_rad, Eigen::Vector3d::Zero());
    std::string text =
        with(2, "altitude_m = 2\naltitude_is = \"plumb\"\naltitude_offset_m = -0.35");
    text.replace(text.find("[camera]\n"),
                 9,
                 "[camera]\nposition_m = [0.5, -0.25, 0.125]\norientation_deg = [0, 30, -90]\n");
    const Mounting told = parse(text).mounting;
    EXPECT_EQ(told.altitude_is, AltitudeIs::Plumb);
    EXPECT_EQ(told.altitude_offset_m, -0.35);
    expect_vector(told.position_m, {0.5, -0.25, 0.125});
    expect_vector(told.roll_pitch_yaw_rad, {0.0, kPi / 6.0, -kPi / 2.0});
    EXPECT_EQ(parse(with(2, "altitude_m = 2\naltitude_is = \"nearest\"")).mounting.altitude_is,
              AltitudeIs::Nearest);
}

TEST(RigReader, ReadsAConesExponent) {
    EXPECT_EQ(parse(kMinimal).strobes[0].beam.cones[0].exponent, 1.0);
    const Rig steep = parse(
        with(12, "cones = [{ part = \"x\", half_angle_deg = 60, weight = 0.5, exponent = 2.5 }]"));
    EXPECT_EQ(steep.strobes[0].beam.cones[0].exponent, 2.5);
}

TEST(RigReader, ReadsEverythingThatMayBeSaid) {
    std::string text = "title = \"All of it\"\n" + with(9,
                                                        std::string(kPort) +
                                                            "[water]\n"
                                                            "absorption = \"pure-2016\"\n"
                                                            "multiple = 0.5\n"
                                                            "uniform_loss_per_m = 0.125\n"
                                                            "salinity_psu = 7\n"
                                                            "temperature_c = -1.5\n");
    text.replace(text.find("[seafloor]\n"),
                 11,
                 "[seafloor]\nreflectance = \"red-algae\"\nphong = 0.25\nphong_size = 12\n");
    text.replace(text.find("[beam.wide]\n"), 12, "[beam.wide]\nweights = \"literal\"\n");
    text += "spectrum = \"xenon-arc\"\npower = 3\nemitter_mm = [63.5, 30.2]\n";
    const Rig rig = parse(text);
    EXPECT_EQ(rig.title, "All of it");
    ASSERT_TRUE(rig.camera.port.has_value());
    EXPECT_NEAR(rig.camera.port->distance_m, 0.05, kRounding);
    EXPECT_NEAR(rig.camera.port->thickness_m, 0.012, kRounding);
    EXPECT_EQ(rig.camera.port->glass.name(), "bk7");
    EXPECT_EQ(rig.water.absorption_per_m.name(), "water absorption 'pure-2016'");
    EXPECT_EQ(rig.water.multiple, 0.5);
    EXPECT_EQ(rig.water.uniform_loss_per_m, 0.125);
    EXPECT_EQ(rig.water.salinity_psu, 7.0);
    EXPECT_EQ(rig.water.temperature_c, -1.5);
    EXPECT_EQ(rig.seafloor.reflectance.name(), "reflectance 'red-algae'");
    EXPECT_EQ(rig.seafloor.phong, 0.25);
    EXPECT_EQ(rig.seafloor.phong_size, 12.0);
    EXPECT_EQ(rig.strobes[0].beam.weights, ConeWeights::Literal);
    EXPECT_EQ(rig.strobes[0].spectrum.name(), "lamp spectrum 'xenon-arc'");
    EXPECT_EQ(rig.strobes[0].power, 3.0);
    ASSERT_TRUE(rig.strobes[0].emitter.has_value());
    EXPECT_NEAR(rig.strobes[0].emitter->across_m, 0.0635, kRounding);
    EXPECT_NEAR(rig.strobes[0].emitter->along_m, 0.0302, kRounding);
}

TEST(RigReader, ReadsTheRigOfTheSourcePaper) {
    const Rig rig = read_rig(fs::path(APHOTIC_SOURCE_DIR) / "scenes" / "habcam.toml");
    ASSERT_EQ(rig.strobes.size(), 4U);
    const std::vector<std::string> names{"fore", "aft", "port", "starboard"};
    for (std::size_t s = 0; s < names.size(); ++s) {
        const Strobe& strobe = rig.strobes[s];
        EXPECT_EQ(strobe.name, names[s]);
        EXPECT_NEAR(strobe.position_m.norm(), 0.5, kRounding) << "all on one circle";
        EXPECT_EQ(strobe.beam.cones.size(), 3U);
        const double tilt_deg = std::acos(strobe.axis.z()) * 180.0 / kPi;
        constexpr double kAcosRounding = 1e-12;  // degrees
        EXPECT_NEAR(tilt_deg, s < 2 ? 26.0 : 28.0, kAcosRounding) << names[s];
        EXPECT_LT(strobe.axis.dot(strobe.position_m), 0.0) << names[s] << " shines inward";
    }
}

// --- Aim -------------------------------------------------------------------------------------

std::string strobe_at(std::string_view position, std::string_view axis) {
    std::string text = with(15, "position_m = " + std::string(position));
    const std::string aim = "aim = { tilt_deg = 26, toward = \"axis\" }";
    text.replace(text.find(aim), aim.size(), axis);
    return text;
}

Eigen::Vector3d axis_of(std::string_view position, std::string_view axis) {
    return parse(strobe_at(position, axis)).strobes[0].axis;
}

TEST(RigReader, TiltsTheAxisFromStraightDownTowardTheCamerasAxis) {
    const double sin26 = std::sin(26.0 * kPi / 180.0);
    const double cos26 = std::cos(26.0 * kPi / 180.0);
    const std::string aim = "aim = { tilt_deg = 26, toward = \"axis\" }";
    expect_vector(axis_of("[0.5, 0, 0]", aim), {-sin26, 0.0, cos26});
    expect_vector(axis_of("[-0.5, 0, 0.3]", aim), {sin26, 0.0, cos26});
    expect_vector(axis_of("[0, -0.5, 0]", aim), {0.0, sin26, cos26});
    expect_vector(axis_of("[0, 0.5, -1]", aim), {0.0, -sin26, cos26});
    // Inward from (0.3, -0.4) is (-0.6, 0.8).
    expect_vector(axis_of("[0.3, -0.4, 0]", aim), {-0.6 * sin26, 0.8 * sin26, cos26});
}

TEST(RigReader, TiltIsFromStraightDownToStraightUp) {
    expect_vector(axis_of("[0.5, 0, 0]", "aim = { tilt_deg = 0, toward = \"axis\" }"),
                  {0.0, 0.0, 1.0});
    expect_vector(axis_of("[0.5, 0, 0]", "aim = { tilt_deg = 90, toward = \"axis\" }"),
                  {-1.0, 0.0, 0.0});
    expect_vector(axis_of("[0.5, 0, 0]", "aim = { tilt_deg = 180, toward = \"axis\" }"),
                  {0.0, 0.0, -1.0});
    expect_vector(axis_of("[0, 0, 0]", "aim = { tilt_deg = 0, toward = \"axis\" }"),
                  {0.0, 0.0, 1.0});
}

TEST(RigReader, TakesADirectionOfAnyLength) {
    expect_vector(axis_of("[0, 0, 0]", "direction = [0, 3, 4]"), {0.0, 0.6, 0.8});
    expect_vector(axis_of("[0, 0, 0]", "direction = [-1e-6, 0, 0]"), {-1.0, 0.0, 0.0});
}

TEST(RigReader, CannotTiltTowardTheAxisFromTheAxis) {
    EXPECT_EQ(error_of(with(15, "position_m = [0, 0, 0.1]")),
              "rig.toml:16: strobe[0].aim.toward: found 'axis'; allowed: direction = [x, y, z] in "
              "place of aim, since this strobe stands on the camera's axis");
}

TEST(RigReader, TakesEitherAimOrDirection) {
    const std::string allowed =
        "allowed: either aim = { tilt_deg = 26.0, toward = \"axis\" } or direction = [x, y, z]";
    EXPECT_EQ(error_of(minimal_and("direction = [0, 0, 1]\n")),
              "rig.toml:18: strobe[0].direction: found [0, 0, 1]; " + allowed);
    EXPECT_EQ(error_of(with(16, "")), "rig.toml:13: strobe[0].aim: is missing; " + allowed);
    EXPECT_EQ(
        error_of(with(16, "aim = { direction = [0, 0, 1] }")),
        "rig.toml:16: strobe[0].aim.direction: is not a known key. Known here: tilt_deg, toward");
    EXPECT_EQ(error_of(with(16, "aim = 26")), "rig.toml:16: strobe[0].aim: found 26; " + allowed);
    EXPECT_EQ(error_of(with(16, "direction = [0, 0, 0]")),
              "rig.toml:16: strobe[0].direction: found [0, 0, 0]; allowed: a vector that is not "
              "zero");
}

// --- Every value is checked ------------------------------------------------------------------

struct BadValue {
    int line;
    std::string text;     // in place of that line
    std::string message;  // after "rig.toml:LINE: "
};

void expect_errors(const std::vector<BadValue>& values) {
    for (const BadValue& bad : values) {
        EXPECT_EQ(error_of(with(bad.line, bad.text)),
                  "rig.toml:" + std::to_string(bad.line) + ": " + bad.message)
            << bad.text;
    }
}

TEST(RigReader, NamesFileLineKeyWhatWasFoundAndWhatIsAllowed) {
    const std::string focal = "camera.focal_length_mm: found ";
    const std::string allowed = "; allowed: a number from 0.01 to 100000";
    expect_errors({
        {6, "focal_length_mm = -12", focal + "-12" + allowed},
        {6, "focal_length_mm = 0.009", focal + "0.009" + allowed},
        {6, "focal_length_mm = 100001", focal + "100001" + allowed},
        {6, "focal_length_mm = nan", focal + "nan" + allowed},
        {6, "focal_length_mm = inf", focal + "inf" + allowed},
        {6, "focal_length_mm = -inf", focal + "-inf" + allowed},
        {6, "focal_length_mm = true", focal + "true" + allowed},
        {6, "focal_length_mm = \"12\"", focal + "'12'" + allowed},
        {6, "focal_length_mm = [12]", focal + "[12]" + allowed},
        {6, "focal_length_mm = { mm = 12 }", focal + "a table" + allowed},
        {6, "focal_length_mm = 1979-05-27", focal + "1979-05-27" + allowed},
        // More digits than a double holds.
        {6, "focal_length_mm = 9007199254740993", focal + "9007199254740993" + allowed},
    });
    EXPECT_EQ(error_of(with(6, "focal_length_mm = 0.01")), "no error");
    EXPECT_EQ(error_of(with(6, "focal_length_mm = 100000")), "no error");
}

TEST(RigReader, ChecksEveryNumber) {
    expect_errors({
        {2, "altitude_m = 0", "sled.altitude_m: found 0; allowed: a number from 0.001 to 10000"},
        {5,
         "pixel_pitch_um = 0",
         "camera.pixel_pitch_um: found 0; allowed: a number from 0.01 to 10000"},
        {4,
         "resolution = [0, 1]",
         "camera.resolution: found [0, 1]; allowed: an array of 2 numbers, each from 1 to 16384"},
        {4,
         "resolution = [1, 16385]",
         "camera.resolution: found [1, 16385]; allowed: an array of 2 numbers, each from 1 to "
         "16384"},
        {4,
         "resolution = [10.5, 10]",
         "camera.resolution: found [10.5, 10]; allowed: two whole numbers, width and height"},
        {7,
         "range_nm = [700, 400]",
         "camera.range_nm: found [700, 400]; allowed: two wavelengths, the shorter one first"},
        {7,
         "range_nm = [0.4, 0.7]",
         "camera.range_nm: found [0.4, 0.7]; allowed: an array of 2 numbers, each from 100 to "
         "10000"},
    });
}

TEST(RigReader, ChecksArraysOfNumbers) {
    const std::string allowed = "; allowed: an array of 3 numbers, each from -1000 to 1000";
    expect_errors({
        {15, "position_m = 0.5", "strobe[0].position_m: found 0.5" + allowed},
        {15, "position_m = [0, 0]", "strobe[0].position_m: found [0, 0]" + allowed},
        {15, "position_m = [0, 0, 0, 0]", "strobe[0].position_m: found [0, 0, 0, 0]" + allowed},
        {15, "position_m = [0, 0, nan]", "strobe[0].position_m: found [0, 0, nan]" + allowed},
        {15, "position_m = [0, 0, '1']", "strobe[0].position_m: found [0, 0, '1']" + allowed},
        {15, "position_m = [0, true, 0]", "strobe[0].position_m: found [0, true, 0]" + allowed},
        {15, "position_m = [0, 0, 1001]", "strobe[0].position_m: found [0, 0, 1001]" + allowed},
    });
}

// One line after another of the tables whose keys may all be left out.
TEST(RigReader, ChecksTheNumbersThatMayBeLeftOut) {
    struct Optional {
        const char* table;
        std::string text;
        std::string message;
    };
    for (const Optional& bad : {
             Optional{"[sled]",
                      "pitch_deg = 90",
                      "sled.pitch_deg: found 90; allowed: a number from -89.9 to 89.9"},
             {"[sled]",
              "roll_deg = -90",
              "sled.roll_deg: found -90; allowed: a number from -89.9 to 89.9"},
             {"[sled]",
              "altitude_is = \"echo\"",
              "sled.altitude_is: found 'echo'; allowed: \"axis\" or \"plumb\" or \"nearest\""},
             {"[sled]",
              "altitude_offset_m = 1001",
              "sled.altitude_offset_m: found 1001; allowed: a number from -1000 to 1000"},
             {"[camera]",
              "position_m = [0, 0]",
              "camera.position_m: found [0, 0]; allowed: an array of 3 numbers, each from -1000 to "
              "1000"},
             {"[camera]",
              "orientation_deg = [0, 361, 0]",
              "camera.orientation_deg: found [0, 361, 0]; allowed: an array of 3 numbers, each "
              "from -360 to 360"},
             {"[water]",
              "multiple = -1",
              "water.multiple: found -1; allowed: a number from 0 to 1000000"},
             {"[water]",
              "uniform_loss_per_m = -0.1",
              "water.uniform_loss_per_m: found -0.1; allowed: a number from 0 to 1000000"},
             {"[water]",
              "salinity_psu = 41",
              "water.salinity_psu: found 41; allowed: a number from 0 to 40"},
             {"[water]",
              "temperature_c = -3",
              "water.temperature_c: found -3; allowed: a number from -2 to 35"},
             {"[seafloor]",
              "phong = -1",
              "seafloor.phong: found -1; allowed: a number from 0 to 1000000"},
             {"[seafloor]",
              "phong_size = nan",
              "seafloor.phong_size: found nan; allowed: a number from 0 to 1000000"},
             {"[[strobe]]",
              "power = -1",
              "strobe[0].power: found -1; allowed: a number from 0 to 1000000000000"},
             {"[[strobe]]",
              "emitter_mm = [-1, 1]",
              "strobe[0].emitter_mm: found [-1, 1]; allowed: an array of 2 numbers, each from 0 "
              "to 10000"},
         }) {
        std::string text(kMinimal);
        const std::size_t at = text.find(bad.table) + std::string_view(bad.table).size();
        const auto line = 2 + std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n');
        text.insert(at, "\n" + bad.text);
        const std::string message = error_of(text);
        EXPECT_TRUE(message.starts_with("rig.toml:" + std::to_string(line) + ": " + bad.message))
            << message;
    }
}

Beam beam_of(std::string_view lines, const fs::path& folder = ".") {
    return parse_rig(with(12, lines), "rig.toml", folder).strobes[0].beam;
}

TEST(RigReader, ReadsEveryKindOfBeam) {
    const Beam soft =
        beam_of("cones = [{ part = \"x\", half_angle_deg = 60, weight = 0.5, edge_deg = 30 }]");
    EXPECT_NEAR(soft.cones[0].edge_rad, kPi / 6.0, kRounding);
    // One that no cosine tells from a sharp one has none to divide by.
    const Beam sharp = beam_of(
        "cones = [{ part = \"x\", half_angle_deg = 0.001, weight = 0.5, edge_deg = 1e-13 }]");
    EXPECT_EQ(sharp.cones[0].edge_rad, 0.0);

    // cos^n is a half at 60 degrees for n = 1.
    const Beam wide = beam_of("fwhm_deg = 120");
    ASSERT_EQ(wide.cones.size(), 1U);
    EXPECT_NEAR(wide.cones[0].exponent, 1.0, 4.0 * kRounding);
    EXPECT_NEAR(wide.cones[0].half_angle_rad, kPi / 2.0, kRounding);

    const Beam optics = beam_of(
        "diffuser_mm = [30.2, 63.5]\nfocal_length_mm = 65\ndistance_mm = 40\naperture_mm = 80\n"
        "turn_deg = 90\nmeasured_in = \"air\"\nwindow = 1.5");
    const BeamOptics& lens = std::get<BeamOptics>(optics.pattern);
    EXPECT_NEAR(lens.along_m, 0.0302, kRounding);
    EXPECT_NEAR(lens.across_m, 0.0635, kRounding);
    EXPECT_NEAR(lens.focal_length_m, 0.065, kRounding);
    EXPECT_NEAR(lens.distance_m, 0.04, kRounding);
    EXPECT_NEAR(lens.aperture_m, 0.08, kRounding);
    EXPECT_NEAR(optics.turn_rad, kPi / 2.0, kRounding);
    ASSERT_TRUE(optics.window);
    EXPECT_EQ(optics.window->glass_index, 1.5);
    // Sea water of 35 psu at 10 degrees, by hand from Quan and Fry's (1995) formula at 550 nm.
    EXPECT_NEAR(optics.window->water_index, 1.341671, 1e-6);

    const Beam glass = beam_of("fwhm_deg = 90\nmeasured_in = \"air\"\nwindow = \"bk7\"");
    EXPECT_NEAR(glass.window->glass_index, 1.51852, 1e-5);  // Schott's own n at 546 nm is 1.51872
    EXPECT_FALSE(beam_of("fwhm_deg = 90\nmeasured_in = \"water\"").window);
}

TEST(RigReader, ReadsABeamsTableBesideIt) {
    const TempFolder folder;
    write_file(folder.path() / "lamp.csv", "theta_deg,intensity\n0,4\n30,2\n60,0\n");
    const std::string rig = with(12, "table = \"lamp.csv\"");
    const Rig read = parse_rig(rig, "rig.toml", folder.path());
    const BeamTable& table = std::get<BeamTable>(read.strobes[0].beam.pattern);
    EXPECT_EQ(table.angles, TableAngles::TypeC);
    EXPECT_EQ(table.intensity, (std::vector<double>{0.5, 0.25, 0.0}));  // only the shape counts
    ASSERT_EQ(read.files.size(), 1U);
    EXPECT_EQ(read.files[0].name, "lamp.csv");
    // What it holds counts in the digest.
    write_file(folder.path() / "lamp.csv", "theta_deg,intensity\n0,4\n30,3\n60,0\n");
    EXPECT_NE(parse_rig(rig, "rig.toml", folder.path()).digest, read.digest);

    write_file(folder.path() / "dark.csv", "theta_deg,intensity\n0,0\n30,0\n60,0\n");
    EXPECT_EQ(error_of(with(12, "table = \"dark.csv\""), folder.path()),
              "rig.toml:12: beam.wide.table: found 'dark.csv'; allowed: one with light in it");
    EXPECT_TRUE(error_of(with(12, "table = \"none.ies\""), folder.path())
                    .starts_with("rig.toml:12: beam.wide.table: "));
    EXPECT_EQ(
        error_of(with(12, "table = \"lamp.txt\""), folder.path()),
        "rig.toml:12: beam.wide.table: found 'lamp.txt'; allowed: the name of a .ies, .ldt or "
        ".csv file beside the rig");
}

TEST(RigReader, ChecksBeamsOfOtherKinds) {
    const std::string kind =
        "found beside another kind of beam; allowed: one of cones, fwhm_deg, table, or diffuser_mm "
        "with its lens";
    const std::string optics =
        "diffuser_mm = [30, 60]\nfocal_length_mm = 65\ndistance_mm = 40\naperture_mm = 80";
    struct Bad {
        int line;
        std::string text;
        std::string message;
    };
    const std::vector<Bad> all{
        {12, "cones = []\nfwhm_deg = 90", "beam.wide.cones: " + kind},
        {13, "table = \"a.ies\"\ndiffuser_mm = [1, 1]", "beam.wide.diffuser_mm: " + kind},
        {12, "fwhm_deg = 180", "beam.wide.fwhm_deg: found 180; allowed: a number from 1 to 179.9"},
        {13,
         "fwhm_deg = 90\nturn_deg = 10",
         "beam.wide.turn_deg: found for a beam that is round; allowed: for table and diffuser_mm"},
        {13,
         "fwhm_deg = 90\nwindow = \"bk7\"",
         "beam.wide.window: found for a beam in water; allowed: with measured_in = \"air\""},
        {14,
         "fwhm_deg = 90\nmeasured_in = \"air\"\nwindow = true",
         "beam.wide.window: found true; allowed: a built-in glass or its index, 1 to 3"},
        {13,
         "fwhm_deg = 90\nweights = \"flux\"",
         "beam.wide.weights: found for a beam without cones; allowed: for cones"},
        {12,
         "cones = [{ part = \"a\", half_angle_deg = 30, weight = 1, edge_deg = 31 }]",
         "beam.wide.cones[0].edge_deg: found 31; allowed: up to half_angle_deg, where the cone "
         "ends"},
        {12, "tabel = \"lamp.ies\"", "beam.wide.tabel: is not a known key; did you mean 'table'?"},
        {11, "diffuser_mm = [30, 60]", "beam.wide.focal_length_mm: is missing; allowed: "},
        {13,
         "diffuser_mm = [30, 60]\nfocal_length_mm = 0.04",
         "beam.wide.focal_length_mm: found 0.04; allowed: a number from 0.05 to 100000"},
    };
    for (const Bad& bad : all) {
        const std::string found = error_of(with(12, bad.text));
        EXPECT_TRUE(found.starts_with(fmt::format("rig.toml:{}: {}", bad.line, bad.message)))
            << found;
    }
    EXPECT_EQ(error_of(with(12, optics)), "no error");
}

// The table's own flux at power 1, by hand: a triangle of 300 nm at its base.
TEST(RigReader, ALampsFluxIsItsPower) {
    const TempFolder folder;
    write_file(folder.path() / "lamp.csv", "wavelength_nm,relative_power\n400,0\n550,2\n700,0\n");
    const auto power = [&](const std::string& line) {
        return parse_rig(minimal_and("spectrum = \"lamp.csv\"\n" + line), "rig.toml", folder.path())
            .strobes[0]
            .power;
    };
    EXPECT_EQ(power(""), 1.0);
    EXPECT_NEAR(power("radiant_flux_w = 60"), 0.2, kRounding);
    EXPECT_NEAR(power("energy_j = 30"), 0.1, kRounding);
    // Of 555 nm, a lumen is 1/683 W; this lamp is broader, so its lumens are fewer.
    const double per_lumen = power("luminous_flux_lm = 683");
    EXPECT_GT(per_lumen * 300.0, 1.0);
    EXPECT_LT(per_lumen * 300.0, 2.5);
    EXPECT_EQ(error_of(minimal_and("power = 2\nenergy_j = 3")),
              "rig.toml:19: strobe[0].energy_j: found beside power; allowed: one of power, "
              "luminous_flux_lm, radiant_flux_w, energy_j");
    EXPECT_EQ(error_of(minimal_and("radiant_flux_w = -1")),
              "rig.toml:18: strobe[0].radiant_flux_w: found -1; allowed: a number from 0 to "
              "1000000000000");
}

TEST(RigReader, ChecksConesInTheirArray) {
    expect_errors({
        {12,
         "cones = [{ part = \"all\", half_angle_deg = 91, weight = 1 }]",
         "beam.wide.cones[0].half_angle_deg: found 91; allowed: a number from 0.001 to 90"},
        {12,
         "cones = [{ part = \"all\", half_angle_deg = 90, weight = -1 }]",
         "beam.wide.cones[0].weight: found -1; allowed: a number from 0 to 1000000000000"},
        {12,
         "cones = [{ part = \"all\", half_angle_deg = 90, weight = 1, exponent = 1001 }]",
         "beam.wide.cones[0].exponent: found 1001; allowed: a number from 0 to 1000"},
        {12,
         "cones = [{ half_angle_deg = 90, weight = 1 }]",
         "beam.wide.cones[0].part: is missing; allowed: a name in quotes"},
        {12,
         "cones = []",
         "beam.wide.cones: found []; allowed: an array of { part, half_angle_deg, weight }"},
        {12,
         "cones = [1]",
         "beam.wide.cones: found [1]; allowed: an array of { part, half_angle_deg, weight }"},
    });
}

TEST(RigReader, ChecksWords) {
    expect_errors({
        {12,
         "weights = \"fluxx\"",
         "beam.wide.weights: found 'fluxx'; allowed: \"flux\" or \"literal\""},
        {12, "weights = 1", "beam.wide.weights: found 1; allowed: \"flux\" or \"literal\""},
        {14, "name = 7", "strobe[0].name: found 7; allowed: a name in quotes"},
        {16,
         "aim = { tilt_deg = 26, toward = \"bow\" }",
         "strobe[0].aim.toward: found 'bow'; allowed: \"axis\""},
        {16,
         "aim = { tilt_deg = 181, toward = \"axis\" }",
         "strobe[0].aim.tilt_deg: found 181; allowed: a number from 0 to 180"},
    });
    EXPECT_EQ(error_of("title = 7\n" + std::string(kMinimal)),
              "rig.toml:1: title: found 7; allowed: a text in quotes");
}

// --- Missing, unknown, misspelt --------------------------------------------------------------

// The line is that of the table which lacks the key.
TEST(RigReader, NamesEveryKeyThatIsMissing) {
    const auto missing = [](int line, int table_line, const std::string& key) {
        const std::string message = error_of(with(line, ""));
        EXPECT_TRUE(message.starts_with("rig.toml:" + std::to_string(table_line) + ": " + key +
                                        ": is missing; allowed: "))
            << message;
    };
    missing(2, 1, "sled.altitude_m");
    missing(4, 3, "camera.resolution");
    missing(5, 3, "camera.pixel_pitch_um");
    missing(6, 3, "camera.focal_length_mm");
    missing(8, 3, "camera.response");
    missing(9, 1, "water");
    missing(10, 1, "seafloor");
    missing(12, 11, "beam.wide.cones");
    missing(14, 13, "strobe[0].name");
    missing(15, 13, "strobe[0].position_m");
    missing(17, 13, "strobe[0].beam");
    EXPECT_EQ(error_of(""), "rig.toml:1: sled: is missing; allowed: a table [sled]");
    EXPECT_EQ(error_of(with(2, "")),
              "rig.toml:1: sled.altitude_m: is missing; allowed: a number from 0.001 to 10000");
}

TEST(RigReader, NamesMissingTablesOfLists) {
    const std::string no_strobe(kMinimal.substr(0, kMinimal.find("[[strobe]]")));
    EXPECT_EQ(error_of(no_strobe),
              "rig.toml:1: strobe: is missing; allowed: one or more tables [[strobe]]");
    EXPECT_EQ(error_of("strobe = 7\n" + no_strobe),
              "rig.toml:1: strobe: found 7; allowed: one or more tables [[strobe]]");
    EXPECT_EQ(error_of("strobe = []\n" + no_strobe),
              "rig.toml:1: strobe: found []; allowed: one or more tables [[strobe]]");
    EXPECT_EQ(error_of(with(12, "[beam.x]")),
              "rig.toml:11: beam.wide.cones: is missing; allowed: an array of { part, "
              "half_angle_deg, weight }");
    EXPECT_EQ(error_of("sled = 7\n" + std::string(kMinimal.substr(kMinimal.find("[camera]")))),
              "rig.toml:1: sled: found 7; allowed: a table [sled]");
}

TEST(RigReader, UnknownKeyNamesTheNearest) {
    EXPECT_EQ(
        error_of("tittle = \"x\"\n" + std::string(kMinimal)),
        "rig.toml:1: tittle: is not a known key; did you mean 'title'? Known here: title, sled, "
        "camera, water, seafloor, beam, strobe, materials, object, scene");
    EXPECT_EQ(error_of(with(2, "altitude_m = 2\nrol_deg = 1")),
              "rig.toml:3: sled.rol_deg: is not a known key; did you mean 'roll_deg'? Known here: "
              "altitude_offset_m, altitude_is, altitude_m, pitch_deg, roll_deg");
    EXPECT_EQ(
        error_of(with(9, "[water]\nsalinity_ppt = 35")),
        "rig.toml:10: water.salinity_ppt: is not a known key; did you mean 'salinity_psu'? Known "
        "here: type, chlorophyll_mg_m3, absorption, scattering, attenuation, multiple, "
        "uniform_loss_per_m, salinity_psu, temperature_c, cdom_440_per_m, particles, phase");
    EXPECT_EQ(
        error_of(with(10, "[seafloor]\nphong_sice = 35")),
        "rig.toml:11: seafloor.phong_sice: is not a known key; did you mean 'phong_size'? Known "
        "here: reflectance, phong, phong_size");
}

TEST(RigReader, UnknownKeysAreFoundInEveryTable) {
    struct Unknown {
        int line;
        std::string text;
        std::string start;
    };
    for (const Unknown& unknown : {
             Unknown{
                 8,
                 "response = \"nikon-d5100\"\nrange_mm = 1",
                 "9: camera.range_mm: is not a known key; did you mean 'range_nm'? Known here: "},
             {9,
              std::string(kPort) + "shap = 1\n[water]",
              "14: camera.port.shap: is not a known key; did you mean 'shape'? Known here: "},
             {11,
              "[beam.wide]\nweight = \"flux\"",
              "12: beam.wide.weight: is not a known key; did you mean 'weights'? Known here: "},
             {17,
              "beam = \"wide\"\npwer = 1",
              "18: strobe[0].pwer: is not a known key; did you mean 'power'? Known here: "},
             {16,
              "aim = { tilt_deg = 1, toward = \"axis\", towards = 1 }",
              "16: strobe[0].aim.towards: is not a known key; did you mean 'toward'? Known here: "
              "tilt_deg, toward"},
             {12,
              "cones = [{ part = \"x\", half_angle_deg = 9, weight = 1, weigt = 2 }]",
              "12: beam.wide.cones[0].weigt: is not a known key; did you mean 'weight'? Known "
              "here: "
              "part, half_angle_deg, weight"},
         }) {
        const std::string message = error_of(with(unknown.line, unknown.text));
        EXPECT_TRUE(message.starts_with("rig.toml:" + unknown.start)) << message;
    }
}

TEST(RigReader, UnknownKeyFarFromAllListsTheKnown) {
    EXPECT_EQ(error_of(with(2, "altitude_m = 2\nxyzzy = 1")),
              "rig.toml:3: sled.xyzzy: is not a known key. Known here: altitude_offset_m, "
              "altitude_is, altitude_m, pitch_deg, roll_deg");
}

// The slip of the pen that is made most: a key that must be there, misspelt.
TEST(RigReader, MisspeltRequiredKeyIsNamed) {
    EXPECT_EQ(error_of(with(2, "altitud_m = 2")),
              "rig.toml:2: sled.altitud_m: is not a known key; did you mean 'altitude_m'?");
    EXPECT_EQ(error_of(with(1, "[sledd]")),
              "rig.toml:1: sledd: is not a known key; did you mean 'sled'?");
    EXPECT_EQ(
        error_of(with(16, "aim = { tilt_de = 26, toward = \"axis\" }")),
        "rig.toml:16: strobe[0].aim.tilt_de: is not a known key; did you mean 'tilt_deg'? Known "
        "here: tilt_deg, toward");
}

TEST(RigReader, UnknownBeamNamesTheBeamsThereAre) {
    EXPECT_EQ(error_of(with(17, "beam = \"narrow\"")),
              "rig.toml:17: strobe[0].beam: found 'narrow'; allowed: \"wide\"");
    const std::string two = with(11,
                                 "[beam.fresnel]\ncones = [{ part = \"x\", half_angle_deg = 9, "
                                 "weight = 1 }]\n[beam.wide]");
    std::string text = two;
    text.replace(text.find("beam = \"wide\""), 13, "beam = \"fresnell\"");
    EXPECT_EQ(error_of(text),
              "rig.toml:19: strobe[0].beam: found 'fresnell'; allowed: \"fresnel\" or \"wide\"");
    EXPECT_EQ(error_of(two), "no error") << "a beam that no strobe uses";
}

TEST(RigReader, EveryStrobeHasItsOwnName) {
    const std::string strobe = std::string(kMinimal.substr(kMinimal.find("[[strobe]]")));
    EXPECT_EQ(error_of(minimal_and(strobe)),
              "rig.toml:19: strobe[1].name: found 'fore'; allowed: a name that no other strobe "
              "has");
}

// --- Strobes stand above the floor -----------------------------------------------------------

TEST(RigReader, StrobesStandAboveTheFloor) {
    const std::string allowed = "; allowed: a point at least 0.001 m above the sea floor";
    EXPECT_EQ(error_of(with(15, "position_m = [0.5, 0, 2.4995]")),
              "rig.toml:15: strobe[0].position_m: found [0.5, 0, 2.4995]" + allowed);
    EXPECT_EQ(error_of(with(15, "position_m = [0.5, 0, 2.498]")), "no error");
}

// Bow up by 45 degrees: the floor is at z = 2.5 + x, so 0.5 m aft it is at 2.0.
TEST(RigReader, TheFloorIsTiltedWithTheSled) {
    std::string text = with(2, "altitude_m = 2.5\npitch_deg = 45");
    const std::string position = "position_m = [0.5, 0, 0]";
    text.replace(text.find(position), position.size(), "position_m = [-0.5, 0, 2.1]");
    EXPECT_TRUE(error_of(text).starts_with("rig.toml:16: strobe[0].position_m: found ["))
        << error_of(text);
    text.replace(text.find("[-0.5, 0, 2.1]"), 14, "[0.5, 0, 2.9]");
    EXPECT_EQ(error_of(text), "no error");
}

// --- Tables ----------------------------------------------------------------------------------

constexpr const char* kRgb =
    "wavelength_nm,red,green,blue\n400,0.5,0.25,0.125\n700,0.5,0.25,0.125\n";

TEST(RigReader, RangeThatTablesDoNotCoverNamesThemAndTheRangeThatWouldDo) {
    EXPECT_EQ(error_of(with(7, "range_nm = [390, 750]")),
              "rig.toml:7: camera.range_nm: water absorption 'pope-fry-1997' covers 380 to 727.5 "
              "nm, which "
              "leaves 727.5 to 750 nm of the range 390 to 750 nm without a value; range_nm = "
              "[390, 727.5] would do");
    const std::string both = error_of(with(7, "range_nm = [350, 750]"));
    for (const char* part : {"water absorption 'pope-fry-1997' covers 380 to 727.5 nm",
                             "lamp spectrum 'xenon-flash' covers 380 to 780 nm",
                             "sensor response 'nikon-d5100' (red) covers 380 to 780 nm",
                             "range_nm = [380, 727.5] would do"}) {
        EXPECT_NE(both.find(part), std::string::npos) << part << "\nin " << both;
    }
}

// The range of the response, when none is given, may be more than the water's table covers.
TEST(RigReader, RangeThatIsLeftOutIsNamedToo) {
    const std::string message = error_of(with(7, ""));
    EXPECT_TRUE(
        message.starts_with("rig.toml:3: camera.range_nm: water absorption "
                            "'pope-fry-1997' covers 380 to 727.5 nm"))
        << message;
    EXPECT_TRUE(message.ends_with("range_nm = [380, 727.5] would do")) << message;
}

TEST(RigReader, WaterThatAbsorbsNothingNeedsNoTable) {
    std::string text = with(7, "range_nm = [390, 750]");
    text.replace(text.find("[water]"), 7, "[water]\nmultiple = 0");
    EXPECT_EQ(error_of(text), "no error");
}

TEST(RigReader, GlassMustCoverTheRange) {
    std::string text = with(9, std::string(kPort) + "[water]");
    text.replace(text.find("bk7"), 3, "pmma");  // from 420 nm
    EXPECT_EQ(error_of(text),
              "rig.toml:7: camera.range_nm: refractive index of 'pmma' covers 420 to 1620 nm, "
              "which leaves "
              "400 to 420 nm of the range 400 to 700 nm without a value; range_nm = [420, 700] "
              "would do");
    text.replace(text.find("[400, 700]"), 10, "[420, 700]");
    EXPECT_EQ(error_of(text), "no error");
}

TEST(RigReader, ChecksThePort) {
    const auto port = [](std::string_view found, std::string_view instead) {
        std::string text = with(9, std::string(kPort) + "[water]");
        text.replace(text.find(found), found.size(), instead);
        return error_of(text);
    };
    EXPECT_EQ(port("shape = \"flat\"", "shape = \"round\""),
              "rig.toml:10: camera.port.shape: found 'round'; allowed: \"flat\" or \"dome\"");
    EXPECT_EQ(port("distance_mm", "normal = [2, 0, 1]\ndistance_mm"),
              "rig.toml:11: camera.port.normal: found [2, 0, 1]; allowed: a direction within 60 "
              "degrees of the camera's axis, [0, 0, 1]");
    const auto dome = [&](const std::string& centre) {
        return port("shape = \"flat\"\ndistance_mm = 50.0",
                    "shape = \"dome\"\nradius_mm = 50.0\n" + centre);
    };
    EXPECT_EQ(dome(""), "no error");
    EXPECT_EQ(dome("centre_mm = [0, 0, 49]"), "no error");
    EXPECT_EQ(dome("centre_mm = [0, 40, 30]"),
              "rig.toml:12: camera.port.centre_mm: found [0, 40, 30]; allowed: the pupil, [0, 0, "
              "0], within radius_mm of the centre");
    EXPECT_EQ(port("50.0", "0"),
              "rig.toml:11: camera.port.distance_mm: found 0; allowed: a number from 1 to 10000");
    EXPECT_EQ(port("12.0", "0.5"),
              "rig.toml:12: camera.port.thickness_mm: found 0.5; allowed: a number from 1 to 1000");
    EXPECT_EQ(port("\"bk7\"", "\"ice\""),
              "rig.toml:13: camera.port.glass: no built-in glass is called 'ice'; allowed: bk7, "
              "fused-silica, pmma, polycarbonate, sapphire");
    EXPECT_EQ(port("\"bk7\"", "7"),
              "rig.toml:13: camera.port.glass: found 7; allowed: a built-in glass");
}

TEST(RigReader, UnknownTableNamesTheNearest) {
    const std::string message = error_of(with(10, "[seafloor]\nreflectance = \"sandd\""));
    EXPECT_TRUE(
        message.starts_with("rig.toml:11: seafloor.reflectance: no built-in table is "
                            "called 'sandd'; did you mean 'sand'?"))
        << message;
}

TEST(RigReader, ATableOfAnotherRoleIsRefused) {
    const std::string message = error_of(with(10, "[seafloor]\nreflectance = \"nikon-d5100\""));
    EXPECT_TRUE(
        message.starts_with("rig.toml:11: seafloor.reflectance: 'nikon-d5100' is a built-in table "
                            "of role sensor response, not reflectance; allowed: "))
        << message;
}

TEST(RigReader, ReadsUserTablesBesideTheRig) {
    const TempFolder folder;
    write_file(folder.path() / "mud.csv", "wavelength_nm,reflectance\n400,0.25\n700,0.75\n");
    write_file(folder.path() / "rgb.csv", kRgb);
    std::string text = with(10, "[seafloor]\nreflectance = \"mud.csv\"");
    text.replace(text.find("\"nikon-d5100\""), 13, "{ table = \"rgb.csv\", kind = \"energy\" }");
    write_file(folder.path() / "rig.toml", text);
    const Rig rig = read_rig(folder.path() / "rig.toml");
    EXPECT_EQ(rig.seafloor.reflectance.at(550.0), 0.5);
    EXPECT_EQ(rig.camera.sensor.response(0, 550.0), 0.5);
    EXPECT_EQ(rig.camera.sensor.response(2, 550.0), 0.125);
}

TEST(RigReader, ReadsMaterialsByNameAndFromFiles) {
    const TempFolder folder;
    write_file(folder.path() / "mud.csv", "wavelength_nm,reflectance\n400,0.25\n700,0.75\n");
    const std::string text =
        "materials = [\"red-algae\", \"mud.csv\", \"sand\"]\n" + std::string(kMinimal);
    const Rig rig = parse_rig(text, "rig.toml", folder.path());
    ASSERT_EQ(rig.materials.size(), 3U);
    EXPECT_EQ(rig.materials[0].name(), "reflectance 'red-algae'");
    EXPECT_EQ(rig.materials[1].at(550.0), 0.5);
    EXPECT_EQ(rig.materials[2].name(), "reflectance 'sand'");
    EXPECT_TRUE(parse("materials = []\n" + std::string(kMinimal)).materials.empty());
}

TEST(RigReader, ReadsTheSceneBesideTheRig) {
    EXPECT_TRUE(parse(std::string(kMinimal)).scene.empty());
    const TempFolder folder;
    write_file(folder.path() / "reef.pov", "");
    const std::string text = "scene = \"reef.pov\"\n" + std::string(kMinimal);
    EXPECT_EQ(parse_rig(text, "rig.toml", folder.path()).scene, folder.path() / "reef.pov");
    EXPECT_EQ(error_of("scene = \"none.pov\"\n" + std::string(kMinimal)),
              "rig.toml:1: scene: ./none.pov: cannot be read: No such file or directory");
    EXPECT_EQ(error_of("scene = 7\n" + std::string(kMinimal)),
              "rig.toml:1: scene: found 7; allowed: a POV-Ray scene beside the rig");
}

TEST(RigReader, ChecksMaterials) {
    const auto message = [](std::string_view materials) {
        return error_of("materials = " + std::string(materials) + "\n" + std::string(kMinimal));
    };
    const std::string allowed =
        "; allowed: an array of built-in reflectances (aphotic data) or .csv files beside the rig";
    EXPECT_EQ(message("\"sand\""), "rig.toml:1: materials: found 'sand'" + allowed);
    EXPECT_EQ(message("7"), "rig.toml:1: materials: found 7" + allowed);
    EXPECT_EQ(message("[\"sand\", 7]"), "rig.toml:1: materials: found ['sand', 7]" + allowed);
    EXPECT_EQ(message("[[\"sand\"]]"), "rig.toml:1: materials: found [['sand']]" + allowed);
    for (const auto& [materials, start] : {
             std::pair{"[\"sand\", \"green-algea\"]",
                       "no built-in table is called 'green-algea'; did you mean 'green-algae'?"},
             {"[\"xenon-arc\"]",
              "'xenon-arc' is a built-in table of role lamp spectrum, not reflectance; allowed: "},
             {"[\"nowhere.csv\"]", "./nowhere.csv: cannot be read: No such file or directory"},
         }) {
        const std::string found = message(materials);
        EXPECT_TRUE(found.starts_with("rig.toml:1: materials: " + std::string(start))) << found;
    }
}

TEST(RigReader, MaterialsMustCoverTheRange) {
    const TempFolder folder;
    write_file(folder.path() / "mud.csv", "wavelength_nm,reflectance\n450,0.25\n690,0.75\n");
    const std::string message =
        error_of("materials = [\"mud.csv\"]\n" + std::string(kMinimal), folder.path());
    EXPECT_TRUE(message.starts_with("rig.toml:8: camera.range_nm: ")) << message;
    EXPECT_NE(message.find("mud.csv"), std::string::npos) << message;
    EXPECT_NE(message.find(" covers 450 to 690 nm, which leaves 400 to 450 nm"), std::string::npos)
        << message;
    EXPECT_TRUE(message.ends_with("range_nm = [450, 690] would do")) << message;
}

// lambda / (h c) photons per joule, with the exact h and c of the SI.
TEST(RigReader, AQuantumResponseCountsPhotons) {
    const TempFolder folder;
    write_file(folder.path() / "rgb.csv", kRgb);
    write_file(folder.path() / "ccd.csv", "wavelength_nm,quantum_efficiency\n400,0.5\n700,0.5\n");
    const double per_joule = 550e-9 / (6.62607015e-34 * 299792458.0);
    constexpr double kFewRoundings = 1e-14;
    const Rig table = parse_rig(
        with(8, "response = { table = \"rgb.csv\", kind = \"quantum\" }"), "r", folder.path());
    EXPECT_NEAR(table.camera.sensor.response(1, 550.0) / (0.25 * per_joule), 1.0, kFewRoundings);
    const Rig filtered =
        parse_rig(with(8, "response = { filters = \"rgb.csv\", quantum_efficiency = \"ccd.csv\" }"),
                  "r",
                  folder.path());
    EXPECT_NEAR(
        filtered.camera.sensor.response(1, 550.0) / (0.125 * per_joule), 1.0, kFewRoundings);
}

TEST(RigReader, AMonoCameraHasOneResponse) {
    const TempFolder folder;
    write_file(folder.path() / "ccd.csv", "wavelength_nm,quantum_efficiency\n400,0.5\n700,0.5\n");
    const std::string mono = "response = { quantum_efficiency = \"ccd.csv\" }";
    const Camera camera = parse_rig(with(8, mono), "r", folder.path()).camera;
    EXPECT_TRUE(camera.sensor.is_mono());
    EXPECT_EQ(camera.readout.bayer, "mono");
    for (const int channel : {1, 2})
        EXPECT_EQ(camera.sensor.response(channel, 550.0), camera.sensor.response(0, 550.0));
    EXPECT_FALSE(parse(kMinimal).camera.sensor.is_mono());
    EXPECT_EQ(
        error_of(with(8, mono + "\nbayer = \"RGGB\""), folder.path()),
        "rig.toml:9: camera.bayer: found 'RGGB'; allowed: \"mono\", as the response is of one "
        "channel");
    EXPECT_EQ(error_of(with(8, "response = \"nikon-d5100\"\nbayer = \"mono\"")),
              "rig.toml:9: camera.bayer: found 'mono'; allowed: a pattern of colours, as the "
              "response is of three channels");
}

TEST(RigReader, TellsWhatTheCamerasFilesHold) {
    const auto readout = [](const std::string& more) {
        return parse(with(7, "range_nm = [400, 700]\n" + more)).camera.readout;
    };
    EXPECT_EQ(readout("").bayer, "");
    EXPECT_EQ(readout("").black_level_dn, std::nullopt);
    const Readout all = readout(
        "bayer = \"GRBG\"\nblack_level_dn = 64\nwhite_level_dn = 4095\nexposure_ms = 2.5\n"
        "iso = 400\nf_number = 5.6\ngain_dn_per_e = 0.25\nread_noise_e = 8\nsaturation_e = 15000");
    EXPECT_EQ(all.bayer, "GRBG");
    EXPECT_EQ(all.black_level_dn, 64.0);
    EXPECT_EQ(all.white_level_dn, 4095.0);
    EXPECT_EQ(all.exposure_ms, 2.5);
    EXPECT_EQ(all.iso, 400.0);
    EXPECT_EQ(all.f_number, 5.6);
    EXPECT_EQ(all.gain_dn_per_e, 0.25);
    EXPECT_EQ(all.read_noise_e, 8.0);
    EXPECT_EQ(all.saturation_e, 15000.0);
    const auto refused = [](const std::string& line, const std::string& words) {
        EXPECT_EQ(error_of(with(7, "range_nm = [400, 700]\n" + line)),
                  "rig.toml:8: camera." + words);
    };
    refused("black_level_dn = -1",
            "black_level_dn: found -1; allowed: a number from 0 to 1000000000");
    refused("white_level_dn = 60\nblack_level_dn = 64",
            "white_level_dn: found 60; allowed: a number over black_level_dn");
    refused("exposure_ms = 0", "exposure_ms: found 0; allowed: a number from 0.0001 to 1000000");
    refused("iso = 0", "iso: found 0; allowed: a number from 0.1 to 10000000");
    refused("f_number = \"2.8\"", "f_number: found '2.8'; allowed: a number from 0.1 to 1000");
    refused("gain_dn_per_e = 0", "gain_dn_per_e: found 0; allowed: a number from 1e-06 to 1000000");
    refused("read_noise_e = -1", "read_noise_e: found -1; allowed: a number from 0 to 1000000");
    refused("saturation_e = 0", "saturation_e: found 0; allowed: a number from 1 to 1000000000");
    refused("bayer = \"RGB\"",
            "bayer: found 'RGB'; allowed: \"RGGB\" or \"BGGR\" or \"GRBG\" or \"GBRG\" or "
            "\"mono\"");
}

TEST(RigReader, AResponseFileMustSayItsKind) {
    const TempFolder folder;
    write_file(folder.path() / "rgb.csv", kRgb);
    const std::string allowed =
        "; allowed: a built-in response's name, { table = \"rgb.csv\", kind = \"energy\" } (or "
        "\"quantum\"), or { filters = \"rgb.csv\", quantum_efficiency = \"ccd.csv\" }, of a mono "
        "camera without filters";
    EXPECT_EQ(error_of(with(8, "response = \"rgb.csv\""), folder.path()),
              "rig.toml:8: camera.response: found 'rgb.csv'" + allowed);
    EXPECT_EQ(error_of(with(8, "response = 7"), folder.path()),
              "rig.toml:8: camera.response: found 7" + allowed);
    EXPECT_EQ(error_of(with(8, "response = { table = \"rgb.csv\" }"), folder.path()),
              "rig.toml:8: camera.response.kind: is missing; allowed: \"energy\" or \"quantum\"");
    EXPECT_EQ(
        error_of(with(8, "response = { table = \"rgb.csv\", kind = \"raw\" }"), folder.path()),
        "rig.toml:8: camera.response.kind: found 'raw'; allowed: \"energy\" or \"quantum\"");
    const std::string unknown = error_of(
        with(8, "response = { table = \"rgb.csv\", kind = \"energy\", kinds = 1 }"), folder.path());
    EXPECT_TRUE(
        unknown.starts_with("rig.toml:8: camera.response.kinds: is not a known key; did you "
                            "mean 'kind'?"))
        << unknown;
    const std::string half =
        error_of(with(8, "response = { filters = \"rgb.csv\" }"), folder.path());
    EXPECT_TRUE(half.starts_with("rig.toml:8: camera.response.quantum_efficiency: is missing; "))
        << half;
}

TEST(RigReader, FaultsInUserTablesNameRigAndTable) {
    const TempFolder folder;
    const fs::path mud = folder.path() / "mud.csv";
    const std::string text = with(10, "[seafloor]\nreflectance = \"mud.csv\"");
    EXPECT_EQ(error_of(text, folder.path()),
              "rig.toml:11: seafloor.reflectance: " + mud.string() +
                  ": cannot be read: No such file or directory");
    write_file(mud, "wavelength_nm,reflectance\n400,0.25\n700,1.5\n");
    EXPECT_EQ(error_of(text, folder.path()),
              "rig.toml:11: seafloor.reflectance: " + mud.string() +
                  ":3: reflectance: found 1.5; allowed: 0 to 1");
}

// --- Files and syntax ------------------------------------------------------------------------

TEST(RigReader, SyntaxErrorsNameTheLine) {
    EXPECT_TRUE(error_of(with(6, "focal_length_mm = ")).starts_with("rig.toml:6: "))
        << error_of(with(6, "focal_length_mm = "));
    EXPECT_TRUE(error_of(with(4, "resolution = [1 2]")).starts_with("rig.toml:4: "))
        << error_of(with(4, "resolution = [1 2]"));
    EXPECT_TRUE(error_of(with(7, "pixel_pitch_um = 1")).starts_with("rig.toml:7: "))
        << "a key that stands twice: " << error_of(with(7, "pixel_pitch_um = 1"));
}

// Counted before anything is made of them: one by one, each held against all others, these would
// take minutes.
TEST(RigReader, RefusesMoreOfAKindThanItsLimit) {
    const auto many = [](const char* form) {
        std::string text;
        for (int i = 0; i < 60'000; ++i) text += fmt::format(fmt::runtime(form), i);
        return text;
    };
    EXPECT_EQ(error_of(minimal_and(many("[beam.b{}]\n"))),
              "rig.toml:11: beam: found 60001; allowed: up to 1024");
    EXPECT_EQ(error_of(minimal_and(many("[[strobe]]\nname = \"{}\"\n"))),
              "rig.toml:13: strobe: found 60001; allowed: up to 1024");
    EXPECT_EQ(error_of(minimal_and(many("[[object]]\nname = \"{}\"\n"))),
              "rig.toml:18: object: found 60000; allowed: up to 1024");
    EXPECT_EQ(error_of("materials = [" + many("\"m{}\",") + "]\n" + std::string(kMinimal)),
              "rig.toml:1: materials: found 60000; allowed: up to 1024");
    EXPECT_EQ(error_of(with(12, "cones = [" + many("{{ part = \"{}\" }},") + "]")),
              "rig.toml:12: beam.wide.cones: found 60000; allowed: up to 1024");
}

TEST(RigReader, RefusesMoreConesOfAllStrobesThanItsLimit) {
    std::string cones;
    for (int i = 0; i < 1000; ++i) cones += "{ part = \"a\", half_angle_deg = 9, weight = 1 }, ";
    std::string strobes;
    for (int i = 0; i < 100; ++i) {
        strobes += fmt::format(
            "[[strobe]]\nname = \"{}\"\nposition_m = [0.5, 0, 0]\ndirection = [0, 0, 1]\n"
            "beam = \"wide\"\n",
            i);
    }
    // With the rig's own strobe, the 101st.
    EXPECT_EQ(error_of(with(12, "cones = [" + cones + "]") + strobes),
              "rig.toml:517: strobe[100].beam: found 'wide'; allowed: up to 100000 cones of all "
              "strobes together");
}

TEST(RigReader, TakesAsManyOfAKindAsItsLimit) {
    std::string text;
    for (int i = 1; i < 1024; ++i) {
        text += fmt::format(
            "[beam.b{0}]\ncones = [{{ part = \"a\", half_angle_deg = 9, weight = 1 }}]\n"
            "[[strobe]]\nname = \"{0}\"\nposition_m = [0.5, 0, 0]\n"
            "direction = [0, 0, 1]\nbeam = \"b{0}\"\n",
            i);
    }
    EXPECT_EQ(parse(minimal_and(text)).strobes.size(), 1024U);
}

// As keys or as a header, such a rig once ran the program out of stack.
TEST(RigReader, RefusesTablesWithinTablesWithoutEnd) {
    std::string key = "a";
    for (int i = 1; i < 50'000; ++i) key += ".a";
    const std::string refusal =
        ": found a key of more than 16 parts with dots between them; allowed: up to 16";
    EXPECT_EQ(error_of("\n" + key + " = 1\n"), "rig.toml:2" + refusal);
    EXPECT_EQ(error_of("[" + key + "]\n"), "rig.toml:1" + refusal);
}

TEST(RigReader, AnUnreadableRigIsNamed) {
    const TempFolder folder;
    const fs::path missing = folder.path() / "rig.toml";
    try {
        static_cast<void>(read_rig(missing));
        FAIL() << "no error";
    } catch (const InputError& error) {
        EXPECT_EQ(error.what(), missing.string() + ": cannot be read: No such file or directory");
    }
    EXPECT_THROW(static_cast<void>(read_rig(folder.path())), InputError);
}

// --- Digest ----------------------------------------------------------------------------------

TEST(RigReader, DigestChangesWithTheTextAndWithUserTables) {
    const TempFolder folder;
    const TempFolder elsewhere;
    const std::string text = with(10, "[seafloor]\nreflectance = \"mud.csv\"");
    const std::string mud = "wavelength_nm,reflectance\n400,0.25\n700,0.75\n";
    const auto digest = [](const fs::path& where, const std::string& rig, const std::string& csv) {
        write_file(where / "mud.csv", csv);
        write_file(where / "rig.toml", rig);
        return read_rig(where / "rig.toml").digest;
    };
    const std::string first = digest(folder.path(), text, mud);
    EXPECT_EQ(first.size(), 64U) << first;
    EXPECT_EQ(digest(folder.path(), text, mud), first) << "nothing has changed";
    EXPECT_EQ(digest(elsewhere.path(), text, mud), first) << "only the folder has changed";
    EXPECT_NE(digest(folder.path(), text, mud + "# note\n"), first) << "the table has changed";
    EXPECT_NE(digest(folder.path(), text + "# note\n", mud), first) << "the rig has changed";
    write_file(folder.path() / "unused.csv", mud);
    EXPECT_EQ(digest(folder.path(), text, mud), first) << "a file that the rig does not name";
}

TEST(RigReader, DigestCountsResponseTables) {
    const TempFolder folder;
    const std::string text =
        with(8, "response = { filters = \"rgb.csv\", quantum_efficiency = \"ccd.csv\" }");
    const std::string ccd = "wavelength_nm,quantum_efficiency\n400,0.5\n700,0.5\n";
    const auto digest = [&](const std::string& rgb, const std::string& efficiency) {
        write_file(folder.path() / "rgb.csv", rgb);
        write_file(folder.path() / "ccd.csv", efficiency);
        return parse_rig(text, "rig.toml", folder.path()).digest;
    };
    const std::string first = digest(kRgb, ccd);
    EXPECT_NE(digest(std::string(kRgb) + "\n", ccd), first);
    EXPECT_NE(digest(kRgb, ccd + "\n"), first);
    EXPECT_EQ(digest(kRgb, ccd), first);
}

TEST(RigReader, DigestCountsMaterials) {
    const TempFolder folder;
    const std::string mud = "wavelength_nm,reflectance\n400,0.25\n700,0.75\n";
    const auto digest = [&](const std::string& materials, const std::string& csv) {
        write_file(folder.path() / "mud.csv", csv);
        return parse_rig(
                   "materials = " + materials + "\n" + std::string(kMinimal), "r", folder.path())
            .digest;
    };
    const std::string first = digest("[\"sand\", \"mud.csv\"]", mud);
    EXPECT_EQ(digest("[\"sand\", \"mud.csv\"]", mud), first);
    EXPECT_NE(digest("[\"sand\", \"mud.csv\"]", mud + "\n"), first);
    EXPECT_NE(digest("[\"sand\"]", mud), first);
}

// --- Objects ---------------------------------------------------------------------------------

constexpr std::string_view kBall =
    "[[object]]\n"
    "name = \"ball\"\n"
    "shape = \"sphere\"\n"
    "centre_m = [0.1, 0.2, 2]\n"
    "radius_m = 0.25\n"
    "reflectance = \"sand\"\n";

TEST(RigReader, ReadsNoObjectsUnlessThereAreAny) {
    EXPECT_TRUE(parse(kMinimal).objects.empty());
}

TEST(RigReader, ReadsASphereABoxAndAMesh) {
    const TempFolder folder;
    write_file(folder.path() / "rock.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Rig rig = parse_rig(
        minimal_and(std::string(kBall) +
                    "phong = 0.5\nphong_size = 20\n"
                    "[[object]]\nname = \"block\"\nshape = \"box\"\nfrom_m = [0.5, 1, 2]\n"
                    "to_m = [0.25, 2, 1]\nreflectance = \"red-algae\"\n"
                    "[[object]]\nname = \"rock\"\nshape = \"mesh\"\nfile = \"rock.obj\"\n"
                    "position_m = [0.5, 0.25, 2]\nreflectance = \"sand\"\n"),
        "rig.toml",
        folder.path());
    ASSERT_EQ(rig.objects.size(), 3U);
    EXPECT_EQ(rig.objects[0].name, "ball");
    const auto& ball = std::get<Sphere>(rig.objects[0].shape);
    expect_vector(ball.centre_m, {0.1, 0.2, 2.0});
    EXPECT_EQ(ball.radius_m, 0.25);
    EXPECT_EQ(rig.objects[0].phong, 0.5);
    EXPECT_EQ(rig.objects[0].phong_size, 20.0);
    EXPECT_EQ(rig.objects[0].reflectance.name(), "reflectance 'sand'");
    const auto& block = std::get<Box>(rig.objects[1].shape);
    expect_vector(block.least_m, {0.25, 1.0, 1.0});
    expect_vector(block.most_m, {0.5, 2.0, 2.0});
    EXPECT_EQ(rig.objects[1].phong, 0.0);
    EXPECT_EQ(rig.objects[1].phong_size, 40.0);
    const auto& rock = std::get<Mesh>(rig.objects[2].shape);
    expect_vector(rock.vertices_m.at(1), {1.5, 0.25, 2.0});
}

// The minimal rig ends in line 17; the ball's lines are 18 to 23.
TEST(RigReader, TellsWhatIsWrongWithAnObject) {
    const auto ball_with = [](const std::string& from, const std::string& to) {
        std::string text(kBall);
        return minimal_and(text.replace(text.find(from), from.size(), to));
    };
    const std::vector<std::pair<std::string, std::string>> wrong{
        {ball_with("\"sphere\"", "\"cone\""),
         "rig.toml:20: object[0].shape: found 'cone'; allowed: \"sphere\" or \"box\" or \"mesh\""},
        {ball_with("0.25", "0"),
         "rig.toml:22: object[0].radius_m: found 0; allowed: a number from 0.001 to 1000"},
        {ball_with("radius_m", "radius_mm"),
         "rig.toml:22: object[0].radius_mm: is not a known key; did you mean 'radius_m'?"},
        {ball_with("reflectance = \"sand\"", ""),
         "rig.toml:18: object[0].reflectance: is missing; allowed: a built-in table's name "
         "(aphotic data) or a .csv file beside the rig"},
        {ball_with("[0.1, 0.2, 2]", "[0, 0, 0.2]"),
         "rig.toml:21: object[0].centre_m: found the camera's pupil inside the object; allowed: "
         "outside"},
        {ball_with("[0.1, 0.2, 2]", "[0.5, 0.2505, 0]"),
         "rig.toml:21: object[0].centre_m: found strobe 'fore' inside the object or 0.0005 m "
         "off "
         "it; allowed: at least 0.001 m off"},
        {minimal_and(std::string(kBall) + std::string(kBall)),
         "rig.toml:25: object[1].name: found 'ball'; allowed: a name that no other object has"},
        {minimal_and("[[object]]\nname = \"block\"\nshape = \"box\"\nfrom_m = [0, 1, 2]\n"
                     "to_m = [1, 1, 3]\nreflectance = \"sand\"\n"),
         "rig.toml:22: object[0].to_m: found [1, 1, 3]; allowed: a corner at least 0.001 m from "
         "that "
         "of from_m along every axis"},
        {minimal_and("[[object]]\nname = \"rock\"\nshape = \"mesh\"\nfile = \"rock.stl\"\n"
                     "reflectance = \"sand\"\n"),
         "rig.toml:21: object[0].file: found 'rock.stl'; allowed: the name of a Wavefront .obj "
         "file "
         "beside the rig"},
        {minimal_and("[[object]]\nname = \"rock\"\nshape = \"mesh\"\nfile = \"no.obj\"\n"
                     "reflectance = \"sand\"\n"),
         "rig.toml:21: object[0].file: ./no.obj: cannot be read: No such file or directory"}};
    for (const auto& [toml, message] : wrong) EXPECT_EQ(error_of(toml), message);
}

TEST(RigReader, CountsAMeshInTheDigest) {
    const TempFolder folder;
    const auto digest_with = [&](std::string_view obj) {
        write_file(folder.path() / "rock.obj", obj);
        return parse_rig(minimal_and("[[object]]\nname = \"rock\"\nshape = \"mesh\"\n"
                                     "file = \"rock.obj\"\nreflectance = \"sand\"\n"),
                         "rig.toml",
                         folder.path())
            .digest;
    };
    const std::string a = digest_with("v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n");
    EXPECT_NE(a, digest_with("v 0 0 1\nv 1 0 1\nv 0 2 1\nf 1 2 3\n"));
    EXPECT_EQ(a, digest_with("v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n"));
}

// --- Calibrations ------------------------------------------------------------------------------

constexpr std::string_view kCamchain =
    "cam0:\n"
    "  camera_model: pinhole\n"
    "  intrinsics: [2000, 1990, 682.25, 508.5]\n"
    "  distortion_model: radtan\n"
    "  distortion_coeffs: [-0.1, 0.02, 0.001, -0.002]\n"
    "  resolution: [1360, 1024]\n";

constexpr std::string_view kPinhole = "1 SIMPLE_PINHOLE 1360 1024 2000 680 512\n";

constexpr std::string_view kBehindGlass =
    "model: PINHOLE\n"
    "parameters: [2000, 2000, 680, 512]\n"
    "non_svp_model: FLATPORT\n"
    "non_svp_parameters: [0.6, 0, 0.8, 0.02, 0.008, 1, 1.52, 1.34]\n"
    "width: 1360\n"
    "height: 1024\n";

const std::string kByCalibration = with(6, "calibration = \"cam\"");

class CalibratedRig : public testing::Test {
  protected:
    void calibrate(std::string_view text) const {
        write_file(folder_.path() / "cam", std::string(text));
    }
    [[nodiscard]] Rig read(const std::string& toml) const {
        return parse_rig(toml, "rig.toml", folder_.path());
    }
    [[nodiscard]] std::string error(const std::string& toml) const {
        return error_of(toml, folder_.path());
    }

  private:
    TempFolder folder_;
};

TEST_F(CalibratedRig, HasTheLensOfTheFile) {
    calibrate(kCamchain);
    const Rig rig = read(kByCalibration);
    ASSERT_TRUE(rig.camera.lens);
    EXPECT_EQ(*rig.camera.lens, parse_calibration("cam", kCamchain).lens);
    EXPECT_NEAR(rig.camera.pixel_pitch_m, 6.45e-6, kRounding * 6.45e-6);
    EXPECT_NEAR(rig.camera.focal_length_m, 0.0129, kRounding);
    // What it holds counts.
    ASSERT_EQ(rig.files.size(), 1U);
    EXPECT_EQ(rig.files[0].name, "cam");
    std::string other(kCamchain);
    other.replace(other.find("0.001"), 5, "0.002");
    calibrate(other);
    const Rig changed = read(kByCalibration);
    EXPECT_NE(changed.digest, rig.digest);
    EXPECT_NE(geometry_signature(changed), geometry_signature(rig));
}

TEST_F(CalibratedRig, NeedsNeitherResolutionNorPitch) {
    calibrate(kCamchain);
    std::string text = kByCalibration;
    text.erase(text.find("resolution"), std::string_view("resolution = [1360, 1024]").size());
    text.erase(text.find("pixel_pitch_um"), std::string_view("pixel_pitch_um = 6.45").size());
    const Rig rig = read(text);
    EXPECT_EQ(rig.camera.width_px, 1360);
    EXPECT_EQ(rig.camera.height_px, 1024);
    EXPECT_EQ(rig.camera.lens, read(kByCalibration).camera.lens);
    EXPECT_NEAR(rig.camera.focal_length_m / rig.camera.pixel_pitch_m, 2000.0, 1e-9);
}

// So that its images are what they always were, to the bit.
TEST_F(CalibratedRig, OfACentredPinholeHasNoLens) {
    calibrate(kPinhole);
    const Rig rig = read(kByCalibration);
    const Rig plain = read(with(6, "focal_length_mm = 12.9"));
    EXPECT_FALSE(rig.camera.lens);
    EXPECT_EQ(rig.camera.focal_length_m, plain.camera.focal_length_m);
    EXPECT_EQ(geometry_signature(rig), geometry_signature(plain));
}

TEST_F(CalibratedRig, HasThePortOfTheFile) {
    calibrate(kBehindGlass);
    const std::string glass = "[camera.port]\nglass = \"bk7\"\n[water]";
    std::string text = kByCalibration;
    text.replace(text.find("[water]"), 7, glass);
    const Rig rig = read(text);
    ASSERT_TRUE(rig.camera.port);
    // Tilted to the right: to starboard.
    expect_vector(rig.camera.port->normal, {0.0, 0.6, 0.8});
    EXPECT_EQ(rig.camera.port->distance_m, 0.02);
    EXPECT_EQ(rig.camera.port->thickness_m, 0.008);
    EXPECT_EQ(rig.camera.port->glass.name(), "bk7");
    EXPECT_EQ(error(kByCalibration),
              "rig.toml:3: camera.port: is missing; allowed: a table with the glass of the "
              "calibration's port");
    text.replace(text.find("glass"), 5, "distance_mm = 30\nglass");
    EXPECT_EQ(error(text),
              "rig.toml:10: camera.port.distance_mm: found beside a calibration that tells the "
              "port; allowed: glass alone");
    // One that tells of none leaves the port to the rig.
    calibrate(kPinhole);
    text = kByCalibration;
    text.replace(text.find("[water]"), 7, std::string(kPort) + "[water]");
    EXPECT_EQ(read(text).camera.port->distance_m, 0.05);
}

TEST_F(CalibratedRig, TellsWhatIsWrong) {
    calibrate(kCamchain);
    EXPECT_EQ(error(with(6, "focal_length_mm = 12\ncalibration = \"cam\"")),
              "rig.toml:7: camera.calibration: found beside 'focal_length_mm'; allowed: one of "
              "them");
    EXPECT_EQ(error(with(6, "fov_deg = 40\ncalibration = \"cam\"")),
              "rig.toml:7: camera.calibration: found beside 'fov_deg'; allowed: one of them");
    EXPECT_EQ(error(with(6, "calibration = 3")),
              "rig.toml:6: camera.calibration: found 3; allowed: the name of a camera calibration "
              "beside the rig");
    EXPECT_TRUE(error(with(6, "calibration = \"none.yaml\""))
                    .starts_with("rig.toml:6: camera.calibration: "));
    std::string text = kByCalibration;
    text.replace(text.find("1360, 1024"), 10, "680, 512");
    EXPECT_EQ(error(text),
              "rig.toml:4: camera.resolution: found [680, 512]; allowed: [1360, 1024], that of the "
              "calibration");
    calibrate("cam0: [");
    EXPECT_EQ(error(kByCalibration),
              "rig.toml:6: camera.calibration: cam:1: is not YAML: end of sequence flow not found");
    // r - r^3 ends at r = 1/sqrt(3), 30 degrees off the axis; a corner is at 0.77 focal lengths.
    calibrate("1 SIMPLE_RADIAL 1360 1024 1100 680 512 -1\n");
    EXPECT_TRUE(error(kByCalibration)
                    .starts_with("rig.toml:6: camera.calibration: cam: the lens's formula holds to "
                                 "29.9"))
        << error(kByCalibration);
}

// --- Hostile rigs ----------------------------------------------------------------------------

// Each key of a number, with what is no number that a rig may hold.
TEST(RigReader, RefusesNumbersThatAreNone) {
    for (const std::string number : {"nan",
                                     "-nan",
                                     "inf",
                                     "-inf",
                                     "9223372036854775807",
                                     "-9223372036854775808",
                                     "1979-05-27",
                                     "1979-05-27T07:32:00Z",
                                     "07:32:00",
                                     "true",
                                     "\"2\"",
                                     "[2]",
                                     "{}"}) {
        const std::string message = error_of(with(2, "altitude_m = " + number));
        EXPECT_TRUE(message.starts_with("rig.toml:2: sled.altitude_m: found ")) << message;
        EXPECT_TRUE(message.ends_with("; allowed: a number from 0.001 to 10000")) << message;
    }
    // No double and no 64-bit integer holds these: TOML itself has no such number.
    for (const std::string number : {"1e400",
                                     "99999999999999999999",
                                     "0x1FFFFFFFFFFFFFFFF",
                                     "0x",
                                     "1__0",
                                     "2,5",
                                     "02",
                                     ".5",
                                     "5."}) {
        const std::string message = error_of(with(2, "altitude_m = " + number));
        EXPECT_TRUE(message.starts_with("rig.toml:2: ")) << number << ": " << message;
    }
}

TEST(RigReader, UnderstandsEveryNumberOfTomlExactly) {
    const auto altitude_m = [](const std::string& number) {
        return parse(with(2, "altitude_m = " + number)).sled.altitude_m;
    };
    EXPECT_EQ(altitude_m("0x10"), 16.0);
    EXPECT_EQ(altitude_m("0o17"), 15.0);
    EXPECT_EQ(altitude_m("0b101"), 5.0);
    EXPECT_EQ(altitude_m("1_0.0_1"), 10.01);
    EXPECT_EQ(altitude_m("+2.5e-1"), 0.25);
    EXPECT_EQ(parse(with(2, "altitude_m = 2\npitch_deg = -0.0")).sled.pitch_rad, 0.0);
    EXPECT_EQ(parse(with(9, "[water]\nmultiple = -0.0")).water.attenuation_per_m(550.0), 0.0);
    EXPECT_NE(error_of(with(2, "altitude_m = -0.0")), "no error");
    EXPECT_NE(error_of(with(2, "altitude_m = 1e-400")), "no error") << "it is not 0";
}

// Every text of a rig, by the line of the rig that holds it. ESC would steer a terminal, a line's
// end would begin a line of its own in scenes and settings, and NUL would end a file's name.
TEST(RigReader, RefusesControlCharactersInEveryText) {
    for (const std::string bad :
         {"\\n", "\\u001b", "\\u0000", "\\r", "\\t", "\\u007f", "\\u009b"}) {
        const std::vector<std::pair<std::string, std::string>> rigs{
            {"title = \"a" + bad + "\"\n" + std::string(kMinimal), "rig.toml:1: title: "},
            {"scene = \"a" + bad + "\"\n" + std::string(kMinimal), "rig.toml:1: scene: "},
            {"materials = [\"a" + bad + ".csv\"]\n" + std::string(kMinimal),
             "rig.toml:1: materials: "},
            {with(14, "name = \"a" + bad + "\""), "rig.toml:14: strobe[0].name: "},
            {with(12, "cones = [{ part = \"a" + bad + "\", half_angle_deg = 90, weight = 1 }]"),
             "rig.toml:12: beam.wide.cones[0].part: "},
            {with(11, "[beam.\"a" + bad + "\"]"), "rig.toml:11: beam.a\\x"},
            {with(10, "[seafloor]\nreflectance = \"a" + bad + ".csv\""),
             "rig.toml:11: seafloor.reflectance: "},
            {minimal_and("[[object]]\nname = \"a" + bad + "\""), "rig.toml:19: object[0].name: "}};
        for (const auto& [rig, place] : rigs) {
            const std::string message = error_of(rig);
            EXPECT_TRUE(message.starts_with(place)) << message;
            EXPECT_NE(message.find("allowed: a text without control characters"), std::string::npos)
                << message;
            EXPECT_FALSE(has_control_characters(message)) << message;
        }
    }
}

TEST(RigReader, RefusesTextsWithoutEnd) {
    const std::string longest(1000, 'a');
    EXPECT_EQ(parse("title = \"" + longest + "\"\n" + std::string(kMinimal)).title, longest);
    EXPECT_EQ(error_of("title = \"" + longest + "a\"\n" + std::string(kMinimal)),
              "rig.toml:1: title: found a text of 1001 bytes; allowed: up to 1000");
}

TEST(RigReader, KeepsWhatIsOnlyText) {
    const std::string evil = R"(" \ ' */ // /* #include %s {} ${HOME} `id` <script> Köln)";
    const Rig rig = parse("title = '''" + evil + "'''\n" + std::string(kMinimal));
    EXPECT_EQ(rig.title, evil);
}

TEST(RigReader, RefusesBytesThatAreNoUtf8) {
    const std::string message = error_of("title = \"a\xFF\"\n" + std::string(kMinimal));
    EXPECT_TRUE(message.starts_with("rig.toml:1: ")) << message;
    EXPECT_FALSE(has_control_characters(message)) << message;
}

// The rules are those of file_beside.h; here, that no key goes around them.
TEST(RigReader, RefusesEveryFileOutsideItsFolder) {
    const TempFolder folder;
    fs::create_directory(folder.path() / "rig");
    write_file(folder.path() / "t.csv", "wavelength_nm,reflectance\n300,1\n900,1\n");
    write_file(folder.path() / "t.obj", "v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n");
    write_file(folder.path() / "t.pov", "#version 3.7;\n");
    write_file(folder.path() / "rig" / "rgb.csv",
               "wavelength_nm,red,green,blue\n300,1,1,1\n900,1,1,1\n");
    const std::string csv = "\"../t.csv\"";
    const std::string object = "[[object]]\nname = \"a\"\nshape = ";
    const std::vector<std::pair<std::string, std::string>> rigs{
        {"materials = [" + csv + "]\n" + std::string(kMinimal), "rig.toml:1: materials: "},
        {"scene = \"../t.pov\"\n" + std::string(kMinimal), "rig.toml:1: scene: "},
        {with(6, "calibration = \"../t.yaml\""), "rig.toml:6: camera.calibration: "},
        {with(8, "response = { table = " + csv + ", kind = \"energy\" }"),
         "rig.toml:8: camera.response.table: "},
        {with(8, "response = { filters = " + csv + ", quantum_efficiency = \"q.csv\" }"),
         "rig.toml:8: camera.response.filters: "},
        {with(8, "response = { filters = \"rgb.csv\", quantum_efficiency = " + csv + " }"),
         "rig.toml:8: camera.response.quantum_efficiency: "},
        {with(9, "[water]\nabsorption = " + csv), "rig.toml:10: water.absorption: "},
        {with(10, "[seafloor]\nreflectance = " + csv), "rig.toml:11: seafloor.reflectance: "},
        {minimal_and("spectrum = " + csv), "rig.toml:18: strobe[0].spectrum: "},
        {minimal_and(object + "\"mesh\"\nfile = \"../t.obj\"\n"), "rig.toml:21: object[0].file: "},
        {minimal_and(object +
                     "\"sphere\"\ncentre_m = [0, 0, 2]\nradius_m = 0.1\nreflectance = " + csv),
         "rig.toml:23: object[0].reflectance: "}};
    for (const auto& [rig, place] : rigs) {
        const std::string message = error_of(rig, folder.path() / "rig");
        EXPECT_TRUE(message.starts_with(place + "found '../t.")) << message;
        EXPECT_TRUE(message.ends_with("; allowed: a file in the same folder or below it"))
            << message;
    }
}

TEST(RigReader, ReadsARigThatIsReachedThroughALink) {
    const TempFolder folder;
    fs::create_directories(folder.path() / "elsewhere");
    write_file(folder.path() / "elsewhere" / "rig.toml",
               with(10, "[seafloor]\nreflectance = \"mud.csv\""));
    write_file(folder.path() / "mud.csv", "wavelength_nm,reflectance\n300,0.25\n900,0.25\n");
    fs::create_symlink("elsewhere/rig.toml", folder.path() / "link.toml");
    EXPECT_EQ(read_rig(folder.path() / "link.toml").seafloor.reflectance.at(550.0), 0.25)
        << "its tables are beside the link, which is what was named";
}

// The files are holes: they take no place on the disk, and are not read.
TEST(RigReader, RefusesFilesOfAbsurdSizeUnread) {
    const TempFolder folder;
    constexpr std::uintmax_t kTebibyte = std::uintmax_t{1} << 40U;
    for (const char* name : {"rig.toml", "t.csv", "t.obj"}) {
        write_file(folder.path() / name, "");
        fs::resize_file(folder.path() / name, kTebibyte);
    }
    const auto read_error = [](const fs::path& file) {
        try {
            static_cast<void>(read_rig(file));
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    EXPECT_EQ(
        read_error(folder.path() / "rig.toml"),
        (folder.path() / "rig.toml").string() + ": found more than 8 MiB; allowed: 8 MiB or less");
    EXPECT_EQ(error_of(with(10, "[seafloor]\nreflectance = \"t.csv\""), folder.path()),
              "rig.toml:11: seafloor.reflectance: " + (folder.path() / "t.csv").string() +
                  ": found more than 64 MiB; allowed: 64 MiB or less");
    EXPECT_EQ(
        error_of(minimal_and("[[object]]\nname = \"a\"\nshape = \"mesh\"\nfile = \"t.obj\"\n"),
                 folder.path()),
        "rig.toml:21: object[0].file: " + (folder.path() / "t.obj").string() +
            ": found more than 256 MiB; allowed: 256 MiB or less");
    EXPECT_EQ(read_error("/dev/zero"), "/dev/zero: found more than 8 MiB; allowed: 8 MiB or less");
}

}  // namespace
}  // namespace aphotic::rig_reader_test
