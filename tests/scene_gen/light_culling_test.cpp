// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/light_culling.h"

#include "rig/geometry.h"
#include "support/dice.h"
#include "support/scene_rig.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::light_culling_test {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr unsigned kSeed = 20240613;

// --- The list -------------------------------------------------------------------------- --------

using Pairs = std::vector<std::pair<std::string, std::string>>;

Pairs omitted(const Rig& rig) {
    Pairs pairs;
    for (const Omission& o : omissions(rig)) pairs.emplace_back(o.what, o.reason);
    return pairs;
}

const std::pair<std::string, std::string> kMedium{"the water's medium",
                                                  "clear water attenuates nothing"};
const std::pair<std::string, std::string> kNoPort{"a port",
                                                  "none is given: the pupil is in the water"};
const std::pair<std::string, std::string> kNoHighlight{"the floor's highlight",
                                                       "its strength is 0"};

TEST(Omissions, OfHabCamAreThePortAndTheHighlight) {
    EXPECT_EQ(omitted(scene_rig("habcam.toml")), (Pairs{kNoPort, kNoHighlight}));
}

TEST(Omissions, NameTheHighlightsThatObjectsHaveNot) {
    EXPECT_EQ(omitted(scene_rig("objects.toml")),
              (Pairs{kNoPort,
                     kNoHighlight,
                     {"the highlight of object 'rock'", "its strength is 0"},
                     {"the highlight of object 'block'", "its strength is 0"}}));
}

TEST(Omissions, NameTheMediumInClearWaterOnly) {
    Rig rig = scene_rig("habcam.toml");
    rig.water.multiple = 0.0;
    EXPECT_EQ(omitted(rig), (Pairs{kMedium, kNoPort, kNoHighlight}));
    rig.water.uniform_loss_per_m = 1e-6;
    EXPECT_EQ(omitted(rig), (Pairs{kNoPort, kNoHighlight}));
    rig.water = {.absorption_per_m = rig.water.absorption_per_m, .multiple = 1e-6};
    EXPECT_EQ(omitted(rig), (Pairs{kNoPort, kNoHighlight}));
}

TEST(Omissions, NameAStrobeWithoutPowerAndNotItsCones) {
    Rig rig = scene_rig("habcam.toml");
    rig.strobes[1].power = 0.0;
    rig.strobes[1].beam.cones[0].weight = 0.0;
    EXPECT_EQ(omitted(rig), (Pairs{kNoPort, kNoHighlight, {"strobe 'aft'", "its power is 0"}}));
    rig.strobes[1].power = 1e-9;
    rig.strobes[1].beam.cones[0].weight = 1e-9;
    EXPECT_EQ(omitted(rig), (Pairs{kNoPort, kNoHighlight}));
}

TEST(Omissions, NameEveryConeWithoutWeight) {
    Rig rig = scene_rig("habcam.toml");
    rig.strobes[0].beam.cones[1].weight = 0.0;
    rig.strobes[3].beam.cones[2].weight = 0.0;
    EXPECT_EQ(omitted(rig),
              (Pairs{kNoPort,
                     kNoHighlight,
                     {"the focused cone of strobe 'fore'", "its weight is 0"},
                     {"the diffuse cone of strobe 'starboard'", "its weight is 0"}}));
}

// Straight up: the narrow cones light nothing at all, and the half space of the diffuse one is
// above the strobe.
TEST(Omissions, NameEveryConeThatLightsNothingInView) {
    const std::string reason = "it lights nothing in view";
    Rig rig = scene_rig("habcam.toml");
    rig.strobes[2].axis = -Vector3d::UnitZ();
    EXPECT_EQ(omitted(rig),
              (Pairs{kNoPort,
                     kNoHighlight,
                     {"the collimated cone of strobe 'port'", reason},
                     {"the focused cone of strobe 'port'", reason},
                     {"the diffuse cone of strobe 'port'", reason}}));
    // Level to port, away from a view that ends at 0.73 m: half of the diffuse cone still reaches
    // the floor, but none that the image sees.
    rig.strobes[2].position_m = {0.0, -0.8, 0.0};
    rig.strobes[2].axis = -Vector3d::UnitY();
    EXPECT_EQ(omitted(rig).size(), 5U);
    // Level to starboard, over the view: the half space takes it in, the narrow ones pass over it.
    rig.strobes[2].axis = Vector3d::UnitY();
    EXPECT_EQ(omitted(rig),
              (Pairs{kNoPort,
                     kNoHighlight,
                     {"the collimated cone of strobe 'port'", reason},
                     {"the focused cone of strobe 'port'", reason}}));
}

// --- What lights the view -------------------------------------------------------------- --------

Beam cone_of(double half_angle_rad) {
    return {.name = "c",
            .weights = ConeWeights::Flux,
            .cones = {{.part = "c", .half_angle_rad = half_angle_rad, .weight = 1.0}}};
}

// HabCam's camera over a level floor, with one strobe.
Rig rig_with_strobe(const Vector3d& position_m, const Vector3d& axis) {
    Rig rig = scene_rig("habcam.toml");
    rig.sled.pitch_rad = 0.0;
    rig.strobes.resize(1, rig.strobes.front());
    rig.strobes[0].position_m = position_m;
    rig.strobes[0].axis = axis.normalized();
    return rig;
}

bool is_lit(const Rig& rig, double half_angle_deg) {
    return lights_the_view(rig, rig.strobes[0], cone_of(half_angle_deg * kDegree));
}

// The image sees the floor from -0.550 to 0.550 m fore and aft and from -0.731 to 0.731 m across:
// half of 1024 and of 1360 pixels of 6.45 um, times 2 m over 12 mm. From a strobe at the pupil its
// edge is 20.08 degrees off the axis; a 33rd of the image is 1.2 degrees of room.
TEST(LightsTheView, OfABeamThatPassesItByIsNo) {
    constexpr double kEdgeDeg = 20.08;
    constexpr double kRoomDeg = 1.5;
    const auto beside = [&](double deg) {
        return rig_with_strobe(Vector3d::Zero(),
                               {0.0, std::sin(deg * kDegree), std::cos(deg * kDegree)});
    };
    for (const double half_deg : {0.1, 1.0, 10.0}) {
        EXPECT_TRUE(is_lit(beside(kEdgeDeg + half_deg - 0.01), half_deg)) << half_deg;
        EXPECT_FALSE(is_lit(beside(kEdgeDeg + half_deg + kRoomDeg), half_deg)) << half_deg;
        EXPECT_FALSE(is_lit(beside(-kEdgeDeg - half_deg - kRoomDeg), half_deg)) << half_deg;
    }
}

// A beam that passes over the floor in view, and meets a ball on its way.
TEST(LightsTheView, OfABeamThatMeetsAnObjectIsYes) {
    Rig rig = rig_with_strobe({-3.0, 0.0, 1.0}, Vector3d::UnitX());
    const Beam cone = cone_of(3.0 * kDegree);
    EXPECT_FALSE(lights_the_view(rig, rig.strobes.front(), cone));
    rig.objects = {{.name = "ball",
                    .shape = Sphere{.centre_m = {0.0, 0.0, 1.0}, .radius_m = 0.1},
                    .reflectance = rig.seafloor.reflectance}};
    EXPECT_TRUE(lights_the_view(rig, rig.strobes.front(), cone));
    rig.objects[0].shape = Sphere{.centre_m = {0.0, 0.0, 1.4}, .radius_m = 0.1};
    EXPECT_FALSE(lights_the_view(rig, rig.strobes.front(), cone));
}

// Water on the upper part of the image, floor on the lower: a beam that comes down at all comes
// down in view, however far away.
TEST(LightsTheView, OfABeamTowardsTheHorizonInViewIsYes) {
    for (const char* scene : {"habcam.toml", "port.toml"}) {
        Rig rig = scene_rig(scene);
        // The horizon runs through one cell of the grid, which is a degree high, and the next.
        for (double pitch_deg = 80.0; pitch_deg < 81.0; pitch_deg += 0.1) {
            rig.sled.pitch_rad = pitch_deg * kDegree;
            const Vector3d down = -floor_plane(rig.sled).normal;
            const Vector3d ahead = (Vector3d::UnitX() - down.x() * down).normalized();
            for (const double under_deg : {5.0, 1.0, 0.1, 0.001}) {
                rig.strobes[0].axis =
                    std::cos(under_deg * kDegree) * ahead + std::sin(under_deg * kDegree) * down;
                EXPECT_TRUE(is_lit(rig, 1e-4)) << scene << ", pitch " << pitch_deg << ", beam "
                                               << under_deg << " degrees under the horizon";
            }
        }
    }
}

TEST(LightsTheView, OfAViewWithoutFloorIsNo) {
    Rig rig = rig_with_strobe({0.5, 0.0, 0.0}, {0.0, 0.0, 1.0});
    rig.sled.roll_rad = 120.0 * kDegree;
    EXPECT_FALSE(is_lit(rig, 90.0));
}

// --- Brute force ----------------------------------------------------------------------- --------

std::optional<Vector3d> floor_at(const Rig& rig, double column, double row, double lambda_nm) {
    const WaterRay ray = pixel_ray(rig, column, row, lambda_nm);
    const auto distance_m = distance_to(floor_plane(rig.sled), ray);
    if (!distance_m) return std::nullopt;
    return ray.origin_m + *distance_m * ray.direction;
}

// This far above the floor, over its point nearest to this one.
Vector3d raised(const Rig& rig, const Vector3d& floor_m, double height_m) {
    return floor_m + height_m * floor_plane(rig.sled).normal;
}

double angle_between(const Vector3d& a, const Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

Rig random_rig(Dice& dice, bool has_port) {
    static const Rig kHabcam = scene_rig("habcam.toml");
    static const Rig kBehindAPort = scene_rig("port.toml");
    Rig rig = has_port ? kBehindAPort : kHabcam;
    rig.sled = {.altitude_m = dice.between(0.5, 6.0),
                .pitch_rad = dice.between(-0.7, 0.7),
                .roll_rad = dice.between(-0.7, 0.7)};
    rig.camera.focal_length_m = dice.between(0.006, 0.03);
    rig.strobes.resize(1, rig.strobes.front());
    return rig;
}

// A place in the image, every other one on its edge.
std::pair<double, double> random_place(const Rig& rig, Dice& dice) {
    double column = dice.between(0.0, 1.0);
    double row = dice.between(0.0, 1.0);
    if (dice.chance(0.5)) (dice.chance(0.5) ? column : row) = dice.chance(0.5) ? 0.0 : 1.0;
    return {column * rig.camera.width_px, row * rig.camera.height_px};
}

// Puts the strobe anywhere, or close to the floor near what the image sees, and aims a narrow cone
// so that it just takes in a floor point that the image sees at this wavelength. Nothing, where
// the place shows no floor.
std::optional<Beam> aim_at_the_view(Rig& rig, double lambda_nm, Dice& dice) {
    const auto [column, row] = random_place(rig, dice);
    const auto [near_column, near_row] = random_place(rig, dice);
    const auto target_m = floor_at(rig, column, row, lambda_nm);
    const auto near_m = floor_at(rig, near_column, near_row, lambda_nm);
    if (!target_m || !near_m) return std::nullopt;
    Strobe& strobe = rig.strobes[0];
    const double height_m = std::pow(10.0, dice.between(-2.0, 0.5));
    const Vector3d aside(dice.between(-1.0, 1.0), dice.between(-1.0, 1.0), dice.between(-1.0, 1.0));
    const Vector3d on_floor_m = dice.chance(0.5) ? *near_m : *target_m + 0.1 * aside;
    const Plane floor = floor_plane(rig.sled);
    const Vector3d foot_m = on_floor_m - height_above(floor, on_floor_m) * floor.normal;
    strobe.position_m = raised(rig, foot_m, height_m);
    // Off the target by almost the cone's half angle.
    const double half_rad = std::pow(10.0, dice.between(-4.0, -0.5));
    const Vector3d towards = (*target_m - strobe.position_m).normalized();
    const Vector3d sideways = towards.cross(aside).normalized();
    strobe.axis = Eigen::AngleAxisd(0.999 * half_rad, sideways) * towards;
    EXPECT_LT(angle_between(strobe.axis, towards), half_rad);
    return cone_of(half_rad);
}

// A cone that lights a floor point in view must not be left out.
void expect_no_light_is_left_out(bool has_port, int rigs) {
    Dice dice(kSeed);
    int aimed = 0;
    int left_out = 0;
    std::string first;
    for (int n = 0; n < rigs; ++n) {
        Rig rig = random_rig(dice, has_port);
        const WavelengthRange range = rig.camera.range;
        const double nm = dice.chance(0.3)   ? range.first_nm
                          : dice.chance(0.5) ? range.last_nm
                                             : dice.between(range.first_nm, range.last_nm);
        const auto cone = aim_at_the_view(rig, nm, dice);
        if (!cone) continue;
        ++aimed;
        if (lights_the_view(rig, rig.strobes[0], *cone)) continue;
        ++left_out;
        if (!first.empty()) continue;
        first = "rig " + std::to_string(n) + " at " + std::to_string(nm) + " nm, strobe " +
                std::to_string(height_above(floor_plane(rig.sled), rig.strobes[0].position_m)) +
                " m above the floor, cone of " + std::to_string(cone->cones[0].half_angle_rad) +
                " rad";
    }
    EXPECT_EQ(left_out, 0) << "of " << aimed << " cones; the first is that of " << first;
    EXPECT_GT(aimed, rigs / 2);
}

TEST(LightsTheView, NeverLeavesOutLightInView) {
    expect_no_light_is_left_out(false, 4000);
}

TEST(LightsTheView, NeverLeavesOutLightInViewBehindAPort) {
    expect_no_light_is_left_out(true, 4000);
}

// At 720 nm the image's corner lies some 3 mm outside that of 560 nm: half a degree, from a lamp
// that is 0.3 m away, and many from a low one.
TEST(LightsTheView, TakesInTheRimThatOnlyOtherWavelengthsSee) {
    Rig rig = scene_rig("port.toml");
    rig.sled.pitch_rad = 0.0;
    rig.strobes.resize(1, rig.strobes.front());
    Strobe& strobe = rig.strobes[0];
    const Vector3d corner_m = *floor_at(rig, 0.0, 0.0, 560.0);
    const Vector3d red_corner_m = *floor_at(rig, 0.1, 0.1, 720.0);
    const Vector3d outward = Vector3d(corner_m.x(), corner_m.y(), 0.0).normalized();
    for (const double height_m : {0.02, 0.05, 0.1, 0.3, 1.0}) {
        for (const double outside_m : {-0.05, 0.0, 0.02, 0.05, 0.1, 0.3}) {
            strobe.position_m = raised(rig, corner_m + outside_m * outward, height_m);
            strobe.axis = (red_corner_m - strobe.position_m).normalized();
            EXPECT_TRUE(lights_the_view(rig, strobe, cone_of(0.01 * kDegree)))
                << height_m << " m above the floor, " << outside_m
                << " m outside the corner; from there, the corner of 560 nm is "
                << angle_between(corner_m - strobe.position_m, strobe.axis) << " rad off";
        }
    }
}

// The other way round: cones aimed anywhere, and the whole image looked at for what they light. A
// no must be right everywhere; a yes may be wrong only within a cell of the cone's edge.
TEST(LightsTheView, AgreesWithAFineLookAtTheImage) {
    constexpr int kSide = 100;
    constexpr double kRoom = 3.0;  // cells that a yes may be off by
    Dice dice(kSeed);
    int yes = 0;
    int no = 0;
    for (int n = 0; n < 300; ++n) {
        Rig rig = random_rig(dice, n % 2 == 1);
        Strobe& strobe = rig.strobes[0];
        strobe.position_m = {dice.between(-1.0, 1.0),
                             dice.between(-1.0, 1.0),
                             dice.between(-0.5, 0.3) * rig.sled.altitude_m};
        if (height_above(floor_plane(rig.sled), strobe.position_m) < 0.3) continue;
        strobe.axis = Vector3d(dice.between(-1.0, 1.0), dice.between(-1.0, 1.0), 1.0).normalized();
        const double half_rad = dice.between(0.001, 0.4);
        double nearest_rad = std::numbers::pi;
        double cell_rad = 0.0;
        bool has_horizon = false;
        std::optional<Vector3d> last;
        for (int j = 0; j <= kSide; ++j) {
            for (int i = 0; i <= kSide; ++i) {
                const auto point_m = floor_at(rig,
                                              rig.camera.width_px * (i / 1.0 / kSide),
                                              rig.camera.height_px * (j / 1.0 / kSide),
                                              j % 2 == 0 ? 400.0 : 720.0);
                has_horizon |= !point_m;
                if (!point_m) continue;
                const Vector3d towards = *point_m - strobe.position_m;
                nearest_rad = std::min(nearest_rad, angle_between(strobe.axis, towards));
                if (i > 0 && last) {
                    // Three of these to a cell of the 33 by 33 grid, and as much the other way.
                    cell_rad =
                        std::max(cell_rad, 3.0 * angle_between(towards, *last - strobe.position_m));
                }
                last = point_m;
            }
        }
        if (has_horizon) continue;
        const bool found = lights_the_view(rig, strobe, cone_of(half_rad));
        (found ? yes : no) += 1;
        if (nearest_rad <= half_rad) {
            EXPECT_TRUE(found) << "rig " << n << ": floor in view at " << nearest_rad
                               << " rad off the axis of a cone of " << half_rad << " rad";
        } else if (nearest_rad > half_rad + kRoom * cell_rad + 0.02) {
            EXPECT_FALSE(found) << "rig " << n << ": no floor in view closer than " << nearest_rad
                                << " rad to the axis of a cone of " << half_rad
                                << " rad; a cell is " << cell_rad << " rad";
        }
    }
    EXPECT_GT(yes, 30);
    EXPECT_GT(no, 30);
}

// All lamps of an emitter shine along its axis: any of them that reaches the view counts.
TEST(LightsTheView, CountsEveryLampOfAnEmitter) {
    Dice dice(kSeed);
    int aimed = 0;
    for (int n = 0; n < 2000; ++n) {
        Rig rig = random_rig(dice, false);
        const auto cone = aim_at_the_view(rig, 550.0, dice);
        if (!cone) continue;
        Strobe& strobe = rig.strobes[0];
        strobe.emitter = Emitter{.across_m = dice.between(0.0, 0.3), .along_m = 0.1};
        // One lamp stands where the strobe was aimed from.
        const auto lamps_m = lamp_positions_m(strobe, {.across = 5, .along = 5});
        const auto lamp = static_cast<std::size_t>(dice.between(0.0, 25.0));
        strobe.position_m += strobe.position_m - lamps_m[lamp];
        ++aimed;
        EXPECT_TRUE(lights_the_view(rig, strobe, *cone))
            << "rig " << n << ", lamp " << lamp << " of an emitter of " << strobe.emitter->across_m
            << " m, " << height_above(floor_plane(rig.sled), strobe.position_m)
            << " m above the floor";
    }
    EXPECT_GT(aimed, 1000);
}

}  // namespace
}  // namespace aphotic::light_culling_test
