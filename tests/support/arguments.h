// SPDX-License-Identifier: BSD-3-Clause
//
// The arguments of a command, as a user types them.
#pragma once

#include <initializer_list>
#include <sstream>
#include <string>
#include <vector>

namespace aphotic {

// "correct raw --map map.exr -o out", parted at blanks; or a list, where one of them has a blank or
// is empty.
class Arguments : public std::vector<std::string> {
  public:
    Arguments() = default;
    Arguments(std::initializer_list<std::string> all) : vector(all) {}
    Arguments(const std::vector<std::string>& all) : vector(all) {}
    Arguments(const std::string& line) {
        std::istringstream words(line);
        for (std::string word; words >> word;) push_back(word);
    }
    Arguments(const char* line) : Arguments(std::string(line)) {}

    Arguments& operator+=(const Arguments& more) {
        insert(end(), more.begin(), more.end());
        return *this;
    }
    friend Arguments operator+(Arguments first, const Arguments& more) { return first += more; }
};

}  // namespace aphotic
