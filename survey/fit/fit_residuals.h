// SPDX-License-Identifier: BSD-3-Clause
//
// What a fit leaves: where the residuals of many images stay in place, or go with the altitude, it
// is the model that is wrong and not the floor.
#pragma once

#include "survey/fit/fit_equations.h"
#include "survey/fit/fit_samples.h"

#include <cstddef>
#include <vector>

namespace aphotic {

// What the fit leaves of an image, and what it makes of the image's own level.
struct ImageOutcome {
    Sled sled;
    double residual = 0.0;  // rms, relative
    double level = 0.0;     // of green, relative
};

// An image as blocks: R, G, B planar, NaN where left out.
struct FitView {
    std::size_t image = 0;
    std::vector<float> observed;
    std::vector<float> fitted;
    std::vector<float> residual;  // relative; the mean over channels, one plane
};
inline constexpr std::size_t kFitViews = 5;

struct FitResiduals {
    double residual = 0.0;  // rms of blocks, relative to the signal, levels taken out
    double pattern = 0.0;   // of that, what stays in place from image to image
    double smooth = 0.0;    // and what a block has in common with the next
    std::vector<ImageOutcome> images;
    std::vector<FitView> views;  // kFitViews of them, from the lowest to the highest
};

[[nodiscard]] FitResiduals fit_residuals(const FitEquations& equations,
                                         const FitSamples& samples,
                                         const FitState& state,
                                         const PathLight& light,
                                         const Eigen::VectorXd& shares);

}  // namespace aphotic
