// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_halves.h"

#include <bit>

namespace aphotic {

bool is_in_half(std::size_t image, std::size_t half) {
    const std::size_t group = image % (kHalves + 1);
    return std::popcount(group & half) % 2 == 0;
}

Eigen::VectorXd variances_by_halves(
    const std::function<Eigen::VectorXd(std::size_t half)>& values_of) {
    const Eigen::VectorXd of_all = values_of(0);
    Eigen::VectorXd variances = Eigen::VectorXd::Zero(of_all.size());
    for (std::size_t half = 1; half <= kHalves; ++half)
        variances += (values_of(half) - of_all).cwiseAbs2() / static_cast<double>(kHalves);
    return variances;
}

}  // namespace aphotic
