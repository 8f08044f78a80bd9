// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/contact_sheet.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "image/any_image.h"
#include "image/preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

struct Pair {
    const ImageFile* file = nullptr;
    RawImage before;  // small, less the black level
    RawImage after;
};

std::vector<const ImageFile*> chosen(const Survey& survey, const RunOutcome& run) {
    std::set<std::string> skipped;
    for (const Skipped& one : run.skipped) skipped.insert(one.image);
    std::vector<const ImageFile*> made;
    for (const ImageFile& file : survey.files) {
        if (!skipped.contains(file.source.string())) made.push_back(&file);
    }
    const std::size_t count = std::min(made.size(), kMostOnSheet);
    std::vector<const ImageFile*> spread;
    for (std::size_t i = 0; i < count; ++i) spread.push_back(made[i * made.size() / count]);
    return spread;
}

// R, G and B, or the one plane of a mono camera; small.
RawImage small(RawImage image) {
    const bool is_mono = image.mosaic == Mosaic::Mono;
    if (is_bayer(image.mosaic)) {
        image.samples = demosaiced(image.samples, image.width_px, image.height_px, image.mosaic);
    }
    const PlaneSize from{image.width_px, image.height_px};
    const int longer = std::max(from.width_px, from.height_px);
    const auto shrunk = [&](int side) {
        return longer <= kSheetPicture_px ? side : std::max(1, side * kSheetPicture_px / longer);
    };
    const PlaneSize to{shrunk(from.width_px), shrunk(from.height_px)};
    RawImage result{.width_px = to.width_px,
                    .height_px = to.height_px,
                    .mosaic = is_mono ? Mosaic::Mono : Mosaic::None,
                    .samples = {}};
    const auto pixels = static_cast<std::ptrdiff_t>(image.pixels());
    for (auto first = image.samples.begin(); first != image.samples.end(); first += pixels) {
        const std::vector<float> plane = resized({first, first + pixels}, from, to, "box");
        result.samples.insert(result.samples.end(), plane.begin(), plane.end());
    }
    return result;
}

// Integer samples are scaled to 0 to 1.
RawImage result_of(const ImageFile& file, Mosaic taken, const CorrectionOptions& options) {
    const fs::path written = options.run.folder / results_of(file, options.run.format).front();
    CameraNumbers numbers;
    numbers.mosaic = taken == Mosaic::Mono || options.keep_mosaic ? taken : Mosaic::None;
    SurveyImage result = read_survey_image(written, numbers);
    if (options.run.format.clips()) {
        for (float& sample : result.raw.samples) sample /= result.levels.white;
    }
    return std::move(result.raw);
}

float exposure_of(const std::vector<Pair>& pairs) {
    std::vector<float> all;
    for (const Pair& pair : pairs) {
        all.insert(all.end(), pair.before.samples.begin(), pair.before.samples.end());
    }
    if (all.empty()) return 1.0F;
    const auto bright = all.begin() + static_cast<std::ptrdiff_t>(
                                          kBrightShare * static_cast<double>(all.size() - 1));
    std::ranges::nth_element(all, bright);
    return *bright > 0.0F ? static_cast<float>(kBrightLevel) / *bright : 1.0F;
}

// The library only writes files.
PagePicture picture_of(const RawImage& image,
                       const Eigen::Matrix3d& matrix,
                       const fs::path& folder,
                       std::string words) {
    constexpr int kQuality = 85;
    const std::vector<float> planes = srgb_planes(image, matrix);
    const AtomicFile scratch(folder / "thumbnail.jpg");
    write_any_image(scratch.temporary(),
                    {.width_px = image.width_px,
                     .height_px = image.height_px,
                     .channels = shown_channels(image),
                     .planes = planes,
                     .type = SampleType::Bits8,
                     .is_srgb = true,
                     .jpeg_quality = kQuality});
    return {.bytes = read_text_file(scratch.temporary()),
            .width_px = image.width_px,
            .height_px = image.height_px,
            .words = std::move(words),
            .type = kJpeg};
}

}  // namespace

PageFigures contact_sheet(const Survey& survey,
                          const CorrectionOptions& options,
                          const CorrectionReport& report) {
    const std::vector<const ImageFile*> files = chosen(survey, *report.run);
    const Mosaic mosaic = mosaic_of(report.looks);
    std::vector<Pair> pairs(files.size());
    parallel_for(files.size(), options.run.jobs, [&](std::size_t i, std::size_t) {
        try {
            SurveyImage taken = read_survey_image(files[i]->source, survey.camera);
            take_off_black(taken);
            pairs[i] = {.file = files[i],
                        .before = small(std::move(taken.raw)),
                        .after = small(result_of(*files[i], mosaic, options))};
        } catch (const InputError&) {
            pairs[i] = {};  // removed since
        }
    });
    std::erase_if(pairs, [](const Pair& pair) { return pair.file == nullptr; });
    const Eigen::Matrix3d before = exposure_of(pairs) * Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d after = shown_as(survey, options, report.gain).matrix();
    PageFigures sheet{.figures = {}, .are_small = true};
    for (const Pair& pair : pairs) {
        PageFigure figure{.caption = named(pair.file->name.string())};
        if (survey.navigation)
            figure.caption +=
                fmt::format(", {:.2f}\xC2\xA0m", survey.sled_of(*pair.file).altitude_m);
        figure.pictures = {picture_of(pair.before, before, options.run.folder, "before"),
                           picture_of(pair.after, after, options.run.folder, "after")};
        sheet.figures.push_back(std::move(figure));
    }
    return sheet;
}

}  // namespace aphotic
