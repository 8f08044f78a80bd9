// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/povray_log.h"

#include <gtest/gtest.h>

namespace aphotic {
namespace {

// As POV-Ray 3.7 prints it, wrapped.
constexpr const char* kLog =
    "==== [Parsing...] ==========================================================\n"
    "File 'band_550nm.pov' line 7: Parse Error: Expected 'numeric expression', undeclared\n"
    " identifier 'nan' found instead\n"
    "Fatal error in parser: Cannot parse input.\n"
    "Render failed\n";

TEST(PovRayLog, ErrorIsUnwrapped) {
    EXPECT_EQ(
        error_in_log(kLog),
        "File 'band_550nm.pov' line 7: Parse Error: Expected 'numeric expression', undeclared "
        "identifier 'nan' found instead\nFatal error in parser: Cannot parse input.");
    EXPECT_EQ(error_in_log("POV-Ray finished\n"), "");
}

TEST(PovRayLog, StatementsAreWithoutWhatProgressOverwrote) {
    EXPECT_EQ(statements_in_log("Rendered 1 of 2\rRendered 2 of 2\nDone\n"),
              (std::vector<std::string>{"Rendered 2 of 2", "Done"}));
}

}  // namespace
}  // namespace aphotic
