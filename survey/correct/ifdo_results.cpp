// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/ifdo_results.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/sha256.h"

#include <fmt/format.h>

#include <functional>
#include <map>
#include <set>
#include <system_error>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr const char* kCalibration = "image-photometric-calibration";

// The image's key in the navigation.
std::string item_key(const fs::path& image) {
    return without_extension(image.filename()).string();
}

IfdoJson calibration_of(const Survey& survey, const CorrectionReport& report, const Rig* rig) {
    const PerChannel& gain = report.gain.gain;
    const std::string light =
        rig != nullptr
            ? fmt::format(
                  "the light that the rig '{}' (SHA-256 {}) throws on a flat sea floor at the "
                  "image's altitude, pitch and roll",
                  rig->title,
                  rig->digest)
            : fmt::format("one map of the light (SHA-256 {})", survey.light.digest);
    IfdoJson json{
        {"photometric-exposure-factor-RGB", {gain[0], gain[1], gain[2]}},
        {"photometric-sequence-illumination-type", "constant artificial"},
        {"photometric-sequence-illumination-description",
         fmt::format("Each image was divided by {}, with aphotic {}.", light, APHOTIC_VERSION)},
        {"photometric-sequence-white-balancing",
         fmt::format("One factor for each channel, the same for all images{}.",
                     report.gain.images.empty() ? std::string()
                                                : fmt::format(", from the medians of {} of them",
                                                              report.gain.images.size()))}};
    if (rig != nullptr) {
        const Water& water = rig->water;
        json["photometric-water-properties-description"] = fmt::format(
            "Absorption '{}' times {:.6g}{}, divided out with the light.",
            water.absorption_per_m.short_name(),
            water.multiple,
            water.uniform_loss_per_m > 0.0
                ? fmt::format(" and {:.6g}/m at all wavelengths", water.uniform_loss_per_m)
                : "");
    }
    return json;
}

// Overwrites existing fields, also within an object.
void put(IfdoJson& fields, const std::string& key, const IfdoJson& value) {
    if (value.is_object() && fields.contains(key) && fields[key].is_object())
        fields[key].update(value);
    else
        fields[key] = value;
}

void forget_pixels(IfdoJson& fields) {
    for (auto field = fields.begin(); field != fields.end();) {
        const std::string& key = field.key();
        const bool is_of_pixels = key == "image-entropy" || key == "image-average-color" ||
                                  key.starts_with("image-mpeg7-");
        field = is_of_pixels ? fields.erase(field) : std::next(field);
    }
}

std::string text_at(const IfdoJson& fields, const char* key) {
    const auto found = fields.find(key);
    return found != fields.end() && found->is_string() ? found->get<std::string>() : "";
}

}  // namespace

std::string uuid_of(std::string_view text) {
    constexpr std::size_t kVersion = 12;  // where among the digits
    constexpr std::size_t kVariant = 16;
    std::string digits = sha256_of_text(text).substr(0, 32);
    digits[kVersion] = '4';
    // The variant is the bits 10, followed by two free ones.
    constexpr std::string_view kHex = "0123456789abcdef";
    digits[kVariant] = kHex[8 + kHex.find(digits[kVariant]) % 4];
    for (const std::size_t hyphen : {8U, 13U, 18U, 23U}) digits.insert(hyphen, 1, '-');
    return digits;
}

fs::path ifdo_place(const fs::path& source, const fs::path& folder) {
    fs::path place = folder / source.filename();
    std::error_code not_there;
    if (fs::equivalent(place, source, not_there)) {
        throw InputError("{}: would be overwritten by the iFDO of the results", source.string());
    }
    if (source.filename() == kCorrectionNotes || source.filename() == kBaselineNotes ||
        source.filename() == kJournal) {
        throw InputError(
            "--ifdo: found a file named {}; allowed: any other name, since the results' iFDO takes "
            "the name",
            source.filename().string());
    }
    return place;
}

namespace {

// For one kind of the files made from each image.
IfdoResults write_ifdo(const Ifdo& of_raw,
                       const fs::path& place,
                       const Survey& survey,
                       const CorrectionReport& report,
                       const IfdoJson& calibration,
                       const std::function<fs::path(const ImageFile&)>& result_of) {
    std::map<std::string, std::string> items;  // of_raw's, by image
    for (const auto& [name, item] : of_raw.items().items()) items.emplace(item_key(name), name);
    std::set<std::string> skipped;
    for (const Skipped& one : report.run->skipped) skipped.insert(one.image);

    const std::vector<std::pair<std::string, IfdoJson>> ours{
        {"image-quality", "processed"},
        {"image-illumination", "artificial light"},
        {kCalibration, calibration}};
    IfdoResults made{.file = place};
    IfdoJson results = IfdoJson::object();
    std::string all_hashes;
    for (const ImageFile& file : survey.files) {
        if (skipped.contains(file.source.string())) continue;
        const fs::path result = result_of(file);
        const auto known = items.find(item_key(file.source));
        if (known == items.end() || still_image(of_raw.items().at(known->second)) == nullptr ||
            results.contains(result.filename().string())) {
            made.without_item.push_back(file.source.string());
            continue;
        }
        IfdoJson item = of_raw.items().at(known->second);
        IfdoJson& fields = item.is_array() ? item[0] : item;
        const std::string hash = sha256_of_file(result);
        fields["image-uuid"] = uuid_of(text_at(fields, "image-uuid") + "\n" + hash);
        fields["image-hash-sha256"] = hash;
        forget_pixels(fields);
        for (const auto& [key, value] : ours) {
            if (fields.contains(key)) put(fields, key, value);
        }
        results[result.filename().string()] = std::move(item);
        all_hashes += hash;
        ++made.images;
    }
    if (made.images == 0) {
        throw InputError("{}: has no item for any of the {} images that were corrected",
                         of_raw.source,
                         made.without_item.size());
    }
    Ifdo of_results{.source = place.string(), .is_yaml = of_raw.is_yaml, .set = of_raw.set};
    IfdoJson& header = of_results.set["image-set-header"];
    forget_pixels(header);
    for (const auto& [key, value] : ours) put(header, key, value);
    header["image-set-uuid"] = uuid_of(text_at(header, "image-set-uuid") + "\n" + all_hashes);
    header["image-set-local-path"] = ".";
    of_results.set["image-set-items"] = std::move(results);
    write_text_file(place, ifdo_text(of_results));
    return made;
}

}  // namespace

IfdoResults write_ifdo_of_results(const Ifdo& of_raw,
                                  const fs::path& place,
                                  const Survey& survey,
                                  const CorrectionOptions& options,
                                  const CorrectionReport& report,
                                  const Rig* rig) {
    const IfdoJson calibration = calibration_of(survey, report, rig);
    const fs::path& folder = options.run.folder;
    const ResultFormat& format = options.run.format;
    if (format.srgb) {
        write_ifdo(of_raw,
                   folder / kSrgbFolder / place.filename(),
                   survey,
                   report,
                   calibration,
                   [&](const auto& file) { return folder / srgb_file_of(file, *format.srgb); });
    }
    return write_ifdo(of_raw, place, survey, report, calibration, [&](const auto& file) {
        return folder / results_of(file, format).front();
    });
}

}  // namespace aphotic
