// SPDX-License-Identifier: BSD-3-Clause
//
// The accuracy of an image's patches of known colour, by the measures used for underwater colour
// correction.
//
// For a patch with mean signal M_c over its pixels, c = R, G, B, and S_c = M_c / k_c:
//
//   degrees     of grey patches, the angle between S and 1, 1, 1
//   difference  CIEDE2000 between S, taken for linear sRGB, and the reference
//   unevenness  rms over all pixels and channels of I_c / m_c - 1, m_c the mean of I_c over the
//               patches of one reference; for a patch whose reference gives no level, over itself
//
//   k  1; or one for the whole image, which removes an exposure: least squares of the luminances
//      against the references; or one for each channel, a white balance: the same of R, G and B
//      over the grey patches of known reflectance
//
// All are 0 at best. The mean of the degrees is known as "gray-patch mean angular error".
#pragma once

#include "validation/image_comparison.h"
#include "validation/patch_file.h"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

struct PatchScore {
    std::string name;
    std::array<double, 3> signal{};  // S
    std::optional<double> degrees{};
    std::optional<double> difference{};
};

struct PatchScores {
    std::vector<PatchScore> patches{};
    std::array<double, 3> scale{1.0, 1.0, 1.0};  // k
    double unevenness = 0.0;
    // Means and medians of existing values; empty if there are none.
    std::optional<double> mean_degrees{};
    std::optional<double> median_degrees{};
    std::optional<double> mean_difference{};
    std::optional<double> median_difference{};
};

struct PatchRequest {
    std::string image;
    std::string patches;  // a file
    ComparedScale scale = ComparedScale::None;
    bool is_srgb = false;  // samples have sRGB's encoding; else linear
};

// Throws InputError for an image without R, G, B, a patch outside it, and a scale that no patch
// determines.
[[nodiscard]] PatchScores score_patches(const PatchRequest& request);
[[nodiscard]] nlohmann::ordered_json to_json(const PatchScores& scores);

}  // namespace aphotic
