// SPDX-License-Identifier: BSD-3-Clause
//
// Many images of the sea floor averaged into the pattern of light that they share, sample by
// sample.
//
// For n samples x_1 <= ... <= x_n of one place, with their standard error E:
//
//   mean     E = s / sqrt(n)                                 s: of n - 1
//   median   E = (x_(n-k+1) - x_k) / (2 z)                   McKean & Schrader 1984, with
//            k = max(1, round((n+1)/2 - z sqrt(n/4)))        z = 2.5758, of 99 %
//   trimmed  the mean without the g = floor(trim n) least and as many largest;
//            E = sqrt(S / (h (h-1))), h = n - 2g             Yuen 1974; S: the sum of squares
//            about the mean, each trimmed sample replaced by the nearest one kept
//
// Both remain valid if x is not normal; the median's is coarse below some ten samples. With trim =
// 0 the trimmed mean and its error are the mean's. Equal samples give E = 0.
//
// A sample that is NaN was not observed. A place never observed is NaN with count 0; the error of
// fewer than two samples (trimmed: kept) is NaN.
//
// J. W. McKean and R. M. Schrader, "A comparison of methods for studentizing the sample median",
// Communications in Statistics - Simulation and Computation 13(6), 1984; K. K. Yuen, "The
// two-sample trimmed t for unequal population variances", Biometrika 61(1), 1974.
#pragma once

#include "survey/images/raw_image.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace aphotic {

enum class Average { Mean, Median, Trimmed };

struct Observed {
    std::vector<float> average;
    std::vector<float> standard_error;
    std::vector<float> count;  // whole numbers, as an EXR holds them
};

// The mean of images that come one by one (Welford's sums in double): 20 bytes per sample, however
// many the images. Their order matters only to the rounding of doubles.
class RunningMean {
  public:
    explicit RunningMean(std::size_t samples);

    void add(std::span<const float> image);  // the announced number of samples
    [[nodiscard]] Observed observed() const;

  private:
    std::vector<double> mean_;
    std::vector<double> squares_;  // about the mean
    std::vector<std::uint32_t> count_;
};

// Any average of images that are all available, each with as many samples. Exact: nothing is
// binned. trim: 0 to below 0.5, for Average::Trimmed. The result does not depend on the threads.
[[nodiscard]] Observed average_of(std::span<const std::vector<float>> images,
                                  Average average,
                                  double trim,
                                  int threads);

// Planes R, G and B of the average of images like this one: for a mosaic each sample in the plane
// of its site's channel, and `elsewhere` at the sites of the others; for a mono camera all three
// equal.
[[nodiscard]] std::vector<float> by_channel(const std::vector<float>& samples,
                                            const RawImage& like,
                                            float elsewhere);

// Gives brighter and darker exposures, floors and altitudes the same weight: only their pattern is
// left. An InputError if the mean of its samples is not above 0.
void divide_by_own_mean(RawImage& image);

// The number of samples per image that fit into the memory for this many images, at least one.
[[nodiscard]] std::size_t samples_in_memory(std::size_t images, double memory_mb);

}  // namespace aphotic
