// SPDX-License-Identifier: BSD-3-Clause
//
// The directory of a TIFF file from any bytes, which go through a file that has no place on a disk.
// Messages do not name the file: what reads it does.
#include "fuzz.h"
#include "image/whole_tiff.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const int kFile = ::memfd_create("tiff", 0);
    if (::ftruncate(kFile, 0) != 0 || ::pwrite(kFile, data, size, 0) != ::ssize_t(size))
        std::abort();
    try {
        aphotic::require_whole_tiff(fmt::format("/proc/self/fd/{}", kFile));
    } catch (const aphotic::InputError& error) {
        if (!std::string_view(error.what()).starts_with("it ")) std::abort();
    }
    return 0;
}
