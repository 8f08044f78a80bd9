// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/round_profile.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <variant>

namespace aphotic {
namespace {

using Eigen::Vector3d;
using Coefficients = std::array<double, kProfileOrder>;
using Fit = Eigen::Matrix<double, kProfileOrder, 1>;

constexpr int kMostHalvings = 24;
constexpr double kGrazing_rad = 0.5 * std::numbers::pi;
constexpr double kMostChord = 2.0;  // behind the lamp

double chord_of(double theta_rad) {
    return 2.0 * std::sin(0.5 * theta_rad);
}

// Chebyshev points of the first kind on 0 to 1, which exclude the ends.
double chebyshev_point(std::size_t i) {
    const double share = (static_cast<double>(i) + 0.5) / kProfileOrder;
    return 0.5 - 0.5 * std::cos(std::numbers::pi * share);
}

// From values at the nodes to coefficients.
const Eigen::Matrix<double, kProfileOrder, kProfileOrder>& to_coefficients() {
    static const Eigen::Matrix<double, kProfileOrder, kProfileOrder> kMatrix = [] {
        Eigen::Matrix<double, kProfileOrder, kProfileOrder> powers;
        for (std::size_t i = 0; i < kProfileOrder; ++i)
            for (std::size_t k = 0; k < kProfileOrder; ++k)
                powers(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
                    std::pow(chebyshev_point(i), static_cast<double>(k));
        return Eigen::Matrix<double, kProfileOrder, kProfileOrder>(powers.inverse());
    }();
    return kMatrix;
}

double polynomial(const Coefficients& c, double x) {
    double value = 0.0;
    for (std::size_t k = kProfileOrder; k-- > 0;) value = c[k] + x * value;
    return value;
}

// Angles off the axis where the beam bends or ends, in air behind a window, increasing from 0.
std::vector<double> breaks_of(const Beam& beam) {
    std::vector<double> breaks_rad{0.0};
    if (const auto* table = std::get_if<BeamTable>(&beam.pattern)) {
        breaks_rad = table->vertical_rad;
        if (breaks_rad.front() > 0.0) breaks_rad.insert(breaks_rad.begin(), 0.0);
    } else {
        for (const Cone& cone : beam.cones) {
            breaks_rad.push_back(cone.half_angle_rad);
            if (cone.edge_rad > 0.0) breaks_rad.push_back(cone.half_angle_rad - cone.edge_rad);
        }
    }
    if (beam.window) {
        std::erase_if(breaks_rad, [](double theta_rad) { return theta_rad > kGrazing_rad; });
        breaks_rad.push_back(kGrazing_rad);
    }
    std::ranges::sort(breaks_rad);
    breaks_rad.erase(std::unique(breaks_rad.begin(), breaks_rad.end()), breaks_rad.end());
    return breaks_rad;
}

// I over the angle in air, with the window's factor.
std::function<double(double)> intensity_of(const Beam& beam) {
    Beam in_air = beam;
    in_air.window.reset();
    const BeamFrame frame{Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitY()};
    return [=](double theta_rad) {
        const Vector3d towards(std::sin(theta_rad), 0.0, std::cos(theta_rad));
        const double intensity = intensity_towards(in_air, frame, towards);
        if (!beam.window) return intensity;
        return intensity * window_factor(*beam.window, std::max(0.0, towards.z()));
    };
}

}  // namespace

bool is_round(const Beam& beam) {
    const auto* table = std::get_if<BeamTable>(&beam.pattern);
    return std::holds_alternative<std::monostate>(beam.pattern) ||
           (table != nullptr && table->angles == TableAngles::TypeC &&
            table->horizontal_rad.size() == 1);
}

RoundProfile::RoundProfile(const Beam& beam)
    : window_index_(beam.window ? beam.window->water_index : 1.0),
      has_window_(beam.window.has_value()) {
    const auto intensity = intensity_of(beam);
    std::vector<double> steps = edges_rad(beam);
    if (beam.window)
        for (double& step_rad : steps) step_rad = angle_in_air_rad(*beam.window, step_rad);
    const auto value_at = [&](double q) {
        return intensity(2.0 * std::asin(std::min(1.0, 0.5 * q)));
    };
    std::vector<double> starts{0.0};  // of pieces
    const std::function<void(double, double, std::size_t, int)> add =
        [&](double first, double last, std::size_t region, int halvings) {
            Fit values;
            for (std::size_t i = 0; i < kProfileOrder; ++i)
                values(static_cast<Eigen::Index>(i)) =
                    value_at(std::lerp(first, last, chebyshev_point(i)));
            const Fit fit = to_coefficients() * values;
            Piece piece{.first = first, .per_width = 1.0 / (last - first), .region = region};
            std::ranges::copy(fit, piece.c.begin());
            const double largest = values.maxCoeff();
            bool is_right = true;
            for (std::size_t i = 0; i + 1 < kProfileOrder; ++i) {
                const double x = 0.5 * (chebyshev_point(i) + chebyshev_point(i + 1));
                const double off = polynomial(piece.c, x) - value_at(std::lerp(first, last, x));
                is_right &= std::abs(off) <= kProfileError * largest;
            }
            if (is_right || halvings == kMostHalvings) {
                pieces_.push_back(piece);
                starts.push_back(last);
                return;
            }
            const double middle = 0.5 * (first + last);
            add(first, middle, region, halvings + 1);
            add(middle, last, region, halvings + 1);
        };
    const std::vector<double> breaks_rad = breaks_of(beam);
    for (std::size_t k = 0; k + 1 < breaks_rad.size(); ++k) {
        const double middle_rad = 0.5 * (breaks_rad[k] + breaks_rad[k + 1]);
        const auto region =
            std::ranges::count_if(steps, [&](double step_rad) { return step_rad < middle_rad; });
        add(chord_of(breaks_rad[k]),
            chord_of(breaks_rad[k + 1]),
            static_cast<std::size_t>(region),
            0);
    }
    // There is no light beyond.
    const double end = starts.back();
    const bool ends_in_step = std::ranges::any_of(
        steps, [&](double step_rad) { return std::abs(chord_of(step_rad) - end) < 1e-9; });
    pieces_.push_back({.first = end, .region = pieces_.back().region + (ends_in_step ? 1 : 0)});
    starts.push_back(end + 1.0);
    piece_at_ = CellSearch(std::move(starts));
}

Lanes RoundProfile::chord(const Lanes& cosine) const {
    Lanes chord;
    for_each_pack([&](std::size_t k) {
        const Pack x = cosine.pack(k);
        Pack q = root(2.0 - 2.0 * x);
        if (has_window_) {
            const Pack cos2 = 1.0 - window_index_ * window_index_ * (1.0 - x * x);
            q = root(2.0 - 2.0 * root(cos2));
            where(x <= 0.0 || cos2 <= 0.0, q) = kMostChord;
        }
        chord.set_pack(k, q);
    });
    return chord;
}

double RoundProfile::value(const Piece& piece, double q) {
    return std::max(0.0, polynomial(piece.c, (q - piece.first) * piece.per_width));
}

Lanes RoundProfile::at(const Lanes& cosine) const {
    Lanes I = chord(cosine);
    for (double& q : I.lane) q = value(pieces_[piece_at_(q)], q);
    return I;
}

Lanes RoundProfile::continued(const Lanes& cosine, const Lanes& cosine_from) const {
    Lanes I = chord(cosine);
    const Lanes q_from = chord(cosine_from);
    for (std::size_t k = 0; k < kLanes; ++k) {
        if (has_window_ && q_from[k] == kMostChord) {
            I[k] = 0.0;
            continue;
        }
        // Beyond a window's last direction, its last piece applies.
        const double q = has_window_ ? std::min(I[k], std::numbers::sqrt2) : I[k];
        const std::size_t region = pieces_[piece_at_(q_from[k])].region;
        std::size_t own = piece_at_(q);
        while (pieces_[own].region > region) --own;
        while (pieces_[own].region < region) ++own;
        I[k] = value(pieces_[own], q);
    }
    return I;
}

}  // namespace aphotic
