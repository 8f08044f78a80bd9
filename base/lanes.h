// SPDX-License-Identifier: BSD-3-Clause
//
// Several numbers for the same formula, in packs as wide as the processor's vectors.
//
//   Lanes         kLanes numbers in memory; LaneVector: as many vectors (x, y, z)
//   Pack          the type of a formula's values: +, *, std::experimental's sqrt, min, max, where
//
// A formula is one loop over packs, whose values stay in registers; table lookups are done lane by
// lane.
#pragma once

#include <array>
#include <cstddef>
#include <experimental/simd>

namespace aphotic {

inline constexpr std::size_t kLanes = 8;

using Pack = std::experimental::native_simd<double>;
static_assert(kLanes % Pack::size() == 0);

struct Lanes {
    // Aligned for the largest vectors, so that all parts of a program agree whatever their vector
    // width.
    alignas(kLanes * sizeof(double)) std::array<double, kLanes> lane;

    double& operator[](std::size_t k) { return lane[k]; }
    const double& operator[](std::size_t k) const { return lane[k]; }

    // The pack that starts at a lane.
    [[nodiscard]] Pack pack(std::size_t k) const {
        return Pack(&lane[k], std::experimental::vector_aligned);
    }
    void set_pack(std::size_t k, const Pack& pack) {
        pack.copy_to(&lane[k], std::experimental::vector_aligned);
    }
};
using LaneVector = std::array<Lanes, 3>;
using PackVector = std::array<Pack, 3>;

[[nodiscard]] inline PackVector pack(const LaneVector& v, std::size_t k) {
    return {v[0].pack(k), v[1].pack(k), v[2].pack(k)};
}
inline void set_pack(LaneVector& v, std::size_t k, const PackVector& pack) {
    for (std::size_t i = 0; i < 3; ++i) v[i].set_pack(k, pack[i]);
}

// Calls f(k) for the first lane of each pack.
template <typename F>
void for_each_pack(const F& f) {
    for (std::size_t k = 0; k < kLanes; k += Pack::size()) f(k);
}

// v.w, where either may be a vector shared by all lanes.
[[nodiscard]] Pack dot(const auto& v, const auto& w) {
    return v[0] * w[0] + v[1] * w[1] + v[2] * w[2];
}

[[nodiscard]] inline Pack root(const Pack& x) {  // 0 where rounding leaves less than 0
    return std::experimental::sqrt(std::experimental::max(x, Pack(0.0)));
}

}  // namespace aphotic
