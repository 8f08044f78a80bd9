// SPDX-License-Identifier: BSD-3-Clause
//
// A host whose numbers have a decimal comma and dots between thousands, while this lives: for
// streams, and for the C library where the machine has such a locale or can make one.
#pragma once

#include "support/temp_folder.h"

#include <fmt/format.h>

#include <clocale>
#include <cstdlib>
#include <locale>
#include <string>

namespace aphotic {

class CommaLocale {
  public:
    CommaLocale() : before_(std::locale::global(std::locale(std::locale(), new Commas))) {
        const auto is_set = [] {
            for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"}) {
                if (std::setlocale(LC_ALL, name) != nullptr) return true;
            }
            return false;
        };
        has_c_ = is_set();
        if (has_c_) return;
        const std::string made = (folder_.path() / "de_DE.UTF-8").string();
        const std::string command =
            fmt::format("localedef -i de_DE -f UTF-8 '{}' > /dev/null 2>&1", made);
        if (std::system(command.c_str()) != 0) return;
        ::setenv("LOCPATH", folder_.path().c_str(), 1);
        has_c_ = is_set();
    }
    ~CommaLocale() {
        ::unsetenv("LOCPATH");
        std::setlocale(LC_ALL, "C");
        std::locale::global(before_);
    }
    CommaLocale(const CommaLocale&) = delete;
    CommaLocale& operator=(const CommaLocale&) = delete;

    // Whether the C library's numbers have commas, too.
    [[nodiscard]] bool has_c() const { return has_c_; }

  private:
    struct Commas : std::numpunct<char> {
        [[nodiscard]] char do_decimal_point() const override { return ','; }
        [[nodiscard]] char do_thousands_sep() const override { return '.'; }
        [[nodiscard]] std::string do_grouping() const override { return "\3"; }
    };

    TempFolder folder_;
    std::locale before_;
    bool has_c_ = false;
};

}  // namespace aphotic
