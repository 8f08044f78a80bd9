// SPDX-License-Identifier: BSD-3-Clause
//
// Position and attitude of a survey's cameras over its mesh (relief/relief_scene.h), from the
// navigation: its east and north, turned by Rz(heading) Ry(pitch) Rx(roll), and z
//
//   by depth       the navigation's depth below the sea level, where the mesh has its z = 0
//   by altitude    the altitude above the mesh: along the axis if altitudes are measured so, else
//                  straight down
#pragma once

#include "survey/survey.h"

namespace aphotic {

// An InputError for this one image if its position is unknown, or no part of the mesh lies below
// it.
[[nodiscard]] CameraStation station_of(const Survey& survey, const ImageFile& file);

// An InputError with the coordinates of both if no image sees the mesh.
void require_in_view(const Survey& survey);

}  // namespace aphotic
