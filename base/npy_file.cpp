// SPDX-License-Identifier: BSD-3-Clause
#include "base/npy_file.h"

#include "base/atomic_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <cassert>
#include <functional>
#include <numeric>
#include <string>

namespace aphotic {

static_assert(std::endian::native == std::endian::little);  // samples go out as they are

void write_npy(const std::filesystem::path& path,
               const std::vector<std::size_t>& shape,
               std::span<const float> samples) {
    assert(samples.size() ==
           std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>{}));
    constexpr std::size_t kStart_bytes = 10;  // magic, version and length
    constexpr std::size_t kAlignment_bytes = 64;
    std::string header = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({},), }}",
                                     fmt::join(shape, ", "));
    header.resize((kStart_bytes + header.size()) / kAlignment_bytes * kAlignment_bytes +
                      kAlignment_bytes - kStart_bytes,
                  ' ');
    header.back() = '\n';
    std::string file("\x93NUMPY\x01\x00", 8);
    file += static_cast<char>(header.size() % 256);
    file += static_cast<char>(header.size() / 256);
    file += header;
    file.append(reinterpret_cast<const char*>(samples.data()), samples.size_bytes());
    write_text_file(path, file);
}

}  // namespace aphotic
