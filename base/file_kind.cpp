// SPDX-License-Identifier: BSD-3-Clause
#include "base/file_kind.h"

#include <array>

namespace aphotic {
namespace {

using namespace std::string_view_literals;

struct Signature {
    std::string_view bytes;
    std::string_view kind;
};

// From the formats' own documents; \0 is part of some.
constexpr std::array kSignatures{
    Signature{"\xFF\xFE"sv, "text in UTF-16"},
    Signature{"\xFE\xFF"sv, "text in UTF-16"},
    Signature{"\x89PNG"sv, "a PNG image"},
    Signature{"\xFF\xD8\xFF"sv, "a JPEG image"},
    Signature{"II*\0"sv, "a TIFF image"},
    Signature{"MM\0*"sv, "a TIFF image"},
    Signature{"II+\0"sv, "a TIFF image"},
    Signature{"MM\0+"sv, "a TIFF image"},
    Signature{"\x76\x2f\x31\x01"sv, "an OpenEXR image"},
    Signature{"%PDF-"sv, "a PDF document"},
    Signature{"PK\x03\x04"sv, "a zip archive, such as .xlsx, .ods or .npz"},
    Signature{"\xD0\xCF\x11\xE0"sv, "an old Office document, such as .xls"},
    Signature{"\x1F\x8B"sv, "a gzip archive"},
    Signature{"\xFD"
              "7zXZ"sv,
              "an xz archive"},
    Signature{"\x28\xB5\x2F\xFD"sv, "a zstd archive"},
    Signature{"\x93NUMPY"sv, "a NumPy array (.npy)"},
    Signature{"MATLAB 5.0 MAT-file"sv, "a MATLAB file (.mat)"},
    Signature{"\x89HDF"sv, "an HDF5 file, such as .mat or .nc"},
    Signature{"CDF\x01"sv, "a NetCDF file"},
    Signature{"CDF\x02"sv, "a NetCDF file"},
    Signature{"SQLite format 3\0"sv, "an SQLite database"},
    Signature{"\x80\x02"sv, "a pickle of Python"},
    Signature{"\x80\x03"sv, "a pickle of Python"},
    Signature{"\x80\x04"sv, "a pickle of Python"},
    Signature{"\x80\x05"sv, "a pickle of Python"},
    Signature{"\x7F"
              "ELF"sv,
              "a program"}};

}  // namespace

std::string_view binary_kind(std::string_view bytes) {
    for (const auto& [start, kind] : kSignatures) {
        if (bytes.starts_with(start)) return kind;
    }
    return {};
}

}  // namespace aphotic
