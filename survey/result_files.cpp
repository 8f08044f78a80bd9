// SPDX-License-Identifier: BSD-3-Clause
#include "survey/result_files.h"

#include "base/atomic_file.h"

#include <algorithm>
#include <iterator>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

fs::path image_of(const ImageFile& file, const ResultFormat& format) {
    return file.name.string() + (format.format == "tiff" ? ".tif" : "." + format.format);
}

fs::path mask_of(const ImageFile& file) {
    return file.name.string() + ".mask.png";
}

// Samples that the format cannot hold are marked; the writer clips them.
void mark_clipped(CorrectedImage& result) {
    const std::size_t pixels = result.doubts.size();
    for (std::size_t first = 0; first < result.image.samples.size(); first += pixels) {
        for (std::size_t i = 0; i < pixels; ++i) {
            const float sample = result.image.samples[first + i];
            const bool is_clipped = sample < 0.0F || sample > 1.0F;
            result.doubts[i] |= is_clipped ? kClipped : std::uint8_t{0};
        }
    }
}

Counts doubts_in(const std::vector<std::uint8_t>& doubts) {
    Counts counts;
    for (const auto& [name, bit] : kDoubts) {
        counts[std::string(name)] = static_cast<double>(
            std::ranges::count_if(doubts, [bit = bit](std::uint8_t d) { return (d & bit) != 0; }));
    }
    return counts;
}

std::vector<std::string> channel_names(const RawImage& image) {
    if (image.mosaic != Mosaic::None) return {"Y"};
    return {kChannelNames.begin(), kChannelNames.end()};
}

int zip_level(Compression compression) {
    constexpr int kUsual = 6;
    if (compression == Compression::None) return 0;
    return compression == Compression::Small ? kUsual : ExrWriter::kFastestZip;
}

void write_exr(const fs::path& file,
               const RawImage& image,
               const SurveyImage& source,
               Compression compression,
               ExrAttributes attributes) {
    attributes.emplace_back("aphotic:version", APHOTIC_VERSION);
    if (!source.description.empty()) attributes.emplace_back("comments", source.description);
    if (!source.date_time.empty()) attributes.emplace_back("capDate", source.date_time);
    if (source.tags) std::ranges::copy(words_of(*source.tags), std::back_inserter(attributes));
    ExrWriter writer(file,
                     image.width_px,
                     image.height_px,
                     channel_names(image),
                     attributes,
                     zip_level(compression));
    writer.write_rows(image.height_px, image.samples);
    writer.finish();
}

void write_mask(const fs::path& file, const CorrectedImage& result, Compression compression) {
    constexpr float kByte = 255.0F;
    std::vector<float> plane(result.doubts.size());
    std::ranges::transform(result.doubts, plane.begin(), [](std::uint8_t doubt) {
        return static_cast<float>(doubt) / kByte;
    });
    write_any_image(file,
                    {.width_px = result.image.width_px,
                     .height_px = result.image.height_px,
                     .channels = {"Y"},
                     .planes = plane,
                     .type = SampleType::Bits8,
                     .compression = compression});
}

}  // namespace

std::string name_of(Compression compression) {
    return std::ranges::find(kCompressions, compression, [](const auto& c) { return c.second; })
        ->first;
}

std::vector<fs::path> results_of(const ImageFile& file, const ResultFormat& format) {
    std::vector<fs::path> files{image_of(file, format)};
    if (format.mask) files.push_back(mask_of(file));
    if (format.srgb) files.push_back(srgb_file_of(file, *format.srgb));
    return files;
}

Counts write_results(const fs::path& folder,
                     const ImageFile& file,
                     CorrectedImage result,
                     const SurveyImage& source,
                     const ResultFormat& format,
                     const ExrAttributes& more) {
    const fs::path image = folder / image_of(file, format);
    if (format.clips()) mark_clipped(result);
    make_folder(image.parent_path());
    if (format.mask) write_mask(folder / mask_of(file), result, format.compression);
    if (format.format == "exr") {
        write_exr(image, result.image, source, format.compression, more);
    } else {
        write_any_image(image,
                        {.width_px = result.image.width_px,
                         .height_px = result.image.height_px,
                         .channels = channel_names(result.image),
                         .planes = result.image.samples,
                         .type = SampleType::Bits16,
                         .compression = format.compression,
                         .description = source.description,
                         .date_time = source.date_time,
                         .tags = source.tags});
    }
    return doubts_in(result.doubts);
}

}  // namespace aphotic
