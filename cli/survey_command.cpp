// SPDX-License-Identifier: BSD-3-Clause
#include "cli/survey_command.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "base/progress.h"
#include "base/words.h"
#include "cli/option_checks.h"
#include "cli/options.h"
#include "cli/rig_file.h"
#include "cli/terminal.h"
#include "rig/file/rig_reader.h"
#include "survey/navigation/image_time.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

namespace aphotic::cli {
namespace {

// A line for each part of the work: it tells how long that part will take.
class ProgressOfParts {
  public:
    void show(std::string_view what, double share) {
        if (!line_ || share < share_) line_.emplace();
        share_ = share;
        line_->show(what, share);
    }
    void wipe() {
        if (line_) line_->wipe();
    }

  private:
    std::optional<ProgressLine> line_;
    double share_ = 0.0;
};

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

constexpr double kMostOffset_m = 1000.0;  // as a rig has it
constexpr double kMostClock_s = 1e10;     // a clock that began anew in 1970 is off by 2e9

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
    add_read(app,
             "--columns",
             options.columns,
             column_names,
             "Take image, time, altitude_m, pitch_deg or roll_deg from other columns, such as "
             "'altitude_m=alt [m],roll_deg=phi'")
        ->option_text("NAME=COLUMN,...");
    app.add_option("--angles-in", options.angles_in, "Unit of pitch and roll: deg or rad")
        ->transform(word_of<AngleUnit>({{"deg", AngleUnit::Degrees}, {"rad", AngleUnit::Radians}}))
        ->type_name("deg|rad")
        ->default_str("deg");
}

std::string time_mask(const std::string& mask) {
    require_time_mask(mask);
    return mask;
}

void add_times(CLI::App& app, NavigationOptions& options) {
    add_read(app,
             "--image-time",
             options.time_mask,
             time_mask,
             "Where images' names have their time, such as xxxYYYYMMDDxhhmmssxfff; by default "
             "EXIF, or HabCam's names",
             "MASK");
    app.add_option("--clock-offset-s",
                   options.clock_offset_s,
                   "Add this many seconds to the images' times, to have the navigation's")
        ->check(in_range(-kMostClock_s, kMostClock_s).description(""))
        ->capture_default_str();
    app.add_option("--longest-gap-s",
                   options.longest_gap_s,
                   "Interpolate over time between lines up to this many seconds apart")
        ->check(positive())
        ->capture_default_str();
}

void add_altitude_meaning(CLI::App& app, NavigationOptions& options) {
    std::map<std::string, AltitudeIs> words;
    for (std::size_t i = 0; i < kAltitudeWords.size(); ++i)
        words[std::string(kAltitudeWords.at(i))] = static_cast<AltitudeIs>(i);
    app.add_option("--altitude-is",
                   options.altitude_is,
                   "What navigation's altitudes are: along the camera's axis, the vertical height, "
                   "or to the nearest floor; by default the rig's altitude_is, or axis")
        ->transform(word_of(words))
        ->type_name("axis|plumb|nearest");
    app.add_option("--altitude-offset-m",
                   options.altitude_offset_m,
                   "Add this to altitudes, in metres; by default the rig's altitude_offset_m, or 0")
        ->check(in_range(-kMostOffset_m, kMostOffset_m));
}

void add_crop_options(CLI::App& app, CameraNumbers& camera) {
    auto* half = app.add_option_function<std::string>(
                        "--half",
                        [&camera](const std::string& name) {
                            camera.half = name == "left" ? Half::Left : Half::Right;
                        },
                        "Take the left or the right half of each file, which holds two cameras' "
                        "images side by side")
                     ->check(CLI::IsMember({"left", "right"}));
    add_read(app,
             "--crop",
             camera.crop,
             read_by(crop_named, "X,Y,WIDTH,HEIGHT, whole numbers of pixels"),
             "Take this part of each file, from column X and row Y of the top left, which are 0,0")
        ->option_text("X,Y,WIDTH,HEIGHT")
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
    app.add_option("IMAGES",
                   input.images,
                   "Raw images, or folders of them: TIFF, PNG, EXR, JPEG, DNG, CR2, NEF, ARW")
        ->required();
}

void add_survey_rig(CLI::App& app, SurveyInput& input) {
    app.add_option(
           "--rig",
           input.rig,
           "Take from this rig what is not given of the camera: its pattern, levels, exposure, and "
           "its place on the vehicle")
        ->type_name("RIG");
}

CLI::Option* add_navigation_options(CLI::App& app, SurveyInput& input) {
    NavigationOptions& options = input.navigation;
    const OptionGroup group(app, "Navigation");
    CLI::Option* nav =
        app.add_option("--nav",
                       options.source,
                       "Altitude, pitch and roll of each image: a table of Aphotic's, oplab's, "
                       "BIIGLE's, SQUIDLE+'s or HabCam's form, or of poses over time; or the word "
                       "tags, for HabCam's tags in the images")
            ->type_name("FILE");
    add_columns(app, options);
    add_times(app, options);
    add_altitude_meaning(app, options);
    for (const char* name : {"--columns",
                             "--angles-in",
                             "--image-time",
                             "--clock-offset-s",
                             "--longest-gap-s",
                             "--altitude-is",
                             "--altitude-offset-m"})
        app.get_option(name)->needs(nav);
    return nav;
}

void add_camera_options(CLI::App& app, SurveyInput& input, bool has_white) {
    CameraNumbers& camera = input.camera;
    add_read(app,
             "--bayer",
             camera.mosaic,
             read_by(mosaic_named, "RGGB, BGGR, GRBG, GBRG, mono"),
             "The images are mosaics, named after the four pixels at the file's top left: RGGB, "
             "BGGR, GRBG or GBRG; or mono, of a mono camera",
             "PATTERN");
    add_crop_options(app, camera);
    app.add_option(
        "--black-level", camera.black_level, "The camera's number for no light; by default 0");
    static const std::map<std::string, ExposureBy> kWays{
        {"none", ExposureBy::Nothing}, {"exif", ExposureBy::Exif}, {"flash", ExposureBy::Flash}};
    app.add_option("--exposure",
                   camera.exposure_by,
                   "Bring images to one exposure by their Exif: exif, by time, ISO number and "
                   "f-number; flash, without the time")
        ->transform(word_of(kWays))
        ->type_name("none|exif|flash")
        ->default_str("none");
    if (!has_white) return;
    app.add_option("--white-level",
                   camera.white_level,
                   "The camera's number at saturation, such as 4095; by default the largest of the "
                   "file's integer type");
}

void add_outcome_options(CLI::App& app, SurveyInput& input, const std::string& json) {
    add_strict_option(app, input.strict);
    add_read(app,
             "--allow-skipped",
             input.allowed_skips,
             read_by(allowed_skips_in, "a number of images, or a share such as 0.01 or 1%"),
             "End with 0 when no more images are skipped than this: a number, or a share of all "
             "such as 0.01 or 1%",
             "N|SHARE")
        ->default_str("0");
    add_json(app, input.json, json);
}

Settle add_format_options(CLI::App& app, ResultFormat& format) {
    const auto encoded = std::make_shared<SrgbFormat>();
    app.add_flag("--mask", format.mask, "Write NAME.mask.png beside each image");
    const CLI::Option* name =
        app.add_option("--format",
                       format.format,
                       "Write tiff or png (16 bits, white 65535) or exr (floats); of --encode "
                       "srgb also jpeg, which it takes by default")
            ->check(CLI::IsMember({"tiff", "png", "exr", "jpeg"}))
            ->capture_default_str();
    app.add_option("--compression",
                   format.compression,
                   "Compress losslessly: none, fast, or small (a few per cent smaller, about 1.5 "
                   "times slower)")
        ->transform(word_of(kCompressions))
        ->type_name("none|fast|small")
        ->default_str("fast");
    const auto encoding = std::make_shared<std::string>("linear");
    app.add_option("--encode",
                   *encoding,
                   "With srgb, also write images to look at: DIR/srgb/NAME.jpg, under one exposure")
        ->check(CLI::IsMember({"linear", "srgb"}))
        ->capture_default_str();
    const CLI::Option* bits =
        app.add_option("--bits", encoded->bits, "Of sRGB as tiff or png: 8 or 16")
            ->check(CLI::IsMember({8, 16}))
            ->capture_default_str();
    const CLI::Option* quality =
        app.add_option("--quality", encoded->quality, "Of sRGB as jpeg: 1 to 100")
            ->check(in_range(1, 100))
            ->capture_default_str();
    const CLI::Option* stops = app.add_option("--stops", encoded->stops, "Brighten sRGB by 2^STOPS")
                                   ->check(in_range(-20.0, 20.0))
                                   ->capture_default_str();
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
    Survey survey{.files = image_files(input.images, output), .camera = input.camera};
    if (rig != nullptr) survey.camera = with_rig(survey.camera, rig->camera);
    survey.camera = with_reference(survey.camera, survey.files);
    // A crop that no image has is one mistake.
    survey.camera = expecting_usual_size(survey.camera, survey.files);
    return survey;
}

Navigation read_navigation(const SurveyInput& input,
                           const std::vector<ImageFile>& files,
                           const Rig* rig) {
    NavigationOptions options = input.navigation;
    options.jobs = static_cast<std::size_t>(all_cores());
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
    if (camera.exposure_by != ExposureBy::Nothing)
        words.push_back("brought to " + words_of(camera.reference));
    if (!words.empty()) say("  camera: {}\n", fmt::join(words, ", "));
}

void print_navigation(const Survey& survey) {
    if (!survey.navigation || !survey.navigation->notes()) return;
    say("  navigation: {}\n", words_of(*survey.navigation->notes()));
}

std::size_t AllowedSkips::of(std::size_t images) const {
    // 0.07 of 100 are 7, which their product in doubles misses by its rounding.
    constexpr double kRounding = 1e-9;
    const double number_of =
        is_share ? number * static_cast<double>(images) * (1.0 + kRounding) : number;
    return static_cast<std::size_t>(number_of);
}

RunWatch terminal_watch(bool strict) {
    const auto line = std::make_shared<ProgressOfParts>();
    return {.progress = [line](std::string_view what, double share) { line->show(what, share); },
            .skipped =
                [line](const Skipped& one) {
                    line->wipe();
                    warn("{}: {}; skipped", one.image, one.why);
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
        say("colours within {:.1f} CIELAB units in the mean of {}, {:.1f} at most ({})\n",
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
    say("  doubtful pixels:");
    for (const auto& [name, bit] : kDoubts) {
        say(" {} {:.3g} %", name, kPercent * outcome.doubtful_share(name));
    }
    say("\n");
}

ExitStatus status_of_skips(std::size_t skipped, std::size_t images, const SurveyInput& input) {
    if (skipped == 0) return kDone;
    const std::size_t most = input.allowed_skips.of(images);
    warn(
        "{} of {} skipped; allowed: {} (--allow-skipped)", skipped, counted(images, "image"), most);
    return skipped <= most ? kDone : kAnswerIsNo;
}

}  // namespace aphotic::cli
