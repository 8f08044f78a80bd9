// SPDX-License-Identifier: BSD-3-Clause
//
// What every target of the fuzzers holds a reader to: it takes the bytes, or it throws an
// InputError whose message is one line that begins with the file's name. Anything else that comes
// out of it, and what a sanitizer finds on the way, ends the program.
//
// libFuzzer calls a target with bytes that it makes up. replay.cpp calls it with those of files, so
// that the suite holds every build to what was ever found.
#pragma once

#include "base/error.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace aphotic {

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

template <typename Read>
void expect_result_or_placed_error(std::string_view file_name, Read read) {
    try {
        read();
    } catch (const InputError& error) {
        const std::string_view message = error.what();
        const bool is_placed = message.starts_with(std::string(file_name) + ":");
        if (is_placed && message.find('\n') == std::string_view::npos) return;
        std::fprintf(
            stderr, "fuzz: a message without a place, or of many lines: %s\n", error.what());
        std::abort();
    }
}

}  // namespace aphotic
