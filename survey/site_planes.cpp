// SPDX-License-Identifier: BSD-3-Clause
#include "survey/site_planes.h"

#include "image/image_size.h"

#include <cstddef>

namespace aphotic {
namespace {

// Where a plane's sites are in the image's samples.
struct Sites {
    std::size_t step = 1;  // from one to the next, across and down
    std::size_t first_column = 0;
    std::size_t first_row = 0;
    std::size_t origin = 0;  // of the plane that holds them

    // Calls visit(index in the plane, index in the image) for each, row by row.
    template <typename Visit>
    void for_each(const RawImage& image, const Visit& visit) const {
        const std::size_t width = size_of(image.width_px);
        std::size_t site = 0;
        for (std::size_t row = first_row; row < size_of(image.height_px); row += step) {
            for (std::size_t column = first_column; column < width; column += step)
                visit(site++, origin + row * width + column);
        }
    }
};

Sites sites_of_plane(const RawImage& image, std::size_t plane) {
    if (!is_bayer(image.mosaic)) return {.origin = plane * image.pixels()};
    return {.step = 2, .first_column = plane % 2, .first_row = plane / 2};
}

}  // namespace

std::vector<SitePlane> site_planes(const RawImage& image) {
    std::vector<SitePlane> planes(is_bayer(image.mosaic) ? 4 : size_of(image.planes()));
    for (std::size_t p = 0; p < planes.size(); ++p) {
        const Sites sites = sites_of_plane(image, p);
        const auto count = [&](int pixels, std::size_t first) {
            return static_cast<int>((size_of(pixels) - first + sites.step - 1) / sites.step);
        };
        planes[p].width_px = count(image.width_px, sites.first_column);
        planes[p].height_px = count(image.height_px, sites.first_row);
        planes[p].samples.resize(size_of(planes[p].width_px) * size_of(planes[p].height_px));
        sites.for_each(image, [&](std::size_t site, std::size_t at) {
            planes[p].samples[site] = image.samples[at];
        });
    }
    return planes;
}

void put_site_planes(const std::vector<SitePlane>& planes, RawImage& image) {
    for (std::size_t p = 0; p < planes.size(); ++p) {
        const auto put = [&](std::size_t site, std::size_t at) {
            image.samples[at] = planes[p].samples[site];
        };
        sites_of_plane(image, p).for_each(image, put);
    }
}

}  // namespace aphotic
