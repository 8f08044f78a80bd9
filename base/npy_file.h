// SPDX-License-Identifier: BSD-3-Clause
//
// Arrays as numpy.load() reads them: the format .npy, written as version 1.0, of little-endian
// floats (<f4) in C's order, the last index fastest.
//
//   \x93NUMPY 1 0, the length of the header in 2 bytes, the header: a dictionary of Python's with
//   descr, fortran_order and shape, padded with blanks and ended with a newline so that the samples
//   begin at a multiple of 64 bytes
//
// numpy.org/doc/stable/reference/generated/numpy.lib.format.html.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace aphotic {

// The number of samples must be that of the shape's elements. The file is complete or absent.
void write_npy(const std::filesystem::path& path,
               const std::vector<std::size_t>& shape,
               std::span<const float> samples);

// Real numbers, little-endian, in either order; returned in C's order. Otherwise an InputError that
// names the file.
struct NpyArray {
    std::vector<std::size_t> shape{};
    std::vector<float> samples{};
};
[[nodiscard]] NpyArray read_npy(const std::filesystem::path& path);

}  // namespace aphotic
