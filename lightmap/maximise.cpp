// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/maximise.h"

#include <nlopt.h>

#include <cmath>
#include <exception>
#include <memory>
#include <new>
#include <type_traits>

namespace aphotic {
namespace {

// A step below which designs are equal: a hundredth of a millimetre in a box of a metre.
constexpr double kLeastStep = 1e-5;

struct Asked {
    const std::function<double(std::span<const double>)>& value;
    nlopt_opt search;
    int left;  // of the evaluations: NLopt ends a few steps later
    std::exception_ptr fault{};
};

// Called from C, which no exception may pass.
double ask(unsigned count, const double* point, double* /*gradient*/, void* data) {
    auto& asked = *static_cast<Asked*>(data);
    if (asked.left == 0) {
        nlopt_force_stop(asked.search);
        return -HUGE_VAL;
    }
    --asked.left;
    try {
        return asked.value({point, count});
    } catch (...) {
        asked.fault = std::current_exception();
        nlopt_force_stop(asked.search);
        return 0.0;
    }
}

}  // namespace

void maximise(SearchWay way,
              const std::vector<double>& start,
              const SearchEffort& effort,
              const std::function<double(std::span<const double>)>& value) {
    using Search = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, decltype(&nlopt_destroy)>;
    const Search search(nlopt_create(way == SearchWay::Global ? NLOPT_GN_CRS2_LM : NLOPT_LN_SBPLX,
                                     static_cast<unsigned>(start.size())),
                        &nlopt_destroy);
    if (!search) throw std::bad_alloc();
    Asked asked{.value = value, .search = search.get(), .left = effort.evaluations};
    nlopt_srand(static_cast<unsigned long>(effort.seed));
    nlopt_set_max_objective(search.get(), ask, &asked);
    nlopt_set_lower_bounds1(search.get(), 0.0);
    nlopt_set_upper_bounds1(search.get(), 1.0);
    nlopt_set_maxeval(search.get(), effort.evaluations);
    nlopt_set_xtol_abs1(search.get(), kLeastStep);
    if (way == SearchWay::Local) nlopt_set_initial_step1(search.get(), effort.first_step);
    std::vector<double> point = start;
    double best = 0.0;
    // The result is one of the points that value() saw, and the reason for ending does not matter.
    (void)nlopt_optimize(search.get(), point.data(), &best);
    if (asked.fault) std::rethrow_exception(asked.fault);
}

}  // namespace aphotic
