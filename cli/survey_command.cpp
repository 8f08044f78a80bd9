// SPDX-License-Identifier: BSD-3-Clause
#include "cli/survey_command.h"

#include "base/error.h"
#include "base/progress.h"
#include "base/words.h"
#include "cli/option_checks.h"
#include "cli/rig_file.h"
#include "cli/terminal.h"
#include "rig/rig_reader.h"
#include "survey/camera_of_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

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

void add_crop_options(CLI::App& app, CameraNumbers& camera) {
    auto* half = app.add_option_function<std::string>(
                        "--half",
                        [&camera](const std::string& name) {
                            camera.half = name == "left" ? Half::Left : Half::Right;
                        },
                        "Take the left or the right half of each file, which holds two cameras' "
                        "images side by side")
                     ->check(CLI::IsMember({"left", "right"}));
    const auto wrong = [](const std::string& text) {
        return crop_named(text)
                   ? ""
                   : fmt::format("found '{}'; allowed: X,Y,WIDTH,HEIGHT, whole numbers of pixels",
                                 text);
    };
    app.add_option_function<std::string>(
           "--crop",
           [&camera](const std::string& text) { camera.crop = crop_named(text); },
           "Take this part of each file, from column X and row Y of the top left, which are 0,0")
        ->check(CLI::Validator(wrong, ""))
        ->option_text("X,Y,WIDTH,HEIGHT")
        ->excludes(half);
}

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

}  // namespace

void add_images(CLI::App& app, std::vector<std::string>& images) {
    app.add_option("IMAGES",
                   images,
                   "Raw images, or folders of them: TIFF, PNG, EXR, JPEG, DNG, CR2, NEF, ARW")
        ->required();
}

void add_camera_options(CLI::App& app, CameraNumbers& camera) {
    const auto wrong = [](const std::string& name) {
        return mosaic_named(name)
                   ? ""
                   : fmt::format("found '{}'; allowed: RGGB, BGGR, GRBG, GBRG, mono", name);
    };
    app.add_option_function<std::string>(
           "--bayer",
           [&camera](const std::string& name) { camera.mosaic = mosaic_named(name); },
           "The images are mosaics, named after the four pixels at the file's top left: RGGB, "
           "BGGR, GRBG or GBRG; or mono, of a mono camera")
        ->check(CLI::Validator(wrong, "PATTERN"));
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
}

void add_white_level_option(CLI::App& app, CameraNumbers& camera) {
    app.add_option("--white-level",
                   camera.white_level,
                   "The camera's number at saturation, such as 4095; by default the largest of the "
                   "file's integer type");
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

void add_survey_rig(CLI::App& app, std::string& rig) {
    app.add_option(
           "--rig",
           rig,
           "Take from this rig what is not given of the camera: its pattern, levels, exposure, and "
           "its place on the vehicle")
        ->type_name("RIG");
}

CameraNumbers camera_of(const CameraNumbers& said,
                        const std::vector<ImageFile>& files,
                        const Camera* rig) {
    CameraNumbers camera = rig != nullptr ? with_rig(said, *rig) : said;
    camera = with_reference(camera, files);
    return expecting_usual_size(camera, files);  // a crop that no image has is one mistake
}

CameraNumbers camera_of(const CameraNumbers& said,
                        const std::vector<ImageFile>& files,
                        const std::string& rig,
                        bool strict) {
    if (rig.empty()) return camera_of(said, files, nullptr);
    const Camera camera = read_plausible_rig(rig, strict).camera;
    return camera_of(said, files, &camera);
}

void print_camera(const CameraNumbers& camera) {
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

}  // namespace aphotic::cli
