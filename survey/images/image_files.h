// SPDX-License-Identifier: BSD-3-Clause
//
// The images of a survey, from the files and folders that a user names, and the paths of their
// results.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct ImageFile {
    std::filesystem::path source;
    // Below the output folder, without extension: the file's name, and its folders below the named
    // one.
    std::filesystem::path name;
};

// The files that `correct` and `baseline` write to a folder of results, which identify it.
inline constexpr std::string_view kCorrectionNotes = "correction.json";
inline constexpr std::string_view kBaselineNotes = "baseline.json";
inline constexpr std::string_view kReportPage = "report.html";
inline constexpr std::string_view kJournal = "corrected.jsonl";  // finished images
inline constexpr const char* kSrgbFolder = "srgb";               // viewable images

// In the order of the arguments; a folder's images are sorted by name and include those in its
// subfolders, also through links, except links to a folder that contains them. `output` and folders
// of results are skipped; of a folder of results that is itself named, only the linear images are
// used. Files with an image's name that cannot be read, such as broken links, are included, so that
// require_file() reports them. An InputError if an argument does not exist or is `output` itself, a
// folder holds no image, or two images would have the same name.
[[nodiscard]] std::vector<ImageFile> image_files(const std::vector<std::string>& arguments,
                                                 const std::filesystem::path& output);

// An InputError, without the image's name, unless it exists and is a regular file: reading a pipe
// would block forever.
void require_file(const std::filesystem::path& image);

// Whether the file's name has an image's extension, such as .tif, ignoring case; and the path
// without it.
[[nodiscard]] bool is_image_name(const std::filesystem::path& file);
[[nodiscard]] std::filesystem::path without_extension(const std::filesystem::path& file);

}  // namespace aphotic
