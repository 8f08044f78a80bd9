// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/range_render.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "image/exr.h"
#include "image/png_frame.h"
#include "rig/geometry.h"
#include "scene_gen/scene_set.h"
#include "scene_gen/user_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

SceneSet distance_scenes(const RangeRender& render, const std::vector<SurveyPicture>& pictures) {
    SceneSet set;
    set.user_scene = scene_file_at(render.scene);
    set.ini = render_ini(
        render.rig,
        {.emitter_lamps = {}, .format = FrameFormat::Png16, .ini_lines = render.ini_lines});
    if (render.rig.camera.lens) set.camera = render.rig.camera;
    for (const SurveyPicture& picture : pictures) {
        const std::string name = fmt::format("{:06}_distance", picture.number);
        set.manifest.frames.push_back({.name = name, .scene_sha256 = {}, .image_sha256 = {}});
        set.scenes.push_back({.name = name,
                              .sdl = distance_sdl(render.rig,
                                                  set.user_scene.path.filename().string(),
                                                  declarations(picture, render.declared),
                                                  picture.sled.altitude_m)});
    }
    return set;
}

void require_dark(const fs::path& scene, const SurveyPicture& picture, ExrReader& frame) {
    const std::vector<float> others = frame.planes(std::vector<std::string>{"G", "B"});
    const auto lit = std::ranges::find_if(others, [](float sample) { return sample > 0.0F; });
    if (lit == others.end()) return;
    const auto pixel = (lit - others.begin()) %
                       (static_cast<std::ptrdiff_t>(frame.width_px()) * frame.height_px());
    throw InputError(
        "{}: found light with all strobes off, at column {}, row {} of image {}; allowed: none, "
        "since ranges are measured by fog",
        scene.string(),
        pixel % frame.width_px(),
        pixel / frame.width_px(),
        picture.number);
}

void write_ranges(const fs::path& frame_file,
                  const Rig& rig,
                  const SurveyPicture& picture,
                  int threads) {
    const double fog_m = picture.sled.altitude_m;
    const double middle_nm = std::midpoint(rig.camera.range.first_nm, rig.camera.range.last_nm);
    ExrReader frame(frame_file);
    const auto width = static_cast<std::size_t>(frame.width_px());
    const auto height = static_cast<std::size_t>(frame.height_px());
    std::vector<float> plane = frame.planes(std::vector<std::string>{"R"});
    parallel_for(height, static_cast<std::size_t>(threads), [&](std::size_t row, std::size_t) {
        for (std::size_t column = 0; column < width; ++column) {
            float& sample = plane[row * width + column];
            const double way_m = -fog_m * std::log1p(-double{sample});
            sample = std::numeric_limits<float>::quiet_NaN();
            if (!(way_m > 0.0 && way_m <= kFarthestFogs * fog_m)) continue;
            const WaterRay ray = pixel_ray(
                rig, static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5, middle_nm);
            sample = static_cast<float>(ray.origin_m.z() + way_m * ray.direction.z());
        }
    });
    write_exr(picture.image, frame.width_px(), frame.height_px(), {"Z"}, plane);
}

}  // namespace

void render_ranges(const PovRay& povray,
                   const fs::path& folder,
                   const RangeRender& render,
                   const std::vector<SurveyPicture>& pictures,
                   const RunOptions& options) {
    std::vector<SurveyPicture> missing;
    std::ranges::copy_if(pictures, std::back_inserter(missing), [](const SurveyPicture& picture) {
        return !fs::exists(picture.image);
    });
    if (missing.empty()) return;
    const SceneSet set = distance_scenes(render, missing);
    require_place_for_scenes(folder, set);
    write_scenes(folder, set);
    std::map<std::string, const SurveyPicture*> picture_of;
    for (std::size_t i = 0; i < missing.size(); ++i)
        picture_of[set.manifest.frames[i].name] = &missing[i];
    RunOptions run = options;
    run.scene = set.user_scene;
    run.convert = [](const ManifestFrame&, const fs::path& image) {
        exr_of_png_frame(image, White::IsWhite);
    };
    run.arrived = [&](const ManifestFrame& frame) {
        const fs::path made = image_path(folder, frame);
        const SurveyPicture& picture = *picture_of.at(frame.name);
        ExrReader reader(made);
        require_dark(set.user_scene.path, picture, reader);
        write_ranges(made, render.rig, picture, options.jobs);
        for (const fs::path& file : {made, log_path(folder, frame), scene_path(folder, frame)})
            fs::remove(file);
    };
    const Camera& camera = render.rig.camera;
    run_frames(povray, folder, set.manifest.frames, camera.width_px, camera.height_px, run);
}

}  // namespace aphotic
