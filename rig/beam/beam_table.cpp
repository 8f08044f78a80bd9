// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/beam_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace aphotic {

using Eigen::Vector3d;

namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kQuarterTurn_rad = 0.25 * kTurn_rad;

// The rounding error of an angle, and with margin, of an interpolated value.
constexpr double kAngleRounding_rad = 1e-12;
constexpr double kValueRounding = 1.0 + 8.0 * std::numeric_limits<double>::epsilon();

struct AngleRange {
    double lo = 0.0;
    double hi = 0.0;

    [[nodiscard]] bool contains(double x) const { return lo <= x && x <= hi; }
};

AngleRange range_of(const std::vector<double>& nodes) {
    return {nodes.front(), nodes.back()};
}

bool is_round(const BeamTable& table) {
    return table.horizontal_rad.size() == 1;
}

// A goniometer's angles are those of a globe. One is the latitude, from -pi/2 at one pole to pi/2
// at the other; the other one is the longitude.
bool vertical_is_latitude(TableAngles type) {
    return type != TableAngles::TypeB;
}

double latitude_of(TableAngles type, const GoniometerAngles& at) {
    switch (type) {
        case TableAngles::TypeA:
            return at.vertical_rad;
        case TableAngles::TypeB:
            return at.horizontal_rad;
        case TableAngles::TypeC:
            break;
    }
    return at.vertical_rad - kQuarterTurn_rad;
}

// Between nodes: (1 - share) of the one at index and share of the next.
struct GridPlace {
    std::size_t index = 0;
    double share = 0.0;
};

// x is within the nodes' range.
GridPlace place_of(double x, const std::vector<double>& nodes) {
    if (nodes.size() == 1) return {};
    const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, x);
    const double upper = *above;
    const double lower = *(above - 1);
    return {.index = static_cast<std::size_t>(above - nodes.begin()) - 1,
            .share = (x - lower) / (upper - lower)};
}

double between(double a, double b, double share) {
    return (1.0 - share) * a + share * b;
}

// A plane of the table, or interpolated between two.
class TablePlane {
  public:
    TablePlane(const BeamTable& table, const GridPlace& horizontal)
        : near_(&table.intensity[horizontal.index * table.vertical_rad.size()]),
          far_(horizontal.share == 0.0 ? near_ : near_ + table.vertical_rad.size()),
          share_(horizontal.share) {}

    [[nodiscard]] double at_node(std::size_t i) const {
        return near_ == far_ ? near_[i] : between(near_[i], far_[i], share_);
    }
    [[nodiscard]] double at(const GridPlace& vertical) const {
        const double a = at_node(vertical.index);
        if (vertical.share == 0.0) return a;
        return between(a, at_node(vertical.index + 1), vertical.share);
    }
    [[nodiscard]] double most_between(const GridPlace& lo, const GridPlace& hi) const {
        double most = std::max(at(lo), at(hi));
        for (std::size_t i = lo.index + 1; i <= hi.index; ++i) most = std::max(most, at_node(i));
        return most;
    }

  private:
    const double* near_;
    const double* far_;
    double share_;
};

// The smallest rectangle of angles that contains all directions within an angle of a given one. On
// a globe, a cap of radius r about latitude b that contains no pole spans asin(sin r / cos b) of
// longitude to either side.
struct AngleBox {
    AngleRange vertical;
    AngleRange horizontal;
};

AngleBox box_about(TableAngles type, const Vector3d& direction, double within_rad) {
    constexpr AngleRange kAll{-2.0 * kTurn_rad, 2.0 * kTurn_rad};
    const GoniometerAngles at = angles_of(type, direction);
    const double r = within_rad + kAngleRounding_rad;
    const double latitude = latitude_of(type, at);
    const bool has_pole = std::abs(latitude) + r >= kQuarterTurn_rad;
    const auto about = [](double x, double by) { return AngleRange{x - by, x + by}; };
    const auto longitudes = [&](double x) {
        if (has_pole) return kAll;
        const double sine = std::min(1.0, std::sin(r) / std::cos(latitude));
        return about(x, std::asin(sine) + kAngleRounding_rad);
    };
    if (vertical_is_latitude(type))
        return {about(at.vertical_rad, r), longitudes(at.horizontal_rad)};
    return {longitudes(at.vertical_rad), about(at.horizontal_rad, r)};
}

// The maximum of a bilinear function over a rectangle is at a corner, within each cell.
double most_within(const BeamTable& table, const AngleBox& box) {
    const auto common = [](const AngleRange& a, const AngleRange& b) {
        return AngleRange{std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
    };
    const AngleRange vertical = common(box.vertical, range_of(table.vertical_rad));
    const AngleRange horizontal =
        is_round(table) ? AngleRange{} : common(box.horizontal, range_of(table.horizontal_rad));
    if (vertical.lo > vertical.hi || horizontal.lo > horizontal.hi) return 0.0;
    const GridPlace low = place_of(vertical.lo, table.vertical_rad);
    const GridPlace high = place_of(vertical.hi, table.vertical_rad);
    const auto most_at = [&](const GridPlace& plane) {
        return TablePlane(table, plane).most_between(low, high);
    };
    const GridPlace first = place_of(horizontal.lo, table.horizontal_rad);
    const GridPlace last = place_of(horizontal.hi, table.horizontal_rad);
    double most = std::max(most_at(first), most_at(last));
    for (std::size_t i = first.index + 1; i <= last.index; ++i)
        most = std::max(most, most_at({.index = i}));
    return most;
}

// The integral over each node's hat, the function that is 1 at the node, 0 at the others and linear
// between them, from the weights of one of its sides: `side(node, other)`.
template <typename Side>
std::vector<double> hat_integrals(const std::vector<double>& nodes, Side side) {
    std::vector<double> integrals(nodes.size(), 0.0);
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        integrals[i] += side(nodes[i], nodes[i + 1]);
        integrals[i + 1] += side(nodes[i + 1], nodes[i]);
    }
    return integrals;
}

// Half of a hat at x, on the side of the node at `other`: integral of hat cos. With h the distance
// between the two and m the middle, |sin m sin(h/2) / (h/2) - sin x|.
double half_hat_of_cosine(double x, double other) {
    const double half = 0.5 * (other - x);
    return std::abs(std::sin(x + half) * std::sin(half) / half - std::sin(x));
}

std::vector<double> latitude_weights(std::vector<double> latitudes) {
    return hat_integrals(latitudes, half_hat_of_cosine);
}

std::vector<double> longitude_weights(const std::vector<double>& longitudes) {
    if (longitudes.size() == 1) return {kTurn_rad};
    return hat_integrals(longitudes,
                         [](double x, double other) { return 0.5 * std::abs(other - x); });
}

// Whether a line of the table, along which one angle is constant, has any light.
bool line_shines(const BeamTable& table, TableAngle fixed, std::size_t index) {
    const std::size_t rows = table.vertical_rad.size();
    const std::size_t columns = table.horizontal_rad.size();
    if (fixed == TableAngle::Horizontal) {
        return std::any_of(&table.intensity[index * rows],
                           &table.intensity[index * rows] + rows,
                           [](double I) { return I > 0.0; });
    }
    for (std::size_t h = 0; h < columns; ++h) {
        if (table.intensity[h * rows + index] > 0.0) return true;
    }
    return false;
}

}  // namespace

Vector3d direction_at(TableAngles type, const GoniometerAngles& at) {
    const double sin_v = std::sin(at.vertical_rad);
    const double cos_v = std::cos(at.vertical_rad);
    const double sin_h = std::sin(at.horizontal_rad);
    const double cos_h = std::cos(at.horizontal_rad);
    switch (type) {
        case TableAngles::TypeA:
            return {sin_v, cos_v * sin_h, cos_v * cos_h};
        case TableAngles::TypeB:
            return {sin_v * cos_h, sin_h, cos_v * cos_h};
        case TableAngles::TypeC:
            break;
    }
    return {sin_v * cos_h, -sin_v * sin_h, cos_v};
}

GoniometerAngles angles_of(TableAngles type, const Vector3d& direction) {
    const double x = direction.x();
    const double y = direction.y();
    const double z = direction.z();
    switch (type) {
        case TableAngles::TypeA:
            return {std::atan2(x, std::hypot(y, z)), std::atan2(y, z)};
        case TableAngles::TypeB:
            return {std::atan2(x, z), std::atan2(y, std::hypot(x, z))};
        case TableAngles::TypeC:
            break;
    }
    const double turn_rad = std::atan2(-y, x);
    return {std::atan2(std::hypot(x, y), z), turn_rad < 0.0 ? turn_rad + kTurn_rad : turn_rad};
}

double table_intensity(const BeamTable& table, const Vector3d& direction) {
    const GoniometerAngles at = angles_of(table.angles, direction);
    if (!range_of(table.vertical_rad).contains(at.vertical_rad)) return 0.0;
    if (!is_round(table) && !range_of(table.horizontal_rad).contains(at.horizontal_rad)) return 0.0;
    const TablePlane plane(table, place_of(at.horizontal_rad, table.horizontal_rad));
    return plane.at(place_of(at.vertical_rad, table.vertical_rad));
}

double most_table_intensity(const BeamTable& table, const Vector3d& direction, double within_rad) {
    const AngleBox box = box_about(table.angles, direction, within_rad);
    double most = most_within(table, box);
    if (table.angles == TableAngles::TypeC && !is_round(table)) {
        // The part beyond the seam, where the turn starts again.
        for (const double turn : {-kTurn_rad, kTurn_rad}) {
            const AngleRange turned{box.horizontal.lo + turn, box.horizontal.hi + turn};
            most = std::max(most, most_within(table, {box.vertical, turned}));
        }
    }
    return kValueRounding * most;
}

double largest_intensity(const BeamTable& table) {
    return *std::ranges::max_element(table.intensity);
}

double table_flux(const BeamTable& table) {
    std::vector<double> vertical = table.vertical_rad;
    if (table.angles == TableAngles::TypeC)
        for (double& angle : vertical) angle -= kQuarterTurn_rad;
    const bool is_latitude = vertical_is_latitude(table.angles);
    const std::vector<double> of_vertical =
        is_latitude ? latitude_weights(vertical) : longitude_weights(vertical);
    const std::vector<double> of_horizontal = is_latitude ? longitude_weights(table.horizontal_rad)
                                                          : latitude_weights(table.horizontal_rad);
    double flux = 0.0;
    for (std::size_t h = 0; h < of_horizontal.size(); ++h) {
        double of_plane = 0.0;
        for (std::size_t v = 0; v < of_vertical.size(); ++v)
            of_plane += of_vertical[v] * table.intensity[h * of_vertical.size() + v];
        flux += of_horizontal[h] * of_plane;
    }
    return flux;
}

std::vector<TableEdge> edges_of(const BeamTable& table) {
    std::vector<TableEdge> edges;
    const auto add_ends = [&](TableAngle angle, const std::vector<double>& nodes) {
        for (const std::size_t end : {std::size_t{0}, nodes.size() - 1}) {
            const bool is_latitude =
                (angle == TableAngle::Vertical) == vertical_is_latitude(table.angles);
            const double latitude = latitude_of(
                table.angles, {.vertical_rad = nodes[end], .horizontal_rad = nodes[end]});
            const bool is_pole =
                is_latitude && std::abs(latitude) >= kQuarterTurn_rad - kAngleRounding_rad;
            if (!is_pole && line_shines(table, angle, end))
                edges.push_back({.angle = angle, .at_rad = nodes[end]});
        }
    };
    add_ends(TableAngle::Vertical, table.vertical_rad);
    if (table.angles != TableAngles::TypeC) add_ends(TableAngle::Horizontal, table.horizontal_rad);
    return edges;
}

}  // namespace aphotic
