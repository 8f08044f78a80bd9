// SPDX-License-Identifier: BSD-3-Clause
//
// PLY files as Metashape, Open3D and Blender write them.
#include "survey/relief/ply_mesh.h"

#include "support/geotiff.h"
#include "support/has.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>

namespace aphotic::ply_mesh_test {
namespace {

constexpr std::size_t kMany = 100;
constexpr std::string_view kAscii =
    "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nelement vertex 4\r\nproperty double x\r\n"
    "property double y\r\nproperty float64 z\r\nproperty uchar red\r\nelement face 2\r\n"
    "property list uchar int vertex_indices\r\nend_header\r\n"
    "500000.25 0 -1 255\r\n1 0 -1.5 0\r\n1 1 -2 0\r\n0 1e0 -2 0\r\n3 0 1 2\r\n3 0 2 3\r\n";

std::string refusal(const std::string& ply, std::size_t most = kMany) {
    return refusal_of([&] { (void)parse_ply("a.ply", ply, most); });
}

std::string with(std::string_view from, std::string_view to) {
    std::string text(kAscii);
    return text.replace(text.find(from), from.size(), to);
}

TEST(PlyMesh, IsReadFromText) {
    const Mesh mesh = parse_ply("a.ply", kAscii, kMany);
    ASSERT_EQ(mesh.vertices_m.size(), 4U);
    EXPECT_EQ(mesh.vertices_m[0], Eigen::Vector3d(500000.25, 0.0, -1.0));
    EXPECT_EQ(mesh.vertices_m[3], Eigen::Vector3d(0.0, 1.0, -2.0));
    ASSERT_EQ(mesh.triangles.size(), 2U);
    EXPECT_EQ(mesh.triangles[1], (std::array{0, 2, 3}));
}

// Properties in another order, others between, an element before and one after, and a square.
TEST(PlyMesh, IsReadFromBytes) {
    std::string ply =
        "ply\nformat binary_little_endian 1.0\nelement camera 1\nproperty list ushort double "
        "views\n"
        "element vertex 4\nproperty short quality\nproperty float z\nproperty float x\n"
        "property float y\nelement face 1\nproperty uchar flags\n"
        "property list uint8 uint32 vertex_index\nelement edge 1\nproperty int32 "
        "vertex1\nend_header\n";
    ply += bytes_of(std::vector<std::uint16_t>{2}) + bytes_of(std::vector{1.0, 2.0});
    for (const std::array<float, 3>& zxy : {std::array{-5.0F, 0.0F, 0.0F},
                                            {-5.0F, 2.0F, 0.0F},
                                            {-5.0F, 2.0F, 2.0F},
                                            {-6.0F, 0.0F, 2.0F}})
        ply += bytes_of(std::vector<std::int16_t>{-7}) +
               bytes_of(std::vector<float>(zxy.begin(), zxy.end()));
    ply += std::string("\x09\x04", 2) + bytes_of(std::vector<std::uint32_t>{0, 1, 2, 3}) +
           bytes_of(std::vector<std::int32_t>{0});
    const Mesh mesh = parse_ply("a.ply", ply, kMany);
    EXPECT_EQ(mesh.vertices_m[3], Eigen::Vector3d(0.0, 2.0, -6.0));
    EXPECT_EQ(mesh.triangles.size(), 2U);
    EXPECT_TRUE(has(refusal(ply.substr(0, ply.size() - 3)),
                    "a.ply: the file is truncated: found 0 of 1 elements 'edge'"));
    EXPECT_TRUE(has(refusal(ply.substr(0, ply.size() - 30)), "found 3 of 4 elements 'vertex'"));
}

TEST(PlyMesh, ThatCannotBeSaysWhy) {
    EXPECT_EQ(refusal("obj"), "a.ply: not a PLY file");
    EXPECT_TRUE(has(refusal("ply\nformat ascii 1.0\n"), "the file ends within its header"));
    EXPECT_TRUE(
        has(refusal(with("ascii", "binary_big_endian")), "found 'format binary_big_endian 1.0"));
    EXPECT_TRUE(has(refusal(with("uchar red", "half red")), "found 'property half red"));
    EXPECT_TRUE(has(refusal(with("double y", "double v")), "vertices without x, y or z"));
    EXPECT_TRUE(has(refusal(with("vertex_indices", "corners")), "faces without vertex_indices"));
    EXPECT_TRUE(has(refusal(with("1e0", "one")), "found 'one' in vertex 4; allowed: a number"));
    EXPECT_TRUE(has(refusal(with("1e0", "nan")), "vertex 4 with a coordinate that is not finite"));
    EXPECT_TRUE(
        has(refusal(with("3 0 2 3", "3 0 2 4")), "found vertex 4 in face 2; allowed: 0 to 3"));
    EXPECT_TRUE(has(refusal(with("3 0 2 3", "2 0 2")), "found face 2 of 2 corners"));
    EXPECT_TRUE(has(refusal(with("3 0 2 3", "")), "truncated: found 1 of 2 elements 'face'"));
    EXPECT_TRUE(has(refusal(with("face 2", "face 0")), "found 4 vertices and no faces"));
    EXPECT_TRUE(has(refusal(std::string(kAscii), 1), "more than 1 triangles"));
    EXPECT_TRUE(has(refusal(with("element vertex 4", "element vertex 99999999999999999999")),
                    "found 'element vertex 9999"));
    // Of nothing there may be any number.
    EXPECT_EQ(refusal(with("element face", "element none 999999999999999999\nelement face")),
              kAccepted);
}

}  // namespace
}  // namespace aphotic::ply_mesh_test
