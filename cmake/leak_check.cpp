// SPDX-License-Identifier: BSD-3-Clause
//
// Where the leak sanitizer shall not look. The name is its own.
#include <link.h>

#include <cstddef>
#include <cstring>

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
