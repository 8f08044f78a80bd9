// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/sweep_file.h"

#include "base/error.h"
#include "base/number.h"
#include "base/printable.h"
#include "rig/key_depth.h"
#include "rig/section.h"
#include "survey/random_draw.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

namespace aphotic {
namespace {

constexpr Bounds kAnyNumber{-std::numeric_limits<double>::max(),
                            std::numeric_limits<double>::max()};

double whole_number(Section& section, std::string_view key, double least, double most) {
    const double number = section.number(key, {least, most});
    if (number != std::floor(number))
        section.found_but(key, fmt::format("a whole number from {} to {}", least, most));
    return number;
}

int whole_number(Section& section, std::string_view key, int least, int most) {
    return static_cast<int>(
        whole_number(section, key, static_cast<double>(least), static_cast<double>(most)));
}

std::optional<double> number_in(const toml::node& node) {
    const auto number = node.is_number() ? node.value<double>() : std::nullopt;
    return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<SweepValue> value_of(const toml::node& node) {
    if (const auto number = number_in(node)) return *number;
    if (const auto text = node.value_exact<std::string>()) return *text;
    const toml::array* array = node.as_array();
    if (array == nullptr || array->empty()) return std::nullopt;
    std::vector<double> numbers;
    for (const toml::node& item : *array) {
        const auto number = number_in(item);
        if (!number) return std::nullopt;
        numbers.push_back(*number);
    }
    return numbers;
}

std::vector<SweepValue> list_of(Section& section) {
    const std::string allowed = "a list of numbers, texts or lists of numbers";
    const toml::array* array = section.required("values", allowed).as_array();
    if (array == nullptr || array->empty()) section.found_but("values", allowed);
    std::vector<SweepValue> values;
    for (const toml::node& node : *array) {
        auto value = value_of(node);
        if (!value) section.found_but("values", allowed);
        values.push_back(*std::move(value));
    }
    return values;
}

// 0.1 + 2 x 0.1 is to be 0.3, and -0.3 + 3 x 0.1 to be 0: what is left of a sum's rounding goes.
double tidy(double value, double step) {
    constexpr double kNothing = 1e-9;  // of a step
    constexpr int kDigits = 12;
    return std::abs(value) < kNothing * step ? 0.0 : rounded_to_digits(value, kDigits);
}

std::vector<SweepValue> range_of(Section& section) {
    const auto [first, last, step] = section.numbers<3>("range", kAnyNumber);
    const std::string allowed = "[first, last, step], whose steps end at last";
    constexpr double kWhole = 1e-6;  // of a step: what decimal fractions leave
    const double steps = (last - first) / step;
    const double whole = std::round(steps);
    const bool is_counted = steps >= 0.0 && std::isfinite(steps);
    if (!is_counted || std::abs(steps - whole) > kWhole) section.found_but("range", allowed);
    if (whole >= static_cast<double>(kMostTasks))
        section.found_but("range", fmt::format("up to {} values", kMostTasks));
    std::vector<SweepValue> values;
    for (int i = 0; i <= static_cast<int>(whole); ++i)
        values.emplace_back(tidy(first + i * step, std::abs(step)));
    return values;
}

std::vector<double> ends_of(Section& section) {
    const auto [least, most] = section.numbers<2>("between", kAnyNumber);
    if (!(least < most)) section.found_but("between", "[least, most], the smaller one first");
    return {least, most};
}

SweptKey read_key(Section section) {
    SweptKey swept{.key = section.text("key", "a key of the rig, such as \"water.multiple\"")};
    const bool has_list = section.has("values");
    const bool has_range = section.has("range");
    const bool has_ends = section.has("between");
    if (const int found = has_list + has_range + has_ends; found != 1) {
        section.fail_at("key",
                        fmt::format("found {} of values, range and between; allowed: one",
                                    found == 0 ? "none" : fmt::to_string(found)));
    }
    if (has_list) swept.values = list_of(section);
    if (has_range) swept.values = range_of(section);
    if (has_ends) swept.between = ends_of(section);
    section.refuse_unknown_keys();
    return swept;
}

std::vector<SweptKey> read_keys(Section& top) {
    std::vector<SweptKey> keys;
    if (!top.has("vary")) return keys;
    std::set<std::string> known;
    for (const Section& section : top.sections("vary", "tables [[vary]]")) {
        keys.push_back(read_key(section));
        if (known.insert(keys.back().key).second) continue;
        section.fail_at("key", fmt::format("found {} twice; allowed: once", keys.back().key));
    }
    return keys;
}

bool is_of_hypercube(const SweptKey& key) {
    return !key.between.empty();
}

SweepFile read_sweep(Section top) {
    constexpr int kMostCores = 1024;
    constexpr auto kMost = static_cast<int>(kMostTasks);
    constexpr double kMostSeed = 0x1p53;
    SweepFile sweep;
    const auto refuse = [&](const char* key, const char* where) {
        if (top.has(key)) top.fail_at(key, fmt::format("allowed only {}", where));
    };
    sweep.command =
        top.word("command", {"render", "trace", "lightmap", "validate", "correct", "fit"});
    sweep.rig = top.text("rig", "a rig's file");
    const bool takes_images = sweep.command == "correct" || sweep.command == "fit";
    if (takes_images) {
        sweep.images = top.texts("images", "a list of images and folders of them");
        if (sweep.images.empty()) top.found_but("images", "one or more");
    } else {
        refuse("images", "for correct and fit");
    }
    if (top.has("arguments")) sweep.arguments = top.texts("arguments", "a list of texts");
    if (top.has("cores")) sweep.cores = whole_number(top, "cores", 1, kMostCores);
    if (sweep.command != "correct") refuse("shares", "for correct");
    if (top.has("shares")) sweep.shares = whole_number(top, "shares", 1, kMost);
    sweep.vary = read_keys(top);
    if (std::ranges::any_of(sweep.vary, is_of_hypercube)) {
        if (!top.has("samples"))
            top.fail_at("vary", "found `between` without samples, the hypercube's points");
        sweep.samples = whole_number(top, "samples", 1, kMost);
        if (top.has("seed"))
            sweep.seed = static_cast<std::uint64_t>(whole_number(top, "seed", 0.0, kMostSeed));
    } else {
        refuse("samples", "where a key has `between`");
        refuse("seed", "where a key has `between`");
    }
    top.refuse_unknown_keys();
    return sweep;
}

// 0 to count - 1 in any order, each as likely, by Fisher and Yates.
std::vector<int> shuffled(int count, RandomSource& random) {
    std::vector<int> order(static_cast<std::size_t>(count));
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t i = order.size(); i > 1; --i)
        std::swap(order[i - 1], order[static_cast<std::size_t>(uniform(random) * double(i))]);
    return order;
}

// By sample, of one key.
std::vector<SweepValue> drawn(const SweptKey& key, int samples, RandomSource random) {
    std::vector<SweepValue> values;
    for (const int part : shuffled(samples, random)) {
        const double share = (part + uniform(random)) / samples;
        values.emplace_back(std::lerp(key.between[0], key.between[1], share));
    }
    return values;
}

}  // namespace

SweepFile parse_sweep_file(std::string_view toml, const std::string& name) {
    require_shallow_keys(toml, name);
    toml::table table;
    try {
        table = toml::parse(toml, name);
    } catch (const toml::parse_error& error) {
        fail_at_line(name, error.source().begin.line, printable(error.description()));
    }
    SweepFile sweep = read_sweep(Section(table, "", name));
    std::size_t count = static_cast<std::size_t>(sweep.shares);
    if (sweep.samples > 0) count *= static_cast<std::size_t>(sweep.samples);
    for (const SweptKey& key : sweep.vary) {
        if (count <= kMostTasks && !is_of_hypercube(key)) count *= key.values.size();
    }
    if (count > kMostTasks)
        throw InputError("{}: found more than {} tasks; allowed: up to that", name, kMostTasks);
    return sweep;
}

std::vector<SweepPoint> points_of(const SweepFile& sweep) {
    std::vector<SweepPoint> points{SweepPoint(sweep.vary.size())};
    for (std::size_t k = 0; k < sweep.vary.size(); ++k) {
        if (is_of_hypercube(sweep.vary[k])) continue;
        std::vector<SweepPoint> more;
        for (const SweepPoint& point : points) {
            for (const SweepValue& value : sweep.vary[k].values) {
                more.push_back(point);
                more.back()[k] = value;
            }
        }
        points = std::move(more);
    }
    if (sweep.samples == 0) return points;
    std::vector<SweepPoint> more;
    for (const SweepPoint& point : points)
        more.insert(more.end(), static_cast<std::size_t>(sweep.samples), point);
    for (std::size_t k = 0; k < sweep.vary.size(); ++k) {
        if (!is_of_hypercube(sweep.vary[k])) continue;
        const auto values =
            drawn(sweep.vary[k], sweep.samples, random_of(sweep.seed, static_cast<int>(k)));
        for (std::size_t i = 0; i < more.size(); ++i) more[i][k] = values[i % values.size()];
    }
    return more;
}

std::string words_of(const SweepValue& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
    return fmt::format("{}", fmt::join(std::get<std::vector<double>>(value), " "));
}

}  // namespace aphotic
