// SPDX-License-Identifier: BSD-3-Clause
#include "cli/outcome.h"

#include "base/progress.h"
#include "base/words.h"
#include "cli/option_checks.h"
#include "image/exr.h"
#include "plugin/interruption.h"
#include "spectral/integrator.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <numeric>
#include <thread>

namespace aphotic::cli {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void add_preview_options(CLI::App& app, PreviewOptions& options) {
    static const std::map<std::string, PreviewWhite> kWhites{
        {"lamp", PreviewWhite::Lamp}, {"image", PreviewWhite::Image}, {"none", PreviewWhite::None}};
    constexpr double kMostStops = 20.0;
    app.add_option("--preview-white",
                   options.white,
                   "what the preview shows as grey: the lamp's own light (lamp, the default), the "
                   "image's mean (image), or equal signals (none)")
        ->transform(CLI::CheckedTransformer(kWhites))
        ->option_text("lamp|image|none");
    app.add_option("--preview-stops", options.stops, "the preview brighter by 2^STOPS")
        ->check(in_range(-kMostStops, kMostStops))
        ->capture_default_str();
}

std::string dumped(const Json& json) {
    // Titles and paths are the user's and need not be UTF-8; JSON must be.
    constexpr int kIndent = 2;
    return json.dump(kIndent, ' ', false, Json::error_handler_t::replace);
}

Json outcome_of(const fs::path& folder, const CameraImage& image) {
    Json channels;
    const auto plane = static_cast<std::ptrdiff_t>(image.samples.size() / kChannels);
    for (int c = 0; c < kChannels; ++c) {
        const auto first = image.samples.begin() + c * plane;
        const auto [least, most] = std::minmax_element(first, first + plane);
        const double mean = std::accumulate(first, first + plane, 0.0) / static_cast<double>(plane);
        channels[std::string(kChannelNames[static_cast<std::size_t>(c)])] = {
            {"least", *least}, {"mean", mean}, {"most", *most}};
    }
    return {{"folder", folder.string()},
            {"width_px", image.width_px},
            {"height_px", image.height_px},
            {"signal", channels}};
}

void put_promises(Json& json, const Manifest& manifest) {
    if (!manifest.has_promise()) {
        json["promise"] = nullptr;
        json["no_promise"] = manifest.no_promise;
        return;
    }
    for (std::size_t c = 0; c < kChannels; ++c) {
        const RuleQuality& quality = manifest.quality[c];
        json["promise"][std::string(kChannelNames[c])] = {{"error", quality.error},
                                                          {"amplification", quality.amplification},
                                                          {"promise", manifest.promise(c)}};
    }
}

Json integrate_folder(const fs::path& folder,
                      const Manifest& manifest,
                      const PreviewOptions& preview,
                      const fs::path& images) {
    const auto start = std::chrono::steady_clock::now();
    const InterruptionHold hold;
    set_exr_threads(static_cast<int>(std::thread::hardware_concurrency()));
    ProgressLine line;
    const auto report = [&](double share) {
        throw_if_interrupted();
        line.show("integrating", share);
    };
    const CameraImage image = images == folder
                                  ? integrate(folder, manifest, report)
                                  : integrate_signals(folder, manifest, images, report);
    write_preview(image, manifest.lamp_signal, preview, images / "preview.png");
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;

    Json outcome = outcome_of(images, image);
    outcome["spectral"] = images == folder;
    outcome["wavelengths"] = manifest.wavelengths.size();
    outcome["frames"] = manifest.frames.size();
    outcome["frame_error"] = manifest.frame_error;
    put_promises(outcome, manifest);
    outcome["integration_s"] = elapsed.count();
    return outcome;
}

void print_outcome(const Json& outcome) {
    fmt::print("{}: {} x {} pixels from {} in {}, integrated in {:.1f} s\n",
               outcome["title"].get<std::string>(),
               outcome["width_px"].get<int>(),
               outcome["height_px"].get<int>(),
               counted(outcome["wavelengths"].get<std::size_t>(), "wavelength"),
               counted(outcome["frames"].get<std::size_t>(), "frame"),
               outcome["integration_s"].get<double>());
    if (outcome["promise"].is_null()) {
        print_no_promise(outcome["no_promise"]);
    } else {
        fmt::print("  off the full spectrum by at most {:.3g} (R), {:.3g} (G), {:.3g} (B)\n",
                   outcome["promise"]["R"]["promise"].get<double>(),
                   outcome["promise"]["G"]["promise"].get<double>(),
                   outcome["promise"]["B"]["promise"].get<double>());
    }
    print_signals(outcome);
}

void print_no_promise(const std::vector<std::string>& reasons) {
    fmt::print("  no bound on the error against the full spectrum:\n");
    for (const std::string& reason : reasons) fmt::print("    {}\n", reason);
}

void print_signals(const Json& outcome) {
    const auto folder = outcome["folder"].get<std::string>();
    for (const auto& [channel, signal] : outcome["signal"].items()) {
        fmt::print("  {}  {:.6g} to {:.6g}, mean {:.6g}\n",
                   channel,
                   signal["least"].get<double>(),
                   signal["most"].get<double>(),
                   signal["mean"].get<double>());
    }
    fmt::print(
        "  {}/preview.png   to look at\n"
        "  {}/image.exr     the camera's signal, linear R, G, B\n",
        folder,
        folder);
    if (outcome.value("spectral", true)) {
        fmt::print("  {}/spectral.exr  the radiance at each wavelength\n", folder);
    }
}

}  // namespace aphotic::cli
