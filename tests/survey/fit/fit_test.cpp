// SPDX-License-Identifier: BSD-3-Clause
//
// Fits to light whose rig is known: lightmaps, of beams that the fit's splines do not hold.
#include "survey/fit/fit.h"

#include "base/degrees.h"
#include "base/error.h"
#include "support/fit_rig.h"
#include "support/has.h"
#include "support/hills.h"
#include "support/temp_folder.h"
#include "survey/fit/block_planes.h"
#include "survey/fit/fitted_rig.h"
#include "survey/simulate/floor_texture.h"

#include <gtest/gtest.h>

#include <algorithm>
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
// Of a map at an altitude that the fit has not seen, rms.
constexpr double kPredicted = 0.01;
// Hard cones in blocks of 1.5 degrees are softened, which moves aims by less than a tenth of one,
// and takes little from a cone's flux.
constexpr double kSoftenedAim_deg = 0.1;
constexpr double kSoftenedShare = 0.01;

std::vector<Sled> flown(const std::vector<double>& altitudes_m) {
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
    numbers.multiple = 1.2;
    numbers.exponent = 3.0;
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

const FittedNumber& number_of(const FitResult& result, const std::string& key) {
    const auto at = std::ranges::find(result.numbers, key, &FittedNumber::key);
    if (at == result.numbers.end()) throw InputError("the fit has no {}", key);
    return *at;
}

void expect_told(const FitResult& result, const std::string& key, double truth) {
    const FittedNumber& one = number_of(result, key);
    EXPECT_NEAR(one.value, truth, kSigmas * one.error) << key;
    EXPECT_GT(one.error, 0.0) << key;
}

// rms of fitted over true light, each channel at its own scale: neither knows the other's.
double off_at(const RigText& start, const FitResult& result, const Rig& truth, const Sled& sled) {
    const TempFolder folder;
    write_fitted_rig(start, result, folder.path());
    const Rig fitted = RigText(folder.path() / kFittedRig).rig();
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

// A rig that is right has nothing to gain, and the fit's error is no reason to change it.
TEST(Fit, TellsARigThatIsRightFromOneThatIsNot) {
    const FitSamples samples = fit_samples_of(fit_rig({}).rig(), flown({1.2, 1.5, 2.0}), kNoise, 5);
    EXPECT_TRUE(is_rig_as_good(fit(fit_rig({}), samples, exact_poses(), {})));
    EXPECT_FALSE(is_rig_as_good(fit(guess(), samples, exact_poses(), {})));
}

TEST(Fit, FindsTheRigThatMadeTheMaps) {
    const Rig truth = fit_rig({}).rig();
    const FitSamples samples = fit_samples_of(truth, flown({1.2, 1.5, 2.0, 2.5}), kNoise, 1);
    const FitResult result = fit(guess(), samples, exact_poses(), {});
    EXPECT_TRUE(result.looks_wrong.empty());
    expect_told(result, "water.multiple", 1.0);
    expect_told(result, "strobe.fore.aim_along_deg", 4.0 * std::cos(std::atan2(0.1, 0.5)));
    expect_told(result, "strobe.aft.aim_along_deg", 0.0);
    expect_told(result, "strobe.aft.aim_across_deg", 0.0);
    // Powers are relative to each other, which is no news.
    for (const Confounded& pair : result.confounded) EXPECT_FALSE(pair.one.ends_with(".power"));
    const FittedNumber& aft = number_of(result, "strobe.aft.power");
    EXPECT_NEAR(
        aft.value / number_of(result, "strobe.fore.power").value, 0.8, 2.0 * kSigmas * aft.error);
    // They are told as the fitted rig has them: their sum is the first rig's.
    double sum = 0.0;
    for (const Strobe& strobe : guess().rig().strobes) sum += strobe.power;
    EXPECT_NEAR(aft.value + number_of(result, "strobe.fore.power").value, sum, 1e-9);
    // And as a rig it shines as the truth does, higher than any image was.
    const Sled high{.altitude_m = 3.0};
    EXPECT_LT(off_at(guess(), result, truth, high), kPredicted);
    FitOptions held = exact_poses();
    held.hold = {"beam", "aim", "power", "vignetting"};
    EXPECT_GT(off_at(guess(), fit(guess(), samples, held, {}), truth, high), 2.0 * kPredicted);
}

// Of every eighth block in the lower half most is in the shade: too little light for its noise,
// which taken for light would make another beam.
TEST(Fit, LooksPastWhatStonesShade) {
    const Rig truth = fit_rig({}).rig();
    FitSamples samples = fit_samples_of(truth, flown({1.2, 1.5, 1.8, 2.0, 2.2, 2.5}), kNoise, 1);
    constexpr std::size_t kOf = 8;
    constexpr float kShade = 0.4F;
    const FitPlaces& places = samples.places;
    for (std::size_t image = 0; image < samples.images.size(); ++image) {
        for (std::size_t place = image; place < places.size(); place += kOf) {
            if (places.row(place) < 0.5 * places.height_px) continue;
            for (std::size_t c = 0; c < kChannels; ++c)
                samples.images[image].signal[kChannels * place + c] *= kShade;
        }
    }
    const FitResult result = fit(guess(), samples, exact_poses(), {});
    expect_told(result, "strobe.fore.aim_along_deg", 4.0 * std::cos(std::atan2(0.1, 0.5)));
    EXPECT_LT(off_at(guess(), result, truth, {.altitude_m = 2.0}), kPredicted);
}

// Images of hills, of which each sees others, by the relief's own kernel.
FitSamples samples_of_hills(const Rig& rig, int images) {
    FitSamples samples;
    samples.places = fit_places(rig.camera.width_px, rig.camera.height_px, rig.camera.width_px);
    const ReliefMapMaker maker(rig, {});
    std::mt19937_64 dice(4);
    std::normal_distribution<double> normal;
    for (int i = 0; i < images; ++i) {
        const Hills hills{.depth_m = 1.4 + 0.06 * i,
                          .height_m = 0.05,
                          .k_per_m = 6.0,
                          .p_rad = 1.7 * i,
                          .q_rad = 2.9 * i};
        const Relief relief = relief_of(hills, maker, rig.camera.width_px, rig.camera.height_px);
        const std::vector<float> light = signal_of(maker.map(relief, 0).map);
        FitImage image{.name = "hills",
                       .sled = {.altitude_m = hills.depth_m},
                       .planes = block_planes(relief, samples.places, rig)};
        for (std::size_t k = 0; k < light.size(); ++k) {
            const std::size_t pixel = k / kChannels;
            const float signal = light[k % kChannels * relief.point_m.size() + pixel];
            image.signal.push_back(signal * static_cast<float>(1.0 + kNoise * normal(dice)));
        }
        samples.images.push_back(std::move(image));
    }
    return samples;
}

// The rig's aims are off by 2 degrees. By blocks' own planes they are found to what their errors
// say; by the plane of the altitude, whose texture the slopes are, several times worse.
TEST(Fit, FindsTheRigOverReliefByItsRanges) {
    constexpr double kWorse = 4.0;
    FitRigNumbers numbers;
    numbers.width_px = 24;
    numbers.height_px = 18;
    FitSamples samples = samples_of_hills(fit_rig(numbers).rig(), 20);
    numbers.fore_tilt_deg += 2.0;
    const std::vector<std::pair<std::string, double>> truths{
        {"strobe.fore.aim_along_deg", 2.0 * std::cos(std::atan2(0.1, 0.5))},
        {"strobe.aft.aim_along_deg", 0.0},
        {"strobe.aft.aim_across_deg", 0.0}};
    const auto off_by = [&](const FitResult& result) {
        double squares = 0.0;
        for (const auto& [key, truth] : truths)
            squares += std::pow(number_of(result, key).value - truth, 2);
        return std::sqrt(squares);
    };
    FitOptions options;
    options.threads = 2;
    const FitResult by_ranges = fit(fit_rig(numbers), samples, options, {});
    for (const auto& [key, truth] : truths) expect_told(by_ranges, key, truth);
    for (FitImage& image : samples.images) image.planes.clear();
    const FitResult by_plane = fit(fit_rig(numbers), samples, options, {});
    EXPECT_GT(off_by(by_plane), kWorse * off_by(by_ranges)) << off_by(by_ranges);
}

TEST(Fit, FindsTheRigInWaterThatScatters) {
    FitRigNumbers numbers;
    numbers.water = "chlorophyll_mg_m3 = {}";
    numbers.multiple = 0.4;
    numbers.width_px = 16;
    numbers.height_px = 12;
    const Rig truth = fit_rig(numbers).rig();
    const FitSamples samples = fit_samples_of(truth, flown({1.2, 1.6, 2.0, 2.5}), kNoise, 2);
    numbers.multiple = 0.5;
    numbers.exponent = 4.0;
    const RigText start = fit_rig(numbers);
    const FitResult result = fit(start, samples, exact_poses(), {});
    expect_told(result, "water.chlorophyll_mg_m3", 0.4);
    EXPECT_GT(result.veil_share, 0.01);
    EXPECT_LT(off_at(start, result, truth, {.altitude_m = 3.0}), 2.0 * kPredicted);
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
    const std::vector<Sled> sleds = flown({1.2, 1.5, 2.0, 2.5});
    FitSamples grey = fit_samples_of(truth, sleds, kNoise, 11);
    std::mt19937_64 dice(11);
    std::normal_distribution<double> normal;
    for (FitImage& image : grey.images) {
        for (std::size_t i = 0; i < image.signal.size(); i += kChannels) {
            const double texture = std::exp(kTexture * normal(dice));
            for (std::size_t c = 0; c < kChannels; ++c)
                image.signal[i + c] = static_cast<float>(image.signal[i + c] * texture);
        }
    }
    const auto water_of = [&](const FitSamples& samples) {
        // Else the floor's colour, which nobody knows, has the same part in both errors.
        FitOptions options = exact_poses();
        options.hold = {"tint"};
        const FitResult result = fit(fit_rig(numbers), samples, options, {});
        expect_told(result, "water.multiple", 1.0);
        return number_of(result, "water.multiple").error;
    };
    EXPECT_LT(water_of(grey), kBetter * water_of(fit_samples_of(truth, sleds, kTexture, 11)));
}

// cos^6. Its curve is (n + 1)/(2 pi) cos^n, whose error is that of n.
TEST(Fit, FindsTheExponentOfACosine) {
    const Rig truth = fit_rig({}).rig();
    const FitSamples samples = fit_samples_of(truth, flown({1.2, 2.0, 2.8}), kNoise, 3);
    FitOptions options = exact_poses();
    options.beam = FitBeamKind::Cosine;
    const FitResult result = fit(guess(), samples, options, {});
    expect_told(result, "strobe.fore.beam.exponent", 6.0);
    const FittedNumber& exponent = number_of(result, "strobe.fore.beam.exponent");
    ASSERT_EQ(result.beam_curves.size(), 1U);
    for (const BeamPoint& point : result.beam_curves[0]) {
        constexpr double kRounding = 1e-9;
        const double n = exponent.value;
        const double cosine = std::cos(point.theta_rad);
        if (cosine < 0.1) continue;
        const double intensity = (n + 1.0) / (2.0 * std::numbers::pi) * std::pow(cosine, n);
        const double slope = 1.0 / (n + 1.0) + std::log(cosine);
        EXPECT_NEAR(point.intensity, intensity, kRounding);
        EXPECT_NEAR(point.error, intensity * std::abs(slope) * exponent.error, kRounding);
    }
    EXPECT_LT(off_at(guess(), result, truth, {.altitude_m = 3.0}), kPredicted);
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

// By one altitude the water is told by what slant paths differ by, which a lens imitates: its
// error is the prior's, and lower flights would help.
TEST(Fit, NamesWhatTheSurveyDoesNotDetermine) {
    FitRigNumbers numbers;
    numbers.width_px = 16;
    numbers.height_px = 12;
    const RigText rig = fit_rig(numbers);
    const FitSamples samples = fit_samples_of(rig.rig(), flown({2.0, 2.0}), 0.1, 5);
    FitOptions options = exact_poses();
    options.free = {{"beam", "water", "altitude", "vignetting"}};
    const FitResult result = fit(rig, samples, options, {});
    const FittedNumber& altitude = number_of(result, "sled.altitude_offset_m");
    EXPECT_FALSE(altitude.is_determined);
    EXPECT_GT(altitude.error, kDetermined * altitude.spread);
    EXPECT_LT(altitude.error, 1.5 * altitude.spread);
    EXPECT_TRUE(words_of(altitude).starts_with(
        "sled.altitude_offset_m is not determined by this survey (+-"))
        << words_of(altitude);
    // A prior as tight as that is what is told.
    options.priors = {{"altitude", 0.001}};
    EXPECT_LT(number_of(fit(rig, samples, options, {}), "sled.altitude_offset_m").error, 0.0015);
}

// Beams with edges, by cones of the rig's.
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
    const FitResult result = fit(cones_rig(22.0, 0.4), samples, options, {});
    const auto value = [&](const std::string& key) { return number_of(result, key).value; };
    EXPECT_NEAR(
        value("strobe.fore.aim_along_deg"), 2.0 * std::cos(std::atan2(0.1, 0.5)), kSoftenedAim_deg);
    EXPECT_NEAR(value("strobe.aft.aim_along_deg"), 0.0, kSoftenedAim_deg);
    EXPECT_NEAR(value("strobe.aft.aim_across_deg"), 0.0, kSoftenedAim_deg);
    EXPECT_NEAR(value("strobe.aft.power") / value("strobe.fore.power"), 0.8, kSoftenedShare);
    EXPECT_NEAR(result.state.beams[0].fitted().beam.cones[0].weight, 0.3, kSoftenedShare);
}

FitResult fitted_to(const FitSamples& samples, const RunWatch& watch = {}) {
    FitOptions options;
    options.threads = 2;
    return fit(fit_rig({}), samples, options, watch);
}

FitSamples thirty_maps(std::uint64_t seed) {
    std::vector<double> altitudes_m;
    for (int i = 0; i < 30; ++i) altitudes_m.push_back(1.2 + 0.05 * i);
    return fit_samples_of(fit_rig({}).rig(), flown(altitudes_m), kNoise, seed);
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

// Every other block a tenth darker in all images, which no beam or lens can be.
TEST(Fit, FindsOutAPatternThatStaysInPlace) {
    FitSamples samples = thirty_maps(8);
    EXPECT_TRUE(fitted_to(samples).looks_wrong.empty());
    for (FitImage& image : samples.images) {
        for (std::size_t i = 0; i < image.signal.size(); ++i)
            if (i / kChannels % 2 == 0) image.signal[i] *= 0.9F;
    }
    const FitResult result = fitted_to(samples);
    ASSERT_EQ(result.looks_wrong.size(), 1U);
    EXPECT_EQ(result.looks_wrong[0].about, "pattern");
}

// Of strobes that fire at every other image the dark ones count for nothing, in halves of the
// survey as well.
TEST(Fit, LeavesOutWhatIsDark) {
    constexpr double kRounding = 1e-6;
    std::vector<double> altitudes_m;
    for (int i = 0; i < 20; ++i) altitudes_m.push_back(1.4 + 0.05 * i);
    const FitRigNumbers numbers{.width_px = 16, .height_px = 12};
    const FitSamples lit = fit_samples_of(fit_rig(numbers).rig(), flown(altitudes_m), 0.02, 9);
    FitSamples both = lit;
    both.images.clear();
    for (const FitImage& image : lit.images) {
        both.images.push_back(image);
        both.images.push_back(image);
        std::ranges::fill(both.images.back().signal, 0.0F);
    }
    const FitResult of_lit = fit(fit_rig(numbers), lit, exact_poses(), {});
    const FitResult of_both = fit(fit_rig(numbers), both, exact_poses(), {});
    for (std::size_t k = 0; k < of_lit.numbers.size(); ++k) {
        const FittedNumber& one = of_lit.numbers[k];
        EXPECT_NEAR(of_both.numbers[k].value, one.value, kRounding * one.error) << one.key;
        EXPECT_NEAR(of_both.numbers[k].error, one.error, kRounding * one.error) << one.key;
    }
}

// Its aim is what no image shows: it stays where the rig has it, with the error that it has
// beforehand, whatever halves of the survey say of the others.
TEST(Fit, KnowsNothingOfALampThatIsOff) {
    std::vector<double> altitudes_m;
    for (int i = 0; i < 20; ++i) altitudes_m.push_back(1.4 + 0.05 * i);
    RigText rig = fit_rig({.width_px = 16, .height_px = 12});
    rig.set("strobe.aft.power", 0.0);
    const FitSamples samples = fit_samples_of(rig.rig(), flown(altitudes_m), 0.02, 9);
    const FitResult result = fit(rig, samples, exact_poses(), {});
    const FittedNumber& aim = number_of(result, "strobe.aft.aim_along_deg");
    EXPECT_EQ(aim.value, 0.0);
    EXPECT_GE(aim.error, aim.spread * (1.0 - 1e-9));
    EXPECT_FALSE(aim.is_determined);
    for (const FittedNumber& one : result.numbers) EXPECT_TRUE(std::isfinite(one.error)) << one.key;
}

TEST(Fit, RefusesFloorsThatItDoesNotKnow) {
    Rig rig = fit_rig({}).rig();
    rig.seafloor.phong = 0.5;
    EXPECT_THROW(require_bare_floor(rig), InputError);
    rig.seafloor.phong = 0.0;
    EXPECT_NO_THROW(require_bare_floor(rig));
    rig.scene = "rocks.pov";
    EXPECT_THROW(require_bare_floor(rig), InputError);
}

}  // namespace
}  // namespace aphotic::fit_test
