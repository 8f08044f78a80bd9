// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/relief_map.h"

#include "light/relief_image.h"
#include "light/relief_veil.h"
#include "lightmap/cone_edge.h"
#include "rig/camera/vignetting.h"

#include <optional>

namespace aphotic {

struct ReliefMapMaker::Tables {
    Tables(const Rig& of, const LightmapOptions& as)
        : rig(of),
          options(as),
          rays(rig, options.threads),
          signals(signal_table(rig, kReliefPaths, options.error)),
          light(rig, rig.sled, signals, rays) {
        if (rig.camera.vignetting) vignetting = vignetting_plane(rig.camera);
        if (!rig.water.scatters() || !options.has_veil) return;
        veil.emplace(rig, kReliefPaths, options.error, map_veil_points(rig, options));
        before.emplace(*veil, rays, rig.camera.width_px, rig.camera.height_px);
    }

    Rig rig;
    LightmapOptions options;
    CameraRays rays;
    SignalTable signals;
    FloorLight light;
    std::vector<float> vignetting;
    std::optional<VeilMap> veil;
    std::optional<ReliefVeil> before;
};

namespace {

std::vector<std::uint8_t> edges_of(const Relief& relief,
                                   const std::vector<std::uint32_t>& seen,
                                   int within_px) {
    std::vector<std::uint8_t> edges(relief.point_m.size());
    if (within_px == 0) return edges;
    const auto compare = [&](std::size_t pixel, std::size_t neighbour) {
        if (seen[pixel] == seen[neighbour] && !relief.jumps(pixel, neighbour)) return;
        edges[pixel] = 1;
        edges[neighbour] = 1;
    };
    for (int row = 0; row < relief.height_px; ++row) {
        for (int column = 0; column < relief.width_px; ++column) {
            const std::size_t pixel = relief.at(column, row);
            if (column + 1 < relief.width_px) compare(pixel, pixel + 1);
            if (row + 1 < relief.height_px) compare(pixel, relief.at(column, row + 1));
        }
    }
    spread(edges, relief.width_px, within_px - 1);
    return edges;
}

void take_off(const std::vector<float>& vignetting, std::vector<float>& planes) {
    for (std::size_t i = 0; !vignetting.empty() && i < planes.size(); ++i)
        planes[i] *= vignetting[i % vignetting.size()];
}

}  // namespace

ReliefMapMaker::ReliefMapMaker(const Rig& rig, const LightmapOptions& options)
    : tables_(std::make_unique<Tables>(rig, options)) {}

ReliefMapMaker::~ReliefMapMaker() = default;

ReliefMap ReliefMapMaker::map(const Relief& relief, int within_px) const {
    ReliefLight light =
        relief_light(tables_->rig, tables_->light, relief, tables_->options.threads);
    ReliefMap made{.map = {.width_px = relief.width_px,
                           .height_px = relief.height_px,
                           .samples = std::move(light.samples)},
                   .edges = edges_of(relief, light.seen, within_px)};
    if (tables_->before) made.map.veil = tables_->before->before(relief);
    take_off(tables_->vignetting, made.map.samples);
    take_off(tables_->vignetting, made.map.veil);
    return made;
}

bool ReliefMapMaker::has_port() const {
    return tables_->light.has_port();
}

WaterRay ReliefMapMaker::ray(double column, double row) const {
    const FloorRay found = tables_->light.rays_at(column, row)[0];
    return {.origin_m = found.origin_m, .direction = found.direction};
}

}  // namespace aphotic
