// SPDX-License-Identifier: BSD-3-Clause
#include "light/index_nodes.h"

#include <cmath>
#include <numeric>

namespace aphotic {
namespace {

// The wavelength at which water has this index; the index falls with the wavelength.
double wavelength_of_index(const Rig& rig, double index) {
    WavelengthRange between = rig.camera.range;
    constexpr int kHalvings = 60;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle_nm = std::midpoint(between.first_nm, between.last_nm);
        (rig.water.refractive_index(middle_nm) > index ? between.first_nm : between.last_nm) =
            middle_nm;
    }
    return between.first_nm;
}

}  // namespace

std::vector<double> index_nodes_nm(const Rig& rig, std::size_t nodes) {
    if (!rig.camera.port) return {rig.camera.range.first_nm};
    const double first = rig.water.refractive_index(rig.camera.range.first_nm);
    const double last = rig.water.refractive_index(rig.camera.range.last_nm);
    std::vector<double> nodes_nm;
    for (std::size_t j = 0; j < nodes; ++j) {
        const double share = static_cast<double>(j) / static_cast<double>(nodes - 1);
        nodes_nm.push_back(wavelength_of_index(rig, std::lerp(first, last, share)));
    }
    return nodes_nm;
}

double index_share(const Rig& rig,
                   const std::vector<double>& nodes_nm,
                   std::size_t node,
                   double lambda_nm) {
    double value = 1.0;
    for (std::size_t m = 0; m < nodes_nm.size(); ++m) {
        if (m == node) continue;
        const double n_m = rig.water.refractive_index(nodes_nm[m]);
        value *= (rig.water.refractive_index(lambda_nm) - n_m) /
                 (rig.water.refractive_index(nodes_nm[node]) - n_m);
    }
    return value;
}

}  // namespace aphotic
