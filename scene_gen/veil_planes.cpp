// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/veil_planes.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/sha256.h"
#include "image/exr.h"
#include "rig/veil_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <thread>
#include <vector>

namespace aphotic {
namespace {

// Of the spectral integral and its table: a tenth of what the interpolation is off by.
constexpr double kTableError = 0.1 * kVeilOfSignal;
constexpr int kBlockRows = 256;

// Few points where they do: not where light is lost within a panel, as in water like milk.
unsigned points_of(const Rig& rig) {
    constexpr double kRight = 1e-6;  // beside kVeilOfSignal
    return veil_error(rig, kVeilPointsBetweenKinks) <= kRight ? kVeilPointsBetweenKinks
                                                              : kVeilPoints;
}

struct FrameMap {
    VeilMap map;
    std::size_t planes;  // that count
};

// One for R, G, B, and one for each frame's wavelengths, in the manifest's order; behind a port for
// each by itself, for it has its own ray.
std::vector<FrameMap> maps_of(const Rig& rig, const Manifest& manifest, bool may_see_far) {
    PathRange paths = path_range(rig);
    paths.has_horizon |= may_see_far;
    const unsigned points = points_of(rig);
    std::vector<FrameMap> maps{{VeilMap(rig, paths, kTableError, points), kChannels}};
    std::span<const PlannedWavelength> rest = manifest.wavelengths;
    while (!rest.empty()) {
        std::vector<double> lambda_nm;
        for (const PlannedWavelength& w : rest) {
            const bool same_ray = lambda_nm.empty() || !rig.camera.port;
            if (w.frame == rest.front().frame && same_ray) lambda_nm.push_back(w.lambda_nm);
        }
        maps.push_back({VeilMap(rig, paths, kTableError, points, lambda_nm, rest.front().lambda_nm),
                        lambda_nm.size()});
        rest = rest.subspan(lambda_nm.size());
    }
    return maps;
}

int threads_here() {
    return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

// Over the bare floor, interpolated.
std::vector<float> block_of_cells(const std::vector<FrameMap>& maps,
                                  const Rig& rig,
                                  VeilMap::Rows rows) {
    const std::size_t plane =
        static_cast<std::size_t>(rig.camera.width_px) * static_cast<std::size_t>(rows.count);
    const std::vector<float> no_floor(kChannels * plane, 0.0F);
    std::vector<float> block;
    std::vector<float> veil;
    for (const FrameMap& of_frame : maps) {
        of_frame.map.rows_into(rig.sled, rows, no_floor, threads_here(), veil);
        veil.resize(of_frame.planes * plane);
        block.insert(block.end(), veil.begin(), veil.end());
    }
    return block;
}

// How far each pixel sees, from the frame of fog; infinite where that is all there is.
std::vector<double> distances(const std::filesystem::path& folder,
                              const Manifest& manifest,
                              VeilMap::Rows rows) {
    static const std::vector<std::string> kFog{"R"};
    ExrReader reader(image_path(folder, manifest.frames.back()));
    std::vector<float> fog(static_cast<std::size_t>(manifest.width_px) *
                           static_cast<std::size_t>(rows.count));
    reader.read_rows(rows.first + manifest.rows_above(), rows.count, kFog, fog);
    std::vector<double> distance_m(fog.size());
    std::ranges::transform(fog, distance_m.begin(), [&](float share) {
        return -manifest.veil->fog_m * std::log1p(-std::min(1.0, static_cast<double>(share)));
    });
    return distance_m;
}

// Over anything, pixel by pixel. Where the floor is in view, it is the floor: nearer to it than the
// fog's half floats tell.
std::vector<float> block_of_pixels(const std::vector<FrameMap>& maps,
                                   const Rig& rig,
                                   VeilMap::Rows rows,
                                   const std::vector<double>& distance_m) {
    constexpr double kHalfFloat = 0x1p-11;
    const auto width = static_cast<std::size_t>(rig.camera.width_px);
    const std::size_t plane = distance_m.size();
    std::size_t planes = 0;
    for (const FrameMap& of_frame : maps) planes += of_frame.planes;
    std::vector<float> block(planes * plane);
    std::vector<VeilNodes> rooms(static_cast<std::size_t>(threads_here()));
    const double middle_nm = std::midpoint(rig.camera.range.first_nm, rig.camera.range.last_nm);
    parallel_for(
        static_cast<std::size_t>(rows.count),
        rooms.size(),
        [&](std::size_t row, std::size_t thread) {
            for (std::size_t i = 0; i < width; ++i) {
                const std::size_t at = row * width + i;
                const double x = static_cast<double>(i) + 0.5;
                const double y = rows.first + static_cast<double>(row) + 0.5;
                const double floor_m = sight_of(rig, x, y, middle_nm).length_m;
                const bool is_floor = std::abs(distance_m[at] - floor_m) <= kHalfFloat * floor_m;
                std::size_t first = 0;
                for (const FrameMap& of_frame : maps) {
                    const VeilMap::Signal veil =
                        is_floor ? of_frame.map.at(rig, x, y, rooms[thread])
                                 : of_frame.map.at(rig, x, y, distance_m[at], rooms[thread]);
                    for (std::size_t c = 0; c < of_frame.planes; ++c)
                        block[(first + c) * plane + at] = static_cast<float>(veil[c]);
                    first += of_frame.planes;
                }
            }
        });
    return block;
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
    return kVeilOfSignal + veil_error(rig, points_of(rig));
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
    ManifestVeil veil = manifest.veil.value_or(ManifestVeil{});
    const std::filesystem::path file = veil_path(folder);
    make_folder(file.parent_path());
    const std::vector<FrameMap> maps = maps_of(rig, manifest, veil.fog_m > 0.0);
    ExrWriter writer(file,
                     manifest.width_px,
                     manifest.height_px,
                     veil_channels(manifest),
                     {{"aphotic:rig_sha256", manifest.rig_sha256}});
    for (int row = 0; row < manifest.height_px;) {
        const VeilMap::Rows rows = maps.front().map.rows_for(
            {.first = row, .count = std::min(kBlockRows, manifest.height_px - row)});
        writer.write_rows(rows.count,
                          veil.fog_m > 0.0
                              ? block_of_pixels(maps, rig, rows, distances(folder, manifest, rows))
                              : block_of_cells(maps, rig, rows));
        row = rows.first + rows.count;
    }
    writer.finish();
    veil.sha256 = sha256_of_file(file);
    return veil;
}

std::optional<ManifestVeil> write_veil_of_signals(const std::filesystem::path& folder,
                                                  const Rig& rig,
                                                  const Manifest& manifest) {
    Manifest signals = manifest;
    signals.wavelengths.clear();
    signals.veil.reset();
    return write_veil(folder, rig, signals);
}

}  // namespace aphotic
