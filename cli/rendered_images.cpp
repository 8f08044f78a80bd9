// SPDX-License-Identifier: BSD-3-Clause
#include "cli/rendered_images.h"

#include "base/error.h"
#include "image/exr.h"
#include "spectral/integrator.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace aphotic::cli {

namespace fs = std::filesystem;

void require_rendered(const fs::path& folder) {
    for (const char* name : {"image.exr", "spectral.exr"}) {
        if (!is_traced(folder / name)) continue;
        throw InputError(
            "{}: found an image by the reference tracer; allowed: one from POV-Ray's frames, as "
            "`aphotic integrate {}` makes it",
            (folder / name).string(),
            folder.string());
    }
}

RenderedImages images_in(const fs::path& folder,
                         const Rig& rig,
                         const Manifest& manifest,
                         const LightFamily& family) {
    RenderedImages images;
    images.signals = read_signals(folder / "image.exr");
    for (const Strobe& strobe : rig.strobes) {
        // The frames may be of another rig, without such a strobe.
        const auto known = std::ranges::find(manifest.strobes, strobe.name, &ManifestStrobe::name);
        const ManifestStrobe lamps = known != manifest.strobes.end() ? *known : ManifestStrobe{};
        images.lamps.push_back({.across = lamps.lamps_across, .along = lamps.lamps_along});
    }
    std::vector<std::string> channels;
    for (const PlannedWavelength& w : manifest.wavelengths) {
        images.lambda_nm.push_back(w.lambda_nm);
        images.radiance_black.push_back(
            std::ldexp(1.0, held_log2(manifest.frame_format()) - w.exposure_log2));
        channels.push_back(spectral_channel(w.lambda_nm));
        images.index_nm.push_back(w.index_nm);
        images.shift_error.push_back(
            family.tilt ? std::abs(family.tilt->at(w.lambda_nm) - family.tilt->at(w.index_nm))
                        : 0.0);
    }
    for (std::size_t c = 0; c < kChannels; ++c) {
        images.promise[c] = manifest.promise(c);
        images.black[c] = manifest.black(c);
    }
    if (manifest.veil && manifest.veil->povray) images.veil_error = manifest.veil->povray->error;
    images.radiance = [folder, channels](std::size_t first, std::size_t count) {
        const auto from = channels.begin() + static_cast<std::ptrdiff_t>(first);
        return ExrReader(folder / "spectral.exr").planes({from, count});
    };
    return images;
}

}  // namespace aphotic::cli
