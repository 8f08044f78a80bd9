// SPDX-License-Identifier: BSD-3-Clause
//
// A variable of the environment, which the tests of a suite share.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace aphotic {

// Sets a variable for the length of a test.
class Variable {
  public:
    Variable(const char* name, const std::string& value) : name_(name) {
        const char* before = std::getenv(name);
        if (before != nullptr) before_ = before;
        ::setenv(name, value.c_str(), 1);
    }
    ~Variable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

  private:
    const char* name_;
    std::optional<std::string> before_;
};

}  // namespace aphotic
