// SPDX-License-Identifier: BSD-3-Clause
//
// Compares a finished render with the reference: every wavelength's radiance and every channel's
// signal, pixel by pixel, absolute scale included.
//
// Bounds of |e| off the edges (tracer.h):
//
//   radiance   kHalfFloatBound: a half float's rounding is 2^-11 = 4.9e-4 of the value; the rest
//              is for the lamps that represent an emitter and for single-precision colours. Behind
//              a port, the effect of shifts in a frame shared by wavelengths is added
//   signals    the plan's promise, which includes the frames' rounding
//
// In the penumbra of an emitter with a size, where the floor is lit by some of its lamps only,
// because of a cone or an object, the light is a staircase with as many steps as lamps, and the
// reference has more of them. Such pixels are traced again with the render's own lamps, each a
// point with its own edges, and held to the same bounds; only those within rounding of one lamp's
// edge remain on edges.
//
// Black, below which errors are relative to it: for radiance, the smallest normal half float of the
// frame's exposure; for signals, kBlackShare of the brightest, or the limit of the frames' half
// floats (Manifest::black), whichever is more.
#pragma once

#include "validation/report.h"
#include "validation/tracer.h"

#include <functional>
#include <span>
#include <vector>

namespace aphotic {

inline constexpr double kHalfFloatBound = 6e-4;
inline constexpr double kBlackShare = 1e-8;

// A render, as supplied by the commands.
struct RenderedImages {
    std::vector<double> lambda_nm;
    // By wavelength: the wavelength of its frame's refractive indices, and the possible effect of
    // that.
    std::vector<double> index_nm;
    std::vector<double> shift_error;
    std::vector<double> radiance_black;  // the level below which frames lose digits
    double veil_error = 0.0;             // of the radiance of wavelengths
    std::array<double, kChannels> promise{};
    std::array<double, kChannels> black{};
    // The planes of radiance of wavelengths [first, first + count), one after another.
    std::function<std::vector<float>(std::size_t first, std::size_t count)> radiance;
    CameraImage signals;
    // The lamps of each strobe's emitter, by strobe; empty if unknown: then penumbrae are edges.
    std::vector<EmitterLamps> lamps{};
};

// Traces, compares, and fills the report's comparisons, images, errors and trace_s; the caller
// fills the fields that depend on the render. report: called with the share of the work.
[[nodiscard]] ValidationReport validate(const Rig& rig,
                                        const RenderedImages& rendered,
                                        int threads,
                                        const std::function<void(double)>& progress = {});

}  // namespace aphotic
