// SPDX-License-Identifier: BSD-3-Clause
#include "cli/outcome.h"

#include "base/interruption.h"
#include "base/progress.h"
#include "base/stopwatch.h"
#include "base/words.h"
#include "cli/model_error.h"
#include "cli/options.h"
#include "image/exr.h"
#include "spectral/integrator.h"

#include <algorithm>
#include <numeric>

namespace aphotic::cli {

namespace fs = std::filesystem;

namespace {
using Json = nlohmann::ordered_json;
}

MadeImages made_images(const fs::path& folder, const CameraImage& image) {
    MadeImages made{.folder = folder, .width_px = image.width_px, .height_px = image.height_px};
    const auto plane = static_cast<std::ptrdiff_t>(image.samples.size() / kChannels);
    auto first = image.samples.begin();
    for (MadeImages::Signal& signal : made.signals) {
        const auto [least, most] = std::minmax_element(first, first + plane);
        const double sum = std::accumulate(first, first + plane, 0.0);
        signal = {.least = *least, .mean = sum / static_cast<double>(plane), .most = *most};
        first += plane;
    }
    return made;
}

Json to_json(const MadeImages& made) {
    Json channels;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const MadeImages::Signal& signal = made.signals[c];
        channels[std::string(kChannelNames[c])] = {
            {"least", signal.least}, {"mean", signal.mean}, {"most", signal.most}};
    }
    return {{"folder", made.folder.string()},
            {"width_px", made.width_px},
            {"height_px", made.height_px},
            {"signal", channels}};
}

void print(const MadeImages& made) {
    for (std::size_t c = 0; c < kChannels; ++c) {
        const MadeImages::Signal& signal = made.signals[c];
        say("  {}  {:.6g} to {:.6g}, mean {:.6g}\n",
            kChannelNames[c],
            signal.least,
            signal.most,
            signal.mean);
    }
    say("  {0}/preview.png   to look at\n"
        "  {0}/image.exr     the camera's signal, linear R, G, B\n",
        made.folder.string());
    if (made.has_spectral) {
        say("  {}/spectral.exr  the radiance at each wavelength\n", made.folder.string());
    }
}

Integration integrate_folder(const fs::path& folder,
                             const Manifest& manifest,
                             const PreviewOptions& preview,
                             const fs::path& images) {
    const Stopwatch watch;
    const InterruptionHold hold;
    set_exr_threads(all_cores());
    ProgressLine line;
    const auto report = [&](double share) {
        throw_if_interrupted();
        line.show("integrating", share);
    };
    const bool is_own = images == folder;
    const CameraImage image = is_own ? integrate(folder, manifest, report)
                                     : integrate_signals(folder, manifest, images, report);
    write_preview(image, manifest.lamp_signal, preview, images / "preview.png");
    const double integrate_s = watch.seconds();
    MadeImages made = made_images(images, image);
    made.has_spectral = is_own;
    return {.manifest = manifest, .images = made, .seconds = integrate_s};
}

namespace {

// Relative to each channel's brightest signal: the level from which 16-bit frames have full
// precision, and the promise is relative to the pixel's own signal.
double share_with_digits(const Integration& integration) {
    double share = 0.0;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const double most = integration.images.signals[c].most;
        if (most > 0.0) share = std::max(share, integration.manifest.black(c) / most);
    }
    return share;
}

}  // namespace

Json to_json(const Integration& integration) {
    const Manifest& manifest = integration.manifest;
    Json json = to_json(integration.images);
    json["spectral"] = integration.images.has_spectral;
    json["wavelengths"] = manifest.wavelengths.size();
    json["frames"] = manifest.frames.size();
    json["frame_error"] = manifest.frame_error;
    if (manifest.png) json["digits_from"] = share_with_digits(integration);
    put_promises(json, manifest);
    put_model_error(json, manifest.model);
    json["integration_s"] = integration.seconds;
    json["title"] = manifest.rig_title;
    return json;
}

void print(const Integration& integration) {
    const Manifest& manifest = integration.manifest;
    say("{}: {} x {} pixels from {} in {}, integrated in {:.1f} s\n",
        manifest.rig_title,
        integration.images.width_px,
        integration.images.height_px,
        counted(manifest.wavelengths.size(), "wavelength"),
        counted(manifest.frames.size(), "frame"),
        integration.seconds);
    if (manifest.has_promise()) {
        say("  off the full spectrum by at most {:.3g} (R), {:.3g} (G), {:.3g} (B)\n",
            manifest.promise(0),
            manifest.promise(1),
            manifest.promise(2));
        if (manifest.png) {
            say("  relative to the pixel, or to {:.2g} of the brightest if that is more: frames "
                "were PNG\n",
                share_with_digits(integration));
        }
    } else {
        print_no_promise(manifest.no_promise);
    }
    print_model_error(manifest.model);
    say_text(povray_veil_in_words(manifest));
    print(integration.images);
}

void put_promises(Json& json, const Manifest& manifest) {
    if (manifest.veil && manifest.veil->povray) {
        const ManifestPovrayVeil& veil = *manifest.veil->povray;
        json["veil"] = {{"by", "povray"},
                        {"samples", veil.samples},
                        {"lobes", veil.lobes},
                        {"error", veil.error}};
    }
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

std::string povray_veil_in_words(const Manifest& manifest) {
    if (!manifest.veil || !manifest.veil->povray) return "";
    const ManifestPovrayVeil& veil = *manifest.veil->povray;
    return fmt::format(
        "  the veil is POV-Ray's, of {} and {} to a ray: off by {:.2g} where it was measured, over "
        "the\n  bare floor, which is no bound\n",
        counted(veil.lobes.size(), "lobe"),
        counted(static_cast<std::size_t>(veil.samples), "sample"),
        veil.error);
}

void print_no_promise(const std::vector<std::string>& reasons) {
    say("  no bound on the error against the full spectrum:\n");
    for (const std::string& reason : reasons) say("    {}\n", reason);
}

}  // namespace aphotic::cli
