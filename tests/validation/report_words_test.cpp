// SPDX-License-Identifier: BSD-3-Clause
#include "validation/report_words.h"

#include "rig/rig_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace aphotic::report_words_test {
namespace {

double radians(double deg) {
    return deg * std::numbers::pi / 180.0;
}

Rig habcam() {
    return read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
}

#define EXPECT_SAYS(text, words) \
    EXPECT_NE((text).find(words), std::string::npos) << "not in it: " << (words) << '\n' << (text)

TEST(PlaceInWords, NamesTheSidesOfTheSled) {
    EXPECT_EQ(place_in_words({0.5, 0.0, 0.0}), "0.5 m forward from the entrance pupil");
    EXPECT_EQ(place_in_words({-0.5, 0.2, 0.0}),
              "0.5 m aft and 0.2 m to starboard from the entrance pupil");
    EXPECT_EQ(place_in_words({0.1, -0.2, -0.3}),
              "0.1 m forward, 0.2 m to port and 0.3 m up from the entrance pupil");
    EXPECT_EQ(place_in_words({0.0, 0.0, 0.0}), "at the entrance pupil");
}

TEST(AimInWords, NamesTheTiltAndItsDirection) {
    const double s = std::sin(radians(26.0));
    const double c = std::cos(radians(26.0));
    EXPECT_EQ(aim_in_words({0.0, 0.0, 1.0}), "along the camera’s axis");
    EXPECT_EQ(aim_in_words({s, 0.0, c}), "26° off the camera’s axis, towards forward");
    EXPECT_EQ(aim_in_words({-s, 0.0, c}), "26° off the camera’s axis, towards aft");
    EXPECT_EQ(aim_in_words({0.0, -s, c}), "26° off the camera’s axis, towards port");
    EXPECT_EQ(aim_in_words({s * std::cos(radians(30.0)), s * std::sin(radians(30.0)), c}),
              "26° off the camera’s axis, towards 30° to starboard of forward");
    EXPECT_EQ(aim_in_words({-1.0, 0.0, 0.0}), "90° off the camera’s axis, towards aft");
    EXPECT_EQ(aim_in_words({0.0, 0.0, -1.0}), "straight up");
}

TEST(RigInWords, TellsWhatTheRigFileSays) {
    const std::string words = rig_in_words(habcam());
    EXPECT_SAYS(words, "2 m above the floor; bow up by 5°, level athwartships");
    EXPECT_SAYS(words, "1360 × 1024 pixels of 6.45 µm behind a lens of 12 mm");
    // By hand: 2 atan(1360 * 6.45e-3 / 24) = 40.16 degrees; 2 atan(1024 ...) = 30.79.
    EXPECT_SAYS(words, "40.2° × 30.8°");
    EXPECT_SAYS(words, "None: the entrance pupil is in the water");
    EXPECT_SAYS(words, "water absorption &#39;pope-fry-1997&#39;");
    EXPECT_SAYS(words, "reflectance &#39;sand&#39;");
    EXPECT_SAYS(words, "<dt>Strobe <bdi>starboard</bdi></dt>");
    EXPECT_SAYS(words, "lamp spectrum &#39;xenon-flash&#39;");
    EXPECT_SAYS(words, "<bdi>focused</bdi> within 26.565° (weight 0.094)");
    EXPECT_SAYS(words, "a share of the lamp’s flux");
    EXPECT_EQ(words.find("Beam"), words.rfind("Beam")) << "a beam of four strobes is told once";
}

TEST(RigInWords, TellsPortEmitterHighlightAndAttitude) {
    Rig rig = habcam();
    rig.sled.pitch_rad = radians(-3.0);
    rig.sled.roll_rad = radians(-2.0);
    rig.camera.port =
        FlatPort{.distance_m = 0.05, .thickness_m = 0.012, .glass = builtin_glass("bk7")};
    rig.seafloor.phong = 0.3;
    rig.strobes[0].emitter = Emitter{.across_m = 0.0635, .along_m = 0.0302};
    rig.strobes[0].beam.weights = ConeWeights::Literal;
    rig.water.multiple = 0.5;
    rig.water.uniform_loss_per_m = 0.02;
    const std::string words = rig_in_words(rig);
    EXPECT_SAYS(words, "bow down by 3°, starboard up by 2°");
    EXPECT_SAYS(words, "Flat, 12 mm of <bdi>bk7</bdi>, its inner face 50 mm before");
    EXPECT_SAYS(words, "in air, ");
    EXPECT_SAYS(words, "35 psu at 10 °C");
    EXPECT_SAYS(words, "a Phong highlight of 0.3 and size 40");
    EXPECT_SAYS(words, "A lit rectangle of 63.5 mm across and 30.2 mm along");
    EXPECT_SAYS(words, "0.5 times the <bdi>water absorption");
    EXPECT_SAYS(words, "0.02 per metre at every wavelength");
    EXPECT_SAYS(words, "an intensity on the axis");
    EXPECT_NE(words.find("Beam"), words.rfind("Beam")) << "two beams of one name, both told";
}

// By hand, from scenes/objects.toml: corners at (0.02, 0.30, 1.76) and (0.26, 0.48, 2.2).
TEST(RigInWords, TellsEveryObject) {
    const std::string words =
        rig_in_words(read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/objects.toml"));
    EXPECT_SAYS(
        words,
        "<dt>Object <bdi>ball</bdi></dt><dd>A sphere of 0.12 m radius, its middle 0.2 m aft, "
        "0.05 m to starboard and 1.86 m down from the entrance pupil, with the "
        "<bdi>reflectance &#39;green-algae&#39;</bdi> and a Phong highlight of 0.05 and size "
        "30.</dd>");
    EXPECT_SAYS(
        words,
        "<dt>Object <bdi>block</bdi></dt><dd>A box 0.24 m fore and aft, 0.18 m athwartships "
        "and 0.44 m high, its middle 0.14 m forward, 0.39 m to starboard and 1.98 m down "
        "from the entrance pupil, with the ");
    EXPECT_SAYS(words, "<dt>Object <bdi>rock</bdi></dt><dd>A mesh of ");
    EXPECT_SAYS(words, " and no highlight.</dd>");
    EXPECT_EQ(rig_in_words(habcam()).find("Object"), std::string::npos);
}

// A tetrahedron of four triangles between two corners.
TEST(RigInWords, TellsAMeshByItsTrianglesAndItsExtent) {
    Rig rig = habcam();
    rig.objects = {{.name = "thing",
                    .shape = Mesh{.vertices_m = {{0, 0, 1}, {0.5, 0, 1}, {0, 0.25, 1}, {0, 0, 2}},
                                  .triangles = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}},
                    .reflectance = rig.seafloor.reflectance}};
    EXPECT_SAYS(
        rig_in_words(rig),
        "A mesh of 4 triangles, 0.5 m fore and aft, 0.25 m athwartships and 1 m high, its "
        "middle 0.25 m forward, 0.125 m to starboard and 1.5 m down from the entrance pupil");
}

TEST(RigInWords, TellsWhichSceneTheReferenceDoesNotRead) {
    EXPECT_EQ(rig_in_words(habcam()).find("Scene"), std::string::npos);
    const std::string words = rig_in_words(habcam(), "my <reef>.pov");
    EXPECT_SAYS(words, "POV-Ray rendered <code>my &lt;reef&gt;.pov</code>");
    EXPECT_SAYS(words, "The reference does not read it");
}

TEST(RigInWords, SaysWhenTheWaterIsClear) {
    Rig rig = habcam();
    rig.water.multiple = 0.0;
    EXPECT_SAYS(rig_in_words(rig), "as clear as air");
}

TEST(RigInWords, EscapesWhatUsersNamed) {
    Rig rig = habcam();
    rig.strobes[0].name = "</dd><script>";
    rig.strobes[0].beam.name = "<i>";
    rig.strobes[0].beam.cones[0].part = "\"&";
    const std::string words = rig_in_words(rig);
    EXPECT_EQ(words.find("<script"), std::string::npos);
    EXPECT_EQ(words.find("<i>"), std::string::npos);
    EXPECT_SAYS(words, "&lt;/dd&gt;&lt;script&gt;");
    EXPECT_SAYS(words, "&quot;&amp;");
}

}  // namespace
}  // namespace aphotic::report_words_test
