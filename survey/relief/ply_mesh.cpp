// SPDX-License-Identifier: BSD-3-Clause
#include "survey/relief/ply_mesh.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "base/number_bytes.h"
#include "base/printable.h"
#include "rig/beam/photometric_text.h"
#include "rig/file/mesh_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

struct PlyType {
    std::string_view name;
    std::string_view sized_name;
    std::size_t bytes;
    double (*at)(const void* bytes);
};
constexpr std::array kPlyTypes{PlyType{"char", "int8", 1, number_at<std::int8_t, double>},
                               PlyType{"uchar", "uint8", 1, number_at<std::uint8_t, double>},
                               PlyType{"short", "int16", 2, number_at<std::int16_t, double>},
                               PlyType{"ushort", "uint16", 2, number_at<std::uint16_t, double>},
                               PlyType{"int", "int32", 4, number_at<std::int32_t, double>},
                               PlyType{"uint", "uint32", 4, number_at<std::uint32_t, double>},
                               PlyType{"float", "float32", 4, number_at<float, double>},
                               PlyType{"double", "float64", 8, number_at<double, double>}};

struct PlyProperty {
    std::string_view name;
    const PlyType* type;
    const PlyType* count;  // for a list; otherwise null
};

struct PlyElement {
    std::string_view name;
    std::size_t count;
    std::vector<PlyProperty> properties;
};

class PlyReader {
  public:
    PlyReader(const std::string& name, std::string_view ply, std::size_t most_triangles)
        : name_(name), rest_(ply), most_triangles_(most_triangles) {}

    Mesh read() {
        read_header();
        for (const PlyElement& element : elements_) {
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face")
                read_faces(element);
            else
                each(element, [](const Row&) {});
        }
        if (mesh_.triangles.empty())
            fail("found {} vertices and no faces; allowed: a mesh of triangles",
                 mesh_.vertices_m.size());
        return std::move(mesh_);
    }

  private:
    template <typename... Values>
    [[noreturn]] void fail(fmt::format_string<Values...> format, Values&&... values) const {
        throw InputError("{}: {}", name_, fmt::format(format, std::forward<Values>(values)...));
    }

    [[noreturn]] void refuse_header(std::string_view line) const {
        constexpr std::size_t kMostLetters = 80;
        fail("found '{}' in the header; allowed: PLY 1.0, ascii or binary_little_endian",
             printable(line.substr(0, kMostLetters)));
    }

    std::string_view take_line() {
        if (rest_.find('\n') == std::string_view::npos) fail("the file ends within its header");
        return next_line(rest_);
    }

    [[nodiscard]] const PlyType* type_named(std::string_view word, std::string_view line) const {
        const auto* const type = std::ranges::find_if(kPlyTypes, [&](const PlyType& one) {
            return one.name == word || one.sized_name == word;
        });
        if (type == kPlyTypes.end()) refuse_header(line);
        return type;
    }

    void read_header() {
        if (!rest_.starts_with("ply")) fail("not a PLY file");
        take_line();
        while (true) {
            const std::string_view line = take_line();
            const auto words = words_in(line);
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
            if (words[0] == "end_header") return;
            const std::size_t count = words.size();
            if (words[0] == "format" && count == 3 &&
                (words[1] == "ascii" || words[1] == "binary_little_endian")) {
                is_ascii_ = words[1] == "ascii";
            } else if (words[0] == "element" && count == 3) {
                const auto many = read_number<std::size_t>(words[2]);
                if (!many) refuse_header(line);
                elements_.push_back({words[1], *many, {}});
            } else if (words[0] == "property" && count == 3 && !elements_.empty()) {
                elements_.back().properties.push_back(
                    {words[2], type_named(words[1], line), nullptr});
            } else if (words[0] == "property" && count == 5 && words[1] == "list" &&
                       !elements_.empty()) {
                elements_.back().properties.push_back(
                    {words[4], type_named(words[3], line), type_named(words[2], line)});
            } else {
                refuse_header(line);
            }
        }
    }

    double take(const PlyType& type) {
        if (is_ascii_) return take_word();
        if (rest_.size() < type.bytes) refuse_end();
        const double value = type.at(rest_.data());
        rest_.remove_prefix(type.bytes);
        return value;
    }

    double take_word() {
        const std::size_t start = rest_.find_first_not_of(kBlanks);
        if (start == std::string_view::npos) refuse_end();
        rest_.remove_prefix(start);
        const std::string_view word = rest_.substr(0, rest_.find_first_of(kBlanks));
        const auto value = read_number<double>(word);
        if (!value)
            fail("found {} in {} {}; allowed: a number", shown_word(word), in_->name, place_ + 1);
        rest_.remove_prefix(word.size());
        return *value;
    }

    [[noreturn]] void refuse_end() const {
        fail("the file is truncated: found {} of {} elements '{}'",
             place_,
             in_->count,
             printable(in_->name));
    }

    // The values of one element by property: several, or none, of a list.
    using Row = std::vector<std::vector<double>>;

    template <typename Use>
    void each(const PlyElement& element, const Use& use) {
        in_ = &element;
        if (element.properties.empty()) return;
        Row row(element.properties.size());
        for (place_ = 0; place_ < element.count; ++place_) {
            for (std::size_t i = 0; i < row.size(); ++i) {
                const PlyProperty& property = element.properties[i];
                const double many = property.count == nullptr ? 1.0 : take(*property.count);
                row[i].clear();
                for (double n = 0.0; n < many; ++n) row[i].push_back(take(*property.type));
            }
            use(row);
        }
    }

    [[nodiscard]] std::optional<std::size_t> property_of(const PlyElement& element,
                                                         std::string_view name,
                                                         bool is_list) const {
        const auto found = std::ranges::find_if(element.properties, [&](const PlyProperty& one) {
            return one.name == name && (one.count != nullptr) == is_list;
        });
        if (found == element.properties.end()) return std::nullopt;
        return static_cast<std::size_t>(found - element.properties.begin());
    }

    void read_vertices(const PlyElement& element) {
        const auto x = property_of(element, "x", false);
        const auto y = property_of(element, "y", false);
        const auto z = property_of(element, "z", false);
        if (!x || !y || !z) fail("found vertices without x, y or z; needed: all three");
        each(element, [&](const Row& row) {
            const Eigen::Vector3d vertex_m(row[*x][0], row[*y][0], row[*z][0]);
            if (!vertex_m.allFinite())
                fail("found vertex {} with a coordinate that is not finite; allowed: numbers",
                     place_ + 1);
            mesh_.vertices_m.push_back(vertex_m);
        });
    }

    void read_faces(const PlyElement& element) {
        auto corners = property_of(element, "vertex_indices", true);
        if (!corners) corners = property_of(element, "vertex_index", true);
        if (!corners) fail("found faces without vertex_indices; needed: the list of that name");
        each(element, [&](const Row& row) { add_face(row[*corners]); });
    }

    void add_face(const std::vector<double>& values) {
        const auto vertices = static_cast<double>(mesh_.vertices_m.size());
        std::vector<int> corners;
        for (const double value : values) {
            if (!(value >= 0.0 && value < vertices && value == std::floor(value)))
                fail("found vertex {} in face {}; allowed: 0 to {}, the vertices before it",
                     value,
                     place_ + 1,
                     vertices - 1.0);
            corners.push_back(static_cast<int>(value));
        }
        if (corners.size() < 3 || corners.size() > kMostCorners)
            fail("found face {} of {} corners; allowed: 3 to {}",
                 place_ + 1,
                 corners.size(),
                 kMostCorners);
        if (corners.size() == 3) {
            mesh_.triangles.push_back({corners[0], corners[1], corners[2]});
        } else {
            const auto triangles = cut(mesh_, corners);
            mesh_.triangles.insert(mesh_.triangles.end(), triangles.begin(), triangles.end());
        }
        if (mesh_.triangles.size() > most_triangles_)
            fail("found more than {0} triangles; allowed: {0} or fewer", most_triangles_);
    }

    const std::string& name_;
    std::string_view rest_;
    std::size_t most_triangles_;
    bool is_ascii_ = false;
    std::vector<PlyElement> elements_{};
    const PlyElement* in_ = nullptr;
    std::size_t place_ = 0;  // of the current element among its kind
    Mesh mesh_{};
};

}  // namespace

Mesh parse_ply(const std::string& name, std::string_view ply, std::size_t most_triangles) {
    return PlyReader(name, ply, most_triangles).read();
}

}  // namespace aphotic
