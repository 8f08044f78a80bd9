// SPDX-License-Identifier: BSD-3-Clause
//
// The table of docs/water.md: the model of water that scatters over light of all orders, in waters
// from clear to harbour, by phase functions, altitudes and beams.
//
//   all_orders [PATHS]        a line a rig, as Markdown
//
// floor, veil, sum  the model over the truth, in the mean over nine places, and the standard error
// rms               of the sum's error over the places, less the truth's noise
// estimate          what `aphotic plan` tells, by kModelPaths
#include "rig/rig_reader.h"
#include "spectral/phase_loader.h"
#include "validation/model_check.h"

#include <fmt/format.h>

#include <algorithm>
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

void print_row(const char* water,
               const std::string& phase,
               double fwhm_deg,
               const Rig& rig,
               std::size_t paths) {
    const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    const ModelCheck check = check_model(rig, paths, threads);
    const ModelCheck estimate = check_model(rig, kModelPaths, threads);
    double squares = 0.0;
    double share = 0.0;
    for (const ModelPlace& place : check.places) {
        squares += place.error() * place.error() - place.noise() * place.noise();
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
               std::sqrt(std::max(0.0, squares / count)),
               *std::ranges::max_element(by_channel));
    std::fflush(stdout);
}

void print_table(std::size_t paths) {
    const std::vector<WaterRow> waters{{"clear", "petzold-clear", 0.114, 0.037},
                                       {"coastal", "petzold-coast", 0.179, 0.219},
                                       {"turbid", "petzold-coast", 0.300, 0.600},
                                       {"harbour", "petzold-harbour", 0.366, 1.820}};
    fmt::print(
        "| water | phase | beam | m | veil | floor | veil | sum | rms | estimate |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n");
    for (const WaterRow& water : waters) {
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
                    print_row(water.name, phase.name, fwhm_deg, rig, paths);
                }
            }
        }
    }
}

}  // namespace
}  // namespace aphotic

int main(int count, char** words) {
    constexpr std::size_t kPaths = 2000;
    aphotic::print_table(count > 1 ? std::strtoul(words[1], nullptr, 10) : kPaths);
}
