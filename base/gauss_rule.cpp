// SPDX-License-Identifier: BSD-3-Clause
#include "base/gauss_rule.h"

#include <boost/math/special_functions/legendre.hpp>

#include <algorithm>
#include <map>
#include <mutex>

namespace aphotic {
namespace {

std::vector<GaussNode> gauss_legendre(unsigned points) {
    std::vector<GaussNode> nodes;
    if (points == 0) return nodes;
    const int order = static_cast<int>(points);
    for (const double zero : boost::math::legendre_p_zeros<double>(order)) {
        const double slope = boost::math::legendre_p_prime(order, zero);
        const double weight = 1.0 / ((1.0 - zero * zero) * slope * slope);
        nodes.push_back({.at = 0.5 * (1.0 + zero), .weight = weight});
        // Boost lists only the zeros that are not negative; the rule is symmetric.
        if (zero != 0.0) nodes.push_back({.at = 0.5 * (1.0 - zero), .weight = weight});
    }
    std::ranges::sort(nodes, {}, &GaussNode::at);
    return nodes;
}

}  // namespace

const std::vector<GaussNode>& gauss_rule(unsigned points) {
    static std::mutex mutex;
    static std::map<unsigned, std::vector<GaussNode>> rules;
    const std::scoped_lock lock(mutex);
    const auto [rule, is_new] = rules.try_emplace(points);
    if (is_new) rule->second = gauss_legendre(points);
    return rule->second;
}

}  // namespace aphotic
