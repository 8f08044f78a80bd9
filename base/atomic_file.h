// SPDX-License-Identifier: BSD-3-Clause
//
// Files that are complete or absent: written next to their place, then renamed into it.
//
//   AtomicFile out("image.exr");
//   ... write to out.temporary() ...
//   out.commit();
//
// commit() flushes the file's bytes to the disk (fsync) before its new name, and then the name, so
// that even a power cut leaves either the old file or the new one, complete. Without commit()
// nothing is left behind, even when SIGINT, SIGTERM or SIGHUP ends the process
// (base/interruption.h). A failed write, sync or rename is a RunError that names the file.
//
// Only SIGKILL, or a crash or power cut of the machine, leaves a temporary:
//
//   .image.5f3a9c01-f000003c-1234.part.exr
//
// The name contains the kernel's boot, its process namespace (containers have different ones) and
// the process. Other machines and containers may write to the same folder, and our process numbers
// mean nothing there, so the next run removes a temporary only if it is certainly no longer being
// written:
//
//   - same boot, same namespace: no such process is left
//   - another boot: the file system is a disk or memory of this machine, so that boot is over
//
// Others are kept, such as those of a killed container, or of a machine that crashed while writing
// to a network folder. So are those of versions up to 0.2, whose names contain only the process
// number.
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

// Removes the temporaries that killed processes left in this folder. The second overload removes
// those of one file only, in a folder that is not ours.
void remove_abandoned_files(const std::filesystem::path& folder);
void remove_abandoned_of(const std::filesystem::path& file);

// A signal that would end the process waits until the file is complete.
void write_text_file(const std::filesystem::path& path, std::string_view text);

inline constexpr std::size_t kMebibyte = std::size_t{1} << 20U;

// More than any text written by hand, or worth keeping in memory.
inline constexpr std::size_t kMostTextFile_bytes = 256 * kMebibyte;

// The whole file. An unreadable file is an InputError, since users name such files. So is one of
// more than most_bytes; no more than that is read, since a device or a pipe may have no end.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& path,
                                         std::size_t most_bytes = kMostTextFile_bytes);

// Makes the folder and its parents. A RunError if it cannot be created or written to.
void make_folder(const std::filesystem::path& folder);

}  // namespace aphotic
