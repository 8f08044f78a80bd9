// SPDX-License-Identifier: BSD-3-Clause
//
// Throws of dice that are the same on every machine.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string_view>

namespace aphotic {

inline constexpr double kDegree = std::numbers::pi / 180.0;

// The same throws with every standard library: only the engine is the standard's.
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}

    double between(double least, double most) { return least + (most - least) * unit(); }
    // Every octave as likely as any other.
    double over_octaves(double least, double most) {
        return least * std::exp2(std::log2(most / least) * unit());
    }
    int whole(int least, int most) { return least + static_cast<int>(unit() * (most - least + 1)); }
    bool chance(double share) { return unit() < share; }
    std::size_t index_in(const auto& list) {
        return static_cast<std::size_t>(unit() * static_cast<double>(list.size()));
    }
    template <std::size_t N>
    std::string_view one_of(const std::array<std::string_view, N>& names) {
        return names[index_in(names)];
    }

  private:
    // The engine's upper 53 bits, in [0, 1).
    double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }

    std::mt19937_64 engine_;
};

}  // namespace aphotic
