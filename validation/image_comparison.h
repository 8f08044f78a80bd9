// SPDX-License-Identifier: BSD-3-Clause
//
// The difference between an image and its reference, channel by channel, both of any format.
//
//   e = (a / scale - b) / max(|b|, black * largest |b|)
//
// a, b   samples of image and reference, of channels of the same quantity
// scale  1, or the factor that fits the image to the reference best (scaling.h)
//
// Samples that either image records as never observed (count.NAME of 0) are not compared.
//
// No channel is skipped silently. Channels with the same name are compared, and those with the same
// quantity and wavelength in any spelling (spectral/channel_wavelength.h). Any other is reported as
// having no partner, except those that need none: opacity (A, alpha), and counts and standard
// errors from `aphotic observe` (count.NAME, stderr.NAME).
#pragma once

#include "validation/comparison_page.h"

#include <filesystem>
#include <optional>
#include <string>

namespace aphotic {

enum class ComparedScale { None, OfImage, OfEachChannel };

struct ComparisonRequest {
    std::string image;
    std::string reference;
    double bound = 6e-4;                  // of |e|
    double black = 1e-6;                  // as a share of the reference's largest sample
    std::optional<std::string> channels;  // named by the user; empty: all
    ComparedScale scale = ComparedScale::None;
    bool keep_samples = false;  // for a page; otherwise only one channel is in memory
};

// Throws InputError for images that cannot be compared.
[[nodiscard]] ComparedImages compare_images(const ComparisonRequest& request);

}  // namespace aphotic
