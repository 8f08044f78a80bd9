// SPDX-License-Identifier: BSD-3-Clause
//
// How long a plan takes: HabCam's, that of all its altitudes, and of ten materials over forty
// metres of paths. (Goals: under 0.2 s for HabCam, under 2 s for the ten.)
#include "rig/rig_reader.h"
#include "scene_gen/render_plan.h"
#include "spectral/curve_loader.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace aphotic {
namespace {

Rig habcam() {
    return read_rig(APHOTIC_SOURCE_DIR "/scenes/habcam.toml");
}

// A bump of reflectance around a wavelength.
Spectrum bump(double peak_nm) {
    constexpr double kWidthNm = 40.0;
    std::vector<double> lambda_nm;
    std::vector<double> reflectance;
    for (double nm = 380.0; nm <= 780.0; nm += 5.0) {
        const double x = (nm - peak_nm) / kWidthNm;
        lambda_nm.push_back(nm);
        reflectance.push_back(0.05 + 0.5 * std::exp(-0.5 * x * x));
    }
    return {"bump", lambda_nm, reflectance};
}

void HabCam(benchmark::State& state) {
    const Rig rig = habcam();
    for (auto _ : state) benchmark::DoNotOptimize(plan_render(rig, {}));
}
BENCHMARK(HabCam)->Unit(benchmark::kMillisecond);

void HabCamAtEveryAltitude(benchmark::State& state) {
    const Rig rig = habcam();
    PlanRequest request;
    request.paths = {.shortest_m = 2.0, .longest_m = 16.0};
    for (auto _ : state) benchmark::DoNotOptimize(plan_render(rig, request));
}
BENCHMARK(HabCamAtEveryAltitude)->Unit(benchmark::kMillisecond);

void TenMaterialsOverFortyMetres(benchmark::State& state) {
    Rig rig = habcam();
    for (const char* name : {"green-algae", "brown-algae", "red-algae"}) {
        rig.materials.push_back(load_curve(name, CurveRole::Reflectance, {}));
    }
    for (const double nm : {430.0, 480.0, 530.0, 580.0, 630.0, 680.0}) {
        rig.materials.push_back(bump(nm));
    }
    PlanRequest request;
    request.paths = {.shortest_m = 0.3, .longest_m = 40.0};
    std::size_t wavelengths = 0;
    for (auto _ : state) wavelengths = plan_render(rig, request).wavelengths.size();
    state.counters["wavelengths"] = static_cast<double>(wavelengths);
}
BENCHMARK(TenMaterialsOverFortyMetres)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace aphotic
