// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/manifest.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/sha256.h"
#include "image/frame_check.h"
#include "image/image_size.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;  // as a reader of the file would like it

namespace {

constexpr const char* kFormat = "aphotic-manifest-4";
// A thousand times what the manifest of 100 wavelengths takes.
constexpr std::size_t kMostManifestBytes = 64 * kMebibyte;

constexpr const char* kChecksum = "sha256";

// Titles are the user's: bytes that are no UTF-8 are replaced, not refused.
template <class AnyJson>
std::string text_of(const AnyJson& json) {
    constexpr int kIndent = 2;
    return json.dump(kIndent, ' ', false, AnyJson::error_handler_t::replace);
}

// Of all that the manifest holds beside it, in whatever order.
std::string checksum_of(Json json) {
    json.erase(kChecksum);
    return sha256_of_text(text_of(json));
}

// Reads keys of one JSON object, and says which one is wrong.
class Reader {
  public:
    Reader(const Json& object, std::string where) : object_(object), where_(std::move(where)) {
        if (!object.is_object()) fail("", "an object");
    }

    [[nodiscard]] const Json& at(const std::string& key, std::string_view allowed) const {
        if (!object_.contains(key)) fail(key, allowed);
        return object_.at(key);
    }

    [[nodiscard]] std::string text(const std::string& key) const {
        const Json& value = at(key, "a text");
        if (!value.is_string()) fail(key, "a text");
        return value.get<std::string>();
    }

    [[nodiscard]] int integer(const std::string& key, int least, int most) const {
        const std::string allowed = fmt::format("a whole number from {} to {}", least, most);
        const Json& value = at(key, allowed);
        if (!is_whole_number(value, least, most)) fail(key, allowed);
        return value.get<int>();
    }

    [[nodiscard]] double number(const std::string& key) const {
        const Json& value = at(key, "a number");
        if (!value.is_number()) fail(key, "a number");
        return value.get<double>();
    }

    [[nodiscard]] std::vector<double> numbers(
        const std::string& key, std::string_view allowed = "a list of numbers") const {
        const Json& value = at(key, allowed);
        const auto is_number = [](const Json& item) { return item.is_number(); };
        if (!value.is_array() || !std::all_of(value.begin(), value.end(), is_number)) {
            fail(key, allowed);
        }
        return value.get<std::vector<double>>();
    }

    [[nodiscard]] std::array<double, kChannels> channels(const std::string& key) const {
        constexpr std::string_view kAllowed = "three numbers";
        const std::vector<double> values = numbers(key, kAllowed);
        if (values.size() != kChannels) fail(key, kAllowed);
        return {values[0], values[1], values[2]};
    }

    [[nodiscard]] std::map<std::string, std::string> texts(const std::string& key) const {
        const Json& value = at(key, "an object of texts");
        const auto is_text = [](const Json& item) { return item.is_string(); };
        if (!value.is_object() || !std::all_of(value.begin(), value.end(), is_text)) {
            fail(key, "an object of texts");
        }
        return value.get<std::map<std::string, std::string>>();
    }

    [[nodiscard]] bool has(const std::string& key) const { return object_.contains(key); }

    [[nodiscard]] Reader object(const std::string& key) const {
        const Json& value = at(key, "an object");
        if (!value.is_object()) fail(key, "an object");
        return {value, fmt::format("{}: {}", where_, key)};
    }

    [[nodiscard]] std::vector<std::string> list_of_texts(const std::string& key) const {
        const Json& value = at(key, "a list of texts");
        const auto is_text = [](const Json& item) { return item.is_string(); };
        if (!value.is_array() || !std::all_of(value.begin(), value.end(), is_text)) {
            fail(key, "a list of texts");
        }
        return value.get<std::vector<std::string>>();
    }

    [[nodiscard]] std::vector<Reader> objects(const std::string& key) const {
        const Json& value = at(key, "a list of objects");
        if (!value.is_array()) fail(key, "a list of objects");
        std::vector<Reader> all;
        for (const Json& item : value) {
            all.emplace_back(item, fmt::format("{}: {}[{}]", where_, key, all.size()));
        }
        return all;
    }

    [[noreturn]] void fail(const std::string& key, std::string_view allowed) const {
        const std::string found = key.empty()             ? object_.dump()
                                  : object_.contains(key) ? object_.at(key).dump()
                                                          : "nothing";
        throw InputError(fmt::format("{}: {}: found {}; allowed: {}",
                                     where_,
                                     key.empty() ? "value" : key,
                                     found.substr(0, 80),
                                     allowed));
    }

  private:
    const Json& object_;
    std::string where_;
};

// A frame's name becomes a file's name: nothing in it may lead out of the folder.
bool is_plain_name(std::string_view name) {
    const auto is_plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '.' || c == '-';
    };
    return !name.empty() && name.front() != '.' && std::all_of(name.begin(), name.end(), is_plain);
}

ManifestFrame frame_of(const Reader& reader) {
    ManifestFrame frame{.name = reader.text("name"),
                        .scene_sha256 = reader.text("scene_sha256"),
                        .image_sha256 = ""};
    if (!is_plain_name(frame.name)) {
        reader.fail("name", "letters, digits, '_', '-' and '.', not first");
    }
    const std::string state = reader.text("state");
    if (state != "done" && state != "pending") reader.fail("state", "\"done\" or \"pending\"");
    if (state == "done") frame.image_sha256 = reader.text("image_sha256");
    if (state == "done" && !frame.done()) reader.fail("image_sha256", "a checksum");
    return frame;
}

ManifestScene scene_of(const Reader& reader) {
    ManifestScene scene{.file = reader.text("file"),
                        .sha256 = reader.text("sha256"),
                        .materials = reader.list_of_texts("materials"),
                        .shortest_path_m = reader.number("shortest_path_m"),
                        .longest_path_m = reader.number("longest_path_m")};
    if (!(scene.shortest_path_m > 0.0)) reader.fail("shortest_path_m", "a number over 0");
    if (!(scene.longest_path_m >= scene.shortest_path_m)) {
        reader.fail("longest_path_m", "a number not under shortest_path_m");
    }
    return scene;
}

// The frames by their names, and whose channels are taken: a manifest may name thousands.
struct FrameBook {
    std::map<std::string, std::size_t> index;
    std::set<std::pair<std::size_t, std::string>> taken;
};

ManifestWavelength wavelength_of(const Reader& reader, double previous_nm, FrameBook& frames) {
    ManifestWavelength w;
    w.lambda_nm = reader.number("lambda_nm");
    if (!(w.lambda_nm > previous_nm)) reader.fail("lambda_nm", "increasing wavelengths over 0");
    w.weight = reader.channels("weight");
    w.exposure_log2 = reader.integer("exposure_log2", -kMostExposureLog2, kMostExposureLog2);
    w.channel = reader.text("channel");
    if (w.channel != "R" && w.channel != "G" && w.channel != "B") {
        reader.fail("channel", "\"R\", \"G\" or \"B\"");
    }
    w.radiance_bound = reader.number("radiance_bound");
    if (!(w.radiance_bound >= 0.0)) reader.fail("radiance_bound", "0 or more");
    w.index_nm = reader.number("index_nm");
    w.attenuation_per_m = reader.number("attenuation_per_m");
    w.flux = reader.numbers("flux");
    w.reflectance = reader.numbers("reflectance");
    const auto found = frames.index.find(reader.text("frame"));
    if (found == frames.index.end()) reader.fail("frame", "the name of one of the frames");
    w.frame = found->second;
    if (!frames.taken.emplace(w.frame, w.channel).second) {
        reader.fail("channel", "a channel of the frame that no other wavelength has");
    }
    return w;
}

}  // namespace

double Manifest::black(std::size_t channel) const {
    constexpr double kRoom = 64.0;
    double sum = 0.0;
    for (const ManifestWavelength& w : wavelengths) {
        sum += std::ldexp(std::abs(w.weight[channel]), kSmallestNormalHalfLog2 - w.exposure_log2);
    }
    return kRoom * sum;
}

fs::path manifest_path(const fs::path& folder) {
    return folder / "manifest.json";
}

fs::path scene_path(const fs::path& folder, const ManifestFrame& frame) {
    return folder / "povray" / (frame.name + ".pov");
}

fs::path log_path(const fs::path& folder, const ManifestFrame& frame) {
    return folder / "povray" / "logs" / (frame.name + ".log");
}

fs::path image_path(const fs::path& folder, const ManifestFrame& frame) {
    return folder / "povray" / "frames" / (frame.name + ".exr");
}

void write_manifest(const fs::path& folder, const Manifest& manifest) {
    OrderedJson json;
    json["format"] = kFormat;
    json["aphotic_version"] = manifest.aphotic_version;
    json["povray_version"] = manifest.povray_version;
    json["rig_title"] = manifest.rig_title;
    json["rig_sha256"] = manifest.rig_sha256;
    json["width_px"] = manifest.width_px;
    json["height_px"] = manifest.height_px;
    json["lamp_signal"] = manifest.lamp_signal;
    json["method"] = manifest.method;
    json["tolerance"] = manifest.tolerance;
    json["frame_error"] = manifest.frame_error;
    if (manifest.no_promise.empty()) {
        json["error"] = OrderedJson::array();
        json["amplification"] = OrderedJson::array();
        for (std::size_t c = 0; c < kChannels; ++c) {
            json["error"].push_back(manifest.quality[c].error);
            json["amplification"].push_back(manifest.quality[c].amplification);
        }
    } else {
        json["no_promise"] = manifest.no_promise;
    }
    json["geometry"] = manifest.geometry;
    if (manifest.scene) {
        json["scene"] = {{"file", manifest.scene->file},
                         {"sha256", manifest.scene->sha256},
                         {"materials", manifest.scene->materials},
                         {"shortest_path_m", manifest.scene->shortest_path_m},
                         {"longest_path_m", manifest.scene->longest_path_m}};
    }
    json["frames"] = OrderedJson::array();
    for (const ManifestFrame& frame : manifest.frames) {
        json["frames"].push_back({{"name", frame.name},
                                  {"state", frame.done() ? "done" : "pending"},
                                  {"scene_sha256", frame.scene_sha256},
                                  {"image_sha256", frame.image_sha256}});
    }
    json["wavelengths"] = OrderedJson::array();
    for (const ManifestWavelength& w : manifest.wavelengths) {
        json["wavelengths"].push_back({{"lambda_nm", w.lambda_nm},
                                       {"weight", w.weight},
                                       {"frame", manifest.frames[w.frame].name},
                                       {"channel", w.channel},
                                       {"exposure_log2", w.exposure_log2},
                                       {"radiance_bound", w.radiance_bound},
                                       {"index_nm", w.index_nm},
                                       {"attenuation_per_m", w.attenuation_per_m},
                                       {"flux", w.flux},
                                       {"reflectance", w.reflectance}});
    }
    json[kChecksum] = checksum_of(Json::parse(text_of(json)));
    write_text_file(manifest_path(folder), text_of(json) + "\n");
}

Manifest read_manifest(const fs::path& folder) {
    const fs::path file = manifest_path(folder);
    const std::string text = read_text_file(file, kMostManifestBytes);
    Manifest manifest = parse_manifest(file.string(), text);
    const Json json = parse_json(text, file.string());
    if (Reader(json, file.string()).text(kChecksum) != checksum_of(json)) {
        throw InputError(fmt::format(
            "{}: {}: is not that of the rest, which was changed since it was written; allowed: a "
            "manifest as aphotic wrote it",
            file.string(),
            kChecksum));
    }
    return manifest;
}

Manifest parse_manifest(const std::string& file_name, std::string_view text) {
    const Json json = parse_json(text, file_name);
    const Reader reader(json, file_name);
    if (reader.text("format") != kFormat) reader.fail("format", fmt::format("\"{}\"", kFormat));

    Manifest manifest;
    manifest.aphotic_version = reader.text("aphotic_version");
    manifest.povray_version = reader.text("povray_version");
    manifest.rig_title = reader.text("rig_title");
    manifest.rig_sha256 = reader.text("rig_sha256");
    manifest.width_px = reader.integer("width_px", 1, kLargestImagePx);
    manifest.height_px = reader.integer("height_px", 1, kLargestImagePx);
    manifest.lamp_signal = reader.channels("lamp_signal");
    manifest.method = reader.text("method");
    manifest.tolerance = reader.number("tolerance");
    manifest.frame_error = reader.number("frame_error");
    if (reader.has("no_promise")) {
        manifest.no_promise = reader.list_of_texts("no_promise");
        if (manifest.no_promise.empty()) reader.fail("no_promise", "at least one reason");
    } else {
        const auto error = reader.channels("error");
        const auto amplification = reader.channels("amplification");
        for (std::size_t c = 0; c < kChannels; ++c) {
            manifest.quality[c] = {.error = error[c], .amplification = amplification[c]};
        }
    }
    manifest.geometry = reader.texts("geometry");
    if (reader.has("scene")) manifest.scene = scene_of(reader.object("scene"));
    FrameBook frames;
    for (const Reader& frame : reader.objects("frames")) {
        manifest.frames.push_back(frame_of(frame));
        if (!frames.index.emplace(manifest.frames.back().name, frames.index.size()).second) {
            frame.fail("name", "a name that no other frame has");
        }
    }
    double previous_nm = 0.0;
    for (const Reader& w : reader.objects("wavelengths")) {
        manifest.wavelengths.push_back(wavelength_of(w, previous_nm, frames));
        previous_nm = manifest.wavelengths.back().lambda_nm;
    }
    if (manifest.wavelengths.empty()) reader.fail("wavelengths", "at least one");
    return manifest;
}

}  // namespace aphotic
