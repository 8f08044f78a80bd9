// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/integrator.h"

#include "base/error.h"
#include "base/sha256.h"
#include "image/exr.h"
#include "image/frame_check.h"
#include "image/row_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

// A block holds at most this many samples of spectral radiance (64 MiB of floats), in whole blocks
// of OpenEXR's ZIP, the compression of POV-Ray's frames.
constexpr std::size_t kBlockSamples = std::size_t{1} << 24;

struct Block {
    int first_row = 0;
    int rows = 0;
    std::size_t plane = 0;       // samples of one channel
    std::vector<float> samples;  // R, G, B, then one plane per wavelength, in spectral.exr's order

    [[nodiscard]] std::span<float> signal(std::size_t channel) {
        return std::span(samples).subspan(channel * plane, plane);
    }
    [[nodiscard]] std::span<float> radiance(std::size_t wavelength) {
        return std::span(samples).subspan((kChannels + wavelength) * plane, plane);
    }
};

// The samples of a block of a frame, all channels at once, since OpenEXR decompresses them together
// anyway.
std::vector<float> samples_of(const fs::path& file, const Manifest& manifest, const Block& block) {
    static const std::vector<std::string> kFrameChannels(kChannelNames.begin(),
                                                         kChannelNames.end());
    std::vector<float> samples(kFrameChannels.size() * block.plane);
    ExrReader reader(file);
    check_size(file, reader.width_px(), reader.height_px(), manifest.width_px, manifest.height_px);
    reader.read_rows(block.first_row, block.rows, kFrameChannels, samples);
    return samples;
}

// The sum of the frames' layers, times the vignetting unless it is empty.
void sum_layers(const fs::path& folder,
                const Manifest& manifest,
                const std::vector<float>& vignetting,
                Block& block) {
    const auto first_pixel =
        static_cast<std::size_t>(block.first_row) * static_cast<std::size_t>(manifest.width_px);
    std::array<std::vector<double>, kChannels> signals;
    signals.fill(std::vector<double>(block.plane));
    std::optional<std::size_t> frame;
    std::vector<float> samples;
    for (const ManifestLayer& layer : manifest.layers()) {
        const fs::path file = image_path(folder, manifest.frames[layer.frame]);
        if (layer.frame != frame) samples = samples_of(file, manifest, block);
        frame = layer.frame;
        const auto from =
            std::span<const float>(samples).subspan(layer.channel * block.plane, block.plane);
        check_samples(file,
                      std::string(kChannelNames[layer.channel]),
                      from,
                      manifest.width_px,
                      block.first_row);
        const std::span<float> radiance = block.radiance(layer.wavelength);
        for (std::size_t i = 0; i < block.plane; ++i) {
            auto L = static_cast<float>(layer.scale * from[i]);
            if (!vignetting.empty()) L *= vignetting[first_pixel + i];
            radiance[i] += L;
            for (std::size_t c = 0; c < kChannels; ++c) signals[c][i] += layer.weight[c] * L;
        }
    }
    for (std::size_t c = 0; c < kChannels; ++c)
        std::ranges::transform(signals[c], block.signal(c).begin(), [](double value) {
            return static_cast<float>(value);
        });
}

// Weights and exposures of a manifest that we did not write may overflow floats.
void require_finite(const fs::path& folder, const Manifest& manifest, const Block& block) {
    const auto at =
        std::ranges::find_if_not(block.samples, [](float x) { return std::isfinite(x); });
    if (at == block.samples.end()) return;
    const auto index = static_cast<std::size_t>(at - block.samples.begin());
    const auto width = static_cast<std::size_t>(manifest.width_px);
    const std::size_t channel = index / block.plane;
    const std::size_t pixel = index % block.plane;
    throw RunError(
        "{}: {} is {} at column {}, row {}; allowed: weights and exposures that keep it finite",
        manifest_path(folder).string(),
        channel < kChannels
            ? std::string(kChannelNames[channel])
            : fmt::format("{} nm", manifest.wavelengths[channel - kChannels].lambda_nm),
        *at,
        pixel % width,
        static_cast<std::size_t>(block.first_row) + pixel / width);
}

void require_noted_frames(const fs::path& folder, const Manifest& manifest) {
    for (const ManifestFrame& frame : manifest.frames) {
        const fs::path file = image_path(folder, frame);
        if (!fs::exists(file)) {
            throw RunError("{}: the frame is missing; render it first", file.string());
        }
        if (frame.done() && sha256_of_file(file) != frame.image_sha256) {
            throw RunError("{}: is not the image recorded in the manifest", file.string());
        }
    }
}

std::string promise_in_words(const Manifest& manifest) {
    if (!manifest.has_promise()) {
        return fmt::format("none: {}", fmt::join(manifest.no_promise, "; "));
    }
    return fmt::format("{} {} {}", manifest.promise(0), manifest.promise(1), manifest.promise(2));
}

std::vector<double> wavelengths_of(const Manifest& manifest) {
    std::vector<double> lambda_nm;
    for (const PlannedWavelength& w : manifest.wavelengths) lambda_nm.push_back(w.lambda_nm);
    return lambda_nm;
}

ExrAttributes attributes_of(const Manifest& manifest) {
    ExrAttributes attributes{
        {"aphotic:version", manifest.aphotic_version},
        {"aphotic:rig_title", manifest.rig_title},
        {"aphotic:rig_sha256", manifest.rig_sha256},
        {"aphotic:wavelengths_nm", fmt::format("{}", fmt::join(wavelengths_of(manifest), " "))},
        {"aphotic:promise", promise_in_words(manifest)}};
    if (manifest.model)
        attributes.emplace_back(kModelErrorAttribute, attribute_of(*manifest.model));
    return attributes;
}

// The vignetting at each pixel; empty without vignetting.
std::vector<float> vignetting_of(const fs::path& folder, const Manifest& manifest) {
    if (!manifest.camera || manifest.camera->vignetting_sha256.empty()) return {};
    static const std::vector<std::string> kFactor{"Y"};
    const fs::path file = vignetting_path(folder);
    ExrReader reader(file);
    check_size(file, reader.width_px(), reader.height_px(), manifest.width_px, manifest.height_px);
    std::vector<float> factors = reader.planes(kFactor);
    if (sha256_of_floats(factors) != manifest.camera->vignetting_sha256)
        throw RunError("{}: is not the vignetting recorded in the manifest", file.string());
    return factors;
}

// The veil, from a file next to the frames.
class VeilReader {
  public:
    VeilReader(const fs::path& file, const Manifest& manifest, std::size_t planes)
        : channels_(veil_channels(manifest)) {
        if (!manifest.veil || manifest.veil->povray) return;
        if (manifest.veil->sha256.empty() || !fs::exists(file)) {
            throw RunError("{}: the veil is missing; `aphotic render` makes it from its frames",
                           file.string());
        }
        if (sha256_of_file(file) != manifest.veil->sha256)
            throw RunError("{}: is not the veil recorded in the manifest", file.string());
        channels_.resize(kChannels + planes);
        reader_.emplace(file);
        check_size(
            file, reader_->width_px(), reader_->height_px(), manifest.width_px, manifest.height_px);
    }

    void add_to(Block& block, const std::vector<float>& vignetting) {
        if (!reader_) return;
        const std::size_t count = block.plane * channels_.size();
        std::vector<float> veil(count);
        reader_->read_rows(block.first_row, block.rows, channels_, veil);
        const auto first = static_cast<std::size_t>(block.first_row) *
                           static_cast<std::size_t>(reader_->width_px());
        for (std::size_t i = 0; i < count; ++i) {
            block.samples[i] +=
                vignetting.empty() ? veil[i] : veil[i] * vignetting[first + i % block.plane];
        }
    }

  private:
    std::vector<std::string> channels_;
    std::optional<ExrReader> reader_;
};

CameraImage integrate_into(const fs::path& images_folder,
                           const std::vector<double>& planes_nm,
                           const fs::path& veil_file,
                           const fs::path& folder,
                           const Manifest& manifest,
                           const ProgressReport& report) {
    require_noted_frames(folder, manifest);
    OutputImages images(
        images_folder, manifest.width_px, manifest.height_px, planes_nm, attributes_of(manifest));
    const std::vector<float> vignetting = vignetting_of(folder, manifest);
    VeilReader veil(veil_file, manifest, planes_nm.size());
    const int height_px = manifest.height_px;
    const int block_rows = rows_per_block(manifest.width_px, manifest.wavelengths.size());
    for (int row = 0; row < height_px; row += block_rows) {
        Block block;
        block.first_row = row;
        block.rows = std::min(block_rows, height_px - row);
        block.plane =
            static_cast<std::size_t>(block.rows) * static_cast<std::size_t>(manifest.width_px);
        block.samples.resize(block.plane * (kChannels + manifest.wavelengths.size()));
        sum_layers(folder, manifest, vignetting, block);
        veil.add_to(block, vignetting);
        require_finite(folder, manifest, block);
        images.write_rows(block.rows, std::move(block.samples));
        if (report) report(static_cast<double>(row + block.rows) / height_px);
    }
    return images.finish();
}

}  // namespace

int rows_per_block(int width_px, std::size_t wavelengths) {
    const int rows = rows_holding(kBlockSamples, width_px, wavelengths);
    return std::max(kRowsOfZip, rows / kRowsOfZip * kRowsOfZip);
}

CameraImage integrate(const fs::path& folder,
                      const Manifest& manifest,
                      const ProgressReport& report) {
    return integrate_into(
        folder, wavelengths_of(manifest), veil_path(folder), folder, manifest, report);
}

CameraImage integrate_signals(const fs::path& folder,
                              const Manifest& manifest,
                              const fs::path& images_folder,
                              const ProgressReport& report) {
    return integrate_into(images_folder, {}, veil_path(images_folder), folder, manifest, report);
}

}  // namespace aphotic
