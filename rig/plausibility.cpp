// SPDX-License-Identifier: BSD-3-Clause
#include "rig/plausibility.h"

#include "base/csv.h"
#include "base/degrees.h"
#include "base/number.h"
#include "base/printable.h"
#include "rig/camera/calibration_doubts.h"
#include "rig/geometry.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <variant>

namespace aphotic {

using Eigen::Vector3d;

namespace {

// The size of this unit in the key's own unit.
struct Unit {
    std::string_view name;
    double factor = 1.0;
};

constexpr double kHalfPi = 0.5 * std::numbers::pi;
constexpr double kMillimetresPerInch = 25.4;

// A line of usual.csv.
struct Usual {
    std::string_view key;
    double least;
    double most;
    double typical;
    bool is_zero_usual;
    std::string_view why;
    std::vector<Unit> units{};
};

Usual usual_in(const std::vector<std::string_view>& fields) {
    const auto number = [&](std::size_t i) { return read_number<double>(fields[i]).value(); };
    Usual usual{.key = fields[0],
                .least = number(1),
                .most = number(2),
                .typical = number(3),
                .is_zero_usual = fields[4] == "yes",
                .why = fields[5]};
    for (std::size_t i = 6; i < fields.size(); i += 2)
        usual.units.push_back({fields[i], number(i + 1)});
    return usual;
}

const std::vector<Usual>& all_usual() {
    static const std::vector<Usual> kUsual = [] {
        std::vector<Usual> all;
        for_each_line(usual_numbers().front().csv, [&](std::size_t, std::string_view line) {
            if (!line.starts_with('#') && !line.starts_with("key,"))
                all.push_back(usual_in(comma_fields(line)));
        });
        return all;
    }();
    return kUsual;
}

// A number of the rig's file, and its position.
struct KeyPlace {
    std::string key;      // strobe[1].position_m
    std::string pattern;  // strobe[].position_m
    int line = 0;
};

std::string usual_range(const Usual& usual) {
    if (usual.least == 0.0) return fmt::format("up to {:g}", usual.most);
    return fmt::format("{:g} to {:g}", usual.least, usual.most);
}

std::string in_likely_unit(double value, const Usual& usual) {
    double nearest = std::numeric_limits<double>::infinity();
    std::string words;
    for (const Unit& unit : usual.units) {
        const double other = std::abs(value) * unit.factor;
        if (other < usual.least || other > usual.most) continue;
        const double away = std::abs(std::log(other / usual.typical));
        if (!(away < nearest)) continue;
        nearest = away;
        words = fmt::format("; {:.4g} if that is in {}", value * unit.factor, unit.name);
    }
    return words;
}

std::optional<std::string> doubt_of(double value, const Usual& usual) {
    const double size = std::abs(value);
    if (size == 0.0 ? usual.is_zero_usual : size >= usual.least && size <= usual.most)
        return std::nullopt;
    if (usual.key == "strobe[].power") return fmt::format("found {:g}: {}", value, usual.why);
    return fmt::format("found {:g}; usual: {} ({}){}",
                       value,
                       usual_range(usual),
                       usual.why,
                       in_likely_unit(value, usual));
}

const Usual* usual_of(std::string_view pattern) {
    const auto found = std::ranges::find(all_usual(), pattern, &Usual::key);
    return found == all_usual().end() ? nullptr : &*found;
}

// Quarter turns and their halves, in radians.
std::optional<std::string> doubt_of_turn(double degrees) {
    constexpr double kRounding = 2e-3;  // of 1.57 and 1.5708
    const double eighths = std::abs(degrees) / (0.5 * kHalfPi);
    if (eighths < 0.5 || eighths > 8.5 ||
        std::abs(eighths - std::round(eighths)) * 0.5 * kHalfPi > kRounding) {
        return std::nullopt;
    }
    return fmt::format("found {:g}, a fraction of pi; {:.4g} if that is in radians",
                       degrees,
                       degrees * kDegreesPerRadian);
}

class Doubter {
  public:
    explicit Doubter(const Rig& rig) : rig_(rig) {}

    std::vector<Doubt> doubts();

  private:
    void add(const KeyPlace& place, std::string what);
    void judge(const toml::node& node, const KeyPlace& place);
    void judge_number(double value, const KeyPlace& place);
    void judge_sled(const toml::table& root);
    void judge_view(const toml::table& root);
    void judge_levels(const toml::table& root);
    void judge_tilts();
    void judge_cones(const toml::table& root);
    void judge_beam_tables();
    void judge_absorption(const toml::table& root);
    void judge_light();

    const Rig& rig_;
    std::vector<Doubt> doubts_;
    std::vector<std::set<std::string>> more_;  // for each doubt: the keys that it covers
    std::vector<std::string> patterns_;        // for each doubt
    std::vector<std::pair<KeyPlace, double>> tilts_;
};

int source_line(const toml::node* node) {
    return node == nullptr ? 0 : static_cast<int>(node->source().begin.line);
}

void Doubter::add(const KeyPlace& place, std::string what) {
    // Strobes with the same mistake share one line.
    const auto same = std::ranges::find(patterns_, place.pattern);
    if (same != patterns_.end()) {
        more_[static_cast<std::size_t>(same - patterns_.begin())].insert(place.key);
        return;
    }
    patterns_.push_back(place.pattern);
    more_.push_back({place.key});
    doubts_.push_back({.key = place.key, .line = place.line, .what = std::move(what)});
}

void Doubter::judge_number(double value, const KeyPlace& place) {
    if (place.pattern == "strobe[].aim.tilt_deg") tilts_.emplace_back(place, value);
    if (place.pattern == "camera.orientation_deg" || place.pattern == "beam.*.turn_deg") {
        if (auto what = doubt_of_turn(value)) add(place, std::move(*what));
    }
    const Usual* usual = usual_of(place.pattern);
    if (usual == nullptr || place.pattern == "water.multiple") return;
    if (auto what = doubt_of(value, *usual)) add(place, std::move(*what));
}

void Doubter::judge(const toml::node& node, const KeyPlace& place) {
    if (const auto* table = node.as_table()) {
        const bool is_named = place.pattern == "beam";
        for (const auto& [key, child] : *table) {
            const std::string dot = place.key.empty() ? "" : ".";
            judge(child,
                  {.key = place.key + dot + printable(key.str()),
                   .pattern = place.pattern + dot + (is_named ? "*" : std::string(key.str())),
                   .line = source_line(&child)});
        }
    } else if (const auto* array = node.as_array()) {
        const bool is_of_tables = array->is_array_of_tables();
        for (std::size_t i = 0; i < array->size(); ++i) {
            KeyPlace at = place;
            if (is_of_tables) {
                at.key += fmt::format("[{}]", i);
                at.pattern += "[]";
            }
            judge((*array)[i], at);
        }
    } else if (const auto value = node.value<double>(); value && node.is_number()) {
        if (place.pattern.starts_with("sled.") && place.pattern != "sled.altitude_offset_m") return;
        judge_number(*value, place);
    }
}

void Doubter::judge_sled(const toml::table& root) {
    const auto judge_as = [&](std::string_view key, double value) {
        const int line = source_line(root.at_path(key).node());
        if (auto what = doubt_of(value, *usual_of(key))) {
            add({.key = std::string(key), .pattern = std::string(key), .line = line},
                std::move(*what));
        }
    };
    judge_as("sled.altitude_m", rig_.sled.altitude_m);
    judge_as("sled.pitch_deg", rig_.sled.pitch_rad * kDegreesPerRadian);
    judge_as("sled.roll_deg", rig_.sled.roll_rad * kDegreesPerRadian);
    judge_as("water.multiple", rig_.water.multiple);
}

// From corner to corner.
double view_rad(const Camera& camera, double focal_length_m, double pixel_pitch_m) {
    const double half_m = 0.5 * pixel_pitch_m * std::hypot(camera.width_px, camera.height_px);
    return 2.0 * std::atan(half_m / focal_length_m);
}

// Only the ratio of focal length and pitch matters, so only the field of view reveals it.
void Doubter::judge_view(const toml::table& root) {
    if (root.at_path("camera.fov_deg")) return;
    const Camera& camera = rig_.camera;
    if (camera.lens) {
        const int line = source_line(root.at_path("camera.calibration").node());
        for (const std::string& what :
             calibration_doubts(*camera.lens, camera.width_px, camera.height_px)) {
            add({.key = "camera.calibration", .pattern = "calibration: " + what, .line = line},
                what);
        }
        return;
    }
    constexpr double kLeast_rad = 3.0 * kRadiansPerDegree;
    constexpr double kMost_rad = 140.0 * kRadiansPerDegree;  // the widest lenses without distortion
    constexpr double kTypical_rad = 50.0 * kRadiansPerDegree;
    const double f_m = camera.focal_length_m;
    const double pitch_m = camera.pixel_pitch_m;
    const double view = view_rad(camera, f_m, pitch_m);
    if (view >= kLeast_rad && view <= kMost_rad) return;
    struct Slip {
        std::string_view key;
        std::string_view unit;
        double of_focal;
        double of_pitch;
    };
    constexpr std::array kSlips{Slip{"focal_length_mm", "metres", 1e3, 1.0},
                                Slip{"focal_length_mm", "centimetres", 10.0, 1.0},
                                Slip{"focal_length_mm", "inches", kMillimetresPerInch, 1.0},
                                Slip{"focal_length_mm", "micrometres", 1e-3, 1.0},
                                Slip{"pixel_pitch_um", "millimetres", 1.0, 1e3},
                                Slip{"pixel_pitch_um", "nanometres", 1.0, 1e-3}};
    constexpr double kLeastFocal_m = 1e-3;
    constexpr double kMostFocal_m = 0.5;
    constexpr double kLeastSensor_m = 1e-3;
    constexpr double kMostSensor_m = 0.1;
    double nearest = std::numeric_limits<double>::infinity();
    std::string fix;
    std::string key = "focal_length_mm";
    for (const Slip& slip : kSlips) {
        const double focal_m = f_m * slip.of_focal;
        const double sensor_m = camera.width_px * pitch_m * slip.of_pitch;
        const double other = view_rad(camera, focal_m, pitch_m * slip.of_pitch);
        if (other < kLeast_rad || other > kMost_rad || focal_m < kLeastFocal_m ||
            focal_m > kMostFocal_m || sensor_m < kLeastSensor_m || sensor_m > kMostSensor_m) {
            continue;
        }
        const double away = std::abs(std::log(other / kTypical_rad));
        if (!(away < nearest)) continue;
        nearest = away;
        key = slip.key;
        fix = fmt::format(
            "; {:.3g} degrees if {} is in {}", other * kDegreesPerRadian, slip.key, slip.unit);
    }
    const std::string path = "camera." + key;
    add({.key = path, .pattern = path, .line = source_line(root.at_path(path).node())},
        fmt::format("found a focal length of {:.4g} mm and a pitch of {:.4g} um, a field of view "
                    "of {:.4g} degrees from corner to corner; usual: {:g} to {:g}{}",
                    1e3 * f_m,
                    1e6 * pitch_m,
                    view * kDegreesPerRadian,
                    kLeast_rad * kDegreesPerRadian,
                    kMost_rad * kDegreesPerRadian,
                    fix));
}

void Doubter::judge_levels(const toml::table& root) {
    constexpr double kMostShare = 0.5;
    const Readout& readout = rig_.camera.readout;
    if (!readout.black_level_dn || !readout.white_level_dn) return;
    if (*readout.black_level_dn <= kMostShare * *readout.white_level_dn) return;
    const std::string path = "camera.black_level_dn";
    add({.key = path, .pattern = path, .line = source_line(root.at_path(path).node())},
        fmt::format("found {:g}; usual: up to half of white_level_dn, {:g} (the signal needs the "
                    "range between them)",
                    *readout.black_level_dn,
                    *readout.white_level_dn));
}

// Strobes are not all aimed within a degree or so; in radians the same numbers reach a right angle.
void Doubter::judge_tilts() {
    constexpr double kLeast = 5.0 * kRadiansPerDegree;
    const auto may_be_radians = [](const auto& tilt) {
        return tilt.second == 0.0 || (tilt.second >= kLeast && tilt.second <= kHalfPi);
    };
    const auto is_tilted = [](const auto& tilt) { return tilt.second > 0.0; };
    if (!std::ranges::all_of(tilts_, may_be_radians)) return;
    for (const auto& [place, tilt] : tilts_) {
        if (!is_tilted(std::pair(place, tilt))) continue;
        add(place,
            fmt::format(
                "found {:g}; usual: 0, or a few degrees to 90; {:.4g} if that is in radians",
                tilt,
                tilt * kDegreesPerRadian));
    }
}

void Doubter::judge_cones(const toml::table& root) {
    constexpr double kLeastSum = 50.0;  // per cent, with some part possibly missing
    constexpr double kMostSum = 150.0;
    std::set<std::string> done;
    for (const Strobe& strobe : rig_.strobes) {
        const Beam& beam = strobe.beam;
        const toml::node* node = root.at_path("beam")[beam.name]["cones"].node();
        if (beam.cones.empty() || node == nullptr || !done.insert(beam.name).second) continue;
        const std::string key = fmt::format("beam.{}.cones", printable(beam.name));
        const double widest_deg =
            std::ranges::max(beam.cones, {}, &Cone::half_angle_rad).half_angle_rad *
            kDegreesPerRadian;
        if (widest_deg <= kHalfPi * 1.001) {
            add({.key = key, .pattern = "beam.*.cones[].half_angle_deg", .line = source_line(node)},
                fmt::format("found half angles of {:.4g} degrees at most; usual: 3 or more "
                            "(lamps have wider beams); {:.4g} if that is in radians",
                            widest_deg,
                            widest_deg * kDegreesPerRadian));
        }
        double sum = 0.0;
        for (const Cone& cone : beam.cones) sum += cone.weight;
        if (beam.weights == ConeWeights::Flux && sum >= kLeastSum && sum <= kMostSum) {
            add({.key = key, .pattern = "beam.*.cones[].weight", .line = source_line(node)},
                fmt::format("found weights that add up to {:.4g}; usual: about 1 (they are "
                            "shares of the flux); {:.4g} if they are in per cent",
                            sum,
                            0.01 * sum));
        }
    }
}

// Angles in files are in degrees: a table that ends at pi or pi/2 is in radians.
void Doubter::judge_beam_tables() {
    std::set<std::string> done;
    for (const Strobe& strobe : rig_.strobes) {
        const auto* table = std::get_if<BeamTable>(&strobe.beam.pattern);
        if (table == nullptr || !done.insert(strobe.beam.name).second) continue;
        const double end_deg =
            std::max(std::abs(table->vertical_rad.front()), std::abs(table->vertical_rad.back())) *
            kDegreesPerRadian;
        if (end_deg > std::numbers::pi * 1.001) continue;
        add({.key = fmt::format("beam.{}.table", printable(strobe.beam.name)),
             .pattern = "beam.*.table"},
            fmt::format("found a table that ends {:.4g} degrees off its axis; usual: 5 or more "
                        "(lamps have wider beams); {:.4g} if that is in radians",
                        end_deg,
                        end_deg * kDegreesPerRadian));
    }
}

// In the red, water itself absorbs most and its constituents add little, and no water is clearer
// than pure water. All knots must be out of range, as with a wrong unit; a single one may have any
// value.
void Doubter::judge_absorption(const toml::table& root) {
    struct Pure {
        double lambda_nm;
        double per_m;  // Pope and Fry 1997
    };
    constexpr std::array kPure{Pure{600.0, 0.2224}, Pure{650.0, 0.340}, Pure{700.0, 0.624}};
    constexpr double kLeast = 0.1;
    constexpr double kMost = 50.0;
    constexpr double kTypical = 1.2;
    constexpr std::array kUnits{Unit{"1/cm", 100.0}, Unit{"1/mm", 1000.0}, Unit{"1/km", 1e-3}};
    const toml::node* node = root.at_path("water.absorption").node();
    if (node == nullptr || rig_.water.multiple == 0.0) return;
    const Spectrum& a = rig_.water.absorption_per_m;
    const auto ratio_at = [&](const Pure& pure) { return a.at(pure.lambda_nm) / pure.per_m; };
    std::vector<Pure> asked;
    std::ranges::copy_if(kPure, std::back_inserter(asked), [&](const Pure& pure) {
        return a.range().contains(pure.lambda_nm);
    });
    const auto is_all = [&](auto is_out) { return std::ranges::all_of(asked, is_out, ratio_at); };
    if (asked.empty() || !(is_all([](double r) { return r > 0.0 && r < kLeast; }) ||
                           is_all([](double r) { return r > kMost; }))) {
        return;
    }
    const auto& [lambda_nm, pure_per_m] = asked.front();
    const double per_m = a.at(lambda_nm);
    double nearest = std::numeric_limits<double>::infinity();
    std::string fix;
    for (const Unit& unit : kUnits) {
        const double ratio = ratio_at(asked.front()) * unit.factor;
        const double away = std::abs(std::log(ratio / kTypical));
        if (ratio < kLeast || ratio > kMost || !(away < nearest)) continue;
        nearest = away;
        fix = fmt::format("; {:.4g}/m if the table is in {}", per_m * unit.factor, unit.name);
    }
    add({.key = "water.absorption", .pattern = "water.absorption", .line = source_line(node)},
        fmt::format("found {:.4g}/m at {:g} nm; usual: {:.3g}, which pure water has, to {:.3g}{}",
                    per_m,
                    lambda_nm,
                    pure_per_m,
                    kMost * pure_per_m,
                    fix));
}

// A strobe's effect on the floor in view.
struct StrobeView {
    bool has_light = false;
    double nearest_rad = std::numbers::pi;  // from its axis to the view
};

constexpr std::size_t kSideOfView = 33;

// Angles between neighbouring grid points, seen from the strobe.
double spacing_rad(const std::vector<std::optional<FloorSample>>& samples,
                   std::size_t i,
                   const Vector3d& from_m) {
    const std::size_t column = i % kSideOfView;
    const std::size_t row = i / kSideOfView;
    double widest = 0.0;
    const auto ask = [&](bool is_there, std::size_t other) {
        if (!is_there) return;
        if (!samples[other]) {
            widest = kHalfPi;  // to the horizon
            return;
        }
        widest = std::max(
            widest, angle_between(samples[i]->point_m - from_m, samples[other]->point_m - from_m));
    };
    ask(column > 0, i - 1);
    ask(column + 1 < kSideOfView, i + 1);
    ask(row > 0, i - kSideOfView);
    ask(row + 1 < kSideOfView, i + kSideOfView);
    return widest;
}

StrobeView view_of_strobe(const Strobe& strobe,
                          const std::vector<std::optional<FloorSample>>& samples) {
    StrobeView view;
    const BeamFrame frame = frame_about(strobe.axis);
    const double least = kNoLight * most_intensity(strobe.beam);
    const double reach_m = emitter_reach_m(strobe);
    for (const auto& sample : samples) {
        if (!sample) continue;
        const Vector3d towards = sample->point_m - strobe.position_m;
        view.nearest_rad = std::min(view.nearest_rad, angle_between(strobe.axis, towards));
        if (intensity_towards(strobe.beam, frame, towards) > least) view.has_light = true;
    }
    // A narrow beam may fall between the points.
    for (std::size_t i = 0; i < samples.size() && !view.has_light; ++i) {
        if (!samples[i]) continue;
        const Vector3d towards = samples[i]->point_m - strobe.position_m;
        const double within = spacing_rad(samples, i, strobe.position_m) +
                              std::atan2(reach_m, std::max(reach_m, towards.norm() - reach_m));
        view.has_light = most_intensity(strobe.beam, frame, towards, within) > least;
    }
    return view;
}

void Doubter::judge_light() {
    if (!rig_.scene.empty()) return;
    const std::vector<std::optional<FloorSample>> samples = floor_samples(rig_, kSideOfView);
    const bool sees_floor =
        std::ranges::any_of(samples, [](const auto& sample) { return sample.has_value(); });
    if (!sees_floor && rig_.objects.empty()) {
        add({.key = "sled", .pattern = "sled"},
            fmt::format("the camera sees no sea floor, at a pitch of {:.4g} and a roll of {:.4g} "
                        "degrees",
                        rig_.sled.pitch_rad * kDegreesPerRadian,
                        rig_.sled.roll_rad * kDegreesPerRadian));
        return;
    }
    const Vector3d down = -floor_plane(rig_.sled).normal;
    std::size_t dark = 0;
    for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
        const Strobe& strobe = rig_.strobes[s];
        if (strobe.power == 0.0 || is_dark(strobe.beam)) {
            ++dark;
            continue;
        }
        const double above_deg =
            std::asin(std::clamp(-strobe.axis.dot(down), -1.0, 1.0)) * kDegreesPerRadian;
        const StrobeView view = view_of_strobe(strobe, samples);
        // Objects are not considered: they may be in any light.
        if (!rig_.objects.empty() || (view.has_light && above_deg <= 0.0)) continue;
        if (!view.has_light) ++dark;
        const std::string seen = view.has_light ? "" : ", and lights nothing that the camera sees";
        const std::string what =
            above_deg > 0.0
                ? fmt::format("'{}' is aimed {:.3g} degrees above the horizon{}; z points down",
                              printable(strobe.name),
                              above_deg,
                              seen)
                : fmt::format(
                      "'{}' lights nothing that the camera sees: the view begins {:.3g} "
                      "degrees off its axis",
                      printable(strobe.name),
                      view.nearest_rad * kDegreesPerRadian);
        add({.key = fmt::format("strobe[{}]", s), .pattern = "strobe[]"}, what);
    }
    if (dark == 0 || dark < rig_.strobes.size()) return;
    add({.key = "strobe", .pattern = "strobe"},
        "no strobe lights anything that the camera sees: its images are black");
}

std::vector<Doubt> Doubter::doubts() {
    const toml::table root = toml::parse(rig_.toml);
    judge(root, {});
    judge_sled(root);
    judge_view(root);
    judge_levels(root);
    judge_tilts();
    judge_cones(root);
    judge_beam_tables();
    judge_absorption(root);
    judge_light();
    for (std::size_t i = 0; i < doubts_.size(); ++i) {
        if (more_[i].size() > 1)
            doubts_[i].what += fmt::format(" (and {} more like it)", more_[i].size() - 1);
    }
    std::ranges::stable_sort(doubts_, {}, [&](const Doubt& doubt) {
        return doubt.line == 0 ? std::numeric_limits<int>::max() : doubt.line;
    });
    return std::move(doubts_);
}

}  // namespace

std::vector<Doubt> doubts_of(const Rig& rig) {
    return Doubter(rig).doubts();
}

std::string in_words(const Doubt& doubt, std::string_view rig_file) {
    const std::string line = doubt.line > 0 ? fmt::format(":{}", doubt.line) : "";
    return fmt::format("{}{}: {}: {}", rig_file, line, doubt.key, doubt.what);
}

bool is_judged_alone(std::string_view key) {
    return usual_of(key) != nullptr;
}

}  // namespace aphotic
