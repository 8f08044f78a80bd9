// SPDX-License-Identifier: BSD-3-Clause
//
// The mesh as POV-Ray 3.7 looks rays up in it (source/backend/render/tracepixel.cpp, distribution
// 3, and Compute_Mesh_Triangle in source/backend/shape/mesh.cpp), against the lens's own rays.
#include "scene_gen/camera_rays.h"

#include "rig/camera/lens.h"
#include "rig/geometry.h"
#include "support/random_camera.h"
#include "support/random_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <vector>

namespace aphotic::camera_rays_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFloats = 2e-7;  // of normals in single precision, and of what is divided by them

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

using Face = std::array<std::size_t, 3>;

class PovrayMesh {
  public:
    explicit PovrayMesh(const Camera& camera) : width_(camera.width_px), height_(camera.height_px) {
        const std::string sdl = camera_rays_sdl(camera);
        const std::vector<double> places = numbers_after(sdl, "vertex_vectors {");
        const std::vector<double> normals = numbers_after(sdl, "normal_vectors {");
        const std::vector<double> uvs = numbers_after(sdl, "uv_vectors {");
        const std::vector<double> faces = numbers_after(sdl, "face_indices {");
        depth_ = numbers_after(sdl, "scale").at(2);
        for (std::size_t i = 1; i + 3 < places.size(); i += 4)
            places_.push_back(places[i + 3] * Vector3d(places[i], places[i + 1], places[i + 2]));
        for (std::size_t i = 1; i + 2 < normals.size(); i += 3) {
            const Vector3d normal = Vector3d(normals[i], normals[i + 1], normals[i + 2]);
            normals_.emplace_back(normal.normalized().cast<float>());
        }
        for (std::size_t i = 1; i + 1 < uvs.size(); i += 2) uvs_.emplace_back(uvs[i], uvs[i + 1]);
        for (std::size_t i = 1; i + 2 < faces.size(); i += 3) {
            faces_.push_back({static_cast<std::size_t>(faces[i]),
                              static_cast<std::size_t>(faces[i + 1]),
                              static_cast<std::size_t>(faces[i + 2])});
        }
        EXPECT_EQ(places[0], places_.size());
        EXPECT_EQ(normals[0], places_.size());
        EXPECT_EQ(uvs[0], places_.size());
        EXPECT_EQ(faces[0], faces_.size());
        EXPECT_EQ(normals_.size(), places_.size());
        EXPECT_EQ(uvs_.size(), places_.size());
        mark_faces();
    }

    [[nodiscard]] std::size_t points() const { return places_.size(); }

    // In POV-Ray's frame; none where it finds no face.
    [[nodiscard]] std::optional<Vector3d> ray(double column, double row) const {
        const double x = std::clamp(column, 0.0, width_ - 1.0);
        const double y = std::clamp(row - 1.0, 0.0, height_ - 1.0);
        const Vector2d uv((x - 0.5) / width_, 1.0 - (y + 0.5) / height_);
        for (const std::size_t f : marked_.at(bin(uv.x())).at(bin(uv.y()))) {
            const std::optional<Vector3d> normal = normal_in(faces_[f], uv);
            if (normal)
                return Vector3d(normal->x(), normal->y(), normal->z() / depth_).normalized();
        }
        return std::nullopt;
    }

    // It would exchange two corners of a face, but not the normals there if they are much alike.
    [[nodiscard]] bool exchanges_corners() const {
        return std::ranges::any_of(faces_, [&](const Face& face) {
            const Vector3d a = places_[face[0]];
            const Vector3d b = places_[face[1]];
            const Vector3d c = places_[face[2]];
            return (b.x() - c.x()) * (b.y() - a.y()) < (b.y() - c.y()) * (b.x() - a.x());
        });
    }

    [[nodiscard]] double extent() const {
        double extent = 0.0;
        for (const Vector3d& place : places_) extent = std::max(extent, place.norm());
        return extent;
    }

  private:
    static constexpr std::size_t kBins = 10;

    static std::size_t bin(double share) {
        const int of_ten = static_cast<int>(share * static_cast<double>(kBins));
        EXPECT_GE(of_ten, 0) << "of " << share;
        return std::min(static_cast<std::size_t>(std::max(0, of_ten)), kBins - 1);
    }

    void mark_faces() {
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            const auto [a, b, c] = faces_[f];
            const auto us = std::minmax({bin(uvs_[a].x()), bin(uvs_[b].x()), bin(uvs_[c].x())});
            const auto vs = std::minmax({bin(uvs_[a].y()), bin(uvs_[b].y()), bin(uvs_[c].y())});
            for (std::size_t u = us.first; u <= us.second; ++u)
                for (std::size_t v = vs.first; v <= vs.second; ++v) marked_[u][v].push_back(f);
        }
    }

    [[nodiscard]] std::optional<Vector3d> normal_in(const Face& face, const Vector2d& uv) const {
        const Vector2d a = uvs_[face[0]] - uv;
        const Vector2d b = uvs_[face[1]] - uv;
        const Vector2d c = uvs_[face[2]] - uv;
        const auto cross = [](const Vector2d& p, const Vector2d& q) {
            return p.x() * q.y() - q.x() * p.y();
        };
        const Vector3d shares = Vector3d(cross(b, c), cross(c, a), cross(a, b)) /
                                cross(uvs_[face[1]] - uvs_[face[0]], uvs_[face[2]] - uvs_[face[0]]);
        if (shares.minCoeff() < 0.0) return std::nullopt;
        return shares.x() * normals_[face[0]].cast<double>() +
               shares.y() * normals_[face[1]].cast<double>() +
               shares.z() * normals_[face[2]].cast<double>();
    }

    double width_;
    double height_;
    double depth_ = 1.0;
    std::vector<Vector3d> places_;
    std::vector<Eigen::Vector3f> normals_;
    std::vector<Vector2d> uvs_;
    std::vector<Face> faces_;
    std::array<std::array<std::vector<std::size_t>, kBins>, kBins> marked_;
};

struct Size {
    int width_px;
    int height_px;
};

// The pixels of every stride-th column and row, and those along the rim.
template <typename See>
void for_pixels(const Size& size, int stride, const See& see) {
    for (int row = 0; row < size.height_px; ++row) {
        for (int column = 0; column < size.width_px; ++column) {
            const bool is_on_rim = (row < 2 || row + 2 >= size.height_px) &&
                                   (column < 2 || column + 2 >= size.width_px);
            if (is_on_rim || (row % stride == 0 && column % stride == 0)) see(column, row);
        }
    }
}

// By how much the worst pixel is off.
double worst_error_rad(const Camera& camera, int stride) {
    const PovrayMesh mesh(camera);
    double worst = 0.0;
    for_pixels({camera.width_px, camera.height_px}, stride, [&](int column, int row) {
        const std::optional<Vector3d> ray = mesh.ray(column + 0.5, row + 0.5);
        const Vector3d sight = to_povray(direction_in_air(camera, column + 0.5, row + 0.5));
        EXPECT_TRUE(ray) << "pixel " << column << ", " << row;
        worst = std::max(worst, ray ? (*ray - sight).norm() : 0.0);
    });
    return worst;
}

TEST(CameraRays, AreTheLensesAtEveryPixel) {
    constexpr std::array<Size, 5> kSizes{{{2, 1}, {3, 2}, {12, 9}, {64, 64}, {240, 180}}};
    for (const LensKind kind : kLensKinds) {
        for (const Size& size : kSizes) {
            const Camera camera = camera_with(kind, 3, size.width_px, size.height_px);
            // Small images have a point a pixel.
            const double bound = size.width_px <= 64 ? kFloats : kRayErrorRad + kFloats;
            EXPECT_LE(worst_error_rad(camera, 1 + size.width_px / 40), bound) << size.width_px;
        }
    }
}

TEST(CameraRays, AreTheLensesAtTheSizeOfRealCameras) {
    const Camera camera = camera_with(LensKind::RadialTangential, 3, 6000, 4000);
    EXPECT_LE(worst_error_rad(camera, 333), kRayErrorRad + kFloats);
}

// Of --antialias 9, whose samples come nearest to a pixel's borders. POV-Ray asks for all of the
// first row's and the last column's at one place.
TEST(CameraRays, AreTheLensesBetweenPixels) {
    constexpr double kOff = 4.0 / 9.0;
    // With a point a pixel, rays between are off by an eighth of what two pixels' angles differ by.
    constexpr double kOfAPixel = 4e-3;
    constexpr Size kSize{320, 240};
    for (const LensKind kind : kLensKinds) {
        const Camera camera = camera_with(kind, 5, kSize.width_px, kSize.height_px);
        const PovrayMesh mesh(camera);
        for_pixels(kSize, 31, [&](int column, int row) {
            for (const auto& [x, y] : std::array<std::array<double, 2>, 4>{
                     {{-kOff, -kOff}, {kOff, -kOff}, {-kOff, kOff}, {kOff, kOff}}}) {
                const double beside = column + 1 < kSize.width_px ? x : 0.0;
                const double below = row > 0 ? y : 0.0;
                const std::optional<Vector3d> ray = mesh.ray(column + 0.5 + x, row + 0.5 + y);
                ASSERT_TRUE(ray) << "pixel " << column << ", " << row;
                const Vector3d sight =
                    to_povray(direction_in_air(camera, column + 0.5 + beside, row + 0.5 + below));
                ASSERT_LE((*ray - sight).norm(),
                          kOfAPixel * camera.pixel_pitch_m / camera.focal_length_m)
                    << "pixel " << column << ", " << row;
            }
        });
    }
}

// An equidistant fisheye to the corners' 88 degrees, whose rays bend most.
TEST(CameraRays, AreThoseOfTheWidestFisheye) {
    constexpr Size kSize{240, 180};
    Camera camera = camera_with(LensKind::Fisheye, 3, kSize.width_px, kSize.height_px);
    const double focal_px = 150.0 / (88.0 * std::numbers::pi / 180.0);
    camera.lens =
        LensModel{.focal_px = {focal_px, focal_px}, .centre_px = {120.0, 90.0}, .is_fisheye = true};
    const PovrayMesh mesh(camera);
    for_pixels(kSize, 7, [&](int column, int row) {
        const double x = column + 0.5 - 120.0;
        const double y = row + 0.5 - 90.0;
        const double r = std::hypot(x, y);
        const double theta_rad = r / focal_px;
        const Vector3d sight(
            std::sin(theta_rad) * x / r, -std::sin(theta_rad) * y / r, std::cos(theta_rad));
        const std::optional<Vector3d> ray = mesh.ray(column + 0.5, row + 0.5);
        ASSERT_TRUE(ray) << "pixel " << column << ", " << row;
        ASSERT_LE((*ray - sight).norm(), kRayErrorRad + kFloats)
            << "pixel " << column << ", " << row;
    });
}

// Through a long lens neighbouring normals are alike.
TEST(CameraRays, AreOfFacesWhoseCornersPovrayLeavesInPlace) {
    for (const double focal_px : {500.0, 1e7}) {
        Camera camera = camera_with(LensKind::RadialTangential, 3, 320, 240);
        camera.lens->focal_px = {focal_px, focal_px};
        EXPECT_FALSE(PovrayMesh(camera).exchanges_corners()) << focal_px;
    }
}

TEST(CameraRays, BeginAtThePupil) {
    constexpr double kNowhere_m = 1e-8;  // of 0.1 m that a port may be near
    EXPECT_LT(PovrayMesh(camera_with(LensKind::Fisheye, 3, 320, 240)).extent(), kNowhere_m);
}

// An ordinary lens of 24 megapixels, for which a triangle a pixel took 2 GB.
TEST(CameraRays, AreAsManyAsTheLensAsksForAndNotThePixels) {
    constexpr std::uint64_t kMost_bytes = 20'000'000;
    Camera camera = camera_with(LensKind::RadialTangential, 3, 6000, 4000);
    camera.lens = LensModel{.focal_px = {4650.0, 4650.0},
                            .centre_px = {3000.0, 2000.0},
                            .radial = {-0.11, 0.085, -0.01, 0.0}};
    EXPECT_LT(bytes_of_rays(camera), kMost_bytes);
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
