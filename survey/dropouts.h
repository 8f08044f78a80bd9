// SPDX-License-Identifier: BSD-3-Clause
//
// Which strobes lit an image, from its signal in a coarse grid of cells and the light of each
// strobe there. Light adds up, so for a set A of strobes that fired, on a floor of texture x,
//
//   m_k = e S_Ak (1 + x_k),    S_A = sum of the S_s of A,    level = ln(e / E)
//   z_k(A) = ln(m_k / e + s) - ln(S_Ak + s)
//
// m    mean of a cell's green samples over black        S_s  light of strobe s alone (light_at.h)
// e    the image's exposure times its floor's brightness: the median of m_k / S_Ak
// E    the survey's: the median of e over its images    s    kStray of the brightest light
//
// Green only, since strobes and floors differ little in it, and water transmits it everywhere. Each
// set A is scored by
//
//   l(A) = - sum over Haar details d of z   1.5 ln(1 + d^2 / (2 sigma_j^2)) / kDispersion
//          - 2.5 ln(1 + level^2 / (4 psi^2))
//
// as survey/fit/fit_objective.h treats floors: details of rough fields are nearly independent and
// follow a t of two degrees of freedom, an image's level a t of four, and a dispersion accounts for
// the correlation of details within one image. sigma by size of cells, and psi, the spread of the
// floor from image to image, are learned from the survey: medians over its images of what the best
// set of each leaves. So the pattern identifies the strobe that is out; the level contributes
// little, for a floor may be dark.
//
// The alternatives to "all fired, another floor" are all sets of up to kMostSubsets strobes (of
// more strobes, the sets that lack one or two), and "all fired, dim": the density of the level is
// then uniform in the logarithm from kUnlit to 1. The prior is that kRare of a survey's images lack
// light. Half of these lack one of N sets, which is accepted where its l is larger by
// ln(2 N / kRare), plus ln 10 for each strobe out after the first; half are dim, at ln(2 / kRare).
// An image with less than kUnlit of the survey's light is without light, whatever its pattern: no
// floor is so dark.
//
// Not detected: a strobe that gives little of the light in view, or whose light is a constant share
// of the others'; a dim image where floors differ as much: only below 0.14 of the light where they
// differ by 25 %, only below 0.77 where they differ by 2 %. With fewer than kEnoughToLearn images,
// floors are taken to differ by kFloorSpread at least; without a map, where only the level is left,
// so few images are not judged.
#pragma once

#include "lightmap/lightmap.h"
#include "survey/images/survey_image.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

// How they are treated: Mark corrects them by the light of all strobes, and learns nothing from
// them.
enum class Dropouts { Mark, Correct, Ignore };
inline const std::map<std::string, Dropouts> kDropoutWords{
    {"mark", Dropouts::Mark}, {"correct", Dropouts::Correct}, {"ignore", Dropouts::Ignore}};

inline constexpr int kCells = 16;  // across and down, or a smaller power of two for small images
inline constexpr double kStray = 0.01;
inline constexpr double kDarkestCell = 0.03;  // of the brightest: darker ones are ignored
inline constexpr double kUnlit = 1.0 / 30.0;
inline constexpr double kRare = 1e-2;  // share of a survey's images with dropouts
inline constexpr double kDetailDispersion = 3.0;
inline constexpr std::size_t kMostSubsets = 10;
inline constexpr std::size_t kMostStrobes = 32;
inline constexpr std::size_t kEnoughToLearn = 8;
inline constexpr double kFloorSpread = 0.5;

// Row by row; NaN: unseen.
using CellPlane = std::vector<double>;

struct LightCells {
    int side = 0;
    CellPlane signal{};
    CellPlane light{};                 // of all strobes
    bool has_map = true;               // otherwise the light is 1 everywhere
    std::vector<CellPlane> strobes{};  // of each alone; empty: unknown
};

[[nodiscard]] int cells_across(int width_px, int height_px);
// Means of green over black, at the reference exposure. A cell with more than one sample in a
// hundred saturated is unseen.
[[nodiscard]] CellPlane cells_of(const SurveyImage& taken, int side);
// Means of the signal where it exceeds 0, as at an observed mosaic's green sites.
[[nodiscard]] CellPlane cells_of(const Lightmap& map, int side);

// The logarithm of signal over light, where the cell counts, less its median.
[[nodiscard]] CellPlane residual_of(const LightCells& image);

struct DropoutScales {
    std::size_t images = 0;        // learned from; 0: nothing is judged
    double level = 0.0;            // ln E
    double spread = 0.0;           // psi
    std::vector<double> detail{};  // sigma, smallest cells first
};

// level_is_free: images have an exposure each, and the level carries no information.
[[nodiscard]] DropoutScales learned(std::span<const LightCells> images, bool level_is_free = false);

struct Dropout {
    std::uint64_t out = 0;   // bit s: strobe s
    bool is_dark = false;    // without light
    double share = 1.0;      // of the survey's light that was on
    double log_ratio = 0.0;  // of the likeliest set, relative to "all fired"
    double level = 0.0;      // of the image relative to the survey, given that set

    [[nodiscard]] bool is_any() const { return share < 1.0; }
};

// A dropout by the names of its image and strobes.
struct MarkedImage {
    std::string image;
    double share = 1.0;
    std::vector<std::string> strobes{};  // out; empty: all are dim
};
// "strobe fore did not fire: lit by 0.74 of the survey's light"
[[nodiscard]] std::string words_of(const MarkedImage& marked);
[[nodiscard]] nlohmann::ordered_json to_json(const std::vector<MarkedImage>& marked);

[[nodiscard]] Dropout judged(const LightCells& image, const DropoutScales& scales);

}  // namespace aphotic
