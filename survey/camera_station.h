// SPDX-License-Identifier: BSD-3-Clause
//
// Where the cameras of a survey stand over its mesh (relief/relief_scene.h), by the navigation:
// east and north as it tells them, turned by Rz(heading) Ry(pitch) Rx(roll), and z
//
//   by depth       the navigation's own, below the sea level, where the mesh has its z = 0
//   by altitude    as high over the mesh as the altitude says: along the axis where altitudes are,
//                  else straight down
#pragma once

#include "survey/survey.h"

namespace aphotic {

// An InputError of this one image when its place is not known, or it is over no part of the mesh.
[[nodiscard]] CameraStation station_of(const Survey& survey, const ImageFile& file);

// An InputError with the numbers of both when no image looks at the mesh.
void require_in_view(const Survey& survey);

}  // namespace aphotic
