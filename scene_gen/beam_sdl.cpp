// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/beam_sdl.h"

#include "base/degrees.h"
#include "scene_gen/sdl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace aphotic {

namespace {

// Parenthesised, to follow an operator.
std::string operand_sdl(double value) {
    return value < 0.0 ? fmt::format("({})", sdl_number(value)) : sdl_number(value);
}

std::string function_sdl(const std::string& name,
                         const std::string& parameters,
                         const std::string& value) {
    return fmt::format("#declare {} = function ({}) {{ {} }}\n", name, parameters, value);
}

std::string spline_sdl(const std::string& name, const std::vector<std::string>& nodes) {
    return fmt::format("#declare {} = function {{ spline {{ linear_spline\n{} }} }}\n",
                       name,
                       fmt::join(nodes, ",\n"));
}

std::string node_sdl(double at, double value) {
    return fmt::format("{},<{},0>", sdl_number(at), sdl_number(value));
}

// The planes of one table follow each other in the spline at this distance, so that none extends
// into the next.
double plane_distance(const BeamTable& table) {
    return std::ceil(table.vertical_rad.back() - table.vertical_rad.front()) + 1.0;
}

std::string from_on_sdl(const std::string& angle, double least, const std::string& value) {
    return fmt::format("select({} - {}, 0, {})", angle, operand_sdl(least), value);
}

std::string up_to_sdl(const std::string& angle, double most, const std::string& value) {
    return fmt::format("select({} - {}, 0, {})", sdl_number(most), angle, value);
}

// 0 beyond the table's end, with only those tests that some direction needs, since each costs time.
std::string within_sdl(const BeamTable& table, const std::string& value) {
    const std::vector<double>& v = table.vertical_rad;
    const std::vector<double>& h = table.horizontal_rad;
    const std::string up_to_last = up_to_sdl("v", v.back(), value);
    if (table.angles == TableAngles::TypeC) {
        return v.front() == 0.0 ? up_to_last : from_on_sdl("v", v.front(), up_to_last);
    }
    return from_on_sdl(
        "v", v.front(), from_on_sdl("h", h.front(), up_to_sdl("h", h.back(), up_to_last)));
}

// The table over its angles v and h.
std::string planes_sdl(const BeamTable& table, const std::string& name) {
    const std::size_t rows = table.vertical_rad.size();
    const std::size_t columns = table.horizontal_rad.size();
    const double distance = plane_distance(table);
    std::vector<std::string> nodes;
    std::vector<std::string> planes;
    for (std::size_t k = 0; k < columns; ++k) {
        planes.push_back(node_sdl(table.horizontal_rad[k], static_cast<double>(k)));
        for (std::size_t i = 0; i < rows; ++i) {
            const double at = static_cast<double>(k) * distance + table.vertical_rad[i];
            nodes.push_back(node_sdl(at, table.intensity[k * rows + i]));
        }
    }
    const std::string sdl = spline_sdl(name + "_Nodes", nodes);
    if (columns == 1) {
        return sdl + function_sdl(
                         name + "_At", "v", within_sdl(table, fmt::format("{}_Nodes (v).x", name)));
    }
    // c is the place among the planes, k the plane before it.
    const std::string between = fmt::format(
        "(1 - (c - k)) * {0}_Nodes (k * {1} + v).x + (c - k) * {0}_Nodes ((k + 1) * {1} + v).x",
        name,
        distance);
    const std::string across =
        fmt::format("{}_Between (v, min({}, floor(c)), c)", name, columns - 2);
    return sdl + spline_sdl(name + "_Planes", planes) +
           function_sdl(name + "_Between", "v, k, c", between) +
           function_sdl(name + "_Across", "v, c", across) +
           function_sdl(name + "_At",
                        "v, h",
                        within_sdl(table, fmt::format("{0}_Across (v, {0}_Planes (h).x)", name)));
}

std::string table_value_sdl(const BeamTable& table, const std::string& name) {
    switch (table.angles) {
        case TableAngles::TypeA:
            return fmt::format("{}_At (atan2(x, sqrt(y*y + z*z)), atan2(y, z))", name);
        case TableAngles::TypeB:
            return fmt::format("{}_At (atan2(x, z), atan2(y, sqrt(x*x + z*z)))", name);
        case TableAngles::TypeC:
            break;
    }
    if (table.horizontal_rad.size() == 1)
        return fmt::format("{}_At (atan2(sqrt(x*x + y*y), z))", name);
    return fmt::format(
        "{}_At (atan2(sqrt(x*x + y*y), z), select(-y, atan2(-y, x) + 2*pi, select(x, pi, 0), "
        "atan2(-y, x)))",
        name);
}

// In units of the disc's area, for slopes x/z and y/z. For a sharp image it is the whole disc
// within the rectangle's slopes.
std::string optics_value_sdl(const BeamOptics& optics) {
    const double radius_m = 0.5 * optics.aperture_m;
    const double blur_m = std::abs(1.0 - optics.distance_m / optics.focal_length_m) * radius_m;
    if (is_focused(optics)) {
        return fmt::format(
            "select(z, 0, 0, select({0} * z - abs(x), 0, select({1} * z - abs(y), 0, {2} * z)))",
            sdl_number(0.5 * optics.along_m / optics.distance_m),
            sdl_number(0.5 * optics.across_m / optics.distance_m),
            sdl_number(most_optics_intensity(optics)));
    }
    return fmt::format(
        "select(z, 0, 0, {0} * z * Aphotic_Disc_In_Rectangle ({1} * abs(x) / max(z, 1e-9), "
        "{1} * abs(y) / max(z, 1e-9), {2}, {3}))",
        sdl_number(radius_m * radius_m),
        sdl_number(optics.distance_m / blur_m),
        sdl_number(0.5 * optics.along_m / blur_m),
        sdl_number(0.5 * optics.across_m / blur_m));
}

std::string cones_value_sdl(const Beam& beam) {
    std::string sum = "0";
    for (Beam part : parts_of(beam)) {
        part.window.reset();
        const Cone& cone = part.cones.front();
        const std::string none = operand_sdl(std::cos(cone.half_angle_rad));
        const std::string full = operand_sdl(std::cos(cone.half_angle_rad - cone.edge_rad));
        const std::string step = cone.edge_rad == 0.0
                                     ? fmt::format("select(z - {}, 0, 1)", none)
                                     : fmt::format("Aphotic_Soft_Step (z, {}, {})", none, full);
        sum += fmt::format(" + {} * pow(max(0, z), {}) * {}",
                           sdl_number(most_intensity(part)),
                           sdl_number(cone.exponent),
                           step);
    }
    return fmt::format("select(z, 0, 0, {})", sum);
}

// The pattern in the lamp's frame, in air if it was measured there.
std::string bare_functions_sdl(const Beam& beam, const std::string& name) {
    if (const auto* table = std::get_if<BeamTable>(&beam.pattern)) {
        return planes_sdl(*table, name) + function_sdl(name,
                                                       "x, y, z",
                                                       fmt::format("{} * {}",
                                                                   sdl_number(beam.per_flux),
                                                                   table_value_sdl(*table, name)));
    }
    if (const auto* optics = std::get_if<BeamOptics>(&beam.pattern)) {
        return function_sdl(
            name,
            "x, y, z",
            fmt::format("{} * {}", sdl_number(beam.per_flux), optics_value_sdl(*optics)));
    }
    return function_sdl(name, "x, y, z", cones_value_sdl(beam));
}

std::string turned_sdl(const Beam& beam, const std::string& name, const std::string& pattern) {
    const std::string c = operand_sdl(std::cos(beam.turn_rad));
    const std::string s = operand_sdl(std::sin(beam.turn_rad));
    return function_sdl(
        name, "x, y, z", fmt::format("{0} ({1}*x + {2}*y, {1}*y - {2}*x, z)", pattern, c, s));
}

// From a direction in water; c is the cosine in air, squared.
std::string window_sdl(const BeamWindow& window,
                       const std::string& name,
                       const std::string& pattern) {
    const std::string n = sdl_number(window.water_index);
    return function_sdl(name + "_In_Air",
                        "x, y, c",
                        fmt::format("{} ({}*x, {}*y, c) * Aphotic_Window (c, {}, {})",
                                    pattern,
                                    n,
                                    n,
                                    sdl_number(window.glass_index),
                                    n)) +
           function_sdl(name + "_Out",
                        "x, y, c",
                        fmt::format("select(c, 0, {}_In_Air (x, y, sqrt(max(0, c))))", name)) +
           function_sdl(name,
                        "x, y, z",
                        fmt::format("select(z, 0, 0, {}_Out (x, y, 1 - {}*(x*x + y*y)))",
                                    name,
                                    sdl_number(window.water_index * window.water_index)));
}

}  // namespace

bool needs_shell(const Beam& beam) {
    return !std::holds_alternative<std::monostate>(beam.pattern) ||
           (beam.window && !beam.cones.empty());
}

std::size_t light_count(const Beam& beam) {
    return needs_shell(beam) ? 1 : beam.cones.size();
}

std::string beam_sdl(const Beam& beam) {
    const std::vector<Beam> parts = parts_of(beam);
    const bool has_edges =
        std::ranges::any_of(beam.cones, [](const Cone& cone) { return cone.edge_rad != 0.0; });
    const bool has_exponents = has_edges || std::ranges::any_of(beam.cones, [](const Cone& cone) {
                                   return cone.exponent != 1.0;
                               });
    std::string sdl = fmt::format(
        "array[{}][{}] {{\n", parts.size(), 2 + (has_exponents ? 1 : 0) + (has_edges ? 1 : 0));
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const Cone& cone = beam.cones[k];
        sdl += fmt::format("      {{{}, {}{}{}}}{}   // {}\n",
                           sdl_number(cone.half_angle_rad * kDegreesPerRadian),
                           sdl_number(flux_of(parts[k])),
                           has_exponents ? ", " + sdl_number(cone.exponent) : "",
                           has_edges ? ", " + sdl_number(cone.edge_rad * kDegreesPerRadian) : "",
                           k + 1 == parts.size() ? "" : ",",
                           sdl_comment(cone.part));
    }
    return sdl + "   }";
}

std::string pattern_functions_sdl(const Beam& beam, const std::string& name) {
    std::string sdl;
    std::string last = name;
    // From the outermost function inwards, each named by the functions that follow.
    const bool is_turned = beam.turn_rad != 0.0;
    if (is_turned) last = name + "_Turned";
    const std::string bare = beam.window ? name + "_Bare" : last;
    sdl += bare_functions_sdl(beam, bare);
    if (beam.window) sdl += window_sdl(*beam.window, last, bare);
    if (is_turned) sdl += turned_sdl(beam, name, last);
    return sdl;
}

std::string pattern_sdl(const Beam& beam, const std::string& name) {
    return fmt::format("Aphotic_Pattern ({}, {})", name, sdl_number(most_intensity(beam)));
}

}  // namespace aphotic
