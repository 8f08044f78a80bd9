// SPDX-License-Identifier: BSD-3-Clause
//
// Files that are whole or not there: written beside their place, then renamed into it.
//
//   AtomicFile out("image.exr");
//   ... write to out.temporary() ...
//   out.commit();
//
// commit() puts the file's bytes on the disk (fsync) before its new name, and then the name, so
// that a power cut too leaves the file of before or the new one, whole. Without commit() nothing is
// left behind, also when SIGINT, SIGTERM or SIGHUP ends us (base/interruption.h). A failed write,
// sync or rename is a RunError that names the file.
//
// Only what cannot clean up, SIGKILL or a machine that goes down, leaves a temporary:
//
//   .image.5f3a9c01-f000003c-1234.part.exr
//
// It names the boot of the kernel, its space of process numbers (a container's differ) and the
// process. Others may write to the same folder from other machines and containers, where our
// process numbers mean nothing, so the next run removes a temporary only where it is certain that
// nobody writes it:
//
//   - same boot, same space of numbers: no such process is left
//   - another boot: the file system is a disk or memory of this machine, so that boot is over
//
// Others stay, such as those of a container that was killed or of a machine that went down while
// it wrote to a network folder. So do those of versions up to 0.2, which name the process alone.
#pragma once

#include "base/interruption.h"

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
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
    std::optional<RemovedBySignal> removed_by_signal_;  // until it is committed
};

// Removes the temporaries that killed processes left in this folder. The second removes those of
// one file alone, in a folder that is not ours.
void remove_abandoned_files(const std::filesystem::path& folder);
void remove_abandoned_of(const std::filesystem::path& file);

// A signal that would end us waits until the file is whole.
void write_text_file(const std::filesystem::path& path, std::string_view text);

inline constexpr std::size_t kMebibyte = std::size_t{1} << 20U;

// More than any text that people write or that is worth to be kept in memory.
inline constexpr std::size_t kMostTextFile_bytes = 256 * kMebibyte;

// The whole file. An unreadable one is an InputError: users name such files. So is one of more
// bytes than most_bytes, of which no more than that is read: a device or a pipe may have no end.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& path,
                                         std::size_t most_bytes = kMostTextFile_bytes);

// Makes the folder and its parents. A RunError says why it cannot be created or written to.
void make_folder(const std::filesystem::path& folder);

}  // namespace aphotic
