// SPDX-License-Identifier: BSD-3-Clause
//
// [water] of a rig file: each way of saying it, and what is refused.
#include "rig/file/water_reader.h"

#include "base/error.h"
#include "rig/file/rig_reader.h"
#include "support/refusal.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <string>
#include <variant>

namespace aphotic::water_reader_test {
namespace {

constexpr double kExact = 1e-12;

class WaterReader : public testing::Test {
  protected:
    // [water] is line 8, its first key line 9.
    Water read(const std::string& lines) {
        return parse_rig(
                   "[sled]\naltitude_m = 2\n"
                   "[camera]\nresolution = [4, 3]\nfov_deg = 40\nrange_nm = [400, 700]\n"
                   "response = \"nikon-d5100\"\n[water]\n" +
                       lines +
                       "\n[seafloor]\n[beam.wide]\nfwhm_deg = 90\n"
                       "[[strobe]]\nname = \"fore\"\nposition_m = [0.5, 0, 0]\n"
                       "aim = { tilt_deg = 26, toward = \"axis\" }\nbeam = \"wide\"\n",
                   "rig.toml",
                   folder_.path())
            .water;
    }

    std::string error_of(const std::string& lines) {
        return refusal_of([&] { static_cast<void>(read(lines)); });
    }

    void put(const std::string& file, const std::string& text) {
        write_file(folder_.path() / file, text);
    }

    TempFolder folder_;
};

TEST_F(WaterReader, OfNothingIsPureAndDoesNotScatter) {
    const Water water = read("");
    EXPECT_FALSE(water.scatters());
    EXPECT_EQ(water.attenuation_per_m(550.0), water.absorption_per_m.at(550.0));
}

// b and c - a are the same water.
TEST_F(WaterReader, TakesScatteringOrAttenuation) {
    put("a.csv", "wavelength_nm,absorption_per_m\n400,0.1\n700,0.4\n");
    put("b.csv", "wavelength_nm,scattering_per_m\n400,0.5\n700,0.2\n");
    put("c.csv", "wavelength_nm,attenuation_per_m\n400,0.6\n700,0.6\n");
    const Water of_b = read("absorption = \"a.csv\"\nscattering = \"b.csv\"");
    const Water of_c = read("absorption = \"a.csv\"\nattenuation = \"c.csv\"");
    ASSERT_EQ(of_b.scatterers.size(), 1U);
    EXPECT_EQ(of_b.scatterers[0].phase.name, "petzold");
    for (const double nm : {400.0, 550.0, 700.0}) {
        EXPECT_NEAR(of_c.scattering_per_m(0, nm), of_b.scattering_per_m(0, nm), kExact) << nm;
    }
    EXPECT_EQ(error_of("absorption = \"a.csv\"\nscattering = \"b.csv\"\nattenuation = \"c.csv\"")
                  .substr(0, 9),
              "rig.toml:");
    put("c.csv", "wavelength_nm,attenuation_per_m\n400,0.6\n700,0.3\n");
    EXPECT_EQ(error_of("absorption = \"a.csv\"\nattenuation = \"c.csv\""),
              "rig.toml:10: water.attenuation: found 0.3/m at 700 nm, less than the absorption "
              "0.4/m; allowed: no less, since attenuation is absorption plus scattering");
}

TEST_F(WaterReader, TakesATypeWithParticlesOfAnyPhase) {
    const Water water = read("type = \"jerlov-3C\"\nphase = \"petzold-coast\"");
    ASSERT_EQ(water.scatterers.size(), 2U);
    EXPECT_TRUE(std::holds_alternative<MolecularScattering>(water.scatterers[0].phase.kind));
    EXPECT_EQ(water.scatterers[1].phase.name, "petzold-coast");
}

TEST_F(WaterReader, TakesChlorophyllWithAPhaseOfItsOwn) {
    // 0.002 + 0.01 (1/2 - log10(0.1)/4)
    EXPECT_NEAR(
        read("chlorophyll_mg_m3 = 0.1").scatterers[1].phase.backscatter_ratio(), 0.0095, 1e-9);
    const Water water =
        read("chlorophyll_mg_m3 = 0.1\nphase = { fournier_forand = { backscatter_ratio = 0.03 } }");
    EXPECT_NEAR(water.scatterers[1].phase.backscatter_ratio(), 0.03, 1e-9);
}

TEST_F(WaterReader, TakesEveryFormOfPhase) {
    put("b.csv", "wavelength_nm,scattering_per_m\n400,0.5\n700,0.2\n");
    put("p.csv", "angle_deg,phase_function_per_sr\n0,2\n90,2\n180,2\n");
    const auto phase_of = [&](const std::string& said) {
        return read("scattering = \"b.csv\"\nphase = " + said).scatterers[0].phase;
    };
    EXPECT_EQ(std::get<HenyeyGreenstein>(phase_of("{ henyey_greenstein = -0.5 }").kind).g, -0.5);
    const auto forand = std::get<FournierForand>(
        phase_of("{ fournier_forand = { index = 1.1, slope = 3.6 } }").kind);
    EXPECT_EQ(forand.index, 1.1);
    EXPECT_EQ(forand.slope, 3.6);
    EXPECT_NEAR(phase_of("\"p.csv\"").backscatter_ratio(), 0.5, 1e-9) << "as much every way";
    EXPECT_NEAR(phase_of("\"sea-water\"").backscatter_ratio(), 0.5, 1e-12);
}

TEST_F(WaterReader, ScattersAsSeaWaterAlone) {
    const Water water = read("scattering = \"sea-water\"");
    ASSERT_EQ(water.scatterers.size(), 1U);
    EXPECT_NEAR(water.scattering_per_m(0, 550.0), 0.00174, 1e-5);  // Zhang, Hu and He (2009)
}

TEST_F(WaterReader, RefusesWhatSaysTwoThings) {
    EXPECT_EQ(error_of("scattering = \"sea-water\"\nphase = \"petzold\""),
              "rig.toml:10: water.phase: found with pure sea water, whose phase function is known; "
              "allowed: with particles");
    EXPECT_EQ(error_of("phase = \"petzold\""),
              "rig.toml:9: water.phase: found for water that does not scatter; allowed: with type, "
              "chlorophyll_mg_m3, scattering or attenuation");
    EXPECT_EQ(
        error_of("type = \"jerlov-3C\"\nparticles = 2"),
        "rig.toml:10: water.particles: found without chlorophyll_mg_m3; allowed: together with it");
    for (const char* both : {"type = \"jerlov-3C\"\nabsorption = \"pure-2016\"",
                             "type = \"jerlov-3C\"\nchlorophyll_mg_m3 = 1",
                             "chlorophyll_mg_m3 = 1\nscattering = \"sea-water\""}) {
        EXPECT_NE(error_of(both), "nothing was said") << both;
    }
}

// There the veil's 1/d^2 has no end. The rig's strobe is half a metre off.
TEST_F(WaterReader, RefusesALampAtThePupilWhereItScatters) {
    const std::string at_the_pupil =
        "[sled]\naltitude_m = 2\n[camera]\nresolution = [4, 3]\nfov_deg = 40\n"
        "range_nm = [400, 700]\nresponse = \"nikon-d5100\"\n[seafloor]\n[beam.wide]\n"
        "fwhm_deg = 90\n[[strobe]]\nname = \"fore\"\nposition_m = [0, 0, 0]\n"
        "direction = [0, 0, 1]\nbeam = \"wide\"\n[water]\n";
    EXPECT_NO_THROW(static_cast<void>(parse_rig(at_the_pupil, "rig.toml", folder_.path())));
    EXPECT_EQ(
        refusal_of([&] {
            static_cast<void>(
                parse_rig(at_the_pupil + "type = \"jerlov-II\"\n", "rig.toml", folder_.path()));
        }),
        "rig.toml:13: strobe[0].position_m: found [0, 0, 0]; allowed: in water that scatters, "
        "a point at least 0.001 m from the camera's pupil, since the veil is infinite there");
}

TEST_F(WaterReader, RefusesDaylightsAttenuation) {
    put("kd.csv", "wavelength_nm,kd_per_m\n400,0.5\n700,0.7\n");
    const std::string error = error_of("absorption = \"kd.csv\"");
    EXPECT_EQ(error.substr(0, 28), "rig.toml:9: water.absorption");
    EXPECT_NE(error.find("K_d, the diffuse attenuation of daylight"), std::string::npos) << error;
}

}  // namespace
}  // namespace aphotic::water_reader_test
