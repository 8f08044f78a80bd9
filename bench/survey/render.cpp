// SPDX-License-Identifier: BSD-3-Clause
#include "bench/survey/render.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "spectral/integrator.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace aphotic::survey {

namespace fs = std::filesystem;

namespace {

// The manifest of one picture: that of the plan, whose frames have names of the picture's own.
Manifest manifest_of(const Manifest& plan, const Picture& picture) {
    Manifest manifest = plan;
    for (ManifestFrame& frame : manifest.frames) {
        frame = {.name = fmt::format("{}_{}_{}", picture.floor, picture.leg.name, frame.name),
                 .scene_sha256 = {},
                 .image_sha256 = {}};
    }
    return manifest;
}

void write_scenes(const fs::path& folder,
                  const Manifest& plan,
                  const Manifest& manifest,
                  const Picture& picture) {
    for (std::size_t f = 0; f < plan.frames.size(); ++f) {
        write_text_file(scene_path(folder, manifest.frames[f]),
                        scene_of(read_text_file(scene_path(folder, plan.frames[f])), picture));
    }
}

// Whatever interrupts this leaves the frames, or the image and some of the frames: never half of
// one.
void integrate_picture(const fs::path& folder, const Manifest& manifest, const fs::path& image) {
    const fs::path made = folder / (image.stem().string() + ".made");
    make_folder(made);
    integrate_signals(folder, manifest, made);
    fs::rename(made / "image.exr", image);
    fs::remove_all(made);
    for (const ManifestFrame& frame : manifest.frames) {
        fs::remove(image_path(folder, frame));
        fs::remove(log_path(folder, frame));
        fs::remove(scene_path(folder, frame));
    }
}

struct Waiting {
    const Picture* picture = nullptr;
    Manifest manifest;
    std::size_t frames_left = 0;
};

}  // namespace

std::string scene_of(const std::string& generated, const Picture& picture) {
    const std::string version = "#version 3.7;\n";
    const std::size_t at = generated.find(version);
    if (at == std::string::npos) throw RunError("a generated scene does not say #version 3.7;");
    std::string scene = generated;
    return scene.insert(at + version.size(),
                        fmt::format("#declare Survey_Seed = {};\n"
                                    "#declare Survey_Altitude = {};\n"
                                    "#declare Survey_Pitch = {};\n"
                                    "#declare Survey_Roll = {};\n"
                                    "#declare Survey_Floor = \"{}\";\n",
                                    picture.leg.floor_seed,
                                    picture.leg.altitude_m,
                                    picture.leg.pitch_deg,
                                    picture.leg.roll_deg,
                                    picture.floor));
}

void render_pictures(const PovRay& povray,
                     const fs::path& folder,
                     const std::vector<Picture>& pictures,
                     const RunOptions& options) {
    const Manifest plan = read_manifest(folder);
    std::map<std::string, std::shared_ptr<Waiting>> waiting;  // by frame
    std::vector<ManifestFrame> frames;
    for (const Picture& picture : pictures) {
        if (fs::exists(picture.image)) continue;
        const Manifest manifest = manifest_of(plan, picture);
        write_scenes(folder, plan, manifest, picture);
        const auto entry = std::make_shared<Waiting>(Waiting{
            .picture = &picture, .manifest = manifest, .frames_left = manifest.frames.size()});
        for (const ManifestFrame& frame : manifest.frames) {
            frames.push_back(frame);
            waiting[frame.name] = entry;
        }
    }
    RunOptions run = options;
    run.arrived = [&](const ManifestFrame& frame) {
        Waiting& picture = *waiting.at(frame.name);
        if (--picture.frames_left > 0) return;
        integrate_picture(folder, picture.manifest, picture.picture->image);
    };
    run_frames(povray, folder, frames, plan.width_px, plan.height_px, run);
}

}  // namespace aphotic::survey
