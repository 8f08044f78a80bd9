// SPDX-License-Identifier: BSD-3-Clause
//
// The time of Aphotic's parts: wall time, and the processor time of all threads, which other
// processes affect less. The least of many passes is close to the time on an idle machine. HabCam's
// 1360 x 1024 pixels, four strobes of three cones, unless the name indicates otherwise.
//
// Goals: a lightmap at least 300 times as fast as the tracer, at most 15 times as long as filling
// such an image with a constant, under the 166 ms between two frames of the camera; a plan in under
// 0.2 s, under 2 s for ten materials over forty metres. A survey's images are corrected by one
// thread each: map, division, edges and demosaicing run in sequence.
#include "lightmap/cone_edge.h"
#include "lightmap/lightmap.h"
#include "rig/file/rig_reader.h"
#include "scene_gen/render_plan.h"
#include "spectral/curve_loader.h"
#include "survey/correction.h"
#include "validation/tracer.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

constexpr int kThreads = 2;

Rig scene(const std::string& name = "habcam") {
    return read_rig(APHOTIC_SOURCE_DIR "/scenes/" + name + ".toml");
}

void least_of_many(benchmark::internal::Benchmark* benchmark) {
    benchmark->Unit(benchmark::kMillisecond)
        ->UseRealTime()
        ->MeasureProcessCPUTime()
        ->MinTime(0.01)
        ->Repetitions(50)
        ->ReportAggregatesOnly()
        ->ComputeStatistics("least", [](const std::vector<double>& times) {
            return *std::ranges::min_element(times);
        });
}

// Lightmaps.

void fill(benchmark::State& state) {
    std::vector<float> samples(std::size_t{3} * 1360 * 1024);
    for (auto _ : state) {
        std::ranges::fill(samples, 1.0F);
        benchmark::DoNotOptimize(samples.data());
        benchmark::ClobberMemory();
    }
}
BENCHMARK(fill)->Apply(least_of_many);

void map_by(benchmark::State& state, const Rig& rig, int threads) {
    const LightmapMaker maker(rig, std::nullopt, {.error = 1e-5, .threads = threads});
    Lightmap map;
    for (auto _ : state) {
        maker.map_into(rig.sled, map);
        benchmark::DoNotOptimize(map.samples.data());
    }
}

void lightmap(benchmark::State& state, const std::string& name, int threads) {
    map_by(state, scene(name), threads);
}
BENCHMARK_CAPTURE(lightmap, habcam, "habcam", kThreads)->Apply(least_of_many);
BENCHMARK_CAPTURE(lightmap, habcam_one_thread, "habcam", 1)->Apply(least_of_many);
BENCHMARK_CAPTURE(lightmap, port, "port", kThreads)->Apply(least_of_many);

// HabCam in coastal water, compared with the floor's light alone: the veil's goal is ten times as
// long.

Rig coast(const std::string& of = "habcam") {
    Rig rig = scene(of);
    const auto line = [](const char* name, double blue, double red) {
        return Spectrum(name, {300.0, 400.0, 700.0, 900.0}, {blue, blue, red, red});
    };
    rig.water.absorption_per_m = line("absorption", 0.3, 0.65);
    rig.water.scatterers = {{line("scattering", 0.28, 0.18), fournier_forand(0.0183)}};
    return rig;
}

void map_with(benchmark::State& state, const Rig& rig, const LightmapOptions& options) {
    const LightmapMaker maker(rig, std::nullopt, options);
    Lightmap map;
    for (auto _ : state) {
        maker.map_into(rig.sled, map);
        benchmark::DoNotOptimize(map.samples.data());
    }
}

void lightmap_in_coastal_water(benchmark::State& state, bool has_veil, int threads) {
    map_with(state, coast(), {.error = 1e-5, .threads = threads, .has_veil = has_veil});
}
BENCHMARK_CAPTURE(lightmap_in_coastal_water, floor, false, kThreads)->Apply(least_of_many);
BENCHMARK_CAPTURE(lightmap_in_coastal_water, veil, true, kThreads)->Apply(least_of_many);
BENCHMARK_CAPTURE(lightmap_in_coastal_water, floor_one_thread, false, 1)->Apply(least_of_many);
BENCHMARK_CAPTURE(lightmap_in_coastal_water, veil_one_thread, true, 1)->Apply(least_of_many);

// To a correction's tolerance; sharp cones and smooth beams.
void veil_to(benchmark::State& state, const std::string& name, double tolerance) {
    map_with(state, coast(name), {.error = 1e-5, .threads = 1, .veil_tolerance = tolerance});
}
BENCHMARK_CAPTURE(veil_to, cones_1e3, "habcam", 1e-3)->Apply(least_of_many);
BENCHMARK_CAPTURE(veil_to, smooth_1e3, "habcam-led", 1e-3)->Apply(least_of_many);
BENCHMARK_CAPTURE(veil_to, smooth_1e4, "habcam-led", 1e-4)->Apply(least_of_many);
void floor_beside_it(benchmark::State& state, const std::string& name) {
    map_with(state, coast(name), {.error = 1e-5, .threads = 1, .has_veil = false});
}
BENCHMARK_CAPTURE(floor_beside_it, smooth, "habcam-led")->Apply(least_of_many);

// The same strobes with other beams, by one thread: relative to habcam_one_thread, the cost of a
// kind.

constexpr BeamWindow kAcrylic{.glass_index = 1.49, .water_index = 1.34};

void make_soft(Beam& beam) {
    for (Cone& cone : beam.cones) cone.edge_rad = 0.3 * cone.half_angle_rad;
}

void make_data_sheet(Beam& beam) {
    beam.cones = {{.part = "fwhm",
                   .half_angle_rad = 0.5 * std::numbers::pi,
                   .weight = 1.0,
                   .exponent = 1.57}};
}

// 91 x 73 directions, with a kink at each.
void make_table(Beam& beam) {
    constexpr double kDegree = std::numbers::pi / 180.0;
    BeamTable table;
    for (int v = 0; v <= 90; ++v) table.vertical_rad.push_back(v * kDegree);
    for (int h = 0; h <= 72; ++h) {
        table.horizontal_rad.push_back(5.0 * h * kDegree);
        for (int v = 0; v <= 90; ++v) table.intensity.push_back(2.0 + (h % 72 * 7 + v * 3) % 5);
    }
    table.horizontal_rad.back() = 2.0 * std::numbers::pi;
    beam.cones.clear();
    beam.pattern = std::move(table);
}

void make_optics(Beam& beam) {
    beam.cones.clear();
    beam.pattern = BeamOptics{.along_m = 0.0635,
                              .across_m = 0.0302,
                              .focal_length_m = 0.065,
                              .distance_m = 0.05,
                              .aperture_m = 0.065};
}

void make_optics_in_air(Beam& beam) {
    make_optics(beam);
    beam.window = kAcrylic;
}

void lightmap_of(benchmark::State& state, void (*change)(Beam&)) {
    Rig rig = scene();
    for (Strobe& strobe : rig.strobes) {
        change(strobe.beam);
        strobe.beam = scaled_to_flux(std::move(strobe.beam));
    }
    map_by(state, rig, 1);
}
BENCHMARK_CAPTURE(lightmap_of, soft_edges, make_soft)->Apply(least_of_many);
BENCHMARK_CAPTURE(lightmap_of, data_sheet, make_data_sheet)->Apply(least_of_many);
BENCHMARK_CAPTURE(lightmap_of, table, make_table)->Apply(least_of_many);
BENCHMARK_CAPTURE(lightmap_of, optics, make_optics)->Apply(least_of_many);
BENCHMARK_CAPTURE(lightmap_of, optics_in_air, make_optics_in_air)->Apply(least_of_many);

// HabCam through lenses and ports whose rays have no formula: relative to habcam_one_thread, and to
// the flat port next to them.

PortWindow bk7_port() {
    return {.distance_m = 0.05, .thickness_m = 0.012, .glass = builtin_glass("bk7")};
}

void give_lens(Camera& camera) {
    const double focal_px = camera.focal_length_m / camera.pixel_pitch_m;
    camera.lens =
        LensModel{.focal_px = {focal_px, focal_px},
                  .centre_px = {0.5 * camera.width_px + 11.0, 0.5 * camera.height_px - 7.0},
                  .radial = {-0.2, 0.1, 0.0, 0.0},
                  .tangential = {1e-3, -5e-4}};
}

void give_flat_port(Camera& camera) {
    camera.port = bk7_port();
}

void give_tilted_port(Camera& camera) {
    camera.port = bk7_port();
    camera.port->normal = Eigen::Vector3d(0.05, -0.03, 1.0).normalized();
}

void give_dome(Camera& camera) {
    camera.port = bk7_port();
    camera.port->distance_m = 0.0;
    camera.port->dome = Dome{.centre_m = {0.002, -0.001, 0.003}, .radius_m = 0.05};
}

void lightmap_seen_through(benchmark::State& state, void (*change)(Camera&)) {
    Rig rig = scene();
    change(rig.camera);
    map_by(state, rig, 1);
}
BENCHMARK_CAPTURE(lightmap_seen_through, lens, give_lens)->Apply(least_of_many);
BENCHMARK_CAPTURE(lightmap_seen_through, flat_port, give_flat_port)->Apply(least_of_many);
BENCHMARK_CAPTURE(lightmap_seen_through, tilted_port, give_tilted_port)->Apply(least_of_many);
BENCHMARK_CAPTURE(lightmap_seen_through, dome, give_dome)->Apply(least_of_many);

void table(benchmark::State& state) {
    const Rig rig = scene();
    for (auto _ : state) {
        benchmark::DoNotOptimize(LightmapMaker(rig, std::nullopt, {}).table_steps());
    }
}
BENCHMARK(table)->Apply(least_of_many);

void trace(benchmark::State& state) {
    const Rig rig = scene();
    const Tracer tracer(rig, {.signals = true, .planes_nm = {}, .threads = kThreads});
    for (auto _ : state) benchmark::DoNotOptimize(tracer.rows(0, rig.camera.height_px).data());
}
BENCHMARK(trace)->Apply(least_of_many)->Repetitions(2);

// The correction of an image, without reading and writing it.

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

void division(benchmark::State& state) {
    const Rig rig = scene();
    const Lightmap map = LightmapMaker(rig, std::nullopt, {}).map(rig.sled);
    const RawImage raw = grey_mosaic(rig.camera);
    for (auto _ : state) benchmark::DoNotOptimize(corrected(raw, map, kCorrection));
}
BENCHMARK(division)->Apply(least_of_many);

void edges_of_cones(benchmark::State& state) {
    const Rig rig = scene();
    const ConeEdges edges(rig);
    for (auto _ : state) benchmark::DoNotOptimize(edges.mask(rig.sled, 2));
}
BENCHMARK(edges_of_cones)->Apply(least_of_many);

void demosaicing(benchmark::State& state) {
    const Rig rig = scene();
    const Lightmap map = LightmapMaker(rig, std::nullopt, {}).map(rig.sled);
    const CorrectedImage mosaic = corrected(grey_mosaic(rig.camera), map, kCorrection);
    for (auto _ : state) benchmark::DoNotOptimize(demosaiced(mosaic));
}
BENCHMARK(demosaicing)->Apply(least_of_many);

// Plans.

void plan(benchmark::State& state) {
    const Rig rig = scene();
    for (auto _ : state) benchmark::DoNotOptimize(plan_render(rig, {}));
}
BENCHMARK(plan)->Apply(least_of_many)->Repetitions(5);

void plan_of_every_altitude(benchmark::State& state) {
    const Rig rig = scene();
    PlanRequest request;
    request.paths = {.shortest_m = 2.0, .longest_m = 16.0};
    for (auto _ : state) benchmark::DoNotOptimize(plan_render(rig, request));
}
BENCHMARK(plan_of_every_altitude)->Apply(least_of_many)->Repetitions(5);

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

void plan_of_ten_materials_over_forty_metres(benchmark::State& state) {
    Rig rig = scene();
    for (const char* name : {"green-algae", "brown-algae", "red-algae"}) {
        rig.materials.push_back(load_curve(name, CurveRole::Reflectance, {}));
    }
    for (const double nm : {430.0, 480.0, 530.0, 580.0, 630.0, 680.0}) {
        rig.materials.push_back(bump(nm));
    }
    PlanRequest request;
    request.paths = {.shortest_m = 0.3, .longest_m = 40.0};
    for (auto _ : state) benchmark::DoNotOptimize(plan_render(rig, request));
}
BENCHMARK(plan_of_ten_materials_over_forty_metres)->Apply(least_of_many)->Repetitions(2);

}  // namespace
}  // namespace aphotic
