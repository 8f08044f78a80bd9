// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/povray.h"

#include "base/error.h"
#include "support/refusal.h"
#include "support/run_command.h"
#include "support/temp_folder.h"
#include "support/variable.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace aphotic::povray_test {
namespace {

// As Debian's povray prints it, in part.
constexpr const char* kPrinted =
    "POV-Ray 3.7.0.10.unofficial\n\nBuilt-in features:\n  I/O restrictions:          enabled\n"
    "  Supported image formats:   gif tga iff ppm pgm hdr png jpeg tiff openexr\n"
    "  Unsupported image formats: -\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

TEST(PovRay, VersionIsReadFromWhatItPrints) {
    EXPECT_EQ(povray_from(kPrinted).version, "3.7.0.10.unofficial");
    EXPECT_EQ(povray_from(replaced(kPrinted, "3.7.0.10.unofficial", "3.8.0-beta.2")).version,
              "3.8.0-beta.2");
}

TEST(PovRay, OldVersionIsRefused) {
    const std::string old = replaced(kPrinted, "3.7.0.10", "3.6.1");
    EXPECT_EQ(run_error_of([&] { (void)povray_from(old); }),
              "found version 3.6; allowed: 3.7 or later");
}

TEST(PovRay, BuildWithoutOpenExrIsToldAndRefusedWhereItMatters) {
    EXPECT_TRUE(povray_from(kPrinted).has_openexr);
    require_openexr(povray_from(kPrinted), "");
    // "Unsupported: openexr" must not be taken for support.
    std::string without = replaced(kPrinted, " openexr", "");
    without = replaced(without, "formats: -", "formats: openexr");
    PovRay povray = povray_from(without);
    povray.executable = "/opt/povray";
    EXPECT_EQ(run_error_of([&] { require_openexr(povray, "which frames need"); }),
              "POV-Ray: /opt/povray: it was built without OpenEXR, which frames need");
}

TEST(PovRay, OtherProgramIsRefused) {
    const std::string message = run_error_of([] { (void)find_povray("/bin/true"); });
    EXPECT_NE(message.find("/bin/true"), std::string::npos) << message;
    EXPECT_NE(message.find("does not identify itself"), std::string::npos) << message;
}

// Of what cannot be, however much of it there is, nothing is made.
TEST(PovRay, LiesAboutTheVersionAreRefused) {
    const std::string digits(3'000'000, '1');
    for (const std::string& version : {digits,
                                       "3.7" + digits,
                                       "3." + digits,
                                       std::string("99999999999999.7"),
                                       std::string("3.99999999999999"),
                                       std::string("-3.8"),
                                       std::string("3.-8"),
                                       std::string("3"),
                                       std::string("3."),
                                       std::string("")}) {
        EXPECT_EQ(run_error_of([&] {
                      (void)povray_from(replaced(kPrinted, "3.7.0.10.unofficial", version));
                  }),
                  "it does not identify itself as POV-Ray")
            << version.substr(0, 40);
    }
    EXPECT_FALSE(
        povray_from(replaced(kPrinted, " openexr", std::string(3'000'000, ' '))).has_openexr);
    EXPECT_EQ(run_error_of([&] { (void)povray_from(std::string(3'000'000, 'x') + kPrinted); }),
              "it does not identify itself as POV-Ray");
}

TEST(PovRay, ComplaintsBeforeItsNameArePassedOver) {
    EXPECT_EQ(
        povray_from("povray: POV-Ray cannot open POV-Ray 3.x settings\n" + std::string(kPrinted))
            .version,
        "3.7.0.10.unofficial");
}

TEST(PovRay, TheOneOnPathServes) {
    const PovRay povray = find_povray("");
    EXPECT_TRUE(povray.executable.is_absolute());
    EXPECT_TRUE(povray.version.starts_with("3.")) << povray.version;
}

TEST(PovRay, OptionComesBeforeVariableAndVariableBeforePath) {
    const TempFolder folder;
    const auto script = [&](const std::string& version) {
        return write_script(
                   folder.path() / version,
                   "echo 'POV-Ray " + version + "'\necho '  Supported image formats:   openexr'\n")
            .string();
    };
    const Variable variable("APHOTIC_POVRAY", script("3.71.1"));
    EXPECT_EQ(find_povray("").version, "3.71.1");
    EXPECT_EQ(find_povray(script("3.72.2")).version, "3.72.2");
}

TEST(PovRay, MissingOneSaysWhereItWasLookedFor) {
    EXPECT_NE(run_error_of([] { (void)find_povray("/no/such/povray"); }).find("/no/such/povray"),
              std::string::npos);
    const Variable path("PATH", "/nowhere");
    const Variable variable("APHOTIC_POVRAY", "");
    const std::string message = run_error_of([] { (void)find_povray(""); });
    EXPECT_NE(message.find("PATH"), std::string::npos) << message;
    EXPECT_NE(message.find("install povray"), std::string::npos) << message;
}

}  // namespace
}  // namespace aphotic::povray_test
