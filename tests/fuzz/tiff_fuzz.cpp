// SPDX-License-Identifier: BSD-3-Clause
//
// The directory of a TIFF file from any bytes, and the grid of heights that it may hold. They go
// through a file that has no place on a disk. Messages do not name the file: what reads it does.
#include "fuzz.h"
#include "image/height_grid.h"
#include "image/whole_tiff.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

extern "C" void aphotic_read_height_grid(const std::filesystem::path& file,
                                         aphotic::HeightGrid& grid);

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const int kFile = ::memfd_create("tiff", 0);
    if (::ftruncate(kFile, 0) != 0 || ::pwrite(kFile, data, size, 0) != ::ssize_t(size))
        std::abort();
    try {
        const std::string name = fmt::format("/proc/self/fd/{}", kFile);
        aphotic::require_whole_tiff(name);
        aphotic::require_sound_streams(name);
        aphotic::HeightGrid grid;
        aphotic_read_height_grid(name, grid);
    } catch (const aphotic::InputError& error) {
        const std::string_view words = error.what();
        const bool is_said = words.starts_with("it ") || words.starts_with("found ") ||
                             words.starts_with("strip or tile ");
        if (!is_said || words.find('\n') != std::string_view::npos) std::abort();
    }
    return 0;
}
