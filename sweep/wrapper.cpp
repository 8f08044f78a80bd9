// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/wrapper.h"

#include "base/atomic_file.h"
#include "base/words.h"

#include <string>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

void replace_all(std::string& text, std::string_view name, std::string_view value) {
    for (std::size_t at = text.find(name); at != std::string::npos;
         at = text.find(name, at + value.size()))
        text.replace(at, name.size(), value);
}

}  // namespace

void write_wrappers(const WrappedSweep& sweep) {
    const std::string folder = sweep.folder.string();
    std::string slurm_folder = folder;
    replace_all(slurm_folder, "%", "%%");
    for (const char* logs : {"slurm", "condor"}) make_folder(sweep.folder / logs);
    for (const WrapperText& wrapper : wrapper_texts()) {
        std::string text{wrapper.text};
        replace_all(text, "@PLAIN_FOLDER@", folder);
        replace_all(text, "@SLURM_FOLDER@", slurm_folder);
        replace_all(text, "@FOLDER@", shell_word(folder));
        replace_all(text, "@TASKS@", fmt::to_string(sweep.tasks));
        replace_all(text, "@CORES@", fmt::to_string(sweep.cores));
        const fs::path file = sweep.folder / wrapper.name;
        write_text_file(file, text);
        if (text.starts_with("#!"))
            fs::permissions(file,
                            fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                            fs::perm_options::add);
    }
}

}  // namespace aphotic
