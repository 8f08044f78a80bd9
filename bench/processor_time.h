// SPDX-License-Identifier: BSD-3-Clause
//
// Processor time so far, of this process (RUSAGE_SELF) or of those that it waited for
// (RUSAGE_CHILDREN). Other processes on the machine affect it less than wall time.
#pragma once

#include <sys/resource.h>

#include <initializer_list>

namespace aphotic {

inline double processor_s(int who) {
    rusage use{};
    ::getrusage(who, &use);
    double sum_s = 0.0;
    for (const timeval& time : {use.ru_utime, use.ru_stime})
        sum_s += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    return sum_s;
}

}  // namespace aphotic
