// SPDX-License-Identifier: BSD-3-Clause
//
// The signal of the rig's camera on a relief (light/relief_image.h) with the veil before it
// (light/relief_veil.h), the counterpart of a lightmap on a plane. An emitter with a size has as
// many lamps as at the rig's own altitude.
#pragma once

#include "light/relief.h"
#include "lightmap/lightmap.h"
#include "rig/rig.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace aphotic {

struct ReliefMap {
    Lightmap map;
    // 1 for every pixel within within_px pixels of an edge of a beam, a shadow's border, or a jump
    // of the range.
    std::vector<std::uint8_t> edges;
};

class ReliefMapMaker {
  public:
    ReliefMapMaker(const Rig& rig, const LightmapOptions& options);
    ~ReliefMapMaker();
    ReliefMapMaker(const ReliefMapMaker&) = delete;
    ReliefMapMaker& operator=(const ReliefMapMaker&) = delete;

    [[nodiscard]] ReliefMap map(const Relief& relief, int within_px) const;

    // Rays without a port begin at the pupil.
    [[nodiscard]] bool has_port() const;
    // The ray in water for the middle of the spectrum, along which ranges are measured.
    [[nodiscard]] WaterRay ray(double column, double row) const;

  private:
    struct Tables;
    std::unique_ptr<const Tables> tables_;
};

}  // namespace aphotic
