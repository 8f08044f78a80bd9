// SPDX-License-Identifier: BSD-3-Clause
//
// The tables of docs/reference/water.md: the ratio of the model for scattering water to light of
// all orders, in waters from clear to harbour, by phase functions, altitudes and beams.
//
//   all_orders [PATHS]        a line per rig, as Markdown, then a line per cut
//
// floor, veil, sum  model over truth, the mean over nine places, and its standard error
// rms               of the sum's error over the places, less the truth's noise
// estimate          as reported by `aphotic plan`, with kModelPaths
// cuts              instead of kLossCut: rms of the floor's and veil's errors over a water's rigs
#include "rig/file/rig_reader.h"
#include "spectral/phase_loader.h"
#include "validation/model_check.h"
#include "validation/traced_water.h"
#include "validation/tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

namespace aphotic {
namespace {

struct WaterRow {
    const char* name;
    const char* petzold;
    double a;
    double b;
};

Spectrum flat(double value) {
    return {"flat", {300.0, 1100.0}, {value, value}};
}

Beam of_width(double fwhm_deg) {
    const double half_rad = 0.5 * fwhm_deg * std::numbers::pi / 180.0;
    Beam beam{.name = "beam", .cones = {}};
    beam.cones = {{.part = "beam",
                   .half_angle_rad = 0.5 * std::numbers::pi,
                   .weight = 1.0,
                   .exponent = std::log(0.5) / std::log(std::cos(half_rad))}};
    return beam;
}

struct Over {
    double mean = 0.0;
    double noise = 0.0;
};

template <class Part>
Over over_truth(const ModelCheck& check, const Part& part) {
    Over over;
    const auto count = static_cast<double>(check.places.size());
    for (const ModelPlace& place : check.places) {
        const auto& [model, truth] = part(place);
        over.mean += model / truth.mean / count;
        over.noise += std::pow(truth.standard_error / truth.mean / count, 2.0);
    }
    over.noise = std::sqrt(over.noise);
    return over;
}

struct Compared {
    double model;
    Estimate truth;
};

std::string words(const Over& over) {
    return fmt::format("{:.3f} ± {:.3f}", over.mean, over.noise);
}

// The model with another cut, by changing the water's loss accordingly.
constexpr std::array<double, 7> kCuts_deg{5, 10, 20, 30, 45, 60, 90};

struct Squares {
    double floor = 0.0;
    double veil = 0.0;
    double count = 0.0;
};
using SquaresByCut = std::array<Squares, kCuts_deg.size()>;

Rig with_cut(Rig rig, double cut_rad) {
    const TracedPhase phase(rig.water.scatterers.front().phase);
    const double b = rig.water.scatterers.front().scattering_per_m.at(550.0);
    const double a = rig.water.absorption_per_m.at(550.0);
    const double more = phase.share_beyond(cut_rad) - phase.share_beyond(kLossCut);
    rig.water.absorption_per_m = flat(a + b * more);
    return rig;
}

void add_cuts(const Rig& rig, const ModelCheck& check, SquaresByCut& squares) {
    for (std::size_t k = 0; k < kCuts_deg.size(); ++k) {
        const Rig cut = with_cut(rig, kCuts_deg[k] * std::numbers::pi / 180.0);
        const TracedVeil veil(cut, TracedWater(cut.water));
        for (const ModelPlace& place : check.places) {
            const double nm = place.lambda_nm;
            const Tracer tracer(cut, {.signals = false, .planes_nm = {nm}});
            const std::size_t pixel = static_cast<std::size_t>(place.row) *
                                          static_cast<std::size_t>(rig.camera.width_px) +
                                      static_cast<std::size_t>(place.column);
            const double of_veil = veil.radiance(*tracer.ray(place.column, place.row, nm), nm);
            const double of_floor = tracer.pixels({&pixel, 1}).front() - of_veil;
            squares[k].floor += std::pow(of_floor / place.truth.floor.mean - 1.0, 2.0);
            squares[k].veil += std::pow(of_veil / place.truth.veil.mean - 1.0, 2.0);
            squares[k].count += 1.0;
        }
    }
}

void print_cuts(const std::string& water, const SquaresByCut& squares) {
    for (std::size_t k = 0; k < kCuts_deg.size(); ++k) {
        fmt::print("| {} | {:.0f}° | {:.3f} | {:.3f} |\n",
                   water,
                   kCuts_deg[k],
                   std::sqrt(squares[k].floor / squares[k].count),
                   std::sqrt(squares[k].veil / squares[k].count));
    }
}

void print_row(const char* water,
               const std::string& phase,
               double fwhm_deg,
               const Rig& rig,
               std::size_t paths,
               SquaresByCut& squares) {
    const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    const ModelCheck check = check_model(rig, paths, threads);
    const ModelCheck estimate = check_model(rig, kModelPaths, threads);
    double sum = 0.0;
    double share = 0.0;
    for (const ModelPlace& place : check.places) {
        sum += place.error() * place.error() - place.noise() * place.noise();
        share += place.truth.veil.mean / place.truth.sum.mean;
    }
    const auto count = static_cast<double>(check.places.size());
    const auto by_channel = estimate.rms();
    fmt::print("| {} | {} | {:.0f}° | {:.0f} | {:.3f} | {} | {} | {} | {:.3f} | {:.3f} |\n",
               water,
               phase,
               fwhm_deg,
               rig.sled.altitude_m,
               share / count,
               words(over_truth(check,
                                [](const ModelPlace& p) {
                                    return Compared{p.floor, p.truth.floor};
                                })),
               words(over_truth(check,
                                [](const ModelPlace& p) {
                                    return Compared{p.veil, p.truth.veil};
                                })),
               words(over_truth(check,
                                [](const ModelPlace& p) {
                                    return Compared{p.floor + p.veil, p.truth.sum};
                                })),
               std::sqrt(std::max(0.0, sum / count)),
               *std::ranges::max_element(by_channel));
    std::fflush(stdout);
    add_cuts(rig, check, squares);
}

void print_table(std::size_t paths) {
    const std::vector<WaterRow> waters{{"clear", "petzold-clear", 0.114, 0.037},
                                       {"coastal", "petzold-coast", 0.179, 0.219},
                                       {"turbid", "petzold-coast", 0.300, 0.600},
                                       {"harbour", "petzold-harbour", 0.366, 1.820}};
    fmt::print(
        "| water | phase | beam | m | veil | floor | veil | sum | rms | estimate |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n");
    std::vector<SquaresByCut> squares(waters.size());
    for (std::size_t w = 0; w < waters.size(); ++w) {
        const WaterRow& water = waters[w];
        const std::vector<PhaseFunction> phases{
            builtin_phase(water.petzold),
            fournier_forand(0.0183),
            {.name = "henyey-greenstein", .kind = HenyeyGreenstein{.g = 0.924}}};
        for (const PhaseFunction& phase : phases) {
            for (const double fwhm_deg : {80.0, 25.0}) {
                for (const double altitude_m : {1.0, 2.0, 3.0, 4.0}) {
                    Rig rig = read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam-led.toml");
                    rig.water.absorption_per_m = flat(water.a);
                    rig.water.scatterers = {{flat(water.b), phase}};
                    rig.sled.altitude_m = altitude_m;
                    for (Strobe& strobe : rig.strobes) strobe.beam = of_width(fwhm_deg);
                    print_row(water.name, phase.name, fwhm_deg, rig, paths, squares[w]);
                }
            }
        }
    }
    fmt::print("\n| water | cut | floor | veil |\n|---|---|---|---|\n");
    for (std::size_t w = 0; w < waters.size(); ++w) print_cuts(waters[w].name, squares[w]);
}

}  // namespace
}  // namespace aphotic

int main(int count, char** words) {
    constexpr std::size_t kPaths = 2000;
    aphotic::print_table(count > 1 ? std::strtoul(words[1], nullptr, 10) : kPaths);
}
