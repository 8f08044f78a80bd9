// SPDX-License-Identifier: BSD-3-Clause
//
// A new file that libraries write to, which keeps the system's error message, such as "No space
// left on device". Libraries lose it, or report no error.
//
// Header only, since the part loaded at run time also uses it.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>

namespace aphotic {

class CheckedFile {
  public:
    // error() reports failures.
    explicit CheckedFile(const std::filesystem::path& file)
        : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
        if (descriptor_ < 0) error_ = errno;
    }
    ~CheckedFile() { close(); }
    CheckedFile(const CheckedFile&) = delete;
    CheckedFile& operator=(const CheckedFile&) = delete;

    // Whether all bytes were written.
    bool write(const void* bytes, std::size_t count, std::int64_t at) {
        const auto* from = static_cast<const char*>(bytes);
        while (count > 0 && error_ == 0) {
            const ::ssize_t written = ::pwrite(descriptor_, from, count, at);
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) {
                error_ = written < 0 ? errno : ENOSPC;
                break;
            }
            from += written;
            at += written;
            count -= static_cast<std::size_t>(written);
        }
        return error_ == 0;
    }

    // The number of bytes read.
    std::size_t read(void* bytes, std::size_t count, std::int64_t at) {
        std::size_t done = 0;
        while (done < count) {
            const ::ssize_t many = ::pread(descriptor_,
                                           static_cast<char*>(bytes) + done,
                                           count - done,
                                           at + static_cast<std::int64_t>(done));
            if (many < 0 && errno == EINTR) continue;
            if (many <= 0) break;
            done += static_cast<std::size_t>(many);
        }
        return done;
    }

    [[nodiscard]] std::size_t size() const {
        struct stat state {};
        return ::fstat(descriptor_, &state) == 0 ? static_cast<std::size_t>(state.st_size) : 0;
    }

    void close() {
        if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_ == 0) error_ = errno;
        descriptor_ = -1;
    }

    // The system's message; empty if nothing has failed.
    [[nodiscard]] std::string error() const {
        return error_ == 0 ? "" : std::generic_category().message(error_);
    }

  private:
    int descriptor_ = -1;
    int error_ = 0;
};

}  // namespace aphotic
