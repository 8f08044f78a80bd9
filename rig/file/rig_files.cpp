// SPDX-License-Identifier: BSD-3-Clause
#include "rig/file/rig_files.h"

#include "base/atomic_file.h"
#include "base/file_beside.h"
#include "base/sha256.h"
#include "spectral/curve_loader.h"

namespace aphotic {

std::filesystem::path RigFiles::path_of(const std::string& name) const {
    return file_beside(folder_, name);
}

std::string RigFiles::read(const std::string& name, std::size_t most_bytes) {
    std::string text = read_text_file(path_of(name), most_bytes);
    files_.push_back({.name = name, .sha256 = sha256_of_text(text)});
    return text;
}

std::string RigFiles::digest(const std::string& toml) const {
    std::string digested = toml;
    for (const RigFile& file : files_) digested += file.sha256;
    return sha256_of_text(digested);
}

std::vector<Spectrum> RigFiles::curves(Section& section, std::string_view key, CurveRole role) {
    return curves_named(
        section,
        key,
        section.text(key, "a built-in table's name (aphotic data) or a .csv file beside the rig"),
        role);
}

std::vector<Spectrum> RigFiles::curves_named(const Section& section,
                                             std::string_view key,
                                             const std::string& name,
                                             CurveRole role) {
    return section.at_key(key, [&] {
        std::vector<Spectrum> curves = load_curves(name, role, folder_);
        const CurveSource& source = curves.front().source().value();
        if (source.is_file()) files_.push_back({.name = name, .sha256 = source.file_sha256});
        return curves;
    });
}

Spectrum RigFiles::curve(Section& section,
                         std::string_view key,
                         CurveRole role,
                         const std::string& absent) {
    if (section.has(key)) return curves(section, key, role).front();
    return load_curve(absent, role, folder_);
}

Table RigFiles::table(const Section& section, std::string_view key, const std::string& name) {
    return section.at_key(key, [&] {
        Table table = load_table(name, folder_);
        if (!table.file_sha256.empty())
            files_.push_back({.name = name, .sha256 = table.file_sha256});
        return table;
    });
}

}  // namespace aphotic
