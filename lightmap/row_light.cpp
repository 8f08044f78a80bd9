// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/row_light.h"

#include <algorithm>
#include <cmath>

// Where the loader can choose (ELF with glibc on x86-64), each loop is compiled for wider vectors
// too. They change no bit: the same IEEE operations, and none is fused. Unoptimised code, which has
// no vectors, has no need of a choice.
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__OPTIMIZE__) && \
    !defined(__SANITIZE_ADDRESS__)
#define APHOTIC_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define APHOTIC_WIDE
#endif

namespace aphotic {

namespace {

constexpr auto kCount = static_cast<std::size_t>(kRowBlock);

// How a pixel's slopes in air turn into those in water, and where they leave the port.
APHOTIC_WIDE void bend(const RayTerms& terms, double u, double first_v, RayBlock& rays) {
    const double n_w2 = terms.water_index * terms.water_index;
    const double n_g2 = terms.glass_index * terms.glass_index;
    for (std::size_t i = 0; i < kCount; ++i) {
        const double v = first_v + static_cast<double>(static_cast<int>(i)) * terms.slope_per_px;
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

APHOTIC_WIDE void meet_floor(const RayTerms& terms, RayBlock& rays) {
    const double x = terms.down.x();
    const double y = terms.down.y();
    const double z = terms.down.z();
    const double from_port_m = terms.floor_m - z * rays.o_z;
    for (std::size_t i = 0; i < kCount; ++i) {
        const double w = x * rays.D_x[i] + y * rays.D_y[i] + z;
        const double H = from_port_m - x * rays.o_x[i] - y * rays.o_y[i];
        const double sees = (w > 0.0 ? 1.0 : 0.0) * (H > 0.0 ? 1.0 : 0.0);
        rays.sees[i] = sees;
        rays.w[i] = sees > 0.0 ? w : 1.0;
        rays.H[i] = H;
        rays.D_length[i] = std::sqrt(rays.D_x[i] * rays.D_x[i] + rays.D_y[i] * rays.D_y[i] + 1.0);
    }
}

APHOTIC_WIDE void add_cone(double cosine, double intensity, LampBlock& block) {
    for (std::size_t i = 0; i < kCount; ++i) {
        block.intensity[i] += block.V_axis[i] >= cosine * block.V_length[i] ? intensity : 0.0;
    }
}

}  // namespace

void look_along(const RayTerms& terms, int row, int first_column, RayBlock& rays) {
    const double u = (terms.middle_row - (row + 0.5)) * terms.slope_per_px;
    const double first_v = (first_column + 0.5 - terms.middle_column) * terms.slope_per_px;
    rays.o_z = terms.distance_m + terms.thickness_m;
    bend(terms, u, first_v, rays);
    meet_floor(terms, rays);
    for (int i = terms.width_px - first_column; i < kRowBlock; ++i) {
        rays.sees[static_cast<std::size_t>(i)] = 0.0;
    }
}

APHOTIC_WIDE void shine(const RayBlock& rays, const LampTerms& lamp, LampBlock& block) {
    const double s_x = lamp.position_m.x();
    const double s_y = lamp.position_m.y();
    const double z = rays.o_z - lamp.position_m.z();
    const double a_x = lamp.axis.x();
    const double a_y = lamp.axis.y();
    const double a_z = lamp.axis.z();
    for (std::size_t i = 0; i < kCount; ++i) {
        const double V_x = (rays.o_x[i] - s_x) * rays.w[i] + rays.H[i] * rays.D_x[i];
        const double V_y = (rays.o_y[i] - s_y) * rays.w[i] + rays.H[i] * rays.D_y[i];
        const double V_z = z * rays.w[i] + rays.H[i];
        block.V_axis[i] = a_x * V_x + a_y * V_y + a_z * V_z;
        block.V_length[i] = std::sqrt(V_x * V_x + V_y * V_y + V_z * V_z);
    }
}

void find_cones(const LampTerms& lamp, LampBlock& block) {
    block.intensity.fill(0.0);
    for (std::size_t k = 0; k < lamp.cone_cosine.size(); ++k) {
        add_cone(lamp.cone_cosine[k], lamp.cone_intensity[k], block);
    }
}

APHOTIC_WIDE Outside weigh(const RayBlock& rays,
                           const LampTerms& lamp,
                           const PathSteps& steps,
                           LampBlock& block) {
    const double last = steps.count;
    const double first = steps.first_m * steps.steps_per_m;
    for (std::size_t i = 0; i < kCount; ++i) {
        const double w = rays.w[i];
        const double V2 = block.V_length[i] * block.V_length[i];
        const double axis = block.V_axis[i] > 0.0 ? block.V_axis[i] : 0.0;
        const double path = (rays.D_length[i] * rays.H[i] + block.V_length[i]) / w;
        const double arriving = rays.sees[i] * block.intensity[i] * axis * lamp.height_m;
        block.place[i] = path * steps.steps_per_m - first;
        block.diffuse[i] = static_cast<float>(arriving * (w * w * w) / (V2 * V2));
    }
    Outside outside;
    for (std::size_t i = 0; i < kCount; ++i) {
        const bool is_lit = block.diffuse[i] > 0.0F;
        outside.before += static_cast<int>(is_lit & (block.place[i] < 0.0));
        outside.beyond += static_cast<int>(is_lit & (block.place[i] > last));
    }
    for (std::size_t i = 0; i < kCount; ++i) {
        const double place = block.place[i] > 0.0 ? block.place[i] : 0.0;
        const double inside = place < last ? place : 0.0;
        block.diffuse[i] = place < last ? block.diffuse[i] : 0.0F;
        block.step[i] = static_cast<int>(inside);
        block.within_step[i] = static_cast<float>(inside - block.step[i]);
    }
    return outside;
}

// Few rigs have a highlight, and its power is the library's.
void weigh_highlight(const RayBlock& rays, const LampTerms& lamp, LampBlock& block) {
    for (std::size_t i = 0; i < kCount; ++i) {
        block.highlight[i] = 0.0F;
        if (block.diffuse[i] <= 0.0F) continue;
        const double w = rays.w[i];
        const double V_z = (rays.o_z - lamp.position_m.z()) * w + rays.H[i];
        const double V_x = (rays.o_x[i] - lamp.position_m.x()) * w + rays.H[i] * rays.D_x[i];
        const double V_y = (rays.o_y[i] - lamp.position_m.y()) * w + rays.H[i] * rays.D_y[i];
        const double V_D = V_x * rays.D_x[i] + V_y * rays.D_y[i] + V_z;
        const double aligned =
            (2.0 * w * w * lamp.height_m - V_D) / (rays.D_length[i] * block.V_length[i]);
        if (aligned <= 0.0) continue;  // none, where phong_size is 0 too
        const double arriving = block.intensity[i] * block.V_axis[i] * w * w /
                                (block.V_length[i] * block.V_length[i] * block.V_length[i]);
        block.highlight[i] =
            static_cast<float>(arriving * lamp.phong * std::pow(aligned, lamp.phong_size));
    }
}

void look_up(const LampBlock& block,
             const RowBlock<float>& factors,
             std::span<const float> table,
             SumBlock& sums) {
    for (std::size_t i = 0; i < kCount; ++i) {
        const float t = block.within_step[i];
        const float factor = factors[i];
        const float* c = &table[static_cast<std::size_t>(block.step[i]) * kTableStride];
        for (std::size_t lane = 0; lane < kTableLanes; ++lane) {
            sums[i][lane] +=
                factor *
                (c[lane] + t * (c[lane + kTableLanes] +
                                t * (c[lane + 2 * kTableLanes] + t * c[lane + 3 * kTableLanes])));
        }
    }
}

}  // namespace aphotic
