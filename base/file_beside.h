// SPDX-License-Identifier: BSD-3-Clause
//
// A file that another file names, such as a table in a rig: it must be in the folder of that file
// or below. A rig may come from anyone, so it must not make us read files outside its own folder. A
// path that leaves the folder is refused, whether absolute, through ".." or through a symbolic
// link, and so is anything but a regular file: a pipe, a device, a folder.
//
// Files that the user names on the command line are trusted and not read through this.
#pragma once

#include <filesystem>
#include <string>

namespace aphotic {

// folder / name, ready to open; an empty folder is the working directory. Throws InputError.
[[nodiscard]] std::filesystem::path file_beside(const std::filesystem::path& folder,
                                                const std::string& name);

}  // namespace aphotic
