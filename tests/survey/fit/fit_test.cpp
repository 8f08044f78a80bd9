// SPDX-License-Identifier: BSD-3-Clause
//
// Fits to light whose rig is known: lightmaps, of beams that the fit's splines do not hold.
#include "survey/fit/fit.h"

#include "base/degrees.h"
#include "base/error.h"
#include "support/fit_rig.h"
#include "support/has.h"
#include "support/temp_folder.h"
#include "survey/fit/fitted_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::fit_test {
namespace {

constexpr double kNoise = 0.01;
// Of one number, its error being what it says: one in 16000 is farther off.
constexpr double kSigmas = 4.0;
// What the issue asks of a map at an altitude that the fit has not seen: 1 % rms.
constexpr double kPredicted = 0.01;
// Hard cones in blocks of 1.5 degrees are softened, which moves aims by less than a tenth of one,
// and takes little from a cone's flux.
constexpr double kSoftenedAim_deg = 0.1;
constexpr double kSoftenedShare = 0.01;

std::vector<Sled> flown(std::initializer_list<double> altitudes_m) {
    std::vector<Sled> sleds;
    double tilt_deg = -3.0;
    for (const double altitude_m : altitudes_m) {
        sleds.push_back({.altitude_m = altitude_m,
                         .pitch_rad = tilt_deg * kRadiansPerDegree,
                         .roll_rad = -0.7 * tilt_deg * kRadiansPerDegree});
        tilt_deg = -tilt_deg + 0.8;
    }
    return sleds;
}

// What the search begins with: an aim, a power, a water and a lens that are none of the truth's.
RigText guess() {
    FitRigNumbers numbers;
    numbers.fore_tilt_deg = 24.0;
    numbers.aft_power = 1.0;
    numbers.multiple = 1.4;
    numbers.exponent = 2.0;
    numbers.a1 = 0.0;
    return fit_rig(numbers);
}

FitOptions exact_poses() {
    FitOptions options;
    options.altitude_error_m = 0.0;
    options.attitude_error_rad = 0.0;
    options.threads = 2;
    return options;
}

void expect_told(const FitResult& result, const std::string& key, double truth) {
    const auto at = std::ranges::find(result.numbers, key, &FittedNumber::key);
    ASSERT_NE(at, result.numbers.end()) << key;
    EXPECT_NEAR(at->value, truth, kSigmas * at->error) << key;
    EXPECT_GT(at->error, 0.0) << key;
}

// rms of fitted over true light, each channel at its own scale: neither knows the other's.
double off_at(const Rig& fitted, const Rig& truth, const Sled& sled) {
    const std::vector<float> found =
        signal_of(LightmapMaker(fitted, paths_of(fitted, {sled}), {}).map(sled));
    const std::vector<float> wanted =
        signal_of(LightmapMaker(truth, paths_of(truth, {sled}), {}).map(sled));
    const std::size_t pixels = wanted.size() / kChannels;
    double squares = 0.0;
    for (std::size_t c = 0; c < kChannels; ++c) {
        double mean = 0.0;
        double mean_square = 0.0;
        for (std::size_t i = c * pixels; i < (c + 1) * pixels; ++i) {
            const double ratio = static_cast<double>(found[i]) / wanted[i];
            mean += ratio / static_cast<double>(pixels);
            mean_square += ratio * ratio / static_cast<double>(pixels);
        }
        squares += mean_square / (mean * mean) - 1.0;
    }
    return std::sqrt(squares / kChannels);
}

TEST(Fit, FindsTheRigThatMadeTheMaps) {
    const Rig truth = fit_rig({}).rig();
    const FitSamples samples = fit_samples_of(truth, flown({1.2, 1.5, 2.0, 2.5}), kNoise, 1);
    const FitResult result = fit(guess(), samples, exact_poses(), {});
    EXPECT_TRUE(result.held.empty());
    EXPECT_TRUE(result.looks_wrong.empty());
    expect_told(result, "water.multiple", 1.0);
    expect_told(result, "strobe.fore.aim_along_deg", 4.0 * std::cos(std::atan2(0.1, 0.5)));
    expect_told(result, "strobe.aft.aim_along_deg", 0.0);
    expect_told(result, "strobe.aft.aim_across_deg", 0.0);
    expect_told(result, "strobe.aft.power", 0.8);
    EXPECT_NEAR(result.left.residual, kNoise, 0.05 * kNoise);

    // And as a rig it shines as the truth does, higher than any image was.
    const TempFolder folder;
    write_fitted_rig(guess(), result, folder.path());
    const Rig fitted = RigText(folder.path() / kFittedRig).rig();
    const auto power = std::ranges::find(result.numbers, "strobe.aft.power", &FittedNumber::key);
    EXPECT_NEAR(fitted.strobes[1].power / fitted.strobes[0].power, 0.8, kSigmas * power->error);
    EXPECT_LT(off_at(fitted, truth, {.altitude_m = 3.0}), kPredicted);
    EXPECT_GT(off_at(guess().rig(), truth, {.altitude_m = 3.0}), 5.0 * kPredicted);
}

// Poses are told to 3 cm and half a degree alone, so floors might be uneven and images be brighter
// by as much; that these are not shows in five. Else what the finest detail tells would be all
// there is.
TEST(Fit, FindsTheAimsByFewMapsOfAnEvenFloor) {
    constexpr double kFine = 0.0005;
    constexpr double kAim_deg = 0.03;  // of the field's own sketch, by exact poses
    FitRigNumbers numbers;
    numbers.width_px = 80;
    numbers.height_px = 60;
    const auto samples =
        fit_samples_of(fit_rig(numbers).rig(), flown({1.2, 1.5, 1.8, 2.1, 2.5}), kFine, 4);
    numbers.fore_tilt_deg = 24.0;
    FitOptions options;
    options.threads = 2;
    const FitResult result = fit(fit_rig(numbers), samples, options, {});
    const std::vector<std::pair<std::string, double>> aims{
        {"strobe.fore.aim_along_deg", 4.0 * std::cos(std::atan2(0.1, 0.5))},
        {"strobe.aft.aim_along_deg", 0.0},
        {"strobe.aft.aim_across_deg", 0.0}};
    for (const auto& [key, truth] : aims) {
        const auto at = std::ranges::find(result.numbers, key, &FittedNumber::key);
        ASSERT_NE(at, result.numbers.end()) << key;
        EXPECT_NEAR(at->value, truth, kAim_deg) << key;
    }
}

// Of every eighth block in the lower half most is in the shade: too little light for its noise,
// which taken for light, if only for as much of it as Huber's weights do, makes another beam.
TEST(Fit, LooksPastWhatStonesShade) {
    const Rig truth = fit_rig({}).rig();
    constexpr double kRough = 0.05;
    FitSamples samples = fit_samples_of(truth, flown({1.2, 1.5, 2.0, 2.5}), kRough, 1);
    constexpr std::size_t kOf = 8;
    constexpr float kShade = 0.4F;
    const FitPlaces& places = samples.places;
    for (std::size_t image = 0; image < samples.images.size(); ++image) {
        for (std::size_t place = image; place < places.size(); place += kOf) {
            if (places.rows[place] < 0.5 * places.height_px) continue;
            for (std::size_t c = 0; c < kChannels; ++c)
                samples.images[image].signal[kChannels * place + c] *= kShade;
        }
    }
    const FitResult result = fit(guess(), samples, exact_poses(), {});
    expect_told(result, "strobe.fore.aim_along_deg", 4.0 * std::cos(std::atan2(0.1, 0.5)));
    expect_told(result, "strobe.aft.power", 0.8);
    const TempFolder folder;
    write_fitted_rig(guess(), result, folder.path());
    EXPECT_LT(off_at(RigText(folder.path() / kFittedRig).rig(), truth, {.altitude_m = 2.0}),
              kPredicted);
}

TEST(Fit, FindsTheRigInWaterThatScatters) {
    FitRigNumbers numbers;
    numbers.water = "chlorophyll_mg_m3 = {}";
    numbers.multiple = 0.4;
    numbers.width_px = 14;
    numbers.height_px = 11;
    const Rig truth = fit_rig(numbers).rig();
    const FitSamples samples = fit_samples_of(truth, flown({1.2, 1.6, 2.0, 2.5}), kNoise, 2);
    numbers.multiple = 0.8;
    numbers.exponent = 3.0;
    const RigText start = fit_rig(numbers);
    const FitResult result = fit(start, samples, exact_poses(), {});
    expect_told(result, "water.chlorophyll_mg_m3", 0.4);
    const TempFolder folder;
    write_fitted_rig(start, result, folder.path());
    EXPECT_LT(off_at(RigText(folder.path() / kFittedRig).rig(), truth, {.altitude_m = 3.0}),
              kPredicted);
}

// Above a brighter floor there is less veil beside its light. Taken for the rig's own, the beams
// would make up for that.
TEST(Fit, FindsTheFloorsBrightnessByTheVeil) {
    constexpr double kBrightness = 1.6;
    FitRigNumbers numbers;
    numbers.water = "chlorophyll_mg_m3 = {}";
    numbers.multiple = 0.4;
    numbers.width_px = 14;
    numbers.height_px = 11;
    const RigText start = fit_rig(numbers);
    Rig truth = start.rig();
    const Spectrum& sand = truth.seafloor.reflectance;
    std::vector<double> brighter(sand.values().begin(), sand.values().end());
    for (double& value : brighter) value *= kBrightness;
    truth.seafloor.reflectance =
        Spectrum("brighter", {sand.lambda_nm().begin(), sand.lambda_nm().end()}, brighter);
    const FitSamples samples = fit_samples_of(truth, flown({1.2, 1.6, 2.0, 2.5}), kNoise, 2);
    FitOptions options = exact_poses();
    options.free = {{"beam", "aim", "power", "vignetting", "floor"}};
    const FitResult result = fit(start, samples, options, {});
    expect_told(result, "floor.brightness", kBrightness);
    const TempFolder folder;
    write_fitted_rig(start, result, folder.path());
    EXPECT_LT(off_at(RigText(folder.path() / kFittedRig).rig(), truth, {.altitude_m = 3.0}),
              kPredicted);
}

// Texture that darkens all channels at once leaves their ratios: the water is told far better than
// by as much noise of each channel's own.
TEST(Fit, TellsTheWaterByTheColoursOfAGreyFloor) {
    constexpr double kTexture = 0.1;
    constexpr double kBetter = 0.5;
    FitRigNumbers numbers;
    numbers.width_px = 16;
    numbers.height_px = 12;
    const Rig truth = fit_rig(numbers).rig();
    numbers.multiple = 1.4;
    const RigText start = fit_rig(numbers);
    const std::vector<Sled> sleds = flown({1.2, 1.5, 2.0, 2.5});
    FitSamples grey = fit_samples_of(truth, sleds, kNoise, 11);
    std::mt19937_64 dice(11);
    std::normal_distribution<double> normal;
    for (FitImage& image : grey.images) {
        for (std::size_t i = 0; i < image.signal.size(); i += kChannels) {
            const double texture = 1.0 + kTexture * normal(dice);
            for (std::size_t c = 0; c < kChannels; ++c)
                image.signal[i + c] = static_cast<float>(image.signal[i + c] * texture);
        }
    }
    const auto water_of = [&](const FitSamples& samples) {
        const FitResult result = fit(start, samples, exact_poses(), {});
        expect_told(result, "water.multiple", 1.0);
        return std::ranges::find(result.numbers, "water.multiple", &FittedNumber::key)->error;
    };
    EXPECT_LT(water_of(grey), kBetter * water_of(fit_samples_of(truth, sleds, kTexture, 11)));
}

// cos^6, whose exponent is a shape of the beam.
TEST(Fit, FindsTheExponentOfACosine) {
    const FitSamples samples = fit_samples_of(fit_rig({}).rig(), flown({1.2, 2.0, 2.8}), kNoise, 3);
    FitOptions options = exact_poses();
    options.beam = FitBeamKind::Cosine;
    const FitResult result = fit(guess(), samples, options, {});
    expect_told(result, "strobe.fore.beam.exponent", 6.0);
    // (n + 1)/(2 pi) cos^n, whose error is that of n.
    const auto exponent =
        std::ranges::find(result.numbers, "strobe.fore.beam.exponent", &FittedNumber::key);
    ASSERT_EQ(result.beam_curves.size(), 1U);
    for (const BeamPoint& point : result.beam_curves[0]) {
        constexpr double kRounding = 1e-9;
        const double n = exponent->value;
        const double cosine = std::cos(point.theta_rad);
        if (cosine < 0.1) continue;
        const double intensity = (n + 1.0) / (2.0 * std::numbers::pi) * std::pow(cosine, n);
        const double slope = 1.0 / (n + 1.0) + std::log(cosine);
        EXPECT_NEAR(point.intensity, intensity, kRounding);
        const double of_share = std::sqrt(result.covariance(0, 0)) / result.shares(0);
        const auto row = result.shares.size() + (exponent - result.numbers.begin());
        const double both = result.covariance(0, row) / result.shares(0);
        EXPECT_NEAR(point.error / intensity,
                    std::sqrt(of_share * of_share + 2.0 * slope * both +
                              std::pow(slope * exponent->error, 2.0)),
                    kRounding);
    }
    const TempFolder folder;
    write_fitted_rig(guess(), result, folder.path());
    EXPECT_LT(
        off_at(RigText(folder.path() / kFittedRig).rig(), fit_rig({}).rig(), {.altitude_m = 3.0}),
        kPredicted);
}

// Few maps as exact as the model, of level flight, and poses that may be off: the first steps away
// from the rig must not end where poses and floors explain all.
TEST(Fit, FindsTheExponentWherePosesMayBeOff) {
    constexpr double kModel = 2e-3;  // of steps that end by 1e-7 of what is left
    FitRigNumbers numbers;
    numbers.fore_tilt_deg = 23.0;
    numbers.exponent = 3.0;
    FitOptions options;
    options.threads = 2;
    options.beam = FitBeamKind::Cosine;
    for (const std::vector<double>& altitudes_m :
         {std::vector{1.5, 1.8, 2.1, 2.4}, {1.2, 1.8, 2.4}}) {
        std::vector<Sled> level;
        for (const double altitude_m : altitudes_m) level.push_back({.altitude_m = altitude_m});
        const FitSamples samples = fit_samples_of(fit_rig({}).rig(), level, 0.0, 3);
        const FitResult result = fit(fit_rig(numbers), samples, options, {});
        const auto at =
            std::ranges::find(result.numbers, "strobe.fore.beam.exponent", &FittedNumber::key);
        ASSERT_NE(at, result.numbers.end());
        EXPECT_NEAR(at->value, 6.0, 6.0 * kModel);
    }
}

// The navigation reads 5 cm too low, and the camera is mounted askew.
TEST(Fit, FindsHowFarTheNavigationIsOff) {
    const Sled off{.altitude_m = 0.05,
                   .pitch_rad = 1.0 * kRadiansPerDegree,
                   .roll_rad = -0.6 * kRadiansPerDegree};
    auto samples = fit_samples_of(fit_rig({}).rig(), flown({1.2, 1.5, 2.0, 2.5}), kNoise, 3);
    for (FitImage& image : samples.images) {
        image.sled.altitude_m -= off.altitude_m;
        image.sled.pitch_rad -= off.pitch_rad;
        image.sled.roll_rad -= off.roll_rad;
    }
    FitOptions options = exact_poses();
    options.free = {{"altitude", "attitude"}};
    const FitResult result = fit(fit_rig({}), samples, options, {});
    expect_told(result, "sled.altitude_offset_m", off.altitude_m);
    expect_told(result, "camera.pitch_offset_deg", off.pitch_rad * kDegreesPerRadian);
    expect_told(result, "camera.roll_offset_deg", off.roll_rad * kDegreesPerRadian);
}

TEST(Fit, FindsTheChannelsGains) {
    constexpr std::array<float, kChannels> kGains{1.3F, 1.0F, 0.7F};
    auto samples = fit_samples_of(fit_rig({}).rig(), flown({1.2, 2.0, 2.5}), kNoise, 3);
    for (FitImage& image : samples.images)
        for (std::size_t i = 0; i < image.signal.size(); ++i)
            image.signal[i] *= kGains[i % kChannels];
    FitOptions options = exact_poses();
    options.free = {{"gain"}};
    const FitResult result = fit(fit_rig({}), samples, options, {});
    expect_told(result, "gain.R", kGains[0]);
    expect_told(result, "gain.B", kGains[2]);
}

TEST(Fit, FindsALossThatIsTheSameAtAllWavelengths) {
    FitRigNumbers numbers;
    numbers.water = "absorption = \"pope-fry-1997\"\nuniform_loss_per_m = {}";
    numbers.multiple = 0.1;
    const auto samples = fit_samples_of(fit_rig(numbers).rig(), flown({1.2, 2.0, 2.5}), kNoise, 3);
    numbers.multiple = 0.0;
    FitOptions options = exact_poses();
    options.free = {{"water.uniform_loss_per_m"}};
    expect_told(fit(fit_rig(numbers), samples, options, {}), "water.uniform_loss_per_m", 0.1);
}

TEST(Fit, HoldsWhatItIsToldTo) {
    const FitSamples samples = fit_samples_of(fit_rig({}).rig(), flown({1.2, 2.0, 2.8}), kNoise, 4);
    FitOptions options = exact_poses();
    FitRigNumbers known;
    known.multiple = 1.4;
    options.free = {{"water"}};
    const FitResult result = fit(fit_rig(known), samples, options, {});
    expect_told(result, "water.multiple", 1.0);
    for (const FittedNumber& one : result.numbers)
        EXPECT_TRUE(one.key == "water.multiple" || one.key.starts_with("floor.")) << one.key;
    for (const char* word : {"colour", "floor"}) {  // no word, and nothing that clear water tells
        options.free = {{word}};
        EXPECT_THROW(static_cast<void>(fit(fit_rig(known), samples, options, {})), InputError);
    }
}

// One altitude: an offset of it and the water's loss change the light alike, to within the noise of
// few and dim pixels.
TEST(Fit, SaysWhatCannotBeTold) {
    FitRigNumbers numbers;
    numbers.width_px = 8;
    numbers.height_px = 6;
    const FitSamples samples = fit_samples_of(fit_rig(numbers).rig(), flown({2.0}), 0.1, 5);
    FitOptions options = exact_poses();
    FitRigNumbers coarse = numbers;
    options.free = {{"beam", "water", "altitude", "vignetting"}};
    std::string words;
    try {
        static_cast<void>(fit(fit_rig(coarse), samples, options, {}));
    } catch (const InputError& error) {
        words = error.what();
    }
    EXPECT_TRUE(has(words, "cannot be told"));
    EXPECT_TRUE(has(words, "as many images again at"));

    options.free.reset();
    const FitResult result = fit(fit_rig(coarse), samples, options, {});
    ASSERT_FALSE(result.held.empty());
    for (const NotTold& one : result.held) {
        EXPECT_EQ(std::ranges::find(result.numbers, one.key, &FittedNumber::key),
                  result.numbers.end());
    }
}

// Held at 1.8 times its truth, the water gives its colour to the floor, whose error allows for
// that.
TEST(Fit, ErrorsAllowForWhatIsHeld) {
    FitRigNumbers numbers;
    numbers.width_px = 8;
    numbers.height_px = 6;
    const FitSamples samples = fit_samples_of(fit_rig(numbers).rig(), flown({2.0}), 0.1, 5);
    numbers.multiple = 1.8;
    FitOptions options = exact_poses();
    options.beam = FitBeamKind::Cosine;
    const FitResult result = fit(fit_rig(numbers), samples, options, {});
    ASSERT_NE(std::ranges::find(result.held, "water.multiple", &NotTold::key), result.held.end());
    for (const char* key : {"floor.redness", "floor.bend"}) {
        const auto colour = std::ranges::find(result.numbers, key, &FittedNumber::key);
        ASSERT_NE(colour, result.numbers.end());
        EXPECT_NEAR(colour->value, 0.0, 2.0 * colour->error) << key;
    }
}

// Of a single dark image by a camera of one channel no number is told: all are held, and the beam
// alone is fitted.
TEST(Fit, HoldsEveryNumberWhereNoneIsTold) {
    const TempFolder folder;
    write_file(folder.path() / "flat.csv", "wavelength_nm,quantum_efficiency\n380,0.5\n780,0.5\n");
    FitRigNumbers numbers;
    numbers.width_px = 8;
    numbers.height_px = 6;
    std::string toml = fit_rig(numbers).text();
    const std::string colours = "\"nikon-d5100\"";
    toml.replace(toml.find(colours), colours.size(), R"({ quantum_efficiency = "flat.csv" })");
    const RigText mono(toml, "mono.toml", folder.path());
    FitSamples samples = fit_samples_of(mono.rig(), flown({2.0}), 3.0, 12);
    for (std::size_t i = 0; i < samples.images[0].signal.size(); ++i)
        if (i % kChannels > 0) samples.images[0].signal[i] = std::nanf("");
    const FitResult result = fit(mono, samples, exact_poses(), {});
    EXPECT_TRUE(result.numbers.empty());
    EXPECT_FALSE(result.held.empty());
}

// Blocks that are darker than black: no beam that is not negative explains them.
TEST(Fit, SaysThatNoLightFits) {
    FitSamples samples = fit_samples_of(fit_rig({}).rig(), flown({1.2, 2.0}), 0.0, 1);
    for (FitImage& image : samples.images)
        for (float& signal : image.signal) signal = -signal;
    try {
        static_cast<void>(fit(guess(), samples, exact_poses(), {}));
        ADD_FAILURE() << "fitted";
    } catch (const InputError& error) {
        EXPECT_TRUE(has(std::string(error.what()), "no light at all")) << error.what();
    }
}

// As maps, which nobody halves for their errors: that is most of the work, and doubts know nothing
// of it.
FitSamples thirty_maps(std::uint64_t seed) {
    std::vector<Sled> sleds;
    for (int i = 0; i < 30; ++i) {
        sleds.push_back({.altitude_m = 1.2 + 0.05 * (i * 7 % 30),
                         .pitch_rad = 0.05 * std::sin(2.0 * i),
                         .roll_rad = 0.05 * std::cos(3.0 * i)});
    }
    FitRigNumbers numbers;
    numbers.width_px = 10;
    numbers.height_px = 8;
    return fit_samples_of(fit_rig(numbers).rig(), sleds, kNoise, seed);
}

FitResult fitted_to(const FitSamples& samples, const RunWatch& watch = {}) {
    FitRigNumbers numbers;
    numbers.width_px = 10;
    numbers.height_px = 8;
    FitOptions options;
    options.threads = 2;
    options.parts = 8;
    return fit(fit_rig(numbers), samples, options, watch);
}

std::string warnings_of(const FitResult& result) {
    std::string all;
    for (const Suspicion& one : result.looks_wrong) all += one.about + "\n";
    return all;
}

TEST(Fit, SaysWhereErrorsMayNotHold) {
    const Rig truth = fit_rig({}).rig();
    const auto low = fit_samples_of(truth, flown({1.5, 1.6, 1.55}), kNoise, 3);
    EXPECT_EQ(warnings_of(fit(guess(), low, exact_poses(), {})), "altitudes\n");
    auto rough = fit_samples_of(truth, flown({1.2, 1.5, 2.0, 2.5}), kNoise, 3);
    EXPECT_EQ(warnings_of(fit(guess(), rough, exact_poses(), {})), "");
    // Patches of algae, some four blocks wide.
    for (std::size_t i = 0; i < rough.images.size(); ++i) {
        std::vector<float>& signal = rough.images[i].signal;
        for (std::size_t k = 0; k < signal.size(); ++k) {
            const std::size_t place = k / kChannels;
            signal[k] *= static_cast<float>(1.0 + kNoise *
                                                      std::sin(0.8 * rough.places.columns[place] +
                                                               2.0 * static_cast<double>(i)) *
                                                      std::cos(0.7 * rough.places.rows[place]));
        }
    }
    EXPECT_EQ(warnings_of(fit(guess(), rough, exact_poses(), {})), "maps\n");
}

// A lamp four times as bright as the rig has it.
TEST(Fit, FindsOutANumberFarFromTheRigs) {
    const auto samples = fit_samples_of(fit_rig({}).rig(), flown({1.2, 1.5, 2.0, 2.5}), kNoise, 3);
    FitRigNumbers dim;
    dim.aft_power = 0.2;
    const FitResult result = fit(fit_rig(dim), samples, exact_poses(), {});
    EXPECT_EQ(warnings_of(result), "range\n");
    expect_told(result, "strobe.aft.power", 0.8);
}

// Two cones, each with its share of the flux.
RigText cones_rig(double fore_tilt_deg, double narrow_share) {
    FitRigNumbers numbers;
    numbers.width_px = 160;
    numbers.height_px = 120;
    numbers.fore_tilt_deg = fore_tilt_deg;
    std::string text = fit_rig(numbers).text();
    const std::size_t at = text.find("cones = [");
    text.replace(at,
                 text.find('\n', at) - at,
                 fmt::format(R"(cones = [{{ part = "narrow", half_angle_deg = 14.0, weight = {} }},
                                {{ part = "wide", half_angle_deg = 34.0, weight = {} }}])",
                             narrow_share,
                             1.0 - narrow_share));
    return {text, "cones.toml", {}};
}

// An edge has no slope, but the mean of a block that it crosses has.
TEST(Fit, FindsTheAimsOfHardCones) {
    constexpr int kBlock_px = 4;
    const Rig truth = cones_rig(20.0, 0.3).rig();
    FitSamples samples = fit_samples_of(truth, flown({1.2, 1.5, 1.8, 2.1, 2.4}), 0.0, 1);
    std::mt19937_64 dice(5);
    std::normal_distribution<double> normal;
    const FitPlaces fine = samples.places;
    samples.places = fit_places(fine.width_px, fine.height_px, fine.width_px / kBlock_px);
    for (FitImage& image : samples.images) {
        std::vector<float> means(kChannels * samples.places.size(), 0.0F);
        for (std::size_t i = 0; i < image.signal.size(); ++i) {
            const std::size_t pixel = i / kChannels;
            const std::size_t width = static_cast<std::size_t>(fine.width_px);
            const std::size_t block =
                pixel / width / kBlock_px * (width / kBlock_px) + pixel % width / kBlock_px;
            means[kChannels * block + i % kChannels] +=
                image.signal[i] / static_cast<float>(kBlock_px * kBlock_px);
        }
        for (float& mean : means) mean *= static_cast<float>(1.0 + kNoise * normal(dice));
        image.signal = means;
    }
    FitOptions options = exact_poses();
    options.beam = FitBeamKind::Cones;
    options.free = {{"beam", "aim", "power"}};
    const FitResult result = fit(cones_rig(23.0, 0.6), samples, options, {});
    const auto value = [&](const std::string& key) {
        return std::ranges::find(result.numbers, key, &FittedNumber::key)->value;
    };
    EXPECT_NEAR(
        value("strobe.fore.aim_along_deg"), 3.0 * std::cos(std::atan2(0.1, 0.5)), kSoftenedAim_deg);
    EXPECT_NEAR(value("strobe.aft.aim_along_deg"), 0.0, kSoftenedAim_deg);
    EXPECT_NEAR(value("strobe.aft.aim_across_deg"), 0.0, kSoftenedAim_deg);
    EXPECT_NEAR(value("strobe.aft.power"), 0.8, kSoftenedShare);
    const FitBeam::Fitted fitted = result.state.beams[0].beam_of(result.shares);
    EXPECT_NEAR(fitted.beam.cones[0].weight, 0.3, kSoftenedShare);
}

TEST(Fit, FindsOutASurveyWhosePosesAreThoseOfOtherImages) {
    FitSamples samples = thirty_maps(6);
    samples.are_maps = false;
    EXPECT_TRUE(fitted_to(samples).looks_wrong.empty());
    // Each image has its neighbour's altitude, a metre off at most.
    samples.are_maps = true;
    for (std::size_t i = 0; i + 1 < samples.images.size(); ++i)
        std::swap(samples.images[i].sled, samples.images[i + 1].sled);
    EXPECT_TRUE(has(warnings_of(fitted_to(samples)), "exposure\n"));
}

// The lowest image has the highest one's altitude, and so on: said before the fit, which need not
// find any rig.
TEST(Fit, FindsOutPosesThatRunTheOtherWayFirst) {
    FitSamples samples = thirty_maps(6);
    for (FitImage& image : samples.images)
        image.sled.altitude_m = 1.2 + 2.65 - image.sled.altitude_m;
    std::string told;
    RunWatch watch;
    watch.looks_wrong = [&](const std::vector<Suspicion>& found) {
        for (const Suspicion& one : found) told += one.about + ": " + one.what;
        throw InputError("as --strict does");
    };
    EXPECT_THROW(static_cast<void>(fitted_to(samples, watch)), InputError);
    EXPECT_TRUE(told.starts_with("altitude: brightness varies ")) << told;
    EXPECT_TRUE(has(told, "the other way: poses of other images"));
}

// A black level of a fifth of the brightest that nobody took off.
TEST(Fit, FindsOutABlackLevel) {
    FitSamples samples = thirty_maps(7);
    float most = 0.0F;
    for (const FitImage& image : samples.images)
        most = std::max(most, std::ranges::max(image.signal));
    for (FitImage& image : samples.images) {
        for (float& signal : image.signal) signal += 0.2F * most;
    }
    EXPECT_TRUE(has(warnings_of(fitted_to(samples)), "altitude\n"));
}

// Every other block a tenth darker in all images, which no beam or lens can be.
TEST(Fit, FindsOutAPatternThatStaysInPlace) {
    FitSamples samples = thirty_maps(8);
    for (FitImage& image : samples.images) {
        for (std::size_t i = 0; i < image.signal.size(); ++i)
            if (i / kChannels % 2 == 0) image.signal[i] *= 0.9F;
    }
    EXPECT_TRUE(has(warnings_of(fitted_to(samples)), "pattern\n"));
}

}  // namespace
}  // namespace aphotic::fit_test
