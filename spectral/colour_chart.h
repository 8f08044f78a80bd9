// SPDX-License-Identifier: BSD-3-Clause
//
// The names of the usual colour chart's 24 patches, and their colours under D65 for the 2-degree
// observer: the reflectances of scenes/user/chart/patches with cie-1931 and cie-d65, summed over
// every 5 nm from 380 to 780 nm.
#pragma once

#include "spectral/colour_difference.h"

#include <array>
#include <string_view>

namespace aphotic {

struct ChartPatch {
    std::string_view name;
    Lab lab;
};

inline constexpr std::array<ChartPatch, 24> kChartPatches{{
    {.name = "dark-skin", .lab = {37.304, 13.692, 15.564}},
    {.name = "light-skin", .lab = {66.200, 14.467, 17.740}},
    {.name = "blue-sky", .lab = {50.781, -1.473, -21.266}},
    {.name = "foliage", .lab = {42.740, -16.298, 22.344}},
    {.name = "blue-flower", .lab = {56.468, 11.518, -24.399}},
    {.name = "bluish-green", .lab = {71.371, -31.393, 1.982}},
    {.name = "orange", .lab = {61.069, 31.126, 57.163}},
    {.name = "purplish-blue", .lab = {40.828, 15.397, -41.888}},
    {.name = "moderate-red", .lab = {50.952, 45.921, 15.086}},
    {.name = "purple", .lab = {30.696, 23.901, -22.073}},
    {.name = "yellow-green", .lab = {72.000, -27.183, 58.033}},
    {.name = "orange-yellow", .lab = {71.642, 15.324, 65.884}},
    {.name = "blue", .lab = {29.986, 24.609, -50.865}},
    {.name = "green", .lab = {55.655, -41.682, 34.775}},
    {.name = "red", .lab = {40.938, 52.848, 25.608}},
    {.name = "yellow", .lab = {81.641, -1.576, 79.474}},
    {.name = "magenta", .lab = {51.000, 49.425, -15.039}},
    {.name = "cyan", .lab = {51.686, -24.727, -25.982}},
    {.name = "white", .lab = {95.465, -0.357, 0.778}},
    {.name = "neutral-8", .lab = {80.953, 0.142, 0.133}},
    {.name = "neutral-6-5", .lab = {66.380, 0.047, -0.071}},
    {.name = "neutral-5", .lab = {52.181, 0.058, -0.086}},
    {.name = "neutral-3-5", .lab = {36.478, -0.190, -0.475}},
    {.name = "black", .lab = {21.413, -0.034, -0.947}},
}};

// The last six are white to black.
inline constexpr std::size_t kFirstGreyPatch = 18;

}  // namespace aphotic
