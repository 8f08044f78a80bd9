// SPDX-License-Identifier: BSD-3-Clause
//
// The time of `aphotic correct` for a survey from disk to disk, compared with only reading the same
// raw images and writing the same corrected ones, by the same library, in as many threads and with
// the same compression. HabCam's mosaics, 5 MP behind a port, and smooth beams in clear water and
// in Jerlov's 1C, whose veil is subtracted (goal: at most 1.3 times as long). The gain is taken
// from the default number of images, 16, each of which is read and mapped once more; in a survey of
// thousands their time is as negligible as that of 1.
//
// The two numbers after a name are images and jobs. (Goals: HabCam's six mosaics a second on two
// cores; at most twice as long as reading and writing.)
#include "base/atomic_file.h"
#include "base/parallel.h"
#include "bench/processor_time.h"
#include "lightmap/lightmap.h"
#include "plugin/process.h"
#include "rig/file/rig_reader.h"
#include "survey/simulate/raw_camera.h"

#include <OpenImageIO/imageio.h>
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDistinct = 8;  // images; the others are copies of these

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
    spec.attribute("tiff:zipquality", 1);  // the default of `correct`
    const auto output = OIIO::ImageOutput::create(file.string());
    output->threads(1);
    if (!output->open(file.string(), spec) ||
        !output->write_image(OIIO::TypeDesc::UINT16, image.pixels.data()) || !output->close()) {
        throw std::runtime_error(output->geterror());
    }
}

std::string name_of(std::size_t i) {
    return fmt::format("{:04}.tif", i);
}

void write_survey(const fs::path& folder, const Rig& rig, std::size_t images) {
    fs::create_directories(folder / "raw");
    std::vector<Sled> sleds;
    for (std::size_t i = 0; i < kDistinct; ++i) {
        const double step = static_cast<double>(i) / kDistinct;
        sleds.push_back({.altitude_m = 1.6 + 1.4 * step,
                         .pitch_rad = 0.1 * (step - 0.5),
                         .roll_rad = 0.15 * (0.5 - step)});
    }
    double brightest = 0.0;
    for (std::size_t i = 0; i < kDistinct; ++i) {
        Lightmap map = LightmapMaker(rig, paths_of(rig, {sleds[i]}), {}).map(sleds[i]);
        map.samples = signal_of(map);
        if (i == 0) brightest = std::ranges::max(map.samples);
        RawCamera camera;
        camera.electrons_per_signal = camera.saturation_e / (1.2 * brightest);
        const auto mosaic = raw_samples(
            {.width_px = map.width_px, .height_px = map.height_px, .samples = map.samples},
            camera,
            NoiseOf{.seed = 1, .image = static_cast<int>(i) + 1});
        const OIIO::ImageSpec spec(map.width_px, map.height_px, 1, OIIO::TypeDesc::UINT16);
        write_image(folder / "raw" / name_of(i), {.spec = spec, .pixels = mosaic}, "none");
    }
    std::string navigation;
    for (std::size_t i = 0; i < images; ++i) {
        const Sled& sled = sleds[i % kDistinct];
        constexpr double kDegrees = 57.29577951308232;
        if (i >= kDistinct) {
            fs::copy_file(folder / "raw" / name_of(i % kDistinct), folder / "raw" / name_of(i));
        }
        navigation += fmt::format("{} {} {} {}\n",
                                  name_of(i),
                                  sled.altitude_m,
                                  sled.pitch_rad * kDegrees,
                                  sled.roll_rad * kDegrees);
    }
    write_text_file(folder / "nav.txt", navigation);
}

std::string with(const std::string& key, const std::string& value, const std::string& text) {
    return std::regex_replace(
        text, std::regex("\n" + key + " *= [^\n]*"), "\n" + key + " = " + value);
}

std::string rig_text(const std::string& name) {
    const std::string scene = name.starts_with("led") ? "habcam-led" : name;
    std::string toml = read_text_file(APHOTIC_SOURCE_DIR "/scenes/" + scene + ".toml");
    if (name == "port")
        return with("resolution", "[2448, 2048]", with("pixel_pitch_um", "3.45", toml));
    if (name != "led_1C") return toml;
    toml = with("range_nm", "[400, 700]", toml);  // where Jerlov's tables end
    return std::regex_replace(toml, std::regex("\nabsorption *= [^\n]*"), "\ntype = \"jerlov-1C\"");
}

// In a folder that is removed at the end of the program.
class Survey {
  public:
    Survey(const std::string& rig, std::size_t images)
        : folder_(fs::temp_directory_path() /
                  fmt::format("aphotic-survey-bench-{}-{}-{}", ::getpid(), rig, images)) {
        fs::create_directories(folder_);
        write_text_file(folder_ / "rig.toml", rig_text(rig));
        write_survey(folder_, read_rig(folder_ / "rig.toml"), images);
        correct(2);
        for (std::size_t i = 0; i < kDistinct; ++i) {
            corrected_.push_back(read_image(folder_ / "out" / name_of(i)));
        }
    }
    ~Survey() { fs::remove_all(folder_); }
    Survey(const Survey&) = delete;
    Survey& operator=(const Survey&) = delete;

    void correct(std::int64_t jobs) const {
        constexpr double kPatience_s = 3600.0;
        fs::remove_all(folder_ / "out");
        std::istringstream words(
            fmt::format("correct raw --rig rig.toml --nav nav.txt --bayer RGGB --black-level 64 "
                        "--white-level 4095 --model-tolerance 1 --jobs {} -o out",
                        jobs));
        const ProcessEnd end =
            run_process({.executable = APHOTIC_COMMAND,
                         .arguments = {std::istream_iterator<std::string>(words), {}},
                         .folder = folder_,
                         .environment = {},
                         .log = folder_ / "log"},
                        kPatience_s);
        if (!end.succeeded()) throw std::runtime_error("aphotic correct: " + end.words());
    }

    void read_and_write(std::size_t images, std::int64_t jobs) const {
        fs::create_directories(folder_ / "copies");
        parallel_for(images, static_cast<std::size_t>(jobs), [&](std::size_t i, std::size_t) {
            const Image raw = read_image(folder_ / "raw" / name_of(i));
            write_image(folder_ / "copies" / name_of(i), corrected_[i % kDistinct], "zip");
        });
    }

  private:
    fs::path folder_;
    std::vector<Image> corrected_;
};

// Made once, for all repetitions.
const Survey& survey_of(const std::string& rig, std::size_t images) {
    static std::map<std::pair<std::string, std::size_t>, Survey> surveys;
    return surveys.try_emplace({rig, images}, rig, images).first->second;
}

double own_and_childrens_s() {
    return processor_s(RUSAGE_SELF) + processor_s(RUSAGE_CHILDREN);
}

void time_work(benchmark::State& state, const std::function<void()>& work) {
    const auto images = static_cast<double>(state.range(0));
    const double before_s = own_and_childrens_s();
    for (auto _ : state) work();
    state.counters["processor_ms_an_image"] = 1e3 * (own_and_childrens_s() - before_s) / images;
    state.counters["images_a_second"] = benchmark::Counter(images, benchmark::Counter::kIsRate);
}

void correct(benchmark::State& state, const std::string& rig) {
    const Survey& survey = survey_of(rig, static_cast<std::size_t>(state.range(0)));
    time_work(state, [&] { survey.correct(state.range(1)); });
}

void read_and_write(benchmark::State& state, const std::string& rig) {
    const auto images = static_cast<std::size_t>(state.range(0));
    const Survey& survey = survey_of(rig, images);
    time_work(state, [&] { survey.read_and_write(images, state.range(1)); });
}

void each(benchmark::internal::Benchmark* benchmark) {
    benchmark->Unit(benchmark::kSecond)->UseRealTime()->Iterations(1)->Repetitions(3);
}
BENCHMARK_CAPTURE(correct, habcam, "habcam")->Apply(each)->Args({48, 2})->Args({16, 2});
BENCHMARK_CAPTURE(read_and_write, habcam, "habcam")->Apply(each)->Args({48, 2})->Args({16, 2});
BENCHMARK_CAPTURE(correct, led, "led")->Apply(each)->Args({16, 1});
BENCHMARK_CAPTURE(correct, led_1C, "led_1C")->Apply(each)->Args({16, 1});
BENCHMARK_CAPTURE(correct, port, "port")->Apply(each)->Args({24, 2})->Args({8, 2});
BENCHMARK_CAPTURE(read_and_write, port, "port")->Apply(each)->Args({24, 2})->Args({8, 2});

}  // namespace
}  // namespace aphotic
