// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/quadrature_fit.h"

#include "spectral/minimax.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace aphotic {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kGridError = 1e-9;
// Rows of a fit: enough paths to resolve every oscillation of the error, yet few enough for ten
// materials.
constexpr int kMostPaths = 24;
constexpr int kLeastPaths = 10;
constexpr int kRows = 240;

const std::vector<double> kNoTilt{0.0};

constexpr int kIterations = 60;
constexpr int kQuickIterations = 8;
// Weights are penalised more and more until the promise no longer improves.
constexpr std::array kRidges{1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2};

// From 0 to 1, both included, at Chebyshev's spacing, denser towards the ends, where a fit tends to
// err most, or at even spacing.
ArrayXd chebyshev(int count) {
    return 0.5 - 0.5 * (ArrayXd::LinSpaced(count, 0.0, std::numbers::pi)).cos();
}

// Paths at shares of the way from the shortest to the longest, in even ratios, since paths range
// from metres to the horizon.
ArrayXd paths_at(const LightFamily& family, const ArrayXd& share) {
    if (!(family.shortest_path_m > 0.0)) return share * family.longest_path_m;
    const double ratio = family.longest_path_m / family.shortest_path_m;
    if (ratio == 1.0) return ArrayXd::Constant(1, family.shortest_path_m);
    return family.shortest_path_m * (share * std::log(ratio)).exp();
}

}  // namespace

double worst_error(std::span<const RuleQuality> channels) {
    return std::ranges::max(channels, {}, &RuleQuality::error).error;
}

double worst_promise(std::span<const RuleQuality> channels, double frame_error) {
    double worst = 0.0;
    for (const RuleQuality& q : channels) worst = std::max(worst, q.promise(frame_error));
    return worst;
}

QuadratureFitter::QuadratureFitter(const Sensor& sensor,
                                   const LightFamily& family,
                                   WavelengthRange range)
    : family_(family) {
    const std::vector<WeightedWavelength> grid = reference_grid(sensor, family, range, kGridError);
    const auto nodes = static_cast<Index>(grid.size());
    const auto sources = static_cast<Index>(family.sources.size());
    grid_lambda_nm_.resize(nodes);
    grid_attenuation_per_m_.resize(nodes);
    grid_tilt_ = ArrayXd::Zero(nodes);
    grid_sources_.resize(nodes, sources);
    grid_weights_.resize(nodes, kChannels);
    grid_width_nm_.resize(nodes);
    for (Index i = 0; i < nodes; ++i) {
        const WeightedWavelength& w = grid[static_cast<std::size_t>(i)];
        grid_lambda_nm_(i) = w.lambda_nm;
        grid_attenuation_per_m_(i) = family.water.attenuation_per_m(w.lambda_nm);
        if (family.tilt) grid_tilt_(i) = family.tilt->at(w.lambda_nm);
        for (Index s = 0; s < sources; ++s) {
            grid_sources_(i, s) =
                product_at(family.sources[static_cast<std::size_t>(s)], w.lambda_nm);
        }
        for (Index c = 0; c < kChannels; ++c) {
            grid_weights_(i, c) = w.weight[static_cast<std::size_t>(c)];
        }
    }
    for (Index i = 0; i < nodes; ++i) {
        const double below_nm = i > 0 ? grid_lambda_nm_(i - 1) : range.first_nm;
        const double above_nm = i + 1 < nodes ? grid_lambda_nm_(i + 1) : range.last_nm;
        grid_width_nm_(i) = above_nm - below_nm;
    }
    if (nodes > 0) least_attenuation_per_m_ = grid_attenuation_per_m_.minCoeff();
    const std::vector<double> fit_tilts = family.tilt ? std::vector{-1.0, 0.0, 1.0} : kNoTilt;
    const std::vector<double> check_tilts =
        family.tilt ? std::vector{-1.0, -0.5, 0.0, 0.5, 1.0} : kNoTilt;

    const int curves = static_cast<int>(family.sources.size() * fit_tilts.size());
    const int paths = std::clamp(kRows / std::max(1, curves), kLeastPaths, kMostPaths);
    fitting_ = sample(paths_at(family, chebyshev(paths)), fit_tilts);
    checking_ = sample(paths_at(family, ArrayXd::LinSpaced(kCheckPaths, 0.0, 1.0)), check_tilts);
}

double QuadratureFitter::tilt_shape_error() const {
    if (grid_tilt_.size() == 0) return 0.0;
    return 0.5 * kTiltShape * (grid_tilt_.maxCoeff() - grid_tilt_.minCoeff());
}

FrameLight QuadratureFitter::frame_at(double lambda_nm) const {
    FrameLight frame{.lambda_nm = lambda_nm,
                     .attenuation_per_m = family_.water.attenuation_per_m(lambda_nm),
                     .tilt = family_.tilt ? family_.tilt->at(lambda_nm) : 0.0};
    for (const auto& curves : family_.sources) {
        frame.sources.push_back(product_at(curves, lambda_nm));
    }
    return frame;
}

QuadratureFitter::Sample QuadratureFitter::sample(ArrayXd paths_m,
                                                  std::vector<double> tilts) const {
    const Index paths = paths_m.size();
    const Index sources = grid_sources_.cols();
    Sample sample{.path_m = std::move(paths_m), .tilts = std::move(tilts)};
    const Index members = sources * static_cast<Index>(sample.tilts.size()) * paths;
    sample.signals.resize(members, kChannels);
    sample.light.resize(members);
    sample.response.resize(members, kChannels);
    if (members == 0) return sample;
    Index row = 0;
    for (Index s = 0; s < sources; ++s) {
        const MatrixXd weighted = grid_weights_.colwise() * grid_sources_.col(s);
        for (const double tilt : sample.tilts) {
            for (Index p = 0; p < paths; ++p) {
                const ArrayXd light =
                    ((least_attenuation_per_m_ - grid_attenuation_per_m_) * sample.path_m(p) +
                     tilt * grid_tilt_)
                        .exp();
                sample.signals.row(row) = (light.matrix().transpose() * weighted).array();
                sample.light(row++) = (light * grid_sources_.col(s) * grid_width_nm_).sum();
            }
        }
    }
    // Members by sources: where a column is dark relative to the brightest, it is black.
    const Index each = members / sources;
    const ArrayXd brightest = sample.light.reshaped(each, sources).rowwise().maxCoeff();
    for (Index i = 0; i < members; ++i) {
        if (sample.light(i) > kDarkness * brightest(i % each)) continue;
        sample.light(i) = 0.0;
        sample.signals.row(i).setZero();
    }
    sample.response = sample.signals.colwise() / sample.light;
    sample.response = (sample.response > 0.0).select(sample.response, 0.0);  // 0/0 counts as dark
    return sample;
}

MatrixXd QuadratureFitter::light_of(const Sample& sample,
                                    std::span<const FrameLight> frames) const {
    const Index paths = sample.path_m.size();
    MatrixXd light(sample.signals.rows(), static_cast<Index>(frames.size()));
    for (std::size_t j = 0; j < frames.size(); ++j) {
        const FrameLight& frame = frames[j];
        const ArrayXd left =
            ((least_attenuation_per_m_ - frame.attenuation_per_m) * sample.path_m).exp();
        Index row = 0;
        for (const double source : frame.sources) {
            for (const double tilt : sample.tilts) {
                light.col(static_cast<Index>(j)).segment(row, paths) =
                    source * std::exp(tilt * frame.tilt) * left;
                row += paths;
            }
        }
    }
    return light;
}

QuadratureFitter::View QuadratureFitter::view_of(const MatrixXd& light,
                                                 const Sample& sample,
                                                 Index channel) const {
    const ArrayXd response = sample.response.col(channel);
    const double best = response.size() > 0 ? response.maxCoeff() : 0.0;
    std::vector<Index> seen;
    View view{.whole_response = grid_weights_.col(channel).sum(),
              .unseen = ArrayXd::Zero(light.cols())};
    for (Index i = 0; i < response.size(); ++i) {
        if (response(i) > kBlind * best) {
            seen.push_back(i);
        } else if (light.cols() > 0 && sample.light(i) > 0.0) {  // Eigen would offset null
            view.unseen = view.unseen.max(light.row(i).transpose().array() / sample.light(i) *
                                          grid_width_nm_.sum());
        }
    }
    view.relative.resize(static_cast<Index>(seen.size()), light.cols());
    if (light.cols() == 0) return view;
    for (Index row = 0; row < view.relative.rows(); ++row) {
        const Index i = seen[static_cast<std::size_t>(row)];
        view.relative.row(row) = light.row(i) / sample.signals(i, channel);
    }
    for (Index j = 0; j < light.cols(); ++j) {
        const double most =
            seen.empty() ? 0.0 : view.relative.col(j).maxCoeff() * view.whole_response;
        view.is_usable.push_back(view.unseen(j) <= kBlind && most * kMostWeight >= 1.0 &&
                                 std::isfinite(most));
    }
    return view;
}

MatrixXd QuadratureFitter::View::usable() const {
    MatrixXd light = relative;
    for (Index j = 0; j < light.cols(); ++j) {
        if (!is_usable[static_cast<std::size_t>(j)]) light.col(j).setZero();
    }
    return light;
}

namespace {

RuleQuality quality_of(const MatrixXd& relative, const VectorXd& weights) {
    if (relative.rows() == 0) return {};
    return {.error = ((relative * weights).array() - 1.0).abs().maxCoeff(),
            .amplification = (relative * weights.cwiseAbs()).maxCoeff()};
}

}  // namespace

std::array<RuleQuality, kChannels> QuadratureFitter::judge(
    std::span<const WeightedWavelength> rule, std::span<const FrameLight> frames) const {
    const MatrixXd light = light_of(checking_, frames);
    std::array<RuleQuality, kChannels> quality{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        VectorXd weights(static_cast<Index>(rule.size()));
        for (std::size_t j = 0; j < rule.size(); ++j) {
            weights(static_cast<Index>(j)) = rule[j].weight[c];
        }
        const View check = view_of(light, checking_, static_cast<Index>(c));
        if (check.relative.rows() == 0) continue;
        quality[c] = quality_of(check.relative, weights);
        quality[c].error += tilt_shape_error();
        if ((weights.array().abs() * check.unseen > kLeak * check.whole_response).any()) {
            quality[c].error = std::numeric_limits<double>::infinity();
        }
    }
    return quality;
}

FittedRule QuadratureFitter::fit(std::span<const FrameLight> frames, double frame_error) const {
    const MatrixXd light = light_of(fitting_, frames);
    const MatrixXd checked = light_of(checking_, frames);
    FittedRule rule;
    for (const FrameLight& frame : frames) {
        rule.wavelengths.push_back({.lambda_nm = frame.lambda_nm});
    }
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto channel = static_cast<Index>(c);
        View fitted = view_of(light, fitting_, channel);
        const View checking = view_of(checked, checking_, channel);
        if (checking.relative.rows() == 0) continue;
        for (std::size_t j = 0; j < frames.size(); ++j) {
            if (!checking.is_usable[j]) fitted.is_usable[j] = false;
        }
        const MatrixXd rows = fitted.usable();
        const MatrixXd check = checking.usable();
        rule.quality[c] = {.error = 1.0, .amplification = 0.0};  // of zero weights
        double best = 1.0 + kFreeAmplification * frame_error;
        for (const double ridge : kRidges) {
            const MinimaxFit fit = minimax_fit(
                rows, VectorXd::Ones(rows.rows()), {.iterations = kIterations, .ridge = ridge});
            RuleQuality quality = quality_of(check, fit.x);
            quality.error += tilt_shape_error();
            // Amplification within the free limit is no reason to penalise weights.
            const double cost =
                quality.error + std::max(quality.amplification, kFreeAmplification) * frame_error;
            if (!(cost < best)) continue;
            best = cost;
            rule.quality[c] = quality;
            for (std::size_t j = 0; j < frames.size(); ++j) {
                rule.wavelengths[j].weight[c] = fit.x(static_cast<Index>(j));
            }
        }
    }
    return rule;
}

QuadratureFitter::Column QuadratureFitter::column_of(std::span<const FrameLight> frames) const {
    const MatrixXd light = light_of(fitting_, frames);
    Column column;
    for (std::size_t c = 0; c < kChannels; ++c) {
        column.light[c] = view_of(light, fitting_, static_cast<Index>(c)).usable();
    }
    return column;
}

namespace {

MatrixXd joined(std::span<const QuadratureFitter::Column* const> columns, std::size_t channel) {
    MatrixXd rows(columns.empty() ? 0 : columns.front()->light[channel].rows(),
                  static_cast<Index>(columns.size()));
    for (std::size_t j = 0; j < columns.size(); ++j) {
        rows.col(static_cast<Index>(j)) = columns[j]->light[channel];
    }
    return rows;
}

}  // namespace

ArrayXd QuadratureFitter::least_costs(std::span<const Column* const> columns,
                                      const Column& candidates,
                                      const Hint& hint) const {
    ArrayXd least = ArrayXd::Zero(candidates.light[0].cols());
    for (std::size_t c = 0; c < kChannels; ++c) {
        const Index members = candidates.light[c].rows();
        if (members == 0 || hint[c].size() != members) continue;
        least = least.max(minimax_lower_bounds(
            joined(columns, c), VectorXd::Ones(members), candidates.light[c], hint[c]));
    }
    return least;
}

double QuadratureFitter::quick_cost(std::span<const Column* const> columns,
                                    double frame_error,
                                    double give_up,
                                    Hint& hint) const {
    double worst = 0.0;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const MatrixXd rows = joined(columns, c);
        const Index members = rows.rows();
        if (members == 0) continue;
        const MinimaxFit fit =
            minimax_fit(rows,
                        VectorXd::Ones(members),
                        {.iterations = kQuickIterations, .give_up = give_up, .weights = hint[c]});
        const RuleQuality quality = quality_of(rows, fit.x);
        const double cost =
            quality.error + std::max(0.0, quality.amplification - kFreeAmplification) * frame_error;
        // NaN counts as the worst cost.
        if (!(cost <= give_up)) return std::numeric_limits<double>::infinity();
        hint[c] = fit.weights;
        worst = std::max(worst, cost);
    }
    return worst;
}

namespace {

// Lines may be too narrow to be found by their shares: every interval of light gets kLeastPlaces,
// if it has that many nodes, at even shares of its light.
void add_places_in_lines(const ArrayXd& share, std::vector<Index>& places) {
    constexpr int kLeastPlaces = 3;
    constexpr double kNoLight = 1e-6;
    constexpr double kMuch = 0.01;
    const double largest = share.maxCoeff();
    for (Index first = 0; first < share.size(); ++first) {
        if (!(share(first) > kNoLight * largest)) continue;
        Index end = first;
        while (end < share.size() && share(end) > kNoLight * largest) ++end;
        const auto stretch = share.segment(first, end - first);
        const auto shows_much = [&](Index i) {
            return i >= first && i < end && share(i) >= kMuch * stretch.maxCoeff();
        };
        if (stretch.maxCoeff() >= kMuch * largest &&
            std::ranges::count_if(places, shows_much) < kLeastPlaces) {
            double sum = 0.0;
            int next = 0;
            for (Index i = first; i < end; ++i) {
                sum += share(i);
                if (sum < stretch.sum() * (next + 0.5) / kLeastPlaces) continue;
                ++next;
                if (std::ranges::find(places, i) == places.end()) places.push_back(i);
            }
        }
        first = end;
    }
}

}  // namespace

std::vector<double> QuadratureFitter::places_of_light(int count) const {
    const Index nodes = grid_lambda_nm_.size();
    std::vector<ArrayXd> shares;  // of each node in a signal, by member and channel
    const Index paths = fitting_.path_m.size();
    Index row = 0;
    for (Index s = 0; s < grid_sources_.cols(); ++s) {
        for (const double tilt : fitting_.tilts) {
            for (Index p = 0; p < paths; ++p, ++row) {
                if (p != 0 && p != paths / 2 && p != paths - 1) continue;
                const ArrayXd light =
                    grid_sources_.col(s) *
                    ((least_attenuation_per_m_ - grid_attenuation_per_m_) * fitting_.path_m(p) +
                     tilt * grid_tilt_)
                        .exp();
                for (Index c = 0; c < kChannels; ++c) {
                    const double signal = fitting_.signals(row, c);
                    if (signal > 0.0) shares.push_back(light * grid_weights_.col(c) / signal);
                }
            }
        }
    }
    ArrayXd most = ArrayXd::Zero(nodes);  // largest share of any member
    for (const ArrayXd& share : shares) most = most.max(share);
    // Density sqrt(share / width) over a width: sqrt(share width).
    ArrayXd cumulative(nodes);
    double sum = 0.0;
    for (Index i = 0; i < nodes; ++i) {
        const double width_nm = grid_lambda_nm_(std::min(i + 1, nodes - 1)) -
                                grid_lambda_nm_(std::max<Index>(i - 1, 0));
        sum += std::sqrt(most(i) * width_nm);
        cumulative(i) = sum;
    }
    std::vector<Index> places;
    Index node = 0;
    for (int k = 0; k < count && sum > 0.0; ++k) {
        while (node + 1 < nodes && cumulative(node) < sum * (k + 0.5) / count) ++node;
        if (places.empty() || places.back() < node) places.push_back(node);
    }
    for (const ArrayXd& share : shares) add_places_in_lines(share, places);
    std::ranges::sort(places);
    std::vector<double> lambda_nm;
    for (const Index i : places) lambda_nm.push_back(grid_lambda_nm_(i));
    return lambda_nm;
}

std::vector<QuadratureFitter::PathError> QuadratureFitter::errors_over_path(
    const FittedRule& rule, std::span<const FrameLight> frames, std::size_t source) const {
    const MatrixXd light = light_of(checking_, frames);
    const Index paths = checking_.path_m.size();
    // The middle tilt, which is 0.
    const auto tilts = static_cast<Index>(checking_.tilts.size());
    const Index first = (static_cast<Index>(source) * tilts + tilts / 2) * paths;
    std::vector<PathError> errors;
    for (Index p = 0; p < paths; ++p) {
        PathError error{.path_m = checking_.path_m(p)};
        for (std::size_t c = 0; c < kChannels; ++c) {
            double found = 0.0;
            for (std::size_t j = 0; j < frames.size(); ++j) {
                found += rule.wavelengths[j].weight[c] * light(first + p, static_cast<Index>(j));
            }
            const double right = checking_.signals(first + p, static_cast<Index>(c));
            if (right > 0.0) error.error[c] = found / right - 1.0;
        }
        errors.push_back(error);
    }
    return errors;
}

}  // namespace aphotic
