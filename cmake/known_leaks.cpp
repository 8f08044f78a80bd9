// SPDX-License-Identifier: BSD-3-Clause
//
// Leaks that the leak sanitizer shall not report. Cairo keeps the fonts it has found for the
// next text, and fontconfig offers no way to free them that is safe while Cairo is in use.

// The name is the sanitizer's.
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libfontconfig";
}
