// SPDX-License-Identifier: BSD-3-Clause
//
// The samples of a .npy file of floats, by what its format says alone: they follow the header,
// whose length stands in its ninth and tenth byte.
#pragma once

#include "base/atomic_file.h"

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

namespace aphotic {

inline std::vector<float> npy_samples(const std::filesystem::path& file) {
    const std::string bytes = read_text_file(file);
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes.at(i)); };
    const std::size_t start = 10U + byte(8) + 256U * byte(9);
    std::vector<float> samples((bytes.size() - start) / sizeof(float));
    std::memcpy(samples.data(), bytes.data() + start, samples.size() * sizeof(float));
    return samples;
}

}  // namespace aphotic
