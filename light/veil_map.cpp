// SPDX-License-Identifier: BSD-3-Clause
#include "light/veil_map.h"

#include "base/lagrange.h"
#include "base/parallel.h"
#include "light/index_nodes.h"
#include "rig/geometry.h"
#include "spectral/light_family.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace aphotic {
namespace {

constexpr double kVeilGridShare = 0.1;
constexpr double kVeilTableShare = 0.5;
constexpr int kVeilStencil = 4;
constexpr std::size_t kMostCell_px = 18;

// The veil knows no pixels: of a small image a cell is smaller, down to a pixel, whose veil is then
// not interpolated.
double cell_px(const Camera& camera) {
    constexpr double kLeast_px = 1.0;
    return std::clamp(
        std::max(camera.width_px, camera.height_px) / kVeilCells, kLeast_px, kVeilCell_px);
}

// Of the wavelengths that are scattered.
double least_loss_per_m(const Rig& rig) {
    double least = std::numeric_limits<double>::infinity();
    for (const double nm : union_of_knots(rig.water.curves(), rig.camera.range)) {
        for (std::size_t i = 0; i < rig.water.scatterers.size(); ++i) {
            if (rig.water.scattering_per_m(i, nm) > 0.0)
                least = std::min(least, rig.water.attenuation_per_m(nm));
        }
    }
    return least;
}

PathRange veil_paths(const Rig& rig, const PathRange& direct) {
    double shortest_m = std::numeric_limits<double>::infinity();
    for (const Strobe& strobe : rig.strobes) {
        shortest_m = std::min(
            shortest_m, strobe.position_m.norm() - port_reach_m(rig) - emitter_reach_m(strobe));
    }
    PathRange paths{.shortest_m = std::max(0.0, shortest_m), .longest_m = direct.longest_m};
    constexpr double kSome_m = 1.0;
    const double least_per_m = least_loss_per_m(rig);
    if (!std::isfinite(least_per_m)) {
        paths.longest_m = std::max(paths.longest_m, paths.shortest_m + kSome_m);
        return paths;
    }
    const double dark_m = kVeilDepth / least_per_m;
    if (direct.has_horizon || direct.longest_m == 0.0) paths.longest_m = dark_m;
    // However deep the water's black: a table of no more than that depth.
    paths.longest_m = std::clamp(
        paths.longest_m, paths.shortest_m + std::min(kSome_m, dark_m), paths.shortest_m + dark_m);
    return paths;
}

SpectralSum veil_sum(const Rig& rig,
                     const std::vector<WeightedWavelength>& grid,
                     const Spectrum& lamp,
                     std::size_t scatterer,
                     const std::function<double(double)>& share) {
    const auto count = static_cast<Eigen::Index>(grid.size());
    SpectralSum sum{.K_per_m = Eigen::ArrayXd(count), .weights = Eigen::ArrayXXd(count, kChannels)};
    for (Eigen::Index i = 0; i < count; ++i) {
        const WeightedWavelength& node = grid[static_cast<std::size_t>(i)];
        sum.K_per_m(i) = rig.water.attenuation_per_m(node.lambda_nm);
        const double light = share(node.lambda_nm) * lamp.at(node.lambda_nm) *
                             rig.water.scattering_per_m(scatterer, node.lambda_nm);
        for (Eigen::Index c = 0; c < kChannels; ++c)
            sum.weights(i, c) = node.weight[static_cast<std::size_t>(c)] * light;
    }
    return sum;
}

}  // namespace

VeilMap::VeilMap(const Rig& rig, unsigned points, std::vector<double> index_nodes_nm)
    : rig_(rig),
      veil_(rig, points),
      across_(rig.camera.width_px, cell_px(rig.camera)),
      down_(rig.camera.height_px, cell_px(rig.camera)),
      index_nodes_nm_(std::move(index_nodes_nm)) {}

VeilMap::VeilMap(const Rig& rig, const PathRange& direct, double error, unsigned points)
    : VeilMap(rig, direct, error, points, {}) {}

VeilMap::VeilMap(const Rig& rig,
                 const PathRange& direct,
                 double error,
                 unsigned points,
                 std::span<const double> lambda_nm)
    : VeilMap(rig, points, index_nodes_nm(rig)) {
    const PathRange paths = veil_paths(rig, direct);
    LightFamily family{.sources = {},
                       .water = rig.water,
                       .shortest_path_m = paths.shortest_m,
                       .longest_path_m = paths.longest_m};
    for (const Strobe& strobe : rig.strobes) {
        for (const Scatterer& scatterer : rig.water.scatterers)
            family.sources.push_back({strobe.spectrum, scatterer.scattering_per_m});
    }
    grids_.push_back(
        reference_grid(rig.camera.sensor, family, rig.camera.range, kVeilGridShare * error));
    planes_ = kChannels;
    add_grids_of(lambda_nm);
    tabulate(paths, error);
}

VeilMap::VeilMap(const Rig& rig,
                 const PathRange& direct,
                 double error,
                 unsigned points,
                 std::span<const double> lambda_nm,
                 double index_nm)
    : VeilMap(rig, points, {index_nm}) {
    add_grids_of(lambda_nm);
    tabulate(veil_paths(rig, direct), error);
}

void VeilMap::add_grids_of(std::span<const double> lambda_nm) {
    for (std::size_t k = 0; k < lambda_nm.size(); ++k) {
        const std::size_t channel = k % kChannels;
        if (channel == 0) grids_.emplace_back();
        grids_.back().push_back({.lambda_nm = lambda_nm[k]});
        grids_.back().back().weight[channel] = 1.0;
    }
    planes_ += lambda_nm.size();
    assert(planes_ <= kVeilPlanes);
}

void VeilMap::tabulate(const PathRange& paths, double error) {
    std::vector<const Spectrum*> lamps;
    for (const Strobe& strobe : rig_.strobes) {
        const auto known = std::ranges::find_if(
            lamps, [&](const Spectrum* lamp) { return is_same_curve(*lamp, strobe.spectrum); });
        lamp_of_strobe_.push_back(static_cast<std::size_t>(known - lamps.begin()));
        if (known == lamps.end()) lamps.push_back(&strobe.spectrum);
    }
    const auto every = [](double) { return 1.0; };
    const auto for_each_kind = [&](const auto& take) {
        for (const Spectrum* lamp : lamps) {
            for (std::size_t i = 0; i < rig_.water.scatterers.size(); ++i) take(*lamp, i);
        }
    };
    for_each_kind([&](const Spectrum& lamp, std::size_t i) {
        for (const Grid& grid : grids_) {
            const SpectralSum sum = veil_sum(rig_, grid, lamp, i, every);
            const PathSteps steps = path_steps(sum, paths, kVeilTableShare * error);
            if (steps.count > steps_.count) steps_ = steps;
        }
    });
    for (std::size_t j = 0; j < index_nodes_nm_.size(); ++j) {
        for_each_kind([&](const Spectrum& lamp, std::size_t i) {
            const auto of_node = [&](double nm) {
                return index_share(rig_, index_nodes_nm_, j, nm);
            };
            const std::size_t stride = grids_.size() * kTableStride;
            std::vector<float> table(static_cast<std::size_t>(steps_.count) * stride);
            for (std::size_t g = 0; g < grids_.size(); ++g) {
                const std::vector<float> of_grid =
                    path_table(veil_sum(rig_, grids_[g], lamp, i, of_node), steps_);
                for (std::size_t k = 0; k < of_grid.size(); ++k)
                    table[k / kTableStride * stride + g * kTableStride + k % kTableStride] =
                        of_grid[k];
            }
            tables_.push_back(std::move(table));
        });
    }
}

VeilMap::Signal VeilMap::at(const Rig& flown, double column, double row, VeilNodes& nodes) const {
    return at_sights(Flight(flown), column, row, std::nullopt, nodes);
}

VeilMap::Signal VeilMap::at(
    const Rig& flown, double column, double row, double length_m, VeilNodes& nodes) const {
    return at_sights(Flight(flown), column, row, length_m, nodes);
}

VeilMap::Signal VeilMap::at_sights(const Flight& flight,
                                   double column,
                                   double row,
                                   std::optional<double> length_m,
                                   VeilNodes& nodes) const {
    Signal sum{};
    for (std::size_t j = 0; j < index_nodes_nm_.size(); ++j) {
        const VeilSight sight = sight_of(flight.rig, flight.floor, column, row, index_nodes_nm_[j]);
        for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
            veil_.nodes(s, sight.ray, length_m.value_or(sight.length_m), nodes);
            add(nodes, s, j, sum);
        }
    }
    return sum;
}

VeilMap::Signal VeilMap::at_part(
    const Flight& flight, std::size_t part, double column, double row, VeilNodes& nodes) const {
    Signal sum{};
    for (std::size_t j = 0; j < index_nodes_nm_.size(); ++j) {
        const VeilSight sight = sight_of(flight.rig, flight.floor, column, row, index_nodes_nm_[j]);
        veil_.nodes_of_part(part, sight.ray, sight.length_m, nodes);
        add(nodes, veil_.strobe_of_part()[part], j, sum);
    }
    return sum;
}

void VeilMap::add(const VeilNodes& nodes,
                  std::size_t strobe,
                  std::size_t index_node,
                  Signal& sum) const {
    const std::size_t scatterers = rig_.water.scatterers.size();
    const std::size_t kinds = tables_.size() / index_nodes_nm_.size();
    const std::vector<float>* const tables =
        &tables_[index_node * kinds + lamp_of_strobe_[strobe] * scatterers];
    std::array<std::array<float, kTableLanes>, kVeilPlanes / kChannels> lanes{};
    for (std::size_t n = 0; n < nodes.path_m.size(); ++n) {
        const double place = (nodes.path_m[n] - steps_.first_m) * steps_.steps_per_m;
        // Rounding may lead out of it a little. Beyond the horizon's end nothing is left.
        if (place > steps_.count + 0.01) continue;
        const int step = std::clamp(static_cast<int>(place), 0, steps_.count - 1);
        const auto t = static_cast<float>(place - step);
        for (std::size_t i = 0; i < scatterers; ++i) {
            const float* T =
                &tables[i][static_cast<std::size_t>(step) * grids_.size() * kTableStride];
            const auto weight = static_cast<float>(nodes.weight[i][n]);
            for (std::size_t g = 0; g < grids_.size(); ++g, T += kTableStride) {
                for (std::size_t c = 0; c < kTableLanes; ++c) {
                    const float signal =
                        T[c] + t * (T[kTableLanes + c] +
                                    t * (T[2 * kTableLanes + c] + t * T[3 * kTableLanes + c]));
                    lanes[g][c] += weight * signal;
                }
            }
        }
    }
    for (std::size_t c = 0; c < planes_; ++c)
        sum[c] +=
            rig_.strobes[strobe].power * static_cast<double>(lanes[c / kChannels][c % kChannels]);
}

VeilMap::Axis::Axis(int count, double cell_px)
    : pixels(count),
      cells(count == 3
                ? kVeilStencil  // so that the middle one is a node
                : std::max(kVeilStencil - 1, static_cast<int>(std::ceil((count - 1) / cell_px)))),
      apart_px(std::max(1, count - 1) / static_cast<double>(cells)) {}

int VeilMap::Axis::first_pixel(int cell) const {
    if (cell >= cells) return pixels;
    return static_cast<int>(std::ceil(cell * apart_px));
}

VeilMap::Rows VeilMap::rows_for(Rows wanted) const {
    const auto cell_of = [&](int row) {
        int cell = std::min(down_.cells - 1, static_cast<int>(row / down_.apart_px));
        while (down_.first_pixel(cell) > row) --cell;
        while (down_.first_pixel(cell + 1) <= row) ++cell;
        return cell;
    };
    const int first = down_.first_pixel(cell_of(wanted.first));
    const int end = down_.first_pixel(cell_of(wanted.first + wanted.count - 1) + 1);
    return {first, end - first};
}

// A row of cells.
class VeilMap::Strip {
  public:
    Strip(const VeilMap& map,
          const Flight& flight,
          const std::vector<Signal>& nodes,  // by row, column and part
          int first_node_row,
          Rows rows,
          const std::vector<float>& floor,
          std::vector<float>& samples)
        : map_(map),
          flight_(flight),
          nodes_(nodes),
          first_node_row_(first_node_row),
          rows_(rows),
          floor_(floor),
          samples_(samples),
          parts_(map.has_node_at_each_pixel() ? 1 : map.veil_.strobe_of_part().size()) {}

    void fill(int cell_row, VeilNodes& room) const {
        for (int cell = 0; cell < map_.across_.cells; ++cell) fill_cell(cell_row, cell, room);
    }

  private:
    static constexpr auto kSide = static_cast<std::size_t>(kVeilStencil);
    using Stencil = std::array<std::array<const Signal*, kSide>, kSide>;
    // Where a stencil begins, and how its nodes lie in the image.
    struct Place {
        double first_column;
        double first_row;
        double apart_column;
        double apart_row;
    };

    // Pixels, and what is looked at there: one part's veil, beside that of all about here.
    struct Scope {
        Rows rows;
        Rows columns;
        std::size_t part = 0;
        Signal veil{};
    };

    [[nodiscard]] Signal cubic(const Stencil& nodes,
                               const Place& place,
                               double column,
                               double row) const {
        const auto of_column = lagrange_weights((column - place.first_column) / place.apart_column);
        const auto of_row = lagrange_weights((row - place.first_row) / place.apart_row);
        Signal sum{};
        for (std::size_t j = 0; j < kSide; ++j) {
            for (std::size_t i = 0; i < kSide; ++i) {
                for (std::size_t c = 0; c < map_.planes_; ++c)
                    sum[c] += of_row[j] * of_column[i] * (*nodes[j][i])[c];
            }
        }
        return sum;
    }

    [[nodiscard]] std::size_t index(std::size_t channel, int row, int column) const {
        const auto width = static_cast<std::size_t>(map_.across_.pixels);
        return (channel * static_cast<std::size_t>(rows_.count) +
                static_cast<std::size_t>(row - rows_.first)) *
                   width +
               static_cast<std::size_t>(column);
    }

    [[nodiscard]] double floor_at(std::size_t plane, int row, int column) const {
        return floor_.empty() ? 0.0 : static_cast<double>(floor_[index(plane, row, column)]);
    }

    // Whether the cubic is right there, as far as the signal of the nearest of these pixels asks.
    [[nodiscard]] bool holds(const Signal& found,
                             const Signal& exact,
                             const Scope& scope,
                             double column,
                             double row) const {
        const int y = nearest(row, scope.rows);
        const int x = nearest(column, scope.columns);
        for (std::size_t c = 0; c < map_.planes_; ++c) {
            const double signal = scope.veil[c] + floor_at(c, y, x);
            if (std::abs(found[c] - exact[c]) > kVeilOff * signal) return false;
        }
        return true;
    }

    // Third differences: where an edge crosses the nodes, they stand out. Of nodes that are as
    // bright on the left as on the right, as seen past a lamp on the camera's axis, there are none,
    // whatever lies between; they tell nothing.
    static bool is_straight(const std::array<double, kSide>& line, double most) {
        const double outer = line[3] - line[0];
        const double inner = line[1] - line[2];
        if (!(std::abs(outer + 3.0 * inner) <= most)) return false;
        const bool is_even = std::abs(outer) <= most && std::abs(inner) <= most;
        return !is_even || std::abs(line[1] - line[0]) <= most;
    }

    [[nodiscard]] bool is_straight(const Stencil& nodes, const Scope& scope) const {
        const int row = scope.rows.first + scope.rows.count / 2;
        const int column = scope.columns.first + scope.columns.count / 2;
        for (std::size_t c = 0; c < map_.planes_; ++c) {
            const double most = kVeilBend * (scope.veil[c] + floor_at(c, row, column));
            for (std::size_t k = 0; k < kSide; ++k) {
                const std::array along{
                    (*nodes[k][0])[c], (*nodes[k][1])[c], (*nodes[k][2])[c], (*nodes[k][3])[c]};
                const std::array down{
                    (*nodes[0][k])[c], (*nodes[1][k])[c], (*nodes[2][k])[c], (*nodes[3][k])[c]};
                if (!is_straight(along, most) || !is_straight(down, most)) return false;
            }
        }
        return true;
    }

    // Whether the stencil's cubic serves a cell or a part of one.
    bool fits(const Stencil& nodes,
              const Place& place,
              const Place& part,
              const Scope& scope,
              VeilNodes& room) const {
        if (is_straight(nodes, scope)) return true;
        constexpr std::array<std::array<double, 2>, 5> kPlaces{
            {{0.5, 0.5}, {0.2, 0.2}, {0.8, 0.8}, {0.2, 0.8}, {0.8, 0.2}}};
        return std::ranges::all_of(kPlaces, [&](const auto& look) {
            const double column = part.first_column + look[0] * part.apart_column;
            const double row = part.first_row + look[1] * part.apart_row;
            return holds(cubic(nodes, place, column, row),
                         map_.at_part(flight_, scope.part, column, row, room),
                         scope,
                         column,
                         row);
        });
    }

    // Adds to the pixels of a part of the image, by one cubic.
    void store(const Stencil& nodes, const Place& place, Rows rows, Rows columns) const {
        std::array<std::array<double, kSide>, kMostCell_px> weights{};
        for (int i = 0; i < columns.count; ++i) {
            weights[static_cast<std::size_t>(i)] = lagrange_weights(
                (columns.first + i + 0.5 - place.first_column) / place.apart_column);
        }
        for (int row = rows.first; row < rows.first + rows.count; ++row) {
            const auto of_row = lagrange_weights((row + 0.5 - place.first_row) / place.apart_row);
            for (std::size_t c = 0; c < map_.planes_; ++c) {
                std::array<double, kSide> line{};
                for (std::size_t j = 0; j < kSide; ++j) {
                    for (std::size_t i = 0; i < kSide; ++i)
                        line[i] += of_row[j] * (*nodes[j][i])[c];
                }
                float* const to = &samples_[index(c, row, columns.first)];
                for (int i = 0; i < columns.count; ++i) {
                    const auto& w = weights[static_cast<std::size_t>(i)];
                    to[i] += static_cast<float>(w[0] * line[0] + w[1] * line[1] + w[2] * line[2] +
                                                w[3] * line[3]);
                }
            }
        }
    }

    void fill_cell(int cell_row, int cell, VeilNodes& room) const {
        const Axis& across = map_.across_;
        const Axis& down = map_.down_;
        const Rows rows =
            pixels_between(down.first_pixel(cell_row), down.first_pixel(cell_row + 1));
        const Rows columns = pixels_between(across.first_pixel(cell), across.first_pixel(cell + 1));
        if (rows.count == 0 || columns.count == 0) return;
        const int left = std::clamp(cell - 1, 0, across.cells + 1 - kVeilStencil);
        const int top = std::clamp(cell_row - 1, 0, down.cells + 1 - kVeilStencil);
        const Place place{across.node_px(left), down.node_px(top), across.apart_px, down.apart_px};
        const Place own{
            across.node_px(cell), down.node_px(cell_row), across.apart_px, down.apart_px};
        const bool is_every_pixel = map_.has_node_at_each_pixel();
        Scope scope{.rows = rows, .columns = columns};
        for (std::size_t k = 0; k < parts_; ++k) {
            for (std::size_t c = 0; c < map_.planes_; ++c)
                scope.veil[c] += node(k, cell_row, cell)[c];
        }
        std::array<std::array<Signal, kSide>, kSide> smooth{};  // of all parts that it serves
        for (std::size_t k = 0; k < parts_; ++k) {
            Stencil nodes;
            for (int j = 0; j < kVeilStencil; ++j) {
                for (int i = 0; i < kVeilStencil; ++i) {
                    nodes[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] =
                        &node(k, top + j, left + i);
                }
            }
            scope.part = k;
            if (!is_every_pixel && !fits(nodes, place, own, scope, room)) {
                refine(cell_row, cell, scope, room);
                continue;
            }
            for (std::size_t j = 0; j < kSide; ++j) {
                for (std::size_t i = 0; i < kSide; ++i) {
                    for (std::size_t c = 0; c < map_.planes_; ++c)
                        smooth[j][i][c] += (*nodes[j][i])[c];
                }
            }
        }
        Stencil sum;
        for (std::size_t j = 0; j < kSide; ++j) {
            for (std::size_t i = 0; i < kSide; ++i) sum[j][i] = &smooth[j][i];
        }
        store(sum, place, rows, columns);
    }

    void refine(int cell_row, int cell, const Scope& scope, VeilNodes& room) const {
        const Axis& across = map_.across_;
        const Axis& down = map_.down_;
        constexpr auto kNodes = std::size_t{kVeilParts} + 1;
        const Place own{across.node_px(cell),
                        down.node_px(cell_row),
                        across.apart_px / kVeilParts,
                        down.apart_px / kVeilParts};
        std::array<std::array<Signal, kNodes>, kNodes> fine;
        for (std::size_t j = 0; j < kNodes; ++j) {
            for (std::size_t i = 0; i < kNodes; ++i) {
                const auto x = static_cast<double>(i);
                const auto y = static_cast<double>(j);
                const bool is_corner = i % kVeilParts == 0 && j % kVeilParts == 0;
                fine[j][i] = is_corner ? node(scope.part,
                                              cell_row + static_cast<int>(j) / kVeilParts,
                                              cell + static_cast<int>(i) / kVeilParts)
                                       : map_.at_part(flight_,
                                                      scope.part,
                                                      own.first_column + x * own.apart_column,
                                                      own.first_row + y * own.apart_row,
                                                      room);
            }
        }
        for (int j = 0; j < kVeilParts; ++j) {
            for (int i = 0; i < kVeilParts; ++i) {
                Scope part = scope;
                part.rows = part_of(scope.rows, own.first_row, own.apart_row, j);
                part.columns = part_of(scope.columns, own.first_column, own.apart_column, i);
                if (part.rows.count == 0 || part.columns.count == 0) continue;
                const int left = std::clamp(i - 1, 0, kVeilParts + 1 - kVeilStencil);
                const int top = std::clamp(j - 1, 0, kVeilParts + 1 - kVeilStencil);
                Stencil nodes;
                for (std::size_t y = 0; y < kSide; ++y) {
                    for (std::size_t x = 0; x < kSide; ++x)
                        nodes[y][x] = &fine[static_cast<std::size_t>(top) + y]
                                           [static_cast<std::size_t>(left) + x];
                }
                const Place place{own.first_column + left * own.apart_column,
                                  own.first_row + top * own.apart_row,
                                  own.apart_column,
                                  own.apart_row};
                const Place at{own.first_column + i * own.apart_column,
                               own.first_row + j * own.apart_row,
                               own.apart_column,
                               own.apart_row};
                fill_part(nodes, place, at, part, room);
            }
        }
    }

    void fill_part(const Stencil& nodes,
                   const Place& place,
                   const Place& at,
                   const Scope& scope,
                   VeilNodes& room) const {
        const Rows rows = scope.rows;
        const Rows columns = scope.columns;
        if (fits(nodes, place, at, scope, room)) {
            store(nodes, place, rows, columns);
            return;
        }
        for (int y = rows.first; y < rows.first + rows.count; ++y) {
            for (int x = columns.first; x < columns.first + columns.count; ++x) {
                const Signal exact = map_.at_part(flight_, scope.part, x + 0.5, y + 0.5, room);
                for (std::size_t c = 0; c < map_.planes_; ++c)
                    samples_[index(c, y, x)] += static_cast<float>(exact[c]);
            }
        }
    }

    static Rows pixels_between(int first, int end) { return {first, std::max(0, end - first)}; }
    static int nearest(double place, Rows pixels) {
        return std::clamp(static_cast<int>(place), pixels.first, pixels.first + pixels.count - 1);
    }
    // Pixels whose centres are in a part; the last part takes the last one, too.
    static Rows part_of(Rows pixels, double first, double apart, int part) {
        const auto at = [&](int k) {
            const int pixel = static_cast<int>(std::ceil(first + k * apart - 0.5));
            return std::clamp(pixel, pixels.first, pixels.first + pixels.count);
        };
        const int end = part + 1 == kVeilParts ? pixels.first + pixels.count : at(part + 1);
        return pixels_between(part == 0 ? pixels.first : at(part), end);
    }

    [[nodiscard]] const Signal& node(std::size_t part, int row, int column) const {
        const auto stride = static_cast<std::size_t>(map_.across_.cells) + 1;
        return nodes_[(static_cast<std::size_t>(row - first_node_row_) * stride +
                       static_cast<std::size_t>(column)) *
                          parts_ +
                      part];
    }

    const VeilMap& map_;
    const Flight& flight_;
    const std::vector<Signal>& nodes_;
    int first_node_row_;
    Rows rows_;
    const std::vector<float>& floor_;
    std::vector<float>& samples_;
    std::size_t parts_;
};

void VeilMap::rows_into(const Sled& sled,
                        Rows rows,
                        const std::vector<float>& floor,
                        int threads,
                        std::vector<float>& samples) const {
    samples.assign(
        planes_ * static_cast<std::size_t>(rows.count) * static_cast<std::size_t>(across_.pixels),
        0.0F);
    Rig flown = rig_;
    flown.sled = sled;
    int first_cell = 0;
    while (down_.first_pixel(first_cell + 1) <= rows.first) ++first_cell;
    int end_cell = first_cell;
    while (end_cell < down_.cells && down_.first_pixel(end_cell) < rows.first + rows.count)
        ++end_cell;
    const int first_node = std::clamp(first_cell - 1, 0, down_.cells + 1 - kVeilStencil);
    const int last_node =
        std::min(down_.cells, std::max(end_cell + 1, first_node + kVeilStencil - 1));
    const auto stride = static_cast<std::size_t>(across_.cells) + 1;
    const auto node_rows = static_cast<std::size_t>(last_node - first_node) + 1;
    const bool is_whole = has_node_at_each_pixel();
    const std::size_t parts = is_whole ? 1 : veil_.strobe_of_part().size();
    const Flight flight(flown);
    std::vector<Signal> nodes(node_rows * stride * parts);
    std::vector<VeilNodes> rooms(static_cast<std::size_t>(threads));
    parallel_for(node_rows, rooms.size(), [&](std::size_t row, std::size_t thread) {
        const double y = down_.node_px(static_cast<double>(row) + first_node);
        for (std::size_t i = 0; i < stride * parts; ++i) {
            const std::size_t column = i / parts;
            const double x = across_.node_px(static_cast<double>(column));
            nodes[row * stride * parts + i] =
                is_whole ? at_sights(flight, x, y, std::nullopt, rooms[thread])
                         : at_part(flight, i % parts, x, y, rooms[thread]);
        }
    });
    const Strip strip(*this, flight, nodes, first_node, rows, floor, samples);
    parallel_for(static_cast<std::size_t>(end_cell - first_cell),
                 rooms.size(),
                 [&](std::size_t row, std::size_t thread) {
                     strip.fill(first_cell + static_cast<int>(row), rooms[thread]);
                 });
}

}  // namespace aphotic
