// SPDX-License-Identifier: BSD-3-Clause
#include "image/colour_profile.h"

#include <lcms2.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>

namespace aphotic {
namespace {

struct CloseProfile {
    void operator()(void* profile) const { cmsCloseProfile(profile); }
};
struct FreeCurve {
    void operator()(cmsToneCurve* curve) const { cmsFreeToneCurve(curve); }
};
struct FreeText {
    void operator()(cmsMLU* text) const { cmsMLUfree(text); }
};
using Profile = std::unique_ptr<void, CloseProfile>;

// CIE xyY of IEC 61966-2-1.
constexpr cmsCIExyY kD65{0.3127, 0.3290, 1.0};
constexpr cmsCIExyYTRIPLE kPrimaries{{0.64, 0.33, 1.0}, {0.30, 0.60, 1.0}, {0.15, 0.06, 1.0}};

Profile made(ColourProfile kind) {
    if (kind == ColourProfile::Srgb) return Profile(cmsCreate_sRGBProfile());
    const std::unique_ptr<cmsToneCurve, FreeCurve> line(cmsBuildGamma(nullptr, 1.0));
    if (kind == ColourProfile::LinearGrey)
        return Profile(cmsCreateGrayProfile(cmsD50_xyY(), line.get()));
    const std::array<cmsToneCurve*, 3> curves{line.get(), line.get(), line.get()};
    return Profile(cmsCreateRGBProfile(&kD65, &kPrimaries, curves.data()));
}

void name(cmsHPROFILE profile, const char* words) {
    const std::unique_ptr<cmsMLU, FreeText> text(cmsMLUalloc(nullptr, 1));
    cmsMLUsetASCII(text.get(), "en", "US", words);
    cmsWriteTag(profile, cmsSigProfileDescriptionTag, text.get());
}

}  // namespace

std::vector<std::uint8_t> icc_profile(ColourProfile kind) {
    constexpr double kVersion = 2.4;  // supported by every program
    constexpr std::array kNames{"sRGB", "Linear RGB, Rec. 709 primaries", "Linear grey"};
    const Profile profile = made(kind);
    cmsSetProfileVersion(profile.get(), kVersion);
    name(profile.get(), kNames.at(static_cast<std::size_t>(kind)));
    cmsUInt32Number size = 0;
    cmsSaveProfileToMem(profile.get(), nullptr, &size);
    std::vector<std::uint8_t> bytes(size);
    if (size == 0 || cmsSaveProfileToMem(profile.get(), bytes.data(), &size) == 0)
        throw std::runtime_error("Little CMS makes no colour profile");
    // The time at which it was made.
    constexpr std::ptrdiff_t kDate = 24;
    constexpr std::ptrdiff_t kDateBytes = 12;
    std::fill_n(bytes.begin() + kDate, kDateBytes, std::uint8_t{0});
    return bytes;
}

}  // namespace aphotic
