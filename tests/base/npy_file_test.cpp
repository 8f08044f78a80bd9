// SPDX-License-Identifier: BSD-3-Clause
#include "base/npy_file.h"

#include "base/atomic_file.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <numeric>
#include <string>

namespace aphotic::npy_file_test {
namespace {

constexpr const char* kPython = "/usr/bin/python3";

// By numpy.lib.format: the magic, version 1.0, a header that ends in a newline at a multiple of 64.
TEST(NpyFile, HasTheHeaderOfItsFormat) {
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "a.npy";
    write_npy(file, {2, 3}, std::vector<float>{0.0F, 1.0F, 2.0F, 3.0F, 4.0F, -0.5F});
    const std::string bytes = read_text_file(file);
    ASSERT_EQ(bytes.size(), 128U + 6U * 4U);
    EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
    EXPECT_EQ(bytes[8], 118) << "128 less 10";
    EXPECT_EQ(bytes[9], 0);
    EXPECT_EQ(bytes.substr(10, 60), "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3,), }");
    EXPECT_EQ(bytes[127], '\n');
    EXPECT_EQ(bytes.substr(148, 4), std::string("\x00\x00\x00\xbf", 4)) << "-0.5";
}

TEST(NpyFile, IsWhatNumpyReads) {
    const TempFolder folder;
    if (std::system((std::string(kPython) + " -c 'import numpy' 2>/dev/null").c_str()) != 0)
        GTEST_SKIP() << "no " << kPython << " with numpy";
    for (const std::vector<std::size_t>& shape :
         {std::vector<std::size_t>{24}, {3, 8}, {3, 2, 4}, {3, 2, 2, 2}}) {
        std::vector<float> samples(24);
        std::iota(samples.begin(), samples.end(), 0.25F);
        write_npy(folder.path() / "a.npy", shape, samples);
        std::string wanted;
        for (const std::size_t size : shape) wanted += std::to_string(size) + ",";
        std::ofstream(folder.path() / "read.py")
            << "import numpy as np, sys\n"
            << "a = np.load(sys.argv[1])\n"
            << "b = (np.arange(24) + 0.25).reshape((" << wanted << "))\n"
            << "assert a.dtype == np.float32 and a.shape == b.shape and (a == b).all(), a\n";
        const std::string command = std::string(kPython) + " '" +
                                    (folder.path() / "read.py").string() + "' '" +
                                    (folder.path() / "a.npy").string() + "'";
        EXPECT_EQ(std::system(command.c_str()), 0) << wanted;
    }
}

}  // namespace
}  // namespace aphotic::npy_file_test
