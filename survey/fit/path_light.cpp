// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/path_light.h"

#include "light/veil.h"
#include "spectral/bands.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aphotic {
namespace {

constexpr std::size_t kPhaseSteps = 4096;
constexpr double kPhaseStep_rad = (std::numbers::pi - kVeilCut) / kPhaseSteps;
constexpr double kBand_nm = 1.0;

std::vector<WeightedWavelength> grid_of(const Camera& camera) {
    const double width_nm = camera.range.last_nm - camera.range.first_nm;
    const int bands = std::max(1, static_cast<int>(std::ceil(width_nm / kBand_nm)));
    return equal_bands(camera.sensor, camera.range, bands);
}

void join(const SpectralSum& more, double share, SpectralSum& sum) {
    const Eigen::Index had = sum.K_per_m.size();
    sum.K_per_m.conservativeResize(had + more.K_per_m.size());
    sum.weights.conservativeResize(had + more.K_per_m.size(), kChannels);
    sum.K_per_m.tail(more.K_per_m.size()) = more.K_per_m;
    sum.weights.bottomRows(more.weights.rows()) = share * more.weights;
}

Rig rig_with(RigText text, const std::vector<WaterNumber>& numbers) {
    for (const WaterNumber& number : numbers) text.set(number.key, number.value);
    Rig rig = text.rig();
    if (!rig.water.scatters()) rig.water.scatterers.clear();
    return rig;
}

}  // namespace

PathLight::PathLight(const RigText& text,
                     const std::vector<WaterNumber>& numbers,
                     const FloorTint& tint,
                     const PathRange& paths)
    : rig_(rig_with(text, numbers)), scatterers_(rig_.water.scatterers.size()) {
    const auto of_lamp = [&](double nm) { return rig_.strobes.front().spectrum.at(nm); };
    steps_ =
        path_steps(spectral_sum(rig_.water, grid_of(rig_.camera), of_lamp), paths, kFitTableError);
    add_version({&rig_}, {1.0}, tint, 0);
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        // A number at 0 may have no lower value.
        const double step = kWaterStep * std::max(std::abs(numbers[k].value), 0.01);
        const double down = numbers[k].value > step ? step : 0.0;
        std::vector<WaterNumber> moved = numbers;
        moved[k].value = numbers[k].value + step;
        const Rig more = rig_with(text, moved);
        moved[k].value = numbers[k].value - down;
        const Rig less = rig_with(text, moved);
        const double per_step = 1.0 / (step + down);
        add_version({&more, &less}, {per_step, -per_step}, tint, 0);
    }
    for (int power = 1; power <= 2; ++power) add_version({&rig_}, {1.0}, tint, power);
}

// The sum of some rigs' light, each with its share, times u to a power.
void PathLight::add_version(const std::vector<const Rig*>& rigs,
                            const std::vector<double>& shares,
                            const FloorTint& tint,
                            int power_of_u) {
    ++versions_;
    const WavelengthRange range = rig_.camera.range;
    const std::vector<WeightedWavelength> grid = grid_of(rig_.camera);
    for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
        const Spectrum& lamp = rig_.strobes[s].spectrum;
        const auto tabulated = [&](const auto& light) {
            SpectralSum sum;
            for (std::size_t k = 0; k < rigs.size(); ++k) {
                const auto of_rig = [&](double nm) { return light(*rigs[k], nm); };
                join(spectral_sum(rigs[k]->water, grid, of_rig), shares[k], sum);
            }
            return path_table(sum, steps_);
        };
        floor_.push_back(tabulated([&](const Rig& rig, double nm) {
            const double u =
                (2.0 * nm - range.first_nm - range.last_nm) / (range.last_nm - range.first_nm);
            return lamp.at(nm) * rig.seafloor.reflectance.at(nm) *
                   std::exp(u * (tint[0] + u * tint[1])) * std::pow(u, power_of_u);
        }));
        for (std::size_t i = 0; i < scatterers_; ++i) {
            // The veil does not depend on the floor's colour.
            veil_.push_back(tabulated([&](const Rig& rig, double nm) {
                return power_of_u > 0 ? 0.0 : lamp.at(nm) * rig.water.scattering_per_m(i, nm);
            }));
        }
    }
    for (std::size_t i = 0; i < scatterers_; ++i) {
        std::vector<double>& phase = phase_.emplace_back(kPhaseSteps + 1, 0.0);
        for (std::size_t node = 0; node <= kPhaseSteps && power_of_u == 0; ++node) {
            const double psi_rad = kVeilCut + static_cast<double>(node) * kPhaseStep_rad;
            for (std::size_t k = 0; k < rigs.size(); ++k)
                phase[node] += shares[k] * rigs[k]->water.scatterers[i].phase.at(psi_rad);
        }
    }
}

PathSignal PathLight::floor(std::size_t strobe, std::size_t version, double path_m) const {
    return signal_at(floor_[version * rig_.strobes.size() + strobe], steps_, path_m);
}

PathSignal PathLight::veil(std::size_t strobe,
                           std::size_t version,
                           std::size_t scatterer,
                           double path_m) const {
    const std::size_t of_strobe = version * rig_.strobes.size() + strobe;
    return signal_at(veil_[of_strobe * scatterers_ + scatterer], steps_, path_m);
}

double PathLight::phase(std::size_t version, std::size_t scatterer, double psi_rad) const {
    const std::vector<double>& phase = phase_[version * scatterers_ + scatterer];
    const double place =
        std::clamp((psi_rad - kVeilCut) / kPhaseStep_rad, 0.0, static_cast<double>(kPhaseSteps));
    const std::size_t node = std::min(static_cast<std::size_t>(place), kPhaseSteps - 1);
    return std::lerp(phase[node], phase[node + 1], place - static_cast<double>(node));
}

double PathLight::longest_m() const {
    return steps_.first_m + steps_.count / steps_.steps_per_m;
}

}  // namespace aphotic
