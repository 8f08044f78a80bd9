// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/planes.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>
#include <string_view>

namespace aphotic {
namespace {

std::span<const float> plane_of(const Lightmap& map, std::size_t channel) {
    const std::size_t size = map.samples.size() / kChannels;
    return std::span(map.samples).subspan(channel * size, size);
}

std::string cone_name(const std::vector<Beam>& cones, std::size_t k) {
    const std::string& name = cones[k].name;
    const auto bearers = std::ranges::count(cones, name, &Beam::name);
    return name.empty() || bearers > 1 ? fmt::format("cone{}", k + 1) : name;
}

}  // namespace

std::vector<RigPart> parts_by_strobe(const Rig& rig) {
    std::vector<RigPart> parts;
    for (const Strobe& strobe : rig.strobes) {
        parts.push_back({.name = strobe.name, .rig = rig});
        parts.back().rig.strobes = {strobe};
    }
    return parts;
}

std::vector<RigPart> parts_by_cone(const Rig& rig) {
    std::vector<RigPart> parts;
    for (const RigPart& strobe : parts_by_strobe(rig)) {
        const std::vector<Beam> cones = parts_of(strobe.rig.strobes.front().beam);
        for (std::size_t k = 0; k < cones.size(); ++k) {
            parts.push_back({.name = strobe.name + "." + cone_name(cones, k), .rig = strobe.rig});
            parts.back().rig.strobes.front().beam = cones[k];
        }
    }
    return parts;
}

void require_different_names(const std::vector<RigPart>& parts) {
    std::set<std::string> names;
    for (const RigPart& part : parts) {
        if (names.insert(part.name).second) continue;
        throw InputError(
            "strobes: found two parts of the light named {}, of a strobe and a cone or of two "
            "cones; allowed: names that differ",
            part.name);
    }
}

std::vector<std::string> plane_names(const std::string& layer, bool has_veil) {
    std::vector<std::string> names;
    for (const std::string_view of : {"", "veil."}) {
        if (!of.empty() && !has_veil) break;
        for (const std::string_view channel : kChannelNames)
            names.push_back(fmt::format("{}{}{}{}", layer, layer.empty() ? "" : ".", of, channel));
    }
    return names;
}

std::array<float, kChannels> peaks_of(const Lightmap& map) {
    std::array<float, kChannels> peaks{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        const std::span<const float> plane = plane_of(map, c);
        if (!plane.empty()) peaks[c] = *std::ranges::max_element(plane);
    }
    return peaks;
}

void divide_by(const std::array<float, kChannels>& peaks, Lightmap& map) {
    const std::size_t size = map.samples.size() / kChannels;
    for (std::size_t c = 0; c < kChannels; ++c) {
        if (peaks[c] <= 0.0F) continue;
        for (std::vector<float>* planes : {&map.samples, &map.veil}) {
            for (std::size_t i = c * size; i < (c + 1) * size && !planes->empty(); ++i)
                (*planes)[i] /= peaks[c];
        }
    }
}

}  // namespace aphotic
