// SPDX-License-Identifier: BSD-3-Clause
#include "base/sha256.h"

#include "base/error.h"
#include "support/refusal.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

namespace aphotic::sha256_test {
namespace {

// NIST, "Cryptographic Standards and Guidelines: Example Values", SHA-256; the empty message and
// the million letters are of FIPS 180-2, appendix B, and its test vectors.
TEST(Sha256, HasThePublishedValues) {
    EXPECT_EQ(sha256_of_text(""),
              "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256_of_text("abc"),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256_of_text("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(sha256_of_text(std::string(1'000'000, 'a')),
              "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

// More than one block of any reader, and a last block that is not full.
TEST(Sha256, OfAFileIsThatOfItsBytes) {
    const TempFolder folder;
    const auto file = folder.path() / "a";
    write_file(file, std::string(1'000'000, 'a'));
    EXPECT_EQ(sha256_of_file(file),
              "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
    write_file(file, "");
    EXPECT_EQ(sha256_of_file(file),
              "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    const std::string bytes("\0\r\n\xFF", 4);
    write_file(file, bytes);
    EXPECT_EQ(sha256_of_file(file), sha256_of_text(bytes));
}

TEST(Sha256, OfAnUnreadableFileIsARunErrorThatNamesIt) {
    const TempFolder folder;
    const auto missing = folder.path() / "missing";
    EXPECT_EQ(run_error_of([&] { static_cast<void>(sha256_of_file(missing)); }),
              missing.string() + ": cannot be read");
    EXPECT_THROW(static_cast<void>(sha256_of_file(folder.path())), RunError);
}

}  // namespace
}  // namespace aphotic::sha256_test
