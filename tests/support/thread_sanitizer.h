// SPDX-License-Identifier: BSD-3-Clause
//
// What clang's thread sanitizer changes for a test: signals of a process, and pthread_create, which
// is its own.
#pragma once

#include <sys/wait.h>

#ifdef __has_feature
#if __has_feature(thread_sanitizer)
#define APHOTIC_THREAD_SANITIZER
#endif
#endif

namespace aphotic {

#ifdef APHOTIC_THREAD_SANITIZER
inline constexpr bool kHasThreadSanitizer = true;
#else
inline constexpr bool kHasThreadSanitizer = false;
#endif

// By a status of waitpid(). The sanitizer blocks signals in handlers, so a process that would end
// by one may end by the status that shells use.
[[nodiscard]] inline bool is_ended_by(int status, int signal) {
    constexpr int kShellsOffset = 128;
    if (WIFSIGNALED(status)) return WTERMSIG(status) == signal;
    return kHasThreadSanitizer && WEXITSTATUS(status) == kShellsOffset + signal;
}

}  // namespace aphotic
