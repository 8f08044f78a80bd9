// SPDX-License-Identifier: BSD-3-Clause
#include "rig/veil_map.h"

#include "base/parallel.h"
#include "rig/geometry.h"
#include "rig/index_nodes.h"
#include "spectral/light_family.h"

#include <algorithm>
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

// Lagrange's through 0, 1, 2, 3.
std::array<double, 4> lagrange_weights(double a) {
    const double b = a - 1.0;
    const double c = a - 2.0;
    const double d = a - 3.0;
    return {-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0};
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
    if (direct.has_horizon || direct.longest_m == 0.0) {
        const double least_per_m = least_loss_per_m(rig);
        if (std::isfinite(least_per_m)) paths.longest_m = kVeilDepth / least_per_m;
    }
    paths.longest_m = std::max(paths.longest_m, paths.shortest_m + 1.0);
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
    tabulate(paths,
             reference_grid(rig.camera.sensor, family, rig.camera.range, kVeilGridShare * error),
             error);
}

VeilMap::VeilMap(const Rig& rig,
                 const PathRange& direct,
                 double error,
                 unsigned points,
                 std::span<const double> lambda_nm,
                 double index_nm)
    : VeilMap(rig, points, {index_nm}) {
    Grid grid;
    for (std::size_t c = 0; c < lambda_nm.size(); ++c) {
        grid.push_back({.lambda_nm = lambda_nm[c]});
        grid.back().weight[c] = 1.0;
    }
    tabulate(veil_paths(rig, direct), grid, error);
}

void VeilMap::tabulate(const PathRange& paths, const Grid& grid, double error) {
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
        const SpectralSum sum = veil_sum(rig_, grid, lamp, i, every);
        const PathSteps steps = path_steps(sum, paths, kVeilTableShare * error);
        if (steps.count > steps_.count) steps_ = steps;
    });
    for (std::size_t j = 0; j < index_nodes_nm_.size(); ++j) {
        for_each_kind([&](const Spectrum& lamp, std::size_t i) {
            const auto of_node = [&](double nm) {
                return index_share(rig_, index_nodes_nm_, j, nm);
            };
            tables_.push_back(path_table(veil_sum(rig_, grid, lamp, i, of_node), steps_));
        });
    }
}

VeilMap::Signal VeilMap::table_at(const std::vector<float>& table, double path_m) const {
    const double place = (path_m - steps_.first_m) * steps_.steps_per_m;
    // Rounding may lead out of it a little. Beyond the horizon's end nothing is left.
    if (place > steps_.count + 0.01) return {};
    const int step = std::clamp(static_cast<int>(place), 0, steps_.count - 1);
    const double t = place - step;
    const float* const of_step = &table[static_cast<std::size_t>(step) * kTableStride];
    Signal signal{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto at = [&](std::size_t order) {
            return static_cast<double>(of_step[order * kTableLanes + c]);
        };
        signal[c] = at(0) + t * (at(1) + t * (at(2) + t * at(3)));
    }
    return signal;
}

VeilMap::Signal VeilMap::at(const Rig& flown, double column, double row, VeilNodes& nodes) const {
    Signal sum{};
    for (std::size_t s = 0; s < rig_.strobes.size(); ++s)
        add(flown, s, column, row, std::nullopt, nodes, sum);
    return sum;
}

VeilMap::Signal VeilMap::at(
    const Rig& flown, double column, double row, double length_m, VeilNodes& nodes) const {
    Signal sum{};
    for (std::size_t s = 0; s < rig_.strobes.size(); ++s)
        add(flown, s, column, row, length_m, nodes, sum);
    return sum;
}

VeilMap::Signal VeilMap::at(
    const Rig& flown, std::size_t strobe, double column, double row, VeilNodes& nodes) const {
    Signal sum{};
    add(flown, strobe, column, row, std::nullopt, nodes, sum);
    return sum;
}

void VeilMap::add(const Rig& flown,
                  std::size_t strobe,
                  double column,
                  double row,
                  std::optional<double> length_m,
                  VeilNodes& nodes,
                  Signal& sum) const {
    const std::size_t scatterers = rig_.water.scatterers.size();
    const std::size_t kinds = tables_.size() / index_nodes_nm_.size();
    for (std::size_t j = 0; j < index_nodes_nm_.size(); ++j) {
        const VeilSight sight = sight_of(flown, column, row, index_nodes_nm_[j]);
        veil_.nodes(strobe, sight.ray, length_m.value_or(sight.length_m), nodes);
        for (std::size_t i = 0; i < scatterers; ++i) {
            const std::vector<float>& table =
                tables_[j * kinds + lamp_of_strobe_[strobe] * scatterers + i];
            Signal of_scatterer{};
            for (std::size_t n = 0; n < nodes.path_m.size(); ++n) {
                const Signal T = table_at(table, nodes.path_m[n]);
                for (std::size_t c = 0; c < kChannels; ++c)
                    of_scatterer[c] += nodes.weight[i][n] * T[c];
            }
            for (std::size_t c = 0; c < kChannels; ++c)
                sum[c] += rig_.strobes[strobe].power * of_scatterer[c];
        }
    }
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
          const Rig& flown,
          const std::vector<Signal>& nodes,  // by row, column and strobe
          int first_node_row,
          Rows rows,
          const std::vector<float>& floor,
          std::vector<float>& samples)
        : map_(map),
          flown_(flown),
          nodes_(nodes),
          first_node_row_(first_node_row),
          rows_(rows),
          floor_(floor),
          samples_(samples) {}

    void fill(int cell_row, VeilNodes& room) const {
        for (int cell = 0; cell < map_.across_.cells; ++cell) fill_cell(cell_row, cell, room);
    }

  private:
    static constexpr auto kSide = static_cast<std::size_t>(kVeilStencil);
    using Stencil = std::array<std::array<Signal, kSide>, kSide>;
    // Where a stencil begins, and how its nodes lie in the image.
    struct Place {
        double first_column;
        double first_row;
        double apart_column;
        double apart_row;
    };

    // Pixels, and what is looked at there: one strobe's veil, beside that of all about here.
    struct Scope {
        Rows rows;
        Rows columns;
        std::size_t strobe = 0;
        Signal veil{};
    };

    static Signal cubic(const Stencil& nodes, const Place& place, double column, double row) {
        const auto of_column = lagrange_weights((column - place.first_column) / place.apart_column);
        const auto of_row = lagrange_weights((row - place.first_row) / place.apart_row);
        Signal sum{};
        for (std::size_t j = 0; j < kSide; ++j) {
            for (std::size_t i = 0; i < kSide; ++i) {
                for (std::size_t c = 0; c < kChannels; ++c)
                    sum[c] += of_row[j] * of_column[i] * nodes[j][i][c];
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

    // Whether the cubic is right there, as far as the signal of the nearest of these pixels asks.
    [[nodiscard]] bool holds(const Signal& found,
                             const Signal& exact,
                             const Scope& scope,
                             double column,
                             double row) const {
        const int y = nearest(row, scope.rows);
        const int x = nearest(column, scope.columns);
        for (std::size_t c = 0; c < kChannels; ++c) {
            const double signal = scope.veil[c] + static_cast<double>(floor_[index(c, y, x)]);
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
        for (std::size_t c = 0; c < kChannels; ++c) {
            const double most =
                kVeilBend * (scope.veil[c] + static_cast<double>(floor_[index(c, row, column)]));
            for (std::size_t k = 0; k < kSide; ++k) {
                const std::array along{
                    nodes[k][0][c], nodes[k][1][c], nodes[k][2][c], nodes[k][3][c]};
                const std::array down{
                    nodes[0][k][c], nodes[1][k][c], nodes[2][k][c], nodes[3][k][c]};
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
        constexpr std::array<std::array<double, 2>, 5> kLooks{
            {{0.5, 0.5}, {0.2, 0.2}, {0.8, 0.8}, {0.2, 0.8}, {0.8, 0.2}}};
        return std::ranges::all_of(kLooks, [&](const auto& look) {
            const double column = part.first_column + look[0] * part.apart_column;
            const double row = part.first_row + look[1] * part.apart_row;
            return holds(cubic(nodes, place, column, row),
                         map_.at(flown_, scope.strobe, column, row, room),
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
            for (std::size_t c = 0; c < kChannels; ++c) {
                std::array<double, kSide> line{};
                for (std::size_t j = 0; j < kSide; ++j) {
                    for (std::size_t i = 0; i < kSide; ++i) line[i] += of_row[j] * nodes[j][i][c];
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
        // Then pixels' centres are nodes.
        const bool is_every_pixel = across.apart_px <= 1.0 && down.apart_px <= 1.0;
        Scope scope{.rows = rows, .columns = columns};
        for (std::size_t s = 0; s < map_.rig_.strobes.size(); ++s) {
            for (std::size_t c = 0; c < kChannels; ++c) scope.veil[c] += node(s, cell_row, cell)[c];
        }
        Stencil smooth{};  // of all strobes that it serves
        for (std::size_t s = 0; s < map_.rig_.strobes.size(); ++s) {
            Stencil nodes;
            for (int j = 0; j < kVeilStencil; ++j) {
                for (int i = 0; i < kVeilStencil; ++i) {
                    nodes[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] =
                        node(s, top + j, left + i);
                }
            }
            scope.strobe = s;
            if (!is_every_pixel && !fits(nodes, place, own, scope, room)) {
                refine(cell_row, cell, scope, room);
                continue;
            }
            for (std::size_t j = 0; j < kSide; ++j) {
                for (std::size_t i = 0; i < kSide; ++i) {
                    for (std::size_t c = 0; c < kChannels; ++c) smooth[j][i][c] += nodes[j][i][c];
                }
            }
        }
        store(smooth, place, rows, columns);
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
                fine[j][i] = is_corner ? node(scope.strobe,
                                              cell_row + static_cast<int>(j) / kVeilParts,
                                              cell + static_cast<int>(i) / kVeilParts)
                                       : map_.at(flown_,
                                                 scope.strobe,
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
                        nodes[y][x] = fine[static_cast<std::size_t>(top) + y]
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
                const Signal exact = map_.at(flown_, scope.strobe, x + 0.5, y + 0.5, room);
                for (std::size_t c = 0; c < kChannels; ++c)
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

    [[nodiscard]] const Signal& node(std::size_t strobe, int row, int column) const {
        const auto stride = static_cast<std::size_t>(map_.across_.cells) + 1;
        return nodes_[(static_cast<std::size_t>(row - first_node_row_) * stride +
                       static_cast<std::size_t>(column)) *
                          map_.rig_.strobes.size() +
                      strobe];
    }

    const VeilMap& map_;
    const Rig& flown_;
    const std::vector<Signal>& nodes_;
    int first_node_row_;
    Rows rows_;
    const std::vector<float>& floor_;
    std::vector<float>& samples_;
};

void VeilMap::rows_into(const Sled& sled,
                        Rows rows,
                        const std::vector<float>& floor,
                        int threads,
                        std::vector<float>& samples) const {
    samples.assign(floor.size(), 0.0F);
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
    const std::size_t strobes = rig_.strobes.size();
    std::vector<Signal> nodes(node_rows * stride * strobes);
    std::vector<VeilNodes> rooms(static_cast<std::size_t>(threads));
    parallel_for(node_rows, rooms.size(), [&](std::size_t row, std::size_t thread) {
        for (std::size_t i = 0; i < stride * strobes; ++i) {
            const std::size_t column = i / strobes;
            nodes[row * stride * strobes + i] =
                at(flown,
                   i % strobes,
                   across_.node_px(static_cast<double>(column)),
                   down_.node_px(static_cast<double>(row) + first_node),
                   rooms[thread]);
        }
    });
    const Strip strip(*this, flown, nodes, first_node, rows, floor, samples);
    parallel_for(static_cast<std::size_t>(end_cell - first_cell),
                 rooms.size(),
                 [&](std::size_t row, std::size_t thread) {
                     strip.fill(first_cell + static_cast<int>(row), rooms[thread]);
                 });
}

}  // namespace aphotic
