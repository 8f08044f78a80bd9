// SPDX-License-Identifier: BSD-3-Clause
//
// A TIFF file opened by libtiff for reading, with libtiff's messages kept instead of printed.
//
// Header only, since the part loaded at run time also uses it.
#pragma once

#include "base/printable.h"
#include "image/decoded_size.h"

#include <tiffio.h>

#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <string>

namespace aphotic {

struct SaidOfTiff {
    std::string error;              // the first message
    bool has_false_counts = false;  // of bytes, which libtiff replaced by estimates
};

struct CloseTiff {
    void operator()(TIFF* tiff) const { ::TIFFClose(tiff); }
};
using TiffHandle = std::unique_ptr<TIFF, CloseTiff>;

inline int note_tiff_error(
    TIFF* /*tiff*/, void* said, const char*, const char* format, std::va_list with) {
    constexpr std::size_t kMost = 300;
    std::array<char, kMost> text{};
    static_cast<void>(std::vsnprintf(text.data(), text.size(), format, with));
    std::string& error = static_cast<SaidOfTiff*>(said)->error;
    if (error.empty()) error = printable(text.data());
    return 1;
}

inline int note_tiff_warning(
    TIFF* /*tiff*/, void* said, const char*, const char* format, std::va_list) {
    constexpr const char* kMadeUp = "calculating from imagelength";
    if (std::strstr(format, kMadeUp) != nullptr)
        static_cast<SaidOfTiff*>(said)->has_false_counts = true;
    return 1;
}

// Null if it cannot be opened. `said` must outlive it; mode: TIFFOpen's.
inline TiffHandle open_tiff(const std::filesystem::path& file, const char* mode, SaidOfTiff& said) {
    constexpr auto kMost_bytes = static_cast<tmsize_t>(256 * kMebi);
    const std::unique_ptr<TIFFOpenOptions, decltype(&::TIFFOpenOptionsFree)> options(
        ::TIFFOpenOptionsAlloc(), &::TIFFOpenOptionsFree);
    if (!options) throw std::bad_alloc();
    ::TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kMost_bytes);
    ::TIFFOpenOptionsSetErrorHandlerExtR(options.get(), note_tiff_error, &said);
    ::TIFFOpenOptionsSetWarningHandlerExtR(options.get(), note_tiff_warning, &said);
    return TiffHandle(::TIFFOpenExt(file.c_str(), mode, options.get()));
}

}  // namespace aphotic
