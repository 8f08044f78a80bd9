// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/sweep_inputs.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/sha256.h"
#include "survey/image_files.h"

#include <fmt/format.h>

#include <regex>
#include <set>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

// By its place from home: a survey that was moved with its sweep is the same.
std::string stamp_of(const fs::path& file, const fs::path& home) {
    std::error_code none;
    if (!fs::is_regular_file(file, none)) return "";
    return fmt::format("{} {} {}\n",
                       fs::absolute(file).lexically_normal().lexically_relative(home).string(),
                       fs::file_size(file, none),
                       fs::last_write_time(file, none).time_since_epoch().count());
}

std::string stamps_of_images(const std::string& argument, const SweepInputs& inputs) {
    std::string stamps;
    try {
        for (const ImageFile& image :
             image_files({(inputs.home / argument).string()}, inputs.folder))
            stamps += stamp_of(image.source, inputs.home);
    } catch (const InputError&) {
        return "";
    }
    return stamps;
}

// POV-Ray is run in the scene's folder, where names in includes start as well.
void add_scene(const fs::path& folder,
               const fs::path& name,
               std::set<fs::path>& seen,
               std::string& contents) {
    std::error_code none;
    const fs::path file = folder / name;
    if (!fs::is_regular_file(file, none) || !seen.insert(file.lexically_normal()).second) return;
    const std::string text = read_text_file(file);
    contents += fmt::format("{} {}\n", name.string(), sha256_of_text(text));
    // On one line: std::regex recurses by the character.
    static const std::regex kInclude(R"re(#[ \t]*include[ \t]*"([^"\n]+)")re");
    for (std::sregex_iterator it(text.begin(), text.end(), kInclude), end; it != end; ++it)
        add_scene(folder, (*it)[1].str(), seen, contents);
}

}  // namespace

std::string state_of(const SweepInputs& inputs) {
    std::string state;
    for (const std::string& argument : inputs.images) state += stamps_of_images(argument, inputs);
    for (const std::string& argument : inputs.arguments) {
        state += stamp_of(inputs.home / argument, inputs.home);
        const std::size_t value = argument.find('=') + 1;  // of --nav=FILE
        if (value > 0) state += stamp_of(inputs.home / argument.substr(value), inputs.home);
    }
    std::set<fs::path> seen;
    add_scene(inputs.scene.parent_path(), inputs.scene.filename(), seen, state);
    return state;
}

}  // namespace aphotic
