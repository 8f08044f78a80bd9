// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/povray_log.h"

#include "base/error.h"
#include "plugin/process.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace aphotic::povray_log_test {
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

TEST(PovRayLog, IsReadUpToTheSizeAtWhichPovRayIsStopped) {
    const TempFolder folder;
    write_file(folder.path() / "short.log", "POV-Ray finished\n");
    EXPECT_EQ(read_log(folder.path() / "short.log"), "POV-Ray finished\n");
    write_file(folder.path() / "long.log", "x");
    std::filesystem::resize_file(folder.path() / "long.log", 3 * kMostLogBytes);  // takes no room
    EXPECT_EQ(read_log(folder.path() / "long.log").size(), kMostLogBytes);
    EXPECT_THROW(static_cast<void>(read_log(folder.path() / "none.log")), RunError);
}

TEST(PovRayLog, TellsTheLastShareThatCanBe) {
    EXPECT_EQ(share_in_log(""), 0.0);
    EXPECT_EQ(share_in_log("Rendered 1 of 4 pixels (25%)\rRendered 3 of 4 pixels (75%)\r"), 0.75);
    EXPECT_EQ(share_in_log("Rendered 1 of 4 pixels (25%)\rRendered 3 of 4 pixels (7"), 0.25);
    for (const char* lie : {"99999999999", "101", "-1", "", "x", "1e1", " 50"}) {
        EXPECT_EQ(share_in_log(fmt::format("pixels (25%)\rpixels ({}%)\r", lie)), 0.25) << lie;
    }
}

TEST(PovRayLog, QuotesNoMoreThanOneReads) {
    constexpr std::size_t kPage = 2500;
    std::string log;
    for (int i = 0; i < 1000; ++i) log += "File 'x.pov' line 7: Parse Error: No such thing.\n";
    const std::string said = error_in_log(log);
    EXPECT_LT(said.size(), kPage);
    EXPECT_TRUE(said.starts_with("File 'x.pov' line 7: Parse Error: No such thing.\n"));
    EXPECT_TRUE(said.ends_with(" ..."));
    EXPECT_LT(error_in_log(std::string(100000, 'x') + "rror").size(), kPage);
}

}  // namespace
}  // namespace aphotic::povray_log_test
