// SPDX-License-Identifier: BSD-3-Clause
#include "cli/survey_files.h"

#include "lightmap/navigation.h"
#include "spectral/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace aphotic::cli {

namespace fs = std::filesystem;

namespace {

fs::path without_extension(const fs::path& file) {
    return is_image_name(file) ? file.parent_path() / file.stem() : file;
}

void add_folder(const fs::path& folder, const fs::path& output, std::vector<SurveyFile>& files) {
    std::error_code none;
    if (fs::equivalent(folder, output, none)) {
        throw InputError(
            fmt::format("{}: found the folder to write to; allowed: folders of images, "
                        "with the results elsewhere",
                        folder.string()));
    }
    const auto first = std::ssize(files);
    const auto options = fs::directory_options::follow_directory_symlink;
    for (fs::recursive_directory_iterator it(folder, options), end; it != end; ++it) {
        const fs::path& file = it->path();
        // Results are no raw images: those of this run, nor those of an earlier one.
        if (it->is_directory() &&
            (fs::equivalent(file, output, none) || fs::exists(file / "correction.json"))) {
            it.disable_recursion_pending();
        }
        const bool is_hidden = file.filename().string().starts_with('.');
        if (!is_image_name(file) || is_hidden || !it->is_regular_file()) continue;
        files.push_back({.source = file, .name = without_extension(fs::relative(file, folder))});
    }
    if (std::ssize(files) == first) {
        throw InputError(fmt::format("{}: the folder holds no image", folder.string()));
    }
    std::ranges::sort(files.begin() + first, files.end(), {}, &SurveyFile::name);
}

}  // namespace

std::vector<SurveyFile> survey_files(const std::vector<std::string>& arguments,
                                     const fs::path& output) {
    std::vector<SurveyFile> files;
    for (const std::string& argument : arguments) {
        if (!fs::exists(argument)) {
            throw InputError(fmt::format("{}: there is no such file or folder", argument));
        }
        if (fs::is_directory(argument)) {
            add_folder(argument, output, files);
        } else {
            const fs::path file(argument);
            files.push_back({.source = file, .name = without_extension(file.filename())});
        }
    }
    std::map<fs::path, const SurveyFile*> by_name;
    for (const SurveyFile& file : files) {
        const auto [other, is_new] = by_name.emplace(file.name, &file);
        if (is_new) continue;
        throw InputError(fmt::format("{} and {} would both become {}",
                                     other->second->source.string(),
                                     file.source.string(),
                                     (output / file.name).string()));
    }
    return files;
}

}  // namespace aphotic::cli
