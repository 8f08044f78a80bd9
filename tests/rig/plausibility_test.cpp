// SPDX-License-Identifier: BSD-3-Clause
//
// A rig is written as a user would, and one number of it spoilt as by a wrong unit: the doubt must
// name the key and the number that was meant, which the test knows beforehand.
#include "rig/plausibility.h"

#include "base/atomic_file.h"
#include "rig/file/rig_reader.h"
#include "rig/geometry.h"
#include "support/effort.h"
#include "support/has.h"
#include "support/mistakes.h"
#include "support/random_rig.h"
#include "support/temp_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace aphotic::plausibility_test {
namespace {

const std::string kUsualRig = read_text_file(APHOTIC_SOURCE_DIR "/tests/rig/mistakes/usual.toml");

// Text in place of other text, wherever that stands.
std::string with(std::string rig, std::string_view from, std::string_view to) {
    std::size_t at = rig.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    for (; at != std::string::npos; at = rig.find(from, at + to.size()))
        rig.replace(at, from.size(), to);
    return rig;
}

std::vector<Doubt> doubts_of_text(const std::string& text, const std::filesystem::path& folder) {
    return doubts_of(parse_rig(text, "rig.toml", folder));
}

std::string words_of(const std::vector<Doubt>& doubts) {
    std::string words;
    for (const Doubt& doubt : doubts) words += in_words(doubt, "rig.toml") + "\n";
    return words;
}

TEST(Plausibility, EveryNumberInAnotherUnitIsDoubtedAndTheUnitTold) {
    for (const Mistake& mistake : mistakes_in("rig/mistakes/units.txt", 25)) {
        SCOPED_TRACE(testing::PrintToString(mistake));
        const auto& parts = mistake.parts;
        const std::vector<Doubt> doubts =
            doubts_of_text(with(kUsualRig, parts[0].text, parts[1].text), "");
        if (mistake.message.empty()) {  // one strobe that points down by half a degree is one
            EXPECT_TRUE(doubts.empty()) << words_of(doubts);
            continue;
        }
        const auto found = std::ranges::find(doubts, parts.at(2).text, &Doubt::key);
        ASSERT_NE(found, doubts.end()) << words_of(doubts);
        EXPECT_TRUE(has(found->what, mistake.message)) << words_of(doubts);
        EXPECT_GT(found->line, 0);
    }
}

// A principal point at the image's corner, as of a calibration that tells none.
TEST(Plausibility, WhatACalibrationCannotMeanIsDoubted) {
    const TempFolder folder;
    write_text_file(folder.path() / "camera.txt", "1 PINHOLE 1360 1024 1860 1860 0 0\n");
    std::string text = kUsualRig;
    const std::string told = "pixel_pitch_um = 6.45\nfocal_length_mm = 12.0\n";
    text.replace(
        text.find(told), told.size(), "pixel_pitch_um = 6.45\ncalibration = \"camera.txt\"\n");
    write_text_file(folder.path() / "rig.toml", text);
    const std::vector<Doubt> doubts = doubts_of(read_rig(folder.path() / "rig.toml"));
    const auto found = std::ranges::find(doubts, "camera.calibration", &Doubt::key);
    ASSERT_NE(found, doubts.end());
    EXPECT_TRUE(has(found->what, "found 0, 0 in an image of 1360 x 1024"));
    EXPECT_GT(found->line, 0);
}

TEST(Plausibility, TiltsOfAllStrobesInRadiansAreDoubted) {
    std::string rig = with(kUsualRig, "tilt_deg = 20", "tilt_deg = 0.35");
    rig = with(rig, "tilt_deg = 26", "tilt_deg = 0.45");
    const std::vector<Doubt> doubts = doubts_of_text(rig, "");
    ASSERT_EQ(doubts.size(), 1U) << words_of(doubts);
    EXPECT_EQ(doubts[0].key, "strobe[0].aim.tilt_deg");
    EXPECT_TRUE(has(doubts[0].what, "20.05 if that is in radians"));
    EXPECT_TRUE(has(doubts[0].what, "1 more like it"));
}

// Of curves from a file: absorption per centimetre, and a beam's table over angles in radians.
TEST(Plausibility, TablesInOtherUnitsAreDoubted) {
    const TempFolder folder;
    write_file(folder.path() / "a.csv",
               "wavelength_nm,absorption_per_m\n400,0.0001\n600,0.0023\n700,0.0065\n");
    write_file(folder.path() / "beam.csv", "theta_deg,intensity\n0,1\n0.7854,0.5\n1.5708,0\n");
    const std::string absorption = with(kUsualRig, "[water]", "[water]\nabsorption = \"a.csv\"");
    const std::vector<Doubt> of_water = doubts_of_text(absorption, folder.path());
    ASSERT_EQ(of_water.size(), 1U) << words_of(of_water);
    EXPECT_TRUE(has(of_water[0].what, "0.23/m if the table is in 1/cm")) << words_of(of_water);
    const std::string table = with(kUsualRig, "fwhm_deg = 100", "table = \"beam.csv\"");
    const std::vector<Doubt> of_beam = doubts_of_text(table, folder.path());
    ASSERT_FALSE(of_beam.empty());
    EXPECT_EQ(of_beam[0].key, "beam.wide.table") << words_of(of_beam);
    EXPECT_TRUE(has(of_beam[0].what, "90 if that is in radians"));
}

TEST(Plausibility, StrobesThatLightNothingInViewAreDoubted) {
    // The sled is pitched by 5 degrees: what points straight away from the floor in the sled's
    // frame is 85 degrees above the horizon.
    const std::string up = with(kUsualRig, "direction = [0, 0.4, 1]", "direction = [0, 0, -1]");
    const std::vector<Doubt> of_up = doubts_of_text(up, "");
    ASSERT_EQ(of_up.size(), 1U) << words_of(of_up);
    EXPECT_EQ(of_up[0].key, "strobe[2]");
    EXPECT_TRUE(
        has(of_up[0].what, "'port' is aimed 85 degrees above the horizon, and lights nothing"))
        << words_of(of_up);
    // A spot of 5 degrees, 70 degrees outward: the view's edge is some 80 degrees off.
    std::string spot = with(kUsualRig, "fwhm_deg = 100", "fwhm_deg = 10");
    spot = with(spot, "aim = { tilt_deg = 20, toward = \"axis\" }", "direction = [2.7, 0, 1]");
    const std::vector<Doubt> of_spot = doubts_of_text(spot, "");
    ASSERT_EQ(of_spot.size(), 1U) << words_of(of_spot);
    EXPECT_TRUE(has(of_spot[0].what, "'fore' lights nothing that the camera sees"));
    // All of them: the image is black.
    std::string black =
        with(up, "aim = { tilt_deg = 20, toward = \"axis\" }", "direction = [0,0,-1]");
    black = with(black, "aim = { tilt_deg = 26, toward = \"axis\" }", "direction = [0,0,-1]");
    const std::vector<Doubt> of_black = doubts_of_text(black, "");
    ASSERT_EQ(of_black.size(), 2U) << words_of(of_black);
    EXPECT_TRUE(has(of_black[1].what, "images are black"));
}

// As set by a command, such as lightmap --altitude 2000.
TEST(Plausibility, ThePoseThatCountsIsJudgedNotTheFiles) {
    Rig rig = parse_rig(kUsualRig, "rig.toml", "");
    EXPECT_TRUE(doubts_of(rig).empty()) << words_of(doubts_of(rig));
    rig.sled.altitude_m = 2000.0;
    ASSERT_FALSE(doubts_of(rig).empty());
    EXPECT_EQ(doubts_of(rig)[0].key, "sled.altitude_m");
}

TEST(Plausibility, NoShippedRigIsDoubted) {
    std::size_t rigs = 0;
    for (const auto& entry : std::filesystem::directory_iterator(APHOTIC_SOURCE_DIR "/scenes")) {
        if (entry.path().extension() != ".toml") continue;
        const std::vector<Doubt> doubts = doubts_of(read_rig(entry.path()));
        EXPECT_TRUE(doubts.empty()) << entry.path() << "\n" << words_of(doubts);
        ++rigs;
    }
    EXPECT_GT(rigs, 5U);
}

// Judged together with others, or free to be anything that the reader takes.
const std::set<std::string_view> kElsewhere{
    "camera.pixel_pitch_um",          // field of view
    "camera.focal_length_mm",         // field of view
    "camera.orientation_deg",         // quarter turns in radians
    "camera.black_level_dn",          // beside the white level
    "camera.white_level_dn",          // beside the black level
    "beam.*.turn_deg",                // quarter turns in radians
    "beam.*.cones[].half_angle_deg",  // all cones of the beam
    "beam.*.cones[].weight",          // their sum
    "strobe[].aim.tilt_deg",          // all strobes
    "strobe[].direction",             // geometry
    "camera.scale",                   // of a small version, as small as one likes
    "camera.resolution",              // of whole pixels, and the calibration has it too
    "camera.vignetting.radial",       // the reader keeps the image bright
    "camera.port.normal",             // a direction
    "water.salinity_psu",             // the reader's bounds are the sea's
    "water.temperature_c",            // the reader's bounds are the sea's, and exclude kelvin
    "water.particles",                // a share of what is usual
    "water.phase.henyey_greenstein",  // a mean cosine
    "water.phase.fournier_forand.backscatter_ratio",
    "water.phase.fournier_forand.index",
    "water.phase.fournier_forand.slope",
    "beam.*.cones[].exponent",
    "beam.*.cones[].edge_deg",  // any, from a sharp edge up
    "beam.*.window",            // an index
};

// Each key with a range of numbers in the manual's tables of keys has an entry, or a reason to have
// none.
TEST(Plausibility, EveryNumberOfARigIsJudged) {
    const std::map<std::string, std::string> kPrefixes{{"`[sled]`", "sled."},
                                                       {"`[camera]`", "camera."},
                                                       {"`[camera.port]`", "camera.port."},
                                                       {"`[water]`", "water."},
                                                       {"`[seafloor]`", "seafloor."},
                                                       {"`[beam.NAME]`", "beam.*."},
                                                       {"`[[strobe]]`", "strobe[]."},
                                                       {"`[[object]]`", "object[]."}};
    std::istringstream manual(read_text_file(APHOTIC_SOURCE_DIR "/docs/reference/rig.md"));
    std::string line;
    std::string prefix;
    std::size_t keys = 0;
    while (std::getline(manual, line)) {
        if (line.starts_with("### ")) {
            const auto found = kPrefixes.find(line.substr(4));
            prefix = found == kPrefixes.end() ? "" : found->second;
        }
        if (line.starts_with("## ")) prefix.clear();
        const bool is_number =
            line.find(" to ") != std::string::npos && line.find("CSV") == std::string::npos;
        if (prefix.empty() || !line.starts_with("| `") || !is_number) continue;
        const std::string names = line.substr(2, line.find(" | ", 2) - 2);
        for (std::size_t at = names.find('`'); at != std::string::npos; at = names.find('`', at)) {
            const std::size_t end = names.find('`', at + 1);
            const std::string name = names.substr(at + 1, end - at - 1);
            const bool is_of_cone =
                prefix == "beam.*." && (name == "half_angle_deg" || name == "weight" ||
                                        name == "exponent" || name == "edge_deg");
            const std::string key =
                prefix + (is_of_cone ? "cones[]." : "") + (name == "aim" ? "aim.tilt_deg" : name);
            EXPECT_NE(is_judged_alone(key), kElsewhere.contains(key)) << key;
            ++keys;
            at = end + 1;
        }
    }
    EXPECT_GT(keys, 40U);
}

// As people build them: from tanks to vehicles 12 m up, from spots to bare bulbs, aimed at what the
// camera sees or some degrees beside it.
std::string ordinary_rig(std::uint64_t seed) {
    Dice dice(seed);
    const double altitude_m = dice.over_octaves(0.3, 12.0);
    const int width_px = dice.whole(320, 6000);
    const double pitch_um = dice.over_octaves(1.4, 10.0) * (width_px < 800 ? 4.0 : 1.0);
    std::string text = fmt::format(
        "[sled]\naltitude_m = {}\npitch_deg = {}\nroll_deg = {}\n[camera]\nresolution = [{}, {}]\n"
        "range_nm = [440, 690]\nresponse = \"nikon-d5100\"\n",
        altitude_m,
        dice.between(-25.0, 25.0),
        dice.between(-25.0, 25.0),
        width_px,
        static_cast<int>(width_px * dice.between(0.5, 1.0)));
    if (dice.chance(0.3)) {
        text += fmt::format("fov_deg = {}\n", dice.between(15.0, 100.0));
    } else {
        const double half = 0.5 * width_px * pitch_um * 1e-3;
        text += fmt::format("pixel_pitch_um = {}\nfocal_length_mm = {}\n",
                            pitch_um,
                            half / std::tan(0.5 * dice.between(15.0, 100.0) * kDegree));
    }
    if (dice.chance(0.3)) {
        text += fmt::format(
            "[camera.port]\nshape = \"flat\"\ndistance_mm = {}\nthickness_mm = {}\nglass = "
            "\"bk7\"\n",
            dice.over_octaves(5.0, 200.0),
            dice.over_octaves(3.0, 40.0));
    } else if (dice.chance(0.3)) {
        text += fmt::format(
            "[camera.port]\nshape = \"dome\"\nradius_mm = {}\nthickness_mm = {}\nglass = \"bk7\"\n",
            dice.over_octaves(25.0, 150.0),
            dice.over_octaves(3.0, 15.0));
    }
    text += "[water]\n";
    if (dice.chance(0.3)) text += fmt::format("multiple = {}\n", dice.between(0.0, 5.0));
    if (dice.chance(0.3)) text += fmt::format("uniform_loss_per_m = {}\n", dice.between(0.0, 1.0));
    text += "[seafloor]\n[beam.b]\n";
    if (dice.chance(0.4)) {
        text += fmt::format("fwhm_deg = {}\n", dice.over_octaves(8.0, 140.0));
    } else if (dice.chance(0.5)) {
        text += fmt::format("cones = [{{ part = \"a\", half_angle_deg = {}, weight = {} }}]\n",
                            dice.over_octaves(5.0, 90.0),
                            dice.over_octaves(0.1, 10.0));
    } else {
        const double size_mm = dice.over_octaves(3.0, 100.0);
        text += fmt::format(
            "diffuser_mm = [{}, {}]\nfocal_length_mm = {}\ndistance_mm = {}\naperture_mm = {}\n",
            size_mm,
            size_mm * dice.between(0.3, 1.0),
            size_mm * dice.between(0.7, 2.0),
            size_mm * dice.between(0.3, 0.7),
            size_mm * dice.between(1.0, 2.0));
    }
    return text;
}

// With strobes that are aimed at some point in view of the camera.
std::string with_strobes(std::string text, std::uint64_t seed) {
    Dice dice(~seed);
    const std::string first =
        "[[strobe]]\nname = \"0\"\nposition_m = [0.4, 0, 0]\ndirection = [0, 0, 1]\nbeam = \"b\"\n";
    const Rig rig = parse_rig(text + first, "rig.toml", "");
    const int strobes = dice.whole(1, 8);
    for (int s = 0; s < strobes; ++s) {
        const Eigen::Vector3d place_m = random_position_m(dice, rig.sled);
        const Eigen::Vector3d axis = random_aim_m(dice, rig) - place_m;
        text += fmt::format(
            "[[strobe]]\nname = \"{}\"\nposition_m = [{}]\ndirection = [{}]\nbeam = \"b\"\n",
            s,
            fmt::join(place_m, ", "),
            fmt::join(axis, ", "));
        if (dice.chance(0.5))
            text += fmt::format("luminous_flux_lm = {}\n", dice.over_octaves(300.0, 3e6));
        if (dice.chance(0.3))
            text += fmt::format("emitter_mm = [{}, 20]\n", dice.over_octaves(2.0, 400.0));
    }
    return text;
}

TEST(Plausibility, OrdinaryRigsAreNotDoubted) {
    const auto rigs = static_cast<std::uint64_t>(campaign(40, 1000));
    for (std::uint64_t seed = 0; seed < rigs; ++seed) {
        const std::string text = with_strobes(ordinary_rig(seed), seed);
        const std::vector<Doubt> doubts = doubts_of_text(text, "");
        EXPECT_TRUE(doubts.empty()) << seed << "\n" << words_of(doubts);
        const std::vector<Doubt> of_random = doubts_of(random_rig(seed));
        EXPECT_TRUE(of_random.empty()) << "random_rig " << seed << "\n" << words_of(of_random);
    }
}

}  // namespace
}  // namespace aphotic::plausibility_test
