// SPDX-License-Identifier: BSD-3-Clause
//
// What `aphotic correct` takes of a survey from disk to disk, beside what reading the same raw
// images and writing the same corrected ones takes by itself, by the same library, in as many
// threads and with the same compression. Both in turn, three times; the least counts, of the clock
// and of processor time. HabCam's mosaics, and 5 MP behind a port. The gain is taken
// from as many images as by default, 16, each of which is read and mapped once more; of a survey of
// thousands they count for nothing, as of 1.
//
//   survey_bench [IMAGES [JOBS [GAIN_IMAGES]]]     48, 2 and 16 by default; of 5 MP half as many
//
// (Goals: HabCam's six mosaics a second on two cores; at most twice as long as reading and
// writing.)
#include "base/atomic_file.h"
#include "base/parallel.h"
#include "bench/survey/raw_camera.h"
#include "lightmap/lightmap.h"
#include "rig/rig_reader.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

namespace aphotic {
namespace {

namespace fs = std::filesystem;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kDistinct = 8;  // images; the others are copies of these

struct Cost {
    double clock_s = kInfinity;
    double processor_s = kInfinity;
    double memory_MiB = 0.0;
};

double seconds_of(const rusage& use) {
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(use.ru_utime) + seconds(use.ru_stime);
}

// By a process of its own, so that neither finds what the other has loaded or left in memory.
Cost cost_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    std::fflush(stdout);
    const pid_t child = ::fork();
    if (child == 0) {
        work();
        ::_exit(0);
    }
    int status = 0;
    rusage use{};
    ::wait4(child, &status, 0, &use);
    if (status != 0) throw std::runtime_error("a pass failed");
    const std::chrono::duration<double> clock = std::chrono::steady_clock::now() - start;
    return {.clock_s = clock.count(),
            .processor_s = seconds_of(use),
            .memory_MiB = static_cast<double>(use.ru_maxrss) / 1024.0};
}

struct Image {
    OIIO::ImageSpec spec;
    std::vector<std::uint16_t> pixels;
};

Image read_image(const fs::path& file) {
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input) throw std::runtime_error(OIIO::geterror());
    Image image{.spec = input->spec(), .pixels = {}};
    image.pixels.resize(image.spec.image_pixels() * static_cast<std::size_t>(image.spec.nchannels));
    input->read_image(0, 0, 0, -1, OIIO::TypeDesc::UINT16, image.pixels.data());
    return image;
}

void write_image(const fs::path& file, const Image& image, const std::string& compression) {
    OIIO::ImageSpec spec(
        image.spec.width, image.spec.height, image.spec.nchannels, image.spec.format);
    spec.attribute("compression", compression);
    spec.attribute("tiff:zipquality", 1);  // as `correct` has it by default
    const auto output = OIIO::ImageOutput::create(file.string());
    output->threads(1);
    if (!output->open(file.string(), spec) ||
        !output->write_image(OIIO::TypeDesc::UINT16, image.pixels.data()) || !output->close()) {
        throw std::runtime_error(output->geterror());
    }
}

struct Survey {
    fs::path folder;
    std::size_t images;
    std::size_t jobs;
    std::size_t gain_images;

    [[nodiscard]] fs::path raw(std::size_t i) const {
        return folder / "raw" / fmt::format("{:04}.tif", i);
    }
};

void make_survey(const Survey& survey, const Rig& rig) {
    fs::create_directories(survey.folder / "raw");
    std::vector<Sled> sleds;
    for (std::size_t i = 0; i < kDistinct; ++i) {
        const double step = static_cast<double>(i) / kDistinct;
        sleds.push_back({.altitude_m = 1.6 + 1.4 * step,
                         .pitch_rad = 0.1 * (step - 0.5),
                         .roll_rad = 0.15 * (0.5 - step)});
    }
    double brightest = 0.0;
    for (std::size_t i = 0; i < kDistinct; ++i) {
        const Lightmap map = LightmapMaker(rig, paths_of(rig, {sleds[i]}), {}).map(sleds[i]);
        if (i == 0) brightest = std::ranges::max(map.samples);
        const auto mosaic = survey::raw_mosaic(
            {.width_px = map.width_px, .height_px = map.height_px, .samples = map.samples},
            {.full_signal = 1.2 * brightest},
            i + 1);
        const OIIO::ImageSpec spec(map.width_px, map.height_px, 1, OIIO::TypeDesc::UINT16);
        write_image(survey.raw(i), {.spec = spec, .pixels = mosaic}, "none");
    }
    std::string navigation;
    for (std::size_t i = 0; i < survey.images; ++i) {
        const Sled& sled = sleds[i % kDistinct];
        constexpr double kDegrees = 57.29577951308232;
        if (i >= kDistinct) fs::copy_file(survey.raw(i % kDistinct), survey.raw(i));
        navigation += fmt::format("{} {} {} {}\n",
                                  survey.raw(i).filename().string(),
                                  sled.altitude_m,
                                  sled.pitch_rad * kDegrees,
                                  sled.roll_rad * kDegrees);
    }
    write_text_file(survey.folder / "nav.txt", navigation);
}

Cost correct(const Survey& survey) {
    fs::remove_all(survey.folder / "out");
    return cost_of([&] {
        const std::string jobs = std::to_string(survey.jobs);
        const std::vector<std::string> words{APHOTIC_COMMAND,
                                             "correct",
                                             (survey.folder / "raw").string(),
                                             "--rig",
                                             (survey.folder / "rig.toml").string(),
                                             "--nav",
                                             (survey.folder / "nav.txt").string(),
                                             "--bayer",
                                             "RGGB",
                                             "--black-level",
                                             "64",
                                             "--white-level",
                                             "4095",
                                             "--gain-images",
                                             std::to_string(survey.gain_images),
                                             "--jobs",
                                             jobs,
                                             "-o",
                                             (survey.folder / "out").string()};
        std::vector<char*> arguments;
        for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        if (std::freopen("/dev/null", "w", stdout) == nullptr) ::_exit(1);
        ::execv(arguments[0], arguments.data());
        ::_exit(1);
    });
}

Cost read_and_write(const Survey& survey, const std::vector<Image>& corrected) {
    fs::remove_all(survey.folder / "copies");
    fs::create_directories(survey.folder / "copies");
    return cost_of([&] {
        parallel_for(survey.images, survey.jobs, [&](std::size_t i, std::size_t) {
            const Image raw = read_image(survey.raw(i));
            write_image(survey.folder / "copies" / survey.raw(i).filename(),
                        corrected[i % kDistinct],
                        "zip");
        });
    });
}

void take_least(Cost& least, const Cost& found) {
    least.clock_s = std::min(least.clock_s, found.clock_s);
    least.processor_s = std::min(least.processor_s, found.processor_s);
    least.memory_MiB = std::max(least.memory_MiB, found.memory_MiB);
}

void print(const std::string& what, const Cost& cost, std::size_t images) {
    fmt::print("  {:<16} {:6.1f} images/s, {:6.0f} ms of processor time an image",
               what,
               static_cast<double>(images) / cost.clock_s,
               1e3 * cost.processor_s / static_cast<double>(images));
}

void compare(const std::string& name, const Survey& survey) {
    make_survey(survey, read_rig(survey.folder / "rig.toml"));
    Cost corrected;
    Cost copied;
    std::vector<Image> images;
    constexpr int kPasses = 3;
    for (int pass = 0; pass < kPasses; ++pass) {
        take_least(corrected, correct(survey));
        for (std::size_t i = images.size(); i < kDistinct; ++i) {
            images.push_back(read_image(survey.folder / "out" / survey.raw(i).filename()));
        }
        take_least(copied, read_and_write(survey, images));
    }
    fmt::print("{}, {} images, {} jobs, gain from {}\n",
               name,
               survey.images,
               survey.jobs,
               std::min(survey.gain_images, survey.images));
    print("correct", corrected, survey.images);
    fmt::print(", {:.0f} MiB in all\n", corrected.memory_MiB);
    print("read and write", copied, survey.images);
    fmt::print("\n  ratio            {:.2f} by the clock, {:.2f} by processor time\n",
               corrected.clock_s / copied.clock_s,
               corrected.processor_s / copied.processor_s);
}

std::string with(const std::string& key, const std::string& value, const std::string& text) {
    return std::regex_replace(
        text, std::regex("\n" + key + " *= [^\n]*"), "\n" + key + " = " + value);
}

void run(std::size_t images, std::size_t jobs, std::size_t gain_images) {
    const fs::path scenes = APHOTIC_SOURCE_DIR "/scenes";
    const fs::path folder =
        fs::temp_directory_path() / ("aphotic-survey-bench-" + std::to_string(::getpid()));
    for (const char* name : {"habcam", "port"}) fs::create_directories(folder / name);
    const Survey habcam{
        .folder = folder / "habcam", .images = images, .jobs = jobs, .gain_images = gain_images};
    write_text_file(habcam.folder / "rig.toml", read_text_file(scenes / "habcam.toml"));
    compare("HabCam, 1360 x 1024", habcam);
    const Survey port{.folder = folder / "port",
                      .images = std::max(kDistinct, images / 2),
                      .jobs = jobs,
                      .gain_images = gain_images};
    write_text_file(port.folder / "rig.toml",
                    with("resolution",
                         "[2448, 2048]",
                         with("pixel_pitch_um", "3.45", read_text_file(scenes / "port.toml"))));
    compare("behind a port, 2448 x 2048", port);
    fs::remove_all(folder);
}

}  // namespace
}  // namespace aphotic

int main(int argc, char** argv) {
    constexpr std::size_t kImages = 48;
    constexpr std::size_t kGainImages = 16;
    const auto number = [&](int i, std::size_t otherwise) {
        return argc > i ? std::stoul(argv[i]) : otherwise;
    };
    aphotic::run(
        std::max(aphotic::kDistinct, number(1, kImages)), number(2, 2), number(3, kGainImages));
    return 0;
}
