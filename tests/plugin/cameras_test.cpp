// SPDX-License-Identifier: BSD-3-Clause
//
// Calibrated lenses and ports of every kind through real POV-Ray, against the reference at every
// pixel: rigs that nobody chose, over tilted floors.
#include "image/output_images.h"
#include "spectral/integrator.h"
#include "support/random_camera.h"
#include "support/random_rig.h"
#include "support/rendered.h"
#include "validation/tracer.h"

namespace aphotic::cameras_test {
namespace {

constexpr std::uint64_t kSeed = 16'000;
constexpr double kMiddle_nm = 550.0;

struct Worst {
    double error = 0.0;
    std::size_t lit = 0;
    std::size_t on_edges = 0;
};

Worst against_the_reference(const Rig& rig) {
    const TempFolder folder;
    const SceneSet set = scenes_of(rig, {kMiddle_nm});
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

}  // namespace
}  // namespace aphotic::cameras_test
