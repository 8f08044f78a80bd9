// SPDX-License-Identifier: BSD-3-Clause
//
// The tables and other files that a rig file names, read from its folder. Their contents are part
// of the rig's digest.
#pragma once

#include "rig/file/section.h"
#include "rig/rig.h"
#include "spectral/table.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

class RigFiles {
  public:
    explicit RigFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

    // name: as in the rig.
    std::string read(const std::string& name, std::size_t most_bytes);

    // Curves by a built-in table's name or from a CSV file.
    std::vector<Spectrum> curves(Section& section, std::string_view key, CurveRole role);
    std::vector<Spectrum> curves_named(const Section& section,
                                       std::string_view key,
                                       const std::string& name,
                                       CurveRole role);
    // absent: the built-in table used without the key.
    Spectrum curve(Section& section,
                   std::string_view key,
                   CurveRole role,
                   const std::string& absent);
    // Any table, from a file that the key names.
    Table table(const Section& section, std::string_view key, const std::string& name);

    [[nodiscard]] std::filesystem::path path_of(const std::string& name) const;
    [[nodiscard]] const std::vector<RigFile>& all() const { return files_; }

    // SHA-256 of the rig file's text and of all files that it names.
    [[nodiscard]] std::string digest(const std::string& toml) const;

  private:
    std::filesystem::path folder_;
    std::vector<RigFile> files_;
};

}  // namespace aphotic
