// SPDX-License-Identifier: BSD-3-Clause
//
// Beams that nobody chose, of every kind that rig/beam/beam.h knows.
#pragma once

#include "rig/beam/beam.h"
#include "support/dice.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

enum class BeamKind { Cones, TableA, TableB, TableC, Optics };
inline constexpr std::array<BeamKind, 5> kBeamKinds{
    BeamKind::Cones, BeamKind::TableA, BeamKind::TableB, BeamKind::TableC, BeamKind::Optics};

// Sharp cones of a Lambertian falloff, as the paper's.
inline Beam random_beam(Dice& dice) {
    Beam beam{.name = "random",
              .weights = dice.chance(0.8) ? ConeWeights::Flux : ConeWeights::Literal,
              .cones = {}};
    const int cones = dice.whole(1, 3);
    for (int k = 0; k < cones; ++k) {
        const double half_angle_deg = dice.chance(0.3) ? 90.0 : dice.over_octaves(3.0, 90.0);
        beam.cones.push_back({.part = "random",
                              .half_angle_rad = half_angle_deg * kDegree,
                              .weight = dice.between(0.05, 1.0)});
    }
    return beam;
}

// Sharp and soft cones of any falloff.
inline std::vector<Cone> random_cones(Dice& dice) {
    std::vector<Cone> cones;
    const int count = dice.whole(1, 3);
    for (int k = 0; k < count; ++k) {
        const double half_angle_deg = dice.chance(0.3) ? 90.0 : dice.over_octaves(3.0, 90.0);
        Cone cone{.part = "random",
                  .half_angle_rad = half_angle_deg * kDegree,
                  .weight = dice.between(0.05, 1.0)};
        if (dice.chance(0.6)) cone.exponent = dice.over_octaves(0.5, 60.0);
        if (dice.chance(0.6)) cone.edge_rad = dice.between(0.05, 1.0) * cone.half_angle_rad;
        cones.push_back(std::move(cone));
    }
    return cones;
}

// From the first angle to the last, unevenly.
inline std::vector<double> random_angles_rad(Dice& dice, double first_deg, double last_deg) {
    std::vector<double> angles_rad{first_deg * kDegree};
    const double spacing_deg = (last_deg - first_deg) / dice.whole(1, 12);
    for (double at_deg = first_deg + spacing_deg * dice.between(0.5, 1.5);
         at_deg < last_deg - 0.2 * spacing_deg;
         at_deg += spacing_deg * dice.between(0.5, 1.5)) {
        angles_rad.push_back(at_deg * kDegree);
    }
    angles_rad.push_back(last_deg * kDegree);
    return angles_rad;
}

// Some end at nothing, some on a step; at the poles all planes have one value.
inline BeamTable random_table(Dice& dice, TableAngles angles) {
    BeamTable table{.angles = angles, .vertical_rad = {}, .horizontal_rad = {}, .intensity = {}};
    if (angles == TableAngles::TypeC) {
        const double first_deg = dice.chance(0.2) ? 10.0 : 0.0;
        const std::array<double, 3> ends_deg{90.0, 180.0, dice.between(20.0, 80.0)};
        table.vertical_rad =
            random_angles_rad(dice, first_deg, ends_deg.at(dice.index_in(ends_deg)));
        table.horizontal_rad =
            dice.chance(0.3) ? std::vector<double>{0.0} : random_angles_rad(dice, 0.0, 360.0);
    } else {
        const auto side = [&] {
            if (dice.chance(0.3)) return random_angles_rad(dice, -90.0, 90.0);
            return random_angles_rad(dice, -dice.between(5.0, 80.0), dice.between(5.0, 80.0));
        };
        table.vertical_rad = side();
        table.horizontal_rad = side();
    }
    const bool ends_dark = dice.chance(0.4);
    const double at_pole = dice.between(0.0, 1000.0);
    const std::size_t columns = table.vertical_rad.size();
    const std::size_t rows = table.horizontal_rad.size();
    const auto is_pole = [](double angle_rad, bool is_type_c) {
        return is_type_c ? angle_rad == 0.0 || angle_rad >= std::numbers::pi
                         : std::abs(angle_rad) >= 0.5 * std::numbers::pi;
    };
    for (std::size_t h = 0; h < rows; ++h) {
        for (std::size_t v = 0; v < columns; ++v) {
            double value = dice.chance(0.1) ? 0.0 : dice.between(0.0, 1000.0);
            const bool is_end = v + 1 == columns || (angles != TableAngles::TypeC &&
                                                     (v == 0 || h == 0 || h + 1 == rows));
            if (is_pole(
                    angles == TableAngles::TypeB ? table.horizontal_rad[h] : table.vertical_rad[v],
                    angles == TableAngles::TypeC)) {
                value = at_pole;
            }
            if (is_end && ends_dark && columns > 2 && rows != 2) value = 0.0;
            if (angles == TableAngles::TypeC && rows > 1 && h + 1 == rows) {
                value = table.intensity[v];
            }
            table.intensity.push_back(value);
        }
    }
    return table;
}

// A diffuser of centimetres close to a lens of about its size, now and then in focus.
inline BeamOptics random_optics(Dice& dice) {
    BeamOptics optics{.along_m = dice.over_octaves(0.005, 0.1),
                      .across_m = dice.over_octaves(0.005, 0.1),
                      .focal_length_m = dice.over_octaves(0.02, 0.2),
                      .distance_m = 0.0,
                      .aperture_m = dice.over_octaves(0.01, 0.15)};
    optics.distance_m =
        dice.chance(0.2) ? optics.focal_length_m : optics.focal_length_m * dice.between(0.1, 2.0);
    return optics;
}

inline Beam random_beam_of(BeamKind kind, Dice& dice) {
    Beam beam{.name = "random",
              .weights = dice.chance(0.8) ? ConeWeights::Flux : ConeWeights::Literal,
              .cones = {}};
    switch (kind) {
        case BeamKind::Cones:
            beam.cones = random_cones(dice);
            break;
        case BeamKind::TableA:
            beam.pattern = random_table(dice, TableAngles::TypeA);
            break;
        case BeamKind::TableB:
            beam.pattern = random_table(dice, TableAngles::TypeB);
            break;
        case BeamKind::TableC:
            beam.pattern = random_table(dice, TableAngles::TypeC);
            break;
        case BeamKind::Optics:
            beam.pattern = random_optics(dice);
            break;
    }
    if (kind != BeamKind::Cones) beam.turn_rad = dice.between(-180.0, 180.0) * kDegree;
    if (dice.chance(0.4)) {
        beam.window = {.glass_index = dice.between(1.45, 1.8),
                       .water_index = dice.between(1.33, 1.36)};
    }
    return scaled_to_flux(std::move(beam));
}

}  // namespace aphotic
