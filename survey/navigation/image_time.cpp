// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation/image_time.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "base/printable.h"
#include "image/any_image.h"
#include "survey/images/image_files.h"
#include "survey/navigation/time_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <regex>

namespace aphotic {
namespace {

struct MaskPart {
    std::string_view letters;
    bool is_needed;
};
constexpr std::array<MaskPart, 8> kMaskParts{{{"YYYY", true},
                                              {"MM", true},
                                              {"DD", true},
                                              {"hh", true},
                                              {"mm", true},
                                              {"ss", true},
                                              {"fff", false},
                                              {"uuu", false}}};

// The digits at the places of these letters in the mask.
std::optional<int> part_in(std::string_view name, std::string_view mask, std::string_view letters) {
    const std::size_t at = mask.find(letters);
    if (at == std::string_view::npos) return 0;
    if (name.size() < at + letters.size()) return std::nullopt;
    const std::string_view digits = name.substr(at, letters.size());
    if (digits.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
    return read_number<int>(digits);
}

std::string tag(const std::map<std::string, std::string>& tags, const std::string& name) {
    const auto found = tags.find(name);
    return found == tags.end() ? "" : std::string(trimmed(found->second));
}

// Blanks, with or without the colon between them, mean unknown in EXIF.
std::string zone_in(const std::map<std::string, std::string>& tags, const std::string& name) {
    const std::string zone = tag(tags, name);
    return zone.find_first_not_of(" :") == std::string::npos ? "" : zone;
}

}  // namespace

void require_time_mask(const std::string& mask) {
    const auto refuse = [&](std::string_view why) {
        throw InputError(
            "found '{}', {}; allowed: YYYY, MM, DD, hh, mm, ss once each, fff for "
            "milliseconds, uuu for microseconds after it, x for any other character",
            mask,
            why);
    };
    for (const auto& [letters, is_needed] : kMaskParts) {
        const auto count = static_cast<std::size_t>(std::ranges::count(mask, letters.front()));
        if (count == 0 && !is_needed) continue;
        if (count == 0) refuse(fmt::format("which has no {}", letters));
        if (count != letters.size() || mask.find(letters) == std::string::npos)
            refuse(fmt::format("in which {} is split", letters));
    }
    if (mask.find('u') != std::string::npos && mask.find('f') == std::string::npos)
        refuse("which has uuu without fff");
}

std::optional<double> time_by_mask(std::string_view name, const std::string& mask) {
    std::array<int, kMaskParts.size()> values{};
    for (std::size_t i = 0; i < kMaskParts.size(); ++i) {
        const auto value = part_in(name, mask, kMaskParts[i].letters);
        if (!value) return std::nullopt;
        values[i] = *value;
    }
    const auto& [year, month, day, hour, minute, second, milliseconds, microseconds] = values;
    return unix_time_s({.year = year,
                        .month = month,
                        .day = day,
                        .hour = hour,
                        .minute = minute,
                        .second = second + milliseconds * 1e-3 + microseconds * 1e-6});
}

std::optional<double> time_in_habcam_name(const std::string& name) {
    static const std::regex kTime(R"((^|[^0-9])([0-9]{8}\.[0-9]{9})\.)");
    std::smatch found;
    if (!std::regex_search(name, found, kTime)) return std::nullopt;
    return time_by_mask(found[2].str(), "YYYYMMDD.hhmmssfff");
}

std::optional<double> time_in_exif(const std::map<std::string, std::string>& tags) {
    std::string text = tag(tags, "Exif:DateTimeOriginal");
    if (text.find(':') == std::string::npos) return std::nullopt;  // EXIF has no times in seconds
    const std::string part = tag(tags, "Exif:SubsecTimeOriginal");
    if (!part.empty()) text += "." + part;
    const auto time_s = unix_time_s(text);
    const std::string zone = zone_in(tags, "Exif:OffsetTimeOriginal");
    if (!time_s || zone.empty()) return time_s;
    if (const auto shifted_s = unix_time_s(text + zone)) return shifted_s;
    throw InputError(
        "OffsetTimeOriginal: found '{}'; allowed: Z, or hours and minutes such as "
        "+02:00",
        printable(zone));
}

ImageTime image_time(const std::filesystem::path& image, const std::string& mask) {
    const std::string name = image.filename().string();
    if (!mask.empty()) {
        if (const auto time_s = time_by_mask(without_extension(name).string(), mask))
            return {*time_s};
        throw InputError("its name has no time where --image-time {} expects it", mask);
    }
    require_file(image);
    const std::map<std::string, std::string> tags = header_of_image(image);
    if (const auto time_s = time_in_exif(tags)) {
        const bool lacks_zone = zone_in(tags, "Exif:OffsetTimeOriginal").empty() &&
                                !zone_in(tags, "Exif:OffsetTime").empty();
        return {.time_s = *time_s, .lacks_zone = lacks_zone};
    }
    if (const auto time_s = time_in_habcam_name(name)) return {*time_s};
    throw InputError(
        "it has no time: no DateTimeOriginal in its EXIF, and its name is not HabCam's; "
        "--image-time gives the time's place in its name");
}

}  // namespace aphotic
