// SPDX-License-Identifier: BSD-3-Clause
//
// Rigs that nobody chose: random geometry, water, materials, lamps, sensors and ports, all within
// what the reader of rigs allows. A seed is a rig, the same on every machine.
//
//   random_rig(seed)       the floor alone under point lamps, 48 x 36 pixels
//   random_full_rig(seed)  the same rig with what else there is: beams of any kind, emitters of a
//                          size, objects, cones of no weight, strobes of no power
//   random_nasty_rig(seed) the same geometry with users' worst tables: filters that rise over
//                          hundreds of decades, lamps of a single line, notches, knots that almost
//                          coincide, and 30 decades between lamps
//   random_extended_rig(seed)  the full rig through a calibrated lens, any port and vignetting, in
//                          water that scatters: any of these or none
//
// A test that fails prints the seed with in_words(); run alone with APHOTIC_RIG_SEED=<seed>, it
// tries that rig and no other.
#pragma once

#include "rig/geometry.h"
#include "rig/rig.h"
#include "rig/solid.h"
#include "spectral/curve_loader.h"
#include "spectral/natural_water.h"
#include "support/box_mesh.h"
#include "support/random_beam.h"
#include "support/random_camera.h"
#include "support/scene_rig.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aphotic {

// Straight lines between random values, some of them the least.
inline Spectrum random_curve(Dice& dice, double least, double most) {
    constexpr WavelengthRange kCovered{.first_nm = 360.0, .last_nm = 760.0};
    constexpr double kShareOfLeast = 0.15;
    const double spacing_nm = dice.over_octaves(4.0, 100.0);
    std::vector<double> lambda_nm{kCovered.first_nm};
    while (lambda_nm.back() < kCovered.last_nm) {
        lambda_nm.push_back(lambda_nm.back() + spacing_nm * dice.between(0.2, 1.8));
    }
    std::vector<double> values;
    for (std::size_t i = 0; i < lambda_nm.size(); ++i) {
        const double value = dice.between(least, most);
        values.push_back(dice.chance(kShareOfLeast) ? least : value);
    }
    return {"random", std::move(lambda_nm), std::move(values)};
}

inline Spectrum random_lamp(Dice& dice) {
    if (dice.chance(0.5)) {
        constexpr std::array<std::string_view, 3> kLamps{"xenon-flash", "xenon-arc", "cie-d65"};
        return load_curve(std::string(dice.one_of(kLamps)), CurveRole::LampSpectrum, {});
    }
    return random_curve(dice, 0.0, dice.over_octaves(1e-3, 1e3));
}

inline Spectrum random_reflectance(Dice& dice) {
    if (dice.chance(0.5)) {
        constexpr std::array<std::string_view, 4> kMaterials{
            "sand", "green-algae", "brown-algae", "red-algae"};
        return load_curve(std::string(dice.one_of(kMaterials)), CurveRole::Reflectance, {});
    }
    return random_curve(dice, 0.02, 1.0);
}

inline Sensor random_sensor(Dice& dice) {
    if (dice.chance(0.4)) return builtin_sensor("nikon-d5100");
    if (dice.chance(0.2)) {
        return {load_curves("cie-1931", CurveRole::ColourMatching, {}), ResponseKind::Energy};
    }
    std::vector<Spectrum> responses;
    for (int c = 0; c < kChannels; ++c) responses.push_back(random_curve(dice, 0.0, 1.0));
    return {std::move(responses), dice.chance(0.5) ? ResponseKind::Energy : ResponseKind::Quantum};
}

inline Water random_water(Dice& dice) {
    constexpr std::array<std::string_view, 2> kWaters{"pope-fry-1997", "pure-2016"};
    Water water{.absorption_per_m =
                    load_curve(std::string(dice.one_of(kWaters)), CurveRole::WaterAbsorption, {})};
    water.multiple = dice.chance(0.1) ? 0.0 : dice.between(0.0, 5.0);
    water.uniform_loss_per_m = dice.chance(0.3) ? dice.between(0.0, 0.5) : 0.0;
    water.salinity_psu = dice.between(0.0, 40.0);
    water.temperature_c = dice.between(-2.0, 35.0);
    return water;
}

// HabCam's chip in 48 by 36 pixels, behind its lens of 12 mm, a somewhat other, or now and then one
// so wide that a tilted sled has the horizon in view.
inline Camera random_camera(Dice& dice) {
    constexpr double kChipWidth_m = 1360 * 6.45e-6;
    Camera camera{.width_px = 48,
                  .height_px = 36,
                  .pixel_pitch_m = kChipWidth_m / 48,
                  .focal_length_m = dice.chance(0.1) ? 0.004 : dice.between(0.008, 0.016),
                  // Where Pope and Fry's table and all glasses but one have values.
                  .range = {dice.between(420.0, 440.0), dice.between(650.0, 720.0)},
                  .sensor = random_sensor(dice),
                  .port = std::nullopt};
    if (dice.chance(0.1)) {
        constexpr std::array<std::string_view, 5> kGlasses{
            "bk7", "fused-silica", "sapphire", "pmma", "polycarbonate"};
        camera.port = {.distance_m = dice.between(0.01, 0.05),
                       .thickness_m = dice.between(0.003, 0.03),
                       .glass = builtin_glass(dice.one_of(kGlasses))};
        camera.range.first_nm =
            std::max(camera.range.first_nm, camera.port->glass.range().first_nm);
    } else {
        camera.range.first_nm = dice.between(380.0, 440.0);
    }
    return camera;
}

// Around the camera, outside any housing, and above the floor.
inline Eigen::Vector3d random_position_m(Dice& dice, const Sled& sled) {
    constexpr double kLeastHeight_m = 0.15;
    while (true) {
        const double around_rad = dice.between(0.0, 2.0 * std::numbers::pi);
        const double aside_m = dice.between(0.3, 1.0);
        Eigen::Vector3d position_m(aside_m * std::cos(around_rad),
                                   aside_m * std::sin(around_rad),
                                   dice.between(-0.3, 0.3));
        if (position_m.norm() > 1.0) continue;
        if (height_above(floor_plane(sled), position_m) > kLeastHeight_m) return position_m;
    }
}

// A point of the floor in view; where that is the horizon, the floor on the camera's axis.
inline Eigen::Vector3d random_aim_m(Dice& dice, const Rig& rig) {
    const double column = dice.between(0.0, rig.camera.width_px);
    const double row = dice.between(0.0, rig.camera.height_px);
    const double middle_nm = 0.5 * (rig.camera.range.first_nm + rig.camera.range.last_nm);
    const WaterRay ray = pixel_ray(rig, column, row, middle_nm);
    const auto distance_m = distance_to(floor_plane(rig.sled), ray);
    if (!distance_m) return {0.0, 0.0, rig.sled.altitude_m};
    return ray.origin_m + *distance_m * ray.direction;
}

// A rig of the floor alone under 1 to 6 point lamps, all of them lit.
inline Rig random_rig(std::uint64_t seed) {
    Dice dice(seed);
    const Sled sled{.altitude_m = dice.over_octaves(0.5, 10.0),
                    .pitch_rad = dice.between(-30.0, 30.0) * kDegree,
                    .roll_rad = dice.between(-30.0, 30.0) * kDegree};
    Rig rig{.title = "random",
            .sled = sled,
            .camera = random_camera(dice),
            .water = random_water(dice),
            .seafloor = {.reflectance = random_reflectance(dice)},
            .strobes = {},
            .materials = {},
            .digest = ""};
    if (dice.chance(0.2)) {
        rig.seafloor.phong = dice.between(0.05, 1.0);
        rig.seafloor.phong_size = dice.over_octaves(4.0, 200.0);
    }
    if (dice.chance(0.1)) rig.materials.push_back(random_reflectance(dice));
    const Spectrum lamp = random_lamp(dice);
    const bool is_mixed = dice.chance(0.2);
    const Spectrum other_lamp = is_mixed ? random_lamp(dice) : lamp;
    const int strobes = dice.whole(1, 6);
    for (int s = 0; s < strobes; ++s) {
        const Eigen::Vector3d position_m = random_position_m(dice, sled);
        const Eigen::Vector3d aim_m = random_aim_m(dice, rig);
        rig.strobes.push_back({.name = std::to_string(s),
                               .position_m = position_m,
                               .axis = (aim_m - position_m).normalized(),
                               .beam = random_beam(dice),
                               .spectrum = s % 2 == 0 ? lamp : other_lamp,
                               .power = dice.over_octaves(0.1, 100.0),
                               .emitter = std::nullopt});
    }
    return rig;
}

// What the reader of rigs allows: neither pupil nor strobe within it or too close, and no port in
// it.
inline bool has_place(const Rig& rig, const Shape& shape) {
    constexpr double kLeastFromLamp_m = 0.02;
    constexpr double kHousing_m = 0.6;  // from the pupil to the farthest corner of any of these
    const double from_pupil_m = rig.camera.port ? kHousing_m : kLeastFromLamp_m;
    if (bounds_m(shape).exteriorDistance(Eigen::Vector3d::Zero().eval()) < from_pupil_m) {
        return false;
    }
    return std::ranges::all_of(rig.strobes, [&](const Strobe& strobe) {
        const double reach_m =
            strobe.emitter ? std::hypot(strobe.emitter->across_m, strobe.emitter->along_m) : 0.0;
        return bounds_m(shape).exteriorDistance(strobe.position_m) > kLeastFromLamp_m + reach_m;
    });
}

inline Shape random_shape(Dice& dice, const Eigen::Vector3d& at_m, double size_m) {
    if (dice.chance(0.4)) return Sphere{.centre_m = at_m, .radius_m = 0.5 * size_m};
    const auto side = [&] { return size_m * dice.between(0.2, 1.0); };
    const double forward_m = side();
    const double starboard_m = side();
    const double down_m = side();
    const Eigen::Vector3d half_m = 0.5 * Eigen::Vector3d(forward_m, starboard_m, down_m);
    const Box box{.least_m = at_m - half_m, .most_m = at_m + half_m};
    if (dice.chance(0.5)) return box;
    return mesh_of(box);
}

// On the floor in view, or some way above it.
inline void add_random_object(Dice& dice, Rig& rig) {
    const Eigen::Vector3d on_floor_m = random_aim_m(dice, rig);
    const double size_m = rig.sled.altitude_m * dice.over_octaves(0.02, 0.4);
    const Eigen::Vector3d at_m = on_floor_m * dice.between(0.6, 1.0);
    Object object{.name = std::to_string(rig.objects.size()),
                  .shape = random_shape(dice, at_m, size_m),
                  .reflectance = random_reflectance(dice)};
    if (dice.chance(0.2)) {
        object.phong = dice.between(0.05, 1.0);
        object.phong_size = dice.over_octaves(4.0, 200.0);
    }
    if (has_place(rig, object.shape)) rig.objects.push_back(std::move(object));
}

inline Rig random_full_rig(std::uint64_t seed) {
    Rig rig = random_rig(seed);
    Dice dice(~seed);
    for (Strobe& strobe : rig.strobes) {
        if (dice.chance(0.2)) {
            strobe.emitter = {.across_m = dice.between(0.0, 0.05),
                              .along_m = dice.between(0.0, 0.05)};
        }
        if (dice.chance(0.1)) strobe.beam.cones[dice.index_in(strobe.beam.cones)].weight = 0.0;
        if (dice.chance(0.3)) {
            strobe.beam = random_beam_of(kBeamKinds.at(dice.index_in(kBeamKinds)), dice);
        }
        if (dice.chance(0.05)) strobe.power = 0.0;
    }
    const int objects = dice.chance(0.3) ? dice.whole(1, 3) : 0;
    for (int k = 0; k < objects; ++k) add_random_object(dice, rig);
    return rig;
}

inline PhaseFunction random_phase(Dice& dice) {
    if (dice.chance(0.5)) {
        return {.name = "henyey-greenstein", .kind = HenyeyGreenstein{dice.between(-0.5, 0.95)}};
    }
    return fournier_forand(dice.over_octaves(0.003, 0.1));
}

// By its chlorophyll, or the water as it was with particles of any kind.
inline void give_scatterers(Dice& dice, Camera& camera, Water& water) {
    if (dice.chance(0.5)) {
        // Where the formulas of case-1 water have values.
        camera.range = {std::max(camera.range.first_nm, 400.0),
                        std::min(camera.range.last_nm, 700.0)};
        const double chlorophyll_mg_m3 =
            dice.over_octaves(kLeastChlorophyll, 0.1 * kMostChlorophyll);
        take_constituents({.chlorophyll_mg_m3 = chlorophyll_mg_m3}, water);
    } else {
        water.scatterers.push_back(
            {random_curve(dice, 0.0, dice.over_octaves(0.01, 1.0)), random_phase(dice)});
    }
    water.multiple = std::max(water.multiple, 0.1);
}

// Objects have no place in a veil, nor in the housing of a port.
inline Rig random_extended_rig(std::uint64_t seed) {
    Rig rig = random_full_rig(seed);
    Dice dice(seed ^ 0x657874656e646564ULL);
    Camera& camera = rig.camera;
    if (dice.chance(0.5)) give_lens(kLensKinds.at(dice.index_in(kLensKinds)), dice, camera);
    if (dice.chance(0.6)) give_port(kPortKinds.at(dice.index_in(kPortKinds)), dice, camera);
    if (dice.chance(0.5)) give_vignetting(dice.index_in(kPortKinds), dice, camera);
    if (dice.chance(0.4)) give_scatterers(dice, camera, rig.water);
    std::erase_if(rig.objects, [&](const Object& object) {
        return rig.water.scatters() || !has_place(rig, object.shape);
    });
    return rig;
}

// Knots: some even, some so close to another that they almost coincide.
inline std::vector<double> nasty_knots_nm(Dice& dice) {
    constexpr WavelengthRange kCovered{.first_nm = 360.0, .last_nm = 760.0};
    const double spacing_nm = dice.over_octaves(2.0, 40.0);
    std::vector<double> knots_nm{kCovered.first_nm};
    while (knots_nm.back() < kCovered.last_nm) {
        if (dice.chance(0.1)) knots_nm.push_back(knots_nm.back() + dice.over_octaves(1e-9, 1e-2));
        knots_nm.push_back(knots_nm.back() + spacing_nm);
    }
    return knots_nm;
}

inline Spectrum curve_of(const std::vector<double>& knots_nm, const auto& value_at) {
    std::vector<double> values;
    for (const double nm : knots_nm) values.push_back(value_at(nm));
    return {"nasty", knots_nm, std::move(values)};
}

// A bell over so many decades that its skirts may end in zeros, on a pedestal or none.
inline Spectrum steep_filter(Dice& dice) {
    const double centre_nm = dice.between(380.0, 740.0);
    const double width_nm = dice.over_octaves(3.0, 100.0);
    const double power = dice.chance(0.5) ? 2.0 : dice.between(1.0, 6.0);
    const double pedestal = dice.chance(0.5) ? 0.0 : dice.over_octaves(1e-12, 0.1);
    return curve_of(nasty_knots_nm(dice), [&](double nm) {
        return pedestal + std::exp(-std::pow(std::abs(nm - centre_nm) / width_nm, power));
    });
}

// Bright between two wavelengths alone.
inline Spectrum window(Dice& dice, double most) {
    const double first_nm = dice.between(360.0, 740.0);
    const double last_nm = first_nm + dice.over_octaves(1.0, 200.0);
    return curve_of(nasty_knots_nm(dice), [&](double nm) {
        return nm >= first_nm && nm <= last_nm ? most * dice.between(0.2, 1.0) : 0.0;
    });
}

// Lines a thousandth to three nanometres wide, up or down to nothing, on a level.
inline Spectrum lines(Dice& dice, double level, double peak) {
    std::vector<double> knots_nm{360.0};
    std::vector<double> values{level};
    const int count = dice.whole(1, 4);
    for (int k = 0; k < count; ++k) {
        const double half_nm = dice.over_octaves(5e-4, 1.5);
        const double from_nm = knots_nm.back() + dice.between(1.0, 360.0 / count - 4.0);
        const double value = dice.chance(0.3) ? 0.0 : peak;
        for (const double step : {0.0, 1.0, 2.0}) {
            knots_nm.push_back(from_nm + step * half_nm);
            values.push_back(step == 1.0 ? value : level);
        }
    }
    knots_nm.push_back(760.0);
    values.push_back(level);
    return {"nasty", std::move(knots_nm), std::move(values)};
}

inline Spectrum nasty_lamp(Dice& dice) {
    const double level = dice.over_octaves(1e-3, 1e3);
    if (dice.chance(0.3)) return window(dice, level);
    if (dice.chance(0.3)) return lines(dice, 0.0, level);
    if (dice.chance(0.5)) return lines(dice, level, level * dice.over_octaves(1.0, 1e3));
    if (dice.chance(0.5)) return steep_filter(dice);
    return random_lamp(dice);
}

inline Sensor nasty_sensor(Dice& dice) {
    std::vector<Spectrum> responses;
    for (int c = 0; c < kChannels; ++c) {
        responses.push_back(dice.chance(0.7) ? steep_filter(dice) : lines(dice, 0.01, 1.0));
    }
    if (dice.chance(0.5))
        return Sensor::filtered(std::move(responses), random_curve(dice, 0.1, 1.0));
    return {std::move(responses), dice.chance(0.5) ? ResponseKind::Energy : ResponseKind::Quantum};
}

inline Rig random_nasty_rig(std::uint64_t seed) {
    Rig rig = random_rig(seed);
    Dice dice(seed ^ 0x6e61737479ULL);
    rig.camera.sensor = nasty_sensor(dice);
    if (dice.chance(0.5)) rig.water.multiple *= dice.between(1.0, 3.0);
    if (dice.chance(0.3)) rig.seafloor.reflectance = lines(dice, 0.3, 1.0);
    std::vector<Spectrum> lamps;
    const int kinds = dice.whole(1, 3);
    for (int k = 0; k < kinds; ++k) lamps.push_back(nasty_lamp(dice));
    for (Strobe& strobe : rig.strobes) {
        strobe.spectrum = lamps[dice.index_in(lamps)];
        strobe.power = dice.over_octaves(1e-15, 1e15);
    }
    return rig;
}

inline std::string in_words(std::uint64_t seed, const Rig& rig) {
    return fmt::format(
        "APHOTIC_RIG_SEED={}: {:.3g} m up, pitch {:.3g} and roll {:.3g} degrees, {} "
        "strobes, {} objects{}{}{}{}{}",
        seed,
        rig.sled.altitude_m,
        rig.sled.pitch_rad / kDegree,
        rig.sled.roll_rad / kDegree,
        rig.strobes.size(),
        rig.objects.size(),
        rig.seafloor.phong > 0.0 ? ", a highlight" : "",
        rig.camera.lens ? ", a lens" : "",
        rig.camera.port ? ", a port" : "",
        rig.camera.vignetting ? ", vignetting" : "",
        rig.water.scatters() ? ", a veil" : "");
}

// The seeds first_seed, first_seed + 1, ...; or the one that the environment asks for.
inline std::vector<std::uint64_t> rig_seeds(std::uint64_t first_seed, int count) {
    if (const char* only = std::getenv("APHOTIC_RIG_SEED")) return {std::stoull(only)};
    std::vector<std::uint64_t> seeds;
    for (int i = 0; i < count; ++i) seeds.push_back(first_seed + static_cast<std::uint64_t>(i));
    return seeds;
}

}  // namespace aphotic
