// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/manifest.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/printable.h"
#include "base/sha256.h"
#include "image/image_size.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <set>
#include <span>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;  // keeps the order in which keys are written

namespace {

constexpr const char* kFormat = "aphotic-manifest-5";
// A thousand times the size of a manifest of 100 wavelengths.
constexpr std::size_t kMostManifestBytes = 64 * kMebibyte;

// A changed digit would still have the right type, and give an image with other weights under the
// same promise.
constexpr const char* kChecksum = "sha256";

// Titles come from the user: bytes that are not UTF-8 are replaced, not refused.
template <class AnyJson>
std::string text_of(const AnyJson& json) {
    constexpr int kIndent = 2;
    return json.dump(kIndent, ' ', false, AnyJson::error_handler_t::replace);
}

// The checksum of everything else in the manifest, whatever the order of its keys.
std::string checksum_of(Json json) {
    json.erase(kChecksum);
    return sha256_of_text(text_of(json));
}

// Writes the fields of one JSON object.
class Writer {
  public:
    explicit Writer(OrderedJson& object) : object_(object) { object_ = OrderedJson::object(); }

    template <typename T, typename... Limits>
    void operator()(const char* key, const T& value, Limits...) const {
        object_[key] = value;
    }
    void one_of(const char* key, std::size_t index, std::span<const std::string_view> names) const {
        object_[key] = names[index];
    }
    template <typename List, typename... Context>
    void list(const char* key, const List& items, Context&... context) const {
        OrderedJson& array = object_[key] = OrderedJson::array();
        for (const auto& item : items) {
            Writer writer(array.emplace_back());
            fields(writer, item, context...);
        }
    }
    template <typename T>
    void optional(const char* key, const std::optional<T>& value) const {
        if (!value) return;
        Writer writer(object_[key]);
        fields(writer, *value);
    }
    void require(const char*, std::string_view, bool) const {}

  private:
    OrderedJson& object_;
};

// The name of a value's JSON type.
template <typename T>
constexpr std::string_view kWords = "a list of numbers";
template <>
constexpr std::string_view kWords<std::string> = "a string";
template <>
constexpr std::string_view kWords<double> = "a number";
template <>
constexpr std::string_view kWords<bool> = "true or false";
template <>
constexpr std::string_view kWords<std::vector<std::string>> = "a list of strings";
template <>
constexpr std::string_view kWords<std::array<double, kChannels>> = "three numbers";
template <>
constexpr std::string_view kWords<std::map<std::string, std::string>> = "an object of strings";

// Reads the fields of one JSON object and reports which one is wrong.
class Reader {
  public:
    Reader(const Json& object, std::string where) : object_(object), where_(std::move(where)) {
        if (!object.is_object()) fail("", "an object");
    }

    template <typename T>
    void operator()(const std::string& key, T& value) const {
        const Json& found = at(key, kWords<T>);
        try {
            value = found.get<T>();
            if (Json(value).size() == found.size()) return;  // an array may hold more than ours
        } catch (const Json::type_error&) {
        } catch (const Json::out_of_range&) {
        }
        fail(key, kWords<T>);
    }
    template <typename T>
    void operator()(const std::string& key, T& value, int least, int most) const {
        const std::string allowed = fmt::format("a whole number from {} to {}", least, most);
        const Json& found = at(key, allowed);
        if (!is_whole_number(found, least, most)) fail(key, allowed);
        value = found.get<T>();
    }
    void one_of(const std::string& key,
                std::size_t& index,
                std::span<const std::string_view> names) const {
        std::string name;
        (*this)(key, name);
        index = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
        require(key, fmt::format("one of {}", fmt::join(names, ", ")), index < names.size());
    }
    template <typename T, typename... Context>
    void list(const std::string& key, std::vector<T>& items, Context&... context) const {
        const Json& found = at(key, "a list of objects");
        if (!found.is_array()) fail(key, "a list of objects");
        items.clear();
        for (const Json& item : found) {
            const Reader reader(item, fmt::format("{}: {}[{}]", where_, key, items.size()));
            fields(reader, items.emplace_back(), context...);
        }
    }
    template <typename T, std::size_t n>
    void list(const std::string& key, std::array<T, n>& items) const {
        std::vector<T> found;
        list(key, found);
        require(key, fmt::format("{} objects", n), found.size() == n);
        std::ranges::copy(found, items.begin());
    }
    template <typename T>
    void optional(const std::string& key, std::optional<T>& value) const {
        if (!object_.contains(key)) return;
        if (!object_.at(key).is_object()) fail(key, "an object");
        fields(Reader(object_.at(key), fmt::format("{}: {}", where_, key)), value.emplace());
    }
    void require(const std::string& key, std::string_view allowed, bool is_kept) const {
        if (!is_kept) fail(key, allowed);
    }

  private:
    [[nodiscard]] const Json& at(const std::string& key, std::string_view allowed) const {
        if (!object_.contains(key)) fail(key, allowed);
        return object_.at(key);
    }

    [[noreturn]] void fail(const std::string& key, std::string_view allowed) const {
        const std::string found = key.empty()             ? object_.dump()
                                  : object_.contains(key) ? object_.at(key).dump()
                                                          : "nothing";
        throw InputError("{}: {}: found {}; allowed: {}",
                         where_,
                         key.empty() ? "value" : key,
                         excerpt(found),
                         allowed);
    }

    const Json& object_;
    std::string where_;
};

// A frame's name becomes a file name, which must not lead out of the folder.
bool is_plain_name(std::string_view name) {
    const auto is_plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '.' || c == '-';
    };
    return !name.empty() && name.front() != '.' && std::all_of(name.begin(), name.end(), is_plain);
}

// --- The fields, each declared once, to be written and read ------------------------------------

template <typename T, typename Plain>
concept Is = std::same_as<std::remove_const_t<T>, Plain>;

// names: those of the preceding frames.
template <typename Visit, Is<ManifestFrame> Frame>
void fields(const Visit& visit, Frame& frame, std::set<std::string>& names) {
    visit("name", frame.name);
    visit.require(
        "name", "letters, digits, '_', '-' and '.', not first", is_plain_name(frame.name));
    visit.require("name", "a unique name", names.insert(frame.name).second);
    visit("scene_sha256", frame.scene_sha256);
    visit("image_sha256", frame.image_sha256);
}

template <typename Visit, Is<ManifestStrobe> Strobe>
void fields(const Visit& visit, Strobe& strobe) {
    constexpr int kMostLamps = 100'000;  // of a scene (scene_gen/pov_scene.cpp)
    visit("name", strobe.name);
    visit("lamps_across", strobe.lamps_across, 1, kMostLamps);
    visit("lamps_along", strobe.lamps_along, 1, kMostLamps);
}

template <typename Visit, Is<ManifestScene> Scene>
void fields(const Visit& visit, Scene& scene) {
    visit("file", scene.file);
    visit("sha256", scene.sha256);
    visit("materials", scene.materials);
    visit("shortest_path_m", scene.shortest_path_m);
    visit.require("shortest_path_m", "a number above 0", scene.shortest_path_m > 0.0);
    visit("longest_path_m", scene.longest_path_m);
    visit.require("longest_path_m",
                  "a number no smaller than shortest_path_m",
                  scene.longest_path_m >= scene.shortest_path_m);
}

template <typename Visit, Is<RuleQuality> Quality>
void fields(const Visit& visit, Quality& quality) {
    visit("error", quality.error);
    visit("amplification", quality.amplification);
}

// The preceding wavelengths.
struct Before {
    double lambda_nm = 0.0;
    int frames = 0;
    std::set<std::pair<std::size_t, std::size_t>> taken{};  // frames and channels
};

template <typename Visit, Is<PlannedVeil> Veil>
void fields(const Visit& visit, Veil& veil) {
    visit("scattering_per_m", veil.scattering_per_m);
    visit("weight", veil.weight);
    visit("exposure_log2", veil.exposure_log2, -kMostExposureLog2, kMostExposureLog2);
    visit("radiance_bound", veil.radiance_bound);
}

template <typename Visit, Is<PlannedWavelength> Wavelength>
void fields(const Visit& visit, Wavelength& w, Before& before) {
    visit("lambda_nm", w.lambda_nm);
    visit.require("lambda_nm", "increasing wavelengths above 0", w.lambda_nm > before.lambda_nm);
    before.lambda_nm = w.lambda_nm;
    visit("weight", w.weight);
    visit("frame", w.frame, 0, before.frames - 1);
    visit.one_of("channel", w.channel, kChannelNames);
    visit.require("channel",
                  "a channel of the frame that no other wavelength has",
                  before.taken.emplace(w.frame, w.channel).second);
    visit("index_nm", w.index_nm);
    visit("attenuation_per_m", w.light.attenuation_per_m);
    visit("flux", w.light.flux);
    visit("reflectance", w.light.reflectance);
    visit("exposure_log2", w.exposure_log2, -kMostExposureLog2, kMostExposureLog2);
    visit("radiance_bound", w.radiance_bound);
    visit.require("radiance_bound", "0 or more", w.radiance_bound >= 0.0);
    visit.optional("veil", w.veil);
}

template <typename Visit, Is<ManifestCamera> Camera>
void fields(const Visit& visit, Camera& camera) {
    visit("vignetting_sha256", camera.vignetting_sha256);
}

template <typename Visit, Is<ManifestPng> Png>
void fields(const Visit& visit, Png& png) {
    visit("bits", png.bits, 16, 16);
}

template <typename Visit, Is<ManifestPovrayVeil> Veil>
void fields(const Visit& visit, Veil& veil) {
    constexpr int kMostSamples = 1'000'000;
    visit("samples", veil.samples, 1, kMostSamples);
    visit("lobes", veil.lobes);
    visit("takes_surfaces_off", veil.takes_surfaces_off);
    visit("error", veil.error);
}

template <typename Visit, Is<ManifestVeil> Veil>
void fields(const Visit& visit, Veil& veil) {
    visit("sha256", veil.sha256);
    visit("fog_m", veil.fog_m);
    visit.require("fog_m", "0 or more", veil.fog_m >= 0.0);
    visit.optional("povray", veil.povray);
}

// Whether each wavelength's veil has frames.
bool has_veil_frames(const Manifest& manifest) {
    if (!manifest.veil || !manifest.veil->povray) return true;
    const ManifestPovrayVeil& veil = *manifest.veil->povray;
    const std::size_t sets = 1 + veil.lobes.size() + (veil.takes_surfaces_off ? 1 : 0);
    return manifest.frames.size() == sets * manifest.direct_frames() &&
           std::ranges::all_of(manifest.wavelengths, [&](const PlannedWavelength& w) {
               return w.veil && w.veil->scattering_per_m.size() == veil.lobes.size();
           });
}

template <typename Visit, Is<ManifestModel> Model>
void fields(const Visit& visit, Model& model) {
    visit("error", model.error);
}

template <typename Visit, Is<ManifestSettings> Settings>
void fields(const Visit& visit, Settings& settings) {
    visit("keys", settings.keys);
}

template <typename Visit, Is<Manifest> Whole>
void fields(const Visit& visit, Whole& manifest) {
    visit("aphotic_version", manifest.aphotic_version);
    visit("povray_version", manifest.povray_version);
    visit("rig_title", manifest.rig_title);
    visit("rig_sha256", manifest.rig_sha256);
    visit.optional("rig_settings", manifest.rig_settings);
    visit("width_px", manifest.width_px, 1, kLargestImagePx);
    visit("height_px", manifest.height_px, 1, kLargestImagePx);
    visit.optional("camera", manifest.camera);
    visit.optional("png", manifest.png);
    visit("lamp_signal", manifest.lamp_signal);
    visit("method", manifest.method);
    visit("tolerance", manifest.tolerance);
    visit("frame_error", manifest.frame_error);
    visit("no_promise", manifest.no_promise);
    if (manifest.has_promise()) visit.list("quality", manifest.quality);
    visit("geometry", manifest.geometry);
    visit.list("strobes", manifest.strobes);
    visit.optional("scene", manifest.scene);
    visit.optional("veil", manifest.veil);
    visit.optional("model", manifest.model);
    std::set<std::string> names;
    visit.list("frames", manifest.frames, names);
    Before before{.frames = static_cast<int>(manifest.frames.size())};
    visit.list("wavelengths", manifest.wavelengths, before);
    visit.require("wavelengths", "at least one", !manifest.wavelengths.empty());
    visit.require("frames", "as many as the lobes of the veil require", has_veil_frames(manifest));
}

}  // namespace

std::string attribute_of(const ManifestModel& model) {
    return fmt::format("{}", fmt::join(model.error, " "));
}

std::size_t Manifest::direct_frames() const {
    std::size_t count = 0;
    for (const PlannedWavelength& w : wavelengths) count = std::max(count, w.frame + 1);
    return count;
}

// A veil's frame holds what a lobe scatters, and what other light reaches the camera: of that, all
// lobes' frames together hold as many times too much as their signs sum to.
std::vector<ManifestLayer> Manifest::layers() const {
    const std::size_t direct = direct_frames();
    std::vector<ManifestLayer> all;
    for (std::size_t j = 0; j < wavelengths.size(); ++j) {
        const PlannedWavelength& w = wavelengths[j];
        ManifestLayer layer{.frame = w.frame,
                            .channel = w.channel,
                            .wavelength = j,
                            .scale = std::ldexp(1.0, -w.exposure_log2),
                            .weight = w.weight};
        all.push_back(layer);
        if (!veil || !veil->povray) continue;
        layer.weight = w.veil->weight;
        double signs = 0.0;
        const auto add = [&](double sign) {
            layer.frame += direct;
            layer.scale = std::ldexp(sign, -w.veil->exposure_log2);
            all.push_back(layer);
            signs += sign;
        };
        for (const double scattering_per_m : w.veil->scattering_per_m)
            add(scattering_per_m < 0.0 ? -1.0 : 1.0);
        if (veil->povray->takes_surfaces_off) add(-signs);
    }
    std::ranges::stable_sort(all, {}, &ManifestLayer::frame);
    return all;
}

double Manifest::black(std::size_t channel) const {
    const double room = png ? 1.0 : 64.0;
    const int held = held_log2(frame_format());
    double sum = 0.0;
    for (const PlannedWavelength& w : wavelengths) {
        sum += std::ldexp(std::abs(w.weight[channel]), held - w.exposure_log2);
    }
    return room * sum;
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

fs::path vignetting_path(const fs::path& folder) {
    return folder / "povray" / "vignetting.exr";
}

fs::path veil_path(const fs::path& folder) {
    return folder / "povray" / "veil.exr";
}

std::vector<std::string> veil_channels(const Manifest& manifest) {
    std::vector<std::string> channels(kChannelNames.begin(), kChannelNames.end());
    for (std::size_t j = 0; j < manifest.wavelengths.size(); ++j)
        channels.push_back(fmt::format("wavelength_{}", j));
    return channels;
}

void write_manifest(const fs::path& folder, const Manifest& manifest) {
    OrderedJson json;
    const Writer writer(json);
    writer("format", std::string(kFormat));
    fields(writer, manifest);
    json[kChecksum] = checksum_of(Json::parse(text_of(json)));
    write_text_file(manifest_path(folder), text_of(json) + "\n");
}

Manifest read_manifest(const fs::path& folder) {
    const fs::path file = manifest_path(folder);
    const std::string text = read_text_file(file, kMostManifestBytes);
    Manifest manifest = parse_manifest(file.string(), text);
    const Json json = parse_json(text, file.string());
    std::string noted;
    Reader(json, file.string())(kChecksum, noted);
    if (noted != checksum_of(json)) {
        throw InputError(
            "{}: {}: does not match the rest, which was changed after it was written; allowed: a "
            "manifest as aphotic wrote it",
            file.string(),
            kChecksum);
    }
    return manifest;
}

Manifest parse_manifest(const std::string& file_name, std::string_view text) {
    const Json json = parse_json(text, file_name);
    const Reader reader(json, file_name);
    std::string format;
    reader("format", format);
    reader.require(
        "format",
        fmt::format("\"{}\", which this version writes: render again, into another folder",
                    kFormat),
        format == kFormat);
    Manifest manifest;
    fields(reader, manifest);
    return manifest;
}

}  // namespace aphotic
