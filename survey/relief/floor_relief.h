// SPDX-License-Identifier: BSD-3-Clause
//
// An image's relief (light/relief.h) from its depth map (depth_map.h): points and normals of the
// tangent planes (local_planes.h). Where a range is off its plane by more than kOffPlane of the
// plane's own rms, the point is taken from the range.
//
// Holes are filled by the planes around them, up to a thirtieth of the image's width; larger ones
// by the navigation's plane, or stay unknown without one.
#pragma once

#include "light/relief.h"
#include "lightmap/relief_map.h"
#include "rig/rig.h"
#include "survey/relief/depth_map.h"
#include "survey/relief/relief_scene.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace aphotic {

inline constexpr double kOffPlane = 4.0;

enum class DepthIs { AlongAxis, AlongRay };
enum class NormalsFrom { Depth, Floor };

// A mesh of the floor, which with the navigation gives each image its depth map.
struct FloorMesh {
    std::shared_ptr<const ReliefScene> scene;
    ReliefAxes axes = ReliefAxes::EastNorthUp;
    bool is_by_depth = false;  // cameras are placed by the navigation's depth; else above the mesh
};

// The depth maps of a survey: a folder with one per image, the file of a single image, or a mesh.
struct DepthMaps {
    std::filesystem::path place{};
    std::optional<FloorMesh> mesh{};  // read from `place`
    std::optional<double> unit_m{};   // empty: as in depth_map.h
    DepthIs is = DepthIs::AlongAxis;
    NormalsFrom normals = NormalsFrom::Depth;
};

struct FloorRelief {
    Relief relief;
    std::vector<std::uint8_t> filled;  // by pixel: 1 where the map has a hole
    double roughness = 0.0;            // of the ranges within a window, relative
};

[[nodiscard]] nlohmann::ordered_json to_json(const DepthMaps& maps);

// The map has the image's size. floor: the navigation's, for large holes, and required for
// NormalsFrom::Floor. An InputError if all pixels are unknown.
[[nodiscard]] FloorRelief floor_relief(const DepthMap& map,
                                       DepthIs depth_is,
                                       NormalsFrom normals,
                                       const ReliefMapMaker& rays,
                                       const std::optional<Sled>& floor);

}  // namespace aphotic
