// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/wavelength_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aphotic {
namespace {

// A sweep that gains less than this share is the last.
constexpr double kGain = 0.02;
constexpr int kMostSweeps = 6;
// Closer wavelengths would have the same channel names.
constexpr double kLeastDistanceNm = 0.01;
// Few enough to try all sets of them.
constexpr int kFewEnough = 3;
// More wavelengths are tried at once if a first sweep is this far from the budget.
constexpr double kHopeless = 30.0;
// The same limit after the whole search, where a second search might still help.
constexpr double kFarOff = 3.0;
constexpr int kMany = 6;
constexpr double kMiddle = 0.5;
// A plan of fewer wavelengths is as good if its error is below this, far below any frame's
// rounding.
constexpr double kNothing = 1e-8;

class Search {
  public:
    Search(const QuadratureFitter& fitter,
           WavelengthRange range,
           double frame_error,
           std::span<const FrameLight> given)
        : fitter_(fitter), range_(range), frame_error_(frame_error) {
        for (const FrameLight& frame : given) given_.push_back(place_of(frame));
        std::vector<FrameLight> frames;
        for (const double nm : fitter.places_of_light(kCandidates)) {
            frames.push_back(fitter.frame_at(nm));
            candidates_.push_back(place_of(frames.back()));
        }
        all_candidates_ = fitter.column_of(frames);
    }

    // Starts from these wavelengths.
    void start(std::span<const double> lambda_nm) {
        places_ = given_;
        for (const double nm : lambda_nm) places_.push_back(place_of(fitter_.frame_at(free(nm))));
        hint_ = {};
        cost_ = cost_of(places_, std::numeric_limits<double>::infinity());
    }

    void improve() {
        double before = std::numeric_limits<double>::infinity();
        for (int i = 0; i < kMostSweeps && cost_ < (1.0 - kGain) * before; ++i) {
            before = cost_;
            sweep();
            refine();
        }
    }

    // Moves each wavelength in turn to the best candidate.
    void sweep() {
        for (std::size_t j = given_.size(); j < places_.size(); ++j) {
            std::vector<const QuadratureFitter::Column*> others;
            for (std::size_t k = 0; k < places_.size(); ++k) {
                if (k != j) others.push_back(&places_[k].column);
            }
            const Eigen::ArrayXd least = fitter_.least_costs(others, all_candidates_, hint_);
            for (std::size_t i = 0; i < candidates_.size(); ++i) {
                if (least(static_cast<Eigen::Index>(i)) < cost_) try_out(j, {&candidates_[i], 1});
            }
        }
    }

    // Starting wavelengths, spread evenly over the light, or over the range; offset: that of the
    // first, 0 to 1.
    [[nodiscard]] std::vector<double> over_the_light(int count, double offset) const {
        std::vector<double> lambda_nm;
        for (int j = 0; j < count; ++j) {
            const double share = (j + offset) / count;
            const auto place =
                static_cast<std::size_t>(share * static_cast<double>(candidates_.size()));
            lambda_nm.push_back(candidates_[place].lambda_nm);
        }
        return lambda_nm;
    }

    [[nodiscard]] std::vector<double> over_the_range(int count, double offset) const {
        std::vector<double> lambda_nm;
        for (int j = 0; j < count; ++j) {
            lambda_nm.push_back(std::lerp(range_.first_nm, range_.last_nm, (j + offset) / count));
        }
        return lambda_nm;
    }

    // The best of all sets of a few candidates.
    std::vector<double> best_of_all(int count) {
        std::vector<double> chosen;
        std::vector<double> best = over_the_light(count, kMiddle);
        start(best);
        try_all(count, 0, chosen, best);
        return best;
    }

    [[nodiscard]] double cost() const { return cost_; }
    [[nodiscard]] bool has_candidates() const { return !candidates_.empty(); }

    [[nodiscard]] std::vector<double> wavelengths() const {
        std::vector<double> lambda_nm;
        for (std::size_t j = given_.size(); j < places_.size(); ++j) {
            lambda_nm.push_back(places_[j].lambda_nm);
        }
        std::ranges::sort(lambda_nm);
        return lambda_nm;
    }

  private:
    struct Place {
        double lambda_nm;
        QuadratureFitter::Column column;
    };

    [[nodiscard]] bool is_free(double lambda_nm) const {
        return std::ranges::none_of(places_, [&](const Place& place) {
            return std::abs(place.lambda_nm - lambda_nm) < kLeastDistanceNm;
        });
    }

    // The nearest free wavelength, up or down.
    [[nodiscard]] double free(double lambda_nm) const {
        const double width_nm = range_.last_nm - range_.first_nm;
        for (double away_nm = 0.0; away_nm <= width_nm; away_nm += kLeastDistanceNm) {
            for (const double nm : {lambda_nm + away_nm, lambda_nm - away_nm}) {
                if (range_.contains(nm) && is_free(nm)) return nm;
            }
        }
        return lambda_nm;
    }

    [[nodiscard]] Place place_of(const FrameLight& frame) const {
        return {.lambda_nm = frame.lambda_nm, .column = fitter_.column_of({&frame, 1})};
    }

    double cost_of(const std::vector<Place>& places, double give_up) {
        std::vector<const QuadratureFitter::Column*> columns;
        for (const Place& place : places) columns.push_back(&place.column);
        return fitter_.quick_cost(columns, frame_error_, give_up, hint_);
    }

    void try_all(int count,
                 std::size_t first,
                 std::vector<double>& chosen,
                 std::vector<double>& best) {
        constexpr std::size_t kEach = 3;  // every third candidate
        if (static_cast<int>(chosen.size()) == count) {
            const std::vector<Place> before = places_;
            const double cost = cost_;
            start(chosen);
            if (cost_ < cost) {
                best = chosen;
            } else {
                places_ = before;
                cost_ = cost;
            }
            return;
        }
        for (std::size_t i = first; i < candidates_.size(); i += kEach) {
            chosen.push_back(candidates_[i].lambda_nm);
            try_all(count, i + kEach, chosen, best);
            chosen.pop_back();
        }
    }

    // Replaces the places from j on, if that is better.
    void try_out(std::size_t j, std::span<const Place> instead) {
        std::vector<const Place*> tried;
        for (const Place& place : places_) tried.push_back(&place);
        for (std::size_t k = 0; k < instead.size(); ++k) tried[j + k] = &instead[k];
        for (std::size_t k = j; k < j + instead.size(); ++k) {
            for (std::size_t other = 0; other < tried.size(); ++other) {
                const double apart_nm = std::abs(tried[k]->lambda_nm - tried[other]->lambda_nm);
                if (other != k && apart_nm < kLeastDistanceNm) return;
            }
        }
        std::vector<const QuadratureFitter::Column*> columns;
        for (const Place* place : tried) columns.push_back(&place->column);
        const double cost = fitter_.quick_cost(columns, frame_error_, cost_, hint_);
        if (!(cost < cost_)) return;
        cost_ = cost;
        std::ranges::copy(instead, places_.begin() + static_cast<std::ptrdiff_t>(j));
    }

    // Moves each place, and each together with its neighbour, by the step.
    void move_by(double step_nm) {
        for (std::size_t j = given_.size(); j < places_.size(); ++j) {
            for (const double move_nm : {-step_nm, step_nm}) {
                for (const double next_nm : {0.0, move_nm, -move_nm}) {
                    const bool is_pair = next_nm != 0.0;
                    if (is_pair && j + 1 == places_.size()) continue;
                    std::vector<Place> moved;
                    const double to_nm = places_[j].lambda_nm + move_nm;
                    if (!range_.contains(to_nm)) continue;
                    moved.push_back(place_of(fitter_.frame_at(to_nm)));
                    if (is_pair) {
                        const double neighbour_nm = places_[j + 1].lambda_nm + next_nm;
                        if (!range_.contains(neighbour_nm)) continue;
                        moved.push_back(place_of(fitter_.frame_at(neighbour_nm)));
                    }
                    try_out(j, moved);
                }
            }
        }
    }

    void refine() {
        std::sort(places_.begin() + static_cast<std::ptrdiff_t>(given_.size()),
                  places_.end(),
                  [](const Place& a, const Place& b) { return a.lambda_nm < b.lambda_nm; });
        double step_nm = (range_.last_nm - range_.first_nm) / kCandidates;
        while (step_nm >= kFinestStepNm) {
            const double before = cost_;
            move_by(step_nm);
            if (cost_ > (1.0 - kGain) * before) step_nm *= 0.5;
        }
    }

    const QuadratureFitter& fitter_;
    WavelengthRange range_;
    double frame_error_;
    std::vector<Place> given_;
    std::vector<Place> candidates_;
    QuadratureFitter::Column all_candidates_;
    std::vector<Place> places_;
    double cost_ = 0.0;
    QuadratureFitter::Hint hint_;
};

FittedRule fitted(const QuadratureFitter& fitter,
                  std::span<const double> lambda_nm,
                  double frame_error) {
    std::vector<FrameLight> frames;
    for (const double nm : lambda_nm) frames.push_back(fitter.frame_at(nm));
    return fitter.fit(frames, frame_error);
}

}  // namespace

std::vector<double> best_wavelengths(const QuadratureFitter& fitter,
                                     WavelengthRange range,
                                     int count,
                                     double frame_error,
                                     std::span<const FrameLight> given,
                                     double budget) {
    // No more than fit into the range.
    const double room = (range.last_nm - range.first_nm) / (2.0 * kLeastDistanceNm);
    count = std::max(1, static_cast<int>(std::min<double>(count, room)));
    Search search(fitter, range, frame_error, given);
    // Without any light, any wavelength will do.
    if (!search.has_candidates()) return {0.5 * (range.first_nm + range.last_nm)};
    search.start(search.over_the_light(count, kMiddle));
    search.sweep();
    if (search.cost() > kHopeless * budget) return search.wavelengths();

    std::vector<double> best;
    double least = std::numeric_limits<double>::infinity();
    const auto improve_from = [&](const std::vector<double>& start) {
        search.start(start);
        search.improve();
        if (search.cost() < least || best.empty()) {
            least = search.cost();
            best = search.wavelengths();
        }
    };
    improve_from(count <= kFewEnough ? search.best_of_all(count)
                                     : search.over_the_light(count, kMiddle));
    // A search with many wavelengths takes long, so further starts are only for near misses.
    const bool is_settled = least <= budget || least > kFarOff * budget;
    if (count > kMany && is_settled) return best;
    improve_from(search.over_the_range(count, kMiddle));
    if (count <= kFewEnough || count > kMany) return best;
    improve_from(search.over_the_light(count, 0.5 * kMiddle));
    improve_from(search.over_the_range(count, 0.5 * kMiddle));
    return best;
}

FittedRule plan_wavelengths(const QuadratureFitter& fitter,
                            WavelengthRange range,
                            const PlanTarget& target) {
    constexpr double kLeastShare = 0.01;
    // The part of the error budget that frames leave to the wavelengths, if the weights do not
    // amplify it.
    const double budget =
        std::max(kLeastShare * target.frame_error, target.tolerance - target.frame_error);
    const auto at = [&](int count) {
        return fitted(fitter,
                      best_wavelengths(fitter, range, count, target.frame_error, {}, budget),
                      target.frame_error);
    };
    FittedRule best;
    for (int count = target.step; count <= target.most; count += target.step) {
        FittedRule rule = at(count);
        if (best.wavelengths.empty() ||
            rule.promise(target.frame_error) < best.promise(target.frame_error)) {
            best = std::move(rule);
        }
        if (best.promise(target.frame_error) > target.tolerance) continue;
        for (int fewer = 1; count == target.step && fewer < target.step; ++fewer) {
            FittedRule small = at(fewer);
            if (small.error() <= kNothing) return small;
        }
        return best;
    }
    return best;
}

}  // namespace aphotic
