// SPDX-License-Identifier: BSD-3-Clause
//
// Names of channels as the writers of spectral images spell them.
#include "spectral/channel_wavelength.h"

#include "image/output_images.h"

#include <gtest/gtest.h>

namespace aphotic::channel_wavelength_test {
namespace {

// The reference writer's six decimals, pbrt's three, and what the layout's pattern allows besides.
TEST(ChannelWavelength, IsTheSameHoweverItIsSpelt) {
    for (const char* name : {"S0.440nm",
                             "S0.440,nm",
                             "S0.440,0nm",
                             "S0.440,000000nm",
                             "S0.4,4E2nm",
                             "S0.4,4e+2nm",
                             "S0.0,44um",
                             "S0.,44um",
                             "S0.0,00000044m",
                             "S0.440000pm",
                             "S0.681,346495455THz"}) {  // c / 440 nm
        EXPECT_TRUE(is_same_spectral_channel(name, spectral_channel(440.0))) << name;
    }
    EXPECT_TRUE(is_same_spectral_channel("S0.374,688nm", "S0.374,687500nm"));
    EXPECT_TRUE(is_same_spectral_channel("T.400nm.550,0nm", "T.0,4um.550nm"));
    EXPECT_TRUE(is_same_spectral_channel("count.S0.440,0nm", "count.S0.440nm"));
}

TEST(ChannelWavelength, IsAnotherWhereQuantityOrWavelengthIs) {
    for (const char* name : {"S0.440,01nm",
                             "S0.450,0nm",
                             "S1.440,0nm",
                             "T.440,0nm",
                             "T.440nm.440nm",
                             "S0.440,0um",
                             "S0.440,0",
                             "S0.440,0xm",
                             "S0.-440nm",
                             "S0.m",
                             "S0.0nm",
                             "S0.nm",
                             "S0",
                             "440nm",
                             "R",
                             ""}) {
        EXPECT_FALSE(is_same_spectral_channel(name, spectral_channel(440.0))) << name;
    }
    EXPECT_FALSE(is_same_spectral_channel("R", "R")) << "no wavelength";
}

}  // namespace
}  // namespace aphotic::channel_wavelength_test
