// SPDX-License-Identifier: BSD-3-Clause
//
// A file system that knows no locks, for a command that is started with this as LD_PRELOAD.
#include <cerrno>

// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int flock(int /*descriptor*/, int /*operation*/) {
    errno = ENOLCK;
    return -1;
}
