// SPDX-License-Identifier: BSD-3-Clause
#include "report/picture.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <cstddef>
#include <vector>

namespace aphotic {

std::string data_uri(std::string_view picture, std::string_view type) {
    std::vector<unsigned char> base64(4 * ((picture.size() + 2) / 3) + 1);  // and a terminating 0
    const int length = EVP_EncodeBlock(base64.data(),
                                       reinterpret_cast<const unsigned char*>(picture.data()),
                                       static_cast<int>(picture.size()));
    return fmt::format("data:{};base64,", type) +
           std::string(base64.begin(), base64.begin() + static_cast<std::ptrdiff_t>(length));
}

}  // namespace aphotic
