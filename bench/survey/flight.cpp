// SPDX-License-Identifier: BSD-3-Clause
#include "bench/survey/flight.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <random>

namespace aphotic::survey {

namespace {

double fraction(double x) {
    return x - std::floor(x);
}

double rounded(double value, double step) {
    return std::round(value / step) * step;
}

// The library's own distributions differ from one standard library to the next.
double uniform(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11U) * 0x1p-53;
}

// By Box and Muller.
double normal(std::mt19937_64& random) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(random)));
    return radius * std::cos(2.0 * std::numbers::pi * uniform(random));
}

std::mt19937_64 random_of(std::uint64_t seed, int image) {
    std::seed_seq words{static_cast<std::uint32_t>(seed),
                        static_cast<std::uint32_t>(seed >> 32U),
                        static_cast<std::uint32_t>(image)};
    return std::mt19937_64(words);
}

}  // namespace

Leg leg(std::uint64_t seed, int image) {
    std::mt19937_64 start = random_of(seed, 0);
    std::mt19937_64 random = random_of(seed, image);
    const double height = fraction(uniform(start) + image * (std::numbers::phi - 1.0));
    const double pitch = uniform(random);
    const double roll = uniform(random);
    return {.image = image,
            .name = fmt::format("{:06}", image),
            .floor_seed = static_cast<std::uint32_t>(random() >> 33U),
            .altitude_m = rounded(std::lerp(kLowest_m, kHighest_m, height), 1e-3),
            .pitch_deg = rounded(std::lerp(kLeastPitch_deg, kMostPitch_deg, pitch), 1e-2),
            .roll_deg = rounded(std::lerp(-kMostRoll_deg, kMostRoll_deg, roll), 1e-2),
            .has_chart = image <= 5 || image % 10 == 0};
}

std::vector<Leg> flight(std::uint64_t seed, int images) {
    std::vector<Leg> legs;
    for (int image = 1; image <= images; ++image) legs.push_back(leg(seed, image));
    return legs;
}

std::vector<Leg> as_measured(const std::vector<Leg>& legs, std::uint64_t seed) {
    std::vector<Leg> measured = legs;
    for (Leg& leg : measured) {
        std::mt19937_64 random = random_of(~seed, leg.image);
        leg.altitude_m += kAltimeterError_m * normal(random);
        leg.pitch_deg += kAttitudeError_deg * normal(random);
        leg.roll_deg += kAttitudeError_deg * normal(random);
    }
    return measured;
}

std::string navigation(const std::vector<Leg>& legs, const std::string& suffix) {
    std::string lines;
    for (const Leg& leg : legs) {
        lines += fmt::format("{}{} {:.3f} {:.2f} {:.2f}\n",
                             leg.name,
                             suffix,
                             leg.altitude_m,
                             leg.pitch_deg,
                             leg.roll_deg);
    }
    return lines;
}

}  // namespace aphotic::survey
