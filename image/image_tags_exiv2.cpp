// SPDX-License-Identifier: BSD-3-Clause
//
// The part of the command that links Exiv2; see image_tags.h.
#include "image/decoded_size.h"
#include "image/image_tags.h"

#include <exiv2/exiv2.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace aphotic {

struct ImageTags {
    Exiv2::ExifData exif;
    Exiv2::IptcData iptc;
    Exiv2::XmpData xmp;
    ShotExposure exposure;

    // Except the description and time, which every image has (any_image.h).
    [[nodiscard]] bool is_empty() const {
        const auto is_of_any = [](const Exiv2::Exifdatum& datum) {
            return datum.key() == "Exif.Image.ImageDescription" ||
                   datum.key() == "Exif.Image.DateTime";
        };
        return std::all_of(exif.begin(), exif.end(), is_of_any) && iptc.empty() && xmp.empty();
    }
};

namespace {

// Adobe's part of the library is not thread-safe.
void lock_or_unlock(void* mutex, bool lock) {
    auto& known = *static_cast<std::recursive_mutex*>(mutex);
    if (lock) {
        known.lock();
    } else {
        known.unlock();
    }
}

void make_ready() {
    static std::recursive_mutex mutex;
    static const bool kIsReady = [] {
        Exiv2::LogMsg::setLevel(Exiv2::LogMsg::mute);
        return Exiv2::XmpParser::initialize(lock_or_unlock, &mutex);
    }();
    static_cast<void>(kIsReady);
}

// The tags of a file's first directory that describe the camera and the picture; all others
// describe the pixels.
const std::set<std::uint16_t> kOfThePicture{
    0x010e,  // ImageDescription
    0x010f,  // Make
    0x0110,  // Model
    0x0112,  // Orientation
    0x0132,  // DateTime
    0x013b,  // Artist
    0x013c,  // HostComputer
    0x4746,  // Rating
    0x8298,  // Copyright
    0x829a,  // ExposureTime, in raw files of TIFF/EP
    0x829d,  // FNumber
    0x8827,  // ISOSpeedRatings
    0x9003,  // DateTimeOriginal
    0x920a,  // FocalLength
    0xc614,  // UniqueCameraModel
    0xc62f,  // CameraSerialNumber
};

const std::set<std::uint16_t> kOfThePixels{
    0x9101,  // ComponentsConfiguration
    0x9102,  // CompressedBitsPerPixel
    0x927c,  // MakerNote
    0xa001,  // ColorSpace
    0xa002,  // PixelXDimension
    0xa003,  // PixelYDimension
    0xa005,  // InteroperabilityTag
    0xa302,  // CFAPattern
    0xa500,  // Gamma
};

bool stays_true(const Exiv2::Exifdatum& datum) {
    const std::string group = datum.groupName();
    if (group == "Image") return kOfThePicture.contains(datum.tag());
    return group == "GPSInfo" || (group == "Photo" && !kOfThePixels.contains(datum.tag()));
}

bool stays_true(const Exiv2::Xmpdatum& datum) {
    static const std::regex kOfPixels(
        "Xmp\\.tiff\\.(Image(Width|Length)|BitsPerSample|Compression|Photometric|SamplesPerPixel|"
        "PlanarConfiguration|YCbCr).*|Xmp\\.exif\\.(Pixel[XY]Dimension|ColorSpace).*|"
        "Xmp\\.xmp\\.Thumbnails.*");
    return !std::regex_match(datum.key(), kOfPixels);
}

using FindExif = Exiv2::ExifData::const_iterator (*)(const Exiv2::ExifData&);

std::optional<double> number_of(const Exiv2::ExifData& exif, FindExif find) {
    const auto found = find(exif);
    if (found == exif.end() || found->count() == 0) return std::nullopt;
    const auto [above, below] = found->toRational();
    const double number = static_cast<double>(above) / below;
    if (!(std::isfinite(number) && number > 0.0)) return std::nullopt;
    return number;
}

// Larger numbers do not fit into Exif's own tag, which then has this value.
constexpr double kTooLargeIso = 65535.0;

ShotExposure exposure_in(const Exiv2::ExifData& exif) {
    ShotExposure exposure{.time_s = number_of(exif, Exiv2::exposureTime),
                          .iso = number_of(exif, Exiv2::isoSpeed),
                          .f_number = number_of(exif, Exiv2::fNumber)};
    if (exposure.iso == kTooLargeIso) exposure.iso.reset();
    return exposure;
}

Exiv2::URational fraction(double number, std::uint32_t below) {
    return {static_cast<std::uint32_t>(std::llround(number * below)), below};
}

void add_iso(Exiv2::ExifData& exif, double number) {
    if (number < kTooLargeIso) {
        exif["Exif.Photo.ISOSpeedRatings"] = static_cast<std::uint16_t>(std::lround(number));
        return;
    }
    constexpr std::uint16_t kIsTheRecommendedIndex = 2;
    exif["Exif.Photo.ISOSpeedRatings"] = static_cast<std::uint16_t>(kTooLargeIso);
    exif["Exif.Photo.SensitivityType"] = kIsTheRecommendedIndex;
    exif["Exif.Photo.RecommendedExposureIndex"] = static_cast<std::uint32_t>(std::lround(number));
}

std::unique_ptr<Exiv2::Image> tagged(const std::filesystem::path& file) {
    make_ready();
    std::unique_ptr<Exiv2::Image> image(Exiv2::ImageFactory::open(file.string()).release());
    image->readMetadata();
    return image;
}

void put(const ImageTags& tags, Exiv2::Image& image) {
    for (const Exiv2::Exifdatum& datum : tags.exif) {
        image.exifData()[datum.key()].setValue(&datum.value());
    }
    for (const Exiv2::Xmpdatum& datum : tags.xmp) {
        image.xmpData()[datum.key()].setValue(&datum.value());
    }
    image.setIptcData(tags.iptc);
}

}  // namespace
}  // namespace aphotic

extern "C" void aphotic_read_image_tags(const std::filesystem::path& file,
                                        aphotic::SharedTags& tags) {
    using namespace aphotic;
    try {
        if (std::filesystem::file_size(file) > kMostOfNotes_bytes) return;
        const std::unique_ptr<Exiv2::Image> image = tagged(file);
        auto read = std::make_shared<ImageTags>();
        for (const Exiv2::Exifdatum& datum : image->exifData()) {
            if (stays_true(datum)) read->exif.add(datum);
        }
        for (const Exiv2::Xmpdatum& datum : image->xmpData()) {
            if (stays_true(datum)) read->xmp.add(datum);
        }
        read->iptc = image->iptcData();
        read->exposure = exposure_in(image->exifData());
        if (!read->is_empty()) tags = std::move(read);
    } catch (const std::exception&) {
        // An unknown format, or damaged tags: the pixels are usable without them.
    }
}

// The reason why tags could not be added, or empty.
static std::string tagged(std::vector<unsigned char>& bytes,
                          const aphotic::ImageTags* tags,
                          bool is_srgb) {
    using namespace aphotic;
    try {
        make_ready();
        const std::unique_ptr<Exiv2::Image> image(
            Exiv2::ImageFactory::open(bytes.data(), static_cast<long>(bytes.size())).release());
        image->readMetadata();
        if (tags != nullptr) put(*tags, *image);
        if (is_srgb) image->exifData()["Exif.Photo.ColorSpace"] = std::uint16_t{1};
        image->writeMetadata();
        Exiv2::BasicIo& made = image->io();
        if (made.open() != 0) return "no data";
        bytes.resize(static_cast<std::size_t>(made.size()));
        std::copy_n(made.mmap(), bytes.size(), bytes.begin());
        return "";
    } catch (const std::exception& error) {
        return error.what();
    }
}

extern "C" void aphotic_add_image_tags(std::vector<unsigned char>& bytes,
                                       const aphotic::ImageTags* tags,
                                       bool is_srgb,
                                       std::string& fault) {
    fault = tagged(bytes, tags, is_srgb);
}

extern "C" void aphotic_words_of_tags(const aphotic::ImageTags& tags,
                                      std::vector<std::pair<std::string, std::string>>& words) {
    const auto add = [&](const auto& data) {
        for (const auto& datum : data) words.emplace_back(datum.key(), datum.toString());
    };
    add(tags.exif);
    add(tags.iptc);
    add(tags.xmp);
}

extern "C" void aphotic_exposure_of_tags(const aphotic::ImageTags& tags,
                                         aphotic::ShotExposure& exposure) {
    exposure = tags.exposure;
}

extern "C" void aphotic_tags_of_shot(const aphotic::ShotExposure& exposure,
                                     const std::string& taken_at,
                                     aphotic::SharedTags& tags) {
    using namespace aphotic;
    constexpr std::uint32_t kNanoseconds = 1'000'000'000;
    constexpr std::uint32_t kMillionths = 1'000'000;
    auto made = std::make_shared<ImageTags>();
    if (const auto time_s = exposure.time_s)
        made->exif["Exif.Photo.ExposureTime"] =
            fraction(*time_s, *time_s < 1.0 ? kNanoseconds : kMillionths);
    if (exposure.f_number)
        made->exif["Exif.Photo.FNumber"] = fraction(*exposure.f_number, kMillionths);
    if (exposure.iso) add_iso(made->exif, *exposure.iso);
    if (!taken_at.empty()) {
        made->exif["Exif.Photo.DateTimeOriginal"] = taken_at;
        made->exif["Exif.Photo.OffsetTimeOriginal"] = "+00:00";
    }
    made->exposure = exposure_in(made->exif);
    tags = std::move(made);
}
