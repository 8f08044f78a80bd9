// SPDX-License-Identifier: BSD-3-Clause
//
// The manifest of a render: its frames, their wavelengths, exposures and weights, and which frames
// are done. The integrator needs nothing else, so frames may be rendered elsewhere.
//
// In a render's folder DIR:
//
//   DIR/manifest.json
//   DIR/povray/NAME.pov            the scene of frame NAME
//   DIR/povray/frames/NAME.exr     its image
//   DIR/povray/logs/NAME.log       POV-Ray's messages
//
// A frame is done once its image has been checked and its checksum recorded; it belongs to the
// scene whose checksum is recorded with it.
#pragma once

#include "image/frame_format.h"
#include "spectral/planned_wavelength.h"
#include "spectral/quadrature_fit.h"

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// Any frame's exponent lies between the negative of this limit and the limit: a double holds every
// power of two between them.
inline constexpr int kMostExposureLog2 = 1000;

struct ManifestFrame {
    std::string name;
    std::string scene_sha256;
    std::string image_sha256;  // empty: not rendered yet

    [[nodiscard]] bool done() const { return !image_sha256.empty(); }
};

// A strobe of the rig, and the grid of lamps that represents its emitter.
struct ManifestStrobe {
    std::string name;
    int lamps_across = 1;
    int lamps_along = 1;
};

// A user's scene that the frames show.
struct ManifestScene {
    std::string file;
    std::string sha256;                  // of the scene and its includes
    std::vector<std::string> materials;  // the names of its reflectances
    double shortest_path_m = 0.0;        // of the light in view
    double longest_path_m = 0.0;
};

// The differences between frames and image.
struct ManifestCamera {
    // Of the factors of all pixels, as floats (vignetting_path); empty without vignetting.
    std::string vignetting_sha256{};
};

// The properties of frames that POV-Ray wrote as PNG (image/frame_format.h).
struct ManifestPng {
    int bits = 16;
};

// A veil rendered by POV-Ray. The frames of direct light are followed by as many frames for each
// lobe, in their order, and then by those of light that the water does not scatter, to be
// subtracted.
struct ManifestPovrayVeil {
    int samples = 0;                   // per ray
    std::vector<std::string> lobes{};  // of the phase functions
    bool takes_surfaces_off = false;
    double error = 0.0;  // measured beforehand, relative to the veil; not a bound
};

// The light that the water scatters into the view: a file next to the frames (veil_path), or
// POV-Ray frames. If more than the bare floor is in view, the last frame holds no light but a fog
// of distance fog_m in red: 1 - exp(-D / fog_m), which gives the distance D that each pixel sees.
struct ManifestVeil {
    std::string sha256{};  // of the file; empty: not computed yet, or rendered by POV-Ray
    double fog_m = 0.0;    // 0: bare floor, without such a frame
    std::optional<ManifestPovrayVeil> povray{};
};

// The model error estimate for water that scatters (docs/reference/water.md): a share of each
// channel's signal, rms over the image. Not part of the promise.
struct ManifestModel {
    std::array<double, kChannels> error{};
};

// Metadata of images and maps with a model error, next to aphotic:promise.
inline constexpr const char* kModelErrorAttribute = "aphotic:model_error";
[[nodiscard]] std::string attribute_of(const ManifestModel& model);

// Rig keys set on the command line, KEY=VALUE each.
struct ManifestSettings {
    std::vector<std::string> keys{};
};

// What one channel of a frame adds to the image: direct light, or a part of the veil.
//
//   L(lambda_j) += s F,     S_c += w_cj s F
struct ManifestLayer {
    std::size_t frame = 0;
    std::size_t channel = 0;                 // of the sample F
    std::size_t wavelength = 0;              // j
    double scale = 1.0;                      // s: plus or minus a power of two, or 0
    std::array<double, kChannels> weight{};  // w_cj
};

struct Manifest {
    std::string aphotic_version;
    std::string povray_version;  // empty: rendered elsewhere
    std::string rig_title;
    std::string rig_sha256;  // of its text, with the settings
    std::optional<ManifestSettings> rig_settings{};
    int width_px = 0;
    int height_px = 0;
    std::optional<ManifestCamera> camera{};  // none: frames match the image
    std::optional<ManifestPng> png{};        // none: POV-Ray wrote half floats
    // The signal of the lamps themselves: the sum over strobes of int Phi Q_c dlambda. The
    // preview's white.
    std::array<double, kChannels> lamp_signal{};
    // How the wavelengths were chosen: "fitted", "equal bands" or "listed".
    std::string method;
    double tolerance = 0.0;  // requested for fitted wavelengths; else 0
    // The error of the wavelengths and their weights, and their amplification of the frames' own
    // error: together the promise (spectral/quadrature_fit.h).
    std::array<RuleQuality, kChannels> quality{};
    double frame_error = 0.0;
    // Why the image has no promise, for a user's scene that voids it; empty if it has one. Quality
    // is then that of the spectra named in the scene, and not written.
    std::vector<std::string> no_promise{};
    // Everything in the rig that its frames depend on, except sources and water, by part, as text:
    // frames serve another rig if its signature is equal (rig/geometry_signature.h).
    std::map<std::string, std::string> geometry;
    std::vector<ManifestStrobe> strobes{};  // in the order of every wavelength's flux
    std::optional<ManifestScene> scene{};   // none: the rig's own floor
    std::optional<ManifestVeil> veil{};     // none: the water does not scatter
    std::optional<ManifestModel> model{};   // none: the same, or no estimate
    std::vector<ManifestFrame> frames;
    std::vector<PlannedWavelength> wavelengths;  // increasing

    // The direct light's wavelengths, which come first.
    [[nodiscard]] std::size_t direct_frames() const;
    // The layers of all frames, in their order.
    [[nodiscard]] std::vector<ManifestLayer> layers() const;

    [[nodiscard]] FrameFormat frame_format() const {
        return png ? FrameFormat::Png16 : FrameFormat::Exr;
    }
    [[nodiscard]] bool has_promise() const { return no_promise.empty(); }
    [[nodiscard]] double promise(std::size_t channel) const {
        return quality[channel].promise(frame_error);
    }

    // The signal below which the promise is relative to this level, not to the pixel's own signal:
    //
    //   r sum_j |w_cj| 2^(h - e_j)      h  the power of two from which frames have full precision
    //
    // For half floats h = -14; smaller samples round by up to 2^-25 all the same, which r = 64
    // makes negligible. A 16-bit PNG rounds everything by up to 2^-17: h = -6, r = 1.
    [[nodiscard]] double black(std::size_t channel) const;
};

[[nodiscard]] std::filesystem::path manifest_path(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path scene_path(const std::filesystem::path& folder,
                                               const ManifestFrame& frame);
[[nodiscard]] std::filesystem::path log_path(const std::filesystem::path& folder,
                                             const ManifestFrame& frame);
[[nodiscard]] std::filesystem::path image_path(const std::filesystem::path& folder,
                                               const ManifestFrame& frame);

// The vignetting, one factor per pixel: an EXR with one channel, Y.
[[nodiscard]] std::filesystem::path vignetting_path(const std::filesystem::path& folder);

// The veil at every pixel, to be added: R, G, B as signals, and a plane of radiance for each
// wavelength, in the manifest's order.
[[nodiscard]] std::filesystem::path veil_path(const std::filesystem::path& folder);
[[nodiscard]] std::vector<std::string> veil_channels(const Manifest& manifest);

void write_manifest(const std::filesystem::path& folder, const Manifest& manifest);

// Every value is checked; an InputError names the file and the key.
[[nodiscard]] Manifest read_manifest(const std::filesystem::path& folder);

// The same from text; file_name is for messages.
[[nodiscard]] Manifest parse_manifest(const std::string& file_name, std::string_view text);

}  // namespace aphotic
