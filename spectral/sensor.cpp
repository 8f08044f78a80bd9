// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/sensor.h"

#include "base/error.h"
#include "spectral/curve_loader.h"

#include <string>
#include <utility>

namespace aphotic {
namespace {

constexpr double kPlanck_j_s = 6.62607015e-34;
constexpr double kLightSpeed_m_per_s = 299792458.0;
constexpr double kMetrePerNm = 1e-9;

double photons_per_joule(double lambda_nm) {
    return lambda_nm * kMetrePerNm / (kPlanck_j_s * kLightSpeed_m_per_s);
}

}  // namespace

Sensor::Sensor(std::vector<Spectrum> responses, ResponseKind kind)
    : responses_(std::move(responses)), kind_(kind) {
    if (responses_.size() != kChannels) {
        throw InputError("found {} channel responses; allowed: {}, red, green, blue",
                         responses_.size(),
                         kChannels);
    }
}

Sensor Sensor::filtered(std::vector<Spectrum> filters, Spectrum quantum_efficiency) {
    Sensor sensor(std::move(filters), ResponseKind::Quantum);
    sensor.quantum_efficiency_ = std::move(quantum_efficiency);
    return sensor;
}

Sensor Sensor::mono(const Spectrum& quantum_efficiency) {
    Sensor sensor(std::vector(kChannels, quantum_efficiency), ResponseKind::Quantum);
    sensor.is_mono_ = true;
    return sensor;
}

double Sensor::response(int channel, double lambda_nm) const {
    double response = responses_.at(static_cast<std::size_t>(channel)).at(lambda_nm);
    if (quantum_efficiency_) response *= quantum_efficiency_->at(lambda_nm);
    if (kind_ == ResponseKind::Quantum) response *= photons_per_joule(lambda_nm);
    return response;
}

std::vector<const Spectrum*> Sensor::curves() const {
    std::vector<const Spectrum*> curves;
    for (const Spectrum& response : responses_) curves.push_back(&response);
    if (quantum_efficiency_) curves.push_back(&*quantum_efficiency_);
    return curves;
}

WavelengthRange Sensor::range() const {
    return common_range(curves());
}

Sensor builtin_sensor(std::string_view name) {
    const std::string text(name);
    auto responses = load_curves(text, CurveRole::SensorResponse, {});
    const bool quantum = builtin_table(text).text_of("kind") == "quantum";
    return {std::move(responses), quantum ? ResponseKind::Quantum : ResponseKind::Energy};
}

}  // namespace aphotic
