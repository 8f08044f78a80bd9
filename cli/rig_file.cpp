// SPDX-License-Identifier: BSD-3-Clause
#include "cli/rig_file.h"

#include "base/error.h"
#include "cli/terminal.h"
#include "rig/plausibility.h"
#include "rig/rig_reader.h"

#include <vector>

namespace aphotic::cli {

void add_strict_option(CLI::App& app, bool& strict) {
    app.add_flag("--strict", strict, "Treat warnings of what looks wrong as errors");
}

void check_plausible(const Rig& rig, const std::string& file, bool strict) {
    std::string all;
    for (const Doubt& doubt : doubts_of(rig)) {
        const std::string words = in_words(doubt, file);
        if (!strict) warn("looks wrong: {}", words);
        all += (all.empty() ? "" : "; ") + words;
    }
    if (strict && !all.empty()) throw InputError("--strict: looks wrong: " + all);
}

Rig read_plausible_rig(const std::string& file, bool strict) {
    Rig rig = read_rig(file);
    check_plausible(rig, file, strict);
    return rig;
}

}  // namespace aphotic::cli
