// SPDX-License-Identifier: BSD-3-Clause
#include "cli/survey_command.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "base/progress.h"
#include "base/words.h"
#include "cli/options.h"
#include "cli/rig_file.h"
#include "cli/terminal.h"
#include "survey/navigation/image_time.h"
#include "survey/relief/relief_mesh.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

namespace aphotic::cli {
namespace {

std::string words_of(const ShotExposure& exposure) {
    std::string words;
    const auto add = [&](std::optional<double> number, std::string_view format, double unit) {
        if (!number) return;
        words += words.empty() ? "" : ", ";
        words += fmt::format(fmt::runtime(format), *number * unit);
    };
    constexpr double kMilliseconds = 1e3;
    add(exposure.time_s, "{:g} ms", kMilliseconds);
    add(exposure.iso, "ISO {:g}", 1.0);
    add(exposure.f_number, "f/{:g}", 1.0);
    return words;
}

constexpr double kMostOffset_m = 1000.0;  // as in a rig
constexpr double kMostClock_s = 1e10;     // a clock that restarted in 1970 is off by 2e9

// "altitude_m=alt [m],roll_deg=phi"
ColumnNames column_names(const std::string& text) {
    ColumnNames names;
    for (const std::string_view one : comma_fields(text)) {
        const std::size_t equals = one.find('=');
        const std::string ours(trimmed(one.substr(0, equals)));
        const bool is_ours =
            std::ranges::find(kNavigationFields, std::string_view(ours)) != kNavigationFields.end();
        if (!is_ours || equals == std::string_view::npos || equals + 1 == one.size()) {
            throw InputError("found '{}'; allowed: NAME=COLUMN, NAME one of {}",
                             one,
                             fmt::join(kNavigationFields, ", "));
        }
        names[ours] = std::string(trimmed(one.substr(equals + 1)));
    }
    return names;
}

void add_columns(CLI::App& app, NavigationOptions& options) {
    add_read(app, "--columns", options.columns, column_names);
    add_option(app, "--angles-in", options.angles_in)
        ->transform(word_of<AngleUnit>({{"deg", AngleUnit::Degrees}, {"rad", AngleUnit::Radians}}));
}

std::string time_mask(const std::string& mask) {
    require_time_mask(mask);
    return mask;
}

void add_times(CLI::App& app, NavigationOptions& options) {
    add_read(app, "--image-time", options.time_mask, time_mask);
    add_option(app, "--clock-offset-s", options.clock_offset_s)
        ->check(in_range(-kMostClock_s, kMostClock_s).description(""));
    add_option(app, "--longest-gap-s", options.longest_gap_s)->check(positive());
}

void add_altitude_meaning(CLI::App& app, NavigationOptions& options) {
    std::map<std::string, AltitudeIs> words;
    for (std::size_t i = 0; i < kAltitudeWords.size(); ++i)
        words[std::string(kAltitudeWords.at(i))] = static_cast<AltitudeIs>(i);
    add_option(app, "--altitude-is", options.altitude_is)->transform(word_of(words));
    add_option(app, "--altitude-offset-m", options.altitude_offset_m)
        ->check(in_range(-kMostOffset_m, kMostOffset_m));
}

void add_crop_options(CLI::App& app, CameraNumbers& camera) {
    const auto take = [&camera](const std::string& name) {
        camera.half = name == "left" ? Half::Left : Half::Right;
    };
    auto* half = add_option_function<std::string>(app, "--half", take)
                     ->check(CLI::IsMember({"left", "right"}));
    add_read(app,
             "--crop",
             camera.crop,
             read_by(crop_named, "X,Y,WIDTH,HEIGHT, whole numbers of pixels"))
        ->excludes(half);
}

std::optional<AllowedSkips> allowed_skips_in(std::string_view text) {
    constexpr double kPercent = 0.01;
    constexpr double kMostImages = 1e9;
    const bool is_percent = text.ends_with('%');
    if (is_percent) text.remove_suffix(1);
    const auto read = read_number<double>(text);
    if (!read) return std::nullopt;
    const bool is_share = is_percent || *read != std::floor(*read);
    const double number = is_percent ? kPercent * *read : *read;
    const bool is_allowed = number >= 0.0 && number <= (is_share ? 1.0 : kMostImages);
    return is_allowed ? std::optional(AllowedSkips{number, is_share}) : std::nullopt;
}

}  // namespace

void add_images(CLI::App& app, SurveyInput& input) {
    add_option(app, "IMAGES", input.images)->required();
}

void add_survey_rig(CLI::App& app, SurveyInput& input) {
    add_option(app, "--rig", input.rig);
}

CLI::Option* add_navigation_options(CLI::App& app, SurveyInput& input) {
    NavigationOptions& options = input.navigation;
    const OptionGroup group(app, "Navigation");
    CLI::Option* nav = add_option(app, "--nav", options.source);
    add_columns(app, options);
    add_times(app, options);
    add_altitude_meaning(app, options);
    constexpr std::string_view kOfNav =
        "--columns,--angles-in,--image-time,--clock-offset-s,--longest-gap-s,--altitude-is,"
        "--altitude-offset-m";
    for (const std::string_view name : comma_fields(kOfNav))
        app.get_option(std::string(name))->needs(nav);
    return nav;
}

namespace {

void add_mesh_options(CLI::App& app, SurveyInput& input, CLI::Option* maps) {
    const auto mesh = [&input]() -> FloorMesh& {
        return input.depth.mesh ? *input.depth.mesh : input.depth.mesh.emplace();
    };
    const auto take_file = [&input, mesh](const std::string& file) {
        input.depth.place = file;
        mesh();
    };
    CLI::Option* const relief = add_option_function<std::string>(app, "--relief", take_file)
                                    ->check(CLI::ExistingFile)
                                    ->excludes(maps)
                                    ->needs(app.get_option("--nav"));
    const auto take_axes = [mesh](const std::string& word) {
        const auto* const found = std::ranges::find(kReliefAxesWords, word);
        mesh().axes = static_cast<ReliefAxes>(found - kReliefAxesWords.begin());
    };
    add_option_function<std::string>(app, "--relief-axes", take_axes)
        ->check(CLI::IsMember(
            std::vector<std::string>(kReliefAxesWords.begin(), kReliefAxesWords.end())))
        ->needs(relief);
    const auto take_place = [&input](const std::string& word) {
        input.is_by_depth = word == "depth";
    };
    add_option_function<std::string>(app, "--relief-place", take_place)
        ->check(CLI::IsMember({"depth", "altitude"}))
        ->needs(relief);
}

}  // namespace

CLI::Option* add_depth_maps(CLI::App& app, SurveyInput& input) {
    const OptionGroup group(app, "Relief");
    constexpr double kMillimetre = 1e-3;
    DepthMaps& depth = input.depth;
    CLI::Option* maps = add_option(app, "--depth-map", depth.place)->check(CLI::ExistingPath);
    const auto take = [&depth](const std::string& unit) {
        depth.unit_m = unit == "mm" ? kMillimetre : 1.0;
    };
    add_option_function<std::string>(app, "--depth-unit", take)
        ->check(CLI::IsMember({"m", "mm"}))
        ->needs(maps);
    add_mesh_options(app, input, maps);
    return maps;
}

void add_depth_options(CLI::App& app, SurveyInput& input) {
    CLI::Option* const maps = add_depth_maps(app, input);
    const OptionGroup group(app, "Relief");
    add_option(app, "--depth-is", input.depth.is)
        ->transform(word_of<DepthIs>({{"axis", DepthIs::AlongAxis}, {"ray", DepthIs::AlongRay}}))
        ->needs(maps);
    add_option(app, "--normals", input.depth.normals)
        ->transform(
            word_of<NormalsFrom>({{"depth", NormalsFrom::Depth}, {"floor", NormalsFrom::Floor}}))
        ->needs(maps);
}

void add_camera_options(CLI::App& app, SurveyInput& input, bool has_white, bool has_map) {
    CameraNumbers& camera = input.camera;
    add_read(app, "--bayer", camera.mosaic, read_by(mosaic_named, "RGGB, BGGR, GRBG, GBRG, mono"));
    add_crop_options(app, camera);
    add_option(app, "--black-level", camera.black_level);
    std::map<std::string, ExposureBy> ways{
        {"none", ExposureBy::Nothing}, {"exif", ExposureBy::Exif}, {"flash", ExposureBy::Flash}};
    if (has_map) ways["model"] = ExposureBy::Model;
    add_option(app, "--exposure", camera.exposure_by)->transform(word_of(ways));
    if (!has_white) return;
    add_option(app, "--white-level", camera.white_level);
}

void add_dropouts(CLI::App& app, SurveyInput& input, bool corrects) {
    std::map<std::string, Dropouts> words = kDropoutWords;
    if (!corrects) words.erase(name_of(kDropoutWords, Dropouts::Correct));
    add_option(app, "--dropouts", input.dropouts)->transform(word_of(words));
}

void add_outcome_options(CLI::App& app, SurveyInput& input) {
    add_strict_option(app, input.strict);
    add_read(app,
             "--allow-skipped",
             input.allowed_skips,
             read_by(allowed_skips_in, "a number of images, or a share such as 0.01 or 1%"));
    add_json(app, input.json);
}

Settle add_format_options(CLI::App& app, ResultFormat& format) {
    const auto encoded = std::make_shared<SrgbFormat>();
    add_flag(app, "--mask", format.mask);
    const CLI::Option* name = add_option(app, "--format", format.format)
                                  ->check(CLI::IsMember({"tiff", "png", "exr", "jpeg"}));
    add_option(app, "--compression", format.compression)->transform(word_of(kCompressions));
    const auto encoding = std::make_shared<std::string>("linear");
    add_option(app, "--encode", *encoding)->check(CLI::IsMember({"linear", "srgb"}));
    const CLI::Option* bits =
        add_option(app, "--bits", encoded->bits)->check(CLI::IsMember({8, 16}));
    const CLI::Option* quality =
        add_option(app, "--quality", encoded->quality)->check(in_range(1, 100));
    const CLI::Option* stops =
        add_option(app, "--stops", encoded->stops)->check(in_range(-20.0, 20.0));
    return [&format, linear = format.format, encoded, encoding, name, bits, quality, stops] {
        const bool is_srgb = *encoding == "srgb";
        for (const CLI::Option* option : {bits, quality, stops}) {
            if (option->count() == 0 || is_srgb) continue;
            throw InputError("{}: found linear images; allowed: with --encode srgb",
                             option->get_name());
        }
        if (!is_srgb && format.format == "jpeg") {
            throw InputError(
                "--format: found jpeg, which holds no linear image; allowed: tiff, png, exr, or "
                "jpeg with --encode srgb");
        }
        if (!is_srgb) return;
        const bool is_named = name->count() > 0 && format.format != "exr";
        encoded->format = is_named ? format.format : "jpeg";
        if (format.format == "jpeg") format.format = linear;
        const bool is_jpeg = encoded->format == "jpeg";
        const CLI::Option* idle = is_jpeg ? bits : quality;
        if (idle->count() > 0 && !(is_jpeg && encoded->bits == 8)) {
            throw InputError("{}: found {} of {}; allowed: {}",
                             idle->get_name(),
                             idle->results().front(),
                             encoded->format,
                             is_jpeg ? "8, or --format png or tiff" : "with --format jpeg");
        }
        format.srgb = *encoded;
    };
}

std::optional<Rig> rig_of(const SurveyInput& input) {
    return input.rig.empty() ? std::nullopt
                             : std::optional(read_plausible_rig(input.rig, input.strict));
}

Survey read_survey(const SurveyInput& input, const std::filesystem::path& output, const Rig* rig) {
    Survey survey{.files = image_files(input.images, output),
                  .camera = input.camera,
                  .dropouts = input.dropouts};
    if (rig != nullptr) survey.camera = with_rig(survey.camera, rig->camera);
    survey.camera = with_reference(survey.camera, survey.files);
    // A crop that fits no image is a single mistake, reported once.
    survey.camera = expecting_usual_size(survey.camera, survey.files);
    return survey;
}

std::optional<DepthMaps> depth_of(const SurveyInput& input,
                                  const std::optional<Navigation>& navigation) {
    if (input.depth.place.empty()) return std::nullopt;
    DepthMaps depth = input.depth;
    if (!depth.mesh) return depth;
    depth.mesh->is_by_depth = input.is_by_depth.value_or(navigation->tells_depth());
    depth.mesh->scene =
        std::make_shared<const ReliefScene>(read_relief_mesh(depth.place), depth.mesh->axes);
    return depth;
}

std::optional<Navigation> navigation_of(const SurveyInput& input,
                                        const std::vector<ImageFile>& files,
                                        const Rig& rig) {
    const bool has_depth = !input.depth.place.empty();
    if (!input.navigation.source.empty()) return read_navigation(input, files, &rig);
    if (!has_depth)
        throw InputError("--rig needs --nav, since the map depends on the pose, or --depth-map");
    if (input.depth.normals == NormalsFrom::Floor)
        throw InputError("--normals floor needs --nav, which gives the floor's orientation");
    return std::nullopt;
}

Navigation read_navigation(const SurveyInput& input,
                           const std::vector<ImageFile>& files,
                           const Rig* rig) {
    NavigationOptions options = input.navigation;
    options.jobs = static_cast<std::size_t>(all_cores());
    options.has_places = input.depth.mesh.has_value();
    return aphotic::read_navigation(options, files, rig);
}

void print_camera(const Survey& survey) {
    const CameraNumbers& camera = survey.camera;
    std::vector<std::string> words;
    if (camera.mosaic) words.emplace_back(mosaic_name(*camera.mosaic));
    if (camera.half) words.emplace_back(*camera.half == Half::Left ? "left half" : "right half");
    if (camera.crop) {
        words.push_back(fmt::format("{} x {} pixels from {}, {}",
                                    camera.crop->width_px,
                                    camera.crop->height_px,
                                    camera.crop->left_px,
                                    camera.crop->top_px));
    }
    if (camera.black_level) words.push_back(fmt::format("black level {:g}", *camera.black_level));
    if (camera.white_level) words.push_back(fmt::format("white level {:g}", *camera.white_level));
    if (camera.exposure_by == ExposureBy::Model) words.emplace_back("each image to its own level");
    if (is_told_by_exif(camera.exposure_by))
        words.push_back("brought to " + words_of(camera.reference));
    if (!words.empty()) say("  camera: {}\n", fmt::join(words, ", "));
}

void print_navigation(const Survey& survey) {
    if (!survey.navigation || !survey.navigation->notes()) return;
    say("  navigation: {}\n", words_of(*survey.navigation->notes()));
}

void print_scale(PlaneSize of_rig, PlaneSize of_images) {
    say("  rig of {} x {} pixels scaled to {} x {}\n",
        of_rig.width_px,
        of_rig.height_px,
        of_images.width_px,
        of_images.height_px);
}

void print_relief(const Survey& survey) {
    if (!survey.depth) return;
    const DepthMaps& depth = *survey.depth;
    if (depth.mesh) {
        say("  relief: {}, {}, {}\n",
            depth.place.string(),
            kReliefAxesWords.at(static_cast<std::size_t>(depth.mesh->axes)),
            depth.mesh->is_by_depth ? "by the navigation's depths" : "by altitudes");
        return;
    }
    say("  relief: depth maps of {}, {}{}\n",
        depth.place.string(),
        depth.is == DepthIs::AlongAxis ? "along the axis" : "along rays",
        depth.normals == NormalsFrom::Floor ? "; normals of the navigation's floor" : "");
}

std::size_t AllowedSkips::of(std::size_t images) const {
    // 0.07 of 100 is 7, but the product in doubles differs by rounding.
    constexpr double kRounding = 1e-9;
    const double number_of =
        is_share ? number * static_cast<double>(images) * (1.0 + kRounding) : number;
    return static_cast<std::size_t>(number_of);
}

RunWatch terminal_watch(bool strict) {
    const auto line = std::make_shared<ProgressLine>();
    return {.progress = [line](std::string_view what, double share) { line->show(what, share); },
            .skipped =
                [line](const Skipped& one) {
                    line->wipe();
                    warn("{}: {}; skipped", one.image, one.why);
                },
            .marked =
                [line](const MarkedImage& one) {
                    line->wipe();
                    warn("{}: {}", one.image, words_of(one));
                },
            .looks_wrong =
                [line, strict](const std::vector<Suspicion>& found) {
                    line->wipe();
                    std::string all;
                    for (const Suspicion& one : found) {
                        if (!strict) {
                            warn("looks wrong: {}: {}", one.about, one.what);
                        }
                        all +=
                            fmt::format("{}{}: {}", all.empty() ? "" : "; ", one.about, one.what);
                    }
                    if (strict && !all.empty()) {
                        throw InputError("--strict: suspicious survey: " + all);
                    }
                }};
}

void print_srgb(const SrgbEncoding& encoding, const std::filesystem::path& folder) {
    say("  sRGB in {}: exposure {:.4g}, ", (folder / kSrgbFolder).string(), encoding.exposure);
    if (encoding.camera) {
        say("colours within {:.1f} CIELAB units on average over {}, {:.1f} at most ({})\n",
            encoding.camera->mean_delta_e(),
            counted(encoding.camera->surfaces.size(), "surface"),
            encoding.camera->worst().delta_e,
            encoding.camera->worst().name);
    } else {
        say("channels shown as sRGB's own\n");
    }
}

void print_doubts(const RunOutcome& outcome) {
    constexpr double kPercent = 100.0;
    std::vector<std::string> shares;
    for (const auto& [name, bit, words] : kDoubts)
        shares.push_back(fmt::format("{} {:.3g} %", name, kPercent * outcome.doubtful_share(name)));
    say("  doubtful pixels: {}\n", fmt::join(shares, ", "));
}

ExitStatus status_of_skips(std::size_t skipped, std::size_t images, const SurveyInput& input) {
    if (skipped == 0) return kDone;
    const std::size_t most = input.allowed_skips.of(images);
    warn(
        "{} of {} skipped; allowed: {} (--allow-skipped)", skipped, counted(images, "image"), most);
    return skipped <= most ? kDone : kAnswerIsNo;
}

}  // namespace aphotic::cli
