// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/quadrature_certificate.h"

#include "spectral/panel_quadrature.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace aphotic {
namespace {

using Real = long double;
using Index = Eigen::Index;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Array = Eigen::Array<Real, Eigen::Dynamic, 1>;

constexpr Real kInfinite = std::numeric_limits<Real>::infinity();

Real exact_source_at(const std::vector<Spectrum>& source, double lambda_nm) {
    Real value = 1.0L;
    for (const Spectrum& factor : source) value *= factor.at(lambda_nm);
    return value;
}

// All integrands at every node.
struct Nodes {
    Array attenuation_per_m;
    Array tilt;
    Matrix sources;    // nodes by sources, times the node's weight
    Matrix responses;  // nodes by R, G, B, and 1 for all light
};

std::vector<QuadratureNode> quadrature_of(const Sensor& sensor,
                                          const LightFamily& family,
                                          WavelengthRange range) {
    std::vector<const Spectrum*> tables = sensor.curves();
    for (const auto& source : family.sources) {
        for (const Spectrum& factor : source) tables.push_back(&factor);
    }
    return panel_quadrature(light_panels(tables,
                                         family.water,
                                         family.shortest_path_m,
                                         family.longest_path_m,
                                         family.tilt ? &*family.tilt : nullptr,
                                         range));
}

Nodes nodes_of(const Sensor& sensor, const LightFamily& family, WavelengthRange range) {
    const std::vector<QuadratureNode> quadrature = quadrature_of(sensor, family, range);
    const auto count = static_cast<Index>(quadrature.size());
    const auto sources = static_cast<Index>(family.sources.size());
    Nodes nodes{.attenuation_per_m = Array(count),
                .tilt = Array::Zero(count),
                .sources = Matrix(count, sources),
                .responses = Matrix(count, kChannels + 1)};
    for (Index i = 0; i < count; ++i) {
        const auto& [lambda_nm, width_nm] = quadrature[static_cast<std::size_t>(i)];
        nodes.attenuation_per_m(i) = family.water.attenuation_per_m(lambda_nm);
        if (family.tilt) nodes.tilt(i) = family.tilt->at(lambda_nm);
        for (Index s = 0; s < sources; ++s) {
            nodes.sources(i, s) =
                width_nm * exact_source_at(family.sources[static_cast<std::size_t>(s)], lambda_nm);
        }
        for (int c = 0; c < kChannels; ++c) nodes.responses(i, c) = sensor.response(c, lambda_nm);
        nodes.responses(i, kChannels) = 1.0L;
    }
    return nodes;
}

std::vector<double> paths_of(const LightFamily& family) {
    std::vector<double> paths_m;
    const int count = family.tilt ? kCertifiedPathsOfEachTilt : kCertifiedPaths;
    for (int i = 0; i < count; ++i) {
        const double share = i / (count - 1.0);
        const double even_m = std::lerp(family.shortest_path_m, family.longest_path_m, share);
        paths_m.push_back(family.shortest_path_m > 0.0
                              ? family.shortest_path_m *
                                    std::pow(family.longest_path_m / family.shortest_path_m, share)
                              : even_m);
    }
    return paths_m;
}

// By member: signals in R, G, B and all its light; the rule's result from its frames, and the sum
// of absolute values.
struct Members {
    Matrix signals;
    Matrix found;
    Matrix amplified;
};

Members members_of(const Nodes& nodes,
                   const LightFamily& family,
                   std::span<const WeightedWavelength> rule,
                   std::span<const FrameLight> frames) {
    const std::vector<double> paths_m = paths_of(family);
    const std::vector<double> tilts =
        family.tilt ? std::vector{-1.0, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 1.0}
                    : std::vector{0.0};
    const auto sources = static_cast<Index>(family.sources.size());
    const auto count = sources * static_cast<Index>(paths_m.size() * tilts.size());
    constexpr Index kSignals = kChannels + 1;
    Members members{.signals = Matrix(count, kSignals),
                    .found = Matrix::Zero(count, kChannels),
                    .amplified = Matrix::Zero(count, kChannels)};
    Matrix integrands(nodes.sources.rows(), sources * kSignals);
    for (Index s = 0; s < sources; ++s) {
        integrands.middleCols(s * kSignals, kSignals) =
            nodes.sources.col(s).asDiagonal() * nodes.responses;
    }
    Index row = 0;
    for (const double path_m : paths_m) {
        for (const double tilt : tilts) {
            const Array kept = (Real(tilt) * nodes.tilt - nodes.attenuation_per_m * path_m).exp();
            const Matrix signals = kept.matrix().transpose() * integrands;
            Real brightest = 0.0L;
            for (Index s = 0; s < sources; ++s) {
                brightest = std::max(brightest, signals(0, s * kSignals + kChannels));
            }
            for (Index s = 0; s < sources; ++s, ++row) {
                members.signals.row(row) = signals.middleCols(s * kSignals, kSignals);
                if (members.signals(row, kChannels) < kDarkness * brightest) {
                    members.signals.row(row).setZero();
                    continue;
                }
                for (std::size_t j = 0; j < frames.size(); ++j) {
                    const FrameLight& frame = frames[j];
                    const Real light =
                        frame.sources[static_cast<std::size_t>(s)] *
                        std::exp(Real(tilt) * frame.tilt - Real(frame.attenuation_per_m) * path_m);
                    for (Index c = 0; c < kChannels; ++c) {
                        const Real weight = rule[j].weight[static_cast<std::size_t>(c)];
                        members.found(row, c) += weight * light;
                        members.amplified(row, c) += std::abs(weight) * light;
                    }
                }
            }
        }
    }
    return members;
}

}  // namespace

std::array<RuleQuality, kChannels> certified_quality(const Sensor& sensor,
                                                     const LightFamily& family,
                                                     WavelengthRange range,
                                                     std::span<const WeightedWavelength> rule,
                                                     std::span<const FrameLight> frames) {
    const Members members = members_of(nodes_of(sensor, family, range), family, rule, frames);
    const Array light = members.signals.col(kChannels).array();
    std::array<RuleQuality, kChannels> quality{};
    for (Index c = 0; c < kChannels; ++c) {
        const Array response =
            (light > 0.0L).select(members.signals.col(c).array() / light, Real(0));
        const Real best = response.size() > 0 ? response.maxCoeff() : Real(0);
        Real error = 0.0L;
        Real amplification = 0.0L;
        for (Index i = 0; i < response.size(); ++i) {
            const Real right = members.signals(i, c);
            if (response(i) > kBlind * best) {
                const Real off = std::abs(members.found(i, c) / right - 1.0L);
                // NaN counts as the largest error.
                error = std::isnan(off) ? kInfinite : std::max(error, off);
                amplification = std::max(amplification, members.amplified(i, c) / right);
            } else if (members.amplified(i, c) > kLeak * best * light(i)) {
                error = kInfinite;
            }
        }
        quality[static_cast<std::size_t>(c)] = {
            .error = static_cast<double>(error),
            .amplification = static_cast<double>(amplification)};
    }
    return quality;
}

}  // namespace aphotic
