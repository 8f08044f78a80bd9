// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/survey_render.h"

#include "base/atomic_file.h"
#include "base/degrees.h"
#include "base/error.h"
#include "scene_gen/scene_set.h"
#include "scene_gen/veil_planes.h"
#include "spectral/integrator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <memory>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

SceneSet scenes_at(const SurveyRender& render,
                   const Sled& sled,
                   const std::string& declarations = "") {
    Rig rig = render.rig;
    rig.sled = sled;
    RenderPlan plan = render.plan;
    if (plan.scene.user_scene) plan.scene.declarations = declarations;
    return make_scene_set(rig, plan);
}

// A picture whose frames are in progress. Their names begin with its number.
struct PictureUnderWay {
    fs::path image;
    SceneSet scenes;
    std::size_t frames_left = 0;
};

PictureUnderWay begun(const fs::path& folder,
                      const SurveyRender& render,
                      const SurveyPicture& picture) {
    PictureUnderWay under_way{
        .image = picture.image,
        .scenes = scenes_at(render, picture.sled, declarations(picture, render.declared))};
    SceneSet& set = under_way.scenes;
    for (std::size_t f = 0; f < set.scenes.size(); ++f) {
        ManifestFrame& frame = set.manifest.frames[f];
        frame = {.name = fmt::format("{:06}_{}", picture.number, frame.name),
                 .scene_sha256 = {},
                 .image_sha256 = {}};
        write_text_file(scene_path(folder, frame), set.scenes[f].sdl);
    }
    set.scenes.clear();
    under_way.frames_left = set.manifest.frames.size();
    return under_way;
}

// An interruption leaves the frames, or the image and some of the frames, but never part of an
// image.
void integrate_picture(const fs::path& folder, int threads, PictureUnderWay& picture) {
    const fs::path made = folder / (picture.image.stem().string() + ".made");
    Manifest& manifest = picture.scenes.manifest;
    make_folder(made);
    if (picture.scenes.scattering) {
        manifest.veil = write_veil(folder, *picture.scenes.scattering, manifest, threads);
        make_folder(veil_path(made).parent_path());
        fs::rename(veil_path(folder), veil_path(made));
    }
    integrate_signals(folder, manifest, made);
    fs::rename(made / "image.exr", picture.image);
    fs::remove_all(made);
    for (const ManifestFrame& frame : manifest.frames) {
        fs::remove(image_path(folder, frame));
        fs::remove(log_path(folder, frame));
        fs::remove(scene_path(folder, frame));
    }
}

}  // namespace

std::vector<std::string> declared_numbers(const SurveyPicture& picture,
                                          const std::vector<std::string>& declared) {
    std::vector<std::string> numbers{
        fmt::format("Survey_Image={}", picture.number),
        fmt::format("Survey_Seed={}", picture.seed),
        fmt::format("Survey_Altitude={}", picture.sled.altitude_m),
        fmt::format("Survey_Pitch={}", picture.sled.pitch_rad * kDegreesPerRadian),
        fmt::format("Survey_Roll={}", picture.sled.roll_rad * kDegreesPerRadian)};
    std::ranges::copy_if(declared, std::back_inserter(numbers), [](const std::string& one) {
        return one.find('"') == std::string::npos;
    });
    return numbers;
}

std::string declarations(const SurveyPicture& picture, const std::vector<std::string>& declared) {
    std::string text;
    for (const std::string& one : declared_numbers(picture, {})) text += "#declare " + one + ";\n";
    for (const std::string& one : declared) text += "#declare " + one + ";\n";
    return text;
}

PathRange paths_of_poses(Rig rig, const std::vector<Sled>& sleds, bool has_scene) {
    PathRange paths;
    for (const Sled& sled : sleds) {
        rig.sled = sled;
        const PathRange of_sled = path_range(rig);
        const bool is_first = &sled == &sleds.front();
        paths.shortest_m =
            is_first ? of_sled.shortest_m : std::min(paths.shortest_m, of_sled.shortest_m);
        paths.longest_m = std::max(paths.longest_m, of_sled.longest_m);
    }
    if (has_scene) paths.shortest_m *= kRelief;
    return paths;
}

void require_declaration(const std::string& declared) {
    const auto is_letter = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
    const std::size_t equals = declared.find('=');
    const std::string name = declared.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : declared.substr(equals + 1);
    const bool is_text = value.size() > 1 && value.front() == '"' && value.back() == '"';
    const std::string inside = is_text ? value.substr(1, value.size() - 2) : value;
    const bool is_one = !inside.empty() && std::ranges::all_of(inside, [&](unsigned char c) {
        return is_letter(c) || c == '.' || c == '-' || c == '+' || (is_text && c == ' ');
    });
    if (is_one && !name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) == 0 &&
        std::ranges::all_of(name, is_letter)) {
        return;
    }
    throw InputError("found '{}'; allowed: NAME=NUMBER or NAME=\"WORDS\", in plain letters",
                     declared);
}

void render_pictures(const PovRay& povray,
                     const fs::path& folder,
                     const SurveyRender& render,
                     const std::vector<SurveyPicture>& pictures,
                     const RunOptions& options) {
    SceneSet common = scenes_at(render, render.rig.sled);
    require_place_for_scenes(folder, common);
    common.scenes.clear();
    write_scenes(folder, common);
    std::map<std::string, std::shared_ptr<PictureUnderWay>> under_way;  // by frame
    std::vector<ManifestFrame> frames;
    for (const SurveyPicture& picture : pictures) {
        if (fs::exists(picture.image)) continue;
        const auto begins = std::make_shared<PictureUnderWay>(begun(folder, render, picture));
        for (const ManifestFrame& frame : begins->scenes.manifest.frames) {
            frames.push_back(frame);
            under_way[frame.name] = begins;
        }
    }
    RunOptions run = options;
    run.scene = common.user_scene;
    run.arrived = [&](const ManifestFrame& frame) {
        PictureUnderWay& picture = *under_way.at(frame.name);
        if (--picture.frames_left == 0) integrate_picture(folder, options.jobs, picture);
    };
    run_frames(povray, folder, frames, common.manifest.width_px, common.manifest.height_px, run);
}

}  // namespace aphotic
