// SPDX-License-Identifier: BSD-3-Clause
#include "image/height_grid.h"

#include "base/error.h"
#include "image/any_image_part.h"

namespace aphotic {

HeightGrid read_height_grid(const std::filesystem::path& file) {
    using Read = void (*)(const std::filesystem::path&, HeightGrid&);
    HeightGrid grid;
    naming(file.string(), [&] { from_part<Read>("aphotic_read_height_grid")(file, grid); });
    return grid;
}

}  // namespace aphotic
