// SPDX-License-Identifier: BSD-3-Clause
//
// The iFDO of corrected images, from that of the raw ones: each item under its result's name,
// without skipped images, and everything unchanged except
//
//   image-uuid, image-set-uuid     new, since these are new images: from the old one and the
//                                  SHA-256 of the result, or of all results for the set's
//   image-hash-sha256              of the result
//   image-quality                  processed
//   image-illumination             artificial light
//   image-photometric-calibration  gain, white balance, rig and water
//   image-set-local-path           ".", where the results are
//   image-entropy, -average-color  omitted, with all image-mpeg7: they describe the raw pixels
//
// Images in sRGB, for annotators, have an iFDO of their own beside them.
//
// The schema requires UUIDs of version 4: 122 bits of a SHA-256 replace random ones, so equal
// results have equal UUIDs.
#pragma once

#include "rig/rig.h"
#include "survey/correct/correction_run.h"
#include "survey/navigation/ifdo.h"
#include "survey/survey.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct IfdoResults {
    std::filesystem::path file;
    std::size_t images = 0;
    std::vector<std::string> without_item{};  // results whose images the iFDO lacks
};

// Its place: in the folder of results, under its own name. An InputError if that is the source
// itself, or the file of the correction's notes.
[[nodiscard]] std::filesystem::path ifdo_place(const std::filesystem::path& source,
                                               const std::filesystem::path& folder);

// The report gives the outcome for each image. rig: null if one map was used for all.
IfdoResults write_ifdo_of_results(const Ifdo& of_raw,
                                  const std::filesystem::path& place,
                                  const Survey& survey,
                                  const CorrectionOptions& options,
                                  const CorrectionReport& report,
                                  const Rig* rig);

// Of version 4, as lower-case hexadecimal digits and hyphens.
[[nodiscard]] std::string uuid_of(std::string_view text);

}  // namespace aphotic
