// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/frame_runner.h"

#include "base/atomic_file.h"
#include "base/disk_space.h"
#include "base/error.h"
#include "base/interruption.h"
#include "image/frame_check.h"
#include "plugin/library_paths.h"
#include "plugin/povray_log.h"
#include "plugin/process.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <list>
#include <memory>
#include <optional>
#include <system_error>
#include <thread>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr auto kReportInterval = std::chrono::milliseconds(250);

// The image during rendering. POV-Ray keeps its state next to it, and leaves it behind when
// stopped.
class PartImage {
  public:
    explicit PartImage(const fs::path& image) : file_(image) {}
    ~PartImage() {
        std::error_code ignored;
        fs::remove(fs::path(path()).replace_extension(".pov-state"), ignored);
    }
    PartImage(const PartImage&) = delete;
    PartImage& operator=(const PartImage&) = delete;

    [[nodiscard]] const fs::path& path() const { return file_.temporary(); }
    void commit() { file_.commit(); }

  private:
    AtomicFile file_;
};

struct Running {
    ManifestFrame frame;
    fs::path log;
    std::unique_ptr<PartImage> part;
    Process process;  // last: the process is stopped before its image is removed
};

// A user's scene is parsed in its own folder, with the includes found there.
ProcessRequest in_scene_folder(ProcessRequest request,
                               const PovRay& povray,
                               const ManifestFrame& frame,
                               const fs::path& part,
                               const RunOptions& options) {
    const fs::path work = request.folder;
    request.arguments[0] = path_option("+I", work / (frame.name + ".pov"));
    request.arguments[1] = path_option("+O", work / "frames" / part.filename());
    request.arguments.push_back(path_option("+L", work));
    for (const std::string& path : options.library_paths) {
        request.arguments.push_back(path_option("+L", fs::absolute(path)));
    }
    const fs::path folder = options.scene.path.parent_path();
    for (const std::string& path : library_paths(folder, povray.version)) {
        request.arguments.push_back(path_option("+L", path));
    }
    request.environment.erase("POVINC");
    request.folder = folder;
    return request;
}

Running start(const PovRay& povray,
              const fs::path& folder,
              const ManifestFrame& frame,
              int threads,
              const RunOptions& options) {
    const fs::path work = fs::absolute(folder / "povray");
    const fs::path log = fs::absolute(log_path(folder, frame));
    auto part = std::make_unique<PartImage>(image_path(folder, frame));
    ProcessRequest request{
        .executable = povray.executable,
        .arguments = {fmt::format("+I{}.pov", frame.name),
                      fmt::format("+Oframes/{}", part->path().filename().string()),
                      fmt::format("+WT{}", threads)},
        .folder = work,
        .environment = {{"POVINI", (work / "render.ini").string()}, {"POVINC", ""}},
        .log = log,
        .stall_s = options.stall_s};
    if (!options.scene.path.empty()) {
        request = in_scene_folder(std::move(request), povray, frame, part->path(), options);
    }
    Process process(request);
    return {.frame = frame, .log = log, .part = std::move(part), .process = std::move(process)};
}

// The last progress that POV-Ray reported, from the end of its log only, since a log that is
// written faster than it is read has no end.
double reported_share(const fs::path& log) {
    constexpr std::streamoff kTail = 400;
    std::ifstream in(log, std::ios::binary | std::ios::ate);
    const std::streamoff size = in.tellg();
    if (size <= 0) return 0.0;
    std::string tail(static_cast<std::size_t>(std::min(size, kTail)), '\0');
    in.seekg(size - static_cast<std::streamoff>(tail.size()));
    in.read(tail.data(), static_cast<std::streamsize>(tail.size()));
    tail.resize(static_cast<std::size_t>(in.gcount()));
    return share_in_log(tail);
}

void require_success(const Running& run, const ProcessEnd& end) {
    if (end.succeeded()) return;
    const std::string said = error_in_log(read_log(run.log));
    throw RunError("{}{}{}\nIts log: {}",
                   end.words(),
                   said.empty() ? "" : ":\n",
                   said.c_str(),
                   run.log.string());
}

// The end of a frame's run, if it has ended.
std::optional<ProcessEnd> poll(Running& run, const fs::path& folder) {
    try {
        const std::optional<ProcessEnd> end = run.process.poll();
        if (end) require_success(run, *end);
        return end;
    } catch (const RunError& error) {
        throw RunError("POV-Ray failed on {}: {}{}",
                       scene_path(folder, run.frame).string(),
                       error.what(),
                       words_of_full_disk(folder).c_str());
    }
}

void check(const Running& run,
           const fs::path& folder,
           int width_px,
           int height_px,
           const RunOptions& options) {
    const fs::path& part = run.part->path();
    try {
        if (options.convert) options.convert(run.frame, part);
        if (!fs::exists(part)) throw RunError("POV-Ray exited normally without an image");
        check_frame(part, width_px, height_px);
    } catch (const RunError& error) {
        throw RunError("{}: {}\nIts log: {}{}",
                       scene_path(folder, run.frame).string(),
                       error.what(),
                       run.log.string(),
                       words_of_full_disk(folder).c_str());
    }
}

}  // namespace

void run_frames(const PovRay& povray,
                const fs::path& folder,
                const std::vector<ManifestFrame>& frames,
                int width_px,
                int height_px,
                const RunOptions& options) {
    if (frames.empty()) return;
    make_folder(folder / "povray" / "logs");
    make_folder(folder / "povray" / "frames");
    const auto slots =
        options.scene.writes_files
            ? std::size_t{1}
            : std::min(frames.size(), static_cast<std::size_t>(std::max(1, options.jobs)));
    const int threads = std::max(1, options.jobs / static_cast<int>(slots));

    const InterruptionHold hold;
    std::list<Running> running;
    std::size_t started = 0;
    std::size_t done = 0;
    auto next_report = std::chrono::steady_clock::now();
    while (done < frames.size()) {
        throw_if_interrupted();
        while (running.size() < slots && started < frames.size()) {
            running.push_back(start(povray, folder, frames[started++], threads, options));
        }
        for (auto run = running.begin(); run != running.end();) {
            if (!poll(*run, folder)) {
                ++run;
                continue;
            }
            const Running ended = std::move(*run);
            run = running.erase(run);
            // Starts the next one first, so that cores do not wait for the check.
            if (started < frames.size()) {
                running.push_back(start(povray, folder, frames[started++], threads, options));
            }
            check(ended, folder, width_px, height_px, options);
            if (!options.scene.path.empty()) require_unchanged(options.scene);
            if (options.checked) options.checked(ended.frame, ended.part->path());
            ended.part->commit();
            if (options.arrived) options.arrived(ended.frame);
            ++done;
        }
        if (options.report && std::chrono::steady_clock::now() >= next_report) {
            double share = static_cast<double>(done);
            for (const Running& run : running) share += reported_share(run.log);
            options.report({.frames = frames.size(),
                            .frames_done = done,
                            .share = share / static_cast<double>(frames.size())});
            next_report += kReportInterval;
        }
        std::this_thread::sleep_for(kPollInterval);
    }
}

}  // namespace aphotic
