// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/design_files.h"

#include "base/atomic_file.h"
#include "base/degrees.h"
#include "base/json_text.h"
#include "base/words.h"

#include <nlohmann/json.hpp>

#include <string>

namespace aphotic {
namespace {

namespace fs = std::filesystem;
using DesignJson = nlohmann::ordered_json;

DesignJson degrees(const Ends& ends_rad) {
    return {ends_rad[0] * kDegreesPerRadian, ends_rad[1] * kDegreesPerRadian};
}

DesignJson numbers_of(const LightFigures& figures, const LightFigures& start) {
    return {{"evenness", figures.evenness},
            {"diversity", figures.diversity},
            {"coverage", figures.coverage},
            {"signal_to_noise", figures.signal_to_noise},
            {"signal_to_noise_of_start", figures.signal_to_noise / start.signal_to_noise}};
}

DesignJson numbers_of(const Rig& rig, const Design& design, const LightFigures& start) {
    DesignJson json{{"worst", numbers_of(design.figures, start)}};
    for (std::size_t s = 0; s < design.places.size(); ++s) {
        const auto& [position_m, axis, power] = design.places[s];
        json["strobes"].push_back({{"name", rig.strobes[s].name},
                                   {"position_m", {position_m.x(), position_m.y(), position_m.z()}},
                                   {"direction", {axis.x(), axis.y(), axis.z()}},
                                   {"power_of_start", power / rig.strobes[s].power}});
        // A strobe may have no power, at the start and afterwards.
        if (rig.strobes[s].power == 0.0) json["strobes"].back()["power_of_start"] = nullptr;
    }
    for (const auto& [sled, figures] : design.poses) {
        DesignJson pose{{"altitude_m", sled.altitude_m},
                        {"pitch_deg", sled.pitch_rad * kDegreesPerRadian},
                        {"roll_deg", sled.roll_rad * kDegreesPerRadian}};
        pose.update(numbers_of(figures, start));
        json["poses"].push_back(std::move(pose));
    }
    return json;
}

}  // namespace

DesignJson design_json(const Rig& rig, const DesignRequest& request, const DesignResult& result) {
    const LightFigures& start = result.start.figures;
    DesignJson json{{"title", rig.title},
                    {"rig_sha256", rig.digest},
                    {"vary", request.freedom.keys},
                    {"within_m", request.freedom.within_m},
                    {"boxes", request.freedom.boxes},
                    {"turn_deg", request.freedom.turn_rad / kRadiansPerDegree},
                    {"altitude_m", request.envelope.altitude_m},
                    {"pitch_deg", degrees(request.envelope.pitch_rad)},
                    {"roll_deg", degrees(request.envelope.roll_rad)},
                    {"goal", name_of(kDesignGoals, request.goal)},
                    {"keep", request.keep},
                    {"coverage_level", request.level},
                    {"seed", request.seed},
                    {"free_numbers", result.numbers},
                    {"evaluations", result.evaluations},
                    {"better_than_start", result.is_better},
                    {"start", numbers_of(rig, result.start, start)},
                    {"design", numbers_of(rig, result.best, start)},
                    {"front", DesignJson::array()}};
    for (const Design& one : result.front) json["front"].push_back(numbers_of(rig, one, start));
    return json;
}

void write_design(const RigText& text,
                  const DesignRequest& request,
                  const DesignResult& result,
                  const fs::path& folder) {
    const Rig rig = text.rig();
    text.copy_files(folder);
    write_text_file(folder / kDesignNumbers, json_text(design_json(rig, request, result)));
    write_text_file(folder / kDesignPage, design_html(rig, request, result));
    write_text_file(folder / kDesignedRig, result.best.toml);
}

}  // namespace aphotic
