// SPDX-License-Identifier: BSD-3-Clause
//
// The texture of a simulated floor: its reflectance at a point relative to the rig's floor.
//
//   T(x, y) = exp(s n(x, y) - s^2/2),     s = sqrt(log(1 + contrast^2))
//   n       = sum_k w_k(x, y) / sqrt(sum_k w_k^2),      sum over octaves
//
// so that T is above 0, its mean is 1 and its standard deviation, the rms contrast, is as
// requested. n is value noise: in each octave, random numbers of variance 1 at the corners of a
// square grid, blended by weights as smooth as 6 t^5 - 15 t^4 + 10 t^3. They are divided by their
// root sum of squares, so that n has variance 1 at every point and not only at the corners.
// Six octaves, with grids from 0.64 to 0.02 m, have equal weight, as in pink noise, like natural
// scenes (D. J. Field, J. Opt. Soc. Am. A 4, 2379 (1987)).
//
// It is the same in all channels. Points are on the floor, in metres; the texture depends on them
// and on the seed, so that neighbouring pixels and other views show the same floor.
#pragma once

#include <cstdint>

namespace aphotic {

class FloorTexture {
  public:
    FloorTexture(double contrast, std::uint64_t seed);

    [[nodiscard]] double at(double x_m, double y_m) const;

  private:
    double spread_;  // s
    std::uint64_t seed_;
};

}  // namespace aphotic
