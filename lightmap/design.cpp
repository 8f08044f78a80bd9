// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/design.h"

#include "base/error.h"
#include "base/parallel.h"
#include "lightmap/maximise.h"
#include "rig/camera/lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <utility>

namespace aphotic {
namespace {

constexpr double kSearchError = 1e-4;  // of the signal: the figures are no finer
constexpr double kForbidden = -1e3;    // below every value of an allowed place
// The penalty for losing a share of a figure to be kept: more than a design gains by it.
constexpr double kPenalty = 20.0;
constexpr std::size_t kCandidatesOfRoom = 12;  // to be judged
constexpr std::size_t kFewHold = 8;            // of which this many are enough
// Small and large images differ by about this much: a figure only just kept on one may not be kept
// on the other.
constexpr double kRoomToJudge = 1.003;
constexpr std::size_t kMostOnFront = 9;

// Shares of the evaluations.
constexpr double kGlobalShare = 0.1;
constexpr int kPopulations = 4;  // a single one occasionally ends on a lower hill
constexpr double kFromStartShare = 0.15;
constexpr double kRestartShare = 0.05;
constexpr int kRestarts = 4;
constexpr double kFrontShare = 0.25;

std::vector<double> values_of(const Ends& ends, bool has_middle) {
    if (ends[0] == ends[1]) return {ends[0]};
    if (!has_middle) return {ends[0], ends[1]};
    return {ends[0], std::midpoint(ends[0], ends[1]), ends[1]};
}

std::vector<Sled> poses_of(const Envelope& envelope, bool has_middle) {
    std::vector<Sled> poses;
    for (const double altitude_m : values_of(envelope.altitude_m, has_middle)) {
        for (const double pitch_rad : values_of(envelope.pitch_rad, has_middle)) {
            for (const double roll_rad : values_of(envelope.roll_rad, has_middle))
                poses.push_back({altitude_m, pitch_rad, roll_rad});
        }
    }
    return poses;
}

std::vector<LightFigures> figures_of_poses(const LightmapMaker& maker,
                                           const std::vector<Sled>& poses,
                                           double level,
                                           int threads) {
    std::vector<LightFigures> figures(poses.size());
    parallel_for(poses.size(), static_cast<std::size_t>(threads), [&](std::size_t i, std::size_t) {
        figures[i] = figures_of(maker.map(poses[i]), level);
    });
    return figures;
}

LightFigures worst_of_all(const std::vector<LightFigures>& figures) {
    LightFigures worst = figures.front();
    for (const LightFigures& one : figures) worst = worst_of(worst, one);
    return worst;
}

// The light of any places in the space, as the search computes it.
class SearchedLight {
  public:
    SearchedLight(const Rig& rig, const DesignSpace& space, const DesignRequest& request)
        : poses_(space.poses()),
          level_(request.level),
          threads_(request.threads),
          floor_(with_longer_side(rig, kSearched_px), space.paths(), options(false)) {
        if (!rig.water.scatters()) return;
        veiled_ = std::make_unique<LightmapMaker>(
            with_longer_side(rig, kVeilSearched_px), space.paths(), options(true));
    }

    LightFigures of(const std::vector<StrobePlace>& places) {
        LightFigures worst = of(places, floor_);
        if (veiled_) worst.signal_to_noise = of(places, *veiled_).signal_to_noise;
        return worst;
    }

  private:
    static LightmapOptions options(bool has_veil) {
        return {.error = kSearchError, .threads = 1, .has_veil = has_veil};
    }

    LightFigures of(const std::vector<StrobePlace>& places, LightmapMaker& maker) {
        maker.place(places);
        return worst_of_all(figures_of_poses(maker, poses_, level_, threads_));
    }

    std::vector<Sled> poses_;
    double level_;
    int threads_;
    LightmapMaker floor_;
    std::unique_ptr<LightmapMaker> veiled_;
};

struct Candidate {
    std::vector<double> point;
    LightFigures figures;
};

bool is_as_good(const LightFigures& a, const LightFigures& b) {
    return std::ranges::all_of(
        kGoalFigures, [&](double LightFigures::*figure) { return a.*figure >= b.*figure; });
}

// The Pareto-optimal designs among all that were seen.
class Archive {
  public:
    void take(std::span<const double> point, const LightFigures& figures) {
        for (const Candidate& other : kept_) {
            if (is_as_good(other.figures, figures)) return;
        }
        std::erase_if(kept_,
                      [&](const Candidate& other) { return is_as_good(figures, other.figures); });
        kept_.push_back({{point.begin(), point.end()}, figures});
    }
    [[nodiscard]] const std::vector<Candidate>& kept() const { return kept_; }

  private:
    std::vector<Candidate> kept_;
};

double goal_of(DesignGoal goal, const LightFigures& figures) {
    return figures.*figure_of(goal);
}

LightFigures times(LightFigures figures, double factor) {
    for (double LightFigures::*figure : kGoalFigures) figures.*figure *= factor;
    return figures;
}

// The least that a design must have of each figure.
LightFigures least_of(const DesignRequest& request, const LightFigures& start) {
    LightFigures least = times(start, request.keep);
    least.*figure_of(request.goal) = 0.0;
    return least;
}

double log_missing(double figure, double least) {
    return figure < least ? std::log(least / figure) : 0.0;
}

class DesignSearch {
  public:
    DesignSearch(const DesignSpace& space, SearchedLight& light, const DesignRequest& request)
        : space_(space),
          light_(light),
          request_(request),
          start_(light.of(space.places_at(space.start()))) {
        if (start_.evenness <= 0.0) {
            throw InputError(
                "found pixels without light, or without floor, in a pose of the envelope; allowed: "
                "a start that lights the whole image in all poses");
        }
        archive_.take(space.start(), start_);
    }

    void run() {
        const LightFigures least = times(least_of(request_, start_), kRoomToJudge);
        const auto goal = [&](const LightFigures& f) { return value(request_.goal, f, least); };
        for (int population = 0; population < kPopulations; ++population)
            search(SearchWay::Global, space_.start(), kGlobalShare, goal);
        search(SearchWay::Local, space_.start(), kFromStartShare, goal);
        // Again from the best: a simplex that has shrunk in a crease gets its initial size again.
        for (int again = 0; again < kRestarts; ++again)
            search(SearchWay::Local, best_by(goal).point, kRestartShare, goal);
        fill_front();
    }

    [[nodiscard]] const std::vector<Candidate>& candidates() const { return archive_.kept(); }
    [[nodiscard]] const LightFigures& start() const { return start_; }
    [[nodiscard]] int evaluations() const { return evaluations_; }

  private:
    using Value = std::function<double(const LightFigures&)>;

    // Logarithms: a tenth more of one figure is worth as much as a tenth more of another.
    [[nodiscard]] double value(DesignGoal goal,
                               const LightFigures& figures,
                               const LightFigures& least) const {
        constexpr double kTie = 1e-3;  // coverage has steps: on one, prefer the more even light
        if (figures.evenness <= 0.0 || figures.coverage <= 0.0) return 0.5 * kForbidden;
        const double missing = log_missing(figures.evenness, least.evenness) +
                               log_missing(figures.coverage, least.coverage) +
                               log_missing(figures.signal_to_noise, least.signal_to_noise);
        const double tie = goal == DesignGoal::Coverage ? kTie : 0.0;
        return std::log(goal_of(goal, figures) / goal_of(goal, start_)) +
               tie * std::log(figures.evenness / start_.evenness) - kPenalty * missing;
    }

    void search(SearchWay way, const std::vector<double>& from, double share, const Value& value) {
        const int evaluations =
            std::min(std::max(1, static_cast<int>(share * request_.evaluations)),
                     request_.evaluations - evaluations_);
        if (evaluations == 0) return;
        const auto ask = [&](std::span<const double> point) {
            ++evaluations_;
            if (request_.progress) request_.progress(evaluations_, request_.evaluations);
            const std::vector<StrobePlace> places = space_.places_at(point);
            if (!space_.allows(places)) return kForbidden;
            const LightFigures figures = light_.of(places);
            archive_.take(point, figures);
            return value(figures);
        };
        maximise(way, from, {.evaluations = evaluations, .seed = request_.seed + searches_++}, ask);
    }

    // A copy, since the archive grows.
    [[nodiscard]] Candidate best_by(const Value& value) const {
        return *std::ranges::max_element(
            archive_.kept(), {}, [&](const Candidate& c) { return value(c.figures); });
    }

    // Its two ends, and between them the most even light for a signal.
    void fill_front() {
        constexpr std::array kBetween{0.25, 0.5, 0.75};
        const double share = kFrontShare / (2.0 + kBetween.size());
        const double coverage = request_.keep * start_.coverage;
        const auto run = [&](DesignGoal goal, double least_signal) {
            const LightFigures least{.coverage = coverage, .signal_to_noise = least_signal};
            const auto wanted = [&](const LightFigures& f) { return value(goal, f, least); };
            search(SearchWay::Local, best_by(wanted).point, share, wanted);
            return best_by(wanted).figures.signal_to_noise;
        };
        const double most = run(DesignGoal::Signal, 0.0);
        const double least = run(DesignGoal::Evenness, 0.0);
        for (const double part : kBetween) run(DesignGoal::Evenness, std::lerp(least, most, part));
    }

    const DesignSpace& space_;
    SearchedLight& light_;
    const DesignRequest& request_;
    LightFigures start_;
    Archive archive_;
    int evaluations_ = 0;
    std::uint64_t searches_ = 0;
};

// As the user gets it.
Design judged_at(std::span<const double> point,
                 const DesignSpace& space,
                 const DesignRequest& request) {
    const RigText text = space.text_at(point);
    const Rig rig = text.rig();
    Design design{.toml = text.text(), .places = {}, .figures = {}};
    for (const Strobe& strobe : rig.strobes)
        design.places.push_back({strobe.position_m, strobe.axis, strobe.power});
    const Rig seen = with_longer_side(rig, kJudged_px);
    const std::vector<Sled> poses = grid_poses(request.envelope);
    const LightmapMaker maker(seen, paths_of(seen, poses), {.error = kSearchError});
    const std::vector<LightFigures> figures =
        figures_of_poses(maker, poses, request.level, request.threads);
    design.figures = worst_of_all(figures);
    for (std::size_t i = 0; i < poses.size(); ++i) design.poses.push_back({poses[i], figures[i]});
    return design;
}

// Those that keep the required figures, the best first. Some have margin, since the best have none
// and may fail the judgement.
std::vector<Candidate> best_of(std::vector<Candidate> candidates,
                               const DesignRequest& request,
                               const LightFigures& start) {
    constexpr std::array kRooms{1.0, 1.003, 1.01, 1.03, 1.1};
    std::ranges::sort(candidates, std::ranges::greater(), [&](const Candidate& c) {
        return goal_of(request.goal, c.figures);
    });
    std::vector<bool> is_taken(candidates.size(), false);
    for (const double room : kRooms) {
        const LightFigures least = times(least_of(request, start), room);
        std::size_t taken = 0;
        for (std::size_t i = 0; i < candidates.size() && taken < kCandidatesOfRoom; ++i) {
            if (!is_as_good(candidates[i].figures, least)) continue;
            is_taken[i] = true;
            ++taken;
        }
    }
    std::vector<Candidate> best;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (is_taken[i]) best.push_back(candidates[i]);
    }
    return best;
}

bool is_better_in_both(const LightFigures& a, const LightFigures& b) {
    return a.evenness >= b.evenness && a.signal_to_noise >= b.signal_to_noise &&
           (a.evenness > b.evenness || a.signal_to_noise > b.signal_to_noise);
}

bool is_alike(const LightFigures& a, const LightFigures& b) {
    constexpr double kAlike = 1e-3;
    return std::abs(a.evenness / b.evenness - 1.0) < kAlike &&
           std::abs(a.signal_to_noise / b.signal_to_noise - 1.0) < kAlike;
}

// For evenness and signal only, spread over the signal.
std::vector<Candidate> front_of(std::vector<Candidate> all, double least_coverage) {
    std::vector<Candidate> front;
    std::erase_if(all, [&](const Candidate& c) { return c.figures.coverage < least_coverage; });
    for (const Candidate& one : all) {
        if (std::ranges::none_of(all, [&](const Candidate& other) {
                return is_better_in_both(other.figures, one.figures);
            }))
            front.push_back(one);
    }
    const auto signal = [](const Candidate& c) { return c.figures.signal_to_noise; };
    std::ranges::sort(front, {}, signal);
    if (front.size() <= kMostOnFront) return front;
    std::vector<Candidate> spread;
    for (std::size_t i = 0; i < kMostOnFront; ++i) {
        const double wanted =
            std::lerp(signal(front.front()),
                      signal(front.back()),
                      static_cast<double>(i) / static_cast<double>(kMostOnFront - 1));
        const Candidate& nearest = *std::ranges::min_element(
            front, {}, [&](const Candidate& c) { return std::abs(signal(c) - wanted); });
        if (spread.empty() || spread.back().point != nearest.point) spread.push_back(nearest);
    }
    return spread;
}

}  // namespace

Envelope envelope_of(const Sled& sled) {
    return {.altitude_m = {sled.altitude_m, sled.altitude_m},
            .pitch_rad = {sled.pitch_rad, sled.pitch_rad},
            .roll_rad = {sled.roll_rad, sled.roll_rad}};
}

std::vector<Sled> corner_poses(const Envelope& envelope) {
    std::vector<Sled> poses = poses_of(envelope, false);
    const auto middle = [](const Ends& ends) { return std::midpoint(ends[0], ends[1]); };
    if (poses.size() > 1) {
        poses.push_back(
            {middle(envelope.altitude_m), middle(envelope.pitch_rad), middle(envelope.roll_rad)});
    }
    return poses;
}

std::vector<Sled> grid_poses(const Envelope& envelope) {
    return poses_of(envelope, true);
}

Rig with_longer_side(Rig rig, int longer_px) {
    Camera& camera = rig.camera;
    const int longest = std::max(camera.width_px, camera.height_px);
    if (longest <= longer_px) return rig;
    // Pixels are square, and both sides whole: among sizes near the requested one, that whose view
    // is nearest.
    constexpr double kAbout = 1.25;
    const double full_width = camera.width_px;
    const double full_height = camera.height_px;
    int width = 1;
    int height = 1;
    double least_off = std::numeric_limits<double>::infinity();
    for (int side = longer_px; side > static_cast<int>(longer_px / kAbout); --side) {
        const double factor = longest / static_cast<double>(side);
        const double off_px = std::abs(full_width / factor - std::round(full_width / factor)) +
                              std::abs(full_height / factor - std::round(full_height / factor));
        if (off_px >= least_off) continue;
        least_off = off_px;
        width = std::max(1, static_cast<int>(std::lround(full_width / factor)));
        height = std::max(1, static_cast<int>(std::lround(full_height / factor)));
    }
    enlarge_pixels(camera, longest / static_cast<double>(std::max(width, height)), width, height);
    return rig;
}

DesignResult design(const RigText& text, const DesignRequest& request) {
    const Rig rig = text.rig();
    const DesignSpace space(text, request.freedom, corner_poses(request.envelope));
    SearchedLight light(rig, space, request);
    DesignSearch search(space, light, request);
    search.run();

    DesignResult result{.start = judged_at(space.start(), space, request), .best = {}};
    result.best = result.start;
    result.evaluations = search.evaluations();
    result.numbers = space.size();
    const LightFigures least = least_of(request, result.start.figures);
    std::size_t holding = 0;
    for (const Candidate& one : best_of(search.candidates(), request, search.start())) {
        if (holding == kFewHold) break;
        Design design = judged_at(one.point, space, request);
        if (!is_as_good(design.figures, least)) continue;
        ++holding;
        if (goal_of(request.goal, design.figures) <= goal_of(request.goal, result.best.figures))
            continue;
        result.best = std::move(design);
        result.is_better = true;
    }
    std::vector<Design> judged{result.best};
    const double least_coverage = request.keep * search.start().coverage;
    for (const Candidate& one : front_of(search.candidates(), least_coverage))
        judged.push_back(judged_at(one.point, space, request));
    for (const Design& one : judged) {
        const bool is_beaten = std::ranges::any_of(judged, [&](const Design& other) {
            return is_better_in_both(other.figures, one.figures);
        });
        const bool is_there = std::ranges::any_of(result.front, [&](const Design& other) {
            return is_alike(other.figures, one.figures);
        });
        if (!is_beaten && !is_there) result.front.push_back(one);
    }
    std::ranges::sort(
        result.front, {}, [](const Design& one) { return one.figures.signal_to_noise; });
    return result;
}

}  // namespace aphotic
