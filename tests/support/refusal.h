// SPDX-License-Identifier: BSD-3-Clause
//
// What is said of input that is refused.
#pragma once

#include "base/error.h"

#include <string>

namespace aphotic {

// "nothing was said" where the work accepts its input.
template <typename Work>
std::string refusal_of(const Work& work) {
    try {
        work();
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing was said";
}

}  // namespace aphotic
