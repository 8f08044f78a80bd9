// SPDX-License-Identifier: BSD-3-Clause
//
// A frame from any bytes, checked as the frames of POV-Ray are. OpenEXR takes a file by its name,
// so the bytes go through one that has no place on a disk. A bad frame is a RunError.
#include "fuzz.h"
#include "image/frame_check.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

namespace {

constexpr int kSeedWidth_px = 8;
constexpr int kSeedHeight_px = 6;

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const int kFile = ::memfd_create("frame", 0);
    if (::ftruncate(kFile, 0) != 0 || ::pwrite(kFile, data, size, 0) != ::ssize_t(size))
        std::abort();
    const std::string name = fmt::format("/proc/self/fd/{}", kFile);
    try {
        aphotic::check_frame(name, kSeedWidth_px, kSeedHeight_px);
    } catch (const aphotic::RunError& error) {
        if (!std::string_view(error.what()).starts_with(name + ":")) std::abort();
    }
    return 0;
}
