// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic init RIG.toml: a rig to change, from a template.
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/option_words.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/terminal.h"
#include "rig/file/rig_template.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;

struct InitOptions {
    std::string file;
    std::string like = "habcam";
    bool json = false;
};

struct TemplateCopy {
    fs::path file;
    std::string_view text;
};

void require_new(const std::vector<TemplateCopy>& copies) {
    for (const TemplateCopy& copy : copies) {
        if (fs::exists(copy.file) && read_text_file(copy.file) != copy.text)
            throw InputError("{}: exists; allowed: a new file", copy.file.string());
    }
}

struct BegunRig {
    fs::path rig;
    std::vector<fs::path> files;  // the rig among them
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
        shell_word(begun.rig.string()));
}

ExitStatus begin_rig(const InitOptions& options) {
    const RigTemplate chosen = rig_template(options.like);
    const fs::path file = options.file;
    std::vector<TemplateCopy> copies{{file, chosen.rig}};
    for (const auto& [name, text] : chosen.files)
        copies.push_back({file.parent_path() / name, text});
    require_new(copies);
    BegunRig begun{.rig = file, .files = {}, .guesses = unmeasured_lines(chosen.rig).size()};
    for (const TemplateCopy& copy : copies) {
        write_text_file(copy.file, copy.text);
        begun.files.push_back(copy.file);
    }
    show(begun, options.json);
    return kDone;
}

Action configure_init(CLI::App& app) {
    const auto options = std::make_shared<InitOptions>();
    add_option(app, "FILE", options->file)->required();
    add_option(app, "--like", options->like)->check(CLI::IsMember(template_names()));
    add_json(app, options->json);
    return [options] { return begin_rig(*options); };
}

}  // namespace

const Command kInit{"init", configure_init};

}  // namespace aphotic::cli
