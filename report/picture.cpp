// SPDX-License-Identifier: BSD-3-Clause
#include "report/picture.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <cstddef>
#include <vector>

namespace aphotic {

std::string data_uri(std::string_view picture, std::string_view type) {
    std::vector<unsigned char> base64(4 * ((picture.size() + 2) / 3) + 1);  // and a closing 0
    const int length = EVP_EncodeBlock(base64.data(),
                                       reinterpret_cast<const unsigned char*>(picture.data()),
                                       static_cast<int>(picture.size()));
    return fmt::format("data:{};base64,", type) +
           std::string(base64.begin(), base64.begin() + static_cast<std::ptrdiff_t>(length));
}

std::string picture_html(std::string_view picture,
                         int width_px,
                         int height_px,
                         std::string_view words,
                         std::string_view type) {
    constexpr int kSmall_px = 400;
    const bool shows_pixels = width_px < kSmall_px && type == kPng;
    return fmt::format(R"(<img class="picture{}" width="{}" height="{}" alt="{}" src="{}"/>)",
                       shows_pixels ? " squares" : "",
                       width_px,
                       height_px,
                       words,
                       data_uri(picture, type));
}

}  // namespace aphotic
