// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/path_light.h"

#include "spectral/bands.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aphotic {
namespace {

constexpr std::size_t kPathSteps = 160;
constexpr std::size_t kPhaseSteps = 720;
constexpr double kBand_nm = 1.0;

std::vector<std::size_t> distinct_lamps(const Rig& rig, std::vector<std::size_t>& first) {
    std::vector<std::size_t> lamp_of_strobe;
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        std::size_t lamp = 0;
        while (lamp < first.size() &&
               !is_same_curve(rig.strobes[first[lamp]].spectrum, rig.strobes[s].spectrum))
            ++lamp;
        if (lamp == first.size()) first.push_back(s);
        lamp_of_strobe.push_back(lamp);
    }
    return lamp_of_strobe;
}

// What is added to a lamp's tables: the light of a rig, as one version of it.
struct Share {
    const Rig& rig;
    std::size_t version;
    double times;
    FloorTint colour;
    int floor_power =
        0;  // of u: a derivative over the floor's colour, which the veil does not have
};

void add_lamp(const Share& share, std::size_t strobe, CubicTable& floor, CubicTable& veil) {
    const Rig& rig = share.rig;
    const WavelengthRange range = rig.camera.range;
    const int bands =
        std::max(1, static_cast<int>(std::ceil((range.last_nm - range.first_nm) / kBand_nm)));
    const std::size_t scatterers = share.floor_power > 0 ? 0 : rig.water.scatterers.size();
    for (const WeightedWavelength& band : equal_bands(rig.camera.sensor, range, bands)) {
        const double nm = band.lambda_nm;
        const double K_per_m = rig.water.attenuation_per_m(nm);
        const double lamp = share.times * rig.strobes[strobe].spectrum.at(nm);
        const double u =
            (2.0 * nm - range.first_nm - range.last_nm) / (range.last_nm - range.first_nm);
        double of_floor = lamp * rig.seafloor.reflectance.at(nm) *
                          std::exp(u * (share.colour[0] + u * share.colour[1]));
        for (int power = 0; power < share.floor_power; ++power) of_floor *= u;
        std::vector<double> of_water;
        for (std::size_t i = 0; i < scatterers; ++i)
            of_water.push_back(lamp * rig.water.scattering_per_m(i, nm));
        for (std::size_t node = 0; node < floor.nodes(); ++node) {
            const double left = std::exp(-K_per_m * floor.place(node));
            for (std::size_t c = 0; c < kChannels; ++c) {
                const double direct = of_floor * band.weight[c] * left;
                floor.value(node, share.version * kChannels + c) += direct;
                floor.slope(node, share.version * kChannels + c) -= K_per_m * direct;
                for (std::size_t i = 0; i < scatterers; ++i) {
                    const std::size_t lane = (share.version * scatterers + i) * kChannels + c;
                    const double scattered = of_water[i] * band.weight[c] * left;
                    veil.value(node, lane) += scattered;
                    veil.slope(node, lane) -= K_per_m * scattered;
                }
            }
        }
    }
}

void add_phases(const Rig& rig, std::size_t version, double times, CubicTable& phases) {
    const std::size_t scatterers = rig.water.scatterers.size();
    const double step = phases.place(1) - phases.place(0);
    for (std::size_t i = 0; i < scatterers; ++i) {
        const PhaseFunction& phase = rig.water.scatterers[i].phase;
        const std::size_t lane = version * scatterers + i;
        for (std::size_t node = 0; node < phases.nodes(); ++node) {
            const double psi = phases.place(node);
            const double before = std::max(psi - 0.5 * step, kVeilCut);
            const double after = std::min(psi + 0.5 * step, std::numbers::pi);
            phases.value(node, lane) += times * phase.at(psi);
            phases.slope(node, lane) +=
                times * (phase.at(after) - phase.at(before)) / (after - before);
        }
    }
}

RigText with(RigText rig, const std::vector<WaterNumber>& numbers) {
    for (const WaterNumber& number : numbers) rig.set(number.key, number.value);
    return rig;
}

}  // namespace

CubicTable::CubicTable(double first, double last, std::size_t steps, std::size_t lanes)
    : first_(first),
      step_((last - first) / static_cast<double>(steps)),
      nodes_(steps + 1),
      lanes_(lanes),
      samples_(2 * nodes_ * lanes, 0.0) {}

void CubicTable::at(double x, double* values) const {
    const double place = std::clamp((x - first_) / step_, 0.0, static_cast<double>(nodes_ - 1));
    const std::size_t node = std::min(static_cast<std::size_t>(place), nodes_ - 2);
    const double u = place - static_cast<double>(node);
    const double v = 1.0 - u;
    const double from = v * v * (1.0 + 2.0 * u);
    const double to = u * u * (1.0 + 2.0 * v);
    const double from_slope = step_ * u * v * v;
    const double to_slope = -step_ * u * u * v;
    const double* a = samples_.data() + 2 * node * lanes_;
    const double* b = a + 2 * lanes_;
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        values[lane] = from * a[2 * lane] + from_slope * a[2 * lane + 1] + to * b[2 * lane] +
                       to_slope * b[2 * lane + 1];
    }
}

void CubicTable::slopes_at(double x, double* slopes) const {
    const double place = std::clamp((x - first_) / step_, 0.0, static_cast<double>(nodes_ - 1));
    const std::size_t node = std::min(static_cast<std::size_t>(place), nodes_ - 2);
    const double u = place - static_cast<double>(node);
    const double v = 1.0 - u;
    const double rise = 6.0 * u * v / step_;
    const double* a = samples_.data() + 2 * node * lanes_;
    const double* b = a + 2 * lanes_;
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        slopes[lane] = rise * (b[2 * lane] - a[2 * lane]) + v * (1.0 - 3.0 * u) * a[2 * lane + 1] +
                       u * (1.0 - 3.0 * v) * b[2 * lane + 1];
    }
}

PathLight::PathLight(const RigText& text,
                     const std::vector<WaterNumber>& numbers,
                     const FloorTint& colour,
                     PathRange paths,
                     bool has_derivatives)
    : rig_(with(text, numbers).rig()),
      versions_(has_derivatives ? 1 + numbers.size() + colour.size() : 1),
      scatterers_(rig_.water.scatters() ? rig_.water.scatterers.size() : 0),
      phases_(kVeilCut, std::numbers::pi, kPhaseSteps, versions_ * scatterers_) {
    if (scatterers_ == 0) rig_.water.scatterers.clear();
    std::vector<std::size_t> lamps;
    lamp_of_strobe_ = distinct_lamps(rig_, lamps);
    for (std::size_t lamp = 0; lamp < lamps.size(); ++lamp) {
        floor_.emplace_back(paths.shortest_m, paths.longest_m, kPathSteps, versions_ * kChannels);
        veil_.emplace_back(
            paths.shortest_m, paths.longest_m, kPathSteps, versions_ * scatterers_ * kChannels);
    }
    const auto add = [&](Rig& rig, std::size_t version, double times) {
        if (scatterers_ == 0) rig.water.scatterers.clear();
        for (std::size_t lamp = 0; lamp < lamps.size(); ++lamp)
            add_lamp({rig, version, times, colour}, lamps[lamp], floor_[lamp], veil_[lamp]);
        add_phases(rig, version, times, phases_);
    };
    add(rig_, 0, 1.0);
    if (!has_derivatives) return;
    for (std::size_t k = 0; k < colour.size(); ++k) {
        for (std::size_t lamp = 0; lamp < lamps.size(); ++lamp) {
            add_lamp({rig_, 1 + numbers.size() + k, 1.0, colour, static_cast<int>(k) + 1},
                     lamps[lamp],
                     floor_[lamp],
                     veil_[lamp]);
        }
    }
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        // A number at 0 may have nothing below it.
        const double step = kWaterStep * std::max(std::abs(numbers[k].value), 0.01);
        std::vector<WaterNumber> moved = numbers;
        const bool can_fall = numbers[k].value > step;
        moved[k].value = numbers[k].value + step;
        Rig more = with(text, moved).rig();
        moved[k].value = numbers[k].value - (can_fall ? step : 0.0);
        Rig less = with(text, moved).rig();
        const double apart = can_fall ? 2.0 * step : step;
        add(more, k + 1, 1.0 / apart);
        add(less, k + 1, -1.0 / apart);
    }
}

}  // namespace aphotic
