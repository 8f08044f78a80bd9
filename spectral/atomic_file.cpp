// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/atomic_file.h"

#include "spectral/error.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <vector>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

// Of the temporary names below, whose writer is gone.
bool is_abandoned(const std::string& name) {
    const std::size_t part = name.rfind(".part");
    if (!name.starts_with('.') || part == std::string::npos || part == 0) return false;
    const std::size_t dot = name.rfind('.', part - 1);
    pid_t pid = 0;
    const char* const end = name.data() + part;
    const auto [stop, error] = std::from_chars(name.data() + dot + 1, end, pid);
    if (error != std::errc() || stop != end || pid <= 0) return false;
    return ::kill(pid, 0) != 0 && errno == ESRCH;
}

}  // namespace

AtomicFile::AtomicFile(fs::path final_path) : final_path_(std::move(final_path)) {
    // The extension stays last: some writers choose their format by it.
    temporary_ = final_path_;
    temporary_.replace_filename(fmt::format(".{}.{}.part{}",
                                            final_path_.stem().string(),
                                            ::getpid(),
                                            final_path_.extension().string()));
}

AtomicFile::~AtomicFile() {
    std::error_code ignored;
    if (!committed_) fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
    std::error_code error;
    fs::rename(temporary_, final_path_, error);
    if (error) {
        throw RunError(
            fmt::format("{}: cannot be written: {}", final_path_.string(), error.message()));
    }
    committed_ = true;
}

void remove_abandoned(const fs::path& folder) {
    std::vector<fs::path> abandoned;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (is_abandoned(entry.path().filename().string())) abandoned.push_back(entry.path());
    }
    for (const fs::path& file : abandoned) fs::remove(file);
}

void write_text_file(const fs::path& path, std::string_view text) {
    AtomicFile file(path);
    std::ofstream out(file.temporary(), std::ios::binary);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (!out) {
        throw RunError(
            fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
    }
    file.commit();
}

std::string read_text_file(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in || fs::is_directory(path)) {
        throw InputError(fmt::format(
            "{}: cannot be read: {}", path.string(), in ? "it is a folder" : std::strerror(errno)));
    }
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
        throw RunError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
    }
    if (::access(folder.c_str(), W_OK | X_OK) != 0) {
        throw RunError(
            fmt::format("{}: cannot be written to: {}", folder.string(), std::strerror(errno)));
    }
}

}  // namespace aphotic
