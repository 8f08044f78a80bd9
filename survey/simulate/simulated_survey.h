// SPDX-License-Identifier: BSD-3-Clause
//
// A simulated survey, as a camera would have written it, with the truth. In its folder:
//
//   survey.json               the settings that it is made with, and the camera
//   navigation.txt            the true poses (flight.h)
//   navigation-measured.txt   the same with the errors of instruments
//   truth/000001.exr          the camera's signal, float R, G, B, without noise
//   texture/000001.exr        the floor's reflectance relative to the rig's floor: float Y
//   raw/000001.tif            the camera's file (raw_camera.h), 16 bits
//
// and, if requested, depth, normals, reflectance (image_truth.h) and poses (colmap_poses.h). No
// image depends on these, so they may be requested later.
//
// A flat floor's truth is made here, from lightmaps:
//
//   S_c(pixel) = map_c T(x, y) + veil_c          (x, y) the pixel's place on the floor
//
// with the texture T (floor_texture.h); the veil never met the floor. Each image sees its own piece
// of floor. Any other truth is made elsewhere (plugin/survey_render.h).
//
// An image depends only on the settings and its number: not on threads, nor on the number of
// images. An interrupted survey can thus be continued, and extended, by making it again.
#pragma once

#include "image/camera_image.h"
#include "rig/rig.h"
#include "survey/simulate/flight.h"
#include "survey/simulate/raw_camera.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace aphotic {

struct TruthAsked {
    bool depth = false;
    bool normals = false;
    bool reflectance = false;
    bool poses = false;
};

struct SimulatedSurvey {
    std::filesystem::path folder;
    Rig rig;
    std::vector<Leg> legs;
    std::vector<Sled> corners;  // enclose the legs, and those that may be added
    InstrumentErrors errors{};
    RawCamera camera{};
    bool has_noise = true;
    double texture = 0.2;     // rms contrast; 0: none
    double tolerance = 1e-3;  // of the lightmaps' veil, as a share of the signal
    std::uint64_t seed = 1;
    int jobs = 1;
    TruthAsked truth{};
    nlohmann::ordered_json made_by{};  // other settings that the images depend on
    std::function<void(std::string_view kind, double share)> progress = [](auto, double) {};
};

inline constexpr const char* kSurveyNotes = "survey.json";

// For an image; kind: the folder's name, such as "raw".
[[nodiscard]] std::filesystem::path file_of(const SimulatedSurvey& survey,
                                            const char* kind,
                                            const Leg& leg);
[[nodiscard]] std::filesystem::path truth_file(const SimulatedSurvey& survey, const Leg& leg);

// Of the files still to be written, uncompressed.
[[nodiscard]] std::uint64_t missing_bytes(const SimulatedSurvey& survey);

// An InputError if the folder holds a survey with other settings. Otherwise these are recorded.
void begin_survey(const SimulatedSurvey& survey);

// The electrons for a signal of 1 at which the brightest point of the rig's bare floor, seen
// straight down from the lowest of these poses, fills this share of the well.
[[nodiscard]] double electrons_for_share(Rig rig,
                                         const std::vector<Sled>& corners,
                                         double saturation_e,
                                         double share);

// Makes missing parts of the images' truth, and texture. An InputError for a rig whose view
// contains more than a flat floor.
void make_truth_by_lightmaps(const SimulatedSurvey& survey);

// Makes missing raw images from their truth, the navigation, and all of the notes.
void finish_survey(const SimulatedSurvey& survey);

}  // namespace aphotic
