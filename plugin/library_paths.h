// SPDX-License-Identifier: BSD-3-Clause
//
// The include paths of the user's POV-Ray: the Library_Path lines of the INI file that it would
// read by default in this folder. Our INI file replaces it and repeats these lines.
//
// As POV-Ray 3.7 does: the first found of $POVINI, ./povray.ini, ~/.povray/VERSION/povray.ini and
// /etc/povray/VERSION/povray.ini.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace aphotic {

// version: POV-Ray's, such as 3.7.0.10. Relative paths are kept as they are.
[[nodiscard]] std::vector<std::string> library_paths(const std::filesystem::path& folder,
                                                     const std::string& version);

// Those of one INI file's text.
[[nodiscard]] std::vector<std::string> library_paths_in(const std::string& ini);

}  // namespace aphotic
