// SPDX-License-Identifier: BSD-3-Clause
//
// A survey: its images, their poses, their light, and their camera.
#pragma once

#include "survey/images/image_files.h"
#include "survey/images/survey_image.h"
#include "survey/light_at.h"
#include "survey/navigation/navigation.h"
#include "survey/relief/floor_relief.h"

#include <optional>
#include <vector>

namespace aphotic {

struct Survey {
    std::vector<ImageFile> files;
    std::optional<Navigation> navigation{};  // null: nothing here depends on a pose
    std::optional<DepthMaps> depth{};        // null: the floor is the navigation's plane
    LightAt light{};                         // without maps, the default, it is unknown
    CameraNumbers camera;
    StrobesAt strobes{};  // by default, the light per strobe is unknown
    Dropouts dropouts = Dropouts::Mark;

    // An InputError if the navigation has no pose for it.
    [[nodiscard]] Sled sled_of(const ImageFile& file) const {
        return navigation ? navigation->pose_of(file.source).sled : Sled{};
    }
};

}  // namespace aphotic
