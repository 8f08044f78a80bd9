// SPDX-License-Identifier: BSD-3-Clause
//
// Against cameras whose matrix is known in closed form, and against the same fit by numpy.
#include "spectral/camera_to_srgb.h"

#include "base/error.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace aphotic::camera_to_srgb_test {
namespace {

constexpr WavelengthRange kVisible{380.0, 780.0};
// Sums of some hundred products, solved for two unknowns.
constexpr double kRounding = 1e-10;

double daylight(double lambda_nm) {
    static const Spectrum kD65 = load_curve("cie-d65", CurveRole::LampSpectrum, {});
    return kD65.at(lambda_nm);
}

std::vector<Spectrum> observer() {
    return load_curves("cie-1931", CurveRole::ColourMatching, {});
}

// Curves that are linear in the observer's have the sums of its channels.
Sensor mixed(const Eigen::Matrix3d& shares) {
    const std::vector<Spectrum> xyz = observer();
    std::vector<Spectrum> channels;
    for (int row = 0; row < 3; ++row) {
        std::vector<double> values(xyz[0].values().size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            for (int k = 0; k < 3; ++k) {
                values[i] += shares(row, k) * xyz[static_cast<std::size_t>(k)].values()[i];
            }
        }
        channels.emplace_back(
            "channel",
            std::vector<double>(xyz[0].lambda_nm().begin(), xyz[0].lambda_nm().end()),
            values);
    }
    return {channels, ResponseKind::Energy};
}

const ShownSurface& surface(const CameraToSrgb& fit, const std::string& name) {
    return *std::ranges::find(fit.surfaces, name, &ShownSurface::name);
}

// IEC 61966-2-1 prints its matrix from XYZ with four decimals, for a white that is the standard's;
// that of the tables is 4e-4 off.
TEST(CameraToSrgb, OfTheObserverItselfIsTheStandardsMatrix) {
    constexpr double kDecimals = 1.5e-3;
    const CameraToSrgb fit = camera_to_srgb({observer(), ResponseKind::Energy}, kVisible, daylight);
    Eigen::Matrix3d standard;
    standard << 3.2406, -1.5372, -0.4986,  //
        -0.9689, 1.8758, 0.0415,           //
        0.0557, -0.2040, 1.0570;
    const Eigen::Vector3d white(0.9505, 1.0, 1.0890);
    EXPECT_LT((fit.matrix - standard * white.asDiagonal()).cwiseAbs().maxCoeff(), kDecimals)
        << fit.matrix;
    EXPECT_LT(fit.worst().delta_e, 1e-8);
}

TEST(CameraToSrgb, OfACameraThatSeesAsSrgbIsTheIdentity) {
    const CameraToSrgb xyz = camera_to_srgb({observer(), ResponseKind::Energy}, kVisible, daylight);
    // From XYZ with its own scale: rows as the fit has them over the observer's channels, each of
    // which is 1 for white.
    const Eigen::Vector3d white = [] {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        const std::vector<Spectrum> curves = observer();
        for (double nm = 380.0; nm <= 780.0; nm += 1.0) {
            for (std::size_t k = 0; k < 3; ++k) {
                sum[static_cast<Eigen::Index>(k)] += daylight(nm) * curves[k].at(nm);
            }
        }
        return sum;
    }();
    const Sensor srgb = mixed(xyz.matrix * white.cwiseInverse().asDiagonal());
    const CameraToSrgb fit = camera_to_srgb(srgb, kVisible, daylight);
    EXPECT_LT((fit.matrix - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), kRounding)
        << fit.matrix;
}

// numpy.linalg.lstsq over the same tables: the Nikon by the xenon flash in air, 400 to 720 nm.
TEST(CameraToSrgb, OfANikonIsWhatNumpyFits) {
    constexpr double kDigits = 1e-8;
    const Spectrum flash = load_curve("xenon-flash", CurveRole::LampSpectrum, {});
    const CameraToSrgb fit = camera_to_srgb(
        builtin_sensor("nikon-d5100"), {400.0, 720.0}, [&](double nm) { return flash.at(nm); });
    Eigen::Matrix3d numpy;
    numpy << 1.699487635, -0.619644739, -0.079842896,  //
        -0.173758081, 1.648417051, -0.47465897,        //
        0.07963245, -0.60393519, 1.52430274;
    EXPECT_LT((fit.matrix - numpy).cwiseAbs().maxCoeff(), kDigits) << fit.matrix;
    EXPECT_EQ(fit.surfaces.size(), 28U);
    EXPECT_NEAR(fit.mean_delta_e(), 1.7701006787, kDigits);
    EXPECT_NEAR(fit.worst().delta_e, 7.3921024773, kDigits);
    EXPECT_EQ(fit.worst().name, "18-cyan");
    for (int row = 0; row < 3; ++row) EXPECT_NEAR(fit.matrix.row(row).sum(), 1.0, kRounding);
}

// By numpy; the chart's red is published as (175, 54, 60) in 8 bits, 0.429, 0.037, 0.045 linear.
TEST(CameraToSrgb, KnowsWhatPatchesLookLikeByDaylight) {
    constexpr double kDigits = 1e-6;
    const CameraToSrgb fit = camera_to_srgb({observer(), ResponseKind::Energy}, kVisible, daylight);
    const Eigen::Vector3d red(0.446367, 0.028722, 0.042025);
    const Eigen::Vector3d sand(0.566082, 0.447275, 0.327493);
    EXPECT_LT((surface(fit, "15-red").srgb - red).cwiseAbs().maxCoeff(), kDigits);
    EXPECT_LT((surface(fit, "sand").srgb - sand).cwiseAbs().maxCoeff(), kDigits);
}

TEST(CameraToSrgb, OfThreeChannelsThatAreAlikeLeavesThemAsTheyAre) {
    const Spectrum green = observer()[1];
    const CameraToSrgb fit =
        camera_to_srgb({{green, green, green}, ResponseKind::Energy}, kVisible, daylight);
    EXPECT_LT((fit.matrix - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), kRounding)
        << fit.matrix;
}

TEST(CameraToSrgb, IsRefusedWhereAChannelSeesNothing) {
    const Spectrum nothing("nothing", {380.0, 780.0}, {0.0, 0.0});
    const Spectrum green = observer()[1];
    EXPECT_THROW(static_cast<void>(camera_to_srgb(
                     {{nothing, green, green}, ResponseKind::Energy}, kVisible, daylight)),
                 InputError);
}

}  // namespace
}  // namespace aphotic::camera_to_srgb_test
