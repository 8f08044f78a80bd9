// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_file.h"

#include "base/error.h"
#include "base/interruption.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>  // kill
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <regex>
#include <system_error>
#include <vector>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : ".";
}

bool is_gone(pid_t process) {
    return ::kill(process, 0) != 0 && errno == ESRCH;
}

// Temporaries whose name, less that of their process, is allowed.
template <typename IsAllowed>
void remove_abandoned(const fs::path& folder, IsAllowed is_allowed) {
    static const std::regex kTemporary(R"(\.(.*)\.(\d{1,9})\.part(\..*)?)");
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
        const std::string name = entry.path().filename().string();
        std::smatch found;
        if (!std::regex_match(name, found, kTemporary)) continue;
        if (!is_allowed(found.str(1) + found.str(3)) || !is_gone(std::stoi(found[2]))) continue;
        fs::remove(entry.path(), ignored);
    }
}

// Onto the disk, with all that it holds: a file, or a folder with its names. Some network file
// systems cannot, and say so by EINVAL or ENOTSUP, and a folder that may not be listed (EACCES)
// cannot be opened: there it is the system's to keep.
bool is_synced(const fs::path& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return errno == EACCES;
    const bool is_done = ::fsync(descriptor) == 0 || errno == EINVAL || errno == ENOTSUP;
    const int error = errno;
    ::close(descriptor);
    errno = error;
    return is_done;
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
    const auto fail = [&](int error) {
        throw RunError("{}: cannot be written: {}", final_path_.string(), std::strerror(error));
    };
    // In this order, or a power cut may leave the name of a file whose bytes are not there yet.
    if (!is_synced(temporary_)) fail(errno);
    std::error_code error;
    fs::rename(temporary_, final_path_, error);
    if (error) fail(error.value());
    committed_ = true;
    if (!is_synced(folder_of(final_path_))) fail(errno);
}

void remove_abandoned_files(const fs::path& folder) {
    remove_abandoned(folder, [](const std::string&) { return true; });
}

void remove_abandoned_of(const fs::path& file) {
    remove_abandoned(folder_of(file),
                     [&](const std::string& name) { return name == file.filename(); });
}

void write_text_file(const fs::path& path, std::string_view text) {
    const InterruptionHold hold;
    AtomicFile file(path);
    std::ofstream out(file.temporary(), std::ios::binary);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (!out) {
        throw RunError("{}: cannot be written: {}", path.string(), std::strerror(errno));
    }
    file.commit();
}

std::string read_text_file(const fs::path& path, std::size_t most_bytes) {
    std::ifstream in(path, std::ios::binary);
    if (!in || fs::is_directory(path)) {
        throw InputError(
            "{}: cannot be read: {}", path.string(), in ? "it is a folder" : std::strerror(errno));
    }
    const auto require_room = [&](std::uintmax_t bytes) {
        if (bytes <= most_bytes) return;
        throw InputError("{0}: found more than {1} MiB; allowed: {1} MiB or less",
                         path.string(),
                         most_bytes / kMebibyte);
    };
    if (fs::is_regular_file(path)) require_room(fs::file_size(path));
    // Counted while reading too: a pipe or a device does not say its size.
    std::string text;
    std::vector<char> chunk(1U << 16U);
    while (in.read(chunk.data(), std::ssize(chunk)), in.gcount() > 0) {
        text.append(chunk.data(), static_cast<std::size_t>(in.gcount()));
        require_room(text.size());
    }
    if (in.bad()) throw InputError("{}: cannot be read", path.string());
    return text;
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
        throw RunError("{}: cannot be created: {}", folder.string(), error.message());
    }
    if (::access(folder.c_str(), W_OK | X_OK) != 0) {
        throw RunError("{}: cannot be written to: {}", folder.string(), std::strerror(errno));
    }
}

}  // namespace aphotic
