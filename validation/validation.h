// SPDX-License-Identifier: BSD-3-Clause
//
// Compares a finished render with the reference: every wavelength's radiance and every channel's
// signal, pixel by pixel, absolute scale included.
//
// Bounds of |e| off the edges (tracer.h):
//
//   radiance   kHalfFloatBound: a half float's rounding is 2^-11 = 4.9e-4 of the value; the rest
//              is for the lamps that stand for an emitter and for single-precision colours. Behind
//              a port, what a frame shared with other wavelengths may shift comes to it
//   signals    what the plan promised, the frames' rounding included
//
// In the penumbrae of emitters with a size, where some of its lamps are within a cone or unhidden
// and some are not, the light is a staircase with as many steps as there are lamps, and the
// reference has more of them. Such pixels are traced again with the render's own lamps, each a
// point with its own edges, and held to the same bounds; only those within rounding of one lamp's
// edge remain on edges.
//
// Black, below which errors are relative to it: for radiance the smallest normal half float of the
// frame's exposure, for signals kBlackShare of the brightest, or where the frames' half floats end
// (Manifest::black), whichever is more.
#pragma once

#include "validation/report.h"
#include "validation/tracer.h"

#include <functional>
#include <span>
#include <vector>

namespace aphotic {

inline constexpr double kHalfFloatBound = 6e-4;
inline constexpr double kBlackShare = 1e-8;

// A render, as the commands supply it.
struct RenderedImages {
    std::vector<double> lambda_nm;
    // By wavelength: whose refractive indices its frame has, and the possible effect of that.
    std::vector<double> index_nm;
    std::vector<double> shift_error;
    std::vector<double> radiance_black;  // and under which frames lose digits
    double veil_error = 0.0;             // of the radiance of wavelengths
    std::array<double, kChannels> promise{};
    std::array<double, kChannels> black{};
    // The planes of radiance of wavelengths [first, first + count), one after another.
    std::function<std::vector<float>(std::size_t first, std::size_t count)> radiance;
    CameraImage signals;
    // By strobe, the lamps of its emitter; empty if unknown: then penumbrae are edges.
    std::vector<EmitterLamps> lamps{};
};

// Traces, compares, and fills the report's comparisons, images, errors and trace_s; what only the
// render knows is left to the caller. report: called with the share of the work.
[[nodiscard]] ValidationReport validate(const Rig& rig,
                                        const RenderedImages& rendered,
                                        int threads,
                                        const std::function<void(double)>& progress = {});

}  // namespace aphotic
