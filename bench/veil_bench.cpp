// SPDX-License-Identifier: BSD-3-Clause
//
// The cost of the veil in a render in scattering water: the processor time of its planes, written
// to disk, compared with POV-Ray's for the frames, the least of several passes each. (Goal: under a
// tenth.) Smooth beams, and HabCam's sharp cones, along whose edges the veil is computed pixel by
// pixel; both in Jerlov's 1C.
#include "bench/processor_time.h"
#include "plugin/frame_runner.h"
#include "plugin/render.h"
#include "rig/file/rig_text.h"
#include "scene_gen/render_plan.h"
#include "scene_gen/veil_planes.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace aphotic {
namespace {

namespace fs = std::filesystem;

Rig in_coastal_water(const std::string& name) {
    RigText text(APHOTIC_SOURCE_DIR "/scenes/" + name + ".toml");
    text.erase("water.absorption");
    text.erase("water.multiple");
    text.set("water.type", "jerlov-1C");
    text.set("camera.range_nm", std::vector<double>{400.0, 700.0});  // where Jerlov's tables end
    return text.rig();
}

void veil_beside_frames(benchmark::State& state, const std::string& name) {
    const Rig rig = in_coastal_water(name);
    const SceneSet set = make_scene_set(rig, plan_render(rig, {}));
    const PovRay povray = find_povray("");
    const fs::path folder =
        fs::temp_directory_path() / fmt::format("aphotic-veil-bench-{}-{}", ::getpid(), name);
    double frames_s = std::numeric_limits<double>::infinity();
    double veil_s = std::numeric_limits<double>::infinity();
    for (auto _ : state) {
        fs::remove_all(folder);
        const Manifest manifest = generate(folder, set);
        const double children_s = processor_s(RUSAGE_CHILDREN);
        run_frames(povray, folder, manifest.frames, manifest.width_px, manifest.height_px, {});
        frames_s = std::min(frames_s, processor_s(RUSAGE_CHILDREN) - children_s);
        const double own_s = processor_s(RUSAGE_SELF);
        write_veil(folder, rig, manifest, 1);
        veil_s = std::min(veil_s, processor_s(RUSAGE_SELF) - own_s);
    }
    fs::remove_all(folder);
    state.counters["frames_s"] = frames_s;
    state.counters["veil_s"] = veil_s;
    state.counters["veil_over_frames"] = veil_s / frames_s;
}

void few(benchmark::internal::Benchmark* benchmark) {
    benchmark->Unit(benchmark::kSecond)->UseRealTime()->Iterations(8);
}
BENCHMARK_CAPTURE(veil_beside_frames, smooth, "habcam-led")->Apply(few);
BENCHMARK_CAPTURE(veil_beside_frames, sharp_cones, "habcam")->Apply(few);

}  // namespace
}  // namespace aphotic
