// SPDX-License-Identifier: BSD-3-Clause
//
// The images of a survey, from the files and folders that a user names, and where what is made of
// each goes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace aphotic::cli {

struct SurveyFile {
    std::filesystem::path source;
    // Below the output folder, without extension: the file's name, and its folders below the one
    // that was named.
    std::filesystem::path name;
};

// In the order of the arguments, a folder's images sorted by name, those in the folders within it
// among them. What lies in `output` is left out. An InputError when an argument is not there or is
// `output` itself, a folder holds no image, or two images would have one name.
[[nodiscard]] std::vector<SurveyFile> survey_files(const std::vector<std::string>& arguments,
                                                   const std::filesystem::path& output);

}  // namespace aphotic::cli
