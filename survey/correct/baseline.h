// SPDX-License-Identifier: BSD-3-Clause
//
// A named correction without a model of the lamps, for raw images and whole surveys. The formulas
// and their limits are in slow_light.h and altitude_exponential.h.
//
//   illumination-reflectance  of each image alone
//   local-equalisation        of each image alone
//   homomorphic               of each image alone
//   log-polynomial            learns one pattern of the whole survey
//   binned-polynomial         learns a pattern in each bin of altitude, of width bin_m about its
//                             multiples; corrected images have the brightness of the survey's mean,
//                             whatever their altitude
//   altitude-exponential      learns over altitude an exponential for each pixel, and each pixel's
//                             spread, in two passes
//
// Each channel, and each of the four sites of a mosaic, is corrected separately. A constant image
// stays as it is.
#pragma once

#include "survey/correct/altitude_exponential.h"
#include "survey/correct/polynomial_surface.h"
#include "survey/images/raw_image.h"

#include <array>
#include <cstddef>
#include <map>
#include <string_view>
#include <vector>

namespace aphotic {

enum class Baseline {
    IlluminationReflectance,
    LocalEqualisation,
    Homomorphic,
    LogPolynomial,
    BinnedPolynomial,
    AltitudeExponential
};

inline constexpr std::array<std::string_view, 6> kBaselineNames{
    "illumination-reflectance",
    "local-equalisation",
    "homomorphic",
    "log-polynomial",
    "binned-polynomial",
    "altitude-exponential"};  // in order

[[nodiscard]] constexpr std::string_view name_of(Baseline baseline) {
    return kBaselineNames[static_cast<std::size_t>(baseline)];
}

[[nodiscard]] constexpr bool needs_altitude(Baseline baseline) {
    return baseline >= Baseline::BinnedPolynomial;
}

struct BaselineOptions {
    double sigma = 0.1;  // of the blur, as a share of the image's width
    double low = 0.0;    // gains of slow and of quick changes, homomorphic
    double high = 1.0;
    int tiles = 8;  // local equalisation
    double clip = 3.0;
    int order = 4;  // of the polynomials
    double bin_m = 0.1;
};

class BaselineCorrector {
  public:
    BaselineCorrector(Baseline baseline, const BaselineOptions& options)
        : baseline_(baseline), options_(options) {}

    // How many times every image of the survey must be learned before the first is corrected.
    [[nodiscard]] int passes() const {
        if (baseline_ == Baseline::AltitudeExponential) return 2;
        return baseline_ >= Baseline::LogPolynomial ? 1 : 0;
    }
    [[nodiscard]] bool learns() const { return passes() > 0; }
    [[nodiscard]] bool needs_altitude() const { return aphotic::needs_altitude(baseline_); }

    // The images must have one size and mosaic and be finite. Keeps moments, and discards the
    // image.
    void learn(const RawImage& image, double altitude_m);
    // Call it after the last image of a pass. An InputError if they were too few.
    void end_pass(std::size_t threads);

    // The number of images learned in the bin of that altitude, or in all.
    [[nodiscard]] std::size_t learned(double altitude_m) const;

    // An InputError if it learns and nothing was learned at that altitude.
    [[nodiscard]] RawImage corrected(const RawImage& image, double altitude_m) const;

  private:
    using Surfaces = std::vector<PolynomialSurface>;  // of the planes of sites

    void learn_exponentials(const RawImage& image, double altitude_m);
    [[nodiscard]] int bin_of(double altitude_m) const;
    [[nodiscard]] std::vector<float> without_pattern(const std::vector<float>& plane,
                                                     std::size_t site,
                                                     int bin) const;
    [[nodiscard]] double survey_mean(std::size_t site) const;

    Baseline baseline_;
    BaselineOptions options_;
    std::map<int, Surfaces> bins_;
    std::vector<AltitudeExponential> exponentials_;  // of the planes of sites
    std::size_t learned_ = 0;                        // by these, in the first pass
    int ended_passes_ = 0;
};

}  // namespace aphotic
