// SPDX-License-Identifier: BSD-3-Clause
#include "validation/model_check.h"

#include "base/gauss_rule.h"
#include "base/parallel.h"
#include "validation/traced_veil.h"
#include "validation/tracer.h"

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <optional>

namespace aphotic {
namespace {

constexpr std::uint64_t kSeed = 20111;  // arbitrary, but fixed, for reproducible estimates

// The mean wavelength of a channel's light, over paths of twice the altitude.
double mean_wavelength_nm(const Rig& rig, int channel) {
    const TracedWater water(rig.water);
    const WavelengthRange range = rig.camera.range;
    constexpr int kSteps = 500;
    double light = 0.0;
    double moment_nm = 0.0;
    for (int i = 0; i <= kSteps; ++i) {
        const double nm = std::lerp(range.first_nm, range.last_nm, i / double{kSteps});
        double flux = 0.0;
        for (const Strobe& strobe : rig.strobes) flux += strobe.power * strobe.spectrum.at(nm);
        const double signal = flux * rig.seafloor.reflectance.at(nm) *
                              rig.camera.sensor.response(channel, nm) *
                              std::exp(-water.loss_per_m(nm) * 2.0 * rig.sled.altitude_m);
        light += signal;
        moment_nm += signal * nm;
    }
    return light > 0.0 ? moment_nm / light : 0.5 * (range.first_nm + range.last_nm);
}

Rig bare(Rig rig) {
    rig.objects.clear();
    rig.seafloor.phong = 0.0;
    rig.camera.vignetting.reset();
    return rig;
}

// The pixel of a place along the image's width or height.
std::size_t pixel_at(const GaussNode& place, int pixels) {
    return static_cast<std::size_t>(place.at * pixels);
}

}  // namespace

std::array<double, kChannels> ModelCheck::rms() const {
    std::array<double, kChannels> squares{};
    std::array<double, kChannels> weights{};
    for (const ModelPlace& place : places) {
        const double off = std::abs(place.error()) + place.truth.tail / place.truth.sum.mean;
        squares[place.channel] += place.weight * off * off;
        weights[place.channel] += place.weight;
    }
    std::array<double, kChannels> rms{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        if (weights[c] > 0.0) rms[c] = std::sqrt(squares[c] / weights[c]);
    }
    return rms;
}

ModelCheck check_model(const Rig& rig,
                       std::size_t paths,
                       int threads,
                       const std::function<void(double)>& progress) {
    ModelCheck check{.paths = paths, .places = {}};
    if (!rig.water.scatters()) return check;
    const Rig floor = bare(rig);
    const TracedVeil veil(floor, TracedWater(floor.water));
    const auto width = static_cast<std::size_t>(floor.camera.width_px);
    const auto& across = gauss_rule(kPlacesAcross);
    const auto& down = gauss_rule(kPlacesDown);
    for (int c = 0; c < kChannels; ++c) {
        const double nm = mean_wavelength_nm(floor, c);
        const Tracer tracer(floor, {.signals = false, .planes_nm = {nm}, .threads = 1});
        const MonteCarlo light(floor, nm, {.paths = paths, .seed = kSeed});
        constexpr std::size_t kPlaces = std::size_t{kPlacesAcross} * kPlacesDown;
        std::array<std::optional<ModelPlace>, kPlaces> found;
        std::atomic<std::size_t> done = 0;
        parallel_for(
            kPlaces, static_cast<std::size_t>(threads), [&](std::size_t i, std::size_t thread) {
                const GaussNode& u = across[i % kPlacesAcross];
                const GaussNode& v = down[i / kPlacesAcross];
                const std::size_t column = pixel_at(u, floor.camera.width_px);
                const std::size_t row = pixel_at(v, floor.camera.height_px);
                ModelPlace at{.column = static_cast<double>(column) + 0.5,
                              .row = static_cast<double>(row) + 0.5,
                              .channel = static_cast<std::size_t>(c),
                              .lambda_nm = nm,
                              .truth = {},
                              .weight = u.weight * v.weight};
                if (const auto ray = tracer.ray(at.column, at.row, nm)) {
                    const std::size_t pixel = row * width + column;
                    at.veil = veil.radiance(*ray, nm);
                    at.floor = tracer.pixels({&pixel, 1}).front() - at.veil;
                    at.truth = light.radiance(*ray, pixel);
                    if (at.truth.sum.mean > 0.0) found[i] = at;
                }
                const double share = static_cast<double>(++done) / kPlaces;
                if (progress && thread == 0) progress((c + share) / kChannels);
            });
        for (const auto& place : found) {
            if (place) check.places.push_back(*place);
        }
    }
    return check;
}

}  // namespace aphotic
