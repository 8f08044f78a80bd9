// SPDX-License-Identifier: BSD-3-Clause
#include "validation/validation.h"

#include "validation/tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace aphotic {
namespace {

// Planes held at a time, of each renderer.
constexpr std::size_t kPlanesAtATime = 6;
constexpr int kSmallestNormalHalfLog2 = -14;
// How much of the work the signals are, for the progress: a full spectrum against a few planes.
constexpr double kShareOfSignals = 0.5;

std::size_t pixels_of(const Rig& rig) {
    return static_cast<std::size_t>(rig.camera.width_px) *
           static_cast<std::size_t>(rig.camera.height_px);
}

// Which wavelength, shortest as needed to tell it from others.
std::string wavelength_name(double lambda_nm) {
    return fmt::format("{:.6g} nm", lambda_nm);
}

void compare_radiance(const Rig& rig,
                      const RenderedImages& rendered,
                      int threads,
                      const std::function<void(double)>& progress,
                      ValidationReport& report) {
    const std::size_t pixels = pixels_of(rig);
    const std::size_t count = rendered.lambda_nm.size();
    // Nothing is bent without a port, and all wavelengths have the same edges.
    std::vector<unsigned char> on_edge;
    for (std::size_t first = 0; first < count; first += kPlanesAtATime) {
        const std::size_t part = std::min(kPlanesAtATime, count - first);
        TraceOptions options{.signals = false, .planes_nm = {}, .threads = threads};
        for (std::size_t j = first; j < first + part; ++j) {
            options.planes_nm.push_back(rendered.lambda_nm[j]);
        }
        const Tracer tracer(rig, options);
        const std::vector<double> traced = tracer.rows(0, rig.camera.height_px);
        const std::vector<float> found = rendered.radiance(first, part);
        for (std::size_t k = 0; k < part; ++k) {
            const double lambda_nm = rendered.lambda_nm[first + k];
            const double index_nm = rendered.index_nm[first + k];
            if (on_edge.empty() || rig.camera.port) {
                on_edge = tracer.on_edges({.first_nm = std::min(lambda_nm, index_nm),
                                           .last_nm = std::max(lambda_nm, index_nm)});
            }
            report.wavelengths.push_back(compare_planes(
                wavelength_name(lambda_nm),
                std::span(found).subspan(k * pixels, pixels),
                std::span(traced).subspan(k * pixels, pixels),
                rig.camera.width_px,
                on_edge,
                std::exp2(kSmallestNormalHalfLog2 - rendered.exposure_log2[first + k]),
                kHalfFloatBound + rendered.shift_error[first + k]));
        }
        if (progress) {
            progress(kShareOfSignals + (1.0 - kShareOfSignals) * static_cast<double>(first + part) /
                                           static_cast<double>(count));
        }
    }
}

// The signals over the full spectrum, in rows so that the progress shows.
std::vector<double> trace_signals(const Tracer& tracer,
                                  const std::function<void(double)>& progress) {
    constexpr int kRows = 32;
    const int height_px = tracer.rig().camera.height_px;
    const std::size_t pixels = pixels_of(tracer.rig());
    std::vector<double> signals(kChannels * pixels);
    for (int row = 0; row < height_px; row += kRows) {
        const int rows = std::min(kRows, height_px - row);
        const std::vector<double> block = tracer.rows(row, rows);
        const std::size_t plane = block.size() / kChannels;
        const std::size_t before =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(tracer.rig().camera.width_px);
        for (std::size_t c = 0; c < kChannels; ++c) {
            std::ranges::copy(std::span(block).subspan(c * plane, plane),
                              signals.begin() + static_cast<std::ptrdiff_t>(c * pixels + before));
        }
        if (progress) progress(kShareOfSignals * (row + rows) / height_px);
    }
    return signals;
}

void compare_signals(const Rig& rig,
                     const RenderedImages& rendered,
                     int threads,
                     const std::function<void(double)>& progress,
                     ValidationReport& report) {
    const std::size_t pixels = pixels_of(rig);
    const Tracer tracer(rig, {.signals = true, .planes_nm = {}, .threads = threads});
    report.grid_size = tracer.grid_size();
    const std::vector<double> traced = trace_signals(tracer, progress);
    const std::vector<unsigned char> on_edge = tracer.on_edges(rig.camera.range);
    report.traced = {.width_px = rig.camera.width_px,
                     .height_px = rig.camera.height_px,
                     .samples = {traced.begin(), traced.end()}};
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto a = std::span<const float>(rendered.signals.samples).subspan(c * pixels, pixels);
        const auto b = std::span(traced).subspan(c * pixels, pixels);
        const double black = std::max(kBlackShare * std::ranges::max(b), rendered.black[c]);
        report.channels.push_back(compare_planes(std::string(kChannelNames[c]),
                                                 a,
                                                 b,
                                                 rig.camera.width_px,
                                                 on_edge,
                                                 black,
                                                 rendered.promise[c]));
        for (std::size_t i = 0; i < pixels; ++i) {
            const double e = on_edge[i] != 0 ? std::numeric_limits<double>::quiet_NaN()
                                             : relative_error(a[i], b[i], black);
            report.channel_errors.push_back(static_cast<float>(e));
        }
    }
}

}  // namespace

ValidationReport validate(const Rig& rig,
                          const RenderedImages& rendered,
                          int threads,
                          const std::function<void(double)>& progress) {
    const auto start = std::chrono::steady_clock::now();
    ValidationReport report{.rig = rig};
    report.lambda_nm = rendered.lambda_nm;
    report.rendered = rendered.signals;
    compare_signals(rig, rendered, threads, progress, report);
    compare_radiance(rig, rendered, threads, progress, report);
    report.trace_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
}

}  // namespace aphotic
