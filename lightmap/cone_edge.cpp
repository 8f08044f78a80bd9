// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/cone_edge.h"

#include "image/image_size.h"
#include "rig/geometry.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace aphotic {

namespace {

// An emitter's rim at its corners and half way between them, and its middle; a point's own
// position.
std::vector<LampTerms> places_of(const Strobe& strobe) {
    LampTerms place{.position_m = strobe.position_m,
                    .frame = turned_frame(strobe.beam, strobe.axis),
                    .light = nullptr};
    if (!strobe.emitter) return {place};
    // The centres of a grid of three by three cells lie two thirds of the way to the rim.
    constexpr double kToTheRim = 1.5;
    std::vector<LampTerms> places;
    for (const Eigen::Vector3d& centre : lamp_positions_m(strobe, {.across = 3, .along = 3})) {
        place.position_m = strobe.position_m + kToTheRim * (centre - strobe.position_m);
        places.push_back(place);
    }
    return places;
}

// Bytes of two rows that differ, in bits of their own.
void note_differences(const std::uint8_t* a,
                      const std::uint8_t* b,
                      std::size_t count,
                      std::uint8_t* noted) {
    for (std::size_t i = 0; i < count; ++i)
        noted[i] = static_cast<std::uint8_t>(noted[i] | (a[i] ^ b[i]));
}

// Counts that are neither none nor all.
void note_parts(const std::uint8_t* counts,
                std::uint8_t most,
                std::size_t count,
                std::uint8_t* noted) {
    for (std::size_t i = 0; i < count; ++i) {
        const bool is_part = (counts[i] > 0) & (counts[i] < most);
        noted[i] = static_cast<std::uint8_t>(noted[i] | (is_part ? 1 : 0));
    }
}

void take_in(const std::uint8_t* bits, std::size_t count, std::uint8_t* mask) {
    for (std::size_t i = 0; i < count; ++i) mask[i] = static_cast<std::uint8_t>(mask[i] | bits[i]);
}

}  // namespace

ConeEdges::ConeEdges(const Rig& rig) : rig_(rig), ends_nm_{rig.camera.range.first_nm} {
    if (rig.camera.port) ends_nm_.push_back(rig.camera.range.last_nm);
    for (const double nm : ends_nm_) ray_tables_.push_back(ray_table(rig, nm, 1));
    most_.push_back(static_cast<std::uint8_t>(ends_nm_.size()));
    for (const Strobe& strobe : rig.strobes) {
        const Lamp lamp{.places = places_of(strobe), .edges = beam_edges(strobe)};
        if (lamp.edges.count() == 0) continue;
        most_.insert(most_.end(),
                     lamp.edges.count(),
                     static_cast<std::uint8_t>(ends_nm_.size() * lamp.places.size()));
        lamps_.push_back(lamp);
    }
}

void ConeEdges::count_row(int row, const std::vector<RayTerms>& ends, Counts& counts) const {
    RayBlock rays;
    DirectionBlock V;
    for (auto& thing : counts) std::ranges::fill(thing, 0);
    for (int column = 0; column < rig_.camera.width_px; column += kRowBlock) {
        const std::size_t first = size_of(column);
        for (const RayTerms& end : ends) {
            look_along(end, {}, row, neighbours(end, column), rays);
            count_seen(rays, &counts[0][first]);
            std::size_t thing = 1;
            for (const Lamp& lamp : lamps_) {
                for (const LampTerms& place : lamp.places) {
                    (lamp.edges.has_rim ? aim_turned : aim_round)(rays, place, V);
                    for (std::size_t k = 0; k < lamp.edges.count(); ++k) {
                        count_within(lamp.edges, k, rays, V, &counts[thing + k][first]);
                    }
                }
                thing += lamp.edges.count();
            }
        }
    }
}

std::vector<std::uint8_t> ConeEdges::mask(const Sled& sled, int within_px) const {
    const std::size_t width = size_of(rig_.camera.width_px);
    std::vector<std::uint8_t> mask(width * size_of(rig_.camera.height_px));
    if (within_px == 0) return mask;
    const Plane floor = floor_plane(sled);
    std::vector<RayTerms> ends;
    for (std::size_t e = 0; e < ends_nm_.size(); ++e) {
        ends.push_back(ray_terms(rig_, floor, ends_nm_[e], ray_tables_[e]));
    }
    const std::size_t blocks = (width + kRowBlock - 1) / kRowBlock;
    Counts counts(most_.size(), std::vector<std::uint8_t>(blocks * kRowBlock));
    Counts above(counts);
    std::vector<std::uint8_t> beside(width);
    std::vector<std::uint8_t> below(width);
    for (int row = 0; row < rig_.camera.height_px; ++row) {
        count_row(row, ends, counts);
        std::uint8_t* const marks = &mask[size_of(row) * width];
        std::ranges::fill(beside, 0);
        std::ranges::fill(below, 0);
        for (std::size_t k = 0; k < counts.size(); ++k) {
            const std::uint8_t* const now = counts[k].data();
            if (most_[k] > 1) note_parts(now, most_[k], width, marks);
            note_differences(now, now + 1, width - 1, beside.data());
            if (row > 0) note_differences(now, above[k].data(), width, below.data());
        }
        take_in(beside.data(), width - 1, marks);
        take_in(beside.data(), width - 1, marks + 1);
        take_in(below.data(), width, marks);
        if (row > 0) take_in(below.data(), width, marks - width);
        std::swap(counts, above);
    }
    for (std::uint8_t& mark : mask) mark = mark != 0 ? 1 : 0;
    spread(mask, rig_.camera.width_px, within_px - 1);
    return mask;
}

void spread(std::vector<std::uint8_t>& mask, int width_px, int within_px) {
    const std::size_t width = size_of(width_px);
    std::vector<std::uint8_t> before(within_px > 0 ? mask.size() : 0);
    for (int step = 0; step < within_px; ++step) {
        before = mask;
        take_in(before.data(), mask.size() - width, mask.data() + width);
        take_in(before.data() + width, mask.size() - width, mask.data());
        before = mask;
        // By pointers: in rows of one pixel, the last has nothing to its right.
        for (std::size_t start = 0; start < mask.size(); start += width) {
            const std::uint8_t* const from = before.data() + start;
            std::uint8_t* const to = mask.data() + start;
            take_in(from, width - 1, to + 1);
            take_in(from + 1, width - 1, to);
        }
    }
}

}  // namespace aphotic
