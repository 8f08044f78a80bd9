// SPDX-License-Identifier: BSD-3-Clause
#include "survey/simulate/image_truth.h"

#include "base/atomic_file.h"
#include "base/parallel.h"
#include "image/exr.h"
#include "survey/light_at.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <string>

namespace aphotic {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSeenPlanes = 7;  // Z, then the normal, then R, G, B
using SeenPixel = std::array<float, kSeenPlanes>;

struct Kind {
    const char* name;
    std::vector<std::string> channels;
    std::size_t first_plane;
    bool is_asked;
};

std::vector<Kind> kinds_asked(const TruthAsked& asked) {
    std::vector<Kind> kinds{
        {.name = "depth", .channels = {"Z"}, .first_plane = 0, .is_asked = asked.depth},
        {.name = "normals",
         .channels = {"N.X", "N.Y", "N.Z"},
         .first_plane = 1,
         .is_asked = asked.normals},
        {.name = "reflectance",
         .channels = {"R", "G", "B"},
         .first_plane = 4,
         .is_asked = asked.reflectance}};
    std::erase_if(kinds, [](const Kind& kind) { return !kind.is_asked; });
    return kinds;
}

// Of the floor, then the objects.
std::vector<PerChannel> colours_of(Rig rig) {
    std::vector<PerChannel> colours{floor_colour(rig)};
    for (const Object& object : rig.objects) {
        rig.seafloor.reflectance = object.reflectance;
        colours.push_back(floor_colour(rig));
    }
    return colours;
}

SeenPixel pixel_of(const std::optional<SeenPoint>& seen,
                   const std::vector<PerChannel>& colours,
                   float texture) {
    SeenPixel pixel{};
    pixel.fill(std::numeric_limits<float>::quiet_NaN());
    if (!seen) return pixel;
    const auto& [point_m, normal, surface] = *seen;
    const PerChannel& colour = colours.at(surface);
    const double shown = surface == 0 ? double{texture} : 1.0;
    const std::array<double, kSeenPlanes> exact{point_m.z(),
                                                normal.y(),
                                                -normal.x(),
                                                normal.z(),
                                                shown * colour[0],
                                                shown * colour[1],
                                                shown * colour[2]};
    std::ranges::transform(
        exact, pixel.begin(), [](double value) { return static_cast<float>(value); });
    return pixel;
}

void write_seen_of(const SimulatedSurvey& survey,
                   const Leg& leg,
                   const std::vector<Kind>& kinds,
                   const std::vector<PerChannel>& colours,
                   const Sight& sight) {
    const Camera& camera = survey.rig.camera;
    const auto width = static_cast<std::size_t>(camera.width_px);
    const std::size_t plane = width * static_cast<std::size_t>(camera.height_px);
    std::vector<float> samples(kSeenPlanes * plane);
    std::vector<float> texture(plane, 1.0F);
    if (survey.texture > 0.0)
        texture = ExrReader(file_of(survey, "texture", leg)).planes(std::vector<std::string>{"Y"});
    for (std::size_t i = 0; i < plane; ++i) {
        const std::size_t column = i % width;
        const std::size_t row = i / width;
        const auto seen = sight(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
        const SeenPixel pixel = pixel_of(seen, colours, texture[i]);
        for (std::size_t p = 0; p < kSeenPlanes; ++p) samples[p * plane + i] = pixel[p];
    }
    for (const Kind& kind : kinds) {
        write_exr(
            file_of(survey, kind.name, leg),
            camera.width_px,
            camera.height_px,
            kind.channels,
            std::span(samples).subspan(kind.first_plane * plane, kind.channels.size() * plane));
    }
}

}  // namespace

void write_seen(const SimulatedSurvey& survey, const std::function<Sight(const Sled&)>& sight_at) {
    const std::vector<Kind> kinds = kinds_asked(survey.truth);
    if (kinds.empty()) return;
    for (const Kind& kind : kinds) make_folder(survey.folder / kind.name);
    const std::vector<PerChannel> colours = colours_of(survey.rig);
    const auto jobs = static_cast<std::size_t>(survey.jobs);
    parallel_for(survey.legs.size(), jobs, [&](std::size_t i, std::size_t) {
        const Leg& leg = survey.legs[i];
        std::vector<Kind> missing = kinds;
        std::erase_if(
            missing, [&](const Kind& kind) { return fs::exists(file_of(survey, kind.name, leg)); });
        if (!missing.empty()) write_seen_of(survey, leg, missing, colours, sight_at(leg.sled));
    });
}

}  // namespace aphotic
