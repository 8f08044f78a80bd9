// SPDX-License-Identifier: BSD-3-Clause
//
// What a process leaves that was killed while it wrote.
#pragma once

#include "base/atomic_file.h"

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace aphotic {

// The temporary of this file.
inline std::filesystem::path abandon(const std::filesystem::path& file) {
    const std::string ours = AtomicFile(file).temporary().string();
    const pid_t killed = ::fork();
    if (killed == 0) {
        const AtomicFile half(file);
        std::ofstream(half.temporary()) << "half";
        ::_exit(0);
    }
    ::waitpid(killed, nullptr, 0);
    const std::string number = std::to_string(::getpid()) + ".part";
    std::string its = ours;
    its.replace(its.rfind(number), number.size(), std::to_string(killed) + ".part");
    return its;
}

}  // namespace aphotic
