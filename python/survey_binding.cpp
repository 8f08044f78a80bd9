// SPDX-License-Identifier: BSD-3-Clause
#include "base/degrees.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/printable.h"
#include "lightmap/cone_edge.h"
#include "python/bindings.h"
#include "survey/correction.h"
#include "survey/fit/fit.h"
#include "survey/fit/fit_json.h"
#include "survey/fit/fitted_rig.h"
#include "survey/images/camera_numbers.h"
#include "survey/light_at.h"
#include "survey/navigation/navigation_file.h"

#include <fmt/format.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::python {
namespace {

namespace fs = std::filesystem;

Mosaic mosaic_of(const std::string& name) {
    const std::optional<Mosaic> mosaic = mosaic_named(name);
    if (!mosaic) {
        throw InputError("bayer: found '{}'; allowed: RGGB, BGGR, GRBG, GBRG, mono", name);
    }
    return *mosaic;
}

// --- Correction ---------------------------------------------------------------------------------

using RawArray = nb::ndarray<const float, nb::c_contig, nb::device::cpu>;

RawImage raw_of(const RawArray& array, const std::optional<std::string>& bayer) {
    const std::size_t dimensions = bayer ? 2 : 3;
    if (array.ndim() != dimensions || (!bayer && array.shape(2) != kChannels)) {
        throw InputError(
            "raw: found {} dimensions; allowed: rows and columns of a mosaic with "
            "bayer, or rows, columns and R, G, B",
            array.ndim());
    }
    RawImage raw{.width_px = static_cast<int>(array.shape(1)),
                 .height_px = static_cast<int>(array.shape(0)),
                 .mosaic = bayer ? mosaic_of(*bayer) : Mosaic::None};
    raw.samples.assign(array.data(), array.data() + array.size());
    if (bayer) return raw;
    const std::size_t pixels = raw.pixels();
    for (std::size_t i = 0; i < pixels; ++i) {
        for (std::size_t c = 0; c < kChannels; ++c)
            raw.samples[c * pixels + i] = array.data()[kChannels * i + c];
    }
    return raw;
}

struct CorrectedArray {
    CorrectedImage image;
    PerChannel gain{};
};

// The gain of an image as by `aphotic correct`, in a survey with this image only.
PerChannel gain_of(const RawImage& raw, const RigLightmap& light, const Correction& correction) {
    const PerChannel quotient =
        middle_quotient(raw, light.map, correction.levels, correction.limit.share);
    PerChannel gain{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        if (!(quotient[c] > 0.0))
            throw InputError("raw: found a channel without light or map; allowed: with a gain");
        gain[c] = correction.middle[c] / quotient[c];
    }
    return gain;
}

CorrectedArray correct(const RawArray& array,
                       const RigLightmap& light,
                       const std::optional<std::string>& bayer,
                       float black_level,
                       float white_level,
                       const std::optional<PerChannel>& gain,
                       std::optional<double> middle,
                       double least_light,
                       double most_noise,
                       double read_noise,
                       double electrons,
                       int edge_px,
                       bool keep_mosaic) {
    constexpr int kMostEdge_px = 1000;
    require_range("least_light", least_light, 0.0, 1.0);
    require_range("most_noise", most_noise, std::numeric_limits<double>::min(), 1.0);
    RawImage raw = raw_of(array, bayer);
    const nb::gil_scoped_release no_lock;
    require_range("edge_px", edge_px, 0, kMostEdge_px);
    require_size(raw, light.map.width_px, light.map.height_px, "like the map");
    Correction correction{.levels = {.black = black_level, .white = white_level},
                          .limit = {.share = least_light,
                                    .relative = most_noise,
                                    .read_noise = read_noise,
                                    .electrons_per_number = electrons}};
    if (middle) {
        correction.middle.fill(*middle);
    } else {
        correction.middle = floor_colour(*light.rig);
    }
    correction.gain = gain ? *gain : gain_of(raw, light, correction);
    // With a given gain, how much light the median has is unknown.
    if (gain && !middle) correction.limit = {.share = least_light};
    CorrectedArray result{.image = corrected(std::move(raw), light.map, correction),
                          .gain = correction.gain};
    if (is_bayer(result.image.image.mosaic) && !keep_mosaic)
        result.image = demosaiced(result.image);
    const std::vector<std::uint8_t> edges = ConeEdges(*light.rig).mask(light.rig->sled, edge_px);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (edges[i] != 0) result.image.doubts[i] |= kEdge;
    }
    return result;
}

Array<float, 3> corrected_image(nb::handle self) {
    RawImage& image = nb::cast<CorrectedArray&>(self).image.image;
    return image_of_planes(image.samples.data(),
                           image.height_px,
                           image.width_px,
                           static_cast<std::size_t>(image.planes()),
                           self);
}

Array<std::uint8_t, 2> doubts_of(nb::handle self) {
    CorrectedImage& corrected = nb::cast<CorrectedArray&>(self).image;
    return Array<std::uint8_t, 2>(corrected.doubts.data(),
                                  {static_cast<std::size_t>(corrected.image.height_px),
                                   static_cast<std::size_t>(corrected.image.width_px)},
                                  self);
}

void bind_correction(nb::module_& module) {
    nb::class_<CorrectedArray>(module, "Corrected", "An image divided by its light.")
        .def_prop_ro("image", corrected_image, "Rows, columns, R, G, B; one plane of a mosaic.")
        .def_prop_ro("doubts",
                     doubts_of,
                     "By pixel the sum of 1 dark, 2 saturated, 4 black, 8 on a beam's edge.")
        .def_ro("gain", &CorrectedArray::gain);
    module.def("correct",
               correct,
               nb::arg("raw"),
               nb::arg("light"),
               nb::kw_only(),
               nb::arg("bayer") = nb::none(),
               nb::arg("black_level") = 0.0F,
               nb::arg("white_level") = std::numeric_limits<float>::infinity(),
               nb::arg("gain") = nb::none(),
               nb::arg("middle") = nb::none(),
               nb::arg("least_light") = 0.01,
               nb::arg("most_noise") = 0.5,
               nb::arg("read_noise") = 0.0,
               nb::arg("electrons") = 0.0,
               nb::arg("edge_px") = 2,
               nb::arg("keep_mosaic") = false,
               "Divide a raw image by the map of its own pose. The gain is the image's own unless "
               "given.");
}

// --- Fit ----------------------------------------------------------------------------------------

struct Fitted {
    RigText rig;
    FitResult result;
    std::vector<Skipped> skipped;
};

// In the form that the command prints on standard error.
void warn_of(const Fitted& fitted) {
    const nb::object warn = nb::module_::import_("warnings").attr("warn");
    for (const Skipped& one : fitted.skipped)
        warn(shown_text(fmt::format("{}: {}; skipped", one.image, one.why)));
    for (const Suspicion& one : fitted.result.looks_wrong)
        warn(shown_text(fmt::format("looks wrong: {}: {}", one.about, one.what)));
}

FitBeamKind beam_named(const std::string& name) {
    if (const auto found = kFitBeams.find(name); found != kFitBeams.end()) return found->second;
    throw InputError("beam: found {}; allowed: table, cones, cosine, optics", name);
}

std::optional<bool> is_radial(const std::optional<std::string>& vignetting) {
    if (!vignetting) return std::nullopt;
    if (*vignetting == "cosine" || *vignetting == "radial") return *vignetting == "radial";
    throw InputError("vignetting: found {}; allowed: cosine, radial", *vignetting);
}

using Words = std::vector<std::string>;

FitSamples image_samples(const Rig& rig,
                         const std::vector<std::string>& images,
                         const fs::path& navigation,
                         const CameraNumbers& camera,
                         int blocks,
                         std::size_t jobs) {
    Survey survey{.files = image_files(images, {}), .camera = camera};
    survey.camera = with_rig(survey.camera, rig.camera);
    survey.navigation =
        read_navigation({.source = navigation.string(), .jobs = jobs}, survey.files, &rig);
    survey.strobes = strobes_of_rig(rig, *survey.navigation, survey.files);
    return samples_of_images(survey, rig, blocks, jobs, RunWatch{});
}

Fitted fit_rig(const TextRig& rig,
               const std::vector<std::string>& maps,
               const std::vector<std::string>& images,
               const std::optional<fs::path>& navigation,
               const std::optional<std::string>& bayer,
               std::optional<float> black_level,
               std::optional<float> white_level,
               const std::string& beam,
               bool beam_each,
               const std::optional<Words>& free,
               const Words& hold,
               const std::map<std::string, double>& priors,
               const std::optional<std::string>& vignetting,
               double altitude_error_m,
               double attitude_error_deg,
               int blocks,
               int threads) {
    if (maps.empty() == images.empty()) {
        throw InputError("found {}; allowed: either maps or images",
                         maps.empty() ? "neither maps nor images" : "maps and images");
    }
    if (!images.empty() && !navigation)
        throw InputError("images: found no navigation; allowed: with nav");
    require_range("blocks", blocks, 8, 1000);
    const FitOptions options{.beam = beam_named(beam),
                             .has_beam_each = beam_each,
                             .has_radial_vignetting = is_radial(vignetting),
                             .free = free,
                             .hold = hold,
                             .priors = priors,
                             .altitude_error_m = altitude_error_m,
                             .attitude_error_rad = attitude_error_deg * kRadiansPerDegree,
                             .threads = threads_of(threads)};
    require_fit_options(rig.text, options);
    CameraNumbers camera{.black_level = black_level, .white_level = white_level};
    if (bayer) camera.mosaic = mosaic_of(*bayer);
    Fitted fitted = [&]() -> Fitted {
        const nb::gil_scoped_release without_lock;
        const FitSamples samples = images.empty()
                                       ? samples_of_maps(maps, rig.rig.camera, blocks)
                                       : image_samples(rig.rig,
                                                       images,
                                                       *navigation,
                                                       camera,
                                                       blocks,
                                                       static_cast<std::size_t>(options.threads));
        return {.rig = rig.text,
                .result = fit(rig.text, samples, options, RunWatch{}),
                .skipped = samples.skipped};
    }();
    warn_of(fitted);
    return fitted;
}

TextRig save_fit(const Fitted& fitted, const fs::path& folder) {
    fs::create_directories(folder);
    write_fitted_rig(fitted.rig, fitted.result, folder);
    return TextRig(RigText(folder / kFittedRig));
}

Words not_determined(const Fitted& fitted) {
    Words words;
    for (const FittedNumber& one : fitted.result.numbers)
        if (!one.is_determined) words.push_back(words_of(one));
    return words;
}

using Pairs = std::vector<std::pair<std::string, std::string>>;

Pairs pairs_skipped(const Fitted& fitted) {
    Pairs pairs;
    for (const Skipped& one : fitted.skipped) pairs.emplace_back(one.image, one.why);
    return pairs;
}

Pairs pairs_wrong(const Fitted& fitted) {
    Pairs pairs;
    for (const Suspicion& one : fitted.result.looks_wrong) pairs.emplace_back(one.about, one.what);
    return pairs;
}

void bind_fit(nb::module_& module) {
    nb::class_<FittedNumber>(module, "FittedNumber", "A number with its standard error.")
        .def_ro("key", &FittedNumber::key)
        .def_ro("start", &FittedNumber::start)
        .def_ro("value", &FittedNumber::value)
        .def_ro("error", &FittedNumber::error)
        .def_ro("prior", &FittedNumber::spread, "Its standard deviation before the fit.")
        .def_ro("is_determined", &FittedNumber::is_determined);
    nb::class_<Fitted>(module, "Fit", "The rig that explains a survey.")
        .def_prop_ro("numbers", [](const Fitted& fitted) { return fitted.result.numbers; })
        .def_prop_ro("not_determined",
                     not_determined,
                     "What the survey does not determine, and which altitude would.")
        .def_prop_ro(
            "unevenness",
            [](const Fitted& fitted) { return fitted.result.unevenness; },
            "Expected rms unevenness of a correction by this rig over the survey's poses.")
        .def_prop_ro("skipped", pairs_skipped, "Images that could not be used, and why.")
        .def_prop_ro("looks_wrong", pairs_wrong, "What looks wrong, and why.")
        .def_prop_ro(
            "json",
            [](const Fitted& fitted) { return json_text(to_json(fitted.result)); },
            "The text of fit.json.")
        .def("save",
             save_fit,
             nb::arg("folder"),
             "Write fitted.toml and its tables into the folder, and return that rig.");
    module.def("fit",
               fit_rig,
               nb::arg("rig"),
               nb::kw_only(),
               nb::arg("maps") = std::vector<std::string>(),
               nb::arg("images") = std::vector<std::string>(),
               nb::arg("nav") = nb::none(),
               nb::arg("bayer") = nb::none(),
               nb::arg("black_level") = nb::none(),
               nb::arg("white_level") = nb::none(),
               nb::arg("beam") = "table",
               nb::arg("beam_each") = false,
               nb::arg("free") = nb::none(),
               nb::arg("hold") = Words(),
               nb::arg("priors") = std::map<std::string, double>(),
               nb::arg("vignetting") = nb::none(),
               nb::arg("altitude_error_m") = 0.02,
               nb::arg("attitude_error_deg") = 0.5,
               nb::arg("blocks") = kBlocksAcross,
               nb::arg("threads") = 0,
               "Find the rig that explains a survey, from files of observed maps, or of images "
               "with their navigation. Warns of images that are skipped and of what looks wrong.");
}

}  // namespace

void bind_survey(nb::module_& module) {
    bind_correction(module);
    bind_fit(module);
}

}  // namespace aphotic::python
