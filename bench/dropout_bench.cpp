// SPDX-License-Identifier: BSD-3-Clause
//
// dropout_bench [IMAGES] [SEED]: the rates of detected dropouts (survey/dropouts.h) and of false
// alarms over simulated surveys: the four strobes of scenes/survey, then two of them at the ends,
// then two beside each other; images of 340 x 256 mosaics of 12 bits with noise, at poses measured
// to 3 cm and half a degree. Floors are sand of 25 % contrast under patches of algae, different in
// every image and brighter or darker by 22 %; in every tenth, a meadow that reflects two fifths
// begins somewhere in view. Scales are learned from 16 images, as `correct` does. The light is the
// lightmap's; detection uses the true rig, and one whose aims are off by 3 degrees and powers by 10
// %, as at the start of a fit.
#include "base/degrees.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "lightmap/design.h"
#include "lightmap/planes.h"
#include "rig/file/rig_reader.h"
#include "rig/geometry.h"
#include "survey/dropout_check.h"
#include "survey/simulate/floor_texture.h"
#include "survey/simulate/random_draw.h"
#include "survey/simulate/simulated_survey.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <thread>

namespace aphotic {
namespace {

enum Kind { Fired, OneOut, TwoOut, None, Half, Tenth, kKinds };
constexpr std::array<const char*, kKinds> kWords{
    "all fired", "one out", "two out of four", "none fired", "all at 0.5", "all at 0.1"};

struct Shot {
    Kind kind = Fired;
    std::uint64_t out = 0;
    double power = 1.0;
};

struct Flown {
    Rig rig;
    std::vector<Leg> legs;
    std::vector<Leg> told;
    RawCamera camera;
    std::uint64_t seed;
    std::vector<Shot> shots{};
    std::vector<SurveyImage> images{};
};

Shot shot_of(RandomSource& random, std::size_t strobes) {
    const double lot = uniform(random);
    const std::uint64_t all = (std::uint64_t{1} << strobes) - 1;
    const auto one = [&] {
        return std::uint64_t{1} << static_cast<unsigned>(uniform(random) *
                                                         static_cast<double>(strobes));
    };
    if (lot < 0.6) return {};
    if (lot < 0.75) return {OneOut, one()};
    if (lot < 0.85 && strobes > 2) {
        std::uint64_t out = one();
        while (std::popcount(out) < 2) out |= one();
        return {TwoOut, out};
    }
    if (lot < 0.9) return {None, all, 0.0};
    return lot < 0.95 ? Shot{Half, 0, 0.5} : Shot{Tenth, 0, 0.1};
}

// The floor's reflectance, relative to the rig's, at a pixel's point on the floor [m].
class Floor {
  public:
    explicit Floor(RandomSource& random)
        : sand_(0.25, random()),
          algae_(0.5, random()),
          level_(std::exp(0.22 * normal(random))),
          has_meadow_(uniform(random) < 0.1),
          meadow_rad_(2.0 * std::numbers::pi * uniform(random)),
          meadow_m_(0.5 * normal(random)) {}
    [[nodiscard]] float at(double x_m, double y_m) const {
        constexpr double kAlgae = 0.6;
        constexpr double kMeadow = 0.4;
        const bool is_meadow =
            has_meadow_ && x_m * std::cos(meadow_rad_) + y_m * std::sin(meadow_rad_) > meadow_m_;
        return static_cast<float>(level_ * sand_.at(x_m, y_m) *
                                  (algae_.at(x_m, y_m) > 1.4 ? kAlgae : 1.0) *
                                  (is_meadow ? kMeadow : 1.0));
    }

  private:
    FloorTexture sand_;
    FloorTexture algae_;
    double level_;
    bool has_meadow_;
    double meadow_rad_;
    double meadow_m_;
};

void photograph(Flown& flown, const LightmapMaker& maker, std::size_t i) {
    const Leg& leg = flown.legs[i];
    RandomSource random = random_of(flown.seed + 77, leg.image);
    const Shot shot = flown.shots[i] = shot_of(random, flown.rig.strobes.size());
    const Floor floor(random);
    LightmapMaker lit = maker;
    std::vector<StrobePlace> places;
    for (std::size_t s = 0; s < flown.rig.strobes.size(); ++s) {
        const Strobe& strobe = flown.rig.strobes[s];
        const double power = (shot.out >> s & 1U) != 0 ? 0.0 : shot.power * strobe.power;
        places.push_back({strobe.position_m, strobe.axis, power});
    }
    lit.place(places);
    const Lightmap map = lit.map(leg.sled);
    CameraImage signal{map.width_px, map.height_px, signal_of(map)};
    const Plane plane = floor_plane(leg.sled);
    const std::size_t pixels = signal.samples.size() / kChannels;
    for (std::size_t p = 0; p < pixels; ++p) {
        const auto width = static_cast<std::size_t>(map.width_px);
        const WaterRay ray = pixel_ray(flown.rig,
                                       static_cast<double>(p % width) + 0.5,
                                       static_cast<double>(p / width) + 0.5,
                                       550.0);
        const std::optional<double> far_m = distance_to(plane, ray);
        const Eigen::Vector3d point_m = ray.origin_m + far_m.value_or(0.0) * ray.direction;
        const float reflects = floor.at(point_m.x(), point_m.y());
        for (std::size_t c = 0; c < kChannels; ++c) signal.samples[c * pixels + p] *= reflects;
    }
    const std::vector<std::uint16_t> raw =
        raw_samples(signal, flown.camera, NoiseOf{.seed = flown.seed, .image = leg.image});
    flown.images[i].raw = {.width_px = map.width_px,
                           .height_px = map.height_px,
                           .mosaic = flown.camera.mosaic,
                           .samples = {raw.begin(), raw.end()}};
    flown.images[i].levels = {.black = static_cast<float>(flown.camera.black_dn),
                              .white = static_cast<float>(flown.camera.white_dn)};
}

// With these strobes alone; empty: all.
Flown flown(const std::vector<std::string>& strobes, std::size_t images, std::uint64_t seed) {
    Rig rig = read_rig(APHOTIC_SOURCE_DIR "/scenes/survey/survey.toml");
    std::erase_if(rig.strobes, [&](const Strobe& strobe) {
        return !strobes.empty() && std::ranges::find(strobes, strobe.name) == strobes.end();
    });
    const FlightRanges ranges;
    Flown all{.rig = rig,
              .legs = flight(ranges, seed, static_cast<int>(images)),
              .told = {},
              .camera = {},
              .seed = seed};
    all.told = as_measured(all.legs, {.altitude_m = 0.03, .attitude_deg = 0.5}, seed);
    constexpr double kFilled = 0.6;  // a bright floor is not saturated
    all.camera.electrons_per_signal =
        electrons_for_share(rig, corners_of(ranges), all.camera.saturation_e, kFilled);
    all.shots.resize(images);
    all.images.resize(images);
    const LightmapMaker maker(rig, paths_of(rig, corners_of(ranges)), {});
    parallel_for(images, std::thread::hardware_concurrency(), [&](std::size_t i, std::size_t) {
        photograph(all, maker, i);
    });
    return all;
}

Rig as_a_fit_begins(Rig rig, std::uint64_t seed) {
    RandomSource random = random_of(seed, 0);
    for (Strobe& strobe : rig.strobes) {
        const Eigen::Vector3d off(normal(random), normal(random), normal(random));
        const Eigen::Vector3d about = strobe.axis.cross(off).normalized();
        strobe.axis = Eigen::AngleAxisd(3.0 * kRadiansPerDegree, about) * strobe.axis;
        strobe.power *= std::exp(0.1 * normal(random));
    }
    return rig;
}

struct Tally {
    std::size_t images = 0;
    std::size_t right = 0;  // correct
    std::size_t other = 0;  // found, but as another one
};
using Tallies = std::array<Tally, kKinds>;

void judge_all(const Flown& flown, const Rig& rig, Tallies& tallies, double& seconds) {
    std::vector<ImagePose> poses;
    Survey survey;
    for (const Leg& leg : flown.told) {
        poses.push_back({.image = leg.name, .sled = leg.sled});
        survey.files.push_back({.source = leg.name, .name = leg.name});
    }
    survey.navigation = Navigation("simulated", std::move(poses));
    survey.strobes = strobes_of_rig(rig, *survey.navigation, survey.files);
    const Stopwatch watch;
    std::vector<LightCells> all;
    for (std::size_t i = 0; i < flown.images.size(); ++i)
        all.push_back(light_cells(flown.images[i], survey, survey.files[i]));
    constexpr std::size_t kLooks = 16;
    std::vector<LightCells> looks;
    for (std::size_t i = 0; i < kLooks; ++i) looks.push_back(all[i * all.size() / kLooks]);
    const DropoutScales scales = learned(looks);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Dropout found = judged(all[i], scales);
        const Shot& shot = flown.shots[i];
        const bool is_dim = found.is_any() && !found.is_dark && found.out == 0;
        const bool is_right = shot.kind == Fired  ? !found.is_any()
                              : shot.kind == None ? found.is_dark
                              : shot.kind >= Half ? is_dim
                                                  : found.out == shot.out;
        Tally& tally = tallies.at(shot.kind);
        ++tally.images;
        if (is_right) ++tally.right;
        if (!is_right && found.is_any()) ++tally.other;
        if (std::getenv("APHOTIC_TELL") != nullptr && !is_right)
            fmt::print(
                "{} {}: out {:b}, found {:b} share {:.2f} dark {} ratio {:.1f} level {:.2f}\n",
                kWords.at(shot.kind),
                flown.legs[i].name,
                shot.out,
                found.out,
                found.share,
                found.is_dark,
                found.log_ratio,
                found.level);
    }
    if (std::getenv("APHOTIC_TELL") != nullptr)
        fmt::print("scales: level {:.2f} spread {:.3f}\n", scales.level, scales.spread);
    seconds += watch.seconds();
}

void print(const char* rig, const Tallies& tallies) {
    fmt::print("judged by {}:\n  {:16} {:>7} {:>7} {:>11} {:>7}\n",
               rig,
               "",
               "images",
               "right",
               "told other",
               "missed");
    for (std::size_t k = 0; k < kKinds; ++k) {
        const Tally& tally = tallies.at(k);
        fmt::print("  {:16} {:7} {:7} {:11} {:7}\n",
                   kWords.at(k),
                   tally.images,
                   tally.right,
                   tally.other,
                   tally.images - tally.right - tally.other);
    }
}

}  // namespace
}  // namespace aphotic

int main(int count, char** words) {
    using namespace aphotic;
    const std::vector<std::string> told(words + 1, words + count);
    const std::size_t images = !told.empty() ? std::stoul(told[0]) : 1000;
    const std::uint64_t seed = told.size() > 1 ? std::stoul(told[1]) : 1;
    const std::vector<std::vector<std::string>> rigs{{}, {"fore", "aft"}, {"fore", "starboard"}};
    constexpr std::size_t kSurvey = 100;
    Tallies by_truth{};
    Tallies by_start{};
    double seconds = 0.0;
    for (std::size_t done = 0, k = 0; done < images; done += kSurvey, ++k) {
        const Flown survey =
            flown(rigs[k % rigs.size()], std::min(kSurvey, images - done), seed + k);
        judge_all(survey, survey.rig, by_truth, seconds);
        judge_all(survey, as_a_fit_begins(survey.rig, seed + k), by_start, seconds);
    }
    print("the true rig", by_truth);
    print("a rig whose aims are off by 3 degrees", by_start);
    fmt::print("{:.2f} ms an image\n", 1e3 * seconds / 2.0 / static_cast<double>(images));
}
