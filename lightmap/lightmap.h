// SPDX-License-Identifier: BSD-3-Clause
//
// The signal of the rig's camera on its bare flat floor, at the camera's frame rate:
// light/floor_light.h's sum at every pixel, by tiles of the image (light/floor_image.h). The signal
// over path length is tabulated once per water (light/signal_table.h); a map for any altitude and
// attitude is then geometry and table look-ups at few places where the light is smooth, with a
// polynomial between them.
//
// An emitter with a size is the grid of lamps of rig/geometry.h. Where the image sees no floor, the
// map is black; so it is beyond the longest path if the paths have a horizon, that is if everything
// beyond is darker than kDarkShare of the brightest.
#pragma once

#include "light/floor_light.h"
#include "light/path_range.h"
#include "light/signal_table.h"
#include "light/veil_map.h"
#include "rig/rig.h"
#include "spectral/bands.h"
#include "spectral/veil_share.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace aphotic {

inline constexpr double kLeastMapError = 1e-7;
inline constexpr double kMostMapError = 0.1;  // also of the veil

struct LightmapOptions {
    // Relative, of the spectral integral and of its table. Rounding of floats adds to it, and
    // behind a port the interpolation over the index.
    double error = 1e-5;
    int threads = 1;       // changes no bit
    bool has_veil = true;  // where the water scatters
    // The veil's largest error, relative to the signal: as measured; the rule along the ray adds to
    // it.
    double veil_tolerance = kVeilOfSignal;
};

// For the rule along a ray, whose error should be small compared with the veil's own.
[[nodiscard]] unsigned map_veil_points(const Rig& rig, const LightmapOptions& options);

// The relative difference of a map's signal from the exact one of the same lamps, off the beams'
// edges.
struct MapPromise {
    double error = 0.0;
    // Behind a port the interpolation over the index is measured and has no bound, nor has that of
    // a veil.
    bool is_bounded = true;
    bool has_veil = false;  // the error is that of the sum
    // Emitters with a size are their grids of lamps, and penumbrae have as many steps.
    bool is_of_lamp_grids = false;
};

// The requested error, that of tiles and the rounding of floats, that of a sum of a dozen; behind a
// port plus 1e-4. For the sum of both in water that scatters, the veil's tolerance and veil_error()
// (light/veil.h) are added, measured and not a bound.
[[nodiscard]] MapPromise map_promise(const Rig& rig, const LightmapOptions& options);

// R, G, B planar: all rows of R, then of G, then of B.
struct Lightmap {
    int width_px = 0;
    int height_px = 0;
    std::vector<float> samples;
    // The veil (light/veil_map.h), in the same unit: the signal is samples + veil. Empty if the
    // water does not scatter.
    std::vector<float> veil{};
};

// samples + veil: the camera's signal.
[[nodiscard]] std::vector<float> signal_of(const Lightmap& map);

[[nodiscard]] VeilShare veil_share_of(const Lightmap& map);

// The properties of a strobe that can change while its lamps and the tables stay.
struct StrobePlace {
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // unit vector
    double power = 1.0;
};
void put(const StrobePlace& place, Strobe& strobe);

class LightmapMaker {
  public:
    // paths: the range that the tables must cover; empty: those of the rig's own sled. An
    // InputError for a rig with objects or a user's scene, since the map shows the bare floor.
    LightmapMaker(const Rig& rig,
                  const std::optional<PathRange>& paths,
                  const LightmapOptions& options);

    // An InputError if this sled sees paths outside the tables' range, or puts a lamp below the
    // floor.
    [[nodiscard]] Lightmap map(const Sled& sled) const;
    // The same into an existing map: without allocation if it has the size.
    void map_into(const Sled& sled, Lightmap& map) const;
    // Some rows only, of whole tiles: from a multiple of kVeilTile_px to another, or to the last.
    void rows_into(const Sled& sled, int first_row, int count, Lightmap& map) const;

    // Moves, turns and dims the strobes for all later maps; their lamps and the tables stay.
    void place(const std::vector<StrobePlace>& by_strobe);

    [[nodiscard]] const PathRange& paths() const { return paths_; }
    [[nodiscard]] std::size_t grid_size() const { return table_.grid_size; }
    [[nodiscard]] int table_steps() const { return table_.steps.count; }

  private:
    void make_veil();
    void require_served(const Sled& sled, bool is_before, bool is_beyond) const;
    void take_off_vignetting(int first_row, int count, std::vector<float>& all) const;

    Rig rig_;
    LightmapOptions options_;
    PathRange paths_;
    PathRange direct_;  // as requested
    CameraRays rays_;
    SignalTable table_;
    std::vector<float> vignetting_;          // by pixel; empty: none
    unsigned veil_points_ = kVeilMapPoints;  // of the rig as given, wherever strobes are placed
    std::shared_ptr<const VeilMap> veil_;    // empty if the water does not scatter
};

// The paths that any of these sleds sees, with some margin for those between them.
[[nodiscard]] PathRange paths_of(const Rig& rig, const std::vector<Sled>& sleds);

}  // namespace aphotic
