// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/sweep.h"

#include "base/error.h"
#include "rig/rig_reader.h"
#include "support/small_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

namespace aphotic::sweep_test {
namespace {

namespace fs = std::filesystem;

const fs::path kProgram = "/usr/bin/aphotic";

std::string message_of(const fs::path& file, const fs::path& folder) {
    try {
        write_sweep(file, folder, kProgram);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Sweep, GivesEachTaskARigOfItsOwn) {
    const SmallSweep small;
    const fs::path out = small.folder() / "out";
    const Sweep sweep = write_sweep(small.write("trace", kThreeWaters), out, kProgram);
    ASSERT_EQ(sweep.tasks(), 3U);
    const Rig base = read_rig(small.folder() / "rig.toml");
    const std::vector<double> multiples{0.5, 1.0, 2.0};
    for (std::size_t i = 0; i < multiples.size(); ++i) {
        const Rig rig = read_rig(task_folder(sweep, i + 1) / "rig.toml");
        EXPECT_EQ(rig.water.multiple, multiples[i]);
        EXPECT_EQ(rig.sled.altitude_m, base.sled.altitude_m);
        EXPECT_EQ(rig.strobes.front().spectrum.at(500.0), base.strobes.front().spectrum.at(500.0));
    }
    EXPECT_EQ(std::set<std::string>(sweep.digests.begin(), sweep.digests.end()).size(), 3U);
}

TEST(Sweep, WritesALineForEachTask) {
    const SmallSweep small;
    const fs::path out = small.folder() / "an out's folder";
    const Sweep sweep = write_sweep(small.write("trace", kThreeWaters), out, kProgram);
    const std::string lines = read_text_file(out / "tasks.txt");
    EXPECT_EQ(std::ranges::count(lines, '\n'), 3);
    const std::string quoted = std::regex_replace(out.string(), std::regex("'"), R"('\'')");
    EXPECT_TRUE(lines.starts_with("/usr/bin/aphotic sweep '" + quoted + "' --task 1\n")) << lines;
    for (const char* file : {"run-task", "array.sbatch", "Snakefile", "submit.sub"}) {
        const std::string text = read_text_file(out / file);
        EXPECT_EQ(text.find('@'), std::string::npos) << file;  // a name that nothing stands for
        EXPECT_NE(text.find('3'), std::string::npos) << file;  // the number of tasks
    }
    const auto may_run = fs::status(out / "run-task").permissions() & fs::perms::owner_exec;
    EXPECT_NE(may_run, fs::perms::none);
}

TEST(Sweep, ReadsBackWhatItWrote) {
    const SmallSweep small;
    const fs::path out = small.folder() / "out";
    const Sweep written = write_sweep(small.write("trace", kThreeWaters), out, kProgram);
    const Sweep read = read_sweep(out);
    EXPECT_EQ(read.digests, written.digests);
    EXPECT_EQ(read.points, written.points);
    EXPECT_EQ(read.home, small.folder());
    EXPECT_EQ(read.folder, out);
    for (std::size_t number = 1; number <= 3; ++number)
        EXPECT_EQ(arguments_of(read, number), arguments_of(written, number));
}

TEST(Sweep, TheSameSweepIsTheSameFiles) {
    const SmallSweep small;
    const fs::path file = small.write("trace", kThreeWaters);
    const fs::path out = small.folder() / "out";
    const Sweep first = write_sweep(file, out, kProgram);
    const std::string notes = read_text_file(out / "sweep.json");
    EXPECT_EQ(write_sweep(file, out, kProgram).digests, first.digests);
    EXPECT_EQ(read_text_file(out / "sweep.json"), notes);
}

TEST(Sweep, ATaskDependsOnItsRigTablesAndArguments) {
    const SmallSweep small;
    const fs::path out = small.folder() / "out";
    const Sweep first = write_sweep(small.write("trace", kThreeWaters), out, kProgram);
    const Sweep fewer =
        write_sweep(small.write("trace", "[[vary]]\nkey = \"water.multiple\"\nvalues = [0.5]\n"),
                    out,
                    kProgram);
    EXPECT_EQ(fewer.digests.front(), first.digests.front());
    const Sweep other = write_sweep(
        small.write("trace", std::string("arguments = [\"--fitted\", \"3\"]\n") + kThreeWaters),
        out,
        kProgram);
    EXPECT_NE(other.digests.front(), first.digests.front());
    const Sweep cores =
        write_sweep(small.write("trace", std::string("cores = 2\n") + kThreeWaters), out, kProgram);
    EXPECT_EQ(cores.digests, first.digests);  // they make the same images
    write_file(small.folder() / "lamps/lamp.csv",
               "wavelength_nm,relative_power\n400,1\n500,1.6\n720,1\n");
    const Sweep lamp = write_sweep(small.write("trace", kThreeWaters), out, kProgram);
    EXPECT_NE(lamp.digests.front(), first.digests.front());
}

TEST(Sweep, ATaskDependsOnWhatItReads) {
    const SmallSweep small;
    const fs::path rig = small.folder() / "rig.toml";
    write_file(small.folder() / "my.pov", "#version 3.7;\n#include \"sled.inc\"\n");
    write_file(small.folder() / "sled.inc", "sphere { 0, 1 }");
    write_file(rig, "scene = \"my.pov\"\n" + read_text_file(rig));
    write_file(small.folder() / "nav.csv", "altitude_m\n2\n");
    const auto digest = [&](const std::string& command) {
        const fs::path file = small.write(
            command, std::string("arguments = [\"--nav\", \"nav.csv\"]\n") + kThreeWaters);
        return write_sweep(file, small.folder() / "out", kProgram).digests.front();
    };
    const std::string render = digest("render");
    const std::string trace = digest("trace");
    write_file(small.folder() / "sled.inc", "box { 0, 1 }");
    EXPECT_NE(digest("render"), render);
    EXPECT_EQ(digest("trace"), trace);  // takes no scene
    write_file(small.folder() / "nav.csv", "altitude_m\n2.25\n");
    EXPECT_NE(digest("trace"), trace);
}

TEST(Sweep, WritesNothingWhileARigIsWrong) {
    const SmallSweep small;
    const fs::path out = small.folder() / "out";
    std::string message = message_of(
        small.write("trace", "[[vary]]\nkey = \"water.multiple\"\nvalues = [1, -1]\n"), out);
    EXPECT_NE(message.find("sweep.toml: water.multiple = -1: "), std::string::npos) << message;
    EXPECT_NE(message.find("allowed"), std::string::npos) << message;
    message = message_of(
        small.write("trace", "[[vary]]\nkey = \"strobe.for.power\"\nvalues = [1]\n"), out);
    EXPECT_NE(message.find("strobe.for.power: found no 'for'"), std::string::npos) << message;
    message =
        message_of(small.write("trace", "[[vary]]\nkey = \"water.multipel\"\nvalues = [1]\n"), out);
    EXPECT_NE(message.find("multipel"), std::string::npos) << message;
    EXPECT_FALSE(fs::exists(out));
}

TEST(Sweep, RefusesAFileThatWasEditedBesideItsTasks) {
    const SmallSweep small;
    const fs::path out = small.folder() / "out";
    write_sweep(small.write("trace", kThreeWaters), out, kProgram);
    write_file(out / "sweep.toml", read_text_file(out / "sweep.toml") + "\n");
    try {
        (void)read_sweep(out);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("was edited"), std::string::npos) << error.what();
    }
    EXPECT_THROW((void)read_sweep(small.folder()), InputError);
}

TEST(Sweep, NamesTheRigsSceneToTheCommandsThatTakeOne) {
    const SmallSweep small;
    const fs::path rig = small.folder() / "rig.toml";
    write_file(small.folder() / "my.pov", "#version 3.7;\n");
    write_file(rig, "scene = \"my.pov\"\n" + read_text_file(rig));
    const auto has_scene = [&](const std::string& command) {
        const Sweep sweep =
            write_sweep(small.write(command, kThreeWaters), small.folder() / "out", kProgram);
        const std::vector<std::string> arguments = arguments_of(sweep, 1);
        EXPECT_EQ(arguments_of(read_sweep(small.folder() / "out"), 1), arguments);
        EXPECT_TRUE(read_rig(task_folder(sweep, 1) / "rig.toml").scene.empty());
        return std::ranges::count(arguments, (small.folder() / "my.pov").string()) == 1;
    };
    EXPECT_TRUE(has_scene("render"));
    EXPECT_FALSE(has_scene("trace"));
}

TEST(Sweep, SharesOfOneRigWriteBelowOneFolder) {
    const SmallSweep small;
    const Sweep sweep = write_sweep(
        small.write("correct", std::string("images = [\"survey\"]\nshares = 2\n") + kThreeWaters),
        small.folder() / "out",
        kProgram);
    ASSERT_EQ(sweep.tasks(), 6U);
    EXPECT_EQ(results_folder(sweep, 1), results_folder(sweep, 2));
    EXPECT_NE(results_folder(sweep, 2), results_folder(sweep, 3));
    const std::vector<std::string> last = arguments_of(sweep, 6);
    EXPECT_EQ(*std::next(std::ranges::find(last, "--share")), "2/2");
    EXPECT_EQ(std::set<std::string>(sweep.digests.begin(), sweep.digests.end()).size(), 6U);
}

}  // namespace
}  // namespace aphotic::sweep_test
