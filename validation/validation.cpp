// SPDX-License-Identifier: BSD-3-Clause
#include "validation/validation.h"

#include "base/stopwatch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace aphotic {
namespace {

// The number of planes in memory, for each renderer.
constexpr std::size_t kPlanesAtATime = 6;
// The signals' share of the work, for the progress: a full spectrum against a few planes.
constexpr double kShareOfSignals = 0.5;

std::size_t pixels_of(const Rig& rig) {
    return static_cast<std::size_t>(rig.camera.width_px) *
           static_cast<std::size_t>(rig.camera.height_px);
}

// The wavelength, with as few digits as distinguish it from the others.
std::string wavelength_name(double lambda_nm) {
    return fmt::format("{:.6g} nm", lambda_nm);
}

// Empty if no emitter has a size, or its lamps are unknown.
std::optional<Tracer> tracer_of_lamps(const Rig& rig,
                                      const RenderedImages& rendered,
                                      TraceOptions options) {
    const bool has_emitter = std::ranges::any_of(
        rig.strobes, [](const Strobe& strobe) { return strobe.emitter.has_value(); });
    if (!has_emitter || rendered.lamps.empty()) return std::nullopt;
    options.rendered_lamps = rendered.lamps;
    return Tracer(rig, options);
}

struct Edges {
    std::vector<unsigned char> marks;       // of every pixel: not compared
    std::vector<std::size_t> in_penumbrae;  // compared with the result of the render's own lamps
};

Edges edges_of(const Tracer& reference,
               const std::optional<Tracer>& of_lamps,
               WavelengthRange range) {
    Edges edges{.marks = reference.on_edges(range), .in_penumbrae = {}};
    if (!of_lamps) return edges;
    std::vector<std::size_t> marked;
    for (std::size_t i = 0; i < edges.marks.size(); ++i) {
        if (edges.marks[i] != 0) marked.push_back(i);
    }
    const std::vector<unsigned char> stays = of_lamps->on_edges_of(marked, range);
    for (std::size_t n = 0; n < marked.size(); ++n) {
        if (stays[n] != 0) continue;
        edges.marks[marked[n]] = 0;
        edges.in_penumbrae.push_back(marked[n]);
    }
    return edges;
}

struct HeldPlane {
    std::string name;
    std::span<const float> rendered;
    std::span<double> traced;
    std::span<const double> of_lamps;  // in the penumbrae, by the render's own lamps
    double black = 0.0;
    double bound = 0.0;
};

// In penumbrae the samples of the render's own lamps replace the reference's, after the difference
// from those has been recorded.
Comparison compare_held(const HeldPlane& plane, const Edges& edges, int width_px) {
    double max_error = 0.0;
    for (std::size_t n = 0; n < edges.in_penumbrae.size(); ++n) {
        const std::size_t i = edges.in_penumbrae[n];
        const double e = std::abs(relative_error(plane.rendered[i], plane.traced[i], plane.black));
        max_error = std::max(max_error, std::isnan(e) ? 0.0 : e);
        plane.traced[i] = plane.of_lamps[n];
    }
    Comparison comparison = compare_planes(
        plane.name, plane.rendered, plane.traced, width_px, edges.marks, plane.black, plane.bound);
    comparison.in_penumbrae = edges.in_penumbrae.size();
    comparison.max_error_of_penumbrae = max_error;
    return comparison;
}

void compare_radiance(const Rig& rig,
                      const RenderedImages& rendered,
                      int threads,
                      const std::function<void(double)>& progress,
                      ValidationReport& report) {
    const std::size_t pixels = pixels_of(rig);
    const std::size_t count = rendered.lambda_nm.size();
    // Without a port there is no refraction, and all wavelengths have the same edges.
    std::optional<Edges> edges;
    for (std::size_t first = 0; first < count; first += kPlanesAtATime) {
        const std::size_t part = std::min(kPlanesAtATime, count - first);
        TraceOptions options{.signals = false, .planes_nm = {}, .threads = threads};
        for (std::size_t j = first; j < first + part; ++j) {
            options.planes_nm.push_back(rendered.lambda_nm[j]);
        }
        const Tracer tracer(rig, options);
        std::vector<double> traced = tracer.rows(0, rig.camera.height_px);
        const std::vector<float> found = rendered.radiance(first, part);
        for (std::size_t k = 0; k < part; ++k) {
            const double lambda_nm = rendered.lambda_nm[first + k];
            const double index_nm = rendered.index_nm[first + k];
            options.planes_nm = {lambda_nm};
            const std::optional<Tracer> of_lamps = tracer_of_lamps(rig, rendered, options);
            if (!edges || rig.camera.port) {
                edges = edges_of(tracer,
                                 of_lamps,
                                 {.first_nm = std::min(lambda_nm, index_nm),
                                  .last_nm = std::max(lambda_nm, index_nm)});
            }
            std::vector<double> again;
            if (of_lamps) again = of_lamps->pixels(edges->in_penumbrae);
            report.wavelengths.push_back(compare_held(
                {.name = wavelength_name(lambda_nm),
                 .rendered = std::span(found).subspan(k * pixels, pixels),
                 .traced = std::span(traced).subspan(k * pixels, pixels),
                 .of_lamps = again,
                 .black = rendered.radiance_black[first + k],
                 .bound = kHalfFloatBound + rendered.shift_error[first + k] + rendered.veil_error},
                *edges,
                rig.camera.width_px));
        }
        if (progress) {
            progress(kShareOfSignals + (1.0 - kShareOfSignals) * static_cast<double>(first + part) /
                                           static_cast<double>(count));
        }
    }
}

void compare_signals(const Rig& rig,
                     const RenderedImages& rendered,
                     int threads,
                     const std::function<void(double)>& progress,
                     ValidationReport& report) {
    const std::size_t pixels = pixels_of(rig);
    const TraceOptions options{.signals = true, .planes_nm = {}, .threads = threads};
    const Tracer tracer(rig, options);
    report.grid_size = tracer.grid_size();
    std::vector<double> traced = tracer.rows(0, rig.camera.height_px, [&](double share) {
        if (progress) progress(kShareOfSignals * share);
    });
    report.traced = {.width_px = rig.camera.width_px,
                     .height_px = rig.camera.height_px,
                     .samples = {traced.begin(), traced.end()}};
    const std::optional<Tracer> of_lamps = tracer_of_lamps(rig, rendered, options);
    const Edges edges = edges_of(tracer, of_lamps, rig.camera.range);
    const std::size_t count = edges.in_penumbrae.size();
    std::vector<double> again;
    if (of_lamps) again = of_lamps->pixels(edges.in_penumbrae);
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto a = std::span<const float>(rendered.signals.samples).subspan(c * pixels, pixels);
        const auto b = std::span(traced).subspan(c * pixels, pixels);
        const double black = std::max(kBlackShare * std::ranges::max(b), rendered.black[c]);
        report.channels.push_back(
            compare_held({.name = std::string(kChannelNames[c]),
                          .rendered = a,
                          .traced = b,
                          .of_lamps = std::span(again).subspan(c * count, count),
                          .black = black,
                          .bound = rendered.promise[c]},
                         edges,
                         rig.camera.width_px));
        for (std::size_t i = 0; i < pixels; ++i) {
            const double e = edges.marks[i] != 0 ? std::numeric_limits<double>::quiet_NaN()
                                                 : relative_error(a[i], b[i], black);
            report.channel_errors.push_back(static_cast<float>(e));
        }
    }
}

// If all surfaces are black, only the veil remains.
VeilShare traced_veil_share(Rig rig, const CameraImage& traced) {
    VeilShare share{};
    if (!rig.water.scatters()) return share;
    const auto blacken = [](Spectrum& reflectance, double& phong) {
        reflectance = {reflectance.name(),
                       {reflectance.lambda_nm().begin(), reflectance.lambda_nm().end()},
                       std::vector<double>(reflectance.values().size(), 0.0)};
        phong = 0.0;
    };
    blacken(rig.seafloor.reflectance, rig.seafloor.phong);
    for (Object& object : rig.objects) blacken(object.reflectance, object.phong);
    const std::size_t middle = middle_pixel(traced.width_px, traced.height_px);
    const std::vector<double> veil =
        Tracer(rig, {.signals = true, .planes_nm = {}}).pixels({&middle, 1});
    const std::size_t plane = traced.samples.size() / kChannels;
    for (std::size_t c = 0; c < kChannels; ++c)
        share[c] = veil_share(veil[c], traced.samples[c * plane + middle]);
    return share;
}

}  // namespace

ValidationReport validate(const Rig& rig,
                          const RenderedImages& rendered,
                          int threads,
                          const std::function<void(double)>& progress) {
    const Stopwatch watch;
    ValidationReport report{.rig = rig};
    report.lambda_nm = rendered.lambda_nm;
    report.rendered = rendered.signals;
    compare_signals(rig, rendered, threads, progress, report);
    compare_radiance(rig, rendered, threads, progress, report);
    report.veil_share = traced_veil_share(rig, report.traced);
    report.trace_s = watch.seconds();
    return report;
}

}  // namespace aphotic
