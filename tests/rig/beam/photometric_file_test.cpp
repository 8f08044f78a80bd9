// SPDX-License-Identifier: BSD-3-Clause
//
// The files in tests/rig/beam/photometric/ are written from the text of the standards, each in
// another maker's manner. What they must become is worked out by hand here.
#include "rig/beam/photometric_file.h"

#include "base/atomic_file.h"
#include "base/degrees.h"
#include "base/error.h"
#include "support/refusal.h"
#include "support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic::photometric_file_test {
namespace {

namespace fs = std::filesystem;
using Numbers = std::vector<double>;

constexpr double kRounding = 1e-12;

constexpr TableAngles kA = TableAngles::TypeA;
constexpr TableAngles kB = TableAngles::TypeB;
constexpr TableAngles kC = TableAngles::TypeC;

fs::path sample(const std::string& name) {
    return fs::path(APHOTIC_SOURCE_DIR) / "tests/rig/beam/photometric" / name;
}

PhotometricFile read_sample(const std::string& name) {
    return read_photometric_file(sample(name));
}

PhotometricFile parse(const std::string& name, std::string_view text) {
    return parse_photometric_file(name, text);
}

std::string error_of(const std::string& name, std::string_view text) {
    return refusal_of([&] { static_cast<void>(parse(name, text)); });
}

Numbers in_degrees(const Numbers& angles_rad) {
    Numbers degrees;
    for (const double angle : angles_rad) degrees.push_back(angle * kDegreesPerRadian);
    return degrees;
}

void expect_near(const Numbers& found, const Numbers& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_NEAR(found[i], expected[i], kRounding * std::max(1.0, expected[i])) << i;
}

// What the table has at one vertical angle, all about.
Numbers row_of(const BeamTable& table, std::size_t vertical) {
    Numbers row;
    for (std::size_t h = 0; h < table.horizontal_rad.size(); ++h)
        row.push_back(table.intensity[h * table.vertical_rad.size() + vertical]);
    return row;
}

double at(const BeamTable& table, double vertical_deg, double horizontal_deg) {
    // A little within, so that rounding does not put it beyond the table.
    constexpr double kWithin = 1.0 - 1e-14;
    return table_intensity(table,
                           direction_at(table.angles,
                                        {kWithin * vertical_deg * kRadiansPerDegree,
                                         kWithin * horizontal_deg * kRadiansPerDegree}));
}

TEST(IesFile, Of1986HasNoHeaderAndALampFactor) {
    const PhotometricFile file = read_sample("lm63-1986-round.ies");
    expect_near(in_degrees(file.table.vertical_rad), {0.0, 22.5, 45.0, 67.5, 90.0});
    EXPECT_EQ(file.table.horizontal_rad, Numbers{0.0});
    // Times 10 x 0.9 x 0.95 = 8.55.
    expect_near(file.table.intensity, {855.0, 769.5, 427.5, 42.75, 0.0});
    EXPECT_EQ(file.luminous_flux_lm, 20000.0);
}

TEST(IesFile, MirrorsAQuadrantTwice) {
    const PhotometricFile file = read_sample("lm63-1991-quadrant.ies");
    expect_near(in_degrees(file.table.horizontal_rad), {0, 45, 90, 135, 180, 225, 270, 315, 360});
    expect_near(row_of(file.table, 0), Numbers(9, 200.0));
    expect_near(row_of(file.table, 1), {100, 120, 140, 120, 100, 120, 140, 120, 100});
    EXPECT_EQ(file.luminous_flux_lm, 3000.0);
}

TEST(IesFile, MirrorsWhatGoesFrom90To270) {
    const PhotometricFile file = read_sample("lm63-1995-from-90-to-270.ies");
    expect_near(in_degrees(file.table.horizontal_rad), {0, 45, 90, 135, 180, 225, 270, 315, 360});
    expect_near(row_of(file.table, 1), {1.5, 1.0, 0.5, 1.0, 1.5, 2.0, 2.5, 2.0, 1.5});
}

// Without a plane at 180 there is none at 0: there lies what is between its neighbours.
TEST(IesFile, ClosesATurnBetweenPlanes) {
    const PhotometricFile file =
        parse("a.ies",
              "IESNA91\nTILT=NONE\n1 1 1 2 4 1 2 0 0 0 1 1 1\n0 90\n90 150 240 270\n"
              "0 1 0 2 0 5 0 6\n");
    // Mirrored: 30 is 150's, 300 is 240's. From 300 over 0 to 30: 5 + 60/90 (2 - 5) = 3.
    expect_near(in_degrees(file.table.horizontal_rad), {0, 30, 90, 150, 240, 270, 300, 360});
    expect_near(row_of(file.table, 1), {3, 2, 1, 2, 5, 6, 5, 3});
}

TEST(IesFile, MirrorsHalfATurnAndReadsLatin1) {
    const PhotometricFile file = read_sample("lm63-2002-half-turn.ies");
    expect_near(in_degrees(file.table.horizontal_rad), {0, 90, 180, 270, 360});
    expect_near(row_of(file.table, 2), {2, 3, 4, 3, 2});
    EXPECT_EQ(file.luminous_flux_lm, std::nullopt);
}

TEST(IesFile, MirrorsAQuadrantOfTypeB) {
    const BeamTable table = read_sample("lm63-2002-type-b-quadrant.ies").table;
    EXPECT_EQ(table.angles, kB);
    expect_near(in_degrees(table.vertical_rad), {-90, -45, 0, 45, 90});
    expect_near(in_degrees(table.horizontal_rad), {-60, 0, 60});
    for (const double V : {-45.0, 45.0}) {
        EXPECT_NEAR(at(table, V, 0.0), 500.0, 1e-9);
        for (const double H : {-60.0, 60.0}) EXPECT_NEAR(at(table, V, H), 200.0, 1e-9);
    }
    EXPECT_NEAR(table_intensity(table, {0.0, std::sqrt(3.0), 1.0000001}), 400.0, 1e-4);
}

TEST(IesFile, ReadsTypeAAsItIs) {
    const BeamTable table = read_sample("lm63-1995-type-a.ies").table;
    EXPECT_EQ(table.angles, kA);
    expect_near(table.intensity, {1, 2, 3, 4, 5, 6, 7, 8, 9});
    EXPECT_NEAR(at(table, 10.0, 40.0), 9.0, 1e-9) << "up is along, right is across";
    EXPECT_NEAR(at(table, -20.0, -30.0), 1.0, 1e-9);
    EXPECT_NEAR(at(table, 10.0, -30.0), 3.0, 1e-9);
}

TEST(IesFile, DoesNotMultiplyWithTheCodeOf2019) {
    const PhotometricFile file = read_sample("lm63-2019-file-code.ies");
    EXPECT_EQ(file.table.intensity, (Numbers{3000.0, 2000.0, 500.0, 0.0}));
}

// The same numbers under the header of each edition: 1.1 is a factor as far as 1995.
TEST(IesFile, TakesALampFactorOfTheEditionsThatHaveOne) {
    const std::string rest = "TILT=NONE\n1 1 1 2 1 1 2 0 0 0 1 1.1 1\n0 90\n0\n1 2\n";
    for (const std::string header : {"a label",
                                     "IESNA:LM-63-1986",
                                     "IESNA91",
                                     "IESNA:LM-63-1991",
                                     "IESNA:LM-63-1995",
                                     "iesna: lm-63-1995",
                                     "\n\n  IESNA:LM-63-1995"})
        expect_near(parse("a.ies", header + "\n" + rest).table.intensity, {1.1, 2.2});
    for (const std::string header :
         {"IESNA:LM-63-2002", "IES:LM-63-2019", "ANSI/IES LM-63-19", "\nIES:LM-63-2019"})
        expect_near(parse("a.ies", header + "\n" + rest).table.intensity, {1.0, 2.0});
    EXPECT_EQ(error_of("a.ies", "IESNA:LM-63-2007\n" + rest),
              "a.ies:1: found the edition 'IESNA:LM-63-2007'; allowed: LM-63 of 1986, 1991, 1995, "
              "2002 or 2019");
}

TEST(IesFile, RefusesALampWhoseLightChangesAsItIsTilted) {
    const std::string rest = "1 1 1 2 1 1 2 0 0 0 1 1 1\n0 90\n0\n1 2\n";
    expect_near(parse("a.ies", "IESNA91\nTILT=INCLUDE\n1\n2\n0 90\n1 1.0\n" + rest).table.intensity,
                {1, 2});
    EXPECT_EQ(error_of("a.ies", "IESNA91\nTILT=INCLUDE\n1\n2\n0 90\n1 .87\n" + rest),
              "a.ies:6: the factor of a tilt (TILT): found 0.87; allowed: 1; lamps whose light "
              "changes with tilt are not modelled");
    EXPECT_EQ(error_of("a.ies", "IESNA91\nTILT=b.tlt\n" + rest),
              "a.ies:2: found TILT='b.tlt', a table of the lamp's light over tilt; allowed: "
              "TILT=NONE, or INCLUDE with factors of 1");
}

TEST(IesFile, ReadsAWholeTurnCounterclockwise) {
    const BeamTable table = read_sample("lm63-2002-turn-without-360.ies").table;
    expect_near(in_degrees(table.horizontal_rad), {0, 90, 180, 270, 360});
    expect_near(row_of(table, 1), {1, 2, 3, 4, 1});
    const double theta = 79.99999 * kRadiansPerDegree;
    const auto towards = [&](double x, double y) {
        return table_intensity(table, {x * std::sin(theta), y * std::sin(theta), std::cos(theta)});
    };
    EXPECT_NEAR(towards(1.0, 0.0), 1.0, 1e-5) << "along";
    EXPECT_NEAR(towards(0.0, -1.0), 2.0, 1e-5) << "to port";
    EXPECT_NEAR(towards(-1.0, 0.0), 3.0, 1e-5);
    EXPECT_NEAR(towards(0.0, 1.0), 4.0, 1e-5);
}

TEST(EulumdatFile, TurnsIsym3FromC270OverC0ToC90) {
    const PhotometricFile file = read_sample("eulumdat-isym-3.ldt");
    expect_near(in_degrees(file.table.vertical_rad), {0, 22.5, 45});
    expect_near(in_degrees(file.table.horizontal_rad), {0, 45, 90, 135, 180, 225, 270, 315, 360});
    // Times 1.5 x 4000 / 1000 = 6.
    expect_near(row_of(file.table, 0), Numbers(9, 60.0));
    expect_near(row_of(file.table, 1), {18, 24, 30, 24, 18, 12, 6, 12, 18});
    EXPECT_EQ(file.luminous_flux_lm, 4000.0);
}

TEST(EulumdatFile, ReadsAbsolutePhotometry) {
    const PhotometricFile file = read_sample("eulumdat-absolute.ldt");
    EXPECT_EQ(file.table.horizontal_rad, Numbers{0.0});
    expect_near(file.table.intensity, {1000, 500, 0});
    EXPECT_EQ(file.luminous_flux_lm, std::nullopt);
}

// 1 over the sphere has half of its flux below, and 4 pi in all; lamps of 8 pi lose half of that.
TEST(EulumdatFile, StatesSharesOfFlux) {
    PhotometricFile file;
    file.table.vertical_rad = {
        0.0, 80.0 * kRadiansPerDegree, 100.0 * kRadiansPerDegree, std::numbers::pi};
    file.table.horizontal_rad = {0.0};
    file.table.intensity = Numbers(4, 1.0);
    file.luminous_flux_lm = 8.0 * std::numbers::pi;
    const std::string text = photometric_text(file, "a.ldt");
    EXPECT_NE(text.find("\r\n0\r\n50\r\n50\r\n1\r\n0\r\n1\r\n"), std::string::npos) << text;
}

TEST(EulumdatFile, RefusesAChoiceOfLamps) {
    const std::string name = "eulumdat-two-sets.ldt";
    EXPECT_EQ(error_of(name, read_text_file(sample(name))),
              name +
                  ":26: sets of lamps: found 2; allowed: 1; of several, keep the one that is "
                  "installed, since intensities are per 1000 lm of it");
}

// A file of one line for each item, with four planes a quarter turn apart unless said.
std::string eulumdat(int symmetry, const std::string& planes, const std::string& values) {
    std::string text = fmt::format("m\n1\n{}\n{}\n0\n2\n0\n", symmetry, planes);
    for (int i = 0; i < 16; ++i) text += "0\n";
    text += "1\n0\n1\n1\nLED\n1000\n0\n0\n0\n";
    for (int i = 0; i < 10; ++i) text += "0\n";
    return text + values;
}

TEST(EulumdatFile, ReadsEverySymmetry) {
    const std::string four = "0\n90\n180\n270\n0\n90\n";
    const auto row = [](const std::string& text) { return row_of(parse("a.ldt", text).table, 1); };
    expect_near(row(eulumdat(0, "4", four + "9\n1\n9\n2\n9\n3\n9\n4\n")), {1, 2, 3, 4, 1});
    expect_near(row(eulumdat(1, "4", four + "9\n1\n")), {1});
    expect_near(row(eulumdat(2, "4", four + "9\n1\n9\n2\n9\n3\n")), {1, 2, 3, 2, 1});
    expect_near(row(eulumdat(3, "4", four + "9\n4\n9\n1\n9\n2\n")), {1, 2, 1, 4, 1});
    expect_near(row(eulumdat(4, "4", four + "9\n1\n9\n2\n")), {1, 2, 1, 2, 1});
}

TEST(EulumdatFile, NamesTheLineOfWhatItCannotRead) {
    const std::string four = "0\n90\n180\n270\n0\n90\n";
    EXPECT_EQ(error_of("a.ldt", eulumdat(5, "4", four)),
              "a.ldt:3: Isym, the symmetry: found 5; allowed: a whole number from 0 to 4");
    EXPECT_EQ(error_of("a.ldt", eulumdat(3, "6", four)),
              "a.ldt:4: Mc, the number of C planes: found 6; allowed with Isym 3: multiples of 4");
    EXPECT_EQ(error_of("a.ldt", eulumdat(3, "4", "0\n80\n180\n270\n0\n90\n")),
              "a.ldt:44: a C angle: found 80; allowed: 90 degrees here, by Isym and Mc");
    EXPECT_EQ(error_of("a.ldt", eulumdat(4, "4", four + "9\n1\n9\n-2\n")),
              "a.ldt:52: an intensity: found -2; allowed: 0 or more");
    EXPECT_EQ(error_of("a.ldt", eulumdat(4, "4", four + "9\n1\n9\n")),
              "a.ldt:52: the file ends where an intensity should be");
    EXPECT_EQ(error_of("a.ldt", eulumdat(4, "4", four + "9\n1\n9\n2\n3\n")),
              "a.ldt:53: found '3' after the last intensity; allowed: as many as Isym, Mc and Ng "
              "require");
    EXPECT_EQ(error_of("a.ldt", "m\n1\nx\n"),
              "a.ldt:3: Isym, the symmetry: found 'x'; allowed: a finite number");
}

TEST(BeamCsv, ReadsRowsInAnyOrder) {
    const PhotometricFile file = read_sample("beam.csv");
    expect_near(in_degrees(file.table.vertical_rad), {0, 45, 90});
    expect_near(in_degrees(file.table.horizontal_rad), {0, 90, 180, 270, 360});
    expect_near(row_of(file.table, 0), Numbers(5, 1.0));
    expect_near(row_of(file.table, 1), {0.5, 0.4, 0.3, 0.2, 0.5});
    EXPECT_EQ(file.luminous_flux_lm, std::nullopt);
    const BeamTable round = parse("a.csv", "theta_deg,intensity\n30,0\n0,2\n").table;
    EXPECT_EQ(round.horizontal_rad, Numbers{0.0});
    EXPECT_EQ(round.intensity, (Numbers{2.0, 0.0}));
}

TEST(BeamCsv, NamesTheLineOfWhatItCannotRead) {
    const std::string round = "theta_deg,intensity\n";
    const std::string turn = "theta_deg,phi_deg,intensity\n";
    EXPECT_EQ(error_of("a.csv", "theta,intensity\n0,1\n"),
              "a.csv:1: found the header row theta,intensity; allowed for a beam: "
              "theta_deg,intensity or theta_deg,phi_deg,intensity");
    EXPECT_EQ(error_of("a.csv", round + "0,1\n10,-1\n"),
              "a.csv:3: intensity: found -1; allowed: 0 or more");
    EXPECT_EQ(error_of("a.csv", round + "0,1\n190,1\n"),
              "a.csv:3: theta_deg: found 190; allowed: 0 to 180 degrees");
    EXPECT_EQ(error_of("a.csv", round + "0,1\n"),
              "a.csv:2: theta_deg: found 0; allowed: two or more");
    EXPECT_EQ(error_of("a.csv", round + "0,1\n10,1\n0,2\n"),
              "a.csv:4: found a second row of theta_deg 0, first on line 2; allowed: one");
    EXPECT_EQ(error_of("a.csv", turn + "0,0,1\n10,0,1\n0,180,1\n"),
              "a.csv:4: found no row for theta_deg 10, phi_deg 180; allowed: one for each "
              "theta_deg and phi_deg");
    EXPECT_EQ(error_of("a.csv", turn + "0,0,1\n9,0,1\n0,90,1\n9,90,1\n"),
              "a.csv:4: phi_deg: found 0 to 90; allowed: 0 to 360 (360 may be omitted where steps "
              "are even), or 0 alone");
    EXPECT_EQ(error_of("a.csv", turn + "0,0,1\n9,0,1\n0,360,1\n9,360,2\n"),
              "a.csv:4: found intensities at phi_deg 360 that differ from those at 0; allowed: the "
              "same, since it is one direction");
}

TEST(IesFile, NamesTheLineOfWhatItCannotRead) {
    const auto error = [](const std::string& rest) {
        return error_of("a.ies", "IESNA:LM-63-2002\n[TEST] t\nTILT=NONE\n" + rest);
    };
    const std::string numbers = "1 1 1 2 1 1 2 0 0 0\n1 1 1\n";
    EXPECT_EQ(error(numbers + "0 90\n0\n1 x2\n"),
              "a.ies:8: candela: found 'x2'; allowed: a finite number");
    EXPECT_EQ(error(numbers + "0 90\n0\n1 nan\n"),
              "a.ies:8: candela: found 'nan'; allowed: a finite number");
    EXPECT_EQ(error(numbers + "0 90\n0\n1 -2\n"), "a.ies:8: candela: found -2; allowed: 0 or more");
    EXPECT_EQ(error(numbers + "0 90\n0\n1\n"), "a.ies:9: the file ends where candela should be");
    EXPECT_EQ(error(numbers + "0 90\n0\n1 2\n\n3\n"),
              "a.ies:10: found '3' after the last number; allowed: as many numbers as the counts "
              "of angles require");
    EXPECT_EQ(error(numbers + "0 0\n0\n1 2\n"),
              "a.ies:6: a vertical angle: found 0; allowed: increasing angles, here 1e-06 or more");
    EXPECT_EQ(error(numbers + "0 200\n0\n1 2\n"),
              "a.ies:6: a vertical angle: found 200; allowed: 0 to 180 degrees");
    EXPECT_EQ(error(numbers + "0 90\n30\n1 2\n"),
              "a.ies:7: horizontal angles: found 30 to 30 degrees; allowed for type C: 0 alone, 0 "
              "to 90, 0 to 180, 90 to 270, or 0 to 360 (360 may be omitted where steps are even)");
    EXPECT_EQ(error("1 1 1 2 2 1 2 0 0 0\n1 1 1\n0 90\n0 360\n1 2 1 3\n"),
              "a.ies:7: found candela at 360 degrees that differ from those at 0; allowed: the "
              "same, since it is one plane");
    EXPECT_EQ(error("0 1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n1 2\n"),
              "a.ies:4: the number of lamps: found 0; allowed: a whole number from 1 to 1000000");
    EXPECT_EQ(error("1 -2 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n1 2\n"),
              "a.ies:4: lumens per lamp: found -2; allowed: 0 to 1000000000000, or -1 for absolute "
              "photometry");
    EXPECT_EQ(error("1 1 0 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n1 2\n"),
              "a.ies:4: the multiplier of candela: found 0; allowed: above 0");
    EXPECT_EQ(error("1 1 1 2 1 4 2 0 0 0\n1 1 1\n0 90\n0\n1 2\n"),
              "a.ies:4: the type of photometry: found 4; allowed: a whole number from 1 to 3");
    EXPECT_EQ(error("1 1 1 9999999 1 1 2 0 0 0\n1 1 1\n0 90\n0\n1 2\n"),
              "a.ies:4: the number of vertical angles: found 9999999; allowed: a whole number from "
              "2 to 4000000");
    EXPECT_EQ(error("1 1 1 2 1 2 2 0 0 0\n1 1 1\n0 90\n0\n1 2\n"),
              "a.ies:7: the only horizontal angle: found 0; allowed: two or more of them");
    EXPECT_EQ(error_of("a.ies", "IESNA91\n[TEST] t\n"),
              "a.ies:3: the file ends without a line TILT=; allowed: TILT=NONE, or TILT=INCLUDE "
              "with factors of 1");
}

TEST(PhotometricFile, IsKnownByTheEndingOfItsName) {
    EXPECT_TRUE(is_photometric_file_name("Lamp.IES"));
    EXPECT_TRUE(is_photometric_file_name("a.ldt"));
    EXPECT_TRUE(is_photometric_file_name("a.csv"));
    EXPECT_FALSE(is_photometric_file_name("ies"));
    EXPECT_EQ(error_of("lamp.txt", ""),
              "lamp.txt: found another file type; allowed for a measured beam: .ies, .ldt or .csv");
}

// Angles with as many digits as a goniometer or a program may give, and any values.
BeamTable random_table(TableAngles type, bool is_round, std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto angles = [&](double from_deg, double to_deg, int steps, double grain_deg) {
        Numbers nodes;
        for (int i = 0; i < steps; ++i) {
            const double deg = from_deg + (to_deg - from_deg) * (i + 0.9 * unit(random)) / steps;
            const double rounded = grain_deg == 0.0 ? deg : std::round(deg / grain_deg) * grain_deg;
            nodes.push_back((i == 0 ? from_deg : rounded) * kRadiansPerDegree);
        }
        nodes.push_back(to_deg * kRadiansPerDegree);
        return nodes;
    };
    const double grain_deg = unit(random) < 0.5 ? 0.0 : 0.01;
    const bool is_c = type == kC;
    BeamTable table;
    table.angles = type;
    table.vertical_rad =
        is_c ? angles(0.0, 175.3, 40, grain_deg) : angles(-88.1, 90.0, 30, grain_deg);
    table.horizontal_rad = is_round ? Numbers{0.0}
                           : is_c   ? angles(0.0, 360.0, 30, grain_deg)
                                    : angles(-60.2, 33.3, 25, grain_deg);
    const std::size_t rows = table.vertical_rad.size();
    for (std::size_t i = 0; i < rows * table.horizontal_rad.size(); ++i)
        table.intensity.push_back(std::exp(20.0 * unit(random) - 10.0));
    if (is_c)
        std::copy_n(table.intensity.begin(), rows, table.intensity.end() - std::ptrdiff_t(rows));
    return table;
}

TEST(PhotometricFile, IsReadAgainToTheLastBit) {
    std::mt19937 random(15);
    for (int i = 0; i < 20; ++i) {
        for (const TableAngles type : {kA, kB, kC}) {
            const bool is_round = type == kC && i % 2 == 0;
            PhotometricFile file;
            file.table = random_table(type, is_round, random);
            if (i % 3 == 0) file.luminous_flux_lm = 0.1 + 1000.0 * i;
            const PhotometricFile again = parse("a.ies", photometric_text(file, "a.ies"));
            EXPECT_EQ(again.table, file.table);
            EXPECT_EQ(again.luminous_flux_lm, file.luminous_flux_lm);
            EXPECT_EQ(parse("a.ies", photometric_text(again, "a.ies")), again);
            if (type != kC) continue;
            const PhotometricFile csv = parse("a.csv", photometric_text(file, "a.csv"));
            EXPECT_EQ(csv.table, file.table);
            const PhotometricFile ldt = parse("a.ldt", photometric_text(file, "a.ldt"));
            EXPECT_EQ(ldt.table.vertical_rad, file.table.vertical_rad);
            EXPECT_EQ(ldt.table.horizontal_rad, file.table.horizontal_rad);
            expect_near(ldt.table.intensity, file.table.intensity);
            EXPECT_EQ(ldt.luminous_flux_lm, file.luminous_flux_lm);
        }
    }
}

// What a rig takes of a file: the shape, whatever the unit of the numbers.
TEST(PhotometricFile, HasItsShapeAtAnyScale) {
    constexpr double kRoundings = 1e-14;  // of three decimal numbers, and of a sum
    const auto shape_of = [](const std::string& file, const std::string& text) {
        const BeamTable table = normalised(parse(file, text).table);
        const double largest = largest_intensity(table);
        EXPECT_GE(largest, 0.5) << text;
        EXPECT_LT(largest, 1.0) << text;
        return Numbers{table.intensity[0] / largest,
                       table.intensity[1] / largest,
                       table.intensity[2] / largest,
                       table_flux(table) / largest};
    };
    const Numbers expected = shape_of("a.csv", "theta_deg,intensity\n0,3\n45,1.5\n90,0.6\n");
    const auto expect_shape = [&](const std::string& file, const std::string& text) {
        const Numbers found = shape_of(file, text);
        for (std::size_t i = 0; i < expected.size(); ++i)
            EXPECT_NEAR(found[i], expected[i], kRoundings) << text;
    };
    for (const int exponent : {-307, -200, -20, 0, 20, 200, 307}) {
        expect_shape(
            "a.csv",
            fmt::format("theta_deg,intensity\n0,3e{0}\n45,1.5e{0}\n90,0.6e{0}\n", exponent));
        expect_shape("a.ies",
                     fmt::format("IESNA:LM-63-1995\nTILT=NONE\n1 1000 1e{0} 3 1 1 2 0 0 0\n1 1 1\n"
                                 "0 45 90\n0\n3 1.5 0.6\n",
                                 exponent));
        expect_shape("a.ies",
                     fmt::format("IESNA:LM-63-1995\nTILT=NONE\n1 1000 1e{0} 3 1 1 2 0 0 0\n"
                                 "1e{1} 1 1\n0 45 90\n0\n3 1.5 0.6\n",
                                 exponent,
                                 -exponent));
    }
    // Beside the largest an intensity that doubles hold with few digits is nothing.
    const BeamTable faint =
        normalised(parse("a.csv", "theta_deg,intensity\n0,2\n45,1e-320\n90,0\n").table);
    constexpr double kNothing = 1e-300;
    EXPECT_EQ(faint.intensity.front(), 0.5);
    EXPECT_LT(faint.intensity[1], kNothing);
}

TEST(PhotometricFile, RefusesAScaleThatDoublesDoNotHold) {
    EXPECT_EQ(error_of("a.csv", "theta_deg,intensity\n0,1e-320\n45,1e-320\n90,0\n"),
              "a.csv: found no intensity above 1e-320 after the file's factors; allowed: a largest "
              "one of 2.23e-308 or more, since doubles lose digits below");
    const auto ies = [](const std::string& multiplier, const std::string& factors) {
        return error_of("a.ies",
                        fmt::format("IESNA:LM-63-1995\nTILT=NONE\n1 1000 {} 3 1 1 2 0 0 0\n{} 1\n"
                                    "0 45 90\n0\n3 1.5 0\n",
                                    multiplier,
                                    factors));
    };
    EXPECT_EQ(ies("1e308", "1 1"),
              "a.ies:7: candela: found 3; allowed: up to 1.8, since the file's factors multiply it "
              "by 1e+308");
    EXPECT_EQ(ies("1e200", "1e200 1"),
              "a.ies:4: a factor of all intensities: found 1e+200; allowed: one whose product with "
              "the others, 1e+200, is from 2.23e-308 to 1.8e+308");
    EXPECT_EQ(ies("1e-200", "1e-120 1"),
              "a.ies:4: a factor of all intensities: found 1e-120; allowed: one whose product with "
              "the others, 1e-200, is from 2.23e-308 to 1.8e+308");
    EXPECT_TRUE(ies("1e-200", "1 1e-120").starts_with("a.ies:4: a factor of all intensities"));
}

TEST(PhotometricFile, WritesWhatItReadOfEverySample) {
    const TempFolder folder;
    for (const auto& entry : fs::directory_iterator(sample(""))) {
        if (entry.path().filename() == "eulumdat-two-sets.ldt") continue;
        const PhotometricFile file = read_photometric_file(entry.path());
        const fs::path written = folder.path() / "again.ies";
        write_photometric_file(file, written);
        const PhotometricFile again = read_photometric_file(written);
        EXPECT_EQ(again.table, file.table) << entry.path();
        EXPECT_EQ(again.luminous_flux_lm, file.luminous_flux_lm) << entry.path();
    }
}

TEST(PhotometricFile, RefusesToWriteWhatAFormatCannotSay) {
    const auto error = [](const BeamTable& table, const std::string& name) {
        return refusal_of([&] {
            static_cast<void>(photometric_text({.table = table, .luminous_flux_lm = {}}, name));
        });
    };
    const BeamTable b = read_sample("lm63-2002-type-b-quadrant.ies").table;
    EXPECT_EQ(error(b, "b.ldt"), "b.ldt: found a table of type A or B; allowed in .ldt: type C");
    EXPECT_EQ(error(b, "b.csv"), "b.csv: found a table of type A or B; allowed in .csv: type C");
    BeamTable half = b;
    half.horizontal_rad = {0.0, 0.5, 1.0};
    EXPECT_EQ(error(half, "b.ies"),
              "b.ies: found a table of type A or B that begins at 0; allowed in .ies: one that "
              "begins below 0, since one that begins at 0 is half of a symmetric table");
    BeamTable dark = read_sample("eulumdat-absolute.ldt").table;
    std::ranges::fill(dark.intensity, 0.0);
    EXPECT_EQ(error(dark, "c.ldt"),
              "c.ldt: found a table without light; allowed in .ldt: intensities per 1000 lm");
}

}  // namespace
}  // namespace aphotic::photometric_file_test
