// SPDX-License-Identifier: BSD-3-Clause
#include "survey/dropout_check.h"

#include "base/error.h"
#include "survey/image_light.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace aphotic {

LightCells light_cells(const SurveyImage& taken, const Survey& survey, const ImageFile& file) {
    LightCells image{.side = cells_across(taken.raw.width_px, taken.raw.height_px)};
    image.signal = cells_of(taken, image.side);
    image.light.assign(image.signal.size(), 0.0);
    if (survey.depth ? static_cast<bool>(survey.strobes.relief_cells)
                     : static_cast<bool>(survey.strobes.cells)) {
        image.strobes = strobe_cells_of(survey, file);
        for (const CellPlane& strobe : image.strobes)
            std::ranges::transform(image.light, strobe, image.light.begin(), std::plus());
    } else if (survey.light.map) {
        image.light = cells_of(light_of(survey, file, 0).map, image.side);
    } else {
        std::ranges::fill(image.light, 1.0);
        image.has_map = false;
    }
    return image;
}

std::optional<Suspicion> doubt_of_rig(std::span<const LightCells> images,
                                      const Survey& survey,
                                      DropoutScales& scales) {
    std::map<std::uint64_t, std::size_t> counts;
    for (const LightCells& image : images) ++counts[judged(image, scales).out];
    counts.erase(0);
    for (const auto& [out, count] : counts) {
        if (2 * count <= images.size()) continue;
        scales.images = 0;
        return Suspicion{
            .about = "strobes",
            .what = fmt::format(
                "{} of {} images look as if {} had not fired: a different rig? No image is judged",
                count,
                images.size(),
                fmt::join(marked("", survey.strobes.names, 1.0, out).strobes, ", "))};
    }
    return std::nullopt;
}

std::string why_dark(const Dropout& found) {
    return fmt::format("without light: {:.2g} of the survey's, as when no strobe fires",
                       found.share);
}

void judge(SurveyImage& taken,
           const Survey& survey,
           const ImageFile& file,
           const DropoutScales& scales) {
    const bool has_own_level = survey.camera.exposure_by == ExposureBy::Model;
    if (survey.dropouts == Dropouts::Ignore && !has_own_level) return;
    const Dropout found = judged(light_cells(taken, survey, file), scales);
    if (has_own_level && !found.is_dark) taken.exposure *= std::exp(found.level);
    if (survey.dropouts == Dropouts::Ignore) return;
    if (found.is_dark) throw InputError("{}", why_dark(found));
    taken.light_share = found.share;
    taken.strobes_out = found.out;
    if (survey.dropouts == Dropouts::Correct && found.out == 0) taken.exposure *= found.share;
}

MarkedImage marked(const std::string& image,
                   const std::vector<std::string>& strobes,
                   double share,
                   std::uint64_t out) {
    MarkedImage one{.image = image, .share = share};
    for (std::size_t s = 0; s < strobes.size(); ++s)
        if ((out >> s & 1U) != 0) one.strobes.push_back(strobes[s]);
    return one;
}

}  // namespace aphotic
