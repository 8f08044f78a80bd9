// SPDX-License-Identifier: BSD-3-Clause
//
// What the correction of one HabCam image costs, 1360 x 1024 mosaic to red, green and blue, without
// reading and writing it: each image is worked on by one thread, so the time of two cores an image
// is half of this.
#include "lightmap/cone_edge.h"
#include "rig/rig_reader.h"
#include "survey/correction.h"

#include <benchmark/benchmark.h>

#include <string>

namespace aphotic {
namespace {

Rig habcam() {
    return read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
}

RawImage grey_mosaic(const Camera& camera) {
    constexpr float kGrey = 900.0F;
    RawImage raw{.width_px = camera.width_px,
                 .height_px = camera.height_px,
                 .mosaic = Mosaic::Rggb,
                 .samples = {}};
    raw.samples.assign(raw.pixels(), kGrey);
    return raw;
}

const Correction kCorrection{.gain = {1e-3, 1e-3, 1e-3},
                             .middle = {0.3, 0.3, 0.3},
                             .levels = {.black = 64.0F, .white = 4095.0F},
                             .limit = {}};

void map_of_light(benchmark::State& state) {
    const Rig rig = habcam();
    const LightmapMaker maker(rig, std::nullopt, {});
    for (auto _ : state) benchmark::DoNotOptimize(maker.map(rig.sled));
}

void division(benchmark::State& state) {
    const Rig rig = habcam();
    const Lightmap map = LightmapMaker(rig, std::nullopt, {}).map(rig.sled);
    const RawImage raw = grey_mosaic(rig.camera);
    for (auto _ : state) benchmark::DoNotOptimize(corrected(raw, map, kCorrection));
}

void edges_of_cones(benchmark::State& state) {
    const Rig rig = habcam();
    const ConeEdges edges(rig);
    for (auto _ : state) benchmark::DoNotOptimize(edges.mask(rig.sled, 2));
}

void demosaicing(benchmark::State& state) {
    const Rig rig = habcam();
    const Lightmap map = LightmapMaker(rig, std::nullopt, {}).map(rig.sled);
    const CorrectedImage mosaic = corrected(grey_mosaic(rig.camera), map, kCorrection);
    for (auto _ : state) benchmark::DoNotOptimize(demosaiced(mosaic));
}

BENCHMARK(map_of_light)->Unit(benchmark::kMillisecond);
BENCHMARK(division)->Unit(benchmark::kMillisecond);
BENCHMARK(edges_of_cones)->Unit(benchmark::kMillisecond);
BENCHMARK(demosaicing)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace aphotic
