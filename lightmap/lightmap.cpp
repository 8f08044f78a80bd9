// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/lightmap.h"

#include "base/degrees.h"
#include "base/error.h"
#include "base/offered.h"
#include "base/parallel.h"
#include "image/camera_image.h"
#include "light/index_nodes.h"
#include "lightmap/dispersed_light.h"
#include "lightmap/row_light.h"
#include "rig/geometry.h"
#include "spectral/light_family.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <random>
#include <span>
#include <utility>

namespace aphotic {
namespace {

using Eigen::ArrayXd;

// Shares of the error that is asked for: the rest is dispersion's.
constexpr double kGridShare = 0.1;
constexpr double kTableShare = 0.5;
// What has a ray for each wavelength changes faster over them than light that keeps its path.
constexpr double kDispersedShare = 1e-4;

void require_bare_floor(const Rig& rig) {
    constexpr auto kAllowed = "allowed: the bare floor, which is all that a lightmap is of";
    if (!rig.objects.empty()) {
        throw InputError("found the object '{}'; {}", rig.objects.front().name, kAllowed);
    }
    if (!rig.scene.empty()) {
        throw InputError("found the scene {}; {}", rig.scene.string(), kAllowed);
    }
}

// Maps are of floats. What a strobe's light is made of has room below the largest float for what
// is close, and above the least for what is dark.
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
                "{:g} to {:g}, for maps are of 32-bit floats",
                strobe.name,
                kChannelNames.at(static_cast<std::size_t>(c)),
                signal,
                brightest,
                kLeast,
                kMost));
        }
    }
}

// Each strobe's lamp spectrum: the first strobe that has it.
std::vector<std::size_t> lamps_by_strobe(const Rig& rig) {
    std::vector<std::size_t> lamps;
    for (const Strobe& strobe : rig.strobes) {
        std::size_t first = 0;
        while (!is_same_curve(rig.strobes[first].spectrum, strobe.spectrum)) ++first;
        lamps.push_back(first);
    }
    return lamps;
}

SpectralSum spectral_sum(const Rig& rig,
                         const std::vector<WeightedWavelength>& grid,
                         const std::function<double(double)>& light) {
    const auto count = static_cast<Eigen::Index>(grid.size());
    SpectralSum sum{.K_per_m = ArrayXd(count), .weights = Eigen::ArrayXXd(count, kChannels)};
    for (Eigen::Index i = 0; i < count; ++i) {
        const WeightedWavelength& node = grid[static_cast<std::size_t>(i)];
        sum.K_per_m(i) = rig.water.attenuation_per_m(node.lambda_nm);
        const double value = light(node.lambda_nm);
        for (Eigen::Index c = 0; c < kChannels; ++c) {
            sum.weights(i, c) = node.weight[static_cast<std::size_t>(c)] * value;
        }
    }
    return sum;
}

// Of the grid, what any channel sees.
std::vector<WeightedWavelength> seen_of(const std::vector<WeightedWavelength>& grid) {
    std::vector<WeightedWavelength> seen;
    std::ranges::copy_if(grid, std::back_inserter(seen), [](const WeightedWavelength& node) {
        return std::ranges::any_of(node.weight, [](double weight) { return weight != 0.0; });
    });
    return seen;
}

// As in clear water: of what a signal counts, little is attenuated so much that it asks for more.
LampGrid grid_of_lamps(const Rig& rig, const Strobe& strobe) {
    constexpr double kMostLamps = 1e5;  // a map adds up the lamps pixel by pixel
    const LampGrid grid = lamp_grid(rig, strobe, 0.0);
    if (static_cast<double>(grid.across) * grid.along > kMostLamps) {
        throw InputError(
            "strobe '{}': found an emitter that takes {} x {} lamps so low over the "
            "floor; allowed: up to {} of them",
            strobe.name,
            grid.across,
            grid.along,
            kMostLamps);
    }
    return grid;
}

std::string in_words(const Sled& sled) {
    return fmt::format("altitude {:.6g} m, pitch {:.6g}, roll {:.6g} degrees",
                       sled.altitude_m,
                       sled.pitch_rad * kDegreesPerRadian,
                       sled.roll_rad * kDegreesPerRadian);
}

std::vector<LampTerms> lamps_of(const Rig& rig, const Strobe& strobe, const Plane& floor) {
    const auto positions_m = lamp_positions_m(strobe, grid_of_lamps(rig, strobe));
    const double share =
        strobe.power / (std::numbers::pi * static_cast<double>(positions_m.size()));
    LampTerms terms{.position_m = strobe.position_m,
                    .frame = turned_frame(strobe.beam, strobe.axis),
                    .height_m = 0.0,
                    .light = std::make_shared<BeamLight>(beam_light(strobe.beam, share)),
                    .phong = rig.seafloor.phong,
                    .phong_size = rig.seafloor.phong_size};
    std::vector<LampTerms> lamps;
    for (const Eigen::Vector3d& position_m : positions_m) {
        terms.position_m = position_m;
        terms.height_m = height_above(floor, position_m);
        lamps.push_back(terms);
    }
    return lamps;
}

void store(const SumBlock& sums, int row, int first_column, Lightmap& map) {
    const auto width = static_cast<std::size_t>(map.width_px);
    const std::size_t plane = width * static_cast<std::size_t>(map.height_px);
    const auto first = static_cast<std::size_t>(first_column);
    const std::size_t count = std::min<std::size_t>(kRowBlock, width - first);
    for (std::size_t c = 0; c < kChannels; ++c) {
        std::copy_n(sums[c].begin(),
                    count,
                    &map.samples[c * plane + static_cast<std::size_t>(row) * width + first]);
    }
}

// One lamp, and which tables serve it.
struct PlacedLamp {
    LampTerms terms;
    std::size_t strobe;
    std::size_t spectrum;
    std::shared_ptr<const std::vector<Crease>> steep;  // behind a port
};

using FitBlock = std::array<bool, kSampledBlocks>;

// Factors of one kind, the floor's or the highlight's, of one lamp at the nodes.
struct FactorBlock {
    std::array<RowBlock<float>, kIndexNodes> at_nodes;
    RowBlock<float> doubt;
};

// Of one thread.
struct Workspace {
    std::array<RayBlock, kLookOrder.size()> rays;
    RayNodes nodes;                             // of pixels in doubt
    std::array<DirectionBlock, kIndexNodes> V;  // of the last lamp at the nodes
    LampBlock lit;
    FactorBlock diffuse;
    FactorBlock highlight;
    SumBlock sums;
    SumBlock doubts;            // of the sums
    std::vector<int> in_doubt;  // columns of the row
    TotalBlock totals;          // of many lamps, whose floats would not do
    SumBlock sampled;           // of kSampledBlocks
    FitBlock may_fit;           // which of them
    Outside outside;
};

// As many as the promise's sum of a dozen floats has.
constexpr std::size_t kLampsInFloats = 8;

void move_to_totals(Workspace& work) {
    for (std::size_t c = 0; c < kChannels; ++c) {
        for (std::size_t i = 0; i < kBlockCount; ++i) {
            work.totals[c][i] += static_cast<double>(work.sums[c][i]);
        }
        work.sums[c].fill(0.0F);
    }
}

bool is_in_doubt(const Workspace& work, std::size_t pixel) {
    bool is = false;
    for (std::size_t c = 0; c < kChannels; ++c)
        is |= work.doubts[c][pixel] > kMostDoubt * work.sums[c][pixel];
    return is;
}

Lightmap rows_of(const Lightmap& map, int first_row, int count) {
    const auto some = [&](const std::vector<float>& all) {
        const auto width = static_cast<std::size_t>(map.width_px);
        const auto height = static_cast<std::size_t>(map.height_px);
        const std::size_t size = width * static_cast<std::size_t>(count);
        std::vector<float> samples(kChannels * size);
        for (std::size_t c = 0; c < kChannels; ++c) {
            const float* const from =
                &all[(c * height + static_cast<std::size_t>(first_row)) * width];
            std::copy_n(from, size, &samples[c * size]);
        }
        return samples;
    };
    return {.width_px = map.width_px,
            .height_px = count,
            .samples = some(map.samples),
            .veil = some(map.veil)};
}

std::size_t block_of(int column) {
    return static_cast<std::size_t>(column / kRowBlock);
}

// The middle index first, for it tells where the beams end.
std::vector<std::size_t> node_order(std::size_t nodes) {
    if (nodes == 1) return {0};
    return {nodes / 2, 0, nodes - 1};
}

// Light that has gone from the shortest path to the longest, and as wide, is all but gone.
bool ends_in_darkness(const Water& water, const PathRange& paths) {
    const double K_per_m = water.least_attenuation_per_m();
    constexpr double kRounding = 1.1;
    return std::exp(-K_per_m * (paths.longest_m - paths.shortest_m)) *
               std::pow(paths.shortest_m / paths.longest_m, 3) <=
           kRounding * kDarkShare;
}

}  // namespace

struct LightmapMaker::Scene {
    std::vector<std::size_t> nodes;  // of the index, the middle one first
    std::vector<RayTerms> rays;      // in their order, and those between
    std::vector<PlacedLamp> lamps;
    std::vector<ColumnBlock> blocks;   // of a row
    std::vector<ColumnBlock> samples;  // of its blocks; none where they are not worth it
};

std::vector<float> signal_of(const Lightmap& map) {
    std::vector<float> signal = map.samples;
    for (std::size_t i = 0; i < map.veil.size(); ++i) signal[i] += map.veil[i];
    return signal;
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

void require_over_floor(const Rig& rig, const Sled& sled) {
    Rig flown = rig;
    flown.sled = sled;
    try {
        for (const Strobe& strobe : flown.strobes) {
            require_over_floor(sled, strobe, {});  // else no number of lamps would do
            require_over_floor(sled, strobe, grid_of_lamps(flown, strobe));
        }
    } catch (const InputError& error) {
        throw InputError("{}: {}", in_words(sled), error.what());
    }
}

MapPromise map_promise(const Rig& rig, const LightmapOptions& options) {
    constexpr double kRounding = 12.0 * 0x1p-24;
    constexpr double kVignettingRounding = 2.0 * 0x1p-24;  // of the factor and of the product
    constexpr double kOverTheIndex = 1e-4;
    const bool has_port = rig.camera.port.has_value();
    const bool is_fitted = std::ranges::all_of(
        rig.strobes, [](const Strobe& strobe) { return is_smooth_between(beam_edges(strobe)); });
    const bool has_veil = rig.water.scatters() && options.has_veil;
    const double off_the_veil = has_veil ? kVeilOfSignal + veil_error(rig, kVeilMapPoints) : 0.0;
    const double off_the_lens = rig.camera.vignetting ? kVignettingRounding : 0.0;
    return {.error = options.error + kRounding + off_the_lens + (is_fitted ? kRowFitError : 0.0) +
                     (has_port ? kOverTheIndex : 0.0) + off_the_veil,
            .is_bounded = !has_port && !has_veil,
            .has_veil = has_veil,
            .is_of_lamp_grids = std::ranges::any_of(
                rig.strobes, [](const Strobe& strobe) { return strobe.emitter.has_value(); })};
}

LightmapMaker::LightmapMaker(const Rig& rig,
                             const std::optional<PathRange>& paths,
                             const LightmapOptions& options)
    : rig_(rig), options_(options), spectrum_of_strobe_(lamps_by_strobe(rig)) {
    require_bare_floor(rig);
    require_float_scale(rig);
    for (const Strobe& strobe : rig.strobes) edges_.push_back(beam_edges(strobe));
    direct_ = paths ? *paths : path_range(rig);
    paths_ = direct_;
    // The rig's own end where the floor does, or else where its light does.
    if (!paths || ends_in_darkness(rig.water, paths_)) paths_.has_horizon = true;
    if (rig.camera.vignetting) vignetting_ = vignetting_plane(rig.camera);
    index_nodes_nm_ = index_nodes_nm(rig_);
    ray_nodes_nm_ = rig_.camera.port ? index_nodes_nm(rig_, kLookOrder.size()) : index_nodes_nm_;
    if (rig_.camera.port) dispersed_nodes_nm_ = index_nodes_nm(rig_, kRayNodes);
    for (const double nm : ray_nodes_nm_)
        ray_tables_.push_back(ray_table(rig_, nm, options_.threads));
    if (paths_.longest_m > 0.0) tabulate();
    make_veil();
}

void LightmapMaker::make_veil() {
    if (!rig_.water.scatters() || !options_.has_veil) return;
    veil_ = std::make_shared<VeilMap>(
        rig_,
        PathRange{.shortest_m = direct_.shortest_m,
                  .longest_m = direct_.longest_m,
                  .has_horizon = direct_.has_horizon || ends_in_darkness(rig_.water, direct_)},
        options_.error);
}

void LightmapMaker::place(const std::vector<StrobePlace>& by_strobe) {
    for (std::size_t s = 0; s < by_strobe.size(); ++s) {
        Strobe& strobe = rig_.strobes[s];
        strobe.position_m = by_strobe[s].position_m;
        strobe.axis = by_strobe[s].axis;
        strobe.power = by_strobe[s].power;
        edges_[s] = beam_edges(strobe);
    }
    make_veil();
}

void LightmapMaker::tabulate() {
    const bool has_highlight = rig_.seafloor.phong > 0.0;
    const Spectrum& floor = rig_.seafloor.reflectance;
    LightFamily family{.sources = {},
                       .water = rig_.water,
                       .shortest_path_m = paths_.shortest_m,
                       .longest_path_m = paths_.longest_m};
    for (const Strobe& strobe : rig_.strobes) {
        family.sources.push_back({strobe.spectrum, floor});
        if (has_highlight) family.sources.push_back({strobe.spectrum});
    }
    const auto grid_of = [&](double error) {
        return reference_grid(rig_.camera.sensor, family, rig_.camera.range, error);
    };
    const auto grid = grid_of(kGridShare * options_.error);
    grid_size_ = grid.size();
    std::vector<WeightedWavelength> dispersed;
    if (rig_.camera.port) dispersed = seen_of(grid_of(kDispersedShare * options_.error));
    if (rig_.camera.port) {
        for (const WeightedWavelength& node : dispersed) {
            shares_.emplace_back();
            for (std::size_t j = 0; j < kRayNodes; ++j) {
                shares_.back().push_back(index_share(rig_, dispersed_nodes_nm_, j, node.lambda_nm));
            }
        }
    }

    // Lagrange's polynomials of three even points sum, in size, to 5/4 at most.
    constexpr double kLebesgue = 5.0 / 4.0;
    const double table_error = kTableShare * options_.error / (rig_.camera.port ? kLebesgue : 1.0);
    steps_ = {};
    std::vector<std::function<double(double)>> kinds;
    const auto take_in = [&](const std::function<double(double)>& light) {
        const PathSteps steps = path_steps(spectral_sum(rig_, grid, light), paths_, table_error);
        if (steps.count > steps_.count) steps_ = steps;
    };
    for (const Strobe& strobe : rig_.strobes) {
        take_in([&](double nm) { return strobe.spectrum.at(nm) * floor.at(nm); });
        if (has_highlight) take_in([&](double nm) { return strobe.spectrum.at(nm); });
    }
    tables_.resize(rig_.strobes.size());
    for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
        if (spectrum_of_strobe_[s] != s) continue;
        tabulate_lamp(rig_.strobes[s].spectrum, grid, dispersed, tables_[s]);
    }
}

void LightmapMaker::tabulate_lamp(const Spectrum& lamp,
                                  const std::vector<WeightedWavelength>& grid,
                                  const std::vector<WeightedWavelength>& dispersed_grid,
                                  LightTables& tables) const {
    const Spectrum& floor = rig_.seafloor.reflectance;
    for (std::size_t j = 0; j < index_nodes_nm_.size(); ++j) {
        const auto bare = [&](double nm) {
            return index_share(rig_, index_nodes_nm_, j, nm) * lamp.at(nm);
        };
        const auto diffuse = [&](double nm) { return bare(nm) * floor.at(nm); };
        tables.diffuse.push_back(path_table(spectral_sum(rig_, grid, diffuse), steps_));
        if (rig_.seafloor.phong == 0.0) continue;
        tables.highlight.push_back(path_table(spectral_sum(rig_, grid, bare), steps_));
    }
    if (!rig_.camera.port) return;
    DispersedSpectrum dispersed;
    dispersed.diffuse =
        spectral_sum(rig_, dispersed_grid, [&](double nm) { return lamp.at(nm) * floor.at(nm); });
    if (rig_.seafloor.phong > 0.0)
        dispersed.highlight =
            spectral_sum(rig_, dispersed_grid, [&](double nm) { return lamp.at(nm); });
    tables.dispersed = std::make_shared<const DispersedSpectrum>(std::move(dispersed));
}

LightmapMaker::Scene LightmapMaker::scene_of(const Sled& sled) const {
    const Plane floor = floor_plane(sled);
    Scene scene{.nodes = node_order(index_nodes_nm_.size()),
                .rays = {},
                .lamps = {},
                .blocks = {},
                .samples = {}};
    for (std::size_t j = 0; j < ray_nodes_nm_.size(); ++j) {
        const std::size_t node = ray_nodes_nm_.size() > 1 ? kLookOrder.at(j) : j;
        scene.rays.push_back(ray_terms(rig_, floor, ray_nodes_nm_[node], ray_tables_[node]));
    }
    const int width_px = rig_.camera.width_px;
    Rig flown = rig_;
    flown.sled = sled;
    require_over_floor(rig_, sled);
    for (std::size_t s = 0; s < rig_.strobes.size() && steps_.count > 0; ++s) {
        std::shared_ptr<const std::vector<Crease>> steep;
        if (rig_.camera.port)
            steep = std::make_shared<std::vector<Crease>>(steep_creases(rig_.strobes[s].beam));
        for (const LampTerms& lamp : lamps_of(flown, rig_.strobes[s], floor)) {
            scene.lamps.push_back(
                {.terms = lamp, .strobe = s, .spectrum = spectrum_of_strobe_[s], .steep = steep});
        }
    }
    // Between samples nothing would tell of a steep kink that dispersion crosses.
    const bool is_sampled =
        width_px >= kRowBlock && std::ranges::all_of(edges_, is_smooth_between) &&
        std::ranges::all_of(
            scene.lamps, [](const PlacedLamp& lamp) { return !lamp.steep || lamp.steep->empty(); });
    for (int block = 0; block * kRowBlock < width_px; ++block) {
        scene.blocks.push_back(neighbours(scene.rays.front(), block * kRowBlock));
        if (is_sampled && static_cast<std::size_t>(block) % kSampledBlocks == 0)
            scene.samples.push_back(samples_of_blocks(scene.rays.front(), block));
    }
    return scene;
}

void LightmapMaker::require_served(const Sled& sled, bool is_before, bool is_beyond) const {
    if (!is_before && (!is_beyond || paths_.has_horizon)) return;
    throw InputError(
        fmt::format("{}: the image sees paths {} "
                    "than the tables serve; allowed: from {} to {} m",
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

void LightmapMaker::rows_into(const Sled& sled, int first_row, int count, Lightmap& map) const {
    if (veil_) {
        const VeilMap::Rows rows = veil_->rows_for({.first = first_row, .count = count});
        if (rows.first != first_row || rows.count != count) {
            Lightmap more;
            rows_into(sled, rows.first, rows.count, more);
            map = rows_of(more, first_row - rows.first, count);
            return;
        }
    }
    map.width_px = rig_.camera.width_px;
    map.height_px = count;
    map.samples.resize(kChannels * static_cast<std::size_t>(map.width_px) *
                       static_cast<std::size_t>(count));
    const Scene scene = scene_of(sled);
    const bool is_dispersed = scene.nodes.size() == kIndexNodes;
    // Of the last lamp added.
    const auto add_doubts = [&](const PlacedLamp& lamp, Workspace& work) {
        const LightTables& tables = tables_[lamp.spectrum];
        work.diffuse.doubt.fill(0.0F);
        work.highlight.doubt.fill(0.0F);
        for (std::size_t h = 0; h < kHalfWay.size(); ++h) {
            const auto take = [&](const RowBlock<float>& found, FactorBlock& factors) {
                take_doubt(factors.at_nodes, kHalfWay.at(h), found, factors.doubt);
            };
            shine(work.rays.at(kIndexNodes + h), lamp.terms, Edges::Kept, work.lit);
            static_cast<void>(weigh(work.rays.at(kIndexNodes + h), lamp.terms, steps_, work.lit));
            take(work.lit.diffuse, work.diffuse);
            if (tables.highlight.empty()) continue;
            weigh_highlight(work.rays.at(kIndexNodes + h), lamp.terms, work.lit);
            take(work.lit.highlight, work.highlight);
        }
        if (!lamp.steep->empty()) {
            RowBlock<float> crosses;
            crosses.fill(0.0F);
            note_crossings(*lamp.steep, work.V, !lamp.terms.light->is_round, crosses);
            for (FactorBlock* factors : {&work.diffuse, &work.highlight}) {
                for (const RowBlock<float>& at_node : factors->at_nodes) {
                    for (std::size_t i = 0; i < kBlockCount; ++i)
                        factors->doubt[i] = std::max(factors->doubt[i], crosses[i] * at_node[i]);
                }
            }
        }
        const auto sum_up = [&](const FactorBlock& factors, const auto& by_node) {
            if (by_node.empty() || !is_in_doubt(factors.doubt, factors.at_nodes[0])) return;
            for (const std::vector<float>& table : by_node)
                look_up(work.lit, factors.doubt, table, work.doubts);
        };
        sum_up(work.diffuse, tables.diffuse);
        sum_up(work.highlight, tables.highlight);
    };
    const auto add_lamp = [&](const PlacedLamp& lamp, Workspace& work) {
        const LightTables& tables = tables_[lamp.spectrum];
        for (std::size_t j = 0; j < scene.nodes.size(); ++j) {
            const RayBlock& rays = work.rays[j];
            shine(rays, lamp.terms, j == 0 ? Edges::Found : Edges::Kept, work.lit);
            const Outside found = weigh(rays, lamp.terms, steps_, work.lit);
            work.outside.before += found.before;
            work.outside.beyond += found.beyond;
            look_up(work.lit, work.lit.diffuse, tables.diffuse[scene.nodes[j]], work.sums);
            work.diffuse.at_nodes[j] = work.lit.diffuse;
            if (is_dispersed && !lamp.steep->empty()) work.V[j] = work.lit.V;
            if (tables.highlight.empty()) continue;
            weigh_highlight(rays, lamp.terms, work.lit);
            look_up(work.lit, work.lit.highlight, tables.highlight[scene.nodes[j]], work.sums);
            work.highlight.at_nodes[j] = work.lit.highlight;
        }
        if (is_dispersed) add_doubts(lamp, work);
    };
    const auto look = [&](int row, const ColumnBlock& columns, Workspace& work) {
        for (std::size_t j = 0; j < scene.rays.size(); ++j) {
            look_along(scene.rays[j], steps_, first_row + row, columns, work.rays[j]);
        }
        for (RowBlock<float>& sum : work.sums) sum.fill(0.0F);
        for (RowBlock<float>& doubt : work.doubts) doubt.fill(0.0F);
        for (RowBlock<double>& total : work.totals) total.fill(0.0);
    };
    const auto add_lamps = [&](Workspace& work, const auto& after_each) {
        for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
            add_lamp(scene.lamps[k], work);
            after_each(scene.lamps[k]);
            const bool is_last = k + 1 == scene.lamps.size();
            if ((k + 1) % kLampsInFloats == 0 && !is_last) move_to_totals(work);
        }
        if (scene.lamps.size() <= kLampsInFloats) return;
        move_to_totals(work);
        for (std::size_t c = 0; c < kChannels; ++c) {
            std::ranges::transform(work.totals[c], work.sums[c].begin(), [](double total) {
                return static_cast<float>(total);
            });
        }
    };
    const auto sample = [&](int row, const ColumnBlock& columns, Workspace& work) {
        const Outside before = work.outside;
        look(row, columns, work);
        work.may_fit.fill(true);
        add_lamps(work, [&](const PlacedLamp& lamp) {
            for (std::size_t b = 0; b < kSampledBlocks; ++b) {
                work.may_fit[b] &=
                    is_between(edges_[lamp.strobe], work.lit.V, b * kFitSamples, kFitSamples);
            }
        });
        // A kink that no sample shows is less than the fit's own error.
        for (std::size_t i = 0; i < kBlockCount; ++i)
            work.may_fit[i / kFitSamples] &= !is_in_doubt(work, i);
        // Said where a pixel of the image is outside, and samples may be beyond it.
        if (work.outside != before) work.may_fit.fill(false);
        work.outside = before;
        work.sampled = work.sums;
    };
    const auto is_fit = [&](std::size_t block, Workspace& work) {
        const std::size_t b = block % kSampledBlocks;
        bool fits = work.may_fit[b];
        for (std::size_t c = 0; c < kChannels && fits; ++c) {
            fits = fit(&work.sampled[c][b * kFitSamples], work.sums[c]);
        }
        return fits;
    };
    const auto note_doubts = [&](const ColumnBlock& columns, Workspace& work) {
        for (int i = 0; i < columns.count && is_dispersed; ++i) {
            const auto pixel = static_cast<std::size_t>(i);
            if (is_in_doubt(work, pixel)) work.in_doubt.push_back(columns.column[pixel]);
        }
    };
    const auto disperse = [&](int row, std::span<const int> in_doubt, Workspace& work) {
        const ColumnBlock columns = some_columns(scene.rays.front(), in_doubt);
        const RayTerms& terms = scene.rays.front();
        look_along(terms, steps_, first_row + row, columns, work.rays.front());
        for (std::size_t j = 0; j < kRayNodes; ++j)
            look_exactly(rig_, first_row + row, columns, dispersed_nodes_nm_[j], work.nodes[j]);
        for (RowBlock<double>& total : work.totals) total.fill(0.0);
        for (const PlacedLamp& lamp : scene.lamps) {
            shine(work.rays.front(), lamp.terms, Edges::Found, work.lit);
            add_dispersed(terms,
                          steps_,
                          work.nodes,
                          shares_,
                          columns.count,
                          lamp.terms,
                          *tables_[lamp.spectrum].dispersed,
                          work.lit,
                          work.totals);
        }
        const auto width = static_cast<std::size_t>(map.width_px);
        const std::size_t plane = width * static_cast<std::size_t>(map.height_px);
        for (std::size_t i = 0; i < static_cast<std::size_t>(columns.count); ++i) {
            const std::size_t at =
                static_cast<std::size_t>(row) * width + static_cast<std::size_t>(columns.column[i]);
            for (std::size_t c = 0; c < kChannels; ++c)
                map.samples[c * plane + at] = static_cast<float>(work.totals[c][i]);
        }
    };
    const auto make_row = [&](int row, Workspace& work) {
        work.in_doubt.clear();
        for (std::size_t block = 0; block < scene.blocks.size(); ++block) {
            const bool is_sampled = !scene.samples.empty();
            if (is_sampled && block % kSampledBlocks == 0)
                sample(row, scene.samples[block / kSampledBlocks], work);
            if (is_sampled && is_fit(block, work)) {
                const int first = first_sampled_column(scene.rays.front(), static_cast<int>(block));
                store(work.sums, row, first, map);
                continue;
            }
            look(row, scene.blocks[block], work);
            add_lamps(work, [](const PlacedLamp&) {});
            store(work.sums, row, static_cast<int>(block) * kRowBlock, map);
            note_doubts(scene.blocks[block], work);
        }
        for (std::size_t first = 0; first < work.in_doubt.size(); first += kBlockCount)
            disperse(row, std::span(work.in_doubt).subspan(first), work);
    };
    const auto take_off = [&](int row, std::vector<float>& all) {
        const auto width = static_cast<std::size_t>(map.width_px);
        const float* const V = &vignetting_[static_cast<std::size_t>(first_row + row) * width];
        for (std::size_t c = 0; c < kChannels; ++c) {
            float* const samples =
                &all[(c * static_cast<std::size_t>(count) + static_cast<std::size_t>(row)) * width];
            for (std::size_t i = 0; i < width; ++i) samples[i] *= V[i];
        }
    };
    std::vector<Workspace> workspaces(static_cast<std::size_t>(options_.threads));
    parallel_for(static_cast<std::size_t>(count),
                 workspaces.size(),
                 [&](std::size_t row, std::size_t thread) {
                     make_row(static_cast<int>(row), workspaces[thread]);
                     if (!vignetting_.empty() && !veil_)
                         take_off(static_cast<int>(row), map.samples);
                 });
    const auto sum_of = [&](int Outside::*kind) {
        long long sum = 0;
        for (const Workspace& work : workspaces) sum += work.outside.*kind;
        return sum;
    };
    require_served(sled, sum_of(&Outside::before) > 0, sum_of(&Outside::beyond) > 0);
    map.veil.clear();
    if (!veil_) return;
    veil_->rows_into(
        sled, {.first = first_row, .count = count}, map.samples, options_.threads, map.veil);
    if (vignetting_.empty()) return;
    for (int row = 0; row < count; ++row) {
        take_off(row, map.samples);
        take_off(row, map.veil);
    }
}

std::vector<double> LightmapMaker::cones(const Sled& sled) const {
    const auto width = static_cast<std::size_t>(rig_.camera.width_px);
    std::vector<double> found(width * static_cast<std::size_t>(rig_.camera.height_px), 0.0);
    const Scene scene = scene_of(sled);
    // Whole numbers below 2^40, whose sums are exact and seldom the same by chance.
    std::mt19937_64 engine(1);
    constexpr std::uint64_t kShift = 24;
    std::vector<std::vector<double>> numbers;  // by lamp and edge
    for (const PlacedLamp& lamp : scene.lamps) {
        numbers.emplace_back(edges_[lamp.strobe].count());
        for (double& number : numbers.back()) number = static_cast<double>(engine() >> kShift);
    }
    RayBlock rays;
    DirectionBlock V;
    RowBlock<std::uint8_t> is_within;
    for (int row = 0; row < rig_.camera.height_px; ++row) {
        for (int column = 0; column < rig_.camera.width_px; column += kRowBlock) {
            look_along(scene.rays.front(), steps_, row, scene.blocks[block_of(column)], rays);
            const auto first = static_cast<std::size_t>(column);
            const std::size_t count = std::min<std::size_t>(kRowBlock, width - first);
            for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
                const PlacedLamp& lamp = scene.lamps[k];
                aim_turned(rays, lamp.terms, V);
                for (std::size_t e = 0; e < numbers[k].size(); ++e) {
                    is_within.fill(0);
                    count_within(edges_[lamp.strobe], e, rays, V, is_within.data());
                    double* const to = &found[static_cast<std::size_t>(row) * width + first];
                    for (std::size_t i = 0; i < count; ++i) to[i] += numbers[k][e] * is_within[i];
                }
            }
        }
    }
    return found;
}

}  // namespace aphotic
