// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/veil_planes.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/sha256.h"
#include "image/exr.h"
#include "rig/veil_map.h"

#include <algorithm>
#include <span>
#include <thread>
#include <vector>

namespace aphotic {
namespace {

// Of the spectral integral and its table: a tenth of what the interpolation is off by.
constexpr double kTableError = 0.1 * kVeilOfSignal;
constexpr int kBlockRows = 256;

struct FrameMap {
    VeilMap map;
    std::size_t planes;  // that count
};

// One for R, G, B, and one for each frame's wavelengths, in the manifest's order.
std::vector<FrameMap> maps_of(const Rig& rig, const Manifest& manifest) {
    const PathRange paths = path_range(rig);
    std::vector<FrameMap> maps{{VeilMap(rig, paths, kTableError, kVeilPoints), kChannels}};
    std::span<const PlannedWavelength> rest = manifest.wavelengths;
    while (!rest.empty()) {
        std::vector<double> lambda_nm;
        for (const PlannedWavelength& w : rest) {
            if (w.frame == rest.front().frame) lambda_nm.push_back(w.lambda_nm);
        }
        maps.push_back(
            {VeilMap(rig, paths, kTableError, kVeilPoints, lambda_nm, rest.front().index_nm),
             lambda_nm.size()});
        rest = rest.subspan(lambda_nm.size());
    }
    return maps;
}

}  // namespace

void require_bare_floor_under_veil(const Rig& rig) {
    constexpr auto kAllowed = "allowed with water that scatters: the bare floor";
    if (!rig.objects.empty())
        throw InputError("found the object '{}'; {}", rig.objects.front().name, kAllowed);
    if (!rig.scene.empty())
        throw InputError("found the scene {}; {}", rig.scene.string(), kAllowed);
}

double veil_plane_error(const Rig& rig) {
    return kVeilOfSignal + veil_error(rig, kVeilPoints);
}

std::array<RuleQuality, kChannels> with_veil(std::array<RuleQuality, kChannels> quality,
                                             double veil_error) {
    for (RuleQuality& channel : quality) {
        if (channel.amplification > 0.0) channel.error += veil_error;
    }
    return quality;
}

std::optional<ManifestVeil> write_veil(const std::filesystem::path& folder,
                                       const Rig& rig,
                                       const Manifest& manifest) {
    if (!rig.water.scatters()) return std::nullopt;
    const std::filesystem::path file = veil_path(folder);
    make_folder(file.parent_path());
    const std::vector<FrameMap> maps = maps_of(rig, manifest);
    const int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    ExrWriter writer(file,
                     manifest.width_px,
                     manifest.height_px,
                     veil_channels(manifest),
                     {{"aphotic:rig_sha256", manifest.rig_sha256}});
    for (int row = 0; row < manifest.height_px;) {
        const VeilMap::Rows rows = maps.front().map.rows_for(
            {.first = row, .count = std::min(kBlockRows, manifest.height_px - row)});
        const std::size_t plane =
            static_cast<std::size_t>(manifest.width_px) * static_cast<std::size_t>(rows.count);
        const std::vector<float> no_floor(kChannels * plane, 0.0F);
        std::vector<float> block;
        std::vector<float> veil;
        for (const FrameMap& of_frame : maps) {
            of_frame.map.rows_into(rig.sled, rows, no_floor, threads, veil);
            veil.resize(of_frame.planes * plane);
            block.insert(block.end(), veil.begin(), veil.end());
        }
        writer.write_rows(rows.count, block);
        row = rows.first + rows.count;
    }
    writer.finish();
    return ManifestVeil{.sha256 = sha256_of_file(file)};
}

std::optional<ManifestVeil> write_veil_of_signals(const std::filesystem::path& folder,
                                                  const Rig& rig,
                                                  const Manifest& manifest) {
    Manifest signals = manifest;
    signals.wavelengths.clear();
    return write_veil(folder, rig, signals);
}

}  // namespace aphotic
