// SPDX-License-Identifier: BSD-3-Clause
//
// While it is there, no file of this process grows beyond so many bytes: a write fails with "File
// too large", as on a full disk it fails with "No space left on device".
#pragma once

#include <signal.h>
#include <sys/resource.h>

#include <stdexcept>

namespace aphotic {

class FileLimit {
  public:
    explicit FileLimit(::rlim_t most_bytes) : signal_(::signal(SIGXFSZ, SIG_IGN)) {
        ::rlimit limit{};
        if (::getrlimit(RLIMIT_FSIZE, &limit) != 0) throw std::runtime_error("no file limit");
        before_ = limit.rlim_cur;
        set(most_bytes);
    }
    ~FileLimit() {
        set(before_);
        ::signal(SIGXFSZ, signal_);
    }
    FileLimit(const FileLimit&) = delete;
    FileLimit& operator=(const FileLimit&) = delete;

  private:
    static void set(::rlim_t most_bytes) {
        ::rlimit limit{};
        ::getrlimit(RLIMIT_FSIZE, &limit);
        limit.rlim_cur = most_bytes;
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }

    ::sighandler_t signal_;
    ::rlim_t before_ = 0;
};

}  // namespace aphotic
