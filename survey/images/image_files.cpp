// SPDX-License-Identifier: BSD-3-Clause
#include "survey/images/image_files.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/printable.h"
#include "base/words.h"
#include "image/raw_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <system_error>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

bool is_within(const fs::path& path, const fs::path& folder) {
    return std::ranges::mismatch(folder, path).in1 == folder.end();
}

// To a folder that contains it, itself or through the links that led here: an endless loop.
bool leads_back(const fs::path& link, int folders_up) {
    const fs::path target = fs::canonical(link);
    fs::path folder = link.parent_path();
    for (int up = 0; up <= folders_up; ++up, folder = folder.parent_path()) {
        if (is_within(fs::canonical(folder), target)) return true;
    }
    return false;
}

// Results are not raw images, whether of this run or of an earlier one.
bool holds_results(const fs::path& folder, const fs::path& output) {
    std::error_code none;
    return fs::equivalent(folder, output, none) || fs::exists(folder / kCorrectionNotes, none) ||
           fs::exists(folder / kBaselineNotes, none);
}

// In a folder of results that is itself the survey, as for averaging them: the other files made
// from each image.
bool is_beside_results(const fs::path& path, bool is_folder) {
    return is_folder ? path.filename() == kSrgbFolder
                     : path.filename().string().ends_with(".mask.png");
}

// "24 .orf, 1 .csv": the most frequent kinds, in order.
std::string kinds_in_words(const std::map<std::string, std::size_t>& kinds) {
    constexpr std::size_t kMostKinds = 4;
    std::vector<std::pair<std::size_t, std::string>> by_count;
    for (const auto& [extension, count] : kinds) by_count.emplace_back(count, extension);
    std::ranges::stable_sort(
        by_count, std::greater<>(), &std::pair<std::size_t, std::string>::first);
    std::string words;
    for (std::size_t i = 0; i < std::min(kMostKinds, by_count.size()); ++i) {
        words += fmt::format(
            "{}{} {}", words.empty() ? "" : ", ", by_count[i].first, printable(by_count[i].second));
    }
    return words;
}

// Raw formats that are not supported, for which a message suggests a remedy.
bool is_other_raw(std::string_view extension) {
    constexpr std::string_view kRaws =
        ".orf,.rw2,.raf,.cr3,.pef,.srw,.x3f,.iiq,.3fr,.nrw,.erf,.kdc,.dcr,.raw";
    return std::ranges::count(comma_fields(kRaws), extension) > 0;
}

[[noreturn]] void refuse_empty(const fs::path& folder,
                               const std::map<std::string, std::size_t>& others) {
    std::string found;
    if (!others.empty()) {
        found = "; found " + kinds_in_words(others);
        found += std::ranges::any_of(others, [](const auto& o) { return is_other_raw(o.first); })
                     ? " (raw files of these kinds are not read: convert them to DNG)"
                     : "";
    }
    throw InputError(
        "{}: the folder contains no images{}; allowed: TIFF, PNG, EXR, JPEG, DNG, CR2, NEF, ARW; "
        "others as single files",
        folder.string(),
        found);
}

void add_folder(const fs::path& folder, const fs::path& output, std::vector<ImageFile>& files) {
    std::error_code none;
    if (fs::equivalent(folder, output, none)) {
        throw InputError(
            "{}: found the output folder; allowed: folders of images, with the results elsewhere",
            folder.string());
    }
    const auto first = std::ssize(files);
    const bool are_results = holds_results(folder, output);
    std::map<std::string, std::size_t> others;  // by extension
    const auto options = fs::directory_options::follow_directory_symlink;
    for (fs::recursive_directory_iterator it(folder, options), end; it != end; ++it) {
        const fs::path& file = it->path();
        const bool is_folder = it->is_directory(none);
        const bool is_left_out = are_results && is_beside_results(file, is_folder);
        if (!is_folder || is_left_out || holds_results(file, output) ||
            (it->is_symlink() && leads_back(file, it.depth()))) {
            it.disable_recursion_pending();
        }
        const bool is_hidden = file.filename().string().starts_with('.');
        if (is_folder || is_hidden || is_left_out) continue;
        if (!is_image_name(file)) {
            constexpr std::size_t kMostBytes = 12;
            const std::string extension = lower_case(file.extension().string());
            if (!extension.empty() && extension.size() <= kMostBytes) ++others[extension];
            continue;
        }
        // By its own name here, even if it links to a file elsewhere.
        files.push_back(
            {.source = file, .name = without_extension(file.lexically_relative(folder))});
    }
    if (std::ssize(files) == first) refuse_empty(folder, others);
    std::ranges::sort(files.begin() + first, files.end(), {}, &ImageFile::name);
}

}  // namespace

std::vector<ImageFile> image_files(const std::vector<std::string>& arguments,
                                   const fs::path& output) {
    std::vector<ImageFile> files;
    for (const std::string& argument : arguments) {
        std::error_code none;
        if (!fs::exists(argument, none)) {
            throw InputError("{}: no such file or folder", argument);
        }
        if (fs::is_directory(argument, none)) {
            add_folder(argument, output, files);
        } else {
            const fs::path file(argument);
            files.push_back({.source = file, .name = without_extension(file.filename())});
        }
    }
    std::map<fs::path, const ImageFile*> by_name;
    for (const ImageFile& file : files) {
        const auto [other, is_new] = by_name.emplace(file.name, &file);
        if (is_new) continue;
        throw InputError("{} and {} would both become {}",
                         other->second->source.string(),
                         file.source.string(),
                         (output / file.name).string());
    }
    return files;
}

void require_file(const fs::path& image) {
    std::error_code none;
    const fs::file_status status = fs::status(image, none);
    if (fs::is_regular_file(status)) return;
    if (fs::exists(status)) throw InputError("found a pipe, device or folder; allowed: a file");
    throw InputError(fs::is_symlink(fs::symlink_status(image, none))
                         ? "found a broken link; allowed: a file"
                         : "the file no longer exists");
}

bool is_image_name(const fs::path& file) {
    static constexpr std::array<std::string_view, 6> kExtensions{
        ".tif", ".tiff", ".png", ".exr", ".jpg", ".jpeg"};
    return is_raw_name(file) ||
           std::ranges::find(kExtensions, lower_case(file.extension().string())) !=
               kExtensions.end();
}

fs::path without_extension(const fs::path& file) {
    return is_image_name(file) ? file.parent_path() / file.stem() : file;
}

}  // namespace aphotic
