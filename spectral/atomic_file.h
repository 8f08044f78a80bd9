// SPDX-License-Identifier: BSD-3-Clause
//
// Files that are whole or not there: written beside their place, then renamed into it.
//
//   AtomicFile out("image.exr");
//   ... write to out.temporary() ...
//   out.commit();
//
// Without commit() nothing is left behind. A failed write or rename is a RunError that names
// the file.
#pragma once

#include <filesystem>
#include <string_view>

namespace aphotic {

class AtomicFile {
  public:
    explicit AtomicFile(std::filesystem::path final_path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
    [[nodiscard]] const std::filesystem::path& final_path() const { return final_path_; }
    void commit();

  private:
    std::filesystem::path final_path_;
    std::filesystem::path temporary_;
    bool committed_ = false;
};

// Removes what was left beside such files, in this folder and those below, by processes of this
// machine that were killed: those that run are left alone.
void remove_abandoned(const std::filesystem::path& folder);

void write_text_file(const std::filesystem::path& path, std::string_view text);

// The whole file. An unreadable one is an InputError: users name such files.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& path);

// Makes the folder and its parents. A RunError says why it cannot be made or written to.
void make_folder(const std::filesystem::path& folder);

}  // namespace aphotic
