// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_file.h"

#include "base/error.h"
#include "base/number.h"
#include "base/sha256.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/magic.h>
#include <signal.h>  // kill
#include <sys/statfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
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

// The part of the file's name that is used in a temporary's name: all of it, if within the longest
// name that file systems allow.
std::string kept_name_of(const fs::path& file) {
    constexpr std::size_t kLongestName = 255;
    constexpr std::size_t kOurs = 48;  // dots, boot, numbers, process and "part"
    constexpr std::size_t kDigest = 16;
    std::string stem = file.stem().string();
    const std::size_t taken = kOurs + file.extension().string().size();
    if (stem.size() + taken <= kLongestName || taken + kDigest > kLongestName) return stem;
    return stem.substr(0, kLongestName - taken - kDigest) + sha256_of_text(stem).substr(0, kDigest);
}

bool is_gone(pid_t process) {
    return ::kill(process, 0) != 0 && errno == ESRCH;
}

// The scope in which process numbers are valid: the first digits of the kernel's boot_id, and the
// inode of the process namespace. Empty if /proc does not provide them.
struct ProcessSpace {
    std::string boot{};
    std::string numbers{};
};

ProcessSpace our_space() {
    constexpr std::size_t kDigits = 8;
    ProcessSpace space;
    std::ifstream("/proc/sys/kernel/random/boot_id") >> space.boot;
    space.boot.resize(std::min(space.boot.size(), kDigits));
    std::error_code error;
    const std::string link = fs::read_symlink("/proc/self/ns/pid", error).string();  // pid:[123]
    const std::size_t digits = std::min(link.find_first_of("0123456789"), link.size());
    const auto inode =
        read_number<std::uint64_t>(std::string_view(link).substr(digits, link.find(']') - digits));
    if (inode) space.numbers = fmt::format("{:x}", *inode);
    return space;
}

// A file system whose files belong to one kernel at a time: on a disk, or in memory.
bool is_of_this_machine(const fs::path& folder) {
    constexpr unsigned kXfs = 0x58465342;
    constexpr unsigned kZfs = 0x2FC12FC1;
    constexpr std::array<unsigned, 8> kLocal{EXT4_SUPER_MAGIC,
                                             BTRFS_SUPER_MAGIC,
                                             kXfs,
                                             kZfs,
                                             F2FS_SUPER_MAGIC,
                                             TMPFS_MAGIC,
                                             OVERLAYFS_SUPER_MAGIC,
                                             RAMFS_MAGIC};
    struct statfs system {};
    return ::statfs(folder.c_str(), &system) == 0 &&
           std::ranges::find(kLocal, static_cast<unsigned>(system.f_type)) != kLocal.end();
}

// Temporaries of files whose name is allowed.
template <typename IsAllowed>
void remove_abandoned(const fs::path& folder, IsAllowed is_allowed) {
    static const std::regex kTemporary(
        R"(\.(.*)\.([0-9a-f]{8})-([0-9a-f]{1,16})-(\d{1,9})\.part(\..*)?)");
    static const ProcessSpace kOurs = our_space();
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
        const std::string name = entry.path().filename().string();
        std::smatch found;
        if (!std::regex_match(name, found, kTemporary)) continue;
        if (!is_allowed(found.str(1) + found.str(5))) continue;
        const bool is_abandoned =
            found.str(2) == kOurs.boot
                ? found.str(3) == kOurs.numbers && is_gone(*read_number<pid_t>(found.str(4)))
                : !kOurs.boot.empty() && is_of_this_machine(folder);
        if (is_abandoned) fs::remove(entry.path(), ignored);
    }
}

// Flushes a file with its contents, or a folder with its names, to the disk. Some network file
// systems cannot and return EINVAL or ENOTSUP, and a folder that may not be listed (EACCES) cannot
// be opened: the system then writes them.
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
    static const ProcessSpace kOurs = our_space();
    // The extension stays last: some writers choose their format by it.
    temporary_ = final_path_;
    temporary_.replace_filename(fmt::format(".{}.{}-{}-{}.part{}",
                                            kept_name_of(final_path_),
                                            kOurs.boot,
                                            kOurs.numbers,
                                            ::getpid(),
                                            final_path_.extension().string()));
    removed_by_signal_.emplace(temporary_);
}

AtomicFile::~AtomicFile() {
    std::error_code ignored;
    if (removed_by_signal_) fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
    const auto fail = [&](int error) {
        throw RunError("{}: cannot be written: {}", final_path_.string(), std::strerror(error));
    };
    // In this order, since otherwise a power cut may leave a file's name without its bytes.
    if (!is_synced(temporary_)) fail(errno);
    std::error_code error;
    fs::rename(temporary_, final_path_, error);
    if (error) fail(error.value());
    removed_by_signal_.reset();
    if (!is_synced(folder_of(final_path_))) fail(errno);
}

void remove_abandoned_files(const fs::path& folder) {
    remove_abandoned(folder, [](const std::string&) { return true; });
}

void remove_abandoned_of(const fs::path& file) {
    remove_abandoned(folder_of(file),
                     [name = kept_name_of(file) + file.extension().string()](
                         const std::string& kept) { return kept == name; });
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
    // Also counted while reading, since a pipe or a device does not report its size.
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
