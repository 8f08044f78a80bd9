// SPDX-License-Identifier: BSD-3-Clause
//
// fit_bench SURVEYS [IMAGES] [SEED]: the accuracy of a fit to the light of random surveys, and of
// its error estimates. Their light is the reference's (validation/tracer.h), which shares no code
// with the fit's: sleds like HabCam with soft beams, a lens of cos^n, powers, aims and water of
// their own, images of different brightness, at poses measured to 3 cm and half a degree. Floors
// are sand, with patches of algae for odd seeds; water is clear, with chlorophyll for every third
// seed (there the light is the lightmap's, since the reference would take hours). Each fit begins
// with HabCam's three sharp cones, all aims off by up to 3 degrees, and no vignetting.
//
//   true, fitted   rms of a grey chart's tiles corrected with either rig, at the measured poses,
//                  per cent; the chart is the reference's at the true poses
//   off, said      rms error of the light's map at the flight's poses, and the fit's estimate of it
//   s              processor time
//   z              a number's deviation over its estimated error; for the map, of its pixels
#include "base/degrees.h"
#include "lightmap/lightmap.h"
#include "rig/file/rig_text.h"
#include "survey/fit/fit.h"
#include "survey/fit/fitted_rig.h"
#include "survey/simulate/floor_texture.h"
#include "survey/simulate/random_draw.h"
#include "validation/tracer.h"

#include <fmt/format.h>
#include <malloc.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace aphotic::fit_bench {
namespace {

constexpr int kWidth = 340;
constexpr int kHeight = 256;
constexpr double kAltitudeError_m = 0.03;
constexpr double kAttitudeError_rad = 0.5 * kRadiansPerDegree;
constexpr int kCharts = 12;
constexpr int kTile = 16;

struct Strobe4 {
    Eigen::Vector3d position_m;
    double tilt_deg;
};
const std::array<Strobe4, 4> kStrobes{{{{0.5, 0.0, 0.0}, 26.0},
                                       {{-0.5, 0.0, 0.0}, 26.0},
                                       {{0.0, -0.5, 0.0}, 28.0},
                                       {{0.0, 0.5, 0.0}, 28.0}}};

struct Numbers {
    std::string beam;
    std::string lens;
    std::string water;
    std::array<std::array<double, 2>, 4> off_deg{};
    std::array<double, 4> power{1.0, 1.0, 1.0, 1.0};
};

std::string toml_of(const Numbers& numbers) {
    std::string toml = fmt::format(
        "title = \"a random sled\"\n[sled]\naltitude_m = 2.0\n[camera]\nresolution = [{}, {}]\n"
        "pixel_pitch_um = 25.8\nfocal_length_mm = 12.0\nrange_nm = [400, 700]\n"
        "response = \"nikon-d5100\"\n{}[water]\n{}\n[seafloor]\nreflectance = \"sand\"\n"
        "[beam.lamp]\n{}\n",
        kWidth,
        kHeight,
        numbers.lens,
        numbers.water,
        numbers.beam);
    for (std::size_t s = 0; s < kStrobes.size(); ++s) {
        const double tilt_rad = kStrobes[s].tilt_deg * kRadiansPerDegree;
        const Eigen::Vector3d axis = (std::cos(tilt_rad) * Eigen::Vector3d::UnitZ() -
                                      std::sin(tilt_rad) * kStrobes[s].position_m.normalized())
                                         .normalized();
        const BeamFrame frame = frame_about(axis);
        const Eigen::Vector3d aimed =
            axis + std::tan(numbers.off_deg[s][0] * kRadiansPerDegree) * frame.along +
            std::tan(numbers.off_deg[s][1] * kRadiansPerDegree) * frame.across;
        toml += fmt::format(
            "[[strobe]]\nname = \"s{}\"\nposition_m = [{}, {}, {}]\ndirection = [{}, {}, {}]\n"
            "beam = \"lamp\"\nspectrum = \"xenon-flash\"\npower = {}\n",
            s,
            kStrobes[s].position_m.x(),
            kStrobes[s].position_m.y(),
            kStrobes[s].position_m.z(),
            aimed.x(),
            aimed.y(),
            aimed.z(),
            numbers.power[s]);
    }
    return toml;
}

double even(RandomSource& random, double least, double most) {
    return least + (most - least) * uniform(random);
}

struct Survey {
    RigText truth;
    RigText start;
    Numbers numbers;
    double exponent = 0.0;  // of the lens
    double water = 0.0;     // multiple, or chlorophyll relative to the start's
    std::vector<Sled> flown{};
    FitSamples samples{};
};

// By the reference; in water that scatters by the lightmap, since the reference would take hours.
CameraImage traced(Rig rig, const Sled& sled, int threads) {
    if (rig.water.scatters())
        return {
            kWidth, kHeight, signal_of(LightmapMaker(rig, paths_of(rig, {sled}), {}).map(sled))};
    rig.sled = sled;
    const Tracer tracer(rig, {.signals = true, .planes_nm = {}, .threads = threads});
    const std::vector<double> planes = tracer.rows(0, kHeight);
    return {kWidth, kHeight, {planes.begin(), planes.end()}};
}

// The floor's reflectance, relative to the rig's, by channel.
std::array<double, kChannels> floor_at(const FloorTexture& grain,
                                       const FloorTexture* patches,
                                       double x_m,
                                       double y_m) {
    constexpr std::array<double, kChannels> kAlgae{0.4, 0.6, 0.45};
    const double sand = grain.at(x_m, y_m);
    const bool is_algae = patches != nullptr && patches->at(x_m, y_m) > 1.4;
    std::array<double, kChannels> floor{};
    for (std::size_t c = 0; c < kChannels; ++c) floor[c] = sand * (is_algae ? kAlgae[c] : 1.0);
    return floor;
}

// electrons: those of a signal of 1.
FitImage photographed(const Survey& survey,
                      double electrons_per_signal,
                      std::size_t i,
                      std::uint64_t seed,
                      const CameraImage& light) {
    RandomSource random = random_of(seed, static_cast<int>(i) + 1);
    const FloorTexture grain(0.25, random());
    const FloorTexture patches(0.5, random());
    const double level = std::exp(0.22 * normal(random));
    const FitPlaces& places = survey.samples.places;
    const double x_m = even(random, 0.0, 100.0);
    const double y_m = even(random, 0.0, 100.0);
    const double per_px = 25.8e-6 / 12e-3 * survey.flown[i].altitude_m;
    FitImage image{.name = fmt::format("{:04}", i + 1), .sled = survey.flown[i]};
    image.sled.altitude_m += kAltitudeError_m * normal(random);
    image.sled.pitch_rad += kAttitudeError_rad * normal(random);
    image.sled.roll_rad += kAttitudeError_rad * normal(random);
    for (std::size_t place = 0; place < places.size(); ++place) {
        std::array<double, kChannels> sum{};
        const int first_column = static_cast<int>(places.column(place)) - places.block_px / 2;
        const int first_row = static_cast<int>(places.row(place)) - places.block_px / 2;
        for (int row = first_row; row < first_row + places.block_px; ++row) {
            for (int column = first_column; column < first_column + places.block_px; ++column) {
                const auto floor = floor_at(grain,
                                            seed % 2 == 1 ? &patches : nullptr,
                                            x_m + per_px * column,
                                            y_m + per_px * row);
                for (std::size_t c = 0; c < kChannels; ++c) {
                    sum[c] += floor[c] *
                              light.samples[(c * kHeight + static_cast<std::size_t>(row)) * kWidth +
                                            static_cast<std::size_t>(column)];
                }
            }
        }
        const double pixels = places.block_px * places.block_px;
        for (std::size_t c = 0; c < kChannels; ++c) {
            const double electrons = electrons_per_signal * level * sum[c] / pixels;
            // Half of a mosaic's pixels are green.
            const double seen = pixels * (c == 1 ? 0.5 : 0.25);
            constexpr double kRead2 = 64.0;
            image.signal.push_back(static_cast<float>(
                electrons + std::sqrt((electrons + kRead2) / seen) * normal(random)));
        }
    }
    return image;
}

Survey drawn(std::uint64_t seed, int images, int threads) {
    RandomSource random = random_of(seed, 0);
    const bool scatters = seed % 3 == 0;
    Numbers truth;
    const double narrow = even(random, 8.0, 20.0);
    const double share = even(random, 0.4, 0.8);
    truth.beam = fmt::format(
        "cones = [{{ part = \"narrow\", half_angle_deg = 90.0, weight = {}, exponent = {} }}, "
        "{{ part = \"wide\", half_angle_deg = 90.0, weight = {}, exponent = {} }}]",
        share,
        narrow,
        1.0 - share,
        even(random, 2.0, 5.0));
    const double exponent = even(random, 2.0, 5.0);
    const double water = std::exp(even(random, -0.25, 0.25));
    truth.lens = fmt::format("vignetting = {{ cosine = {} }}\n", exponent);
    Numbers start;
    start.beam =
        "cones = [{ part = \"collimated\", half_angle_deg = 10.0, weight = 0.165 }, "
        "{ part = \"focused\", half_angle_deg = 26.565, weight = 0.094 }, "
        "{ part = \"diffuse\", half_angle_deg = 90.0, weight = 0.741 }]";
    const char* kind =
        scatters ? "chlorophyll_mg_m3 = {}" : "absorption = \"pope-fry-1997\"\nmultiple = {}";
    constexpr double kChlorophyll = 0.1;
    truth.water = fmt::format(fmt::runtime(kind), scatters ? kChlorophyll * water : water);
    start.water = fmt::format(fmt::runtime(kind), scatters ? kChlorophyll : 1.0);
    for (std::size_t s = 0; s < 4; ++s) {
        const double off_deg = even(random, 0.0, 3.0);
        const double about = even(random, 0.0, 6.28);
        truth.off_deg[s] = {off_deg * std::cos(about), off_deg * std::sin(about)};
        truth.power[s] = std::exp(0.1 * normal(random));
    }
    Survey survey{.truth = RigText(toml_of(truth), "truth.toml", {}),
                  .start = RigText(toml_of(start), "start.toml", {}),
                  .numbers = truth,
                  .exponent = exponent,
                  .water = water};
    for (int i = 0; i < images; ++i) {
        survey.flown.push_back({.altitude_m = even(random, 1.5, 3.0),
                                .pitch_rad = even(random, -2.0, 6.0) * kRadiansPerDegree,
                                .roll_rad = even(random, -3.0, 3.0) * kRadiansPerDegree});
    }
    survey.samples.places = fit_places(kWidth, kHeight, kBlocksAcross);
    const Rig rig = survey.truth.rig();
    constexpr double kWell_e = 15000.0;
    const CameraImage lowest = traced(rig, {.altitude_m = 1.5}, threads);
    const double brightest = *std::ranges::max_element(lowest.samples);
    for (std::size_t i = 0; i < survey.flown.size(); ++i) {
        survey.samples.images.push_back(photographed(
            survey, 0.7 * kWell_e / brightest, i, seed, traced(rig, survey.flown[i], threads)));
    }
    return survey;
}

// The rms of charts corrected with a rig, at the measured poses; without a rig: uncorrected.
double uneven(const Survey& survey, const std::vector<CameraImage>& charts, const Rig* rig) {
    std::vector<Sled> told;
    for (std::size_t i = 0; i < charts.size(); ++i) told.push_back(survey.samples.images[i].sled);
    std::array<std::vector<double>, kChannels> tiles;
    for (std::size_t i = 0; i < charts.size(); ++i) {
        std::vector<float> map(charts[i].samples.size(), 1.0F);
        if (rig != nullptr)
            map = signal_of(LightmapMaker(*rig, paths_of(*rig, told), {}).map(told[i]));
        for (std::size_t c = 0; c < kChannels; ++c) {
            for (int row = 0; row + kTile <= kHeight; row += kTile) {
                for (int column = 0; column + kTile <= kWidth; column += kTile) {
                    double sum = 0.0;
                    for (int y = row; y < row + kTile; ++y) {
                        for (int x = column; x < column + kTile; ++x) {
                            const std::size_t at =
                                (c * kHeight + static_cast<std::size_t>(y)) * kWidth +
                                static_cast<std::size_t>(x);
                            sum += static_cast<double>(charts[i].samples[at]) /
                                   static_cast<double>(map[at]);
                        }
                    }
                    tiles[c].push_back(sum);
                }
            }
        }
    }
    double squares = 0.0;
    for (const std::vector<double>& of : tiles) {
        double mean = 0.0;
        double square = 0.0;
        for (const double tile : of) {
            mean += tile / static_cast<double>(of.size());
            square += tile * tile / static_cast<double>(of.size());
        }
        squares += square / (mean * mean) - 1.0;
    }
    return 100.0 * std::sqrt(squares / kChannels);
}

// The logarithm of the fitted map over the true one, by pixel of all channels of the flight.
std::vector<double> off_of(const Survey& survey, const Rig& truth, const Rig& fitted) {
    std::vector<double> off;
    for (std::size_t i = 0; i < std::min<std::size_t>(kCharts, survey.flown.size()); ++i) {
        const Sled& sled = survey.flown[i];
        const auto map = [&](const Rig& rig) {
            return signal_of(LightmapMaker(rig, paths_of(rig, {sled}), {}).map(sled));
        };
        const std::vector<float> found = map(fitted);
        const std::vector<float> wanted = map(truth);
        for (std::size_t k = 0; k < found.size(); ++k)
            off.push_back(std::log(static_cast<double>(found[k]) / static_cast<double>(wanted[k])));
    }
    // Less each channel's mean, which a floor's level would absorb.
    std::array<double, kChannels> mean{};
    constexpr std::size_t kPixels = static_cast<std::size_t>(kWidth) * kHeight;
    for (std::size_t k = 0; k < off.size(); ++k)
        mean[k / kPixels % kChannels] += off[k] * kChannels / static_cast<double>(off.size());
    for (std::size_t k = 0; k < off.size(); ++k) off[k] -= mean[k / kPixels % kChannels];
    return off;
}

struct Count {
    double within = 0.0;
    double all = 0.0;
    double squares = 0.0;

    void add(double z) {
        all += 1.0;
        within += std::abs(z) < 2.0 ? 1.0 : 0.0;
        squares += z * z;
    }
};

std::optional<double> truth_of(const Survey& survey, const FittedNumber& number) {
    for (std::size_t s = 0; s < 4; ++s) {
        const std::string key = fmt::format("strobe.s{}.", s);
        if (number.key == key + "aim_along_deg") return survey.numbers.off_deg[s][0];
        if (number.key == key + "aim_across_deg") return survey.numbers.off_deg[s][1];
        double mean = 0.0;
        for (const double power : survey.numbers.power) mean += 0.25 * power;
        if (number.key == key + "power") return survey.numbers.power[s] / mean;
    }
    if (number.key == "camera.vignetting.cosine") return survey.exponent;
    if (number.key == "water.multiple") return survey.water;
    return std::nullopt;
}

int run(int surveys, int images, std::uint64_t first) {
    const int threads = static_cast<int>(std::thread::hardware_concurrency());
    std::map<std::string, Count> counts;
    double ratios = 0.0;
    double worst = 0.0;
    fmt::print("seed   raw  start  true  fitted ratio   off  said   s  rounds  warnings\n");
    for (int k = 0; k < surveys; ++k) {
        const Survey survey = drawn(first + static_cast<std::uint64_t>(k), images, threads);
        std::vector<CameraImage> charts;
        const Rig truth = survey.truth.rig();
        for (std::size_t i = 0; i < std::min<std::size_t>(kCharts, survey.flown.size()); ++i)
            charts.push_back(traced(truth, survey.flown[i], threads));
        FitOptions options;
        options.altitude_error_m = kAltitudeError_m;
        options.attitude_error_rad = kAttitudeError_rad;
        options.threads = threads;
        const std::clock_t begun = std::clock();
        const FitResult result = fit(survey.start, survey.samples, options, {});
        const double seconds = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
        const std::filesystem::path folder = std::filesystem::temp_directory_path() /
                                             fmt::format("fit_bench-{}", std::time(nullptr));
        std::filesystem::create_directories(folder);
        write_fitted_rig(survey.start, result, folder);
        const Rig fitted = RigText(folder / kFittedRig).rig();
        std::filesystem::remove_all(folder);
        const Rig start = survey.start.rig();
        const double by_truth = uneven(survey, charts, &truth);
        const double by_fit = uneven(survey, charts, &fitted);
        ratios += by_fit / by_truth / surveys;
        worst = std::max(worst, by_fit / by_truth);
        const std::vector<double> off = off_of(survey, truth, fitted);
        double squares = 0.0;
        for (const double one : off) {
            squares += one * one;
            counts["map"].add(one / result.unevenness);
        }
        std::string words;
        for (const Suspicion& one : result.looks_wrong) words += " " + one.about;
        fmt::print(
            "{:4} {:5.1f} {:6.1f} {:5.2f} {:7.2f} {:5.2f} {:5.2f} {:5.2f} {:4.0f} {:4}  {}\n",
            first + static_cast<std::uint64_t>(k),
            uneven(survey, charts, nullptr),
            uneven(survey, charts, &start),
            by_truth,
            by_fit,
            by_fit / by_truth,
            100.0 * std::sqrt(squares / static_cast<double>(off.size())),
            100.0 * result.unevenness,
            seconds,
            result.rounds,
            words);
        std::fflush(stdout);
        for (const FittedNumber& one : result.numbers) {
            const auto wanted = truth_of(survey, one);
            if (!wanted) continue;
            const double z = (one.value - *wanted) / one.error;
            counts[one.word + (one.is_determined ? "" : " (not determined)")].add(z);
        }
    }
    fmt::print("fitted over true: mean {:.2f}, most {:.2f}\n", ratios, worst);
    for (const auto& [word, count] : counts) {
        fmt::print("{:<28} {:.0f} of {:.0f} ({:.1f} %) within two errors, rms z {:.2f}\n",
                   word,
                   count.within,
                   count.all,
                   100.0 * count.within / count.all,
                   std::sqrt(count.squares / count.all));
    }
    return 0;
}

}  // namespace
}  // namespace aphotic::fit_bench

int main(int argc, char** argv) {
    mallopt(M_MMAP_THRESHOLD, 1 << 30);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    if (argc < 2) {
        fmt::print(stderr, "fit_bench SURVEYS [IMAGES] [SEED]\n");
        return 2;
    }
    return aphotic::fit_bench::run(std::atoi(argv[1]),
                                   argc > 2 ? std::atoi(argv[2]) : 60,
                                   argc > 3 ? static_cast<std::uint64_t>(std::atoll(argv[3])) : 1);
}
