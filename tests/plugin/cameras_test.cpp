// SPDX-License-Identifier: BSD-3-Clause
//
// Calibrated lenses and ports of every kind through real POV-Ray, against the reference at every
// pixel: rigs that nobody chose, over tilted floors.
#include "image/output_images.h"
#include "rig/camera/lens.h"
#include "spectral/integrator.h"
#include "support/effort.h"
#include "support/random_camera.h"
#include "support/random_rig.h"
#include "support/rendered.h"
#include "validation/tracer.h"

#include <cstdlib>
#include <iostream>

namespace aphotic::cameras_test {
namespace {

constexpr std::uint64_t kSeed = 16'000;
constexpr double kMiddle_nm = 550.0;

struct Worst {
    double error = 0.0;
    std::size_t lit = 0;
    std::size_t on_edges = 0;
};

Worst against_the_reference(const Rig& rig, const std::vector<std::string>& ini_lines = {}) {
    const TempFolder folder;
    const SceneSet set = scenes_of(
        rig, {kMiddle_nm}, {.pixel_shift = 0.0, .emitter_lamps = {}, .ini_lines = ini_lines});
    const RenderResult result =
        render(find_povray(""), folder.path(), set, {.jobs = 1, .report = {}});
    integrate(folder.path(), result.manifest);
    ExrReader image(folder.path() / "spectral.exr");
    const std::vector<std::string> planes = image.channels();
    const std::vector<float> radiance = image.planes(std::span(planes).last(1));
    const Tracer tracer(rig, {.signals = false, .planes_nm = {kMiddle_nm}, .threads = 2});
    const std::vector<double> traced = tracer.rows(0, rig.camera.height_px);
    const std::vector<unsigned char> on_edge = tracer.on_edges({kMiddle_nm, kMiddle_nm});
    const double black =
        std::ldexp(kSmallestNormalHalf, -result.manifest.wavelengths[0].exposure_log2);
    Worst worst;
    for (std::size_t i = 0; i < traced.size(); ++i) {
        worst.on_edges += on_edge[i];
        if (on_edge[i] != 0) continue;
        worst.lit += traced[i] > 0.0 ? 1 : 0;
        const double error = std::abs(radiance[i] - traced[i]) / std::max(traced[i], black);
        worst.error = std::max(worst.error, error);
    }
    return worst;
}

// The first rigs from a seed on that light half of what they see.
template <typename Change>
void expect_agreement(int rigs, const Change& change) {
    int compared = 0;
    for (std::uint64_t seed = kSeed; compared < rigs; ++seed) {
        Dice dice(seed);
        Rig rig = random_rig(seed);
        rig.camera.port.reset();
        change(dice, rig.camera);
        SCOPED_TRACE(in_words(seed, rig));
        const Tracer tracer(rig, {.signals = false, .planes_nm = {kMiddle_nm}, .threads = 2});
        const std::vector<double> traced = tracer.rows(0, rig.camera.height_px);
        const auto lit = std::ranges::count_if(traced, [](double L) { return L > 0.0; });
        if (2 * lit < static_cast<std::ptrdiff_t>(traced.size())) continue;
        const Worst worst = against_the_reference(rig);
        EXPECT_LE(worst.error, kHalfFloatError) << worst.lit << " lit pixels compared";
        EXPECT_LT(worst.on_edges, traced.size() / 20);
        ++compared;
    }
}

TEST(Cameras, LensesOfEveryKindAreTheReferences) {
    for (const LensKind kind : kLensKinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        expect_agreement(2, [kind](Dice& dice, Camera& camera) { give_lens(kind, dice, camera); });
    }
}

// So many pixels that the mesh has fewer points, behind a port that is tilted.
TEST(Cameras, LensesOfManyPixelsAreTheReferences) {
    for (const LensKind kind : kLensKinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        expect_agreement(1, [kind](Dice& dice, Camera& camera) {
            constexpr int kTimes = 8;
            enlarge_pixels(
                camera, 1.0 / kTimes, kTimes * camera.width_px, kTimes * camera.height_px);
            give_lens(kind, dice, camera);
            give_port(PortKind::Tilted, dice, camera);
        });
    }
}

// A fisheye that sees 160 degrees and the horizon, below which a pixel's floor may be a kilometre
// away, and above which it sees nothing.
TEST(Cameras, AFisheyeThatSeesTheHorizonIsTheReference) {
    Rig rig = small_habcam(96, 72);
    rig.sled.pitch_rad = 0.7;
    rig.water.multiple = 0.01;
    const double focal_px = 60.0 / (80.0 * kDegree);
    rig.camera.lens =
        LensModel{.focal_px = {focal_px, focal_px}, .centre_px = {48.0, 36.0}, .is_fisheye = true};
    const Tracer tracer(rig, {.signals = false, .planes_nm = {kMiddle_nm}, .threads = 2});
    const std::vector<double> traced = tracer.rows(0, rig.camera.height_px);
    EXPECT_GT(std::ranges::count(traced, 0.0), 100);
    const Worst worst = against_the_reference(rig);
    EXPECT_LE(worst.error, kHalfFloatError);
    EXPECT_GT(worst.lit, traced.size() / 4);
}

// Rays between pixels' centres, each that of a camera with pixels of a third. POV-Ray counts the
// one through the centre twice, and has for the first row and the last column but the rays along
// them.
TEST(Cameras, AntialiasingThroughALensIsTheMeanOfItsRays) {
    constexpr int kAcross = 3;
    Rig rig = small_habcam(120, 90);
    rig.camera.lens = LensModel{
        .focal_px = {130.0, 131.0}, .centre_px = {61.0, 44.0}, .radial = {-0.2, 0.05, 0.0, 0.0}};
    Rig fine = rig;
    const int width = rig.camera.width_px;
    const int height = rig.camera.height_px;
    enlarge_pixels(fine.camera, 1.0 / kAcross, kAcross * width, kAcross * height);
    const Tracer tracer(fine, {.signals = false, .planes_nm = {kMiddle_nm}, .threads = 2});
    const std::vector<double> traced = tracer.rows(0, kAcross * height);
    const std::vector<unsigned char> on_edge = tracer.on_edges({kMiddle_nm, kMiddle_nm});

    const TempFolder folder;
    const SceneSet set = scenes_of(
        rig, {kMiddle_nm}, {.pixel_shift = 0.0, .emitter_lamps = {}, .antialias = kAcross});
    const RenderResult result =
        render(find_povray(""), folder.path(), set, {.jobs = 1, .report = {}});
    integrate(folder.path(), result.manifest);
    ExrReader image(folder.path() / "spectral.exr");
    const std::vector<std::string> planes = image.channels();
    const std::vector<float> radiance = image.planes(std::span(planes).last(1));

    int compared = 0;
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column) {
            const auto fine_at = [&](int x, int y) {
                const int below = row > 0 ? y : 1;
                const int beside = column + 1 < width ? x : 1;
                return static_cast<std::size_t>((kAcross * row + below) * kAcross * width +
                                                kAcross * column + beside);
            };
            double sum = traced[fine_at(1, 1)];
            bool is_clear = true;
            for (int y = 0; y < kAcross; ++y) {
                for (int x = 0; x < kAcross; ++x) {
                    sum += traced[fine_at(x, y)];
                    is_clear = is_clear && on_edge[fine_at(x, y)] == 0;
                }
            }
            if (!is_clear) continue;
            ++compared;
            const double expected = sum / (1 + kAcross * kAcross);
            ASSERT_NEAR(radiance[static_cast<std::size_t>(row * width + column)] / expected,
                        1.0,
                        kHalfFloatError)
                << "column " << column << ", row " << row;
        }
    }
    EXPECT_GT(compared, width * height / 2);
}

TEST(Cameras, PortsOfEveryKindAreTheReferences) {
    for (const PortKind kind : kPortKinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        expect_agreement(2, [kind](Dice& dice, Camera& camera) { give_port(kind, dice, camera); });
    }
}

TEST(Cameras, VignettingLensesBehindPortsAreTheReferences) {
    for (const PortKind kind : kPortKinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        expect_agreement(1, [kind](Dice& dice, Camera& camera) {
            give_port(kind, dice, camera);
            give_lens(LensKind::RadialTangential, dice, camera);
            give_vignetting(static_cast<std::size_t>(kind), dice, camera);
        });
    }
}

// --- Ports of any size ---------------------------------------------------------------------------

// Without bounding POV-Ray looks at all objects in the scene's order; with it, in that of a tree.
const std::vector<std::string> kBoundings{
    "Bounding=off\n", "Bounding=on\nBounding_Threshold=1\n", "Bounding_Method=2\n"};

PortWindow any_port(PortKind kind, Dice& dice) {
    constexpr std::array<std::string_view, 5> kGlasses{
        "bk7", "fused-silica", "sapphire", "pmma", "polycarbonate"};
    PortWindow port{.thickness_m = dice.over_octaves(1e-3, 1.0),
                    .glass = builtin_glass(dice.one_of(kGlasses))};
    const Eigen::Vector3d aside =
        Eigen::AngleAxisd(dice.between(0.0, 2.0 * std::numbers::pi), Eigen::Vector3d::UnitZ()) *
        Eigen::Vector3d::UnitX();
    if (kind == PortKind::Dome) {
        const double radius_m = dice.over_octaves(1e-3, 10.0);
        // As often a hair's breadth from the glass as in the middle.
        const double off_m = dice.chance(0.5) ? radius_m * dice.between(0.0, 1.0)
                                              : radius_m - dice.over_octaves(2e-5, radius_m);
        const Eigen::Vector3d towards =
            Eigen::AngleAxisd(dice.between(0.0, std::numbers::pi), aside) *
            Eigen::Vector3d::UnitZ();
        port.dome = Dome{.centre_m = off_m * towards, .radius_m = radius_m};
        return port;
    }
    port.distance_m = dice.over_octaves(1e-3, 10.0);
    if (kind == PortKind::Tilted) {
        port.normal =
            Eigen::AngleAxisd(dice.between(0.0, 60.0) * kDegree, aside) * Eigen::Vector3d::UnitZ();
    }
    return port;
}

// Around the port: all else so much larger that lamps and floor are outside, and the water clearer.
// None where POV-Ray cannot have such a port.
std::optional<Rig> rig_around(Rig rig, const PortWindow& port) {
    constexpr double kLargest = 0x1p14;
    rig.camera.port = port;
    rig.camera.range.first_nm = std::max(rig.camera.range.first_nm, port.glass.range().first_nm);
    for (double times = 1.0; times < kLargest; times *= 2.0) {
        Rig larger = rig;
        larger.sled.altitude_m *= times;
        larger.water.multiple /= times;
        larger.water.uniform_loss_per_m /= times;
        for (Strobe& strobe : larger.strobes) strobe.position_m *= times;
        if (front_m(larger.camera.port) > 0.5 * larger.sled.altitude_m) continue;
        try {
            scenes_of(larger, {kMiddle_nm});
            return larger;
        } catch (const InputError& error) {
            const std::string said = error.what();
            if (said.find("housing") == std::string::npos) return std::nullopt;
        }
    }
    return std::nullopt;
}

// All that the reader takes, and far beyond what is built; each by one way of bounding, in the
// night by all.
TEST(Cameras, PortsOfAnySizeAreTheReferencesHoweverPovrayBoundsThem) {
    const int ports = campaign(6, 300);
    const bool by_all_boundings = is_night();
    int compared = 0;
    int refused = 0;
    double worst_error = 0.0;
    for (std::uint64_t seed = kSeed; compared < ports; ++seed) {
        Dice dice(seed);
        Rig bare = random_rig(seed);
        enlarge_pixels(bare.camera, 2.0, bare.camera.width_px / 2, bare.camera.height_px / 2);
        const PortKind kind = kPortKinds[seed % kPortKinds.size()];
        const std::optional<Rig> rig = rig_around(bare, any_port(kind, dice));
        if (!rig) {
            ++refused;
            continue;
        }
        SCOPED_TRACE(in_words(seed, *rig) + ", " + port_signature(*rig->camera.port));
        for (std::size_t b = 0; b < kBoundings.size(); ++b) {
            if (!by_all_boundings && b != (seed / kPortKinds.size()) % kBoundings.size()) continue;
            const Worst worst = against_the_reference(*rig, {kBoundings[b]});
            EXPECT_LE(worst.error, kHalfFloatError) << kBoundings[b] << worst.lit << " lit pixels";
            worst_error = std::max(worst_error, worst.error);
        }
        ++compared;
    }
    std::cout << compared << " ports, " << refused << " refused; the worst is off by "
              << worst_error << '\n';
}

// A dome of 8.842... cm began in glass for POV-Ray, one of 8.8 cm in air.
TEST(Cameras, APortOfTwoSpheresBeginsInAirHoweverPovrayBoundsThem) {
    Rig rig = small_habcam(24, 18);
    rig.camera.port = {
        .thickness_m = 0.006,
        .glass = builtin_glass("bk7"),
        .dome = Dome{.centre_m = {0.001, 0.008, 0.002}, .radius_m = 0.08842128833206172}};
    for (const std::string& bounding : kBoundings) {
        EXPECT_LE(against_the_reference(rig, {bounding}).error, kHalfFloatError) << bounding;
    }
}

}  // namespace
}  // namespace aphotic::cameras_test
