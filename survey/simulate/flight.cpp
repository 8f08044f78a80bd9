// SPDX-License-Identifier: BSD-3-Clause
#include "survey/simulate/flight.h"

#include "base/degrees.h"
#include "base/error.h"
#include "rig/vehicle_pose.h"
#include "survey/navigation/time_text.h"
#include "survey/simulate/random_draw.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace aphotic {
namespace {

constexpr double kAltitudeStep_m = 1e-3;
constexpr double kTiltStep_deg = 1e-2;

double rounded(double value, double step) {
    return std::round(value / step) * step;
}

double tilt_rad(double tilt_deg) {
    return rounded(tilt_deg, kTiltStep_deg) * kRadiansPerDegree;
}

double within(const std::array<double, 2>& range, double share) {
    return std::lerp(range[0], range[1], share);
}

Leg leg(const FlightRanges& ranges, std::uint64_t seed, int image) {
    RandomSource start = random_of(seed, 0);
    RandomSource random = random_of(seed, image);
    double whole = 0.0;
    const double height = std::modf(uniform(start) + image * (std::numbers::phi - 1.0), &whole);
    const double pitch = uniform(random);
    const double roll = uniform(random);
    return {.image = image,
            .name = fmt::format("{:06}", image),
            .sled = {.altitude_m = rounded(within(ranges.altitude_m, height), kAltitudeStep_m),
                     .pitch_rad = tilt_rad(within(ranges.pitch_deg, pitch)),
                     .roll_rad = tilt_rad(within(ranges.roll_deg, roll))}};
}

// A field of CSV.
std::string quoted(const std::string& name) {
    return name.find_first_of(",# ") == std::string::npos ? name : '"' + name + '"';
}

// Ten digits reproduce numbers rounded to a step exactly, and any other pose to a nanometre.
std::string pose_text(const Sled& sled) {
    return fmt::format(",{:.10g},{:.10g},{:.10g}\n",
                       sled.altitude_m,
                       sled.pitch_rad * kDegreesPerRadian,
                       sled.roll_rad * kDegreesPerRadian);
}

}  // namespace

std::vector<Leg> flight(const FlightRanges& ranges, std::uint64_t seed, int images) {
    std::vector<Leg> legs;
    for (int image = 1; image <= images; ++image) legs.push_back(leg(ranges, seed, image));
    return legs;
}

std::uint32_t floor_seed(std::uint64_t seed, int image) {
    RandomSource random = random_of(seed, image);
    random.discard(2);  // the pose's
    return static_cast<std::uint32_t>(random() >> 33U);
}

std::vector<Leg> flight_of(const Navigation& navigation) {
    std::vector<Leg> legs;
    for (const std::string& image : navigation.images()) {
        legs.push_back({.image = static_cast<int>(legs.size()) + 1,
                        .name = without_extension(std::filesystem::path(image).filename()).string(),
                        .sled = navigation.pose_of(image).sled});
    }
    if (legs.empty()) throw InputError("found no poses of images; allowed: a table of these");
    return legs;
}

std::vector<Sled> corners_of(const FlightRanges& ranges) {
    std::vector<Sled> ends;
    for (const std::size_t end : {0U, 1U}) {
        ends.push_back({.altitude_m = ranges.altitude_m.at(end),
                        .pitch_rad = ranges.pitch_deg.at(end) * kRadiansPerDegree,
                        .roll_rad = ranges.roll_deg.at(end) * kRadiansPerDegree});
    }
    return corners_of(ends);
}

std::vector<Leg> as_measured(std::vector<Leg> legs,
                             const InstrumentErrors& errors,
                             std::uint64_t seed) {
    for (Leg& leg : legs) {
        RandomSource random = random_of(~seed, leg.image);
        Sled& sled = leg.sled;
        const auto measured_rad = [&](double true_rad, double bias_deg) {
            return tilt_rad(true_rad * kDegreesPerRadian + bias_deg +
                            errors.attitude_deg * normal(random));
        };
        sled.altitude_m =
            rounded(sled.altitude_m + errors.altitude_bias_m + errors.altitude_m * normal(random),
                    kAltitudeStep_m);
        sled.pitch_rad = measured_rad(sled.pitch_rad, errors.pitch_bias_deg);
        sled.roll_rad = measured_rad(sled.roll_rad, errors.roll_bias_deg);
    }
    return legs;
}

std::string navigation_text(const std::vector<Leg>& legs, const std::string& suffix) {
    std::string text = "image,altitude_m,pitch_deg,roll_deg\n";
    for (const Leg& leg : legs) text += quoted(leg.name + suffix) + pose_text(leg.sled);
    return text;
}

std::string timed_navigation_text(const std::vector<Leg>& legs) {
    std::string text = "time,altitude_m,pitch_deg,roll_deg\n";
    for (const Leg& leg : legs) text += utc_text(time_of(leg)) + pose_text(leg.sled);
    return text;
}

double time_of(const Leg& leg) {
    static const double kFirst_s = *unix_time_s("2020-01-01 12:00:00");
    return kFirst_s + leg.image - 1;
}

std::vector<Leg> of_vehicle(std::vector<Leg> legs, const Mounting& mounting) {
    for (Leg& leg : legs) leg.sled = vehicle_pose(leg.sled, mounting);
    return legs;
}

}  // namespace aphotic
