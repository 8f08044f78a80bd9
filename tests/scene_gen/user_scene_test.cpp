// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/user_scene.h"

#include "base/error.h"
#include "support/scene_rig.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::user_scene_test {
namespace {

TEST(UserScene, APathIsToldByWhatTwoLossesLeave) {
    constexpr double kRounding = 1e-14;
    EXPECT_NEAR(measured_path_m(7.0 * std::exp(-0.2 * 3.5), 7.0 * std::exp(0.2 * 3.5), 0.4),
                3.5,
                kRounding);
}

TEST(UserScene, PathsHaveRoomOnBothSides) {
    const PathRange paths = paths_of(
        {{{.radiance_per_flux = 1.0, .path_m = 3.0}},
         {},
         {{.radiance_per_flux = 1.0, .path_m = 2.0}, {.radiance_per_flux = 0.1, .path_m = 5.0}}});
    EXPECT_DOUBLE_EQ(paths.shortest_m, 2.0 / kProbeRoom);
    EXPECT_DOUBLE_EQ(paths.longest_m, 5.0 * kProbeRoom);
    EXPECT_EQ(paths_of({{}, {}}).longest_m, 0.0);
}

// Phi max sum G exp(-K l), over pixels of which the brighter depends on the water.
TEST(UserScene, BrightestIsTheBrightestPixelInThisWater) {
    Rig rig = habcam();
    UserScene scene;
    scene.pixels = {
        {{.radiance_per_flux = 2.0, .path_m = 9.0}},
        {{.radiance_per_flux = 0.5, .path_m = 1.0}, {.radiance_per_flux = 0.5, .path_m = 2.0}}};
    constexpr double kRounding = 1e-14;
    const double flux = rig.strobes[0].spectrum.at(600.0);
    const double K_per_m = rig.water.attenuation_per_m(600.0);
    EXPECT_NEAR(scene.brightest_radiance(rig, 600.0),
                flux * 0.5 * (std::exp(-K_per_m) + std::exp(-2.0 * K_per_m)),
                kRounding);
    rig.water.multiple = 0.0;
    EXPECT_NEAR(scene.brightest_radiance(rig, 600.0), flux * 2.0, kRounding);
}

// What the plan is to serve: the scene's materials, and white for what has a colour of its own.
TEST(UserScene, PlansForItsMaterialsAndForWhite) {
    UserScene scene;
    const std::vector<std::string> names{"red-algae"};
    scene.materials = scene_materials(names, habcam(), "/nowhere/reef.pov");
    const Rig rig = rig_of_scene(habcam(), scene);
    EXPECT_EQ(rig.seafloor.reflectance.at(400.0), 1.0);
    EXPECT_EQ(rig.seafloor.reflectance.at(720.0), 1.0);
    ASSERT_EQ(rig.materials.size(), 1U);
    EXPECT_EQ(rig.materials[0].short_name(), "red-algae");
}

// Beside the scene first: a rig elsewhere may have a table of the same name.
TEST(UserScene, TakesAFileBesideTheSceneBeforeTheRigsOwn) {
    Rig rig = habcam();
    rig.materials = {{"rust", {300.0, 800.0}, {0.25, 0.25}, CurveSource{.table = "a/rust.csv"}}};
    const TempFolder folder;
    const auto rust = [&] {
        const std::vector<std::string> names{"rust.csv"};
        return scene_materials(names, rig, folder.path() / "reef.pov")[0].spectrum.at(500.0);
    };
    EXPECT_EQ(rust(), 0.25);
    write_file(folder.path() / "rust.csv", "wavelength_nm,reflectance\n300,0.5\n800,0.5\n");
    EXPECT_EQ(rust(), 0.5);
    std::filesystem::remove(folder.path() / "rust.csv");
    rig.materials.clear();
    EXPECT_THROW(static_cast<void>(rust()), InputError);
}

// --- What the frames depend on ------------------------------------------------------------------

class SceneDigest : public testing::Test {
  protected:
    SceneDigest() {
        put("reef.pov", "#include \"things.inc\"\n// \"no such file\"\n");
        put("things.inc", "image_map { png \"bark.png\" }\n");
        put("bark.png", "pixels");
        put("other.txt", "other");
        before_ = digest();
    }
    void put(const std::string& name, const std::string& text) {
        write_file(folder_.path() / name, text);
    }
    [[nodiscard]] std::string digest() const {
        return digest_of_scene(folder_.path() / "reef.pov");
    }

    TempFolder folder_;
    std::string before_;
};

TEST_F(SceneDigest, ChangesWithTheSceneAndAllThatItNames) {
    EXPECT_EQ(digest(), before_);
    for (const char* name : {"reef.pov", "things.inc", "bark.png"}) {
        const std::string was = digest();
        std::ofstream(folder_.path() / name, std::ios::app) << " ";
        EXPECT_NE(digest(), was) << name;
    }
}

TEST_F(SceneDigest, DoesNotChangeWithWhatTheSceneDoesNotName) {
    put("other.txt", "changed");
    EXPECT_EQ(digest(), before_);
}

// A regular expression would run out of stack here.
TEST_F(SceneDigest, TakesAMebibyteInQuotes) {
    put("things.inc", "\"" + std::string(1U << 20U, 'x') + "\" \"\"\"bark.png\"");
    const std::string was = digest();
    std::ofstream(folder_.path() / "bark.png", std::ios::app) << " ";
    EXPECT_NE(digest(), was) << "what stands behind it counts";
}

TEST_F(SceneDigest, TellsWhetherTheSceneOpensAFileToWrite) {
    const std::filesystem::path scene = folder_.path() / "reef.pov";
    EXPECT_FALSE(opens_to_write(scene));
    put("things.inc", "#fopen In \"a.txt\" read\n");
    EXPECT_FALSE(opens_to_write(scene));
    put("things.inc", "#fopen Out\n  \"a.txt\"\n  append\n");
    EXPECT_TRUE(opens_to_write(scene));
}

TEST_F(SceneDigest, EndsWhereFilesNameEachOther) {
    put("things.inc", "#include \"reef.pov\"\n#include \"things.inc\"\n");
    EXPECT_NE(digest(), before_);
}

}  // namespace
}  // namespace aphotic::user_scene_test
