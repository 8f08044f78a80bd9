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

// The files that `correct` and `baseline` leave in a folder of results, which identify it.
inline constexpr std::string_view kCorrectionNotes = "correction.json";
inline constexpr std::string_view kBaselineNotes = "baseline.json";
inline constexpr std::string_view kReportPage = "report.html";
inline constexpr std::string_view kJournal = "corrected.jsonl";  // of what is done
inline constexpr const char* kSrgbFolder = "srgb";               // of images to look at

// In the order of the arguments, a folder's images sorted by name, those in the folders within it
// among them, also by links; but for a link to a folder that it lies in. What lies in `output` and
// in folders of results is left out; of one that is named itself, its linear images count alone.
// What has an image's name and cannot be read, as a link that leads nowhere, is among them, for
// require_file() to tell. An InputError when an argument is not there or is `output` itself, a
// folder holds no image, or two images would have one name.
[[nodiscard]] std::vector<ImageFile> image_files(const std::vector<std::string>& arguments,
                                                 const std::filesystem::path& output);

// An InputError, without the image's name, unless it exists and is a file: reading a pipe would
// block forever.
void require_file(const std::filesystem::path& image);

// Whether the file's name has an image's extension, such as .tif, ignoring case; and the path
// without it.
[[nodiscard]] bool is_image_name(const std::filesystem::path& file);
[[nodiscard]] std::filesystem::path without_extension(const std::filesystem::path& file);

}  // namespace aphotic
