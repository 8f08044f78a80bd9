// SPDX-License-Identifier: BSD-3-Clause
//
// A rig with several cameras and one set of lamps, such as a stereo sled's:
//
//   [[camera]]                       [[camera]]
//   name       = "port"              name       = "starboard"
//   position_m = [0, -0.2, 0]        position_m = [0, 0.2, 0]
//
// Each has its own place and orientation on the vehicle (rig/vehicle_pose.h) and all
// other keys of [camera]. Strobes and [sled] are relative to the first one. Everything downstream
// has one camera: the rig as a camera sees it is a text in which that is the only one, and
//
//   x'  = R_c^T (m_1 + R_1 x - m_c)      a strobe's place         m, R  of the mountings
//   a'  = R_c^T R_1 a                    its axis                 1     the first camera
//   [sled]                               of that camera           c     the chosen one
//
// A beam that is not round is turned about its axis along with it, in a table of its own.
//
// Limits: objects, scenes, and emitters of cameras that are turned against the first one are
// refused for the others, since these have no orientation in a rig file.
#pragma once

#include "rig/file/rig_text.h"

#include <filesystem>
#include <span>
#include <string>

namespace aphotic {

// A key, and its value as in TOML.
struct RigSetting {
    std::string key;
    std::string value;
};

// Keys are set as in the file, before the lamps are seen by the chosen camera; camera.KEY is that
// camera's. An InputError if there is no such camera. A single [camera] can have a name, too.
[[nodiscard]] RigText rig_of_camera(const std::filesystem::path& file,
                                    const std::string& camera,
                                    std::span<const RigSetting> settings = {});
// The same of a text, with files relative to the folder.
[[nodiscard]] RigText rig_of_camera(const std::string& toml,
                                    const std::string& name,
                                    const std::filesystem::path& folder,
                                    const std::string& camera,
                                    std::span<const RigSetting> settings = {});

}  // namespace aphotic
