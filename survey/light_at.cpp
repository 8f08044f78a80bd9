// SPDX-License-Identifier: BSD-3-Clause
#include "survey/light_at.h"

#include "base/degrees.h"
#include "base/error.h"
#include "base/sha256.h"
#include "image/exr.h"
#include "lightmap/cone_edge.h"
#include "lightmap/design.h"
#include "lightmap/planes.h"
#include "spectral/light_family.h"
#include "survey/survey_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <type_traits>

namespace aphotic {
namespace {

struct RigLight {
    ConeEdges edges;
    LightmapMaker maker;
};

using MapAsRadians = std::function<std::optional<Lightmap>(const Sled& sled)>;

MapAsRadians map_as_radians(const Rig& rig,
                            const std::optional<Navigation>& navigation,
                            std::vector<Sled> sleds,
                            const LightmapOptions& options) {
    const auto is_small = [](double tilt_rad) {
        return std::abs(tilt_rad) <= kSmall_deg * kRadiansPerDegree;
    };
    if (!navigation) return {};
    const auto in_radians = [given = navigation->given()](Sled sled) {
        if (given.pitch) sled.pitch_rad /= kRadiansPerDegree;
        if (given.roll) sled.roll_rad /= kRadiansPerDegree;
        return sled;
    };
    bool is_level = true;
    for (Sled& sled : sleds) {
        if (navigation->given().pitch && !is_small(sled.pitch_rad)) return {};
        if (navigation->given().roll && !is_small(sled.roll_rad)) return {};
        const Sled other = in_radians(sled);
        if (other.pitch_rad != sled.pitch_rad || other.roll_rad != sled.roll_rad) is_level = false;
        sled = other;
    }
    if (is_level) return {};
    try {
        // A separate maker, so that the maps of a sled this steady stay unchanged.
        const auto maker =
            std::make_shared<const LightmapMaker>(rig, paths_of_survey(rig, sleds), options);
        return [maker, in_radians](const Sled& sled) -> std::optional<Lightmap> {
            try {
                return maker->map(in_radians(sled));
            } catch (const InputError&) {
                return std::nullopt;
            }
        };
    } catch (const InputError&) {
        return {};
    }
}

// Independent of the curves' source and names.
std::string response_digest(const Sensor& sensor) {
    std::string text;
    const std::vector<const Spectrum*> curves = sensor.curves();
    for (const double lambda_nm : union_of_knots(curves, sensor.range())) {
        text += fmt::format("{}", lambda_nm);
        for (int c = 0; c < kChannels; ++c)
            text += fmt::format(" {}", sensor.response(c, lambda_nm));
        text += '\n';
    }
    return sha256_of_text(text);
}

void require_map_for(PlaneSize images, const ExrReader& map, const std::filesystem::path& file) {
    constexpr std::int64_t kFew = std::int64_t{1} << 24U;  // more pixels than images have
    const std::int64_t pixels = std::int64_t{map.width_px()} * map.height_px();
    if (pixels <= std::int64_t{images.width_px} * images.height_px + kFew) return;
    throw InputError("{}: found {} x {} pixels; allowed: {} x {}, like the images",
                     file.string(),
                     map.width_px(),
                     map.height_px(),
                     images.width_px,
                     images.height_px);
}

// Down and back.
double path_of_own_altitude(const Rig& rig) {
    return 2.0 * rig.sled.altitude_m;
}

// The light of all lamps, relative, after this path through the water.
std::function<double(double)> light_after(const Rig& rig, double path_m) {
    return [&rig, path_m](double lambda_nm) {
        double flux = 0.0;
        for (const Strobe& strobe : rig.strobes) {
            flux += strobe.power * strobe.spectrum.at(lambda_nm);
        }
        return flux * std::exp(-path_m * rig.water.attenuation_per_m(lambda_nm));
    };
}

constexpr int kCoarse_px = 4 * kCells;  // along the longer side
constexpr double kCoarseError = 1e-3;
constexpr double kCoarseVeil = 1e-2;

// A maker of maps for each subset of the strobes, created on first use by make(rig with these).
template <typename Make>
auto makers_of_lit(const Rig& rig, const Make& make) {
    using Maker = std::invoke_result_t<Make, const Rig&>;
    struct Made {
        std::mutex mutex;
        std::map<std::uint64_t, Maker> makers;
    };
    return [made = std::make_shared<Made>(), rig, make](std::uint64_t out) {
        const std::scoped_lock lock(made->mutex);
        Maker& maker = made->makers[out];
        if (maker) return maker;
        Rig lit = rig;
        lit.strobes.clear();
        for (std::size_t s = 0; s < rig.strobes.size(); ++s)
            if ((out >> s & 1U) == 0) lit.strobes.push_back(rig.strobes[s]);
        return maker = make(lit);
    };
}

using ReliefMakers = std::vector<std::unique_ptr<const ReliefMapMaker>>;

void add_relief(const Rig& rig,
                const std::vector<RigPart>& parts,
                const LightmapOptions& coarse,
                const LightmapOptions& options,
                StrobesAt& at) {
    const auto makers = std::make_shared<ReliefMakers>();
    for (const RigPart& part : parts)
        makers->push_back(std::make_unique<const ReliefMapMaker>(part.rig, coarse));
    const Camera& camera = parts.front().rig.camera;
    at.relief_cells =
        [makers,
         width_px = camera.width_px,
         height_px = camera.height_px,
         side = cells_across(rig.camera.width_px, rig.camera.height_px)](
            const DepthMap& map, const DepthMaps& as, const std::optional<Sled>& floor) {
            const FloorRelief relief = floor_relief(
                resized(map, width_px, height_px), as.is, as.normals, *makers->front(), floor);
            std::vector<CellPlane> cells;
            for (const auto& maker : *makers)
                cells.push_back(cells_of(maker->map(relief.relief, 0).map, side));
            return cells;
        };
    at.relief_without = makers_of_lit(rig, [options](const Rig& lit) {
        return std::make_shared<const ReliefMapMaker>(lit, options);
    });
}

}  // namespace

std::vector<Sled> sleds_of(const std::optional<Navigation>& navigation,
                           const std::vector<ImageFile>& files) {
    std::vector<Sled> sleds;
    for (const ImageFile& file : files) {
        if (!navigation) break;
        try {
            sleds.push_back(navigation->pose_of(file.source).sled);
        } catch (const InputError&) {
            // The image is reported when its turn comes.
        }
    }
    return sleds;
}

PathRange paths_of_survey(const Rig& rig, const std::vector<Sled>& sleds) {
    return sleds.empty() ? PathRange{} : paths_of(rig, corners_of(sleds));
}

LightAt light_of_rig(const Rig& rig,
                     const std::optional<Navigation>& navigation,
                     const std::vector<ImageFile>& files,
                     bool has_veil,
                     double veil_tolerance,
                     bool has_relief) {
    const std::vector<Sled> sleds = sleds_of(navigation, files);
    const LightmapOptions options{.has_veil = has_veil, .veil_tolerance = veil_tolerance};
    const bool scatters = rig.water.scatters();
    const auto light = std::make_shared<const RigLight>(
        RigLight{.edges = ConeEdges(rig),
                 .maker = LightmapMaker(rig, paths_of_survey(rig, sleds), options)});
    return {.title = rig.title,
            .toml = rig.toml,
            .digest = rig.digest,
            .camera_digest = response_digest(rig.camera.sensor),
            .rig_altitude_m = rig.sled.altitude_m,
            .size = {rig.camera.width_px, rig.camera.height_px},
            .is_grey = rig.camera.sensor.is_mono(),
            .has_veil = scatters ? std::optional(has_veil) : std::nullopt,
            .veil_tolerance = scatters && has_veil ? std::optional(veil_tolerance) : std::nullopt,
            .map = [light](const Sled& sled) { return light->maker.map(sled); },
            .edges = [light](const Sled& sled,
                             int within_px) { return light->edges.mask(sled, within_px); },
            .relief = has_relief ? std::make_shared<const ReliefMapMaker>(rig, options) : nullptr,
            .map_as_radians =
                has_relief ? MapAsRadians() : map_as_radians(rig, navigation, sleds, options),
            .to_srgb = rig.camera.sensor.is_mono() ? std::function<CameraToSrgb()>()
                                                   : [rig] { return camera_to_srgb(rig); },
            .floor_colour = floor_colour(rig),
            .floor_colour_in_water = floor_colour(rig, path_of_own_altitude(rig))};
}

StrobesAt strobes_of_rig(const Rig& rig,
                         const std::optional<Navigation>& navigation,
                         const std::vector<ImageFile>& files,
                         bool has_veil,
                         double veil_tolerance,
                         bool has_relief) {
    if (rig.strobes.size() > kMostStrobes) return {};
    const PathRange paths = paths_of_survey(rig, sleds_of(navigation, files));
    const Rig coarse = with_longer_side(rig, kCoarse_px);
    const auto makers = std::make_shared<std::vector<LightmapMaker>>();
    StrobesAt at;
    const std::vector<RigPart> parts = parts_by_strobe(coarse);
    const LightmapOptions as_coarse{
        .error = kCoarseError, .has_veil = has_veil, .veil_tolerance = kCoarseVeil};
    for (const RigPart& part : parts) {
        at.names.push_back(part.name);
        makers->emplace_back(part.rig, paths, as_coarse);
    }
    at.cells = [makers,
                side = cells_across(rig.camera.width_px, rig.camera.height_px)](const Sled& sled) {
        std::vector<CellPlane> cells;
        for (const LightmapMaker& maker : *makers) cells.push_back(cells_of(maker.map(sled), side));
        return cells;
    };
    const LightmapOptions options{.has_veil = has_veil, .veil_tolerance = veil_tolerance};
    at.map_without = [lit = makers_of_lit(rig, [paths, options](const Rig& of) {
                          return std::make_shared<const LightmapMaker>(of, paths, options);
                      })](const Sled& sled, std::uint64_t out) { return lit(out)->map(sled); };
    if (has_relief) add_relief(rig, parts, as_coarse, options, at);
    return at;
}

void require_light_for(const RawImage& raw, const LightAt& light) {
    require_size(raw, light.size.width_px, light.size.height_px, "like the map");
    if (raw.mosaic != Mosaic::Mono || light.is_grey) return;
    throw InputError(
        "found a mono camera's image, and a map whose R, G and B differ; allowed: a mono camera's "
        "map");
}

LightAt light_of_map(const std::filesystem::path& map_file,
                     bool has_veil,
                     std::optional<PlaneSize> images) {
    static const std::vector<std::string> kNames{"R", "G", "B"};
    static const std::vector<std::string> kVeilNames{"veil.R", "veil.G", "veil.B"};
    Lightmap map;
    bool knows_veil = false;
    from_named_exr(map_file, [&](ExrReader& reader) {
        if (images) require_map_for(*images, reader, map_file);
        const std::vector<std::string> channels = reader.channels();
        for (const std::string& name : kNames) {
            if (std::ranges::find(channels, name) != channels.end()) continue;
            throw InputError("{}: has no channel {}; needed: R, G, B", map_file.string(), name);
        }
        map = {reader.width_px(), reader.height_px(), reader.planes(kNames)};
        knows_veil = std::ranges::all_of(kVeilNames, [&](const std::string& name) {
            return std::ranges::find(channels, name) != channels.end();
        });
        if (knows_veil && has_veil) map.veil = reader.planes(kVeilNames);
    });
    for (std::vector<float>* samples : {&map.samples, &map.veil}) {
        for (float& sample : *samples) {
            if (!std::isfinite(sample) || sample < 0.0F) sample = 0.0F;
        }
    }
    const auto pixels = map.samples.size() / kNames.size();
    const std::span<const float> all(map.samples);
    const bool is_grey = std::ranges::equal(all.first(2 * pixels), all.last(2 * pixels));
    return {.digest = sha256_of_file(map_file),
            .size = {map.width_px, map.height_px},
            .is_grey = is_grey,
            .has_veil = knows_veil ? std::optional(has_veil) : std::nullopt,
            .map = [map](const Sled&) { return map; },
            .edges = [pixels](const Sled&, int) { return std::vector<std::uint8_t>(pixels); }};
}

PerChannel floor_colour(const Rig& rig, double path_m) {
    constexpr double kError = 1e-6;
    LightFamily family{.water = rig.water, .shortest_path_m = path_m, .longest_path_m = path_m};
    for (const Strobe& strobe : rig.strobes) {
        family.sources.push_back({strobe.spectrum});
        family.sources.push_back({strobe.spectrum, rig.seafloor.reflectance});
    }
    const auto light = light_after(rig, path_m);
    PerChannel of_floor{};
    PerChannel of_white{};
    for (const WeightedWavelength& w :
         reference_grid(rig.camera.sensor, family, rig.camera.range, kError)) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            const double seen = light(w.lambda_nm) * w.weight[c];
            of_white[c] += seen;
            of_floor[c] += seen * rig.seafloor.reflectance.at(w.lambda_nm);
        }
    }
    for (std::size_t c = 0; c < kChannels; ++c)
        of_floor[c] = of_white[c] > 0.0 ? of_floor[c] / of_white[c] : 0.0;
    return of_floor;
}

CameraToSrgb camera_to_srgb(const Rig& rig) {
    return camera_to_srgb(
        rig.camera.sensor, rig.camera.range, light_after(rig, path_of_own_altitude(rig)));
}

}  // namespace aphotic
