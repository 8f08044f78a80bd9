// SPDX-License-Identifier: BSD-3-Clause
#include "survey/simulate/image_truth.h"

#include "image/exr.h"
#include "rig/file/rig_reader.h"
#include "support/exr_file.h"
#include "support/flat.h"
#include "support/small_scene.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

namespace aphotic::image_truth_test {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

// A float's rounding, of two factors.
constexpr double kFloat = 2e-7;
// What floor_colour's own grid is asked for, and a sum by nanometres of curves with knots every 5.
constexpr double kSpectral = 1e-5;

const std::vector<std::string> kNormal{"N.X", "N.Y", "N.Z"};

class ImageTruth : public testing::Test {
  protected:
    ImageTruth() {
        survey_.truth = {.depth = true, .normals = true, .reflectance = true, .poses = false};
        survey_.texture = 0.0;
    }
    static SimulatedSurvey small_survey(const fs::path& folder) {
        put_small_scene("survey/smooth.toml", folder);
        return {.folder = folder / "out",
                .rig = read_rig(folder / "rig.toml"),
                .legs = flight({}, 1, 2),
                .corners = {}};
    }
    // Every pixel shows this.
    void write(const std::optional<SeenPoint>& seen) {
        write_seen(survey_, [&](const Sled&) -> Sight {
            return [&](double, double) {
                ++looks_;
                return seen;
            };
        });
    }
    [[nodiscard]] std::vector<float> made(const std::string& kind,
                                          const std::vector<std::string>& channels) const {
        return read_exr(survey_.folder / kind / "000002.exr", channels);
    }
    [[nodiscard]] std::size_t pixels() const {
        return static_cast<std::size_t>(survey_.rig.camera.width_px) *
               static_cast<std::size_t>(survey_.rig.camera.height_px);
    }

    TempFolder temp_;
    SimulatedSurvey survey_ = small_survey(temp_.path());
    std::atomic<std::size_t> looks_ = 0;
};

// The sled's x is forward, up the image; its y is to the image's right.
TEST_F(ImageTruth, IsInTheFrameOfCameras) {
    write(SeenPoint{.point_m = {0.25, -0.5, 1.75}, .normal = {0.6, 0.0, -0.8}, .surface = 0});
    EXPECT_EQ(made("depth", {"Z"}), std::vector<float>(pixels(), 1.75F));
    EXPECT_EQ(made("normals", {"N.X"}), std::vector<float>(pixels(), 0.0F));
    EXPECT_EQ(made("normals", {"N.Y"}), std::vector<float>(pixels(), -0.6F));
    EXPECT_EQ(made("normals", {"N.Z"}), std::vector<float>(pixels(), -0.8F));
}

TEST_F(ImageTruth, OfNothingIsNoNumber) {
    write(std::nullopt);
    for (const auto& [kind, channels] : {std::pair{"depth", std::vector<std::string>{"Z"}},
                                         {"normals", kNormal},
                                         {"reflectance", {"R", "G", "B"}}}) {
        for (const float sample : made(kind, channels)) ASSERT_TRUE(std::isnan(sample)) << kind;
    }
}

// The definition as a sum over nanometres, for each surface by itself.
TEST_F(ImageTruth, ReflectsTheLampsLightByTheCamerasResponse) {
    Rig& rig = survey_.rig;
    const Spectrum ramp("ramp", {300.0, 1100.0}, {0.0, 0.8});
    rig.objects = {{.name = "grey", .shape = Sphere{}, .reflectance = flat(0.3)},
                   {.name = "ramp", .shape = Sphere{}, .reflectance = ramp}};
    const std::array<Spectrum, 3> surfaces{rig.seafloor.reflectance, flat(0.3), ramp};
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        write(SeenPoint{.point_m = Vector3d::UnitZ(), .normal = -Vector3d::UnitZ(), .surface = k});
        const std::vector<float> colour = made("reflectance", {"R", "G", "B"});
        for (std::size_t c = 0; c < 3; ++c) {
            double given = 0.0;
            double back = 0.0;
            const auto [first_nm, last_nm] = rig.camera.range;
            for (double nm = first_nm; nm <= last_nm; nm += 0.125) {
                const double end = nm == first_nm || nm == last_nm ? 0.5 : 1.0;
                double flux = 0.0;
                for (const Strobe& strobe : rig.strobes)
                    flux += end * strobe.power * strobe.spectrum.at(nm);
                flux *= rig.camera.sensor.response(static_cast<int>(c), nm);
                given += flux;
                back += flux * surfaces.at(k).at(nm);
            }
            EXPECT_NEAR(colour.at(c * pixels()), back / given, kSpectral) << k << ' ' << c;
        }
        fs::remove_all(survey_.folder / "reflectance");
    }
}

// The texture is the floor's, not that of what lies on it.
TEST_F(ImageTruth, HasTheFloorsTexture) {
    survey_.rig.seafloor.reflectance = flat(0.5);
    survey_.rig.objects = {{.name = "grey", .shape = Sphere{}, .reflectance = flat(0.5)}};
    survey_.texture = 0.2;
    std::vector<float> texture(pixels());
    for (std::size_t i = 0; i < texture.size(); ++i)
        texture[i] = 0.5F + static_cast<float>(i) * 0x1p-7F;
    fs::create_directories(survey_.folder / "texture");
    for (const char* name : {"000001.exr", "000002.exr"})
        write_exr(survey_.folder / "texture" / name, survey_.rig.camera.width_px, texture, {"Y"});
    SeenPoint seen{.point_m = Vector3d::UnitZ(), .normal = -Vector3d::UnitZ(), .surface = 0};
    write(seen);
    const std::vector<float> floor = made("reflectance", {"G"});
    for (std::size_t i = 0; i < floor.size(); ++i)
        ASSERT_NEAR(floor[i], 0.5 * texture[i], kFloat) << i;
    fs::remove_all(survey_.folder / "reflectance");
    seen.surface = 1;
    write(seen);
    for (const float sample : made("reflectance", {"G"})) ASSERT_NEAR(sample, 0.5, kFloat);
}

TEST_F(ImageTruth, IsMadeWhereItIsAskedForAndMissing) {
    const SeenPoint seen{.point_m = Vector3d::UnitZ(), .normal = -Vector3d::UnitZ()};
    const std::uint64_t before = missing_bytes(survey_);
    survey_.truth = {.depth = true};
    EXPECT_EQ(before - missing_bytes(survey_), 2U * 24U * pixels()) << "six floats of two images";
    write(seen);
    EXPECT_FALSE(fs::exists(survey_.folder / "normals"));
    EXPECT_EQ(looks_, 2 * pixels());
    fs::remove(survey_.folder / "depth/000001.exr");
    write(seen);
    EXPECT_EQ(looks_, 3 * pixels());
    write(seen);
    EXPECT_EQ(looks_, 3 * pixels());
}

}  // namespace
}  // namespace aphotic::image_truth_test
