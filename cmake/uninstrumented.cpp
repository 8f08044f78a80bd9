// SPDX-License-Identifier: BSD-3-Clause
//
// What the thread sanitizer shall not look at: OpenEXR, OpenImageIO and zlib come from the system
// without its marks, so it sees their reads and writes and not how they keep them apart.

// The name is the sanitizer's.
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" const char* __tsan_default_options() {
    return "ignore_noninstrumented_modules=1";
}
