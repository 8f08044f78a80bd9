// SPDX-License-Identifier: BSD-3-Clause
//
// An atlas: a folder of a rig's maps over altitude, pitch, roll and water.
//
//   ATLAS/atlas.json                   what it is of, its axes, the bins with their checksums, and
//                                      what was exported beside them (atlas_export.h,
//                                      oplab_export.h)
//   ATLAS/bins/a2.1_p-5_r0_w1.exr      R, G, B at 2.1 m, pitch -5, roll 0 degrees, the water once;
//                                      and veil.R, veil.G, veil.B where the water scatters
//
// Maps between the bins are interpolated (map_axes.h), and atlas.json says with what error. Bins
// are written one by one and noted as they are: an atlas that was interrupted goes on where it
// stopped, and bins of the same rig, version and error are kept when its axes change. A bin is kept
// while its file is the one noted; one that was written but not noted any more, while its header
// says that it is of all the same.
#pragma once

#include "base/work_folder.h"
#include "lightmap/atlas_export.h"
#include "lightmap/atlas_plan.h"
#include "lightmap/map_axes.h"
#include "lightmap/oplab_export.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct AtlasExports {
    std::vector<ExportedMosaic> bayer;
    std::optional<ExportedFit> exponential;
    std::optional<ExportedOplab> oplab{};
};

struct AtlasManifest {
    std::string version;  // of the program that made it
    std::string title;
    std::string rig_digest;
    int width_px = 0;
    int height_px = 0;
    double error = 0.0;  // of the bins themselves
    MapAxes axes;
    InterpolationError interpolation;
    std::vector<std::string> checksums;  // by bin; empty: not yet there
    AtlasExports exports;
};

// As "a2.1_p-5_r0_w1.exr".
[[nodiscard]] std::string bin_name(const MapPoint& point);

// Bins of these axes whose files are not there, whatever is in the others.
[[nodiscard]] std::size_t bins_missing(const std::filesystem::path& folder, const MapAxes& axes);

struct AtlasRequest {
    MapAxes axes;
    InterpolationError interpolation;
    LightmapOptions map;
    std::string version;
    std::function<void(double)> progress;  // share of the bins
    WorkShare share{};                     // of the bins that are computed: to its own folder
};

// Throws InputError, which names pose and strobe, unless every bin holds all lamps over the floor.
void require_over_floor(const Rig& rig, const MapAxes& axes);

// Returns how many bins it computed; the others were there, or are of another share. Exports of an
// earlier run go. Of all bins, takes those that shares left below the folder.
std::size_t write_atlas(const std::filesystem::path& folder,
                        const Rig& rig,
                        const AtlasRequest& request);

// As atlas.json has it.
[[nodiscard]] nlohmann::ordered_json interpolation_json(const InterpolationError& error);

// name stands in messages. Throws InputError when the text is no atlas.json.
[[nodiscard]] AtlasManifest parse_atlas(std::string_view text, const std::string& name);

// Writes them into the manifest of an atlas that is there.
void note_exports(const std::filesystem::path& folder, const AtlasExports& exports);

[[nodiscard]] bool is_atlas(const std::filesystem::path& folder);

// An atlas that is there. Throws InputError when the folder holds none, or one that is not whole.
class Atlas {
  public:
    explicit Atlas(const std::filesystem::path& folder);

    [[nodiscard]] const AtlasManifest& manifest() const { return manifest_; }

    // Throws InputError outside the axes. It keeps the bins that it read last.
    [[nodiscard]] Lightmap map(const MapPoint& point);

  private:
    void load(std::size_t bin);

    std::filesystem::path folder_;
    AtlasManifest manifest_;
    std::vector<MapPoint> points_;
    std::map<std::size_t, Lightmap> read_;
};

}  // namespace aphotic
