// SPDX-License-Identifier: BSD-3-Clause
//
// Blocks of a row's pixels: arrays of one quantity each, and loops over them without branches, for
// compilers to vectorise.
#pragma once

#include <array>
#include <cstddef>
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
// For what such a loop calls: a call left in it would keep it from vectors.
#define APHOTIC_IN_LOOP [[gnu::always_inline]] inline

namespace aphotic {

inline constexpr int kRowBlock = 128;
inline constexpr auto kBlockCount = static_cast<std::size_t>(kRowBlock);
// As wide as the widest vectors.
template <class T>
struct alignas(64) RowBlock : std::array<T, kRowBlock> {};

// atan2, right to 1e-15, which the library's is too, but not in vectors: the smaller of |y| and |x|
// over the larger is turned by 45 degrees if it is more than tan(22.5 degrees). What is left, t,
// has atan(t)/t as a polynomial in t^2, Chebyshev's fit.
APHOTIC_IN_LOOP double arctangent(double y, double x) {
    constexpr double kHalfOfOctant = std::numbers::sqrt2 - 1.0;
    const double abs_y = y < 0.0 ? -y : y;
    const double abs_x = x < 0.0 ? -x : x;
    const bool is_steep = abs_y > abs_x;
    const double less = is_steep ? abs_x : abs_y;
    const double more = is_steep ? abs_y : abs_x;
    const bool is_far = less > kHalfOfOctant * more;
    const double numerator = is_far ? less - more : less;
    const double denominator = is_far ? less + more : more;
    const double t = numerator / (denominator > 0.0 ? denominator : 1.0);
    const double q = t * t;
    double ratio = -0.0253164795737764757;
    ratio = 0.0502476211894012803 + q * ratio;
    ratio = -0.0650598296717083992 + q * ratio;
    ratio = 0.0767353542818328602 + q * ratio;
    ratio = -0.0908952995656230736 + q * ratio;
    ratio = 0.111110488537512957 + q * ratio;
    ratio = -0.142857126616847938 + q * ratio;
    ratio = 0.199999999783926621 + q * ratio;
    ratio = -0.33333333333221434 + q * ratio;
    ratio = 1.0 + q * ratio;
    constexpr double kOctant = 0.25 * std::numbers::pi;
    const double flat = t * ratio + (is_far ? kOctant : 0.0);
    const double upper = is_steep ? 2.0 * kOctant - flat : flat;
    const double turned = x < 0.0 ? 4.0 * kOctant - upper : upper;
    return y < 0.0 ? -turned : turned;
}

}  // namespace aphotic
