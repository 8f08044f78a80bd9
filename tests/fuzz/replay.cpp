// SPDX-License-Identifier: BSD-3-Clause
//
// NAME_replay FILE|FOLDER...: calls the target with the bytes of every file, once. A fault ends the
// program, with the file's name as the last that was said.
#include "base/atomic_file.h"
#include "fuzz.h"

#include <filesystem>
#include <vector>

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(const fs::path& place) {
    if (!fs::is_directory(place)) return {place};
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(place)) {
        if (entry.is_regular_file()) files.push_back(entry.path());
    }
    return files;
}

}  // namespace

int main(int argc, char** argv) {
    int count = 0;
    for (int i = 1; i < argc; ++i) {
        for (const fs::path& file : files_of(argv[i])) {
            std::fprintf(stderr, "%s\n", file.c_str());
            const std::string text = aphotic::read_text_file(file);
            LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
            ++count;
        }
    }
    std::printf("%d files\n", count);
    return count > 0 ? 0 : 1;
}
