// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/sweep.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/sha256.h"
#include "base/words.h"
#include "base/work_folder.h"
#include "rig/rig_text.h"
#include "sweep/sweep_inputs.h"
#include "sweep/wrapper.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <initializer_list>
#include <utility>
#include <variant>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr const char* kFile = "sweep.toml";
constexpr const char* kNotes = "sweep.json";
constexpr const char* kTaskRig = "rig.toml";

fs::path numbered(const Sweep& sweep, const char* what, std::size_t number) {
    return sweep.folder / fmt::format("{}-{:04}", what, number);
}

// A scene stays where it is, with all that it includes: the command names it.
bool takes_scene(const SweepFile& file) {
    return file.command == "render" || file.command == "validate";
}

struct PointRig {
    RigText text;
    std::string digest;
};

PointRig rig_at(const SweepFile& file, const SweepPoint& point, RigText text) {
    std::vector<std::string> set;
    for (std::size_t k = 0; k < point.size(); ++k) {
        const std::string& key = file.vary[k].key;
        set.push_back(fmt::format("{} = {}", key, words_of(point[k])));
        std::visit([&](const auto& value) { text.set(key, value); }, point[k]);
    }
    const auto read = [&] { return text.rig().digest; };
    std::string digest =
        set.empty() ? read() : naming(fmt::format("{}", fmt::join(set, ", ")), read);
    return {.text = std::move(text), .digest = std::move(digest)};
}

std::vector<std::string> own_arguments(const Sweep& sweep, SweepTask task) {
    const SweepFile& file = sweep.file;
    std::vector<std::string> own = file.arguments;
    if (file.shares > 1)
        own.insert(own.end(), {"--share", fmt::format("{}/{}", task.share + 1, file.shares)});
    return own;
}

// What results depend on, the number of cores aside.
std::string digest_of(const Sweep& sweep,
                      SweepTask task,
                      const std::string& rig,
                      const std::string& inputs) {
    const nlohmann::json all{APHOTIC_VERSION,
                             sweep.file.command,
                             sweep.file.images,
                             own_arguments(sweep, task),
                             rig,
                             sha256_of_text(inputs)};
    return sha256_of_text(all.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void write_lines(const Sweep& sweep, const fs::path& program) {
    std::string lines;
    for (std::size_t number = 1; number <= sweep.tasks(); ++number) {
        lines += fmt::format("{} sweep {} --task {}\n",
                             shell_word(program.string()),
                             shell_word(sweep.folder.string()),
                             number);
    }
    write_text_file(sweep.folder / "tasks.txt", lines);
}

// The engines' files have it between quotes, and on one line.
void require_plain(const fs::path& folder) {
    if (folder.string().find_first_of("\n\r\"") == std::string::npos) return;
    throw InputError("{}: found a quote or the end of a line in the path; allowed: neither",
                     folder.string());
}

}  // namespace

SweepTask task_of(const Sweep& sweep, std::size_t number) {
    const auto shares = static_cast<std::size_t>(sweep.file.shares);
    return {.point = (number - 1) / shares, .share = static_cast<int>((number - 1) % shares)};
}

fs::path task_folder(const Sweep& sweep, std::size_t number) {
    return numbered(sweep, "task", number);
}

fs::path results_folder(const Sweep& sweep, std::size_t number) {
    if (sweep.file.shares == 1) return task_folder(sweep, number) / "out";
    return numbered(sweep, "point", task_of(sweep, number).point + 1);
}

namespace {

std::vector<std::string> command_line(const Sweep& sweep,
                                      std::size_t number,
                                      const std::vector<std::string>& own) {
    const SweepFile& file = sweep.file;
    const std::string rig = (task_folder(sweep, number) / kTaskRig).string();
    const std::string out = results_folder(sweep, number).string();
    std::vector<std::string> arguments{file.command};
    const auto add = [&](std::initializer_list<std::string> more) {
        arguments.insert(arguments.end(), more);
    };
    if (file.command == "correct") {
        arguments.insert(arguments.end(), file.images.begin(), file.images.end());
        add({"--rig", rig});
    } else {
        add({rig});
    }
    if (file.command == "fit") {
        add({"--images"});
        arguments.insert(arguments.end(), file.images.begin(), file.images.end());
    }
    if (file.command == "lightmap") {
        add({"-o", out + "/lightmap.exr", "--preview", out + "/preview.png"});
    } else {
        add({"-o", out});
    }
    if (!sweep.scene.empty()) add({"--scene", sweep.scene.string()});
    arguments.insert(arguments.end(), own.begin(), own.end());
    add({"--jobs", fmt::to_string(file.cores), "--json"});
    return arguments;
}

}  // namespace

std::vector<std::string> arguments_of(const Sweep& sweep, std::size_t number) {
    return command_line(sweep, number, own_arguments(sweep, task_of(sweep, number)));
}

std::vector<std::string> joining_arguments(const Sweep& sweep, std::size_t number) {
    return command_line(sweep, number, sweep.file.arguments);
}

Sweep write_sweep(
    const fs::path& file,
    const fs::path& folder,
    const fs::path& program,
    const std::function<void(const std::vector<std::string>& arguments)>& require_taken) {
    const std::string text = read_text_file(file);
    Sweep sweep{.file = parse_sweep_file(text, file.string()),
                .home = fs::absolute(file).lexically_normal().parent_path(),
                .folder = (fs::absolute(folder) / "").lexically_normal().parent_path(),
                .points = {},
                .digests = {}};
    require_plain(sweep.folder);
    sweep.points = points_of(sweep.file);
    RigText rig(sweep.home / sweep.file.rig);
    if (takes_scene(sweep.file)) sweep.scene = rig.rig().scene;
    rig.erase("scene");
    const std::string inputs = state_of({.home = sweep.home,
                                         .images = sweep.file.images,
                                         .arguments = sweep.file.arguments,
                                         .scene = sweep.scene,
                                         .folder = sweep.folder});
    std::vector<PointRig> rigs;
    for (const SweepPoint& point : sweep.points) {
        rigs.push_back(naming(file.string(), [&] { return rig_at(sweep.file, point, rig); }));
        for (int share = 0; share < sweep.file.shares; ++share)
            sweep.digests.push_back(digest_of(sweep, {.share = share}, rigs.back().digest, inputs));
    }
    require_taken(arguments_of(sweep, 1));

    make_folder(sweep.folder);
    const FolderLock lock(sweep.folder, FolderUse::Write);
    for (std::size_t number = 1; number <= sweep.tasks(); ++number) {
        const fs::path own = task_folder(sweep, number);
        const RigText& made = rigs[task_of(sweep, number).point].text;
        make_folder(own);
        made.copy_files(own);
        write_text_file(own / kTaskRig, made.text());
    }
    write_wrappers({.folder = sweep.folder, .tasks = sweep.tasks(), .cores = sweep.file.cores});
    write_lines(sweep, program);
    write_text_file(sweep.folder / kFile, text);
    // Last: with it the folder is a sweep's.
    write_text_file(sweep.folder / kNotes,
                    json_text({{"aphotic_version", APHOTIC_VERSION},
                               {"sweep_sha256", sha256_of_text(text)},
                               {"home", sweep.home.string()},
                               {"scene", sweep.scene.string()},
                               {"digests", sweep.digests}}));
    return sweep;
}

Sweep read_sweep(const fs::path& folder) {
    const fs::path notes = folder / kNotes;
    if (!fs::exists(notes))
        throw InputError("{}: found no sweep; allowed: a folder of `aphotic sweep SWEEP -o DIR`",
                         folder.string());
    const fs::path file = folder / kFile;
    const std::string text = read_text_file(file);
    const nlohmann::json json = parse_json(read_text_file(notes), notes.string());
    Sweep sweep{.file = parse_sweep_file(text, file.string()),
                .home = {},
                .folder = (fs::absolute(folder) / "").lexically_normal().parent_path(),
                .points = {},
                .digests = {}};
    sweep.points = points_of(sweep.file);
    try {
        sweep.home = json.at("home").get<std::string>();
        sweep.scene = json.at("scene").get<std::string>();
        sweep.digests = json.at("digests").get<std::vector<std::string>>();
        if (json.at("sweep_sha256") == sha256_of_text(text)) return sweep;
    } catch (const nlohmann::json::exception& error) {
        throw InputError("{}: is not ours: {}", notes.string(), error.what());
    }
    throw InputError(
        "{}: was edited since its tasks were written; allowed: edit the sweep's own "
        "file, and repeat `aphotic sweep SWEEP -o {}`",
        file.string(),
        folder.string());
}

}  // namespace aphotic
