// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/oplab_export.h"

#include "base/atomic_file.h"
#include "base/npy_file.h"
#include "base/parallel.h"
#include "lightmap/altitude_fit.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr const char* kParameters = "attenuation_parameters.npy";
constexpr const char* kGains = "correction_gains.npy";
constexpr const char* kMean = "image_corrected_mean.npy";
constexpr const char* kDeviation = "image_corrected_std.npy";
constexpr std::size_t kParts = 3;  // a, b, c

// The residual of one sample's fit.
struct Residual {
    double of_mean = 0.0;
    int lit = 0;  // altitudes
    int off = 0;  // of these
};

struct Fits {
    std::vector<float> parameters;  // as in the file
    std::vector<Residual> residuals;
};

class Fitter {
  public:
    Fitter(const std::vector<double>& altitude_m, std::size_t samples)
        : altitude_m_(altitude_m),
          fitter_(altitude_m),
          fits_{.parameters = std::vector<float>(kParts * samples),
                .residuals = std::vector<Residual>(samples)} {}

    // Fits the sample's light at every altitude.
    void fit(std::size_t sample, const std::vector<double>& signal) {
        AltitudeFit fit = fitter_.fit(signal);
        if (fit.a == 0.0 && fit.c == 0.0) fit = {.a = 1.0};
        const std::array<double, kParts> parts{fit.a, fit.b_per_m, fit.c};
        std::ranges::copy(parts, &fits_.parameters[kParts * sample]);
        Residual& residual = fits_.residuals[sample];
        residual.of_mean = fit.residual;
        for (std::size_t i = 0; i < signal.size(); ++i) {
            if (!(signal[i] > 0.0)) continue;
            const double fitted = fit.a * std::exp(fit.b_per_m * altitude_m_[i]) + fit.c;
            ++residual.lit;
            if (!(std::abs(fitted / signal[i] - 1.0) <= kOplabOff)) ++residual.off;
        }
    }

    [[nodiscard]] Fits take() { return std::move(fits_); }

  private:
    const std::vector<double>& altitude_m_;
    AltitudeFitter fitter_;
    Fits fits_;
};

std::vector<Sled> sleds_at(const Rig& rig, const std::vector<double>& altitude_m) {
    std::vector<Sled> sleds(altitude_m.size(), rig.sled);
    for (std::size_t i = 0; i < sleds.size(); ++i) sleds[i].altitude_m = altitude_m[i];
    return sleds;
}

Fits fits_of(const Rig& rig, const AltitudeExport& request) {
    constexpr int kRows = kVeilTile_px;  // of all altitudes at once
    const auto width = static_cast<std::size_t>(rig.camera.width_px);
    const auto height = static_cast<std::size_t>(rig.camera.height_px);
    const std::vector<Sled> sleds = sleds_at(rig, request.altitude_m);
    const LightmapMaker maker(rig, paths_of(rig, {sleds.front(), sleds.back()}), request.map);
    Fitter fitter(request.altitude_m, kChannels * width * height);
    for (int row = 0; row < rig.camera.height_px; row += kRows) {
        request.progress(static_cast<double>(row) / rig.camera.height_px);
        const int rows = std::min(kRows, rig.camera.height_px - row);
        std::vector<Lightmap> maps(sleds.size());
        for (std::size_t i = 0; i < sleds.size(); ++i)
            maker.rows_into(sleds[i], row, rows, maps[i]);
        const auto fit_row = [&](std::size_t part, std::size_t) {
            const std::size_t channel = part / static_cast<std::size_t>(rows);
            const std::size_t at = part % static_cast<std::size_t>(rows);
            std::vector<double> signal(maps.size());
            for (std::size_t column = 0; column < width; ++column) {
                std::ranges::transform(maps, signal.begin(), [&](const Lightmap& map) {
                    const std::size_t i = part * width + column;
                    return map.samples[i] + (map.veil.empty() ? 0.0F : map.veil[i]);
                });
                const std::size_t whole_row = static_cast<std::size_t>(row) + at;
                fitter.fit((channel * height + whole_row) * width + column, signal);
            }
        };
        parallel_for(kChannels * static_cast<std::size_t>(rows),
                     static_cast<std::size_t>(request.map.threads),
                     fit_row);
    }
    return fitter.take();
}

bool is_lit(const Residual& residual) {
    return residual.lit > 0;
}

}  // namespace

ExportedOplab export_oplab(const fs::path& folder, const Rig& rig, const AltitudeExport& request) {
    const std::array files{kParameters, kGains, kMean, kDeviation};
    for (const char* file : files) fs::remove(folder / file);
    const Fits fits = fits_of(rig, request);
    const auto width = static_cast<std::size_t>(rig.camera.width_px);
    const auto height = static_cast<std::size_t>(rig.camera.height_px);
    const std::size_t samples = fits.residuals.size();
    const double mean_m =
        std::accumulate(request.altitude_m.begin(), request.altitude_m.end(), 0.0) /
        static_cast<double>(request.altitude_m.size());
    std::vector<float> gains(samples);
    std::vector<float> mean(samples);
    std::vector<float> deviation(samples);
    ExportedOplab made;
    double squares = 0.0;
    double lit = 0.0;
    double off = 0.0;
    for (std::size_t i = 0; i < samples; ++i) {
        const float* part = &fits.parameters[kParts * i];
        gains[i] = static_cast<float>(part[0] * std::exp(part[1] * mean_m) + part[2]);
        const std::size_t pixel = i % (width * height);
        const std::size_t interleaved = kChannels * pixel + i / (width * height);
        const Residual& residual = fits.residuals[i];
        mean[interleaved] = is_lit(residual) ? gains[i] : 0.0F;
        deviation[interleaved] =
            is_lit(residual) ? static_cast<float>(kContrastOverBrightness * gains[i]) : 1.0F;
        squares += residual.of_mean * residual.of_mean;
        made.worst = std::max(made.worst, residual.of_mean);
        lit += residual.lit;
        off += residual.off;
    }
    made.rms = std::sqrt(squares / static_cast<double>(samples));
    made.share_off = lit > 0.0 ? off / lit : 0.0;
    write_npy(folder / kParameters, {kChannels, height, width, kParts}, fits.parameters);
    write_npy(folder / kGains, {kChannels, height, width}, gains);
    write_npy(folder / kMean, {height, width, kChannels}, mean);
    write_npy(folder / kDeviation, {height, width, kChannels}, deviation);
    return made;
}

nlohmann::ordered_json to_json(const ExportedOplab& made) {
    return {{"rms", made.rms}, {"worst", made.worst}, {"share_off_by_10_percent", made.share_off}};
}

}  // namespace aphotic
