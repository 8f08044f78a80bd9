// SPDX-License-Identifier: BSD-3-Clause
#include "image/png_frame.h"

#include "base/error.h"
#include "image/any_image.h"
#include "image/exr.h"

#include <algorithm>
#include <string>
#include <vector>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

AnyImage open_png(const fs::path& file) {
    if (!fs::exists(file)) throw RunError("POV-Ray exited normally without an image");
    try {
        return open_any_image(file);
    } catch (const InputError& error) {
        throw RunError("{}", error.what());
    }
}

}  // namespace

void exr_of_png_frame(const fs::path& file, White white) {
    const fs::path png_file = file.string() + ".png";
    const AnyImage png = open_png(png_file);
    const std::vector<float> samples = png.planes();
    if (png.channels != std::vector<std::string>{"R", "G", "B"})
        throw RunError("{}: found channels other than R, G and B", png_file.string());
    if (white == White::IsClipped && std::ranges::max(samples) >= 1.0F) {
        throw RunError(
            "a pixel is brighter than a 16-bit PNG can hold; allowed: --frame-format exr, which "
            "keeps highlights");
    }
    write_exr(file, png.width_px, png.height_px, png.channels, samples);
    fs::remove(png_file);
}

}  // namespace aphotic
