// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/frame_runner.h"

#include "plugin/process.h"
#include "spectral/atomic_file.h"
#include "spectral/error.h"
#include "spectral/frame_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <list>
#include <regex>
#include <sstream>
#include <system_error>
#include <thread>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr auto kPollInterval = std::chrono::milliseconds(20);
constexpr auto kReportInterval = std::chrono::milliseconds(250);

struct Running {
    ManifestFrame frame;
    fs::path log;
    fs::path part;  // the image while it is made
    Process process;
};

fs::path part_path(const fs::path& folder, const ManifestFrame& frame) {
    return folder / "povray" / "frames" / (frame.name + ".part.exr");
}

Running start(const PovRay& povray,
              const fs::path& folder,
              const ManifestFrame& frame,
              int threads) {
    const fs::path work = fs::absolute(folder / "povray");
    const fs::path log = fs::absolute(log_path(folder, frame));
    const fs::path part = part_path(folder, frame);
    std::error_code ignored;
    fs::remove(part, ignored);
    return {.frame = frame,
            .log = log,
            .part = part,
            .process = Process(
                {.executable = povray.executable,
                 .arguments = {fmt::format("+I{}.pov", frame.name),
                               fmt::format("+Oframes/{}", part.filename().string()),
                               fmt::format("+WT{}", threads)},
                 .folder = work,
                 .environment = {{"POVINI", (work / "render.ini").string()}, {"POVINC", ""}},
                 .log = log})};
}

// The last share of a frame that POV-Ray reported, from the end of its log.
double reported_share(const fs::path& log) {
    constexpr std::streamoff kTail = 400;
    std::ifstream in(log, std::ios::binary | std::ios::ate);
    const std::streamoff size = in.tellg();
    if (size <= 0) return 0.0;
    in.seekg(std::max<std::streamoff>(0, size - kTail));
    const std::string tail{std::istreambuf_iterator<char>(in), {}};
    static const std::regex kPercent(R"(pixels \((\d+)%\))");
    double share = 0.0;
    for (std::sregex_iterator match(tail.begin(), tail.end(), kPercent), end; match != end;
         ++match) {
        share = std::stoi((*match)[1]) / 100.0;
    }
    return share;
}

void take_in(const Running& run,
             const ProcessEnd& end,
             const fs::path& folder,
             int width_px,
             int height_px,
             const RunOptions& options) {
    if (!end.succeeded()) {
        const std::string said = error_in_log(read_text_file(run.log));
        throw RunError(fmt::format("POV-Ray failed on {} ({}){}{}\nIts log: {}",
                                   scene_path(folder, run.frame).string(),
                                   end.words(),
                                   said.empty() ? "" : ":\n",
                                   said,
                                   run.log.string()));
    }
    if (options.convert) options.convert(run.part);
    if (!fs::exists(run.part)) {
        throw RunError(fmt::format("POV-Ray made no image of {}, though it ended well\nIts log: {}",
                                   scene_path(folder, run.frame).string(),
                                   run.log.string()));
    }
    check_frame(run.part, width_px, height_px);
    std::error_code error;
    fs::rename(run.part, image_path(folder, run.frame), error);
    if (error) {
        throw RunError(fmt::format(
            "{}: cannot be written: {}", image_path(folder, run.frame).string(), error.message()));
    }
}

}  // namespace

std::string error_in_log(const std::string& log) {
    // POV-Ray wraps at 80 columns and indents what goes on with one blank.
    std::istringstream lines(log);
    std::vector<std::string> statements;
    for (std::string line; std::getline(lines, line);) {
        line = line.substr(line.rfind('\r') + 1);  // progress overwrites itself
        if (line.starts_with(' ') && !line.starts_with("  ") && !statements.empty()) {
            statements.back() += line;
        } else {
            statements.push_back(line);
        }
    }
    std::string said;
    for (const std::string& statement : statements) {
        if (statement.find("rror") == std::string::npos &&
            statement.find("Problem with option") == std::string::npos) {
            continue;
        }
        if (!said.empty()) said += '\n';
        said += statement;
    }
    return said;
}

void run_frames(const PovRay& povray,
                const fs::path& folder,
                const std::vector<ManifestFrame>& frames,
                int width_px,
                int height_px,
                const RunOptions& options,
                const std::function<void(const ManifestFrame&)>& arrived) {
    if (frames.empty()) return;
    make_folder(folder / "povray" / "logs");
    make_folder(folder / "povray" / "frames");
    const auto slots = std::min(frames.size(), static_cast<std::size_t>(std::max(1, options.jobs)));
    const int threads = std::max(1, options.jobs / static_cast<int>(slots));

    std::list<Running> running;
    std::size_t started = 0;
    std::size_t done = 0;
    auto next_report = std::chrono::steady_clock::now();
    while (done < frames.size()) {
        while (running.size() < slots && started < frames.size()) {
            running.push_back(start(povray, folder, frames[started++], threads));
        }
        for (auto run = running.begin(); run != running.end();) {
            const auto end = run->process.poll();
            if (!end) {
                ++run;
                continue;
            }
            const Running ended = std::move(*run);
            run = running.erase(run);
            // Start the next one first: the cores need not wait for the check.
            if (started < frames.size()) {
                running.push_back(start(povray, folder, frames[started++], threads));
            }
            take_in(ended, *end, folder, width_px, height_px, options);
            arrived(ended.frame);
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
