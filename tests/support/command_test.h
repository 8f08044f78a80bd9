// SPDX-License-Identifier: BSD-3-Clause
//
// Tests of the command in a folder of their own.
#pragma once

#include "base/atomic_file.h"
#include "support/run_command.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

namespace aphotic {

class CommandTest : public testing::Test {
  protected:
    [[nodiscard]] std::filesystem::path path(const std::string& name) const {
        return folder_.path() / name;
    }
    [[nodiscard]] std::string text_of(const std::string& name) const {
        return read_text_file(path(name));
    }
    // Run in the folder.
    [[nodiscard]] CommandResult aphotic(
        const Arguments& arguments,
        const std::map<std::string, std::string>& environment = {}) const {
        return run_aphotic(folder_.path(), arguments, environment);
    }

    TempFolder folder_;
};

}  // namespace aphotic
