// SPDX-License-Identifier: BSD-3-Clause
//
// The loop over a survey's images, by work that copies a file: what it does again, what it leaves,
// what one bad image costs.
#include "survey/correct/image_run.h"
#include "support/abandoned_file.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/sha256.h"
#include "support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <mutex>
#include <set>

namespace aphotic::image_run_test {
namespace {

namespace fs = std::filesystem;

class ImageRun : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(path("raw"));
        for (const char* name : {"a", "b", "c"}) write_image(name, "light");
        options_.folder = path("out");
        options_.format.format = "exr";
    }

    [[nodiscard]] fs::path path(const std::string& name) const { return temp_.path() / name; }

    void write_image(const std::string& name, const std::string& text) {
        write_file(path("raw/" + name + ".exr"), text);
    }

    [[nodiscard]] std::vector<ImageFile> files() const {
        return image_files({path("raw").string()}, options_.folder);
    }

    // Copies each image; those of bad_ throw.
    RunOutcome run() {
        prepared_ = 0;
        heard_.clear();
        ImageWork work;
        work.inputs = [&](const ImageFile&) { return inputs_; };
        work.prepare = [&] { ++prepared_; };
        work.make = [&](const ImageFile& file) {
            if (bad_.contains(file.name.string())) throw InputError("too dark");
            if (broken_ == file.name.string()) throw RunError("the disk is full");
            write_file(options_.folder / (file.name.string() + ".exr"),
                       read_text_file(file.source));
            return Counts{{"dark", 1.0}, {kPixels, 4.0}};
        };
        RunWatch watch;
        watch.skipped = [&](const Skipped& one) { heard_.push_back(one.why); };
        const WorkFolder folder(options_.folder);
        return run_images(files(), options_, work, watch);
    }

    TempFolder temp_;
    ImageRunOptions options_{.folder = {}, .format = {}, .jobs = 2};
    std::string inputs_ = "settings";
    std::set<std::string> bad_;
    std::string broken_;
    int prepared_ = 0;
    std::vector<std::string> heard_;
};

TEST_F(ImageRun, DoesWhatIsNewOrChangedAndNothingElse) {
    const auto counts = [&] {
        const RunOutcome outcome = run();
        EXPECT_EQ(prepared_, outcome.corrected > 0 ? 1 : 0);
        EXPECT_EQ(outcome.doubtful_share("dark"), 0.25);
        return std::pair(outcome.corrected, outcome.kept);
    };
    EXPECT_EQ(counts(), std::pair(3UL, 0UL));
    EXPECT_EQ(counts(), std::pair(0UL, 3UL));
    write_image("d", "more light");
    EXPECT_EQ(counts(), std::pair(1UL, 3UL));
    write_image("a", "other light");
    EXPECT_EQ(counts(), std::pair(1UL, 3UL));
    fs::remove(path("out/b.exr"));
    write_file(path("out/c.exr"), "cut");
    EXPECT_EQ(counts(), std::pair(2UL, 2UL));
    inputs_ = "other settings";
    EXPECT_EQ(counts(), std::pair(4UL, 0UL));
}

// As version 0.1 wrote it: the name, SHA-256 of inputs, size and time, the files' sizes, counts.
TEST_F(ImageRun, HonoursTheJournalOfVersion01) {
    fs::create_directories(path("out"));
    std::string journal;
    for (const char* name : {"a", "b"}) {
        const fs::path source = path(fmt::format("raw/{}.exr", name));
        write_file(path(fmt::format("out/{}.exr", name)), "12 bytes of.");
        journal += fmt::format(
            R"({{"counts":{{"dark":2.0}},"digest":"{}","files":{{"{}.exr":12}},"name":"{}"}})"
            "\n",
            sha256_of_text(fmt::format("settings {} {}",
                                       fs::file_size(source),
                                       fs::last_write_time(source).time_since_epoch().count())),
            name,
            name);
    }
    write_file(path("out/corrected.jsonl"), journal);
    const RunOutcome outcome = run();
    EXPECT_EQ(outcome.kept, 2U);
    EXPECT_EQ(outcome.corrected, 1U);
    EXPECT_EQ(outcome.counts.at("dark"), 5.0);
}

TEST_F(ImageRun, ABadImageCostsNoOtherAndIsTriedAgain) {
    bad_ = {"a", "c"};
    fs::create_symlink("nowhere.exr", path("raw/b0.exr"));
    const RunOutcome outcome = run();
    EXPECT_EQ(outcome.corrected, 1U);
    ASSERT_EQ(outcome.skipped.size(), 3U);
    EXPECT_EQ(outcome.skipped[0].image, path("raw/a.exr").string());
    EXPECT_EQ(outcome.skipped[0].why, "too dark");
    EXPECT_EQ(outcome.skipped[1].why, "found a broken link; allowed: a file");
    EXPECT_EQ(outcome.skipped[2].image, path("raw/c.exr").string());
    EXPECT_EQ(heard_.size(), 3U);
    const nlohmann::ordered_json json = to_json(outcome);
    EXPECT_EQ(json["skipped"][2]["why"], "too dark");
    EXPECT_EQ(json["doubtful"]["dark"], 0.25);
    bad_.clear();
    EXPECT_EQ(run().corrected, 2U);
}

TEST_F(ImageRun, AFaultOfTheSystemEndsItAndWhatIsDoneStays) {
    options_.jobs = 1;
    broken_ = "b";
    EXPECT_THROW(run(), RunError);
    broken_.clear();
    const RunOutcome outcome = run();
    EXPECT_EQ(outcome.kept, 1U);
    EXPECT_EQ(outcome.corrected, 2U);
}

TEST_F(ImageRun, TheFolderIsRidOfKilledRunsAndGoesWhenNothingIsWritten) {
    { const WorkFolder folder(options_.folder); }
    EXPECT_FALSE(fs::exists(path("out")));
    fs::create_directories(path("out/below"));
    const auto left = abandon(path("out/below/a.exr"));
    ASSERT_TRUE(fs::exists(left));
    write_file(path("out/a.exr"), "a result");
    { const WorkFolder folder(options_.folder); }
    EXPECT_FALSE(fs::exists(left));
    EXPECT_TRUE(fs::exists(path("out/a.exr")));
}

TEST_F(ImageRun, NoSourceIsOverwritten) {
    const std::vector<ImageFile> sources = files();
    options_.folder = path("raw");
    EXPECT_THROW(require_results_apart(sources, options_), InputError);
    options_.format.format = "png";
    EXPECT_NO_THROW(require_results_apart(sources, options_));
    fs::create_symlink("c.exr", path("raw/a.png"));  // by another name
    EXPECT_THROW(require_results_apart(sources, options_), InputError);
}

}  // namespace
}  // namespace aphotic::image_run_test
