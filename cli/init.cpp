// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic init RIG.toml: an editable rig, from a template.
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/terminal.h"
#include "rig/file/rig_template.h"
#include "rig/file/rig_text.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;

struct InitOptions {
    std::string file;
    std::string like = "habcam";
    bool json = false;
};

// An existing file with the same text is accepted.
void require_new(const fs::path& file, std::string_view text) {
    if (fs::exists(file) && read_text_file(file) != text)
        throw InputError("{}: exists; allowed: a new file", file.string());
}

struct BegunRig {
    std::vector<fs::path> files;  // the rig last
    std::size_t guesses = 0;
};

nlohmann::ordered_json to_json(const BegunRig& begun) {
    nlohmann::ordered_json json{{"files", nlohmann::ordered_json::array()},
                                {"guesses", begun.guesses}};
    for (const fs::path& file : begun.files) json["files"].push_back(file.string());
    return json;
}

void print(const BegunRig& begun) {
    for (const fs::path& file : begun.files) say("wrote {}\n", file.string());
    say("{} lines are guesses, marked `measure`. Next:\n"
        "  aphotic plan {}\n",
        begun.guesses,
        shell_word(begun.files.back().string()));
}

// Its title is the file's name.
std::string titled(const std::string& rig, const fs::path& file) {
    RigText text(rig, file.string(), file.parent_path());
    text.set("title", file.stem().string());
    return text.text();
}

// Files that the rig names are written before the rig.
ExitStatus begin_rig(const InitOptions& options) {
    const RigTemplate chosen = rig_template(options.like);
    const fs::path file = options.file;
    BegunRig begun{.files = {}, .guesses = unmeasured_lines(chosen.rig).size()};
    for (const auto& [name, text] : chosen.files) begun.files.push_back(file.parent_path() / name);
    for (std::size_t i = 0; i < begun.files.size(); ++i)
        require_new(begun.files[i], chosen.files[i].csv);
    require_new(file, "");
    for (std::size_t i = 0; i < begun.files.size(); ++i)
        write_text_file(begun.files[i], chosen.files[i].csv);
    begun.files.push_back(file);
    write_text_file(file, titled(chosen.rig, file));
    show(begun, options.json);
    return kDone;
}

}  // namespace

Action configure_init(CLI::App& app) {
    const auto options = std::make_shared<InitOptions>();
    add_option(app, "FILE", options->file)->required();
    add_option(app, "--like", options->like)->check(CLI::IsMember(template_names()));
    add_json(app, options->json);
    return [options] { return begin_rig(*options); };
}

}  // namespace aphotic::cli
