// SPDX-License-Identifier: BSD-3-Clause
//
// The project's scenes as rigs, also in fewer and larger pixels over the same field of view.
#pragma once

#include "rig/file/rig_reader.h"
#include "support/scene_text.h"

#include <filesystem>

namespace aphotic {

// The same view in so many pixels.
inline Rig with_pixels(Rig rig, int width_px, int height_px) {
    rig.camera.pixel_pitch_m *= static_cast<double>(rig.camera.width_px) / width_px;
    rig.camera.width_px = width_px;
    rig.camera.height_px = height_px;
    return rig;
}

// "habcam.toml", below scenes/.
inline Rig scene_rig(const std::filesystem::path& name) {
    return read_rig(scene_file(name));
}
inline Rig scene_rig(const std::filesystem::path& name, int width_px, int height_px) {
    return with_pixels(scene_rig(name), width_px, height_px);
}

inline Rig habcam() {
    return scene_rig("habcam.toml");
}
inline Rig habcam(int width_px, int height_px) {
    return scene_rig("habcam.toml", width_px, height_px);
}

}  // namespace aphotic
