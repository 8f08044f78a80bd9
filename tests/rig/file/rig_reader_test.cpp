// SPDX-License-Identifier: BSD-3-Clause
#include "rig/file/rig_reader.h"

#include "base/error.h"
#include "base/printable.h"
#include "rig/camera/calibration_file.h"
#include "rig/camera/lens.h"
#include "rig/camera/vignetting.h"
#include "rig/geometry_signature.h"
#include "support/has.h"
#include "support/mistakes.h"
#include "support/refusal.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <utility>

namespace aphotic::rig_reader_test {
namespace {

namespace fs = std::filesystem;

constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 1e-15;  // a few units in the last place of numbers near 1

// The least that a rig must say. Errors are told by line: [camera] is line 3, [[strobe]] line 13.
constexpr std::string_view kMinimal = R"([sled]
altitude_m = 2.5
[camera]
resolution = [1360, 1024]
pixel_pitch_um = 6.45
focal_length_mm = 12
range_nm = [400, 700]
response = "nikon-d5100"
[water]
[seafloor]
[beam.wide]
cones = [{ part = "all", half_angle_deg = 90, weight = 1 }]
[[strobe]]
name = "fore"
position_m = [0.5, 0, 0]
aim = { tilt_deg = 26, toward = "axis" }
beam = "wide"
)";

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
    return refusal_of([&] { static_cast<void>(parse_rig(toml, "rig.toml", folder)); });
}

void expect_vector(const Eigen::Vector3d& found, const Eigen::Vector3d& wanted) {
    EXPECT_LE((found - wanted).norm(), kRounding)
        << "found " << found.transpose() << "; wanted " << wanted.transpose();
}

// --- What a good rig becomes ----------------------------------------------------------- --------

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

Camera camera_with(std::string_view vignetting) {
    return parse(with(8, "response = \"nikon-d5100\"\nvignetting = " + std::string(vignetting)))
        .camera;
}

// In the middle of the lower rim, tan theta is 512 pixels over the focal length.
TEST(RigReader, ReadsVignettingAsAPowerOfTheCosine) {
    const double tangent = 512.0 * 6.45e-6 / 0.012;
    const double cosine2 = 1.0 / (1.0 + tangent * tangent);
    const Camera camera = camera_with("{ cosine = 4 }");
    EXPECT_NEAR(vignetting_at(camera, 680.0, 1024.0), cosine2 * cosine2, kRounding);
    EXPECT_EQ(camera.vignetting, camera_with("\"natural\"").vignetting);
    EXPECT_NEAR(vignetting_at(camera_with("{ cosine = 3 }"), 680.0, 1024.0),
                std::pow(cosine2, 1.5),
                kRounding);
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

// --- Aim ------------------------------------------------------------------------------- --------

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

// --- Every value is checked ------------------------------------------------------------ --------

fs::path mistakes_folder() {
    return fs::path(APHOTIC_SOURCE_DIR) / "tests/rig/file/mistakes";
}

// By the rules at the head of the file.
std::string with_mistake(const Mistake& mistake) {
    const auto instead = [&](std::size_t line) -> const std::string* {
        const auto at = std::ranges::find(mistake.parts, std::to_string(line), &Mistake::Part::key);
        return at == mistake.parts.end() ? nullptr : &at->text;
    };
    std::string rig;
    std::istringstream lines{std::string(kMinimal)};
    std::string line;
    for (std::size_t n = 0; n == 0 || n == 18 || std::getline(lines, line); ++n) {
        const std::string* other = instead(n);
        if (other != nullptr) line = *other;
        if ((n > 0 && n < 18) || other != nullptr) rig += line + "\n";
    }
    return rig;
}

class RigMistake : public testing::TestWithParam<Mistake> {};

TEST_P(RigMistake, IsNamedByLineKeyWhatWasFoundAndWhatIsAllowed) {
    std::string wanted = "rig.toml:" + GetParam().message;
    const std::string name = "FOLDER";
    if (const std::size_t at = wanted.find(name); at != std::string::npos) {
        wanted.replace(at, name.size(), mistakes_folder().string());
    }
    const std::string found = error_of(with_mistake(GetParam()), mistakes_folder());
    if (wanted.ends_with("...")) {
        wanted.resize(wanted.size() - 3);
        EXPECT_EQ(found.substr(0, wanted.size()), wanted) << found;
    } else {
        EXPECT_EQ(found, wanted);
    }
}

INSTANTIATE_TEST_SUITE_P(InLine,
                         RigMistake,
                         testing::ValuesIn(mistakes_in("rig/file/mistakes/rigs.txt", 205)),
                         [](const auto& mistake) { return std::to_string(mistake.param.line); });

TEST(RigReader, TakesNumbersAtTheirLimits) {
    for (const std::string& rig :
         {with(6, "focal_length_mm = 0.01"),
          with(6, "focal_length_mm = 100000"),
          with(15, "position_m = [0.5, 0, 2.498]"),
          with(12,
               "diffuser_mm = [30, 60]\nfocal_length_mm = 65\ndistance_mm = 40\n"
               "aperture_mm = 80"),
          with(11, "[beam.of-no-strobe]\nfwhm_deg = 90\n[beam.wide]")}) {
        EXPECT_EQ(error_of(rig), "nothing was said") << rig;
    }
    // Water that absorbs nothing needs no table.
    std::string clear = with(7, "range_nm = [390, 750]");
    clear.replace(clear.find("[water]"), 7, "[water]\nmultiple = 0");
    EXPECT_EQ(error_of(clear), "nothing was said");
}

TEST(RigReader, RangeThatSeveralTablesDoNotCoverNamesThemAll) {
    const std::string both = error_of(with(7, "range_nm = [350, 750]"));
    for (const char* part : {"water absorption 'pope-fry-1997' covers 380 to 727.5 nm",
                             "lamp spectrum 'xenon-flash' covers 380 to 780 nm",
                             "sensor response 'nikon-d5100' (red) covers 380 to 780 nm",
                             "range_nm = [380, 727.5] works"}) {
        EXPECT_TRUE(has(both, part)) << part << "\nin " << both;
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
}

// --- Tables ---------------------------------------------------------------------------- --------

constexpr const char* kRgb =
    "wavelength_nm,red,green,blue\n400,0.5,0.25,0.125\n700,0.5,0.25,0.125\n";

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
}

// --- Files and syntax ------------------------------------------------------------------ --------

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
              "rig.toml:517: strobe[100].beam: found 'wide'; allowed: up to 100000 cones in all "
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
    const std::string refusal = ": found a dotted key of more than 16 parts; allowed: up to 16";
    EXPECT_EQ(error_of("\n" + key + " = 1\n"), "rig.toml:2" + refusal);
    EXPECT_EQ(error_of("[" + key + "]\n"), "rig.toml:1" + refusal);
}

TEST(RigReader, AnUnreadableRigIsNamed) {
    const TempFolder folder;
    const fs::path missing = folder.path() / "rig.toml";
    EXPECT_EQ(refusal_of([&] { static_cast<void>(read_rig(missing)); }),
              missing.string() + ": cannot be read: No such file or directory");
    EXPECT_THROW(static_cast<void>(read_rig(folder.path())), InputError);
}

// --- Digest ---------------------------------------------------------------------------- --------

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

TEST(RigReader, DigestCountsEveryFileThatIsNamed) {
    const TempFolder folder;
    const std::map<std::string, std::string> files{
        {"rgb.csv", kRgb},
        {"ccd.csv", "wavelength_nm,quantum_efficiency\n400,0.5\n700,0.5\n"},
        {"mud.csv", "wavelength_nm,reflectance\n400,0.25\n700,0.75\n"},
        {"rock.obj", "v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n"}};
    const std::string text =
        "materials = [\"sand\", \"mud.csv\"]\n" +
        with(8, "response = { filters = \"rgb.csv\", quantum_efficiency = \"ccd.csv\" }") +
        "[[object]]\nname = \"rock\"\nshape = \"mesh\"\nfile = \"rock.obj\"\n"
        "reflectance = \"sand\"\n";
    const auto digest = [&](const std::string& changed) {
        for (const auto& [name, content] : files) {
            write_file(folder.path() / name, content + (name == changed ? "\n" : ""));
        }
        return parse_rig(text, "rig.toml", folder.path()).digest;
    };
    const std::string first = digest("");
    for (const auto& [name, content] : files) EXPECT_NE(digest(name), first) << name;
    EXPECT_EQ(digest(""), first);
}

// --- Objects --------------------------------------------------------------------------- --------

constexpr std::string_view kBall =
    "[[object]]\n"
    "name = \"ball\"\n"
    "shape = \"sphere\"\n"
    "centre_m = [0.1, 0.2, 2]\n"
    "radius_m = 0.25\n"
    "reflectance = \"sand\"\n";

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

// --- Calibrations ------------------------------------------------------------------------

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

// A small version of the rig: edges see what they saw, of a lens and of a pinhole.
TEST_F(CalibratedRig, HasTheSameViewInFewerPixels) {
    constexpr double kSight = 1e-12;
    calibrate(kCamchain);
    for (const std::string_view lens : {"calibration = \"cam\"", "focal_length_mm = 12.9"}) {
        const Rig whole = read(with(6, lens));
        const Rig tenth = read(with(6, std::string(lens) + "\nscale = 0.1"));
        EXPECT_EQ(tenth.camera.width_px, 136);
        EXPECT_EQ(tenth.camera.height_px, 102);  // of 1024
        for (const double across : {0.0, 0.3, 1.0}) {
            const auto sight = [&](const Camera& camera) {
                return direction_in_air(camera, across * camera.width_px, 0.5 * camera.height_px);
            };
            EXPECT_LT((sight(tenth.camera) - sight(whole.camera)).norm(), kSight)
                << lens << ' ' << across;
        }
    }
    for (const char* scale : {"0", "1.5", "-1"})
        EXPECT_TRUE(
            has(error(with(6, fmt::format("focal_length_mm = 12\nscale = {}", scale))),
                fmt::format("camera.scale: found {}; allowed: a number from 0.001 to 1", scale)))
            << scale;
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
    // One that tells of none leaves the port to the rig.
    calibrate(kPinhole);
    text = kByCalibration;
    text.replace(text.find("[water]"), 7, std::string(kPort) + "[water]");
    EXPECT_EQ(read(text).camera.port->distance_m, 0.05);
}

// --- Hostile rigs ---------------------------------------------------------------------- --------

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
    EXPECT_NE(error_of(with(2, "altitude_m = -0.0")), "nothing was said");
    EXPECT_NE(error_of(with(2, "altitude_m = 1e-400")), "nothing was said") << "it is not 0";
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
            EXPECT_TRUE(has(message, "allowed: a string without control characters"));
            EXPECT_FALSE(has_control_characters(message)) << message;
        }
    }
}

TEST(RigReader, RefusesTextsWithoutEnd) {
    const std::string longest(1000, 'a');
    EXPECT_EQ(parse("title = \"" + longest + "\"\n" + std::string(kMinimal)).title, longest);
    EXPECT_EQ(error_of("title = \"" + longest + "a\"\n" + std::string(kMinimal)),
              "rig.toml:1: title: found a string of 1001 bytes; allowed: up to 1000");
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
        return refusal_of([&] { static_cast<void>(read_rig(file)); });
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
