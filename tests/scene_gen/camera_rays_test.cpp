// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/camera_rays.h"

#include "rig/camera/lens.h"
#include "support/random_camera.h"
#include "support/random_rig.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cstdlib>
#include <string_view>
#include <vector>

namespace aphotic::camera_rays_test {
namespace {

constexpr double kNineDigits = 1e-8;  // of slopes up to 10

Camera camera_with(LensKind kind, std::uint64_t seed, int width_px, int height_px) {
    Dice dice(seed);
    Camera camera = random_rig(seed).camera;
    camera.port.reset();
    camera.width_px = width_px;
    camera.height_px = height_px;
    camera.pixel_pitch_m = 5e-6;
    camera.focal_length_m = width_px * camera.pixel_pitch_m;
    give_lens(kind, dice, camera);
    return camera;
}

// The file's numbers from a place on, words and signs aside.
std::vector<double> numbers_after(std::string_view sdl, std::string_view word) {
    std::vector<double> numbers;
    const std::size_t start = sdl.find(word) + word.size();
    const char* at = sdl.data() + start;
    const char* const end = sdl.data() + sdl.find('}', start);
    while (at < end) {
        char* after = nullptr;
        const double number = std::strtod(at, &after);
        if (after == at) {
            ++at;
            continue;
        }
        numbers.push_back(number);
        at = after;
    }
    return numbers;
}

TEST(CameraRays, AreTheNormalsOfTrianglesAroundThePupil) {
    for (const LensKind kind : kLensKinds) {
        const Camera camera = camera_with(kind, 3, 12, 9);
        const std::string sdl = camera_rays_sdl(camera);
        const std::vector<double> vertices = numbers_after(sdl, "vertex_vectors {");
        const std::vector<double> faces = numbers_after(sdl, "face_indices {");
        ASSERT_EQ(vertices.size(), 1U + 3U * 3U * 12U * 9U);
        ASSERT_EQ(faces.size(), 1U + 3U * 12U * 9U);
        EXPECT_EQ(vertices[0], 3.0 * 12.0 * 9.0);
        EXPECT_EQ(faces[0], 12.0 * 9.0);
        const auto vertex = [&](std::size_t face, std::size_t corner) -> Eigen::Vector3d {
            const auto at = static_cast<std::size_t>(faces.at(1 + 3 * face + corner));
            return {vertices.at(1 + 3 * at), vertices.at(2 + 3 * at), vertices.at(3 + 3 * at)};
        };
        for (std::size_t face = 0; face < 12U * 9U; ++face) {
            const Eigen::Vector3d a = vertex(face, 0);
            const Eigen::Vector3d b = vertex(face, 1);
            const Eigen::Vector3d c = vertex(face, 2);
            EXPECT_LT((a + b + c).norm(), kNineDigits);
            // POV-Ray's y is the sled's x, and its normal the product of these sides.
            const Eigen::Vector3d normal = (c - a).cross(b - a).normalized();
            const double column = static_cast<double>(face % 12U) + 0.5;
            const double row = static_cast<double>(face / 12U) + 0.5;
            const Eigen::Vector3d sight = direction_in_air(camera, column, row);
            const Eigen::Vector3d seen(normal.y(), normal.x(), normal.z());
            EXPECT_LT(std::min((seen - sight).norm(), (seen + sight).norm()), kNineDigits);
        }
    }
}

TEST(CameraRays, TakeNoMoreRoomThanTheEstimateSays) {
    for (const LensKind kind : kLensKinds) {
        const Camera camera = camera_with(kind, 4, 160, 120);
        EXPECT_LT(camera_rays_sdl(camera).size(), bytes_of_rays(camera));
        EXPECT_GT(camera_rays_sdl(camera).size(), bytes_of_rays(camera) / 2);
    }
}

}  // namespace
}  // namespace aphotic::camera_rays_test
