// SPDX-License-Identifier: BSD-3-Clause
#include "survey/simulate/simulated_survey.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/parallel.h"
#include "image/any_image.h"
#include "image/exr.h"
#include "image/output_images.h"
#include "lightmap/lightmap.h"
#include "rig/geometry.h"
#include "survey/navigation/time_text.h"
#include "survey/simulate/colmap_poses.h"
#include "survey/simulate/floor_texture.h"
#include "survey/simulate/random_draw.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <mutex>
#include <span>

namespace aphotic {
namespace {

namespace fs = std::filesystem;
using SettingsJson = nlohmann::ordered_json;

SettingsJson settings_of(const SimulatedSurvey& survey) {
    const InstrumentErrors& errors = survey.errors;
    return {{"rig_sha256", survey.rig.digest},
            {"seed", survey.seed},
            {"made_by", survey.made_by},
            {"texture", survey.texture},
            {"camera", to_json(survey.camera)},
            {"noise", survey.has_noise},
            {"altitude_error_m", errors.altitude_m},
            {"attitude_error_deg", errors.attitude_deg},
            {"altitude_bias_m", errors.altitude_bias_m},
            {"pitch_bias_deg", errors.pitch_bias_deg},
            {"roll_bias_deg", errors.roll_bias_deg}};
}

// By pixel; 1 where no floor is in view.
std::vector<float> texture_of(const SimulatedSurvey& survey, const Leg& leg) {
    const Rig& rig = survey.rig;
    const Camera& camera = rig.camera;
    // Seeded unlike noise and flight.
    const FloorTexture texture(survey.texture,
                               random_of(survey.seed + 0xD1B54A32D192ED03U, leg.image)());
    const double middle_nm = 0.5 * (camera.range.first_nm + camera.range.last_nm);
    const Plane floor = floor_plane(leg.sled);
    // Along the floor, forward and across.
    const Eigen::Vector3d across = floor.normal.cross(Eigen::Vector3d::UnitX()).normalized();
    const Eigen::Vector3d forward = across.cross(floor.normal);
    std::vector<float> plane;
    for (int row = 0; row < camera.height_px; ++row) {
        for (int column = 0; column < camera.width_px; ++column) {
            const WaterRay ray = pixel_ray(rig, column + 0.5, row + 0.5, middle_nm);
            const std::optional<double> distance_m = distance_to(floor, ray);
            const Eigen::Vector3d point_m = ray.origin_m + distance_m.value_or(0.0) * ray.direction;
            plane.push_back(distance_m ? static_cast<float>(
                                             texture.at(point_m.dot(forward), point_m.dot(across)))
                                       : 1.0F);
        }
    }
    return plane;
}

void make_truth(const SimulatedSurvey& survey, const LightmapMaker& maker, const Leg& leg) {
    Lightmap map = maker.map(leg.sled);
    if (survey.texture > 0.0) {
        const std::vector<float> texture = texture_of(survey, leg);
        for (std::size_t i = 0; i < map.samples.size(); ++i)
            map.samples[i] *= texture[i % texture.size()];
        write_exr(file_of(survey, "texture", leg), map.width_px, map.height_px, {"Y"}, texture);
    }
    write_exr(
        truth_file(survey, leg), map.width_px, map.height_px, {"R", "G", "B"}, signal_of(map));
}

void write_raw(const SimulatedSurvey& survey, const Leg& leg) {
    const CameraImage truth = read_signals(truth_file(survey, leg));
    std::optional<NoiseOf> noise;
    if (survey.has_noise) noise = NoiseOf{.seed = survey.seed, .image = leg.image};
    const std::vector<std::uint16_t> samples = raw_samples(truth, survey.camera, noise);
    constexpr float kFull = 65535.0F;
    std::vector<float> plane(samples.size());
    std::ranges::transform(
        samples, plane.begin(), [](std::uint16_t number) { return number / kFull; });
    write_any_image(file_of(survey, "raw", leg),
                    {.width_px = truth.width_px,
                     .height_px = truth.height_px,
                     .channels = {"Y"},
                     .planes = plane,
                     .tags = tags_of(survey.camera.shot, exif_time(time_of(leg)))});
}

// work(leg) for the legs whose file is missing, some at a time.
template <typename Work>
void for_missing(const SimulatedSurvey& survey, const char* kind, const Work& work) {
    std::vector<const Leg*> missing;
    for (const Leg& leg : survey.legs) {
        if (!fs::exists(file_of(survey, kind, leg))) missing.push_back(&leg);
    }
    std::mutex mutex;
    std::size_t done = 0;
    parallel_for(missing.size(), static_cast<std::size_t>(survey.jobs), [&](auto i, auto) {
        work(*missing[i]);
        const std::scoped_lock lock(mutex);
        survey.progress(kind, static_cast<double>(++done) / static_cast<double>(missing.size()));
    });
}

// A folder holds one survey: images of two would be indistinguishable.
void require_same(const SettingsJson& settings, const fs::path& notes) {
    const nlohmann::json read = parse_json(read_text_file(notes), notes.string());
    const nlohmann::json found =
        read.is_object() ? read.value("settings", nlohmann::json::object()) : nlohmann::json();
    for (const auto& [key, value] : settings.items()) {
        // Ignores the keys' order.
        const nlohmann::json asked = nlohmann::json::parse(value.dump());
        const nlohmann::json there = found.is_object() ? found.value(key, nlohmann::json()) : found;
        if (asked == there) continue;
        if (key == "rig_sha256")
            throw InputError(
                "{}: found a survey of another rig; allowed: the same file with the "
                "same --set, or another folder",
                notes.string());
        throw InputError("{}: found a survey with {} {}; allowed: {}, or another folder",
                         notes.string(),
                         key,
                         there.dump(),
                         asked.dump());
    }
}

void require_different_names(const std::vector<Leg>& legs) {
    std::vector<std::string> names;
    for (const Leg& leg : legs) names.push_back(leg.name);
    std::ranges::sort(names);
    const auto twice = std::ranges::adjacent_find(names);
    if (twice != names.end())
        throw InputError("found two images named {}; allowed: names that differ", *twice);
}

}  // namespace

fs::path file_of(const SimulatedSurvey& survey, const char* kind, const Leg& leg) {
    return survey.folder / kind / (leg.name + (std::string_view(kind) == "raw" ? ".tif" : ".exr"));
}

fs::path truth_file(const SimulatedSurvey& survey, const Leg& leg) {
    return file_of(survey, "truth", leg);
}

std::uint64_t missing_bytes(const SimulatedSurvey& survey) {
    const auto missing = [&](const char* kind, std::uint64_t pixel_bytes, bool is_asked) {
        const auto files = std::ranges::count_if(
            survey.legs, [&](const Leg& leg) { return !fs::exists(file_of(survey, kind, leg)); });
        return is_asked ? pixel_bytes * static_cast<std::uint64_t>(files) : 0;
    };
    const Camera& camera = survey.rig.camera;
    // Each raw image comes with three floats of truth and one of texture.
    return (missing("raw", 18, true) + missing("depth", 4, survey.truth.depth) +
            missing("normals", 12, survey.truth.normals) +
            missing("reflectance", 12, survey.truth.reflectance)) *
           static_cast<std::uint64_t>(camera.width_px) *
           static_cast<std::uint64_t>(camera.height_px);
}

void begin_survey(const SimulatedSurvey& survey) {
    require_different_names(survey.legs);
    const fs::path notes = survey.folder / kSurveyNotes;
    const SettingsJson settings = settings_of(survey);
    if (fs::exists(notes)) require_same(settings, notes);
    for (const char* kind : {"truth", "raw"}) make_folder(survey.folder / kind);
    if (!fs::exists(notes)) write_text_file(notes, json_text({{"settings", settings}}));
}

double electrons_for_share(Rig rig,
                           const std::vector<Sled>& corners,
                           double saturation_e,
                           double share) {
    rig.objects.clear();
    rig.scene.clear();
    rig.sled = {.altitude_m = std::ranges::min(corners, {}, &Sled::altitude_m).altitude_m};
    const Lightmap map = LightmapMaker(rig, std::nullopt, {}).map(rig.sled);
    const float brightest = std::ranges::max(signal_of(map));
    if (!(brightest > 0.0F)) throw InputError("found no light on the floor in view");
    return share * saturation_e / brightest;
}

void make_truth_by_lightmaps(const SimulatedSurvey& survey) {
    if (survey.texture > 0.0) make_folder(survey.folder / "texture");
    const LightmapMaker maker(
        survey.rig, paths_of(survey.rig, survey.corners), {.veil_tolerance = survey.tolerance});
    for_missing(survey, "truth", [&](const Leg& leg) { make_truth(survey, maker, leg); });
}

void finish_survey(const SimulatedSurvey& survey) {
    for_missing(survey, "raw", [&](const Leg& leg) { write_raw(survey, leg); });
    const std::vector<Leg> told = of_vehicle(survey.legs, survey.rig.mounting);
    write_text_file(survey.folder / "navigation.txt", navigation_text(told, ".tif"));
    const std::vector<Leg> measured = as_measured(told, survey.errors, survey.seed);
    write_text_file(survey.folder / "navigation-measured.txt", navigation_text(measured, ".tif"));
    write_text_file(survey.folder / "navigation-timed.txt", timed_navigation_text(measured));
    if (survey.truth.poses)
        write_colmap(survey.folder / "colmap", survey.rig.camera, survey.legs, ".tif");
    write_text_file(survey.folder / kSurveyNotes,
                    json_text({{"settings", settings_of(survey)}, {"images", survey.legs.size()}}));
}

}  // namespace aphotic
