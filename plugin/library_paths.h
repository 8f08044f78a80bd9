// SPDX-License-Identifier: BSD-3-Clause
//
// Where the user's POV-Ray looks for includes: the Library_Path lines of the INI file that it would
// read by itself in this folder. Ours takes that file's place, and hands them on.
//
// As POV-Ray 3.7 does it: the first found of $POVINI, ./povray.ini, ~/.povray/VERSION/povray.ini
// and /etc/povray/VERSION/povray.ini.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace aphotic {

// version: POV-Ray's, such as 3.7.0.10. Paths that are relative stand as they are.
[[nodiscard]] std::vector<std::string> library_paths(const std::filesystem::path& folder,
                                                     const std::string& version);

// Those of one INI file's text.
[[nodiscard]] std::vector<std::string> library_paths_in(const std::string& ini);

}  // namespace aphotic
