// SPDX-License-Identifier: BSD-3-Clause
//
// POV-Ray's traps: each gives a plausible picture. Every test here falls into one on purpose, by
// changing a scene's text, and demands that the comparison with the closed form sees it. So the
// tests of closed_form_test.cpp would turn red if the generator fell into it. cli/sabotage_test.cpp
// has others, of which `aphotic validate` itself must tell.
//
// POV-Ray's default ambient light is no trap here, though the scenes switch it off: against
// frames that peak near 2^13 a tenth of the floor's reflectance is under the rounding.
#include "support/rendered.h"

#include "base/error.h"

namespace aphotic::traps_test {
namespace {

// What a trap must at least cost to count as seen: ten times what rounding may.
constexpr double kSeen = 10.0 * kHalfFloatError;

struct Change {
    const char* text;         // in the scene
    const char* replacement;  // what someone might have written
};

struct Trap {
    const char* name;
    std::vector<Change> changes;
    std::function<void(Rig&)> prepare = [](Rig&) {};
};

void PrintTo(const Trap& trap, std::ostream* out) {
    *out << trap.name;
}

void give_port(Rig& rig) {
    rig.camera.port = {.distance_m = 0.05, .thickness_m = 0.012, .glass = builtin_glass("bk7")};
}

const std::vector<Trap> kTraps{
    {"InteractionOff", {{"media_attenuation on", "media_attenuation on media_interaction off"}}},
    {"FadeDistanceZeroFadesNothing",
     {{"fade_distance Aphotic_Fade_Distance / Aphotic_Unit", "fade_distance 0"}}},
    {"DefaultFinish",
     {{"#default {", "#declare Unused = texture {"}, {"ambient 0  emission 0  diffuse 1\n", "\n"}}},
    {"DefaultRight", {{"right x *", "right x * 1.33 * Focal_Length //"}}},
    {"GammaOfTheDisplay", {{"assumed_gamma 1.0", "assumed_gamma 2.2"}}},
    {"SoftConeEdge", {{"falloff min(Widest, Half_Angle", "falloff min(Widest, 5 + Half_Angle"}}},
    {"NoCosineInTheCone", {{"tightness Exponent", "tightness 0"}}},
    {"PointAtIsNoDirection", {{"point_at Position + Axis", "point_at Axis"}}},
    {"IndexOfAirForWater", {{"ior Index / Aphotic_Water_Index", "ior Index"}}, give_port},
};

// Without symmetry between fore and aft or port and starboard.
Rig trap_rig() {
    Rig rig = small_habcam(34, 26);
    rig.sled.roll_rad = 0.1;
    rig.strobes.pop_back();
    return rig;
}

class Traps : public testing::TestWithParam<Trap> {};

TEST_P(Traps, AreSeen) {
    const Trap& trap = GetParam();
    Rig rig = trap_rig();
    trap.prepare(rig);
    SceneSet set =
        scenes_of(rig, rig.camera.port ? std::vector{620.0} : std::vector{470.0, 550.0, 620.0});
    ASSERT_LE(against_closed_form(rig, set).worst, kHalfFloatError) << "the scene itself is wrong";

    std::string& sdl = set.scenes.front().sdl;
    sdl = with_library(sdl);
    for (const Change& change : trap.changes) sdl = replaced(sdl, change.text, change.replacement);
    try {
        EXPECT_GT(against_closed_form(rig, set).worst, kSeen);
    } catch (const RunError& error) {
        // A frame out of range is refused as it arrives: louder than any comparison.
        EXPECT_NE(std::string(error.what()).find("inf"), std::string::npos) << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(All, Traps, testing::ValuesIn(kTraps), [](const auto& trap) {
    return std::string(trap.param.name);
});

// The half float itself: without exposures the dark end of the spectrum is lost among the
// denormals, which is what exposure.h is for.
TEST(Traps, WithoutExposuresDarkWavelengthsLoseTheirDigits) {
    Rig rig = trap_rig();
    rig.sled.altitude_m = 4.0;
    rig.water.multiple = 2.0;
    SceneSet set = scenes_of(rig, {720.0});
    const int exposure = set.manifest.wavelengths[0].exposure_log2;
    ASSERT_GT(exposure, 0);
    std::string& sdl = set.scenes.front().sdl;
    sdl = replaced(with_library(sdl),
                   "Position, rgb Colour",
                   "Position, rgb pow(2, -" + std::to_string(exposure) + ") * Colour");
    set.manifest.wavelengths[0].exposure_log2 = 0;
    const Difference found = against_closed_form(rig, set);
    EXPECT_LT(found.brightest_sample, kSmallestNormalHalf);
    EXPECT_GT(found.worst_of_lit, kSeen) << testing::PrintToString(found);
}

// Three wavelengths in a frame are the same three bits as each by itself.
TEST(Traps, PackingChangesNoBit) {
    const Rig rig = small_habcam();
    const std::vector<double> lambda_nm{470.0, 550.0, 620.0, 700.0};
    const TempFolder packed_folder;
    const TempFolder mono_folder;
    const PovRay povray = find_povray("");
    const RunOptions run{.jobs = 2, .report = {}};
    const Manifest packed =
        render(povray, packed_folder.path(), scenes_of(rig, lambda_nm), run).manifest;
    const Manifest mono =
        render(
            povray,
            mono_folder.path(),
            scenes_of(rig, lambda_nm, {.wavelengths_per_frame = 1, .emitter_lamps = std::nullopt}),
            run)
            .manifest;
    ASSERT_EQ(packed.frames.size(), 2U);
    ASSERT_EQ(mono.frames.size(), 4U);
    const auto samples_of = [&](const TempFolder& folder, const Manifest& manifest, std::size_t j) {
        const PlannedWavelength& w = manifest.wavelengths[j];
        ExrReader frame(image_path(folder.path(), manifest.frames[w.frame]));
        std::vector<float> samples(static_cast<std::size_t>(rig.camera.width_px) *
                                   static_cast<std::size_t>(rig.camera.height_px));
        const std::string channel(kChannelNames[w.channel]);
        frame.read_rows(0, rig.camera.height_px, std::span(&channel, 1), samples);
        return samples;
    };
    for (std::size_t j = 0; j < lambda_nm.size(); ++j) {
        EXPECT_EQ(samples_of(packed_folder, packed, j), samples_of(mono_folder, mono, j))
            << lambda_nm[j] << " nm";
        EXPECT_EQ(packed.wavelengths[j].exposure_log2, mono.wavelengths[j].exposure_log2);
    }
}

}  // namespace
}  // namespace aphotic::traps_test
