// SPDX-License-Identifier: BSD-3-Clause
#include "rig/strobe_text.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace aphotic {
namespace {

// Bytes of a text, and what comes in their place.
struct TextEdit {
    std::size_t first;
    std::size_t last;
    std::string text;
};

// The parser counts lines, and code points along a line, from 1.
class TextPlaces {
  public:
    explicit TextPlaces(std::string_view text) : text_(text) {
        for (std::size_t i = 0; i < text.size(); ++i) {
            if (text[i] == '\n') lines_.push_back(i + 1);
        }
    }

    [[nodiscard]] std::size_t byte_of(const toml::source_position& place) const {
        constexpr unsigned char kContinued = 0x80;
        constexpr unsigned char kContinuedMask = 0xC0;
        const auto is_continued = [&](std::size_t i) {
            return (static_cast<unsigned char>(text_[i]) & kContinuedMask) == kContinued;
        };
        std::size_t at = lines_[place.line - 1];
        for (toml::source_index column = 1; column < place.column; ++column) {
            ++at;
            while (at < text_.size() && is_continued(at)) ++at;
        }
        return std::min(at, text_.size());
    }

  private:
    std::string_view text_;
    std::vector<std::size_t> lines_{0};
};

// A whole number with a decimal point, so that it stays a number of that kind.
std::string decimal(double value, int places) {
    const double scale = std::pow(10.0, places);
    const double rounded = std::round(value * scale) / scale;
    return fmt::format("{:#}", rounded == 0.0 ? 0.0 : rounded);
}

std::string decimals(const Eigen::Vector3d& v, int places) {
    return fmt::format(
        "[{}, {}, {}]", decimal(v.x(), places), decimal(v.y(), places), decimal(v.z(), places));
}

class StrobeEditor {
  public:
    StrobeEditor(const TextPlaces& places, const toml::table& strobe, std::vector<TextEdit>& edits)
        : places_(places), strobe_(strobe), edits_(edits) {}

    void make(const StrobeChange& change) {
        if (change.position_m) {
            replace(*strobe_.get("position_m"), decimals(*change.position_m, kPlacesOfMetre));
        }
        if (change.direction) point(decimals(*change.direction, kPlacesOfDirection));
        if (change.tilt_deg) {
            replace(*strobe_.get("aim")->as_table()->get("tilt_deg"),
                    decimal(*change.tilt_deg, kPlacesOfDegree));
        }
        if (change.power_factor) brighten(*change.power_factor);
    }

  private:
    [[nodiscard]] std::size_t begin_of(std::string_view key) const {
        for (auto&& [name, node] : strobe_) {
            if (name.str() == key) return places_.byte_of(name.source().begin);
        }
        return 0;
    }

    void replace(const toml::node& node, std::string text) {
        edits_.push_back({places_.byte_of(node.source().begin),
                          places_.byte_of(node.source().end),
                          std::move(text)});
    }

    void point(const std::string& direction) {
        if (const toml::node* node = strobe_.get("direction")) {
            replace(*node, direction);
            return;
        }
        const toml::source_region& aim = strobe_.get("aim")->source();
        const std::size_t first = begin_of("aim");
        // The values of a column stay one, where there is room.
        const std::size_t before_equals = places_.byte_of(aim.begin) - first - 2;
        edits_.push_back({first,
                          places_.byte_of(aim.end),
                          fmt::format("{:<{}}= {}", "direction ", before_equals, direction)});
    }

    void brighten(double factor) {
        static constexpr std::array<std::string_view, 4> kPowers{
            "power", "luminous_flux_lm", "radiant_flux_w", "energy_j"};
        const auto digits = [](double value) {
            return fmt::format("{:#.{}g}", value, kDigitsOfPower);
        };
        for (const std::string_view key : kPowers) {
            const toml::node* node = strobe_.get(key);
            if (node == nullptr) continue;
            replace(*node, digits(factor * *node->value<double>()));
            return;
        }
        // Before another key, where it needs to know nothing of comments.
        const std::size_t at = begin_of("position_m");
        edits_.push_back(
            {at,
             at,
             fmt::format("power = {}{}", digits(factor), strobe_.is_inline() ? ", " : "\n")});
    }

    const TextPlaces& places_;
    const toml::table& strobe_;
    std::vector<TextEdit>& edits_;
};

}  // namespace

std::vector<StrobeAim> strobe_aims(std::string_view toml) {
    const toml::table rig = toml::parse(toml);
    std::vector<StrobeAim> aims;
    for (const toml::node& node : *rig.get("strobe")->as_array()) {
        const toml::node* aim = node.as_table()->get("aim");
        if (aim == nullptr) {
            aims.push_back(StrobeAim::Direction);
        } else {
            aims.push_back(aim->as_table()->is_inline() ? StrobeAim::Inline : StrobeAim::Apart);
        }
    }
    return aims;
}

std::string with_strobes(std::string_view toml, const std::vector<StrobeChange>& changes) {
    const toml::table rig = toml::parse(toml);
    const TextPlaces places(toml);
    std::vector<TextEdit> edits;
    const toml::array& strobes = *rig.get("strobe")->as_array();
    for (std::size_t s = 0; s < changes.size(); ++s) {
        StrobeEditor(places, *strobes[s].as_table(), edits).make(changes[s]);
    }
    // From the end, so that what comes before stays where it is.
    std::ranges::sort(edits, std::ranges::greater(), &TextEdit::first);
    std::string text(toml);
    for (const TextEdit& edit : edits) text.replace(edit.first, edit.last - edit.first, edit.text);
    return text;
}

}  // namespace aphotic
