// SPDX-License-Identifier: BSD-3-Clause
//
// What the plan leaves out changes nothing: put back, it gives the same frames.
#include "scene_gen/light_culling.h"

#include "support/rendered.h"

#include <numbers>

namespace aphotic::light_culling_test {
namespace {

// Half floats of equal light differ by their last bit at most, where a sum's order or an
// exponential of 0 moves it over the middle between two of them: 2^-10 of the value.
constexpr double kLastBit = 1.0 / 1024.0;
// The least that counts: where nothing shines, both are black.
constexpr double kBlack = 6.103515625e-5;

std::vector<float> frame_of(const Rig& rig, bool omit, SceneSet& set) {
    const TempFolder folder;
    set = scenes_of(rig, {450.0, 550.0, 650.0}, {.emitter_lamps = {}, .omit = omit});
    const Manifest manifest =
        render(find_povray(""), folder.path(), set, {.jobs = 2, .report = {}}).manifest;
    ExrReader frame(image_path(folder.path(), manifest.frames.at(0)));
    const std::vector<std::string> channels{"R", "G", "B"};
    std::vector<float> samples(3 * static_cast<std::size_t>(rig.camera.width_px) *
                               static_cast<std::size_t>(rig.camera.height_px));
    frame.read_rows(0, rig.camera.height_px, channels, samples);
    return samples;
}

bool lists(const Rig& rig, const std::string& what, const std::string& reason) {
    return std::ranges::any_of(
        omissions(rig), [&](const Omission& o) { return o.what == what && o.reason == reason; });
}

// The scenes differ, by the text given, and the frames do not.
void expect_no_change(const Rig& rig, const std::string& put_back) {
    SceneSet without;
    SceneSet with;
    const std::vector<float> left_out = frame_of(rig, true, without);
    const std::vector<float> all = frame_of(rig, false, with);
    const auto count = [&](const SceneSet& set) {
        std::size_t found = 0;
        const std::string& sdl = set.scenes.at(0).sdl;
        for (auto at = sdl.find(put_back); at != std::string::npos; at = sdl.find(put_back, at + 1))
            ++found;
        return found;
    };
    EXPECT_GT(count(with), count(without)) << put_back;
    ASSERT_EQ(left_out.size(), all.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double size = std::max<double>(std::abs(all[i]), kBlack);
        worst = std::max(worst, std::abs(left_out[i] - all[i]) / size);
    }
    EXPECT_LE(worst, kLastBit);
    EXPECT_GT(*std::ranges::max_element(all), 100.0F) << "nothing is lit";
}

TEST(Omissions, AMediumInClearWater) {
    Rig rig = small_habcam();
    rig.water.multiple = 0.0;
    ASSERT_TRUE(lists(rig, "the water's medium", "clear water attenuates nothing"));
    expect_no_change(rig, "Aphotic_Everything = true");
}

TEST(Omissions, AHighlightOfStrengthZero) {
    const Rig rig = small_habcam();
    ASSERT_TRUE(lists(rig, "the floor's highlight", "its strength is 0"));
    expect_no_change(rig, "Aphotic_Everything = true");
}

TEST(Omissions, AConeOfWeightZero) {
    Rig rig = small_habcam();
    rig.strobes[1].beam.cones[0].weight = 0.0;
    ASSERT_TRUE(lists(rig, "the collimated cone of strobe 'aft'", "its weight is 0"));
    expect_no_change(rig, "// collimated");
}

TEST(Omissions, AStrobeOfPowerZero) {
    Rig rig = small_habcam();
    rig.strobes[2].power = 0.0;
    ASSERT_TRUE(lists(rig, "strobe 'port'", "its power is 0"));
    expect_no_change(rig, "Aphotic_Strobe (");
}

// Turned 70 degrees away from straight down, away from the camera's axis, two of its cones miss
// the view.
TEST(Omissions, AConeThatLightsNothingInView) {
    Rig rig = small_habcam();
    constexpr double kAway_rad = 70.0 * std::numbers::pi / 180.0;
    rig.strobes[0].axis = {std::sin(kAway_rad), 0.0, std::cos(kAway_rad)};
    ASSERT_TRUE(lists(rig, "the collimated cone of strobe 'fore'", "it lights nothing in view"));
    ASSERT_TRUE(lists(rig, "the focused cone of strobe 'fore'", "it lights nothing in view"));
    expect_no_change(rig, "// focused");
}

}  // namespace
}  // namespace aphotic::light_culling_test
