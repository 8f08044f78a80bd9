// SPDX-License-Identifier: BSD-3-Clause
#include "base/degrees.h"
#include "base/error.h"
#include "lightmap/planes.h"
#include "python/bindings.h"
#include "scene_gen/render_plan.h"
#include "validation/model_check.h"
#include "validation/tracer.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <optional>

namespace aphotic::python {
namespace {

using NoLock = nb::call_guard<nb::gil_scoped_release>;

// --- Plans --------------------------------------------------------------------------------------

PlanRequest request_of(double tolerance,
                       std::optional<int> fitted,
                       std::optional<int> bands,
                       const std::vector<double>& wavelengths_nm,
                       const std::optional<std::pair<double, double>>& paths_m) {
    require_range("tolerance", tolerance, 0.0, 1.0);
    if (fitted) require_range("fitted", *fitted, 1, kMostFitted);
    if (bands) require_range("bands", *bands, 1, kMostBands);
    const int ways = (fitted ? 1 : 0) + (bands ? 1 : 0) + (wavelengths_nm.empty() ? 0 : 1);
    if (ways > 1)
        throw InputError("found {} of fitted, bands and wavelengths_nm; allowed: one of them",
                         ways);
    PlanRequest request{.tolerance = tolerance,
                        .fitted = fitted,
                        .bands = bands,
                        .wavelengths_nm = wavelengths_nm,
                        .paths = std::nullopt,
                        .scene = {}};
    if (paths_m) {
        require_range("paths_m", paths_m->first, kLeastPath_m, kMostPath_m);
        require_range("paths_m", paths_m->second, paths_m->first, kMostPath_m);
        request.paths = PathRange{.shortest_m = paths_m->first, .longest_m = paths_m->second};
    }
    return request;
}

RenderPlan plan(const TextRig& rig,
                double tolerance,
                std::optional<int> fitted,
                std::optional<int> bands,
                const std::vector<double>& wavelengths_nm,
                const std::optional<std::pair<double, double>>& paths_m) {
    if (!rig.rig.scene.empty()) {
        throw InputError(
            "scene: found {}, which only POV-Ray can read; allowed: a rig without a "
            "scene, or the command `aphotic plan`",
            rig.rig.scene.string());
    }
    return plan_render(rig.rig, request_of(tolerance, fitted, bands, wavelengths_nm, paths_m));
}

Array<double, 1> wavelengths_of(const RenderPlan& plan) {
    std::vector<double> lambda_nm;
    for (const PlannedWavelength& w : plan.wavelengths) lambda_nm.push_back(w.lambda_nm);
    return list_of(std::move(lambda_nm));
}

Array<double, 2> weights_of(const RenderPlan& plan) {
    std::vector<double> weights;
    for (const PlannedWavelength& w : plan.wavelengths)
        weights.insert(weights.end(), w.weight.begin(), w.weight.end());
    return table_of(std::move(weights), kChannels);
}

std::optional<std::array<double, kChannels>> promise_of(const RenderPlan& plan) {
    if (!plan.no_promise.empty()) return std::nullopt;
    std::array<double, kChannels> promise{};
    for (std::size_t c = 0; c < kChannels; ++c)
        promise[c] = plan.quality[c].promise(plan.frame_error);
    return promise;
}

void bind_plan(nb::module_& module) {
    nb::class_<RenderPlan>(module, "Plan", "The wavelengths, weights and frames of a render.")
        .def_prop_ro("wavelengths_nm", wavelengths_of, kOwn)
        .def_prop_ro("weights", weights_of, kOwn, "By wavelength, then R, G, B.")
        .def_prop_ro("frames", &RenderPlan::frames)
        .def_prop_ro("promise",
                     promise_of,
                     "Bound of the relative error of R, G and B; None if there is none.")
        .def_ro("no_promise", &RenderPlan::no_promise, "Why there is none.")
        .def_prop_ro("paths_m", [](const RenderPlan& plan) {
            return std::pair(plan.family.shortest_path_m, plan.family.longest_path_m);
        });
    module.def("plan",
               plan,
               nb::arg("rig"),
               nb::kw_only(),
               nb::arg("tolerance") = 1e-3,
               nb::arg("fitted") = nb::none(),
               nb::arg("bands") = nb::none(),
               nb::arg("wavelengths_nm") = std::vector<double>(),
               nb::arg("paths_m") = nb::none(),
               NoLock(),
               "What a render would take, as `aphotic plan` says it.");
}

// --- Lightmaps ----------------------------------------------------------------------------------

LightmapOptions map_options(double error, double tolerance, bool has_veil, int threads) {
    require_range("error", error, kLeastMapError, kMostMapError);
    require_range("tolerance", tolerance, 0.0, kMostMapError);
    return {.error = error,
            .threads = threads_of(threads),
            .has_veil = has_veil,
            .veil_tolerance = tolerance};
}

RigLightmap lightmap(const TextRig& rig,
                     double error,
                     double tolerance,
                     bool has_veil,
                     bool has_strobes,
                     int threads) {
    const LightmapOptions options = map_options(error, tolerance, has_veil, threads);
    const LightmapMaker maker(rig.rig, std::nullopt, options);
    RigLightmap light{.rig = std::make_shared<const Rig>(rig.rig), .map = maker.map(rig.rig.sled)};
    if (!has_strobes) return light;
    for (const RigPart& part : parts_by_strobe(rig.rig)) {
        RigLightmap own{.rig = std::make_shared<const Rig>(part.rig),
                        .map = LightmapMaker(part.rig, maker.paths(), options).map(rig.rig.sled)};
        light.strobes.emplace(part.name, std::move(own));
    }
    return light;
}

// Computes tables once, then maps for any pose and any places of the strobes in milliseconds.
class RigLightmapMaker {
  public:
    RigLightmapMaker(const TextRig& rig,
                     const std::vector<double>& altitudes_m,
                     double error,
                     double tolerance,
                     bool has_veil,
                     int threads)
        : rig_(rig.rig),
          maker_(rig.rig,
                 paths_for(rig.rig, altitudes_m),
                 map_options(error, tolerance, has_veil, threads)) {}

    [[nodiscard]] RigLightmap map(std::optional<double> altitude_m,
                                  std::optional<double> pitch_deg,
                                  std::optional<double> roll_deg) const {
        Rig rig = rig_;
        if (altitude_m) {
            require_range("altitude_m", *altitude_m, kLeastAltitude_m, kMostAltitude_m);
            rig.sled.altitude_m = *altitude_m;
        }
        if (pitch_deg) {
            require_range("pitch_deg", *pitch_deg, -kMostTilt_deg, kMostTilt_deg);
            rig.sled.pitch_rad = *pitch_deg * kRadiansPerDegree;
        }
        if (roll_deg) {
            require_range("roll_deg", *roll_deg, -kMostTilt_deg, kMostTilt_deg);
            rig.sled.roll_rad = *roll_deg * kRadiansPerDegree;
        }
        Lightmap map = maker_.map(rig.sled);
        return {.rig = std::make_shared<const Rig>(std::move(rig)), .map = std::move(map)};
    }

    void place(const TextRig& rig) {
        if (rig.rig.strobes.size() != rig_.strobes.size()) {
            throw InputError("strobes: found {}; allowed: {}, like the tables",
                             rig.rig.strobes.size(),
                             rig_.strobes.size());
        }
        std::vector<StrobePlace> places;
        for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
            const Strobe& strobe = rig.rig.strobes[s];
            rig_.strobes[s].position_m = strobe.position_m;
            rig_.strobes[s].axis = strobe.axis;
            rig_.strobes[s].power = strobe.power;
            places.push_back({strobe.position_m, strobe.axis, strobe.power});
        }
        maker_.place(places);
    }

  private:
    // Never empty, since paths outside a map's tables would silently be black.
    static PathRange paths_for(const Rig& rig, const std::vector<double>& altitudes_m) {
        std::vector<Sled> sleds{rig.sled};
        for (const double altitude_m : altitudes_m) {
            sleds.push_back(rig.sled);
            sleds.back().altitude_m = altitude_m;
        }
        return paths_of(rig, sleds);
    }

    Rig rig_;
    LightmapMaker maker_;
};

Array<float, 3> floor_of(nb::handle self) {
    auto& light = nb::cast<RigLightmap&>(self);
    return image_of_planes(
        light.map.samples.data(), light.map.height_px, light.map.width_px, kChannels, self);
}

std::optional<Array<float, 3>> veil_of(nb::handle self) {
    auto& light = nb::cast<RigLightmap&>(self);
    if (light.map.veil.empty()) return std::nullopt;
    return image_of_planes(
        light.map.veil.data(), light.map.height_px, light.map.width_px, kChannels, self);
}

template <std::size_t kChannel>
Array<float, 2> channel_of(nb::handle self) {
    auto& light = nb::cast<RigLightmap&>(self);
    const auto height = static_cast<std::size_t>(light.map.height_px);
    const auto width = static_cast<std::size_t>(light.map.width_px);
    return Array<float, 2>(
        light.map.samples.data() + kChannel * height * width, {height, width}, self);
}

void bind_lightmap(nb::module_& module) {
    nb::class_<RigLightmap>(
        module, "Lightmap", "The camera's signal on the bare flat floor; rows, columns, channels.")
        .def_prop_ro("R", channel_of<0>)
        .def_prop_ro("G", channel_of<1>)
        .def_prop_ro("B", channel_of<2>)
        .def_prop_ro("floor", floor_of, "R, G and B of the floor's light: a view, not a copy.")
        .def_prop_ro("veil", veil_of, "What the water scatters into the view; None in clear water.")
        .def_prop_ro(
            "signal",
            [](const RigLightmap& light) {
                return image_of(signal_of(light.map), light.map.height_px, light.map.width_px);
            },
            kOwn,
            "Floor plus veil: the camera's signal.")
        .def_ro("strobes", &RigLightmap::strobes, "By name, each strobe's own light.");
    module.def("lightmap",
               lightmap,
               nb::arg("rig"),
               nb::kw_only(),
               nb::arg("error") = 1e-5,
               nb::arg("tolerance") = kVeilOfSignal,
               nb::arg("veil") = true,
               nb::arg("per_strobe") = false,
               nb::arg("threads") = 0,
               NoLock(),
               "Map the signal on the rig's bare flat floor, without POV-Ray. error: relative, of "
               "the spectral integral; tolerance: of the veil, relative to the signal.");

    nb::class_<RigLightmapMaker>(
        module, "LightmapMaker", "Tables made once, for many maps of one rig in milliseconds each.")
        .def(nb::init<const TextRig&, const std::vector<double>&, double, double, bool, int>(),
             nb::arg("rig"),
             nb::kw_only(),
             nb::arg("altitudes_m") = std::vector<double>(),
             nb::arg("error") = 1e-5,
             nb::arg("tolerance") = kVeilOfSignal,
             nb::arg("veil") = true,
             nb::arg("threads") = 0,
             NoLock(),
             "altitudes_m: the range of altitudes to prepare for, besides the rig's own.")
        .def("map",
             &RigLightmapMaker::map,
             nb::kw_only(),
             nb::arg("altitude_m") = nb::none(),
             nb::arg("pitch_deg") = nb::none(),
             nb::arg("roll_deg") = nb::none(),
             NoLock(),
             "The map of this pose; values omitted are the rig's.")
        .def("place",
             &RigLightmapMaker::place,
             nb::arg("rig"),
             "Take the strobes' positions, aims and powers from this rig from now on; lamps and "
             "beams stay.");
}

// --- The reference ------------------------------------------------------------------------------

struct Traced {
    int height_px = 0;
    int width_px = 0;
    bool has_signals = true;
    std::vector<double> lambda_nm;
    std::vector<double> planes;  // R, G, B if requested, then one per wavelength
    std::vector<unsigned char> on_edges;

    [[nodiscard]] std::size_t pixels() const {
        return static_cast<std::size_t>(height_px) * static_cast<std::size_t>(width_px);
    }
};

Traced trace(const TextRig& rig,
             const std::vector<double>& wavelengths_nm,
             bool has_signals,
             int threads) {
    if (!has_signals && wavelengths_nm.empty())
        throw InputError("signals: found False without wavelengths_nm; allowed: one of both");
    const Camera& camera = rig.rig.camera;
    const Tracer tracer(
        rig.rig,
        {.signals = has_signals, .planes_nm = wavelengths_nm, .threads = threads_of(threads)});
    return {.height_px = camera.height_px,
            .width_px = camera.width_px,
            .has_signals = has_signals,
            .lambda_nm = wavelengths_nm,
            .planes = tracer.rows(0, camera.height_px),
            .on_edges = tracer.on_edges(camera.range)};
}

std::optional<Array<double, 3>> traced_signal(nb::handle self) {
    auto& traced = nb::cast<Traced&>(self);
    if (!traced.has_signals) return std::nullopt;
    return image_of_planes(
        traced.planes.data(), traced.height_px, traced.width_px, kChannels, self);
}

Array<double, 3> traced_radiance(nb::handle self) {
    auto& traced = nb::cast<Traced&>(self);
    const std::size_t first = traced.has_signals ? kChannels : 0;
    return image_of_planes(traced.planes.data() + first * traced.pixels(),
                           traced.height_px,
                           traced.width_px,
                           traced.lambda_nm.size(),
                           self);
}

Array<bool, 2> traced_edges(const Traced& traced) {
    auto [data, owner] = owned(traced.on_edges);
    // 0 or 1, as in NumPy's bool.
    return Array<bool, 2>(
        data,
        {static_cast<std::size_t>(traced.height_px), static_cast<std::size_t>(traced.width_px)},
        owner);
}

std::array<double, kChannels> model_error(const TextRig& rig, int threads) {
    return check_model(rig.rig, kModelPaths, threads_of(threads)).rms();
}

void bind_trace(nb::module_& module) {
    nb::class_<Traced>(module, "Trace", "Images of the reference tracer.")
        .def_prop_ro("signal", traced_signal, "Rows, columns, R, G, B; None unless asked for.")
        .def_prop_ro("radiance", traced_radiance, "Rows, columns, wavelengths.")
        .def_ro("wavelengths_nm", &Traced::lambda_nm)
        .def_prop_ro("on_edges", traced_edges, kOwn, "Where the signal steps and no bound holds.");
    module.def("trace",
               trace,
               nb::arg("rig"),
               nb::kw_only(),
               nb::arg("wavelengths_nm") = std::vector<double>(),
               nb::arg("signals") = true,
               nb::arg("threads") = 0,
               NoLock(),
               "Trace the rig's floor and objects over the full spectrum, without POV-Ray.");
    module.def("model_error",
               model_error,
               nb::arg("rig"),
               nb::kw_only(),
               nb::arg("threads") = 0,
               NoLock(),
               "In water that scatters, the share of R, G and B that the model leaves out, "
               "estimated.");
}

}  // namespace

void bind_light(nb::module_& module) {
    bind_plan(module);
    bind_lightmap(module);
    bind_trace(module);
}

}  // namespace aphotic::python
