// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/band_sdl.h"

#include "base/error.h"
#include "scene_gen/sdl.h"

#include <gtest/gtest.h>

#include <set>

namespace aphotic::band_sdl_test {
namespace {

// Of the table that is called so.
Spectrum line(const std::string& table, double first, double last) {
    return {"a curve", {400.0, 700.0}, {first, last}, CurveSource{.table = table}};
}

TEST(Named, NamesEachSpectrumOnceAndNoTwoAlike) {
    const std::vector<Spectrum> spectra{
        line("x", 0.1, 0.2), line("x", 0.1, 0.2), line("x", 0.1, 0.3), line("y", 0.1, 0.3)};
    const std::vector<NamedSpectrum> names = named(spectra);
    ASSERT_EQ(names.size(), 3U);
    EXPECT_EQ(names[0].name, "x");
    EXPECT_EQ(names[1].name, "x 2");
    EXPECT_EQ(names[2].name, "y");
    EXPECT_EQ(name_of(spectra[1], names), "x");
    EXPECT_EQ(name_of(spectra[2], names), "x 2");
    EXPECT_THROW(static_cast<void>(name_of(line("z", 0.0, 0.0), names)), InputError);
}

// POV-Ray takes "Ã¤.csv" and "Ã¶.csv" for equal, and a quotation mark cannot stand in its texts.
TEST(Named, TellsApartWhatPovRayWouldTakeForEqual) {
    const std::vector<Spectrum> spectra{line("\xC3\xA4.csv", 0.1, 0.2),
                                        line("\xC3\xB6.csv", 0.1, 0.3),
                                        line("\xC3\xBC.csv", 0.1, 0.2),
                                        line("x\".csv", 0.1, 0.4),
                                        line("x'.csv", 0.1, 0.5),
                                        line(std::string(200, 'y') + "1", 0.1, 0.6),
                                        line(std::string(200, 'y') + "2", 0.1, 0.7)};
    const std::vector<NamedSpectrum> names = named(spectra);
    ASSERT_EQ(names.size(), spectra.size());
    std::set<std::string> texts;
    for (std::size_t i = 0; i < spectra.size(); ++i) {
        EXPECT_EQ(names[i].name, sdl_letters(names[i].name));
        EXPECT_LE(names[i].name.size(), 60U) << "all that aphotic.inc takes";
        EXPECT_EQ(name_of(spectra[i], names), names[i].name);
        texts.insert(names[i].name);
    }
    EXPECT_EQ(texts.size(), spectra.size());
}

TEST(BandSdl, HoldsEveryValueAtEachChannelsWavelength) {
    const Band band{.lambda_nm = {400.0, 550.0, 700.0},
                    .exposure = {1.0, 2.0, 4.0},
                    .attenuation_per_m = {0.1, 0.2, 0.3},
                    .water_index = 1.25,
                    .glasses = {{.name = "bk7", .index = 1.5}},
                    .lamps = {{.name = "flash", .spectrum = line("", 1.0, 2.0)}},
                    .reflectances = {{.name = "a", .spectrum = line("", 0.0, 1.0)},
                                     {.name = "b", .spectrum = line("", 0.5, 0.5)}}};
    EXPECT_EQ(band_sdl(band),
              "#declare Aphotic_Band_Version = 1;\n"
              "#declare Aphotic_Lambda = <400, 550, 700>;\n"
              "#declare Aphotic_Exposure = <1, 2, 4>;\n"
              "#declare Aphotic_Attenuation = "
              "<0.10000000000000001, 0.20000000000000001, 0.29999999999999999>;\n"
              "#declare Aphotic_Water_Index = 1.25;\n"
              "#declare Aphotic_Glass_Names = array[1] {\"bk7\"}\n"
              "#declare Aphotic_Glass_Indices = array[1] {1.5}\n"
              "#declare Aphotic_Lamp_Names = array[1] {\"flash\"}\n"
              "#declare Aphotic_Lamp_Values = array[1] {<1, 1.5, 2>}\n"
              "#declare Aphotic_Reflectance_Names = array[2] {\"a\", \"b\"}\n"
              "#declare Aphotic_Reflectance_Values = array[2] {<0, 0.5, 1>, <0.5, 0.5, 0.5>}\n");
}

}  // namespace
}  // namespace aphotic::band_sdl_test
