// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/veil_planes.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/sha256.h"
#include "image/exr.h"
#include "light/dispersion.h"
#include "light/veil_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

namespace aphotic {
namespace {

// The share of the spectral integral, its table and the rule along the ray: a tenth of the
// interpolation's error.
constexpr double kTableError = 0.1 * kVeilOfSignal;
constexpr int kBlockRows = 2 * kVeilTile_px;
// Deflate takes longer than everything else, for a third of the size.
constexpr int kNotCompressed = 0;

// Planes with the same rays.
struct Planes {
    VeilMap veil;
    CameraRays rays;
};

// R, G, B and then the wavelengths, in the manifest's order: as many as fit into a group, but
// behind a port each wavelength separately, since it has its own ray.
std::vector<Planes> planes_of(const Rig& rig,
                              const Manifest& manifest,
                              bool may_see_far,
                              int threads) {
    PathRange paths = path_range(rig);
    paths.has_horizon |= may_see_far;
    const unsigned points = veil_points(rig, kTableError);
    std::vector<double> lambda_nm;
    for (const PlannedWavelength& w : manifest.wavelengths) lambda_nm.push_back(w.lambda_nm);
    std::span<const double> rest = lambda_nm;
    const auto take = [&](std::size_t most) {
        const std::span<const double> first = rest.first(std::min(most, rest.size()));
        rest = rest.subspan(first.size());
        return first;
    };
    std::vector<Planes> planes;
    const std::size_t beside_signals = disperses(rig) ? 0 : kVeilPlanes - kChannels;
    planes.push_back({.veil = VeilMap(rig, paths, kTableError, points, take(beside_signals)),
                      .rays = CameraRays(rig, threads)});
    while (!rest.empty()) {
        const double nm = rest.front();
        const auto next = take(disperses(rig) ? 1 : kVeilPlanes);
        planes.push_back({.veil = VeilMap(rig, paths, kTableError, points, next, false),
                          .rays = CameraRays(rig, nm, threads)});
    }
    return planes;
}

std::size_t count_of(const std::vector<Planes>& planes) {
    std::size_t count = 0;
    for (const Planes& some : planes) count += some.veil.planes();
    return count;
}

// Some rows of an image.
struct Rows {
    int first = 0;
    int count = 0;
};

// Over the bare floor, by tiles.
void paint_block(const std::vector<Planes>& planes,
                 const Rig& rig,
                 Rows rows,
                 int threads,
                 std::vector<float>& block) {
    const std::size_t plane =
        static_cast<std::size_t>(rig.camera.width_px) * static_cast<std::size_t>(rows.count);
    block.resize(count_of(planes) * plane);
    float* samples = block.data();
    for (const Planes& some : planes) {
        some.veil.paint(rig.sled,
                        some.rays,
                        nullptr,
                        kVeilOfSignal,
                        threads,
                        {.width_px = rig.camera.width_px,
                         .height_px = rig.camera.height_px,
                         .first = rows.first,
                         .count = rows.count,
                         .samples = samples});
        samples += some.veil.planes() * plane;
    }
}

// The distance that each pixel sees, from the frame of fog; infinite if it sees only fog.
std::vector<double> distances(const std::filesystem::path& folder,
                              const Manifest& manifest,
                              Rows rows) {
    static const std::vector<std::string> kFog{"R"};
    ExrReader reader(image_path(folder, manifest.frames.back()));
    std::vector<float> fog(static_cast<std::size_t>(manifest.width_px) *
                           static_cast<std::size_t>(rows.count));
    reader.read_rows(rows.first, rows.count, kFog, fog);
    std::vector<double> distance_m(fog.size());
    std::ranges::transform(fog, distance_m.begin(), [&](float share) {
        return -manifest.veil->fog_m * std::log1p(-std::min(1.0, static_cast<double>(share)));
    });
    return distance_m;
}

// Over any scene, pixel by pixel. Where the floor is in view, its distance is used, since the fog's
// half floats are coarser.
std::vector<float> block_of_pixels(const std::vector<Planes>& planes,
                                   const Rig& rig,
                                   Rows rows,
                                   const std::vector<double>& distance_m,
                                   int threads) {
    constexpr double kHalfFloat = 0x1p-11;
    const auto width = static_cast<std::size_t>(rig.camera.width_px);
    const std::size_t plane = distance_m.size();
    std::vector<float> block(count_of(planes) * plane);
    const Plane floor = floor_plane(rig.sled);
    std::vector<VeilNodes> rooms(static_cast<std::size_t>(threads));
    const double middle_nm = std::midpoint(rig.camera.range.first_nm, rig.camera.range.last_nm);
    parallel_for(static_cast<std::size_t>(rows.count),
                 rooms.size(),
                 [&](std::size_t row, std::size_t thread) {
                     for (std::size_t i = 0; i < width; ++i) {
                         const std::size_t at = row * width + i;
                         const double x = static_cast<double>(i) + 0.5;
                         const double y = rows.first + static_cast<double>(row) + 0.5;
                         const double floor_m = sight_of(rig, x, y, middle_nm).length_m;
                         const bool is_floor =
                             std::abs(distance_m[at] - floor_m) <= kHalfFloat * floor_m;
                         std::size_t first = 0;
                         for (const auto& [veil, rays] : planes) {
                             const VeilMap::Signal found =
                                 veil.at(rays.at(x, y, floor),
                                         rooms[thread],
                                         is_floor ? std::nullopt : std::optional(distance_m[at]));
                             for (std::size_t c = 0; c < veil.planes(); ++c)
                                 block[(first + c) * plane + at] = static_cast<float>(found[c]);
                             first += veil.planes();
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
    return kVeilOfSignal + veil_error(rig, veil_points(rig, kTableError));
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
                                       const Manifest& manifest,
                                       int threads) {
    if (!rig.water.scatters()) return std::nullopt;
    ManifestVeil veil = manifest.veil.value_or(ManifestVeil{});
    const std::filesystem::path file = veil_path(folder);
    make_folder(file.parent_path());
    const std::vector<Planes> planes = planes_of(rig, manifest, veil.fog_m > 0.0, threads);
    ExrWriter writer(file,
                     manifest.width_px,
                     manifest.height_px,
                     veil_channels(manifest),
                     {{"aphotic:rig_sha256", manifest.rig_sha256}},
                     kNotCompressed);
    std::vector<float> block;
    for (int row = 0; row < manifest.height_px; row += kBlockRows) {
        const Rows rows{.first = row, .count = std::min(kBlockRows, manifest.height_px - row)};
        if (veil.fog_m > 0.0)
            block = block_of_pixels(planes, rig, rows, distances(folder, manifest, rows), threads);
        else
            paint_block(planes, rig, rows, threads, block);
        writer.write_rows(rows.count, block);
    }
    writer.finish();
    veil.sha256 = sha256_of_file(file);
    return veil;
}

std::optional<ManifestVeil> write_veil_of_signals(const std::filesystem::path& folder,
                                                  const Rig& rig,
                                                  const Manifest& manifest,
                                                  int threads) {
    Manifest signals = manifest;
    signals.wavelengths.clear();
    signals.veil.reset();
    return write_veil(folder, rig, signals, threads);
}

}  // namespace aphotic
