// SPDX-License-Identifier: BSD-3-Clause
//
// The libraries as a Python module: rig in, arrays out. Computations release the interpreter's
// lock; invalid input is an aphotic.InputError with the command's own message.
//
// Images are arrays of rows, columns, channels. Ours are planes one after another, and such an
// array is a view of them: no sample is copied.
#pragma once

#include "lightmap/lightmap.h"
#include "rig/file/rig_text.h"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::python {

namespace nb = nanobind;

// A rig with its text, so that keys can be set.
struct TextRig {
    explicit TextRig(RigText its_text) : text(std::move(its_text)), rig(text.rig()) {}
    RigText text;
    Rig rig;
};

struct RigLightmap {
    std::shared_ptr<const Rig> rig;  // with the map's sled
    Lightmap map;
    std::map<std::string, RigLightmap> strobes{};
};

template <typename Sample, std::size_t kDimensions>
using Array = nb::ndarray<nb::numpy, Sample, nb::ndim<kDimensions>>;

// owner: the owner of the samples.
template <typename Sample>
Array<Sample, 3> image_of_planes(
    Sample* planes, int height_px, int width_px, std::size_t count, nb::handle owner) {
    const auto height = static_cast<std::size_t>(height_px);
    const auto width = static_cast<std::size_t>(width_px);
    return Array<Sample, 3>(planes,
                            {height, width, count},
                            owner,
                            {static_cast<std::int64_t>(width),
                             std::int64_t{1},
                             static_cast<std::int64_t>(height * width)});
}

// For a property whose array is not a view of the object.
inline constexpr auto kOwn = nb::rv_policy::automatic;

// A new owner, and its samples.
template <typename Sample>
std::pair<Sample*, nb::capsule> owned(std::vector<Sample> samples) {
    auto held = std::make_unique<std::vector<Sample>>(std::move(samples));
    Sample* const data = held->data();
    nb::capsule owner(held.get(),
                      [](void* p) noexcept { delete static_cast<std::vector<Sample>*>(p); });
    static_cast<void>(held.release());
    return {data, std::move(owner)};
}

template <typename Sample>
Array<Sample, 3> image_of(std::vector<Sample> planes, int height_px, int width_px) {
    const std::size_t pixels =
        static_cast<std::size_t>(height_px) * static_cast<std::size_t>(width_px);
    const std::size_t count = planes.size() / pixels;
    auto [data, owner] = owned(std::move(planes));
    return image_of_planes(data, height_px, width_px, count, owner);
}

template <typename Sample>
Array<Sample, 2> table_of(std::vector<Sample> rows, std::size_t columns) {
    const std::size_t count = columns == 0 ? 0 : rows.size() / columns;
    auto [data, owner] = owned(std::move(rows));
    return Array<Sample, 2>(data, {count, columns}, owner);
}

template <typename Sample>
Array<Sample, 1> list_of(std::vector<Sample> values) {
    const std::size_t count = values.size();
    auto [data, owner] = owned(std::move(values));
    return Array<Sample, 1>(data, {count}, owner);
}

// An InputError that names the argument.
void require_range(const char* name, double value, double least, double most);
// 0: one for each core.
[[nodiscard]] int threads_of(int threads);

void bind_rig(nb::module_& module);
void bind_light(nb::module_& module);
void bind_survey(nb::module_& module);

}  // namespace aphotic::python
