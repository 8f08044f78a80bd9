// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "python/bindings.h"

#include <algorithm>
#include <thread>

namespace aphotic::python {

void require_range(const char* name, double value, double least, double most) {
    if (value >= least && value <= most) return;
    throw InputError("{}: found {}; allowed: {} to {}", name, value, least, most);
}

int threads_of(int threads) {
    constexpr double kMostThreads = 1024;
    require_range("threads", threads, 0, kMostThreads);
    return threads > 0 ? threads
                       : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace aphotic::python

NB_MODULE(_aphotic, module) {
    namespace nb = nanobind;
    module.attr("__version__") = APHOTIC_VERSION;
    const nb::exception<aphotic::InputError> input_error(module, "InputError", PyExc_ValueError);
    const nb::exception<aphotic::RunError> run_error(module, "RunError", PyExc_RuntimeError);
    aphotic::python::bind_rig(module);
    aphotic::python::bind_light(module);
    aphotic::python::bind_survey(module);
}
