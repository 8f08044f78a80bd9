// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/beam.h"

#include "support/effort.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::beam_test {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
constexpr double kRounding = 1e-13;

Beam beam_of(std::vector<Cone> cones, ConeWeights weights = ConeWeights::Flux) {
    return {.name = "b", .weights = weights, .cones = std::move(cones)};
}

// The source paper's.
Beam fresnel() {
    return beam_of({{.part = "collimated", .half_angle_rad = 10.0 * kDegree, .weight = 0.165},
                    {.part = "focused", .half_angle_rad = 26.565 * kDegree, .weight = 0.094},
                    {.part = "diffuse", .half_angle_rad = 90.0 * kDegree, .weight = 0.741}});
}

const Vector3d kAxis = Vector3d(0.3, -0.5, 0.8).normalized();

Vector3d off_axis(double theta_rad, double phi_rad = 0.0, double length = 1.0) {
    const BeamFrame frame = frame_about(kAxis);
    return length * (std::cos(theta_rad) * frame.axis +
                     std::sin(theta_rad) *
                         (std::cos(phi_rad) * frame.along + std::sin(phi_rad) * frame.across));
}

double at(const Beam& beam, double theta_rad, double phi_rad = 0.0, double length = 1.0) {
    return intensity_towards(beam, frame_about(kAxis), off_axis(theta_rad, phi_rad, length));
}

// Over all directions, by the midpoint rule over the angle off the axis.
double flux_by_quadrature(const Beam& beam) {
    constexpr int kSteps = 20'000;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double theta_rad = (i + 0.5) / kSteps * 0.5 * kPi;
        sum += at(beam, theta_rad) * kPi * kPi * std::sin(theta_rad) / kSteps;
    }
    return sum;
}

TEST(FrameAbout, IsRightHandedAndLooksForward) {
    for (const Vector3d& axis : {kAxis, Vector3d(0.0, 0.0, 1.0), Vector3d(0.0, -1.0, 0.0)}) {
        const BeamFrame frame = frame_about(axis);
        EXPECT_NEAR((frame.along.cross(frame.across) - axis).norm(), 0.0, kRounding);
        EXPECT_NEAR(frame.along.norm(), 1.0, kRounding);
        EXPECT_GT(frame.along.x(), 0.0);
        EXPECT_NEAR(frame.across.x(), 0.0, kRounding) << "across is level with forward";
    }
    EXPECT_EQ(frame_about(Vector3d::UnitX()).along, Vector3d::UnitZ());
}

// 0.165/(pi sin^2 10) = 1.742, 0.094/(pi sin^2 26.565) = 0.150, 0.741/pi = 0.236: the figures that
// the source paper prints.
TEST(Intensity, HasTheFiguresOfTheSourcePapersCones) {
    constexpr double kThreeDecimals = 0.001;
    EXPECT_NEAR(at(fresnel(), 0.0), 1.742 + 0.150 + 0.236, kThreeDecimals);
    EXPECT_NEAR(
        at(fresnel(), 20.0 * kDegree), (0.150 + 0.236) * std::cos(20.0 * kDegree), kThreeDecimals);
    EXPECT_NEAR(at(fresnel(), 60.0 * kDegree), 0.118, kThreeDecimals);
    EXPECT_EQ(at(fresnel(), 100.0 * kDegree), 0.0);
}

TEST(Intensity, ContinuedIsOfTheSideOfTheEdgesThatIsAsked) {
    const Beam beam =
        beam_of({{.part = "", .half_angle_rad = 0.5, .weight = 0.75}}, ConeWeights::Literal);
    const auto continued = [&](double theta_rad, double from_rad) {
        return continued_intensity(
            beam, frame_about(kAxis), off_axis(theta_rad), off_axis(from_rad));
    };
    EXPECT_NEAR(continued(0.51, 0.49), 0.75 * std::cos(0.51), kRounding);
    EXPECT_EQ(continued(0.49, 0.51), 0.0);
    EXPECT_EQ(continued(2.0, 0.49), 0.0) << "behind the lamp";
}

// 2 pi int cos^n sin = 2 pi (1 - cos^(n + 1))/(n + 1); of n = 0, the solid angle.
TEST(FluxOf, IsThatOfAnyExponent) {
    constexpr double kQuadrature = 2e-3;  // the midpoint rule's over a step, or a steep end
    for (const double exponent : {0.0, 0.3, 1.0, 2.0, 7.3, 1000.0}) {
        for (const double gamma_deg : {5.0, 40.0, 90.0}) {
            const Cone cone{.part = "",
                            .half_angle_rad = gamma_deg * kDegree,
                            .weight = 0.4,
                            .exponent = exponent};
            EXPECT_EQ(flux_of(beam_of({cone})), 0.4);
            EXPECT_NEAR(flux_by_quadrature(beam_of({cone})) / 0.4, 1.0, kQuadrature)
                << exponent << ", " << gamma_deg;
        }
    }
    const auto literal = [](double gamma_rad, double exponent) {
        return beam_of(
            {{.part = "", .half_angle_rad = gamma_rad, .weight = 2.0, .exponent = exponent}},
            ConeWeights::Literal);
    };
    EXPECT_NEAR(flux_of(literal(kPi / 2.0, 0.0)), 4.0 * kPi, kRounding);
    EXPECT_NEAR(flux_of(literal(kPi / 3.0, 0.0)), 2.0 * kPi, kRounding);
    EXPECT_NEAR(flux_of(literal(kPi / 3.0, 3.0)), kPi * 15.0 / 16.0, kRounding);
    // A narrow cone is as flat as its disc, pi gamma^2, whatever its exponent.
    EXPECT_NEAR(flux_of(literal(1e-5, 3.0)) / (2.0 * kPi * 1e-10), 1.0, 1e-9);
}

TEST(Intensity, FallsAsTheExponentSays) {
    const Beam beam = beam_of({{.part = "", .half_angle_rad = 1.2, .weight = 2.0, .exponent = 3.0}},
                              ConeWeights::Literal);
    EXPECT_NEAR(at(beam, kPi / 3.0), 2.0 / 8.0, kRounding);
    EXPECT_NEAR(at(beam, 0.0), 2.0, kRounding);
    EXPECT_EQ(at(beam, 1.21), 0.0);
    EXPECT_EQ(steepest_exponent(beam), 3.0);
    // FWHM of 60 degrees is n = ln(1/2)/ln(cos 30).
    Beam sheet = beam;
    sheet.cones[0].exponent = std::log(0.5) / std::log(std::cos(kPi / 6.0));
    EXPECT_NEAR(at(sheet, kPi / 6.0), 1.0, kRounding);
}

TEST(Reaches, GoesToTheEdgeAndTheAngleBeyondIt) {
    const BeamFrame frame = frame_about(kAxis);
    const Beam beam = beam_of({{.part = "", .half_angle_rad = 0.5, .weight = 1.0}});
    EXPECT_TRUE(reaches(beam, frame, off_axis(0.4999), 0.0));
    EXPECT_FALSE(reaches(beam, frame, off_axis(0.5001), 0.0));
    EXPECT_TRUE(reaches(beam, frame, off_axis(0.6), 0.1001));
    EXPECT_FALSE(reaches(beam, frame, off_axis(0.6), 0.0999));
    const Beam dark = beam_of({{.part = "", .half_angle_rad = 0.5, .weight = 0.0}});
    EXPECT_FALSE(reaches(dark, frame, kAxis, 1.0));
    EXPECT_TRUE(is_dark(dark));
    EXPECT_FALSE(is_dark(beam));
}

TEST(Edges, AreOfConesThatShineAndEndBefore90Degrees) {
    Beam beam = fresnel();
    EXPECT_EQ(edges_rad(beam), (std::vector{10.0 * kDegree, 26.565 * kDegree}));
    beam.cones[0].weight = 0.0;
    EXPECT_EQ(edges_rad(beam), (std::vector{26.565 * kDegree}));
    beam.cones[2].exponent = 2.0;
    EXPECT_EQ(edges_rad(beam).size(), 1U);
    beam.cones[2].exponent = 0.5;  // which falls as steeply as a step
    EXPECT_EQ(edges_rad(beam).size(), 2U);
}

TEST(Parts, AddUpToTheBeamAndHaveItsConesNames) {
    const std::vector<Beam> parts = parts_of(fresnel());
    ASSERT_EQ(parts.size(), 3U);
    EXPECT_EQ(parts[1].name, "focused");
    for (const double theta_rad : {0.1, 0.3, 1.0}) {
        double sum = 0.0;
        for (const Beam& part : parts) sum += at(part, theta_rad);
        EXPECT_NEAR(sum, at(fresnel(), theta_rad), kRounding);
    }
    const Beam wide =
        parts_that(fresnel(), [](const Beam& part) { return part.name == "diffuse"; });
    EXPECT_EQ(wide.name, "b");
    EXPECT_NEAR(flux_of(wide), 0.741, kRounding);
}

TEST(BeamSignature, IsTheLightsAndNotTheNames) {
    Beam beam = fresnel();
    const std::string before = beam_signature(beam);
    beam.name = "another";
    beam.cones[0].part = "another";
    EXPECT_EQ(beam_signature(beam), before);
    beam.cones[2].weight += 1e-9;
    EXPECT_NE(beam_signature(beam), before);
    beam = fresnel();
    beam.cones[0].half_angle_rad -= 1e-9;
    EXPECT_NE(beam_signature(beam), before);
    beam = fresnel();
    beam.cones[2].exponent += 1e-9;
    EXPECT_NE(beam_signature(beam), before);
    beam = fresnel();
    beam.weights = ConeWeights::Literal;
    EXPECT_NE(beam_signature(beam), before);
}

// --- Soft edges, patterns, windows -----------------------------------------------------------

Beam soft(double half_deg, double edge_deg, double exponent) {
    return beam_of({{.part = "soft",
                     .half_angle_rad = half_deg * kDegree,
                     .weight = 0.7,
                     .exponent = exponent,
                     .edge_rad = edge_deg * kDegree}});
}

// Nodes that follow no rule, light that is nowhere alike.
BeamTable table_of(TableAngles angles, unsigned seed = 3) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> step(0.5, 1.5);
    const auto nodes = [&](double first, double last, int count) {
        std::vector<double> values(1, 0.0);
        for (int i = 1; i < count; ++i) values.push_back(values.back() + step(engine));
        for (double& value : values) value = first + (last - first) * value / values.back();
        values.back() = last;
        return values;
    };
    const bool is_c = angles == TableAngles::TypeC;
    BeamTable table{.angles = angles,
                    .vertical_rad = is_c ? nodes(0.0, 1.2, 7) : nodes(-0.9, 1.1, 8),
                    .horizontal_rad = is_c ? nodes(0.0, 2.0 * kPi, 9) : nodes(-0.8, 0.7, 6),
                    .intensity = {}};
    for (std::size_t i = 0; i < table.horizontal_rad.size() * table.vertical_rad.size(); ++i) {
        table.intensity.push_back(step(engine));
    }
    const std::size_t rows = table.vertical_rad.size();
    for (std::size_t i = 0; is_c && i < rows; ++i) {
        table.intensity[table.intensity.size() - rows + i] = table.intensity[i];
    }
    return table;
}

const BeamOptics kOptics{.along_m = 0.0635,
                         .across_m = 0.0302,
                         .focal_length_m = 0.065,
                         .distance_m = 0.04,
                         .aperture_m = 0.08};
const BeamWindow kWindow{.glass_index = 1.5185, .water_index = 1.3437};

Beam pattern_of(BeamPattern pattern, double turn_rad = 0.4) {
    Beam beam{.name = "p", .cones = {}, .pattern = std::move(pattern), .turn_rad = turn_rad};
    return scaled_to_flux(std::move(beam));
}

// One of every kind, in water and behind a window.
std::vector<Beam> all_kinds() {
    BeamOptics focused = kOptics;
    focused.distance_m = focused.focal_length_m;
    std::vector<Beam> beams{fresnel(),
                            soft(50.0, 20.0, 2.5),
                            pattern_of(table_of(TableAngles::TypeA)),
                            pattern_of(table_of(TableAngles::TypeB)),
                            pattern_of(table_of(TableAngles::TypeC)),
                            pattern_of(kOptics),
                            pattern_of(focused)};
    const std::size_t in_water = beams.size();
    for (std::size_t i = 0; i < in_water; ++i) {
        beams.push_back(beams[i]);
        beams.back().window = kWindow;
    }
    return beams;
}

// Over the sphere, midpoints in both angles.
double flux_all_round(const Beam& beam, double widest_rad, int rings = 1000) {
    constexpr int kTurns = 180;
    double sum = 0.0;
    for (int i = 0; i < rings; ++i) {
        const double theta_rad = widest_rad * (i + 0.5) / rings;
        for (int j = 0; j < kTurns; ++j) {
            sum += at(beam, theta_rad, 2.0 * kPi * (j + 0.5) / kTurns) * std::sin(theta_rad);
        }
    }
    return sum * widest_rad / rings * 2.0 * kPi / kTurns;
}

// POV-Ray's t^2 (3 - 2 t), t along the cosine: 1/2 in the middle, 5/32 at a quarter.
TEST(SoftEdge, FallsByHalfInTheMiddleOfItsCosines) {
    const Beam beam = soft(40.0, 15.0, 0.0);
    const auto of_axis = [&](double t) {
        const double cosine = std::lerp(std::cos(40.0 * kDegree), std::cos(25.0 * kDegree), t);
        return at(beam, std::acos(cosine)) / at(beam, 0.0);
    };
    EXPECT_NEAR(of_axis(0.5), 0.5, kRounding);
    EXPECT_NEAR(of_axis(0.25), 5.0 / 32.0, kRounding);
    EXPECT_NEAR(at(beam, 24.99 * kDegree) / at(beam, 0.0), 1.0, kRounding);
    EXPECT_EQ(at(beam, 40.01 * kDegree), 0.0);
    EXPECT_TRUE(edges_rad(beam).empty());
}

TEST(SoftEdge, KeepsTheConesShareOfTheFlux) {
    constexpr double kMidpoints = 1e-7;
    for (const double half_deg : {20.0, 60.0, 90.0}) {
        for (const double edge_deg : {0.5, 10.0, 20.0}) {
            for (const double exponent : {0.0, 1.0, 3.7}) {
                const Beam beam = soft(half_deg, edge_deg, exponent);
                EXPECT_NEAR(flux_by_quadrature(beam), 0.7, kMidpoints)
                    << half_deg << " " << edge_deg;
                EXPECT_NEAR(flux_of(beam), 0.7, kRounding);
            }
        }
    }
}

TEST(Patterns, HaveAFluxOfOne) {
    constexpr double kMidpoints = 5e-6;
    constexpr double kStepsAtEnds = 3e-3;  // a table or a sharp image ends between the midpoints
    for (const Beam& beam : all_kinds()) {
        if (beam.window || !beam.cones.empty()) continue;
        const bool has_edges = has_rim(beam) || !edges_rad(beam).empty();
        EXPECT_NEAR(flux_all_round(beam, kPi), 1.0, has_edges ? kStepsAtEnds : kMidpoints);
    }
}

// What leaves the window is what the light has in air, less what the faces reflect: under 5 % for
// light near the axis.
TEST(Windows, LoseWhatTheyReflect) {
    constexpr double kGrid = 5e-3;
    for (const Beam& beam : all_kinds()) {
        if (!beam.window) continue;
        const double flux = flux_of(beam);
        Beam bare = beam;
        bare.window.reset();
        EXPECT_GT(flux, 0.85 * flux_of(bare));
        EXPECT_LT(flux, 0.96 * flux_of(bare));
        EXPECT_NEAR(flux_all_round(beam, widest_in_water_rad(kWindow), 200) / flux, 1.0, kGrid);
    }
    const Beam narrow = [] {
        Beam beam = beam_of({{.part = "n", .half_angle_rad = 0.01, .weight = 1.0}});
        beam.window = kWindow;
        return beam;
    }();
    EXPECT_NEAR(flux_of(narrow), transmittance_by_cosine(kWindow, 1.0), 1e-3);
    // In air the same light is n^2 as bright on the axis, but for that.
    Beam in_air = narrow;
    in_air.window.reset();
    EXPECT_NEAR(at(narrow, 0.0) / at(in_air, 0.0),
                transmittance_by_cosine(kWindow, 1.0) * 1.3437 * 1.3437,
                1e-12);
}

// Type C grows from along away from across; turned by a quarter it begins at across.
TEST(Patterns, TurnFromAlongToAcross) {
    const BeamTable table = table_of(TableAngles::TypeC);
    const Beam straight = pattern_of(table, 0.0);
    const Beam turned = pattern_of(table, 0.5 * kPi);
    for (const double phi_rad : {0.0, 0.7, 2.0, 4.0}) {
        EXPECT_NEAR(at(turned, 0.6, phi_rad + 0.5 * kPi), at(straight, 0.6, phi_rad), 1e-12);
    }
    const double first = table_intensity(table, {std::sin(0.6), 0.0, std::cos(0.6)});
    EXPECT_NEAR(at(turned, 0.6, 0.5 * kPi), turned.per_flux * first, 1e-12);
    EXPECT_NEAR(at(straight, 0.6, -0.5 * kPi),
                straight.per_flux *
                    table_intensity(table, direction_at(TableAngles::TypeC, {0.6, 0.5 * kPi})),
                1e-12);
}

TEST(MostIntensity, BoundsEveryKind) {
    std::mt19937 engine(11);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (const Beam& beam : all_kinds()) {
        const BeamFrame frame = frame_about(kAxis);
        const double rounding = 1e-12 * most_intensity(beam);
        for (int trial = 0; trial < 150; ++trial) {
            const Vector3d middle = off_axis(1.4 * share(engine), 2.0 * kPi * share(engine));
            const double within_rad = 0.5 * share(engine) * share(engine);
            const double bound = most_intensity(beam, frame, middle, within_rad);
            EXPECT_LE(bound, most_intensity(beam) + rounding);
            for (int k = 0; k < 40; ++k) {
                const Vector3d aside =
                    middle.cross(off_axis(kPi * share(engine), 2.0 * kPi * share(engine)))
                        .normalized();
                const double angle_rad = within_rad * share(engine);
                const double found = intensity_towards(
                    beam, frame, std::cos(angle_rad) * middle + std::sin(angle_rad) * aside);
                ASSERT_LE(found, bound + rounding) << beam.pattern.index() << " " << trial;
                if (found > rounding) {
                    ASSERT_TRUE(reaches(beam, frame, middle, within_rad));
                }
            }
        }
    }
}

// Neighbours that differ much are on either side of an edge, and of no other thing.
TEST(Edges, AreWhereTheLightJumps) {
    constexpr double kBeside_rad = 1e-7;
    constexpr double kJump = 1e-3;
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (const Beam& beam : all_kinds()) {
        const BeamFrame frame = frame_about(kAxis);
        const std::vector<double> edges = edges_rad(beam);
        for (int line = 0; line < cases(20); ++line) {
            const double phi_rad = 2.0 * kPi * share(engine);
            for (double theta_rad = 0.001; theta_rad < 1.55; theta_rad += 0.0007) {
                const double from = at(beam, theta_rad, phi_rad);
                const double to = at(beam, theta_rad + 0.0007, phi_rad);
                if (std::abs(from - to) <= 0.05 * most_intensity(beam)) continue;
                // Halve the step until it is one.
                double inner = theta_rad;
                double outer = theta_rad + 0.0007;
                while (outer - inner > kBeside_rad) {
                    const double middle = 0.5 * (inner + outer);
                    (std::abs(at(beam, middle, phi_rad) - from) < 0.5 * std::abs(from - to)
                         ? inner
                         : outer) = middle;
                }
                if (std::abs(at(beam, inner, phi_rad) - at(beam, outer, phi_rad)) <
                    kJump * most_intensity(beam)) {
                    continue;
                }
                const bool is_circle = std::ranges::any_of(edges, [&](double edge_rad) {
                    return edge_rad >= inner - kBeside_rad && edge_rad <= outer + kBeside_rad;
                });
                const bool is_rim =
                    has_rim(beam) && is_within_rim(beam, frame, off_axis(inner, phi_rad)) !=
                                         is_within_rim(beam, frame, off_axis(outer, phi_rad));
                EXPECT_TRUE(is_circle || is_rim)
                    << beam.pattern.index() << " at " << inner / kDegree << " degrees";
            }
        }
    }
}

// By the light of where it comes from: beyond an edge it goes on, and from beyond there is none.
TEST(Intensity, OfEveryKindContinuesFromItsOwnSide) {
    const BeamFrame frame = frame_about(kAxis);
    const Beam table = pattern_of(table_of(TableAngles::TypeC));
    const Vector3d inside = off_axis(1.2 - 1e-6, 1.0);
    const Vector3d outside = off_axis(1.2 + 1e-6, 1.0);
    EXPECT_EQ(intensity_towards(table, frame, outside), 0.0);
    EXPECT_NEAR(continued_intensity(table, frame, outside, inside),
                intensity_towards(table, frame, inside),
                1e-5);
    EXPECT_EQ(continued_intensity(table, frame, inside, outside), 0.0);
}

TEST(BeamSignature, KnowsEveryKindByAllThatItHas) {
    std::vector<Beam> beams = all_kinds();
    beams.push_back(pattern_of(table_of(TableAngles::TypeC, 4)));
    beams.push_back(pattern_of(table_of(TableAngles::TypeC), 0.5));
    beams.push_back(soft(50.0, 19.0, 2.5));
    std::set<std::string> signatures;
    for (const Beam& beam : beams) signatures.insert(beam_signature(beam));
    EXPECT_EQ(signatures.size(), beams.size());
}

}  // namespace
}  // namespace aphotic::beam_test
