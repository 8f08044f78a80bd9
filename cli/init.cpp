// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic init RIG.toml: a rig to change, from a template.
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/option_words.h"
#include "cli/terminal.h"
#include "rig/file/rig_template.h"

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

ExitStatus begin_rig(const InitOptions& options) {
    const RigTemplate chosen = rig_template(options.like);
    const fs::path file = options.file;
    std::vector<TemplateCopy> copies{{file, chosen.rig}};
    for (const auto& [name, text] : chosen.files)
        copies.push_back({file.parent_path() / name, text});
    require_new(copies);
    for (const TemplateCopy& copy : copies) {
        write_text_file(copy.file, copy.text);
        say("wrote {}\n", copy.file.string());
    }
    say("{} lines are guesses, marked `measure`. Next:\n"
        "  aphotic plan {}\n",
        unmeasured_lines(chosen.rig).size(),
        shell_word(options.file));
    return kDone;
}

Action configure_init(CLI::App& app) {
    const auto options = std::make_shared<InitOptions>();
    add_option(app, "FILE", options->file)->required();
    add_option(app, "--like", options->like)->check(CLI::IsMember(template_names()));
    return [options] { return begin_rig(*options); };
}

}  // namespace

const Command kInit{"init", configure_init};

}  // namespace aphotic::cli
