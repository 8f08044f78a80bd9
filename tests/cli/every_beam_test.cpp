// SPDX-License-Identifier: BSD-3-Clause
//
// Every kind of beam through both renderers, as a rig file says it: three strobes that no mirror
// makes alike, over a floor that leans, with and without a port.
#include "support/command_test.h"
#include "support/has.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <ostream>

namespace aphotic::every_beam_test {
namespace {

constexpr double kHalfFloatBound = 6e-4;

struct Kind {
    const char* name;
    const char* beam;       // the lines of [beam.made]
    bool is_smooth;         // no pixel is on an edge
    const char* more = "";  // of every strobe
};
void PrintTo(const Kind& kind, std::ostream* out) {
    *out << kind.name;
}

std::string rig_of(const Kind& kind, bool has_port) {
    const auto strobe = [&](const char* name, const char* position, const char* direction) {
        return fmt::format(
            "[[strobe]]\nname = \"{}\"\nposition_m = {}\ndirection = {}\nbeam = \"made\"\n{}\n",
            name,
            position,
            direction,
            kind.more);
    };
    return std::string(
               "[sled]\naltitude_m = 1.7\npitch_deg = 6\nroll_deg = -4\n"
               "[camera]\nresolution = [40, 30]\npixel_pitch_um = 220\nfocal_length_mm = 12\n"
               "range_nm = [420, 680]\nresponse = \"nikon-d5100\"\n") +
           (has_port ? "[camera.port]\nshape = \"flat\"\ndistance_mm = 50\nthickness_mm = 12\n"
                       "glass = \"bk7\"\n"
                     : "") +
           "[water]\n[seafloor]\n[beam.made]\n" + kind.beam + "\n" +
           strobe("fore", "[0.52, 0.04, 0.0]", "[-0.43, 0.06, 0.9]") +
           strobe("aft", "[-0.47, -0.1, 0.05]", "[0.35, 0.1, 0.85]") +
           strobe("port", "[0.05, -0.5, -0.02]", "[0.1, 0.5, 0.9]");
}

// Uneven nodes, and light that no turn or mirror leaves as it is.
std::string csv_of_two_angles() {
    std::string text = "theta_deg,phi_deg,intensity\n";
    for (const int phi_deg : {0, 40, 100, 170, 230, 300, 360}) {
        for (const int theta_deg : {0, 8, 20, 35, 55, 80, 90}) {
            const double turn = (phi_deg % 360) / 57.3;
            const double theta = theta_deg / 57.3;
            const double value = theta_deg == 90
                                     ? 0.0
                                     : 10.0 * std::exp(-2.0 * theta * theta) *
                                           (1.0 + 0.4 * std::sin(turn) * std::sin(theta));
            text += fmt::format("{},{},{:.6f}\n", theta_deg, phi_deg, value);
        }
    }
    return text;
}

// Type B: wide across, narrow along, brighter to one side; and on the sides it is dark.
std::string ies_of_type_b() {
    std::string text =
        "IESNA:LM-63-2002\n[TEST] made\n[TESTLAB] none\n[ISSUEDATE] none\n[MANUFAC] "
        "none\nTILT=NONE\n"
        "1 1000 1 7 9 2 2 0 0 0\n1 1 10\n-60 -35 -15 0 15 35 60\n-80 -55 -30 -12 0 12 30 55 80\n";
    for (const double h_deg : {-80.0, -55.0, -30.0, -12.0, 0.0, 12.0, 30.0, 55.0, 80.0}) {
        for (const double v_deg : {-60.0, -35.0, -15.0, 0.0, 15.0, 35.0, 60.0}) {
            const bool is_side = std::abs(h_deg) == 80.0 || std::abs(v_deg) == 60.0;
            const double value = is_side ? 0.0
                                         : 900.0 * std::exp(-std::pow(v_deg / 30.0, 2)) *
                                               (1.0 - 0.006 * h_deg + 0.003 * v_deg);
            text += fmt::format("{:.3f} ", value);
        }
        text += "\n";
    }
    return text;
}

void write_rig(const std::filesystem::path& folder, const Kind& kind, bool has_port) {
    write_file(folder / "rig.toml", rig_of(kind, has_port));
    write_file(folder / "two.csv", csv_of_two_angles());
    write_file(folder / "b.ies", ies_of_type_b());
    write_file(folder / "one.csv", "theta_deg,intensity\n0,5\n12,4.6\n33,2\n61,0.4\n90,0\n");
}

class EveryBeam : public CommandTest, public testing::WithParamInterface<std::tuple<Kind, bool>> {};

TEST_P(EveryBeam, Validates) {
    const auto& [kind, has_port] = GetParam();
    write_rig(home_, kind, has_port);
    const auto json =
        json_by("validate rig.toml -o out --per-frame 1 --wavelengths 450,550,650 --json");
    ASSERT_EQ(json.at("wavelengths").size(), 3U);
    for (const auto& wavelength : json.at("wavelengths")) {
        EXPECT_LE(wavelength.at("max_error").get<double>(), kHalfFloatBound) << wavelength.dump();
        if (kind.is_smooth) {
            EXPECT_EQ(wavelength.at("on_edges").get<int>(), 0) << wavelength.dump();
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds,
    EveryBeam,
    testing::Combine(
        testing::Values(
            Kind{"Soft",
                 "cones = [{ part = \"a\", half_angle_deg = 35, weight = 0.6, edge_deg = 20 },\n"
                 "         { part = \"b\", half_angle_deg = 90, weight = 0.4, exponent = 2.5 }]",
                 true},
            Kind{"Fwhm", "fwhm_deg = 75", true},
            Kind{"FwhmInAir", "fwhm_deg = 100\nmeasured_in = \"air\"\nwindow = \"pmma\"", false},
            Kind{"TypeB", "table = \"b.ies\"\nturn_deg = 25", true},
            Kind{"TypeC", "table = \"two.csv\"\nturn_deg = -70", true},
            Kind{"TypeCInAir", "table = \"two.csv\"\nmeasured_in = \"air\"\nwindow = 1.52", false},
            Kind{"OneAngleOnEmitters", "table = \"one.csv\"", true, "emitter_mm = [60, 30]"},
            Kind{"Optics",
                 "diffuser_mm = [63.5, 30.2]\nfocal_length_mm = 65\ndistance_mm = 40\n"
                 "aperture_mm = 65\nturn_deg = 15",
                 true},
            Kind{"FocusedOptics",
                 "diffuser_mm = [63.5, 30.2]\nfocal_length_mm = 65\ndistance_mm = 65\n"
                 "aperture_mm = 65",
                 false}),
        testing::Bool()),
    [](const auto& kind) {
        return std::string(std::get<0>(kind.param).name) +
               (std::get<1>(kind.param) ? "BehindAPort" : "");
    });

using BeamTableFile = CommandTest;

// A table is part of the rig: what was rendered by another is neither kept nor weighed.
TEST_F(BeamTableFile, ThatChangesChangesTheFrames) {
    write_rig(home_, {"OneAngle", "table = \"one.csv\"", true}, false);
    const Arguments render("render rig.toml -o out --wavelengths 450,550,650");
    const auto rendered = [&] { return done(render).out; };
    EXPECT_TRUE(has(rendered(), "1 frame rendered, 0 kept"));
    EXPECT_TRUE(has(rendered(), "0 frames rendered, 1 kept"));

    write_file(path("one.csv"), "theta_deg,intensity\n0,5\n12,4.6\n33,2\n61,0.3\n90,0\n");
    refused("integrate out --rig rig.toml", "beam");
    EXPECT_TRUE(has(rendered(), "1 frame rendered, 0 kept"));
}

}  // namespace
}  // namespace aphotic::every_beam_test
