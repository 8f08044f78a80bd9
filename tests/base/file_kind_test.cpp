// SPDX-License-Identifier: BSD-3-Clause
//
// Files by their first bytes, which the formats' documents tell.
#include "base/file_kind.h"

#include <gtest/gtest.h>

namespace aphotic {
namespace {

using namespace std::string_view_literals;

TEST(FileKind, IsToldByTheFirstBytes) {
    EXPECT_EQ(binary_kind("\x89PNG\r\n\x1A\n rest"sv), "a PNG image");
    EXPECT_EQ(binary_kind("PK\x03\x04\x14\0"sv), "a zip archive, such as .xlsx, .ods or .npz");
    EXPECT_EQ(binary_kind("\xFF\xFEi\0m\0"sv), "text in UTF-16");
    EXPECT_EQ(binary_kind("MATLAB 5.0 MAT-file, Platform: GLNXA64"sv), "a MATLAB file (.mat)");
    EXPECT_EQ(binary_kind("\x80\x04\x95\x10"sv), "a pickle of Python");
}

TEST(FileKind, OfTextIsNone) {
    for (const std::string_view text : {""sv,
                                        "image,altitude_m\n"sv,
                                        "PK1.tif 2 0 0\n"sv,
                                        "\xEF\xBB\xBFimage;altitude_m\n"sv,
                                        "MM.tif,2\n"sv,
                                        "% STEREO_POSE_FILE\n"sv})
        EXPECT_EQ(binary_kind(text), "") << text;
}

}  // namespace
}  // namespace aphotic
