// SPDX-License-Identifier: BSD-3-Clause
//
// Which channels of two images are compared, and what becomes of the others: none is passed over in
// silence. Partners have one name, or are one quantity at one wavelength whatever its spelling
// (spectral/channel_wavelength.h). A channel that the other image lacks has no partner, unless it
// is one of these, which are left aside: opacity (A, alpha), and what `aphotic observe` says of its
// averages (count.NAME, stderr.NAME).
#pragma once

#include <string>
#include <vector>

namespace aphotic {

struct ChannelPair {
    std::string image;  // its name there
    std::string reference;
};

struct ChannelPairs {
    std::vector<ChannelPair> compared;
    std::vector<std::string> only_in_image;
    std::vector<std::string> only_in_reference;
    std::vector<std::string> left_aside;
};

// scaled: one factor cannot scale counts and standard errors as well, so these are left aside.
[[nodiscard]] ChannelPairs pair_channels(const std::vector<std::string>& image,
                                         const std::vector<std::string>& reference,
                                         bool scaled);

// Those that the user names, as either image has them, separated by commas. A name may hold commas
// itself, as S0.550,000000nm does. Throws InputError when one is not in both images, or none is
// named.
[[nodiscard]] ChannelPairs named_channels(const std::string& names,
                                          const std::vector<std::string>& image,
                                          const std::vector<std::string>& reference);

}  // namespace aphotic
