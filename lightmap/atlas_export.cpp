// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/atlas_export.h"

#include "base/atomic_file.h"
#include "base/number.h"
#include "base/parallel.h"
#include "image/exr.h"
#include "lightmap/altitude_fit.h"
#include "lightmap/atlas_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

ExrAttributes attributes_of(const Rig& rig) {
    return {{"aphotic:rig_title", rig.title},
            {"aphotic:rig_sha256", rig.digest},
            {"aphotic:renderer", "lightmap"}};
}

constexpr const char* kMosaicsFolder = "bayer";
constexpr const char* kFits = "exponential.exr";

// After the point, so that no altitude is rounded.
int digits_of(const std::vector<double>& altitude_m) {
    constexpr int kLeast = 2;
    constexpr int kMost = 9;  // as finely as axes are read
    int digits = kLeast;
    for (const double h_m : altitude_m) {
        while (digits < kMost && read_number<double>(fmt::format("{:.{}f}", h_m, digits)) != h_m) {
            ++digits;
        }
    }
    return digits;
}

constexpr std::array<const char*, 4> kFitted{"a", "b", "c", "residual"};

std::vector<std::string> fitted_channels() {
    std::vector<std::string> names;
    for (const std::string_view channel : kChannelNames) {
        for (const char* part : kFitted) names.push_back(fmt::format("{}.{}", part, channel));
    }
    return names;
}

// The fits of all samples of some rows, which come as one map an altitude: planes in the order of
// fitted_channels.
std::vector<float> fitted(const AltitudeFitter& fitter,
                          const std::vector<Lightmap>& maps,
                          int threads) {
    const std::size_t plane = maps.front().samples.size() / kChannels;
    std::vector<float> planes(kChannels * kFitted.size() * plane);
    const std::size_t samples = kChannels * plane;
    constexpr std::size_t kAtOnce = 1024;
    const auto fit_some = [&](std::size_t part, std::size_t) {
        std::vector<double> signal(maps.size());
        for (std::size_t i = part * kAtOnce; i < std::min((part + 1) * kAtOnce, samples); ++i) {
            std::ranges::transform(maps, signal.begin(), [&](const Lightmap& map) {
                return map.samples[i] + (map.veil.empty() ? 0.0F : map.veil[i]);
            });
            const AltitudeFit fit = fitter.fit(signal);
            float* to = &planes[i / plane * kFitted.size() * plane + i % plane];
            for (const double value : {fit.a, fit.b_per_m, fit.c, fit.residual}) {
                *to = static_cast<float>(value);
                to += plane;
            }
        }
    };
    parallel_for((samples + kAtOnce - 1) / kAtOnce, static_cast<std::size_t>(threads), fit_some);
    return planes;
}

}  // namespace

MapAxes axes_at_own_pose(const Rig& rig, const std::vector<double>& altitude_m) {
    return {.altitude_m = altitude_m,
            .pitch_rad = {rig.sled.pitch_rad},
            .roll_rad = {rig.sled.roll_rad},
            .water_multiple = {rig.water.multiple}};
}

std::vector<float> mosaic_rggb(const Lightmap& map) {
    const auto width = static_cast<std::size_t>(map.width_px);
    const auto height = static_cast<std::size_t>(map.height_px);
    std::vector<float> mosaic(width * height);
    for (std::size_t row = 0; row < height; ++row) {
        for (std::size_t column = 0; column < width; ++column) {
            const std::size_t channel = row % 2 + column % 2;  // R 0, G 1, B 2
            const std::size_t at = row * width + column;
            mosaic[at] = map.samples[channel * width * height + at];
        }
    }
    return mosaic;
}

std::vector<ExportedMosaic> export_bayer(const fs::path& folder,
                                         const Rig& rig,
                                         const AltitudeExport& request) {
    const MapAxes axes = axes_at_own_pose(rig, request.altitude_m);
    const int digits = digits_of(request.altitude_m);
    MapSource source(rig, axes, request.map);
    make_folder(folder / kMosaicsFolder);
    std::vector<ExportedMosaic> made;
    for (const MapPoint& point : points_of(axes)) {
        request.progress(static_cast<double>(made.size()) /
                         static_cast<double>(request.altitude_m.size()));
        const double altitude_m = point.sled.altitude_m;
        const std::string file =
            fmt::format("{}/altitude_{:.{}f}m.exr", kMosaicsFolder, altitude_m, digits);
        ExrAttributes attributes = attributes_of(rig);
        attributes.emplace_back("aphotic:altitude_m", fmt::format("{}", altitude_m));
        attributes.emplace_back("aphotic:mosaic", "RGGB");
        const Lightmap map = source.map(point);
        std::vector<std::string> names{"Y"};
        std::vector<float> mosaics = mosaic_rggb(map);
        if (!map.veil.empty()) {
            const std::vector<float> veil = mosaic_rggb({map.width_px, map.height_px, map.veil});
            names.emplace_back("veil.Y");
            mosaics.insert(mosaics.end(), veil.begin(), veil.end());
        }
        ExrWriter writer(
            folder / file, rig.camera.width_px, rig.camera.height_px, names, attributes);
        writer.write_rows(rig.camera.height_px, mosaics);
        writer.finish();
        made.push_back({.file = file, .altitude_m = altitude_m});
    }
    return made;
}

void remove_exports(const fs::path& folder) {
    fs::remove(folder / kFits);
    if (!fs::is_directory(folder / kMosaicsFolder)) return;
    remove_abandoned_files(folder / kMosaicsFolder);
    std::vector<fs::path> mosaics;
    for (const auto& entry : fs::directory_iterator(folder / kMosaicsFolder)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("altitude_") && name.ends_with("m.exr"))
            mosaics.push_back(entry.path());
    }
    for (const fs::path& file : mosaics) fs::remove(file);
    if (fs::is_empty(folder / kMosaicsFolder)) fs::remove(folder / kMosaicsFolder);
}

ExportedFit export_exponential(const fs::path& folder,
                               const Rig& rig,
                               const AltitudeExport& request) {
    constexpr int kRows = 32;  // of all altitudes at once
    const MapAxes axes = axes_at_own_pose(rig, request.altitude_m);
    const AltitudeFitter fitter(request.altitude_m);
    MapSource source(rig, axes, request.map);
    ExrAttributes attributes = attributes_of(rig);
    attributes.emplace_back("aphotic:fit", "a exp(b h) + c, h the altitude in metres");
    ExrWriter writer(
        folder / kFits, rig.camera.width_px, rig.camera.height_px, fitted_channels(), attributes);
    ExportedFit residuals{.file = kFits};
    double squares = 0.0;
    for (int row = 0; row < rig.camera.height_px; row += kRows) {
        request.progress(static_cast<double>(row) / rig.camera.height_px);
        const int count = std::min(kRows, rig.camera.height_px - row);
        std::vector<Lightmap> maps;
        for (const MapPoint& point : points_of(axes)) {
            maps.push_back(source.rows(point, row, count));
        }
        const std::vector<float> planes = fitted(fitter, maps, request.map.threads);
        writer.write_rows(count, planes);
        const std::size_t plane = planes.size() / (kChannels * kFitted.size());
        for (std::size_t c = 0; c < kChannels; ++c) {
            const std::size_t first = (c * kFitted.size() + kFitted.size() - 1) * plane;
            for (std::size_t i = first; i < first + plane; ++i) {
                squares += static_cast<double>(planes[i]) * planes[i];
                residuals.worst = std::max<double>(residuals.worst, planes[i]);
            }
        }
    }
    writer.finish();
    residuals.rms = std::sqrt(
        squares / (static_cast<double>(kChannels) * rig.camera.width_px * rig.camera.height_px));
    return residuals;
}

}  // namespace aphotic
