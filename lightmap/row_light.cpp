// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/row_light.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

// Where the loader can choose (ELF with glibc on x86-64), each loop is compiled for wider vectors
// too. They change no bit: the same IEEE operations, and none is fused. Unoptimised code has no
// vectors to choose from, and sanitizers are not ready when the loader asks.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define APHOTIC_IS_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define APHOTIC_IS_SANITIZED 1
#endif
#endif
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__OPTIMIZE__) && \
    !defined(APHOTIC_IS_SANITIZED)
#define APHOTIC_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define APHOTIC_WIDE
#endif

namespace aphotic {

namespace {

constexpr auto kCount = static_cast<std::size_t>(kRowBlock);

APHOTIC_WIDE void go_straight(const RayTerms& terms, double u, double first_v, RayBlock& rays) {
    for (std::size_t i = 0; i < kCount; ++i) {
        rays.D_x[i] = u;
        rays.D_y[i] = first_v + static_cast<double>(static_cast<int>(i)) * terms.slope_per_px;
        rays.o_x[i] = 0.0;
        rays.o_y[i] = 0.0;
    }
}

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

APHOTIC_WIDE void meet_floor(const RayTerms& terms, const PathSteps& steps, RayBlock& rays) {
    const double x = terms.down.x();
    const double y = terms.down.y();
    const double z = terms.down.z();
    const double from_port_m = terms.floor_m - z * rays.o_z;
    for (std::size_t i = 0; i < kCount; ++i) {
        const double D_x = rays.D_x[i];
        const double D_y = rays.D_y[i];
        const double down = x * D_x + y * D_y + z;
        const double H = from_port_m - x * rays.o_x[i] - y * rays.o_y[i];
        const bool sees = (down > 0.0) & (H > 0.0);
        const double w = sees ? down : 1.0;
        const double per_w = 1.0 / w;
        const double leg_m = H * std::sqrt(D_x * D_x + D_y * D_y + 1.0) * per_w;
        rays.H[i] = H;
        rays.w[i] = w;
        rays.per_w[i] = static_cast<float>(per_w);
        rays.w3[i] = static_cast<float>(sees ? w * w * w : 0.0);
        rays.leg_steps[i] = static_cast<float>((leg_m - steps.first_m) * steps.steps_per_m);
    }
}

// Signed squares are compared, which are in the order of the cosines and need no root.
APHOTIC_WIDE void add_lobe(const Lobe& lobe, const LampBlock& block, RowBlock<double>& sum) {
    const double square = lobe.edge_cosine * lobe.edge_cosine;
    const double on_axis = lobe.on_axis;
    for (std::size_t i = 0; i < kCount; ++i) {
        const double along = block.V_axis[i] * std::abs(block.V_axis[i]);
        sum[i] += along >= square * block.V2[i] ? on_axis : 0.0;
    }
}

// The library's powers do not vectorise. These are right to 1e-9, and have no choices, which do not
// either: with x = cos^2(theta) = m 2^e and m between 1/sqrt(2) and sqrt(2),
//
//   log2 x = e + ln m/ln 2,   ln m = 2 artanh t,   t = (m - 1)/(m + 1),   |t| < 0.172
//
// and 2^y of a whole number and the rest, both by their series.
constexpr int kMantissaBits = 52;
constexpr std::uint64_t kExponentBias = 1023;

APHOTIC_WIDE void take_logarithm(LampBlock& block) {
    constexpr std::uint64_t kMantissa = 0x000fffffffffffffU;
    constexpr auto kOne = std::bit_cast<std::uint64_t>(1.0);
    constexpr auto kRootOfHalf = std::bit_cast<std::uint64_t>(0.5 * std::numbers::sqrt2);
    constexpr auto kTwo52 = std::bit_cast<std::uint64_t>(0x1p52);  // holds whole numbers at its end
    for (std::size_t i = 0; i < kCount; ++i) {
        const double x = block.V_axis[i] * block.V_axis[i] / block.V2[i];
        const std::uint64_t bits = std::bit_cast<std::uint64_t>(x) + (kOne - kRootOfHalf);
        const double e = std::bit_cast<double>((bits >> kMantissaBits) | kTwo52) -
                         (0x1p52 + static_cast<double>(kExponentBias));
        const double m = std::bit_cast<double>((bits & kMantissa) + kRootOfHalf);
        const double t = (m - 1.0) / (m + 1.0);
        const double q = t * t;
        double series = 1.0 / 11.0 + q / 13.0;
        series = 1.0 / 9.0 + q * series;
        series = 1.0 / 7.0 + q * series;
        series = 1.0 / 5.0 + q * series;
        series = 1.0 / 3.0 + q * series;
        series = 1.0 + q * series;
        block.log2_cosine[i] = 0.5 * e + t * series * std::numbers::log2e;
    }
}

// Adds factors cos^power(theta).
APHOTIC_WIDE void add_power(const RowBlock<double>& factors, double power, LampBlock& block) {
    constexpr double kRound = 0x1.8p52;  // what is added to it loses all after the point
    constexpr double kLeast = -1000.0;   // 2^-1000 is nothing
    constexpr double kMost = 100.0;      // of a negative power, where cos(theta) is nothing
    for (std::size_t i = 0; i < kCount; ++i) {
        const double asked = power * block.log2_cosine[i];
        const double above = 0.5 * (asked + kLeast + std::abs(asked - kLeast));
        const double y = 0.5 * (above + kMost - std::abs(above - kMost));
        const double rounded = y + kRound;
        const double f = (y - (rounded - kRound)) * std::numbers::ln2;
        double series = 1.0 / 40320.0 + f / 362880.0;
        series = 1.0 / 5040.0 + f * series;
        series = 1.0 / 720.0 + f * series;
        series = 1.0 / 120.0 + f * series;
        series = 1.0 / 24.0 + f * series;
        series = 1.0 / 6.0 + f * series;
        series = 1.0 / 2.0 + f * series;
        series = 1.0 + f * series;
        series = 1.0 + f * series;
        const double of_whole = std::bit_cast<double>(
            (std::bit_cast<std::uint64_t>(rounded) + kExponentBias) << kMantissaBits);
        block.intensity[i] += factors[i] * series * of_whole;
    }
}

// The steps that the block's pixels are in.
struct StepRange {
    int first;
    int last;
};

APHOTIC_WIDE StepRange steps_of(const RowBlock<int>& steps) {
    StepRange range{steps[0], steps[0]};
    for (std::size_t i = 0; i < kCount; ++i) {
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
        for (std::size_t i = 0; i < kCount; ++i) {
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
    for (std::size_t i = 0; i < kCount; ++i) {
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

RayTerms ray_terms(const Rig& rig, const Plane& floor, double lambda_nm) {
    RayTerms terms{.width_px = rig.camera.width_px,
                   .slope_per_px = rig.camera.pixel_pitch_m / rig.camera.focal_length_m,
                   .middle_column = 0.5 * rig.camera.width_px,
                   .middle_row = 0.5 * rig.camera.height_px,
                   .down = -floor.normal,
                   .floor_m = height_above(floor, Eigen::Vector3d::Zero())};
    if (!rig.camera.port) return terms;
    terms.distance_m = rig.camera.port->distance_m;
    terms.thickness_m = rig.camera.port->thickness_m;
    terms.glass_index = rig.camera.port->glass.index(lambda_nm);
    terms.water_index = rig.water.refractive_index(lambda_nm);
    return terms;
}

void look_along(
    const RayTerms& terms, const PathSteps& steps, int row, int first_column, RayBlock& rays) {
    const double u = (terms.middle_row - (row + 0.5)) * terms.slope_per_px;
    const double first_v = (first_column + 0.5 - terms.middle_column) * terms.slope_per_px;
    rays.o_z = terms.distance_m + terms.thickness_m;
    const bool has_port = terms.water_index != 1.0;
    has_port ? bend(terms, u, first_v, rays) : go_straight(terms, u, first_v, rays);
    meet_floor(terms, steps, rays);
    for (int i = terms.width_px - first_column; i < kRowBlock; ++i) {
        rays.w3[static_cast<std::size_t>(i)] = 0.0F;
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
        block.V2[i] = V_x * V_x + V_y * V_y + V_z * V_z;
    }
}

std::vector<double> other_exponents(const std::vector<Lobe>& lobes) {
    std::vector<double> others;
    for (const Lobe& lobe : lobes) {
        const bool is_known = std::ranges::find(others, lobe.exponent) != others.end();
        if (lobe.exponent != 1.0 && !is_known) others.push_back(lobe.exponent);
    }
    return others;
}

void find_lobes(const LampTerms& lamp, LampBlock& block) {
    // A cone of 90 degrees ends where its cosine does, and has no edge to look for.
    constexpr double kNoEdge = 1e-15;
    double everywhere = 0.0;
    for (const Lobe& lobe : lamp.lobes) {
        if (lobe.exponent == 1.0 && lobe.edge_cosine < kNoEdge) everywhere += lobe.on_axis;
    }
    block.intensity.fill(everywhere);
    for (const Lobe& lobe : lamp.lobes) {
        if (lobe.exponent == 1.0 && lobe.edge_cosine >= kNoEdge) {
            add_lobe(lobe, block, block.intensity);
        }
    }
    block.powers.resize(lamp.other_exponents.size());
    if (block.powers.empty()) return;
    block.cosines = block.intensity;
    for (std::size_t k = 0; k < block.powers.size(); ++k) {
        block.powers[k].fill(0.0);
        for (const Lobe& lobe : lamp.lobes) {
            if (lobe.exponent != lamp.other_exponents[k]) continue;
            add_lobe(lobe, block, block.powers[k]);
        }
    }
}

void follow_lobes(const LampTerms& lamp, LampBlock& block) {
    if (lamp.other_exponents.empty()) return;
    block.intensity = block.cosines;
    take_logarithm(block);
    for (std::size_t k = 0; k < block.powers.size(); ++k) {
        add_power(block.powers[k], lamp.other_exponents[k] - 1.0, block);
    }
}

APHOTIC_WIDE void count_seen(const RayBlock& rays, std::uint8_t* counts) {
    for (std::size_t i = 0; i < kCount; ++i) {
        counts[i] = static_cast<std::uint8_t>(counts[i] + (rays.w3[i] > 0.0F ? 1 : 0));
    }
}

APHOTIC_WIDE void count_within(const RayBlock& rays,
                               const LampBlock& block,
                               double cosine,
                               std::uint8_t* counts) {
    const double square = cosine * cosine;
    RowBlock<float> is_within;
    for (std::size_t i = 0; i < kCount; ++i) {
        const double along = block.V_axis[i] * std::abs(block.V_axis[i]);
        is_within[i] = along >= square * block.V2[i] ? rays.w3[i] : 0.0F;
    }
    for (std::size_t i = 0; i < kCount; ++i) {
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
    for (std::size_t i = 0; i < kCount; ++i) {
        const auto V2 = static_cast<float>(block.V2[i]);
        const auto signed_axis = static_cast<float>(block.V_axis[i]);
        const float axis = signed_axis > 0.0F ? signed_axis : 0.0F;
        const float inverse = 1.0F / V2;
        const float arriving = static_cast<float>(block.intensity[i]) * height_m * axis;
        block.place[i] = rays.leg_steps[i] + std::sqrt(V2) * rays.per_w[i] * steps_per_m;
        block.diffuse[i] = arriving * rays.w3[i] * inverse * inverse;
    }
    Outside outside;
    for (std::size_t i = 0; i < kCount; ++i) {
        const float light = block.diffuse[i];
        const float place = block.place[i];
        outside.before += static_cast<int>(light > 0.0F) & static_cast<int>(place < 0.0F);
        outside.beyond += static_cast<int>(light > 0.0F) & static_cast<int>(place > last);
    }
    for (std::size_t i = 0; i < kCount; ++i) {
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
    for (std::size_t i = 0; i < kCount; ++i) {
        block.highlight[i] = 0.0F;
        if (block.diffuse[i] <= 0.0F) continue;
        const double w = rays.w[i];
        const double H = rays.H[i];
        const Eigen::Vector3d D(rays.D_x[i], rays.D_y[i], 1.0);
        const Eigen::Vector3d o_m(rays.o_x[i], rays.o_y[i], rays.o_z);
        const double along = (w * (o_m - lamp.position_m) + H * D).dot(D);
        const double V_length = std::sqrt(block.V2[i]);
        const double aligned = (2.0 * w * w * lamp.height_m - along) / (D.norm() * V_length);
        if (aligned <= 0.0) continue;  // none, where phong_size is 0 too
        const double arriving =
            block.intensity[i] * block.V_axis[i] * w * w / (V_length * block.V2[i]);
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
