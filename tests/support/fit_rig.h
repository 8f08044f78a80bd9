// SPDX-License-Identifier: BSD-3-Clause
//
// A small rig for fits: two strobes with smooth beams, and the images that it would take, by
// lightmaps, which share no code with the fit's own light.
#pragma once

#include "lightmap/lightmap.h"
#include "rig/file/rig_text.h"
#include "survey/fit/fit_samples.h"

#include <fmt/format.h>

#include <random>
#include <string>
#include <vector>

namespace aphotic {

struct FitRigNumbers {
    double exponent = 6.0;
    double fore_tilt_deg = 20.0;
    double aft_power = 0.8;
    double multiple = 1.0;
    double a1 = -0.1;
    std::string water = "absorption = \"pope-fry-1997\"\nmultiple = {}";
    int width_px = 40;
    int height_px = 30;
};

inline RigText fit_rig(const FitRigNumbers& numbers) {
    const std::string water = fmt::format(fmt::runtime(numbers.water), numbers.multiple);
    return {fmt::format(R"(
title = "two smooth strobes"
[sled]
altitude_m = 2.0
[camera]
resolution = [{}, {}]
pixel_pitch_um = {}
focal_length_mm = 12.0
range_nm = [400, 700]
response = "nikon-d5100"
vignetting = {{ radial = [{}, 0.0, 0.0] }}
[water]
{}
[seafloor]
reflectance = "sand"
[beam.smooth]
cones = [{{ part = "all", half_angle_deg = 90.0, weight = 1.0, exponent = {} }}]
[[strobe]]
name = "fore"
position_m = [0.5, 0.1, 0.0]
aim = {{ tilt_deg = {}, toward = "axis" }}
beam = "smooth"
[[strobe]]
name = "aft"
position_m = [-0.5, 0.0, 0.0]
aim = {{ tilt_deg = 15.0, toward = "axis" }}
beam = "smooth"
power = {}
)",
                        numbers.width_px,
                        numbers.height_px,
                        25.8 * 340.0 / numbers.width_px,
                        numbers.a1,
                        water,
                        numbers.exponent,
                        numbers.fore_tilt_deg,
                        numbers.aft_power),
            "fit.toml",
            {}};
}

// One block a pixel; the signal of each pose times its own level, with relative noise.
inline FitSamples fit_samples_of(const Rig& rig,
                                 const std::vector<Sled>& sleds,
                                 double noise,
                                 std::uint64_t seed,
                                 double gain = 100.0) {
    FitSamples samples;
    samples.are_maps = true;
    samples.places = fit_places(rig.camera.width_px, rig.camera.height_px, rig.camera.width_px);
    const LightmapMaker maker(rig, paths_of(rig, sleds), {});
    std::mt19937_64 dice(seed);
    std::normal_distribution<double> normal;
    for (const Sled& sled : sleds) {
        const std::vector<float> light = signal_of(maker.map(sled));
        const std::size_t pixels = light.size() / kChannels;
        FitImage image{.name = fmt::format("{} m", sled.altitude_m), .sled = sled};
        for (std::size_t i = 0; i < pixels; ++i) {
            for (std::size_t c = 0; c < kChannels; ++c) {
                image.signal.push_back(static_cast<float>(gain * light[c * pixels + i] *
                                                          (1.0 + noise * normal(dice))));
            }
        }
        samples.images.push_back(std::move(image));
    }
    return samples;
}

}  // namespace aphotic
