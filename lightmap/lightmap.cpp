// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/lightmap.h"

#include "base/error.h"
#include "base/offered.h"
#include "image/image_size.h"
#include "light/dispersion.h"
#include "light/floor_image.h"
#include "rig/camera/vignetting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace aphotic {
namespace {

void require_bare_floor(const Rig& rig) {
    constexpr auto kAllowed = "allowed: the bare floor, since a lightmap shows nothing else";
    if (!rig.objects.empty()) {
        throw InputError("found the object '{}'; {}", rig.objects.front().name, kAllowed);
    }
    if (!rig.scene.empty()) {
        throw InputError("found the scene {}; {}", rig.scene.string(), kAllowed);
    }
}

// Maps are floats. The factors of a strobe's light stay below the largest float with room for close
// light, and above the least with room for dark light.
void require_float_scale(const Rig& rig) {
    constexpr double kLeast = 1e-28;
    constexpr double kMost = 1e28;
    const auto fits = [&](double x) { return x == 0.0 || (x >= kLeast && x <= kMost); };
    const Camera& camera = rig.camera;
    for (const Strobe& strobe : rig.strobes) {
        if (strobe.power == 0.0 || is_dark(strobe.beam)) continue;
        std::vector<const Spectrum*> curves = camera.sensor.curves();
        curves.push_back(&strobe.spectrum);
        curves.push_back(&rig.seafloor.reflectance);
        const std::vector<double> knots_nm = union_of_knots(curves, camera.range);
        const double brightest = strobe.power * most_intensity(strobe.beam);
        for (int c = 0; c < kChannels; ++c) {
            double signal = 0.0;
            for (const double nm : knots_nm) {
                signal = std::max(signal,
                                  strobe.spectrum.at(nm) * rig.seafloor.reflectance.at(nm) *
                                      camera.sensor.response(c, nm));
            }
            if (signal == 0.0 || (fits(signal) && fits(brightest) && fits(signal * brightest)))
                continue;
            throw InputError(fmt::format(
                "strobe '{}', {}: found up to {:.3g} of lamp spectrum times reflectance times "
                "response, and {:.3g} of power times beam; allowed: each, and their product, from "
                "{:g} to {:g}, since maps hold 32-bit floats",
                strobe.name,
                kChannelNames.at(static_cast<std::size_t>(c)),
                signal,
                brightest,
                kLeast,
                kMost));
        }
    }
}

// Whether light is almost gone from the shortest path to the longest, by loss and by spreading.
bool ends_in_darkness(const Water& water, const PathRange& paths) {
    const double K_per_m = water.least_attenuation_per_m();
    constexpr double kRounding = 1.1;
    return std::exp(-K_per_m * (paths.longest_m - paths.shortest_m)) *
               std::pow(paths.shortest_m / paths.longest_m, 3) <=
           kRounding * kDarkShare;
}

}  // namespace

unsigned map_veil_points(const Rig& rig, const LightmapOptions& options) {
    constexpr double kShare = 0.1;
    return veil_points(rig, kShare * options.veil_tolerance);
}

std::vector<float> signal_of(const Lightmap& map) {
    std::vector<float> signal = map.samples;
    for (std::size_t i = 0; i < map.veil.size(); ++i) signal[i] += map.veil[i];
    return signal;
}

void put(const StrobePlace& place, Strobe& strobe) {
    strobe.position_m = place.position_m;
    strobe.axis = place.axis;
    strobe.power = place.power;
}

VeilShare veil_share_of(const Lightmap& map) {
    VeilShare share{};
    if (map.veil.empty()) return share;
    const std::size_t plane = map.samples.size() / kChannels;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const std::size_t i = c * plane + middle_pixel(map.width_px, map.height_px);
        const double veil = map.veil[i];
        share[c] = veil_share(veil, veil + map.samples[i]);
    }
    return share;
}

PathRange paths_of(const Rig& rig, const std::vector<Sled>& sleds) {
    constexpr double kRoom = 1.02;
    PathRange all{.shortest_m = std::numeric_limits<double>::infinity()};
    for (const Sled& sled : sleds) {
        Rig flown = rig;
        flown.sled = sled;
        const PathRange paths = path_range(flown);
        if (paths.longest_m == 0.0) continue;
        all.shortest_m = std::min(all.shortest_m, paths.shortest_m / kRoom);
        all.longest_m = std::max(all.longest_m, paths.longest_m * kRoom);
        all.has_horizon |= paths.has_horizon;
    }
    return all.longest_m > 0.0 ? all : PathRange{};
}

MapPromise map_promise(const Rig& rig, const LightmapOptions& options) {
    constexpr double kRounding = 12.0 * 0x1p-24;
    constexpr double kVignettingRounding = 2.0 * 0x1p-24;  // of the factor and of the product
    constexpr double kOverTheIndex = 1e-4;
    const bool has_port = disperses(rig);
    const bool has_veil = rig.water.scatters() && options.has_veil;
    const double off_the_veil =
        has_veil ? options.veil_tolerance + veil_error(rig, map_veil_points(rig, options)) : 0.0;
    const double off_the_lens = rig.camera.vignetting ? kVignettingRounding : 0.0;
    return {.error = options.error + kRounding + off_the_lens + kTileError +
                     (has_port ? kOverTheIndex : 0.0) + off_the_veil,
            .is_bounded = !has_port && !has_veil,
            .has_veil = has_veil,
            .is_of_lamp_grids = std::ranges::any_of(
                rig.strobes, [](const Strobe& strobe) { return strobe.emitter.has_value(); })};
}

LightmapMaker::LightmapMaker(const Rig& rig,
                             const std::optional<PathRange>& paths,
                             const LightmapOptions& options)
    : rig_(rig), options_(options), rays_(rig, options.threads) {
    require_bare_floor(rig);
    require_float_scale(rig);
    direct_ = paths ? *paths : path_range(rig);
    paths_ = direct_;
    // The rig's own paths end where the floor ends, or where its light ends.
    if (!paths || ends_in_darkness(rig.water, paths_)) paths_.has_horizon = true;
    if (rig.camera.vignetting) vignetting_ = vignetting_plane(rig.camera);
    table_ = signal_table(rig_, paths_, options_.error);
    if (options.has_veil) veil_points_ = map_veil_points(rig, options);
    make_veil();
}

void LightmapMaker::make_veil() {
    if (!rig_.water.scatters() || !options_.has_veil) return;
    veil_ = std::make_shared<VeilMap>(
        rig_,
        PathRange{.shortest_m = direct_.shortest_m,
                  .longest_m = direct_.longest_m,
                  .has_horizon = direct_.has_horizon || ends_in_darkness(rig_.water, direct_)},
        options_.error,
        veil_points_);
}

void LightmapMaker::place(const std::vector<StrobePlace>& by_strobe) {
    for (std::size_t s = 0; s < by_strobe.size(); ++s) put(by_strobe[s], rig_.strobes[s]);
    make_veil();
}

void LightmapMaker::require_served(const Sled& sled, bool is_before, bool is_beyond) const {
    if (!is_before && (!is_beyond || paths_.has_horizon)) return;
    throw InputError(
        fmt::format("{}: the image sees paths {} than the tables cover; allowed: from {} to {} m",
                    in_words(sled),
                    is_before ? "shorter" : "longer",
                    at_least(paths_.shortest_m, 6),
                    at_most(paths_.longest_m, 6)));
}

Lightmap LightmapMaker::map(const Sled& sled) const {
    Lightmap map;
    map_into(sled, map);
    return map;
}

void LightmapMaker::map_into(const Sled& sled, Lightmap& map) const {
    rows_into(sled, 0, rig_.camera.height_px, map);
}

void LightmapMaker::take_off_vignetting(int first_row, int count, std::vector<float>& all) const {
    if (vignetting_.empty()) return;
    const std::size_t size = size_of(rig_.camera.width_px) * size_of(count);
    const float* const V = &vignetting_[size_of(first_row) * size_of(rig_.camera.width_px)];
    for (std::size_t i = 0; i < all.size(); ++i) all[i] *= V[i % size];
}

void LightmapMaker::rows_into(const Sled& sled, int first_row, int count, Lightmap& map) const {
    map.width_px = rig_.camera.width_px;
    map.height_px = count;
    map.samples.resize(kChannels * size_of(map.width_px) * size_of(count));
    map.veil.resize(veil_ ? map.samples.size() : 0);
    ImageRows rows{.width_px = map.width_px,
                   .height_px = rig_.camera.height_px,
                   .first = first_row,
                   .count = count,
                   .samples = map.samples.data()};
    const FloorLight light(rig_, sled, table_, rays_);
    const Outside outside = paint_floor(light, options_.threads, rows);
    require_served(sled, outside.is_before, outside.is_beyond);
    if (veil_) {
        rows.samples = map.veil.data();
        veil_->paint(sled, rays_, &light, options_.veil_tolerance, options_.threads, rows);
    }
    take_off_vignetting(first_row, count, map.samples);
    take_off_vignetting(first_row, count, map.veil);
}

}  // namespace aphotic
