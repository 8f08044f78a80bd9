// SPDX-License-Identifier: BSD-3-Clause
//
// What is said of input that is refused, and of what the file system refuses; kAccepted of what is
// done.
#pragma once

#include "base/error.h"

#include <string>

namespace aphotic {

inline constexpr const char* kAccepted = "nothing was said";

template <typename Error, typename Work>
std::string error_of(const Work& work) {
    try {
        work();
    } catch (const Error& error) {
        return error.what();
    }
    return kAccepted;
}

template <typename Work>
std::string refusal_of(const Work& work) {
    return error_of<InputError>(work);
}

template <typename Work>
std::string run_error_of(const Work& work) {
    return error_of<RunError>(work);
}

}  // namespace aphotic
