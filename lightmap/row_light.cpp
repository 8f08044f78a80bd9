// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/row_light.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace aphotic {

namespace {

APHOTIC_WIDE void go_straight(double u, const RowBlock<double>& v, RayBlock& rays) {
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        rays.D_x[i] = u;
        rays.D_y[i] = v[i];
        rays.o_x[i] = 0.0;
        rays.o_y[i] = 0.0;
    }
}

// How a pixel's slopes in air turn into those in water, and where they leave the port.
APHOTIC_WIDE void bend(const RayTerms& terms,
                       double u,
                       const RowBlock<double>& slopes,
                       RayBlock& rays) {
    const double n_w2 = terms.water_index * terms.water_index;
    const double n_g2 = terms.glass_index * terms.glass_index;
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const double v = slopes[i];
        const double q = u * u + v * v;
        const double in_water = 1.0 / std::sqrt(n_w2 + (n_w2 - 1.0) * q);
        const double leaving_m =
            terms.distance_m + terms.thickness_m / std::sqrt(n_g2 + (n_g2 - 1.0) * q);
        rays.D_x[i] = u * in_water;
        rays.D_y[i] = v * in_water;
        rays.o_x[i] = u * leaving_m;
        rays.o_y[i] = v * leaving_m;
    }
}

template <bool kIsAhead>
APHOTIC_IN_LOOP void meet(const RayTerms& terms, const PathSteps& steps, RayBlock& rays) {
    const double x = terms.down.x();
    const double y = terms.down.y();
    const double z = terms.down.z();
    const double from_port_m = terms.floor_m - z * rays.o_z;
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const double D_x = rays.D_x[i];
        const double D_y = rays.D_y[i];
        const double down = x * D_x + y * D_y + z;
        const double H = from_port_m - x * rays.o_x[i] - y * rays.o_y[i];
        const bool sees = (down > 0.0) & (H > 0.0);
        const double w = sees ? down : 1.0;
        const double per_w = 1.0 / w;
        double leg_m = H * std::sqrt(D_x * D_x + D_y * D_y + 1.0) * per_w;
        if constexpr (kIsAhead) leg_m -= rays.ahead[i] * std::sqrt(D_x * D_x + D_y * D_y + 1.0);
        rays.H[i] = H;
        rays.w[i] = w;
        rays.per_w[i] = static_cast<float>(per_w);
        rays.w3[i] = static_cast<float>(sees ? w * w * w : 0.0);
        rays.leg_steps[i] = static_cast<float>((leg_m - steps.first_m) * steps.steps_per_m);
    }
}

APHOTIC_WIDE void meet_floor(const RayTerms& terms, const PathSteps& steps, RayBlock& rays) {
    meet<false>(terms, steps, rays);
}

APHOTIC_WIDE void meet_floor_ahead(const RayTerms& terms, const PathSteps& steps, RayBlock& rays) {
    meet<true>(terms, steps, rays);
}

// The steps that the block's pixels are in.
struct StepRange {
    int first;
    int last;
};

APHOTIC_WIDE StepRange steps_of(const RowBlock<int>& steps) {
    StepRange range{steps[0], steps[0]};
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        range.first = std::min(range.first, steps[i]);
        range.last = std::max(range.last, steps[i]);
    }
    return range;
}

// The pixels that are in this step.
APHOTIC_WIDE void add_step(const LampBlock& block,
                           const RowBlock<float>& factors,
                           int step,
                           const float* cubic,
                           SumBlock& sums) {
    for (std::size_t c = 0; c < kChannels; ++c) {
        const float c_0 = cubic[c];
        const float c_1 = cubic[c + kTableLanes];
        const float c_2 = cubic[c + 2 * kTableLanes];
        const float c_3 = cubic[c + 3 * kTableLanes];
        for (std::size_t i = 0; i < kBlockCount; ++i) {
            const float t = block.within_step[i];
            const float factor = block.step[i] == step ? factors[i] : 0.0F;
            sums[c][i] += factor * (c_0 + t * (c_1 + t * (c_2 + t * c_3)));
        }
    }
}

// Towards the horizon every pixel is in a step of its own.
void add_pixels(const LampBlock& block,
                const RowBlock<float>& factors,
                std::span<const float> table,
                SumBlock& sums) {
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const float* cubic = &table[static_cast<std::size_t>(block.step[i]) * kTableStride];
        const float t = block.within_step[i];
        for (std::size_t c = 0; c < kChannels; ++c) {
            sums[c][i] +=
                factors[i] *
                (cubic[c] + t * (cubic[c + kTableLanes] + t * (cubic[c + 2 * kTableLanes] +
                                                               t * cubic[c + 3 * kTableLanes])));
        }
    }
}

}  // namespace

RayTerms ray_terms(const Rig& rig,
                   const Plane& floor,
                   double lambda_nm,
                   std::shared_ptr<const RayTable> table) {
    RayTerms terms{.width_px = rig.camera.width_px,
                   .slope_per_px = rig.camera.pixel_pitch_m / rig.camera.focal_length_m,
                   .middle_column = 0.5 * rig.camera.width_px,
                   .middle_row = 0.5 * rig.camera.height_px,
                   .down = -floor.normal,
                   .floor_m = height_above(floor, Eigen::Vector3d::Zero()),
                   .table = std::move(table)};
    if (!rig.camera.port || terms.table) return terms;
    terms.distance_m = rig.camera.port->distance_m;
    terms.thickness_m = rig.camera.port->thickness_m;
    terms.glass_index = rig.camera.port->glass.index(lambda_nm);
    terms.water_index = rig.water.refractive_index(lambda_nm);
    return terms;
}

namespace {

double slope_of(const RayTerms& terms, int first_column, std::size_t pixel) {
    return (first_column + 0.5 - terms.middle_column) * terms.slope_per_px +
           static_cast<double>(pixel) * terms.slope_per_px;
}

}  // namespace

ColumnBlock neighbours(const RayTerms& terms, int first_column) {
    ColumnBlock columns{
        .v = {}, .column = {}, .count = std::min(kRowBlock, terms.width_px - first_column)};
    for (std::size_t i = 0; i < kBlockCount; ++i) columns.v[i] = slope_of(terms, first_column, i);
    std::iota(columns.column.begin(), columns.column.end(), first_column);
    return columns;
}

int first_sampled_column(const RayTerms& terms, int block) {
    return std::min(block * kRowBlock, terms.width_px - kRowBlock);
}

ColumnBlock samples_of_blocks(const RayTerms& terms, int first_block) {
    ColumnBlock columns{.v = {}, .column = {}, .is_in_order = false};
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const int block = first_block + static_cast<int>(i / kFitSamples);
        const int first = first_sampled_column(terms, block);
        const std::size_t pixel = fit_pixels()[i % kFitSamples];
        columns.v[i] = slope_of(terms, first, pixel);
        columns.column[i] = first + static_cast<int>(pixel);
    }
    return columns;
}

ColumnBlock some_columns(const RayTerms& terms, std::span<const int> columns) {
    const std::size_t count = std::min(columns.size(), kBlockCount);
    ColumnBlock block{
        .v = {}, .column = {}, .count = static_cast<int>(count), .is_in_order = false};
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        block.column[i] = columns[std::min(i, count - 1)];
        block.v[i] = slope_of(terms, block.column[i], 0);
    }
    return block;
}

namespace {

void end_row(int count, RayBlock& rays) {
    for (int i = count; i < kRowBlock; ++i) rays.w3[static_cast<std::size_t>(i)] = 0.0F;
}

APHOTIC_WIDE void mix(const RayNodes& nodes,
                      const std::vector<double>& shares,
                      RowBlock<double> RayBlock::*part,
                      RayBlock& rays) {
    RowBlock<double>& mixed = rays.*part;
    mixed.fill(0.0);
    for (std::size_t j = 0; j < kRayNodes; ++j) {
        const RowBlock<double>& node = nodes[j].*part;
        for (std::size_t i = 0; i < kBlockCount; ++i) mixed[i] += shares[j] * node[i];
    }
}

void look_by_table(const RayTable& table, int row, const ColumnBlock& columns, RayBlock& rays) {
    rays.o_z = table.front_m();
    if (!table.has_port()) {
        rays.o_x.fill(0.0);
        rays.o_y.fill(0.0);
    }
    if (columns.is_in_order) {
        table.look_from(row, columns.column.front(), rays);
    } else {
        table.look_at(row, columns.column, rays);
    }
}

}  // namespace

void look_along(const RayTerms& terms,
                const PathSteps& steps,
                int row,
                const ColumnBlock& columns,
                RayBlock& rays) {
    rays.is_in_order = columns.is_in_order;
    if (terms.table) {
        look_by_table(*terms.table, row, columns, rays);
        (terms.table->has_port() ? meet_floor_ahead : meet_floor)(terms, steps, rays);
    } else {
        const double u = (terms.middle_row - (row + 0.5)) * terms.slope_per_px;
        rays.o_z = terms.distance_m + terms.thickness_m;
        const bool has_port = terms.water_index != 1.0;
        has_port ? bend(terms, u, columns.v, rays) : go_straight(u, columns.v, rays);
        meet_floor(terms, steps, rays);
    }
    end_row(columns.count, rays);
}

void look_between(const RayTerms& terms,
                  const PathSteps& steps,
                  const RayNodes& nodes,
                  const std::vector<double>& shares,
                  int count,
                  RayBlock& rays) {
    rays.is_in_order = nodes.front().is_in_order;
    rays.o_z = nodes.front().o_z;
    for (const auto part : {&RayBlock::D_x, &RayBlock::D_y, &RayBlock::o_x, &RayBlock::o_y})
        mix(nodes, shares, part, rays);
    if (terms.table) mix(nodes, shares, &RayBlock::ahead, rays);
    (terms.table ? meet_floor_ahead : meet_floor)(terms, steps, rays);
    end_row(count, rays);
}

void look_exactly(
    const Rig& rig, int row, const ColumnBlock& columns, double lambda_nm, RayBlock& rays) {
    rays.is_in_order = columns.is_in_order;
    rays.o_z = front_m(rig.camera.port);
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const WaterRay ray = pixel_ray(rig, columns.column[i] + 0.5, row + 0.5, lambda_nm);
        const Eigen::Vector3d D = ray.direction / ray.direction.z();
        rays.ahead[i] = ray.origin_m.z() - rays.o_z;
        rays.D_x[i] = D.x();
        rays.D_y[i] = D.y();
        rays.o_x[i] = ray.origin_m.x() - rays.ahead[i] * D.x();
        rays.o_y[i] = ray.origin_m.y() - rays.ahead[i] * D.y();
    }
}

namespace {

// V.a and |V|^2, and with sides, V.along and V.across.
template <bool kHasSides>
APHOTIC_IN_LOOP void aim(const RayBlock& rays, const LampTerms& lamp, DirectionBlock& V) {
    const double s_x = lamp.position_m.x();
    const double s_y = lamp.position_m.y();
    const double z = rays.o_z - lamp.position_m.z();
    const Eigen::Vector3d a = lamp.frame.axis;
    const Eigen::Vector3d along = lamp.frame.along;
    const Eigen::Vector3d across = lamp.frame.across;
    const double a_x = a.x(), a_y = a.y(), a_z = a.z();
    const double along_x = along.x(), along_y = along.y(), along_z = along.z();
    const double across_x = across.x(), across_y = across.y(), across_z = across.z();
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const double V_x = (rays.o_x[i] - s_x) * rays.w[i] + rays.H[i] * rays.D_x[i];
        const double V_y = (rays.o_y[i] - s_y) * rays.w[i] + rays.H[i] * rays.D_y[i];
        const double V_z = z * rays.w[i] + rays.H[i];
        V.axis[i] = a_x * V_x + a_y * V_y + a_z * V_z;
        V.square[i] = V_x * V_x + V_y * V_y + V_z * V_z;
        if constexpr (kHasSides) {
            V.along[i] = along_x * V_x + along_y * V_y + along_z * V_z;
            V.across[i] = across_x * V_x + across_y * V_y + across_z * V_z;
        }
    }
}

}  // namespace

APHOTIC_WIDE void aim_round(const RayBlock& rays, const LampTerms& lamp, DirectionBlock& V) {
    aim<false>(rays, lamp, V);
}

APHOTIC_WIDE void aim_turned(const RayBlock& rays, const LampTerms& lamp, DirectionBlock& V) {
    aim<true>(rays, lamp, V);
}

void shine(const RayBlock& rays, const LampTerms& lamp, Edges edges, LampBlock& block) {
    block.V.is_in_order = rays.is_in_order;
    (lamp.light->is_round ? aim_round : aim_turned)(rays, lamp, block.V);
    look_into(*lamp.light, block.V, edges, block.beam);
}

APHOTIC_WIDE void count_seen(const RayBlock& rays, std::uint8_t* counts) {
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        counts[i] = static_cast<std::uint8_t>(counts[i] + (rays.w3[i] > 0.0F ? 1 : 0));
    }
}

APHOTIC_WIDE void count_within(const RayBlock& rays,
                               const DirectionBlock& V,
                               double cosine,
                               std::uint8_t* counts) {
    const double square = cosine * cosine;
    RowBlock<float> is_within;
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const double along = V.axis[i] * std::abs(V.axis[i]);
        is_within[i] = along >= square * V.square[i] ? rays.w3[i] : 0.0F;
    }
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        counts[i] = static_cast<std::uint8_t>(counts[i] + (is_within[i] > 0.0F ? 1 : 0));
    }
}

APHOTIC_WIDE Outside weigh(const RayBlock& rays,
                           const LampTerms& lamp,
                           const PathSteps& steps,
                           LampBlock& block) {
    const auto last = static_cast<float>(steps.count);
    const auto steps_per_m = static_cast<float>(steps.steps_per_m);
    const auto height_m = static_cast<float>(lamp.height_m);
    const RowBlock<double>& intensity = block.beam.intensity;
    const RowBlock<double>& reach = *block.beam.reach;
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const auto V2 = static_cast<float>(block.V.square[i]);
        const auto signed_reach = static_cast<float>(reach[i]);
        const float ahead = signed_reach > 0.0F ? signed_reach : 0.0F;
        const float inverse = 1.0F / V2;
        const float arriving = static_cast<float>(intensity[i]) * height_m * ahead;
        block.place[i] = rays.leg_steps[i] + std::sqrt(V2) * rays.per_w[i] * steps_per_m;
        block.diffuse[i] = arriving * rays.w3[i] * inverse * inverse;
    }
    Outside outside;
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const float light = block.diffuse[i];
        const float place = block.place[i];
        outside.before += static_cast<int>(light > 0.0F) & static_cast<int>(place < 0.0F);
        outside.beyond += static_cast<int>(light > 0.0F) & static_cast<int>(place > last);
    }
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const float found = block.place[i];
        const float place = found >= 0.0F && found < last ? found : 0.0F;
        const int step = static_cast<int>(place);
        block.diffuse[i] = found == place ? block.diffuse[i] : 0.0F;
        block.step[i] = step;
        block.within_step[i] = place - static_cast<float>(step);
    }
    return outside;
}

// Few rigs have a highlight, and its power is the library's.
void weigh_highlight(const RayBlock& rays, const LampTerms& lamp, LampBlock& block) {
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        block.highlight[i] = 0.0F;
        if (block.diffuse[i] <= 0.0F) continue;
        const double w = rays.w[i];
        const double H = rays.H[i];
        const Eigen::Vector3d D(rays.D_x[i], rays.D_y[i], 1.0);
        const Eigen::Vector3d o_m(rays.o_x[i], rays.o_y[i], rays.o_z);
        const double along = (w * (o_m - lamp.position_m) + H * D).dot(D);
        const double V_length = std::sqrt(block.V.square[i]);
        const double aligned = (2.0 * w * w * lamp.height_m - along) / (D.norm() * V_length);
        if (aligned <= 0.0) continue;  // none, where phong_size is 0 too
        const double arriving = block.beam.intensity[i] * (*block.beam.reach)[i] * w * w /
                                (V_length * block.V.square[i]);
        block.highlight[i] =
            static_cast<float>(arriving * lamp.phong * std::pow(aligned, lamp.phong_size));
    }
}

void look_up(const LampBlock& block,
             const RowBlock<float>& factors,
             std::span<const float> table,
             SumBlock& sums) {
    constexpr int kFewSteps = 4;  // more cost as much as single pixels
    const StepRange steps = steps_of(block.step);
    if (steps.last - steps.first >= kFewSteps) {
        add_pixels(block, factors, table, sums);
        return;
    }
    for (int step = steps.first; step <= steps.last; ++step) {
        add_step(block, factors, step, &table[static_cast<std::size_t>(step) * kTableStride], sums);
    }
}

}  // namespace aphotic
