// SPDX-License-Identifier: BSD-3-Clause
//
// A design in a folder: designed.toml, the rig with its strobes moved and all else as its author
// wrote it, with the files that it names; design.json with every number; and report.html, a page of
// the gain, the light on the floor before and after, the trade-off of evenness against signal, the
// new places of the strobes, and the figures of every pose.
#pragma once

#include "lightmap/design.h"
#include "rig/rig.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

namespace aphotic {

inline constexpr const char* kDesignedRig = "designed.toml";
inline constexpr const char* kDesignNumbers = "design.json";
inline constexpr const char* kDesignPage = "report.html";

// For a rig that was read; the same request gives the same bytes.
[[nodiscard]] nlohmann::ordered_json design_json(const Rig& rig,
                                                 const DesignRequest& request,
                                                 const DesignResult& result);

[[nodiscard]] std::string design_html(const Rig& rig,
                                      const DesignRequest& request,
                                      const DesignResult& result);

// The folder exists. Files are complete or absent; the rig comes last.
void write_design(const RigText& text,
                  const DesignRequest& request,
                  const DesignResult& result,
                  const std::filesystem::path& folder);

}  // namespace aphotic
