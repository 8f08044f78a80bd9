// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic data --from-spline: a scene file's spectra as tables, all of them or none.
#pragma once

#include "cli/command.h"

#include <string>

namespace aphotic::cli {

struct SplineOptions {
    std::string file;
    std::string folder = ".";
    std::string role = "reflectance";
    std::string only = "*";
    bool force = false;
};

ExitStatus write_spline_tables(const SplineOptions& options, bool as_json);

}  // namespace aphotic::cli
