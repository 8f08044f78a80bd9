// SPDX-License-Identifier: BSD-3-Clause
//
// Both renderers at the extremes: what a rig may ask for and a sled never does, each row of
// tests/validation/extremes.toml held against the answer in long double (exact_light.h).
//
//   e = (a - b) / max(|b|, floor)       a a renderer's value, b the answer
//
// floor, what counts as black: for POV-Ray what its frames can hold (validation.h), and in any case
// the smallest normal float, which is what images hold; for the tracer kTracedFloor.
#pragma once

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/number.h"
#include "cli/rendered_images.h"
#include "image/frame_check.h"
#include "plugin/render.h"
#include "rig/file/rig_reader.h"
#include "scene_gen/render_plan.h"
#include "scene_gen/scene_set.h"
#include "spectral/integrator.h"
#include "support/exact_light.h"
#include "validation/comparison.h"
#include "validation/tracer.h"
#include "validation/validation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <ostream>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aphotic::extremes {

// The tracer's bounds of |e|: a double's rounding, through sums and exponentials, and for the
// signals its spectral grid's (tracer.h).
inline constexpr double kTracedRadianceBound = 1e-11;
inline constexpr double kTracedSignalBound = 2e-8;
// Where the water scatters: kVeilTolerance, and the rounding of distances of 100 m beside
// kVeilBeside_m.
inline constexpr double kTracedVeilBound = 1e-8;
// The tracer's light ends where the water has left e^-700 of it (tracer.h); the rest is for the
// brightest lamps that a rig may have.
inline constexpr double kTracedFloor = 1e-280;
inline constexpr double kSmallestNormalFloat = std::numeric_limits<float>::min();

// The words of extremes.toml.
inline constexpr std::array kOutcomes{"holds",    // every error within its bound, something to see
                                      "grows",    // an image, finite, out of bounds
                                      "faint",    // within bounds, but all is under a floor
                                      "black",    // the same, and both images are zero throughout
                                      "refused",  // the reader says why not
                                      "unrenderable"};  // the plan or the render says why not

struct ExtremeTable {
    std::string file;
    std::string text;
};

struct Extreme {
    std::string group;  // such as "water"
    std::string what;   // is changed, in words
    std::string value;  // and to what
    std::string name;   // of letters, digits and _, unique
    std::string rig;    // TOML
    std::vector<ExtremeTable> tables;
    std::optional<int> peak_log2;        // of the frames' exposure, if not the usual
    std::vector<double> wavelengths_nm;  // none: as a render plans them
    std::string expected;                // of kOutcomes
    std::vector<std::string> says;       // one of these stands in the words of a refusal
};

inline void PrintTo(const Extreme& one, std::ostream* out) {
    *out << one.what << ": " << one.value;
}

struct ExtremeFound {
    std::string outcome = "holds";
    std::string said;              // why it was refused
    double peak = 0.0;             // largest radiance of the answer, over pixels and wavelengths
    double povray_radiance = 0.0;  // largest |e|, off the edges
    double povray_signal = 0.0;
    double promise = 0.0;  // the plan's, of the worst channel
    double traced_radiance = 0.0;
    double traced_signal = 0.0;
};

// A refusal for another reason, such as a POV-Ray that fails, is not.
inline bool is_as_expected(const Extreme& asked, const ExtremeFound& found) {
    if (found.outcome != asked.expected) return false;
    return found.said.empty() || std::ranges::any_of(asked.says, [&](const std::string& words) {
               return found.said.find(words) != std::string::npos;
           });
}

// How a row is rendered. Throws InputError or RunError where a render does.
using ExtremeRender = std::function<RenderedImages(
    const Rig& rig, const Extreme& asked, const std::filesystem::path& folder)>;

// The sheet.

// What overlay holds goes over what base holds, table by table; arrays are replaced whole.
inline void lay_over(toml::table& base, const toml::table& overlay) {
    for (const auto& [key, node] : overlay) {
        toml::table* below = base[key].as_table();
        if (node.is_table() && below != nullptr) {
            lay_over(*below, *node.as_table());
        } else {
            base.insert_or_assign(key, node);
        }
    }
}

// key is a path such as "strobe.0.position_m".
inline void put(toml::node& at, std::string_view key, const toml::node& value) {
    const std::size_t dot = key.find('.');
    const std::string_view first = key.substr(0, dot);
    if (auto* array = at.as_array()) {
        put(array->at(read_number<std::size_t>(first).value()), key.substr(dot + 1), value);
    } else if (dot == std::string_view::npos) {
        at.as_table()->insert_or_assign(first, value);
    } else {
        toml::table& table = *at.as_table();
        if (!table.contains(first)) table.insert(first, toml::table{});
        put(*table.get(first), key.substr(dot + 1), value);
    }
}

inline std::string printed(const toml::table& table) {
    std::ostringstream text;
    text << table;
    return text.str();
}

inline std::string label_of(const toml::node& value) {
    if (const toml::table* piece = value.as_table()) {
        return piece->get("as")->value_or(std::string());
    }
    if (const toml::array* array = value.as_array()) {
        std::vector<std::string> items;
        for (const toml::node& item : *array) items.push_back(label_of(item));
        return fmt::format("{}", fmt::join(items, ", "));
    }
    return fmt::format("{}", value.value_or(0.0));
}

inline std::string test_name(std::string_view words, std::size_t number) {
    constexpr std::size_t kLongest = 60;
    std::string name;
    for (const char c : words.substr(0, kLongest)) {
        const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0;
        if (is_plain) name += c;
        if (!is_plain && !name.empty() && name.back() != '_') name += '_';
    }
    return fmt::format("{:03}_{}", number, name);
}

// A smooth curve of so many points over the visible range, for a table of any size.
inline std::string filled_table(std::int64_t points) {
    std::string text = "wavelength_nm,relative_power\n";
    for (std::int64_t i = 0; i < points; ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(points - 1);
        text += fmt::format("{:.9g},{:.9g}\n", 390.0 + 340.0 * t, 1.0 + t * t);
    }
    return text;
}

inline std::vector<ExtremeTable> tables_of(const toml::table& words) {
    std::vector<ExtremeTable> tables;
    const toml::table* named = words["tables"].as_table();
    if (named == nullptr) return tables;
    for (const auto& [file, content] : *named) {
        const auto points = content.value<std::int64_t>();
        tables.push_back(
            {.file = std::string(file.str()),
             .text = points ? filled_table(*points) : content.value_or(std::string())});
    }
    return tables;
}

// So many strobes, the first again and again.
inline void copy_strobe(toml::table& rig, std::int64_t count) {
    const toml::table first = *rig["strobe"].as_array()->at(0).as_table();
    toml::array strobes;
    for (std::int64_t i = 0; i < count; ++i) {
        toml::table strobe = first;
        strobe.insert_or_assign("name", fmt::format("strobe {}", i + 1));
        strobes.push_back(std::move(strobe));
    }
    rig.insert_or_assign("strobe", std::move(strobes));
}

// Fewer and larger pixels over the same field of view.
inline void set_width(toml::table& rig, int width_px) {
    toml::table& camera = *rig["camera"].as_table();
    const auto width = camera["resolution"][0].value_or(1.0);
    const auto height = camera["resolution"][1].value_or(1.0);
    const double share = width_px / width;
    camera.insert_or_assign(
        "resolution",
        toml::array{width_px, std::max<std::int64_t>(1, std::lround(height * share))});
    camera.insert_or_assign("pixel_pitch_um", camera["pixel_pitch_um"].value_or(1.0) / share);
}

inline Extreme row_of(const toml::table& base,
                      const toml::table& extreme,
                      const toml::node& value,
                      const std::string& expected) {
    toml::table sheet = base;
    if (const auto* set = extreme["set"].as_table()) lay_over(sheet, *set);
    const std::string key = extreme["key"].value_or(std::string());
    if (key.empty()) {
        lay_over(sheet, *value.as_table());
    } else {
        put(sheet, key, value);
    }
    sheet.erase("as");
    toml::table words;
    if (const auto* also = sheet["also"].as_table()) words = *also;
    sheet.erase("also");
    if (auto* tables = words["tables"].as_table()) tables->erase("as");
    if (const auto count = words["strobes"].value<std::int64_t>()) copy_strobe(sheet, *count);

    Extreme made{.group = extreme["group"].value_or(std::string()),
                 .what = extreme["name"].value_or(std::string()),
                 .value = label_of(value),
                 .name = "",
                 .rig = printed(sheet) + "\n",
                 .tables = tables_of(words),
                 .peak_log2 = words["peak_log2"].value<int>(),
                 .wavelengths_nm = {},
                 .expected = expected,
                 .says = {}};
    if (const auto* says = extreme["says"].as_array()) {
        for (const toml::node& words_of : *says) {
            made.says.push_back(words_of.value_or(std::string()));
        }
    }
    if (const auto* wavelengths = words["wavelengths_nm"].as_array()) {
        for (const toml::node& nm : *wavelengths) made.wavelengths_nm.push_back(nm.value_or(0.0));
    }
    return made;
}

// Measuring.

struct Answer {
    std::vector<std::vector<double>> radiance;  // by wavelength, row by row
    std::array<std::vector<double>, kChannels> signals;
};

inline Answer answer_of(const Rig& rig, std::span<const double> lambda_nm) {
    const ExactLight<long double> light(rig);
    Answer answer{.radiance = std::vector<std::vector<double>>(lambda_nm.size()), .signals = {}};
    for (int row = 0; row < rig.camera.height_px; ++row) {
        for (int column = 0; column < rig.camera.width_px; ++column) {
            for (std::size_t j = 0; j < lambda_nm.size(); ++j) {
                answer.radiance[j].push_back(
                    static_cast<double>(light.radiance(column + 0.5, row + 0.5, lambda_nm[j])));
            }
            const auto signals = light.signals(column + 0.5, row + 0.5);
            for (std::size_t c = 0; c < kChannels; ++c) {
                answer.signals[c].push_back(static_cast<double>(signals[c]));
            }
        }
    }
    return answer;
}

// The largest |e| off the edges; infinite where a value is not finite, wherever that is.
template <typename Sample>
double largest_error(std::span<const Sample> samples,
                     std::span<const double> answer,
                     std::span<const unsigned char> on_edge,
                     double floor) {
    double largest = 0.0;
    for (std::size_t i = 0; i < answer.size(); ++i) {
        const double e = std::abs(relative_error(samples[i], answer[i], floor));
        if (std::isnan(e)) return std::numeric_limits<double>::infinity();
        if (on_edge[i] == 0) largest = std::max(largest, e);
    }
    return largest;
}

inline double peak_of(std::span<const double> samples) {
    return samples.empty() ? 0.0 : std::ranges::max(samples);
}

struct ExtremePlane {
    std::span<const double> answer;
    std::span<const float> rendered;
    std::span<const double> traced;
    std::span<const unsigned char> on_edge;
    double floor = 0.0;  // of what is rendered
    double bound = 0.0;  // of its |e|
    double traced_bound = 0.0;
};

// Of all planes of radiance, or of all signals.
struct Verdict {
    double rendered_error = 0.0;
    double traced_error = 0.0;
    bool holds = true;
    bool is_seen = false;  // something is over its floor
    bool is_black = true;  // POV-Ray's values are zero throughout

    void take_in(const ExtremePlane& plane) {
        const double e = largest_error(plane.rendered, plane.answer, plane.on_edge, plane.floor);
        const double traced_e =
            largest_error(plane.traced, plane.answer, plane.on_edge, kTracedFloor);
        rendered_error = std::max(rendered_error, e);
        traced_error = std::max(traced_error, traced_e);
        holds &= e <= plane.bound && traced_e <= plane.traced_bound;
        is_seen |= peak_of(plane.answer) > plane.floor;
        is_black &= std::ranges::all_of(plane.rendered, [](float x) { return x == 0.0F; });
    }
};

inline void compare(const Rig& rig, const RenderedImages& rendered, ExtremeFound& found) {
    const Tracer tracer(rig, {.signals = true, .planes_nm = rendered.lambda_nm});
    const std::vector<double> traced = tracer.rows(0, rig.camera.height_px);
    const Answer answer = answer_of(rig, rendered.lambda_nm);
    const std::size_t pixels = answer.signals[0].size();
    const auto plane_of = [pixels](const auto& planes, std::size_t i) {
        return std::span(planes).subspan(i * pixels, pixels);
    };
    Verdict radiance;
    const std::vector<float> planes = rendered.radiance(0, rendered.lambda_nm.size());
    for (std::size_t j = 0; j < rendered.lambda_nm.size(); ++j) {
        const auto [first_nm, last_nm] = std::minmax(rendered.lambda_nm[j], rendered.index_nm[j]);
        found.peak = std::max(found.peak, peak_of(answer.radiance[j]));
        radiance.take_in(
            {.answer = answer.radiance[j],
             .rendered = plane_of(planes, j),
             .traced = plane_of(traced, kChannels + j),
             .on_edge = tracer.on_edges({.first_nm = first_nm, .last_nm = last_nm}),
             .floor = std::max(kSmallestNormalFloat, rendered.radiance_black[j]),
             .bound = kHalfFloatBound + rendered.shift_error[j],
             .traced_bound = rig.water.scatters() ? kTracedVeilBound : kTracedRadianceBound});
    }
    Verdict signals;
    const std::vector<unsigned char> on_edge = tracer.on_edges(rig.camera.range);
    for (std::size_t c = 0; c < kChannels; ++c) {
        const double black = std::max(kBlackShare * peak_of(answer.signals[c]), rendered.black[c]);
        found.promise = std::max(found.promise, rendered.promise[c]);
        signals.take_in({.answer = answer.signals[c],
                         .rendered = plane_of(rendered.signals.samples, c),
                         .traced = plane_of(traced, c),
                         .on_edge = on_edge,
                         .floor = std::max(kSmallestNormalFloat, black),
                         .bound = rendered.promise[c],
                         .traced_bound = kTracedSignalBound});
    }
    found.povray_radiance = radiance.rendered_error;
    found.traced_radiance = radiance.traced_error;
    found.povray_signal = signals.rendered_error;
    found.traced_signal = signals.traced_error;
    if (!radiance.holds || !signals.holds) {
        found.outcome = "grows";
    } else if (radiance.is_black && signals.is_black) {
        found.outcome = "black";
    } else if (!radiance.is_seen || !signals.is_seen) {
        found.outcome = "faint";
    }
}

inline std::vector<Extreme> all_extremes(int width_px) {
    const toml::table sheet =
        toml::parse_file(std::string(APHOTIC_SOURCE_DIR) + "/tests/validation/extremes.toml");
    toml::table base = *sheet["rig"].as_table();
    set_width(base, width_px);
    std::vector<Extreme> rows;
    for (const toml::node& node : *sheet["extreme"].as_array()) {
        const toml::table& extreme = *node.as_table();
        for (const std::string outcome : kOutcomes) {
            const toml::array* values = extreme[outcome].as_array();
            if (values == nullptr) continue;
            for (const toml::node& value : *values) {
                rows.push_back(row_of(base, extreme, value, outcome));
                Extreme& made = rows.back();
                made.name = test_name(made.what + " " + made.value, rows.size());
            }
        }
    }
    return rows;
}

// width_px: of every image whose size is not what the row is about; the field of view stays.
inline std::vector<Extreme> extremes_of(const std::string& group, int width_px) {
    std::vector<Extreme> rows = all_extremes(width_px);
    std::erase_if(rows, [&](const Extreme& one) { return one.group != group; });
    return rows;
}

// Writes the row's rig into the folder, reads it as a user's, renders, traces, and compares.
inline ExtremeFound measure(const Extreme& asked,
                            const std::filesystem::path& folder,
                            const ExtremeRender& render) {
    make_folder(folder);
    for (const ExtremeTable& table : asked.tables) write_text_file(folder / table.file, table.text);
    write_text_file(folder / "rig.toml", asked.rig);
    ExtremeFound found;
    found.outcome = "refused";
    try {
        const Rig rig = read_rig(folder / "rig.toml");
        found.outcome = "unrenderable";
        const RenderedImages images = render(rig, asked, folder);
        found.outcome = "holds";
        compare(rig, images, found);
    } catch (const InputError& error) {
        found.said = error.what();
    } catch (const RunError& error) {
        found.said = error.what();
    }
    return found;
}

inline RenderedImages render_by_povray(const Rig& rig,
                                       const Extreme& asked,
                                       const std::filesystem::path& folder) {
    PlanRequest request;
    request.wavelengths_nm = asked.wavelengths_nm;
    if (asked.peak_log2) request.scene.peak_log2 = *asked.peak_log2;
    const RenderPlan plan = plan_render(rig, request);
    const RenderResult result =
        render(find_povray(""), folder / "out", make_scene_set(rig, plan), {.jobs = 1});
    integrate(folder / "out", result.manifest);
    return cli::images_in(folder / "out", rig, result.manifest, plan.family);
}

}  // namespace aphotic::extremes
