// SPDX-License-Identifier: BSD-3-Clause
#include "image/any_image_part.h"

#include "base/error.h"

#include <dlfcn.h>

namespace aphotic {

void* function_of_part(const char* name) {
    // Searched along the program's run path, then at the installed place; never unloaded, since
    // images refer to it.
    static void* const kPart = [] {
        void* part = ::dlopen("aphotic_any_image.so", RTLD_NOW | RTLD_LOCAL);
        return part != nullptr
                   ? part
                   : ::dlopen(APHOTIC_PARTS "/aphotic_any_image.so", RTLD_NOW | RTLD_LOCAL);
    }();
    if (kPart == nullptr) {
        throw RunError("cannot load the image reader: {}", ::dlerror());
    }
    void* const function = ::dlsym(kPart, name);
    if (function == nullptr) throw RunError("aphotic_any_image.so is of another version");
    return function;
}

}  // namespace aphotic
