// SPDX-License-Identifier: BSD-3-Clause
//
// The correction of light over altitude in oplab's correct_images, used for AUV surveys, on one
// plane of samples. It is learned from a survey in two passes, and then for each pixel
//
//   level  J = I f(h0) / f(h),     f(h) = a exp(b h) + c
//   out    (J - m) S / s + M
//
// h     the image's altitude [m]          h0  the mean altitude of the images
// f     fitted to the means of I over bins of altitude, each at the mean altitude of its images,
//       all of the same weight: a >= 0, b <= 0, 0 <= c <= the least mean (altitude_fit.h)
// m, s  the pixel's mean and standard deviation of J over the survey
// M, S  the means of m and s over the plane, so that the result keeps the survey's brightness
//
// oplab uses 30 % and 3 % of full scale for M and S, omits bins of fewer than three images, and
// fits by soft L1, which is least squares to 0.3 % where the difference is under a tenth of full
// scale. Here no level is amplified more than 1 / kLeastShare times, nor is s less than kLeastShare
// of S; if S is 0, all images being equal, S / s is 1.
//
// Limits: S / s makes a pixel where the floor varies much look like one where it varies little, so
// with few images the contents of each show in all the others; no exponential follows a passing
// edge of a beam; and pitch and roll are ignored.
//
// github.com/ocean-perception/oplab_pipeline, correct_images.
#pragma once

#include "survey/correct/average.h"

#include <cstddef>
#include <map>
#include <span>
#include <vector>

namespace aphotic {

class AltitudeExponential {
  public:
    AltitudeExponential(std::size_t samples, double bin_m);

    // The first pass: a plane with the announced number of samples. Keeps 4 bytes of each sample
    // for each bin.
    void learn_level(std::span<const float> plane, double altitude_m);
    // Ends it. An InputError if the images are in fewer than four bins.
    void fit(std::size_t threads);

    // The second pass, with the same planes. Keeps 20 bytes per sample.
    void learn_spread(std::span<const float> plane, double altitude_m);
    void end();

    [[nodiscard]] std::vector<float> corrected(std::span<const float> plane,
                                               double altitude_m) const;

  private:
    struct Bin {
        std::vector<float> mean;
        double altitude_m = 0.0;
        std::size_t images = 0;
    };
    struct Fit {
        float a = 0.0F;
        float b_per_m = 0.0F;
        float c = 0.0F;
    };

    [[nodiscard]] std::vector<float> level(std::span<const float> plane, double altitude_m) const;

    std::size_t samples_;
    double bin_m_;
    std::map<long, Bin> bins_{};
    double mean_altitude_m_ = 0.0;
    std::vector<Fit> fits_{};
    RunningMean spread_{0};
    std::vector<float> mean_{};   // m
    std::vector<float> scale_{};  // S / s
    double common_mean_ = 0.0;    // M
};

}  // namespace aphotic
