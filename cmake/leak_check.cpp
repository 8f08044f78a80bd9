// SPDX-License-Identifier: BSD-3-Clause
//
// What the leak sanitizer shall not report, and where it shall not look. Both names are its own.
#include <link.h>

#include <cstddef>
#include <cstring>

// Cairo keeps the fonts it has found for the next text, and fontconfig offers no way to free them
// that is safe while Cairo is in use.
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libfontconfig";
}

// Of a process whose threads are just ending the sanitizer now and then scans what is no memory,
// and ends it with "Tracer caught signal 11" (https://github.com/google/sanitizers/issues/1353).
// OpenImageIO's threads end with the process: on a busy machine 3 of 800 tests of its commands
// failed. NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int __lsan_is_turned_off() {
    const auto is_openimageio = [](dl_phdr_info* library, std::size_t, void*) {
        return std::strstr(library->dlpi_name, "libOpenImageIO") == nullptr ? 0 : 1;
    };
    return ::dl_iterate_phdr(is_openimageio, nullptr);
}
