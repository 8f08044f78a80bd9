// SPDX-License-Identifier: BSD-3-Clause
//
// judge SURVEY CARD NAME=DIR ...: the quality of corrections, from a simulated survey's grey chart.
//
// SURVEY is a folder of `aphotic survey`, CARD one of the same poses over the bare grey card, DIR
// one of corrected images: files with the names of the survey's, and any suffix. Prints a table in
// Markdown, a row for each NAME; --json prints the same as JSON. NAME=SURVEY/truth is the row
// without correction.
//
// --picture FILE shows the images of --show side by side: a row for each of them, a column for each
// NAME. Every column has one exposure and one white balance, by which the light tiles of its images
// are grey on average, so differences within a column are those of the corrected images.
#include "base/error.h"
#include "bench/survey/chart.h"
#include "bench/survey/picture_sheet.h"
#include "image/any_image.h"
#include "image/output_images.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace aphotic::survey {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Options {
    std::string survey;
    std::string card;
    std::vector<std::string> corrections;  // NAME=DIR
    int images = 0;
    std::string picture;
    std::vector<std::string> show;
    bool json = false;
};

struct Correction {
    std::string name;
    fs::path folder;
};

Correction correction_of(const std::string& words) {
    const std::size_t equals = words.find('=');
    if (equals == std::string::npos || equals == 0 || !fs::is_directory(words.substr(equals + 1))) {
        throw InputError(
            fmt::format("found \"{}\"; allowed: NAME=DIR, a folder of corrected images", words));
    }
    return {.name = words.substr(0, equals), .folder = words.substr(equals + 1)};
}

// The image of that name: the first image, in alphabetical order, whose name begins with it.
fs::path image_in(const fs::path& folder, const std::string& name) {
    static const std::set<std::string> kSuffixes{".exr", ".png", ".tif", ".tiff"};
    for (const std::string& suffix : kSuffixes) {
        if (fs::path file = folder / (name + suffix); fs::exists(file)) return file;
    }
    throw InputError(fmt::format("{}: found no image {}; allowed: one of {}",
                                 folder.string(),
                                 name,
                                 "its name and .exr, .png, .tif or .tiff"));
}

// The first three channels of an image of any format; integers are scaled to 0..1.
CameraImage read_image(const fs::path& file) {
    const AnyImage any = open_any_image(file);
    if (any.channels.size() < kChannels) {
        throw InputError(fmt::format(
            "{}: found {} channels; allowed: R, G and B", file.string(), any.channels.size()));
    }
    CameraImage image{
        .width_px = any.width_px, .height_px = any.height_px, .samples = any.planes()};
    image.samples.resize(kChannels * image.samples.size() / any.channels.size());
    return image;
}

// The charts of a survey's first images, by the images' names.
using Charts = std::map<std::string, std::vector<Tile>>;

// Some pixels of a floor without a chart still resemble it.
bool has_chart(const std::vector<Tile>& tiles) {
    constexpr double kLeastShare = 0.01;
    const auto some = static_cast<double>(tiles.size()) -
                      static_cast<double>(std::ranges::count(tiles, Tile::None));
    return some >= kLeastShare * static_cast<double>(tiles.size());
}

Charts charts_of(const Options& options) {
    Charts charts;
    for (const auto& entry : fs::directory_iterator(fs::path(options.card) / "truth")) {
        const std::string name = entry.path().stem().string();
        if (options.images > 0 && std::stoi(name) > options.images) continue;
        std::vector<Tile> chart =
            find_chart(read_signals(fs::path(options.survey) / "truth" / (name + ".exr")),
                       read_signals(entry.path()));
        if (has_chart(chart)) charts[name] = std::move(chart);
    }
    if (charts.empty()) {
        throw InputError(fmt::format(
            "{}: found no image with a chart; allowed: a survey of scenes/survey, and {} of the "
            "same over the card",
            options.survey,
            options.card));
    }
    return charts;
}

std::map<std::string, ChartScore> scores_of(const Correction& correction, const Charts& charts) {
    std::map<std::string, ChartScore> scores;
    for (const auto& [name, tiles] : charts) {
        const fs::path file = image_in(correction.folder, name);
        const CameraImage image = read_image(file);
        if (image.samples.size() != kChannels * tiles.size()) {
            throw InputError(fmt::format("{}: found {} x {} pixels; allowed: the survey's",
                                         file.string(),
                                         image.width_px,
                                         image.height_px));
        }
        scores[name] = score_chart(image, tiles);
    }
    return scores;
}

SurveyScore total_of(const std::map<std::string, ChartScore>& scores) {
    std::vector<ChartScore> all;
    for (const auto& [name, score] : scores) all.push_back(score);
    return summed_up(all);
}

Json json_of(const SurveyScore& score) {
    return {{"images", score.images},
            {"unevenness", score.unevenness},
            {"worst_unevenness", score.worst_unevenness},
            {"tone", score.tone},
            {"colour_spread", score.colour_spread},
            {"level_spread", score.level_spread},
            {"degrees_from_grey", score.degrees}};
}

void print_row(const std::string& name, const SurveyScore& score) {
    fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.3f} | {:.2f} | {:.2f} | {:.2f} |\n",
               name,
               score.images,
               100.0 * score.unevenness,
               100.0 * score.worst_unevenness,
               score.tone,
               100.0 * score.colour_spread,
               100.0 * score.level_spread,
               score.degrees);
}

// The light tiles of the shown images are grey on average, sand somewhat lighter.
std::array<double, kChannels> scale_of(const std::map<std::string, ChartScore>& scores,
                                       const std::vector<std::string>& show) {
    std::array<double, kChannels> scale{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        double sum = 0.0;
        for (const std::string& name : show) sum += scores.at(name).light[c];
        scale[c] = kShownGrey * static_cast<double>(show.size()) / sum;
    }
    return scale;
}

void write_picture(const Options& options,
                   const std::vector<Correction>& corrections,
                   const std::vector<std::map<std::string, ChartScore>>& scores) {
    std::vector<SheetColumn> columns;
    for (std::size_t i = 0; i < corrections.size(); ++i) {
        columns.push_back({.scale = scale_of(scores[i], options.show)});
        for (const std::string& name : options.show)
            columns.back().images.push_back(read_image(image_in(corrections[i].folder, name)));
    }
    write_sheet(columns, options.picture);
}

void judge(const Options& options) {
    std::vector<Correction> corrections;
    for (const std::string& words : options.corrections)
        corrections.push_back(correction_of(words));
    const Charts charts = charts_of(options);
    for (const std::string& name : options.show) {
        if (!charts.contains(name)) {
            throw InputError(fmt::format("--show: found {}; allowed: an image with a chart", name));
        }
    }
    std::vector<std::map<std::string, ChartScore>> scores;
    Json json = Json::object();
    for (const Correction& correction : corrections) {
        scores.push_back(scores_of(correction, charts));
        json[correction.name] = json_of(total_of(scores.back()));
    }
    if (!options.picture.empty()) write_picture(options, corrections, scores);
    if (options.json) {
        fmt::print("{}\n", json.dump(2));
        return;
    }
    fmt::print(
        "| correction | images | unevenness, % rms | worst, % | tone | colour over altitude, "
        "% | level over altitude, % | degrees from grey |\n|---|---|---|---|---|---|---|---|\n");
    for (std::size_t i = 0; i < scores.size(); ++i) {
        print_row(corrections[i].name, total_of(scores[i]));
    }
}

}  // namespace
}  // namespace aphotic::survey

int main(int argc, char** argv) {
    aphotic::survey::Options options;
    CLI::App app{"What corrections made of a simulated survey's grey chart."};
    app.add_option("SURVEY", options.survey, "a folder of `aphotic survey`")
        ->required()
        ->check(CLI::ExistingDirectory);
    app.add_option("CARD", options.card, "the same over the bare card")
        ->required()
        ->check(CLI::ExistingDirectory);
    app.add_option("CORRECTION", options.corrections, "NAME=DIR: a folder of corrected images")
        ->required();
    app.add_option("--images", options.images, "use the survey's first N images; 0: all");
    auto* picture = app.add_option("--picture", options.picture, "the images side by side, as PNG")
                        ->type_name("FILE")
                        ->check([](const std::string& file) {
                            return file.ends_with(".png")
                                       ? std::string()
                                       : file + ": allowed: a name that ends in .png";
                        });
    app.add_option("--show", options.show, "names of images for the picture, such as 000001")
        ->delimiter(',')
        ->needs(picture);
    app.add_flag("--json", options.json, "the table as JSON");
    try {
        app.parse(argc, argv);
        if (!options.picture.empty() && options.show.empty()) options.show = {"000001"};
        aphotic::survey::judge(options);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "judge: {}\n", error.what());
        return dynamic_cast<const aphotic::InputError*>(&error) != nullptr ? 2 : 3;
    }
    return 0;
}
