// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation/navigation_file.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/degrees.h"
#include "base/error.h"
#include "base/file_kind.h"
#include "base/parallel.h"
#include "base/printable.h"
#include "base/words.h"
#include "image/any_image.h"
#include "rig/vehicle_pose.h"
#include "survey/navigation/image_time.h"
#include "survey/navigation/navigation_csv.h"
#include "survey/navigation/navigation_ifdo.h"

#include <fmt/format.h>

#include <atomic>
#include <utility>

namespace aphotic {

namespace {

std::optional<std::string_view> tag_in(std::string_view description, std::string_view key) {
    for (const std::string_view tag : comma_fields(description)) {
        const std::size_t equals = tag.find('=');
        if (equals == std::string_view::npos || trimmed(tag.substr(0, equals)) != key) continue;
        return trimmed(tag.substr(equals + 1));
    }
    return std::nullopt;
}

double tagged_number(ImagePose& pose, std::string_view description, const std::string& key) {
    constexpr std::size_t kMostShown = 80;
    if (const auto value = tag_in(description, key)) return number_in(pose, key, *value);
    if (pose.fault.empty()) {
        pose.fault = fmt::format("found the ImageDescription '{}{}'; needed in it: {}=NUMBER",
                                 printable(description.substr(0, kMostShown)),
                                 description.size() > kMostShown ? "..." : "",
                                 key);
    }
    return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

ColumnNames tag_names(const ColumnNames& given) {
    ColumnNames names{{"altitude_m", "alt0"}, {"pitch_deg", "pitch"}, {"roll_deg", "roll"}};
    for (const auto& [ours, theirs] : given) {
        const auto name = names.find(ours);
        if (name == names.end()) {
            throw InputError(
                "--columns: found '{}'; allowed with --nav tags: altitude_m, pitch_deg, roll_deg",
                ours);
        }
        name->second = theirs;
    }
    return names;
}

void read_tags(ImagePose& pose,
               std::string_view description,
               const ColumnNames& names,
               AngleUnit angles_in) {
    const double radians_per_unit = angles_in == AngleUnit::Degrees ? kRadiansPerDegree : 1.0;
    const auto number = [&](const char* ours) {
        return tagged_number(pose, description, names.at(ours));
    };
    pose.sled = {.altitude_m = number("altitude_m"),
                 .pitch_rad = number("pitch_deg") * radians_per_unit,
                 .roll_rad = number("roll_deg") * radians_per_unit};
}

namespace {

Mounting mounting_of(const NavigationOptions& options, const Rig* rig) {
    Mounting mounting = rig != nullptr ? rig->mounting : Mounting{};
    if (options.altitude_is) mounting.altitude_is = *options.altitude_is;
    if (options.altitude_offset_m) mounting.altitude_offset_m = *options.altitude_offset_m;
    return mounting;
}

// For the camera, from the vehicle's pose.
bool is_of_use(const Sled& sled, const Mounting& mounting, const NavigationOptions& options) {
    if (!fault_of(sled).empty()) return false;
    try {
        const double altitude_m = camera_pose(sled, mounting).altitude_m;
        return altitude_m >= options.least_altitude_m && altitude_m <= options.most_altitude_m;
    } catch (const InputError&) {
        return false;
    }
}

// A pose for each image, from read(pose), in several threads, since files are opened, possibly over
// a network. Errors become the pose's fault.
template <typename Read>
std::vector<ImagePose> poses_of(const std::vector<ImageFile>& files,
                                std::size_t jobs,
                                const Read& read) {
    std::vector<ImagePose> poses(files.size());
    parallel_for(files.size(), jobs, [&](auto i, auto) {
        ImagePose& pose = poses[i];
        pose.image = files[i].source.string();
        try {
            read(files[i].source, pose);
        } catch (const InputError& error) {
            pose.fault = error.what();
        }
    });
    return poses;
}

std::vector<std::pair<std::string, std::string>> in_our_order(const ColumnNames& names) {
    std::vector<std::pair<std::string, std::string>> ordered;
    for (const std::string_view field : kNavigationFields) {
        const auto name = names.find(std::string(field));
        if (name != names.end()) ordered.emplace_back(name->first, name->second);
    }
    return ordered;
}

// Options about times must not be ignored silently.
void require_no_times(const NavigationOptions& options) {
    if (options.time_mask.empty() && options.clock_offset_s == 0.0) return;
    throw InputError(
        "{}: {} found, but its poses are of images and not of times; allowed with poses over time, "
        "which --columns time=COLUMN selects",
        options.source,
        options.time_mask.empty() ? "--clock-offset-s" : "--image-time");
}

Navigation navigation_in_tags(const NavigationOptions& options,
                              const std::vector<ImageFile>& files) {
    require_no_times(options);
    const ColumnNames names = tag_names(options.columns);
    const auto read = [&](const std::filesystem::path& image, ImagePose& pose) {
        require_file(image);
        const auto tags = header_of_image(image);
        const auto description = tags.find("ImageDescription");
        if (description == tags.end()) throw InputError("it has no ImageDescription");
        read_tags(pose, description->second, names, options.angles_in);
    };
    Navigation navigation(std::string(kNavigationInTags),
                          poses_of(files, options.jobs, read),
                          {.pitch = true, .roll = true},
                          ImagesKnownBy::Path);
    navigation.note({.format = "HabCam's tags",
                     .columns = in_our_order(names),
                     .angles_in = options.angles_in});
    return navigation;
}

Navigation navigation_by_time(const NavigationTable& table,
                              const NavigationOptions& options,
                              const std::vector<ImageFile>& files,
                              const Mounting& mounting,
                              GivenAngles given,
                              NavigationNotes notes) {
    if (!options.time_mask.empty())
        naming("--image-time", [&] { require_time_mask(options.time_mask); });
    std::vector<ImagePose> points;
    for (const ImagePose& pose : table.poses) {
        if (pose.fault.empty() && is_of_use(pose.sled, mounting, options)) points.push_back(pose);
    }
    const ImagePose& first = table.poses.front();
    if (points.empty()) {
        const std::string fault = first.fault.empty() ? fault_of(first.sled) : first.fault;
        fail_at_line(options.source,
                     first.line,
                     "the first of {} lines, none of which can be used: {}",
                     table.poses.size(),
                     fault.empty()
                         ? "altitude_m: found one that --altitude or the camera's position excludes"
                         : fault);
    }
    notes.times = TimesOfImages{.mask = options.time_mask,
                                .clock_offset_s = options.clock_offset_s,
                                .longest_gap_s = options.longest_gap_s,
                                .lines_left_out = table.poses.size() - points.size()};
    const Track track(std::move(points), options.longest_gap_s);
    std::atomic<std::size_t> without_zone = 0;
    const auto read = [&](const std::filesystem::path& image, ImagePose& pose) {
        const ImageTime time = image_time(image, options.time_mask);
        if (time.lacks_zone) ++without_zone;
        const ImagePose then = track.at(time.time_s + options.clock_offset_s);
        pose.sled = then.sled;
        pose.place = then.place;
    };
    Navigation navigation(
        options.source, poses_of(files, options.jobs, read), given, ImagesKnownBy::Path);
    navigation.note(std::move(notes));
    if (without_zone > 0) {
        navigation.warn(fmt::format(
            "{}: the times of {} are taken as UTC: their EXIF has an OffsetTime, which belongs to "
            "the file's last change, and no OffsetTimeOriginal; --clock-offset-s shifts them",
            options.source,
            counted(without_zone, "image")));
    }
    return navigation;
}

Navigation navigation_of_table(const NavigationTable& table,
                               const NavigationOptions& options,
                               const std::vector<ImageFile>& files,
                               const Mounting& mounting) {
    const NavigationColumns& columns = table.columns;
    NavigationNotes notes{
        .format = columns.format,
        .angles_in = table.are_cameras_own ? AngleUnit::Radians : options.angles_in};
    for (std::size_t field = 0; field < kNavigationFields.size(); ++field) {
        if (columns.places.at(field))
            notes.columns.emplace_back(kNavigationFields.at(field), columns.names.at(field));
    }
    const GivenAngles given{.pitch = columns.place(NavigationField::Pitch).has_value(),
                            .roll = columns.place(NavigationField::Roll).has_value()};
    if (columns.is_track())
        return navigation_by_time(table, options, files, mounting, given, std::move(notes));
    require_no_times(options);
    Navigation navigation(options.source, table.poses, given);
    navigation.note(std::move(notes));
    return navigation;
}

// The camera's own poses cannot be converted by its mounting on the vehicle.
void require_no_place(const NavigationOptions& options, const Mounting& mounting) {
    if (!is_mounted_apart(mounting)) return;
    throw InputError(
        "{}: has the angles of the camera itself; found position_m or orientation_deg in the rig, "
        "which place it on a vehicle; allowed: a rig without them",
        options.source);
}

// Angles missing from the navigation are the rig's, which are the camera's.
void require_angles(const Navigation& navigation,
                    const NavigationOptions& options,
                    const Mounting& mounting,
                    bool has_rig) {
    const GivenAngles given = navigation.given();
    if (given.pitch && given.roll) return;
    const std::string_view lacking = given.pitch ? "roll" : given.roll ? "pitch" : "pitch and roll";
    if (is_mounted_apart(mounting)) {
        throw InputError(
            "{}: has no {}; needed, since the rig's position_m and orientation_deg place the "
            "camera on the vehicle",
            options.source,
            lacking);
    }
    if (!has_rig && mounting.altitude_is != AltitudeIs::Axis) {
        throw InputError("{}: has no {}; needed by --altitude-is {}, or a --rig that has them",
                         options.source,
                         lacking,
                         kAltitudeWords.at(static_cast<std::size_t>(mounting.altitude_is)));
    }
}

// An iFDO defines its fields and their units, and that they are the camera's.
void require_ifdo_alone(const NavigationOptions& options) {
    require_no_times(options);
    const auto refuse = [&](std::string_view option) {
        throw InputError("{}: found {} with an iFDO, whose fields say what they are; allowed: none",
                         options.source,
                         option);
    };
    if (!options.columns.empty()) refuse("--columns");
    if (options.angles_in != AngleUnit::Degrees) refuse("--angles-in");
    if (options.altitude_is) refuse("--altitude-is");
    if (options.altitude_offset_m) refuse("--altitude-offset-m");
}

Navigation navigation_of_ifdo(std::string_view text,
                              const NavigationOptions& options,
                              const Rig* rig) {
    require_ifdo_alone(options);
    const Mounting camera{.altitude_is = AltitudeIs::Plumb};
    Navigation navigation =
        parse_navigation_ifdo(options.source, text, rig != nullptr ? rig->sled : Sled{});
    navigation.limit_altitude(options.least_altitude_m, options.most_altitude_m);
    require_angles(navigation, options, camera, rig != nullptr);
    if (rig != nullptr) navigation.take_angles_of_rig();
    NavigationNotes notes{.format = "iFDO", .mounting = camera};
    notes.columns.emplace_back("altitude_m", kIfdoHeight);
    if (navigation.given().pitch) notes.columns.emplace_back("pitch_deg", kIfdoPitch);
    if (navigation.given().roll) notes.columns.emplace_back("roll_deg", kIfdoRoll);
    navigation.note(std::move(notes));
    // JSON ends with a bracket; YAML may be truncated anywhere.
    if (!text.ends_with('\n') && !text.ends_with('}')) {
        navigation.warn(
            fmt::format("{}: the file ends without a line break: if it was truncated, its last "
                        "value may lack digits",
                        options.source));
    }
    return navigation;
}

// The camera's, at the altitudes asked for.
Navigation mounted(Navigation navigation,
                   const NavigationOptions& options,
                   const Mounting& mounting,
                   bool has_rig) {
    require_angles(navigation, options, mounting, has_rig);
    navigation.mount(mounting);
    navigation.limit_altitude(options.least_altitude_m, options.most_altitude_m);
    NavigationNotes notes = navigation.notes().value_or(NavigationNotes{});
    notes.mounting = mounting;
    navigation.note(std::move(notes));
    return navigation;
}

void require_text(const std::string& source, std::string_view text) {
    if (const std::string_view kind = binary_kind(text); !kind.empty()) {
        throw InputError("{}: found {}; allowed: text in UTF-8, such as CSV", source, kind);
    }
    if (text.find('\0') != std::string_view::npos)
        throw InputError("{}: found zero bytes, as UTF-16 has; allowed: UTF-8", source);
}

}  // namespace

Navigation parse_navigation(std::string_view text,
                            const NavigationOptions& options,
                            const std::vector<ImageFile>& files,
                            const Rig* rig) {
    require_text(options.source, text);
    // The camera's own poses need no mounting.
    if (is_ifdo(text)) return navigation_of_ifdo(text, options, rig);
    const Mounting mounting = mounting_of(options, rig);
    const NavigationTable table = parse_navigation_csv(options.source,
                                                       text,
                                                       rig != nullptr ? rig->sled : Sled{},
                                                       options.columns,
                                                       options.angles_in,
                                                       options.has_places);
    if (table.are_cameras_own) require_no_place(options, mounting);
    Navigation vehicle = navigation_of_table(table, options, files, mounting);
    if (!table.cut_warning.empty()) vehicle.warn(table.cut_warning);
    if (rig != nullptr) vehicle.take_angles_of_rig();
    return mounted(std::move(vehicle), options, mounting, rig != nullptr);
}

Navigation read_navigation(const NavigationOptions& options,
                           const std::vector<ImageFile>& files,
                           const Rig* rig) {
    if (options.source != kNavigationInTags)
        return parse_navigation(
            read_text_file(options.source, kMostNavigation_bytes), options, files, rig);
    return mounted(
        navigation_in_tags(options, files), options, mounting_of(options, rig), rig != nullptr);
}

}  // namespace aphotic
