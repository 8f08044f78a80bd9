// SPDX-License-Identifier: BSD-3-Clause
//
// judge_relief MASKS NAME=DIR ...: the evenness of corrected images of a sea floor with relief and
// uniform reflectance: the rms deviation from the survey's median in each channel, over the pixels
// that are 0 in MASKS, the folder of the correction whose masks count. Files are EXR, with the same
// names in all folders.
//
//   --depths DIR --noise SIGMA --write DIR   in addition, or instead, depth maps with noise  [m]
//   --picture FILE --show IMAGE              the corrections of one image side by side, each with
//                                            its own exposure and white balance
#include "base/error.h"
#include "base/npy_file.h"
#include "base/upper_median.h"
#include "bench/survey/picture_sheet.h"
#include "image/any_image.h"
#include "image/output_images.h"
#include "survey/relief/depth_map.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

namespace aphotic {
namespace {

namespace fs = std::filesystem;

struct Options {
    fs::path masks;
    std::vector<std::string> corrections;  // NAME=DIR
    fs::path depths;
    double noise_m = 0.0;
    fs::path noisy;
    fs::path picture;
    std::string show;
};

std::vector<fs::path> images_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".exr") files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

void write_noisy(const Options& options) {
    std::mt19937 engine(1);
    std::normal_distribution<float> noise(0.0F, static_cast<float>(options.noise_m));
    fs::create_directories(options.noisy);
    for (const fs::path& file : images_in(options.depths)) {
        DepthMap map = read_depth_map(file);
        for (float& depth_m : map.depth_m) depth_m += noise(engine);
        write_npy(options.noisy / (file.stem().string() + ".npy"),
                  {static_cast<std::size_t>(map.height_px), static_cast<std::size_t>(map.width_px)},
                  map.depth_m);
    }
}

std::vector<float> mask_of(const Options& options, const fs::path& image) {
    const fs::path file = options.masks / (image.stem().string() + ".mask.png");
    return open_any_image(file).samples(0);
}

std::array<double, 3> medians_of(const fs::path& folder, const Options& options) {
    std::array<double, 3> medians{};
    for (std::size_t c = 0; c < medians.size(); ++c) {
        std::vector<float> all;
        for (const fs::path& file : images_in(folder)) {
            const CameraImage image = read_signals(file);
            const std::vector<float> mask = mask_of(options, file);
            for (std::size_t i = 0; i < mask.size(); ++i)
                if (mask[i] == 0.0F) all.push_back(image.samples[c * mask.size() + i]);
        }
        medians[c] = upper_median(all);
    }
    return medians;
}

void judge(const std::string& name, const fs::path& folder, const Options& options) {
    const std::array<double, 3> medians = medians_of(folder, options);
    std::array<double, 3> squares{};
    double pixels = 0.0;
    for (const fs::path& file : images_in(folder)) {
        const CameraImage image = read_signals(file);
        const std::vector<float> mask = mask_of(options, file);
        for (std::size_t i = 0; i < mask.size(); ++i) {
            if (mask[i] != 0.0F) continue;
            pixels += 1.0;
            for (std::size_t c = 0; c < squares.size(); ++c)
                squares[c] += std::pow(image.samples[c * mask.size() + i] / medians[c] - 1.0, 2);
        }
    }
    constexpr double kPerCent = 100.0;
    fmt::print("| {} |", name);
    for (const double square : squares)
        fmt::print(" {:.2f} |", kPerCent * std::sqrt(square / pixels));
    fmt::print("\n");
}

// Medians become grey.
survey::SheetColumn column_of(const fs::path& folder, const Options& options) {
    survey::SheetColumn column{.images = {read_signals(folder / (options.show + ".exr"))},
                               .scale = medians_of(folder, options)};
    for (double& scale : column.scale) scale = survey::kShownGrey / scale;
    return column;
}

void run(const Options& options) {
    if (!options.noisy.empty()) write_noisy(options);
    if (options.corrections.empty()) return;
    fmt::print("| correction | R | G | B |\n|---|---|---|---|\n");
    std::vector<survey::SheetColumn> columns;
    for (const std::string& words : options.corrections) {
        const std::size_t equals = words.find('=');
        if (equals == std::string::npos) throw InputError("found \"{}\"; allowed: NAME=DIR", words);
        judge(words.substr(0, equals), words.substr(equals + 1), options);
        if (!options.picture.empty())
            columns.push_back(column_of(words.substr(equals + 1), options));
    }
    if (!columns.empty()) survey::write_sheet(columns, options.picture);
}

}  // namespace
}  // namespace aphotic

int main(int argc, char** argv) {
    CLI::App app("How even corrections leave a sea floor with relief");
    aphotic::Options options;
    app.add_option("MASKS", options.masks)->required();
    app.add_option("CORRECTIONS", options.corrections);
    app.add_option("--depths", options.depths);
    app.add_option("--noise", options.noise_m);
    app.add_option("--write", options.noisy);
    app.add_option("--picture", options.picture);
    app.add_option("--show", options.show);
    CLI11_PARSE(app, argc, argv);
    try {
        aphotic::run(options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "judge_relief: %s\n", error.what());
        return 1;
    }
    return 0;
}
