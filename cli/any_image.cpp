// SPDX-License-Identifier: BSD-3-Clause
#include "cli/any_image.h"

#include "spectral/error.h"

#include <dlfcn.h>
#include <fmt/format.h>

namespace aphotic::cli {

AnyImage open_any_image(const std::filesystem::path& file) {
    using Open = void (*)(const std::filesystem::path&, AnyImage&);
    // Found through the command's own run path; stays loaded, for the images hold on to it.
    static void* const kPart = ::dlopen("aphotic_any_image.so", RTLD_NOW | RTLD_LOCAL);
    if (kPart == nullptr) {
        throw RunError(fmt::format("the part that reads images cannot be loaded: {}", ::dlerror()));
    }
    const auto open = reinterpret_cast<Open>(::dlsym(kPart, "aphotic_open_any_image"));
    if (open == nullptr) throw RunError("aphotic_any_image.so is not of this version");
    AnyImage image;
    open(file, image);
    return image;
}

}  // namespace aphotic::cli
