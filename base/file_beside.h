// SPDX-License-Identifier: BSD-3-Clause
//
// The file that another file names, such as a table in a rig: in the folder of that file or below
// it, and nowhere else. A rig may come from anybody, so it must not make us read what it was not
// sent with. A path that leaves the folder is refused, be it absolute, through ".." or through a
// symbolic link anywhere on its way, and so is what is no regular file: a pipe, a device, a folder.
//
// What the user names on the command line is the user's word, and not read through this.
#pragma once

#include <filesystem>
#include <string>

namespace aphotic {

// folder / name, to be opened; an empty folder is the working directory. Throws InputError.
[[nodiscard]] std::filesystem::path file_beside(const std::filesystem::path& folder,
                                                const std::string& name);

}  // namespace aphotic
