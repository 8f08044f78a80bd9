// SPDX-License-Identifier: BSD-3-Clause
#include "cli/survey_command.h"

#include "base/error.h"
#include "base/progress.h"
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
        ->check(CLI::Validator(wrong, "X,Y,WIDTH,HEIGHT"))
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
        ->transform(CLI::CheckedTransformer(kWays).description(""))
        ->type_name("none|exif|flash")
        ->default_str("none");
}

void add_white_level_option(CLI::App& app, CameraNumbers& camera) {
    app.add_option("--white-level",
                   camera.white_level,
                   "The camera's number at saturation, such as 4095; by default the largest of the "
                   "file's integer type");
}

void add_format_options(CLI::App& app, ResultFormat& format) {
    app.add_flag("--mask", format.mask, "Write NAME.mask.png beside each image");
    app.add_option(
           "--format", format.format, "Write tiff or png (16 bits, white 65535) or exr (floats)")
        ->check(CLI::IsMember({"tiff", "png", "exr"}))
        ->capture_default_str();
    app.add_option("--compression",
                   format.compression,
                   "Compress losslessly: none, fast, or small (a few per cent smaller, about 1.5 "
                   "times slower)")
        ->transform(CLI::CheckedTransformer(kCompressions).description(""))
        ->type_name("none|fast|small")
        ->default_str("fast");
}

void add_rig_of_camera(CLI::App& app, std::string& rig) {
    app.add_option(
           "--rig",
           rig,
           "Take what is not given of --bayer, levels and exposure from this rig's [camera]")
        ->type_name("RIG");
}

CameraNumbers camera_of(const CameraNumbers& said,
                        const std::vector<ImageFile>& files,
                        const Camera* rig) {
    CameraNumbers camera = rig != nullptr ? with_rig(said, *rig) : said;
    camera = with_reference(camera, files);
    static_cast<void>(usual_size(files, camera));  // a crop that no image has is one mistake
    return camera;
}

CameraNumbers camera_of(const CameraNumbers& said,
                        const std::vector<ImageFile>& files,
                        const std::string& rig) {
    if (rig.empty()) return camera_of(said, files, nullptr);
    const Camera camera = read_rig(rig).camera;
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
    if (!words.empty()) fmt::print("  camera: {}\n", fmt::join(words, ", "));
}

void add_strict_option(CLI::App& app, bool& strict) {
    app.add_flag("--strict", strict, "Treat warnings about the survey as errors");
}

RunWatch terminal_watch(bool strict) {
    const auto line = std::make_shared<ProgressOfParts>();
    return {
        .progress = [line](std::string_view what, double share) { line->show(what, share); },
        .skipped =
            [line](const Skipped& one) {
                line->wipe();
                fmt::print(stderr, "aphotic: {}: {}; skipped\n", one.image, one.why);
            },
        .looks_wrong =
            [line, strict](const std::vector<Suspicion>& found) {
                line->wipe();
                std::string all;
                for (const Suspicion& one : found) {
                    if (!strict) {
                        fmt::print(stderr, "aphotic: looks wrong: {}: {}\n", one.about, one.what);
                    }
                    all += fmt::format("{}{}: {}", all.empty() ? "" : "; ", one.about, one.what);
                }
                if (strict && !all.empty()) {
                    throw InputError("--strict: suspicious survey: " + all);
                }
            }};
}

void print_doubts(const RunOutcome& outcome) {
    constexpr double kPercent = 100.0;
    fmt::print("  doubtful pixels:");
    for (const auto& [name, bit] : kDoubts) {
        fmt::print(" {} {:.3g} %", name, kPercent * outcome.doubtful_share(name));
    }
    fmt::print("\n");
}

}  // namespace aphotic::cli
