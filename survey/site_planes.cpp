// SPDX-License-Identifier: BSD-3-Clause
#include "survey/site_planes.h"

#include <cstddef>

namespace aphotic {
namespace {

// Where the planes of an image begin in its samples, and how far apart its sites are.
struct SiteLayout {
    std::size_t planes = 0;
    std::size_t step = 1;
};

SiteLayout layout_of(const RawImage& image) {
    return image.mosaic == Mosaic::None ? SiteLayout{.planes = kChannels, .step = 1}
                                        : SiteLayout{.planes = 4, .step = 2};
}

// Calls visit(index in the plane, index in the image) for every sample of the plane.
template <typename Visit>
void for_each_site(const RawImage& image, std::size_t plane, const Visit& visit) {
    const std::size_t step = layout_of(image).step;
    const auto width = static_cast<std::size_t>(image.width_px);
    const auto height = static_cast<std::size_t>(image.height_px);
    const std::size_t origin = step == 1 ? plane * width * height : 0;
    const std::size_t first_row = step == 1 ? 0 : plane / 2;
    const std::size_t first_column = step == 1 ? 0 : plane % 2;
    std::size_t site = 0;
    for (std::size_t row = first_row; row < height; row += step) {
        for (std::size_t column = first_column; column < width; column += step)
            visit(site++, origin + row * width + column);
    }
}

}  // namespace

std::vector<SitePlane> site_planes(const RawImage& image) {
    const SiteLayout layout = layout_of(image);
    const int step = static_cast<int>(layout.step);
    std::vector<SitePlane> planes(layout.planes);
    for (std::size_t p = 0; p < planes.size(); ++p) {
        const int first_column = step == 1 ? 0 : static_cast<int>(p % 2);
        const int first_row = step == 1 ? 0 : static_cast<int>(p / 2);
        planes[p].width_px = (image.width_px - first_column + step - 1) / step;
        planes[p].height_px = (image.height_px - first_row + step - 1) / step;
        planes[p].samples.resize(static_cast<std::size_t>(planes[p].width_px) *
                                 static_cast<std::size_t>(planes[p].height_px));
        for_each_site(image, p, [&](std::size_t site, std::size_t at) {
            planes[p].samples[site] = image.samples[at];
        });
    }
    return planes;
}

void put_site_planes(const std::vector<SitePlane>& planes, RawImage& image) {
    for (std::size_t p = 0; p < planes.size(); ++p) {
        for_each_site(image, p, [&](std::size_t site, std::size_t at) {
            image.samples[at] = planes[p].samples[site];
        });
    }
}

}  // namespace aphotic
