// SPDX-License-Identifier: BSD-3-Clause
//
// The model error estimate for water that scatters: light scattered more than once on its way into
// the view, blur, and floor light that the water scatters back onto the floor. The model, as in the
// reference, is compared with light of all orders (monte_carlo.h) at kPlacesAcross x kPlacesDown
// places of the image, for each channel at the mean wavelength of its light from a level floor:
//
//   error = (floor + veil) / truth - 1                              of one place
//   rms   = sqrt(sum of g (|error| + tail / truth)^2 / sum of g)    of a channel: the estimate
//
// g     weight of the place, by Gauss-Legendre quadrature across and down the image. The error
//       grows as the square of the distance from the middle, and the rule gives the mean of its
//       square over the whole image, where even places gave 6 to 16 % less.
// tail  the truth's light of more scatterings than paths are followed for (monte_carlo.h)
//
// The truth's own noise is part of rms, which is thus never below what can be resolved. It is an
// estimate, not a bound, and is never added to the promise, which covers the formulas.
//
// For the bare floor: objects, highlights and vignetting are ignored.
#pragma once

#include "image/camera_image.h"
#include "rig/rig.h"
#include "validation/monte_carlo.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace aphotic {

inline constexpr int kPlacesAcross = 3;
inline constexpr int kPlacesDown = 3;
inline constexpr std::size_t kModelPaths = 500;

struct ModelPlace {
    double column = 0.0;
    double row = 0.0;
    std::size_t channel = 0;
    double lambda_nm = 0.0;
    double floor = 0.0;  // of the model
    double veil = 0.0;
    LightOfAllOrders truth;
    double weight = 1.0;  // g

    [[nodiscard]] double error() const { return (floor + veil) / truth.sum.mean - 1.0; }
    [[nodiscard]] double noise() const { return truth.sum.standard_error / truth.sum.mean; }
};

struct ModelCheck {
    std::size_t paths = 0;           // per place
    std::vector<ModelPlace> places;  // with floor light or veil in view; by channel

    [[nodiscard]] std::array<double, kChannels> rms() const;
};

// For water that scatters; without places for any other water. The result does not depend on
// threads.
[[nodiscard]] ModelCheck check_model(const Rig& rig,
                                     std::size_t paths,
                                     int threads,
                                     const std::function<void(double)>& progress = {});

}  // namespace aphotic
