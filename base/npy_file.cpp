// SPDX-License-Identifier: BSD-3-Clause
#include "base/npy_file.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/number.h"
#include "base/number_bytes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numeric>
#include <regex>
#include <string>

namespace aphotic {

namespace {

constexpr std::string_view kMagic{"\x93NUMPY", 6};

// By descr, without the byte order's sign.
struct NumberType {
    std::string_view descr;
    std::size_t bytes;
    float (*at)(const void* bytes);
};
constexpr std::array kNumberTypes{NumberType{"f4", 4, number_at<float, float>},
                                  NumberType{"f8", 8, number_at<double, float>},
                                  NumberType{"u1", 1, number_at<std::uint8_t, float>},
                                  NumberType{"u2", 2, number_at<std::uint16_t, float>},
                                  NumberType{"i2", 2, number_at<std::int16_t, float>},
                                  NumberType{"u4", 4, number_at<std::uint32_t, float>},
                                  NumberType{"i4", 4, number_at<std::int32_t, float>}};

// The header's text, and where the samples start. Version 1 stores its length in two bytes, later
// versions in four.
std::pair<std::string, std::size_t> header_of(const std::string& file) {
    constexpr std::size_t kVersion = 6;
    constexpr std::size_t kLength = 8;
    if (!file.starts_with(kMagic) || file.size() < kLength + 4) return {};
    const std::size_t bytes = file[kVersion] == 1 ? 2 : 4;
    std::size_t length = 0;
    for (std::size_t k = 0; k < bytes; ++k)
        length |= std::size_t{static_cast<unsigned char>(file[kLength + k])} << (8 * k);
    const std::size_t start = kLength + bytes + length;
    if (start > file.size()) return {};
    return {file.substr(kLength + bytes, length), start};
}

// From first index fastest to last index fastest.
std::vector<float> in_rows(const std::vector<float>& columns,
                           const std::vector<std::size_t>& shape) {
    std::vector<float> rows(columns.size());
    for (std::size_t n = 0; n < columns.size(); ++n) {
        std::size_t rest = n;
        std::size_t place = 0;
        std::size_t stride = columns.size();
        for (const std::size_t side : shape) {
            stride /= side;
            place += rest % side * stride;
            rest /= side;
        }
        rows[place] = columns[n];
    }
    return rows;
}

}  // namespace

NpyArray read_npy(const std::filesystem::path& path) {
    static const std::regex kDescr(R"('descr':\s*'[<|]([fui][1248])')");
    static const std::regex kShape(R"('shape':\s*\(([0-9, ]*)\))");
    const std::string file = read_text_file(path);
    const auto [header, start] = header_of(file);
    std::smatch descr;
    std::smatch shape;
    const bool is_known =
        std::regex_search(header, descr, kDescr) && std::regex_search(header, shape, kShape);
    const auto* const type = std::ranges::find_if(kNumberTypes, [&](const NumberType& one) {
        return is_known && one.descr == descr[1].str();
    });
    if (type == kNumberTypes.end())
        throw InputError("{}: found {}; allowed: a NumPy array of little-endian real numbers",
                         path.string(),
                         is_known ? "numbers of the type " + descr[1].str() : "no such array");
    NpyArray array;
    const std::string sides = shape[1];
    static const std::regex kNumber("[0-9]+");
    for (std::sregex_iterator side(sides.begin(), sides.end(), kNumber), end; side != end; ++side)
        array.shape.push_back(read_number<std::size_t>(side->str()).value_or(0));
    const std::size_t count = std::accumulate(
        array.shape.begin(), array.shape.end(), std::size_t{1}, std::multiplies<>{});
    if (count * type->bytes != file.size() - start)
        throw InputError("{}: found {} bytes of samples; allowed: {} for the shape ({})",
                         path.string(),
                         file.size() - start,
                         count * type->bytes,
                         sides);
    for (std::size_t n = 0; n < count; ++n)
        array.samples.push_back(type->at(file.data() + start + n * type->bytes));
    static const std::regex kFortran(R"('fortran_order':\s*True)");
    if (std::regex_search(header, kFortran)) array.samples = in_rows(array.samples, array.shape);
    return array;
}

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
    std::string file(kMagic);
    file.append("\x01\x00", 2);
    file += static_cast<char>(header.size() % 256);
    file += static_cast<char>(header.size() / 256);
    file += header;
    file.append(reinterpret_cast<const char*>(samples.data()), samples.size_bytes());
    write_text_file(path, file);
}

}  // namespace aphotic
