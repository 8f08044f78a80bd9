// SPDX-License-Identifier: BSD-3-Clause
#include "validation/study.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/page.h"
#include "support/small_scene.h"
#include "support/small_study.h"
#include "support/temp_folder.h"
#include "validation/study_plot.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <regex>
#include <set>
#include <stdexcept>
#include <tuple>

namespace aphotic::study_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Rig rig_of(const std::string& scene) {
    return read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/" + scene);
}

Rig rig_of_size(int width_px, int height_px) {
    Rig rig = rig_of("habcam.toml");
    rig.camera.width_px = width_px;
    rig.camera.height_px = height_px;
    return rig;
}

StudyMeasure plain_measure(double time_s, double max_error) {
    return measure_of({}, time_s, max_error);
}

bool has(const std::vector<StudySetting>& settings, std::string_view name) {
    return std::ranges::any_of(settings, [&](const auto& setting) { return setting.name == name; });
}

// Settings.

TEST(StudySettings, AreUniqueAndHavePlainNames) {
    const std::regex plain_name("[a-z0-9]+(-[a-z0-9]+)*");
    for (const fs::path& scene : all_scenes()) {
        const Rig rig = read_rig(scene);
        for (const int cores : {1, 2, 64}) {
            for (const bool quick : {false, true}) {
                std::set<std::string> names;
                std::set<decltype(content_of({}))> contents;
                for (const StudySetting& setting : study_settings(rig, quick, cores)) {
                    EXPECT_TRUE(std::regex_match(setting.name, plain_name)) << setting.name;
                    EXPECT_TRUE(names.insert(setting.name).second) << setting.name;
                    EXPECT_TRUE(contents.insert(content_of(setting)).second) << setting.name;
                    EXPECT_NE(setting.words, "");
                    EXPECT_NE(setting.subject, "");
                    EXPECT_NE(setting.fitted > 0, setting.bands > 0) << setting.name;
                    EXPECT_EQ(setting.shrink > 1, !setting.filter.empty()) << setting.name;
                }
            }
        }
    }
}

TEST(StudySettings, StartWithTheBaselineAndHaveWhatItIsHeldAgainst) {
    const Rig rig = rig_of("habcam.toml");
    for (const bool quick : {false, true})
        EXPECT_EQ(study_settings(rig, quick, 2).front().name, kBaseline);
    const auto settings = study_settings(rig, false, 2);
    EXPECT_TRUE(has(settings, kCustomary));
    EXPECT_TRUE(has(settings, kCustomaryMono));
    EXPECT_LT(study_settings(rig, true, 2).size(), settings.size() / 2);
}

TEST(StudySettings, CoverEverySubject) {
    std::set<std::string> subjects;
    for (const StudySetting& s : study_settings(rig_of("habcam-emitters.toml"), false, 2))
        subjects.insert(s.subject);
    EXPECT_EQ(
        subjects,
        (std::set<std::string>{
            "wavelengths", "packing", "resolution", "emitters", "frames", "antialiasing", "jobs"}));
}

TEST(StudySettings, LeaveOutWhatWouldRepeatAnother) {
    for (const StudySetting& setting : study_settings(rig_of("habcam.toml"), false, 1)) {
        EXPECT_FALSE(setting.one_soft_lamp) << "no emitter: " << setting.name;
        EXPECT_NE(setting.subject, "jobs") << "one core: " << setting.name;
    }
    EXPECT_TRUE(has(study_settings(rig_of("habcam.toml"), false, 2), "bands-12-jobs-1"));
}

TEST(StudySettings, ShrinkOnlyWhatDivides) {
    const auto shrinks = [](int width_px, int height_px) {
        std::map<int, int> counts;
        for (const StudySetting& s : study_settings(rig_of_size(width_px, height_px), false, 2))
            ++counts[s.shrink];
        counts.erase(1);
        return counts;
    };
    EXPECT_EQ(shrinks(1360, 1024), (std::map<int, int>{{2, 3}, {4, 3}}));
    EXPECT_EQ(shrinks(1362, 1024), (std::map<int, int>{{2, 3}}));
    EXPECT_EQ(shrinks(1360, 1023), (std::map<int, int>{}));
    EXPECT_EQ(shrinks(681, 512), (std::map<int, int>{}));
}

// The size of a quick study.

TEST(QuickRig, KeepsTheFieldOfViewOfEveryScene) {
    for (const fs::path& scene : all_scenes()) {
        const Rig rig = read_rig(scene);
        const Camera small = quick_rig(rig).camera;
        const bool is_slow = rig.camera.port || rig.strobes[0].emitter;
        EXPECT_LE(small.width_px * small.height_px, is_slow ? 90'000 : 350'000) << scene;
        const int own = rig.camera.width_px * rig.camera.height_px;
        EXPECT_GE(small.width_px * small.height_px, std::min(own, is_slow ? 30'000 : 100'000))
            << scene;
        EXPECT_DOUBLE_EQ(small.width_px * small.pixel_pitch_m,
                         rig.camera.width_px * rig.camera.pixel_pitch_m)
            << scene;
        EXPECT_DOUBLE_EQ(small.height_px * small.pixel_pitch_m,
                         rig.camera.height_px * rig.camera.pixel_pitch_m)
            << scene;
        EXPECT_EQ(small.focal_length_m, rig.camera.focal_length_m) << scene;
    }
}

TEST(QuickRig, OfASmallImageIsTheRigItself) {
    const Rig rig = rig_of("one-lamp.toml");
    const Rig quick = quick_rig(rig);
    EXPECT_EQ(quick.camera.width_px, rig.camera.width_px);
    EXPECT_EQ(quick.camera.height_px, rig.camera.height_px);
    EXPECT_EQ(quick.camera.pixel_pitch_m, rig.camera.pixel_pitch_m);
}

// A third is small enough, but only a quarter divides 1000.
TEST(QuickRig, PrefersADivisorNearby) {
    const Rig rig = rig_of_size(1500, 1000);
    const Camera small = quick_rig(rig).camera;
    EXPECT_EQ(small.width_px, 375);
    EXPECT_EQ(small.height_px, 250);
    EXPECT_DOUBLE_EQ(small.pixel_pitch_m, 4.0 * rig.camera.pixel_pitch_m);
}

// 1361 and 1021 are prime. 1364 x 1023 has 11 as its least divisor, which would leave 124 x 93.
TEST(QuickRig, LosesLessThanAPixelWhereTheSizeDoesNotDivide) {
    for (const auto& [width_px, height_px] : {std::pair(1361, 1021), std::pair(1364, 1023)}) {
        const Rig rig = rig_of_size(width_px, height_px);
        const Camera small = quick_rig(rig).camera;
        const double pitch = small.pixel_pitch_m / rig.camera.pixel_pitch_m;
        for (const double lost :
             {width_px - pitch * small.width_px, height_px - pitch * small.height_px}) {
            EXPECT_GE(lost, -1e-9) << width_px;
            EXPECT_LT(lost, pitch) << width_px;
        }
        EXPECT_GT(small.width_px * small.height_px, 100'000) << width_px;
    }
}

// Comparing.

constexpr int kWidth_px = 5;
constexpr int kHeight_px = 4;
constexpr std::size_t kPixels = 20;

CameraImage even_image(float r, float g, float b) {
    CameraImage image{.width_px = kWidth_px, .height_px = kHeight_px, .samples = {}};
    for (const float value : {r, g, b}) image.samples.insert(image.samples.end(), kPixels, value);
    return image;
}

TEST(CompareSignals, FindsAPlantedErrorInItsChannelAndPlace) {
    const CameraImage reference = even_image(1.0F, 2.0F, 4.0F);
    CameraImage image = reference;
    image.samples[kPixels + 2 * kWidth_px + 3] *= 1.25F;
    const auto channels = compare_signals(image, reference, {});
    EXPECT_EQ(channels[0].max_error, 0.0);
    EXPECT_EQ(channels[1].max_error, 0.25);
    EXPECT_EQ(channels[2].max_error, 0.0);
    EXPECT_EQ(channels[1].column, 3);
    EXPECT_EQ(channels[1].row, 2);
    EXPECT_EQ(channels[1].compared, kPixels);
    EXPECT_EQ(channels[0].name, "R");
    EXPECT_EQ(channels[1].name, "G");
    EXPECT_EQ(channels[2].name, "B");
}

TEST(CompareSignals, SetsEdgesApart) {
    const CameraImage reference = even_image(1.0F, 2.0F, 4.0F);
    CameraImage image = reference;
    image.samples[2 * kPixels + 6] *= 1.5F;
    std::vector<unsigned char> on_edge(kPixels, 0);
    on_edge[6] = 1;
    const auto channels = compare_signals(image, reference, on_edge);
    EXPECT_EQ(channels[2].max_error, 0.0);
    EXPECT_EQ(channels[2].max_error_on_edges, 0.5);
    EXPECT_EQ(channels[2].on_edges, 1U);
    EXPECT_EQ(channels[2].compared, kPixels - 1);
}

// Black is 1e-8 of the brightest, 4: a difference of 4e-9 beside nothing is a tenth of it.
TEST(CompareSignals, MeasuresBlackAgainstTheBrightest) {
    CameraImage reference = even_image(1.0F, 1.0F, 4.0F);
    reference.samples[2 * kPixels] = 0.0F;
    CameraImage image = reference;
    image.samples[2 * kPixels] = 4e-9F;
    EXPECT_NEAR(compare_signals(image, reference, {})[2].max_error, 0.1, 1e-7);
}

TEST(CompareSignals, OfDifferentSizesIsOurMistake) {
    const CameraImage reference = even_image(1.0F, 1.0F, 1.0F);
    CameraImage turned = reference;
    std::swap(turned.width_px, turned.height_px);
    EXPECT_THROW((void)compare_signals(turned, reference, {}), std::logic_error);
    CameraImage cut = reference;
    cut.samples.pop_back();
    EXPECT_THROW((void)compare_signals(cut, reference, {}), std::logic_error);
    const std::vector<unsigned char> on_edge(kPixels - 1, 0);
    EXPECT_THROW((void)compare_signals(reference, reference, on_edge), std::logic_error);
}

// Measures.

TEST(StudyMeasure, IsOfItsWorstChannel) {
    StudyMeasure measure = plain_measure(4.0, 0.02);
    measure.channels[0].percentile_999 = 0.015;
    measure.channels[2].max_error_on_edges = 0.75;
    EXPECT_EQ(measure.total_s(), 4.0);
    EXPECT_EQ(measure.max_error(), 0.02);
    EXPECT_EQ(measure.percentile_999(), 0.9 * 0.02);
    EXPECT_EQ(measure.rms_error(), 0.3 * 0.02);
    EXPECT_EQ(measure.max_error_on_edges(), 0.75);
    measure.channels[0].percentile_999 = 0.019;
    EXPECT_EQ(measure.percentile_999(), 0.019);
}

// No error was found, but nothing was looked at either.
TEST(StudyMeasure, OfNothingIsInfinitelyWrong) {
    StudyMeasure not_finite = plain_measure(1.0, 0.0);
    not_finite.channels[1].not_finite = 1;
    StudyMeasure all_on_edges = plain_measure(1.0, 0.0);
    all_on_edges.channels[2].compared = 0;
    for (const StudyMeasure& measure : {not_finite, all_on_edges, StudyMeasure{}}) {
        EXPECT_EQ(measure.max_error(), kInfinity);
        const std::vector<StudyMeasure> measures{measure};
        EXPECT_EQ(pareto_front(measures), std::vector<bool>{false});
        EXPECT_FALSE(recommended(measures, 1.0));
    }
}

TEST(StudyMeasure, HasNoPromiseForWhatThePlanDoesNotKnow) {
    for (const StudySetting& setting : study_settings(rig_of("habcam-emitters.toml"), false, 2)) {
        const bool known = setting.subject == "wavelengths" || setting.subject == "packing" ||
                           setting.subject == "jobs";
        EXPECT_EQ(measure_of(setting, 1.0, 1.0).promise_applies(), known) << setting.name;
    }
}

// Few different values, so that there are ties in one of the two and in both.
std::vector<StudyMeasure> random_measures(std::mt19937& random, int count) {
    std::uniform_int_distribution<int> step(1, 12);
    std::vector<StudyMeasure> measures;
    for (int i = 0; i < count; ++i)
        measures.push_back(plain_measure(step(random), 0.125 * step(random)));
    return measures;
}

// From the fastest on, the front is where no error so far was as small; by another way than
// comparing all with all.
TEST(ParetoFront, OfRandomPointsIsWhatASweepFinds) {
    std::mt19937 random(7);
    for (int round = 0; round < 200; ++round) {
        const std::vector<StudyMeasure> measures = random_measures(random, 1 + round % 40);
        std::map<double, double> least_by_time;
        for (const StudyMeasure& m : measures) {
            const auto at = least_by_time.try_emplace(m.total_s(), m.max_error()).first;
            at->second = std::min(at->second, m.max_error());
        }
        std::set<std::pair<double, double>> expected;
        double least = kInfinity;
        for (const auto& [time_s, error] : least_by_time) {
            if (error < least) expected.emplace(time_s, error);
            least = std::min(least, error);
        }
        const std::vector<bool> front = pareto_front(measures);
        ASSERT_EQ(front.size(), measures.size());
        for (std::size_t i = 0; i < measures.size(); ++i) {
            const std::pair point(measures[i].total_s(), measures[i].max_error());
            EXPECT_EQ(front[i], expected.contains(point))
                << "round " << round << ": " << point.first << " s, " << point.second;
        }
    }
}

TEST(ParetoFront, KeepsBothOfATie) {
    const std::vector<StudyMeasure> measures{
        plain_measure(2.0, 0.5), plain_measure(2.0, 0.5), plain_measure(2.0, 0.75)};
    EXPECT_EQ(pareto_front(measures), (std::vector<bool>{true, true, false}));
    EXPECT_TRUE(pareto_front({}).empty());
}

TEST(Recommended, IsTheFastestWithinTheTolerance) {
    const std::vector<StudyMeasure> measures{plain_measure(9.0, 1e-4),
                                             plain_measure(3.0, 2e-3),
                                             plain_measure(5.0, 1e-3),
                                             plain_measure(7.0, 5e-4)};
    EXPECT_EQ(recommended(measures, 1e-3), 2U) << "its very error";
    EXPECT_EQ(recommended(measures, 9e-4), 3U);
    EXPECT_EQ(recommended(measures, 1.0), 1U);
    EXPECT_EQ(recommended(measures, 9e-5), std::nullopt);
    EXPECT_EQ(recommended({}, 1.0), std::nullopt);
}

TEST(Recommended, IsOnTheFront) {
    std::mt19937 random(11);
    for (int round = 0; round < 100; ++round) {
        const std::vector<StudyMeasure> measures = random_measures(random, 1 + round % 30);
        const auto best = recommended(measures, 0.5);
        for (const StudyMeasure& m : measures) {
            if (m.max_error() > 0.5) continue;
            ASSERT_TRUE(best);
            EXPECT_LE(measures[*best].total_s(), m.total_s());
        }
        if (best) {
            EXPECT_LE(measures[*best].max_error(), 0.5);
            EXPECT_TRUE(pareto_front(measures)[*best]);
        }
    }
}

TEST(TimeRatio, IsNothingWhereEitherIsMissing) {
    Study study = small_study();
    const double ratio = find_measure(study.measures, "bands-36")->total_s() /
                         find_measure(study.measures, "fitted-3")->total_s();
    EXPECT_EQ(time_ratio(study.measures, kCustomary, kBaseline), ratio);
    EXPECT_EQ(time_ratio(study.measures, kBaseline, kBaseline), 1.0);
    EXPECT_EQ(time_ratio(study.measures, "bands-37", kBaseline), std::nullopt);
    EXPECT_EQ(time_ratio(study.measures, kBaseline, "bands-37"), std::nullopt);
}

// The files.

std::string written(const Study& study, const std::string& name) {
    const TempFolder folder;
    write_study(study, folder.path());
    return read_text_file(folder.path() / name);
}

// RFC 4180, one line a row.
std::vector<std::string> fields_of(const std::string& line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const bool doubled = quoted && line[i] == '"' && i + 1 < line.size() && line[i + 1] == '"';
        if (doubled) {
            fields.back() += line[++i];
        } else if (line[i] == '"') {
            quoted = !quoted;
        } else if (line[i] == ',' && !quoted) {
            fields.emplace_back();
        } else {
            fields.back() += line[i];
        }
    }
    return fields;
}

std::vector<std::map<std::string, std::string>> csv_of(const Study& study) {
    std::istringstream text(written(study, "study.csv"));
    std::string line;
    std::getline(text, line);
    const std::vector<std::string> names = fields_of(line);
    std::vector<std::map<std::string, std::string>> rows;
    while (std::getline(text, line)) {
        const std::vector<std::string> fields = fields_of(line);
        EXPECT_EQ(fields.size(), names.size()) << line;
        std::map<std::string, std::string> row;
        for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = fields[i];
        EXPECT_EQ(row.size(), names.size()) << "columns of the same name";
        rows.push_back(row);
    }
    return rows;
}

TEST(StudyCsv, HasARowAMeasureAndEveryNumber) {
    const Study study = small_study();
    const auto rows = csv_of(study);
    ASSERT_EQ(rows.size(), study.measures.size());
    const std::vector<bool> front = pareto_front(study.measures);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const StudyMeasure& m = study.measures[i];
        auto row = rows[i];
        EXPECT_EQ(row["name"], m.setting.name);
        EXPECT_EQ(row["subject"], m.setting.subject);
        EXPECT_EQ(row["words"], m.setting.words);
        EXPECT_EQ(row["filter"], m.setting.filter);
        EXPECT_EQ(std::stoi(row["shrink"]), m.setting.shrink);
        EXPECT_EQ(std::stoi(row["jobs"]), m.setting.jobs);
        EXPECT_EQ(row["png"], m.setting.png ? "true" : "false");
        EXPECT_EQ(std::stoul(row["wavelengths"]), m.wavelengths);
        EXPECT_EQ(std::stoul(row["frames"]), m.frames);
        EXPECT_EQ(std::stod(row["render_s"]), m.render_s);
        EXPECT_EQ(std::stod(row["integrate_s"]), m.integrate_s);
        EXPECT_EQ(std::stod(row["total_s"]), m.total_s());
        EXPECT_EQ(std::stod(row["time_ratio"]), m.total_s() / study.measures[0].total_s());
        EXPECT_EQ(std::stod(row["max_error"]), m.max_error());
        EXPECT_EQ(std::stod(row["percentile_999"]), m.percentile_999());
        EXPECT_EQ(std::stod(row["rms_error"]), m.rms_error());
        EXPECT_EQ(std::stod(row["max_error_on_edges"]), 0.25);
        EXPECT_EQ(std::stod(row["max_error_B"]), m.channels[2].max_error);
        EXPECT_EQ(std::stod(row["mean_error_R"]), m.channels[0].mean_error);
        EXPECT_EQ(row["on_front"], front[i] ? "true" : "false");
        EXPECT_EQ(row["promise"].empty(), !m.promise_applies());
    }
}

TEST(StudyCsv, QuotesWhatNeedsIt) {
    Study study = small_study();
    study.measures[0].setting.words = "3, \"fitted\"";
    const std::string text = written(study, "study.csv");
    EXPECT_TRUE(contains(text, "fitted-3,wavelengths,\"3, \"\"fitted\"\"\",3,0,"));
    EXPECT_EQ(csv_of(study)[0]["words"], "3, \"fitted\"");
}

TEST(StudyCsv, WritesInfForWhatIsNotFinite) {
    Study study = small_study();
    study.measures[3].channels[0].not_finite = 1;
    EXPECT_EQ(csv_of(study)[3]["max_error"], "inf");
}

TEST(StudyJson, AgreesWithTheStudy) {
    const Study study = small_study();
    const Json json = Json::parse(written(study, "study.json"));
    EXPECT_EQ(json["rig"]["title"], study.rig_title);
    EXPECT_EQ(json["rig"]["sha256"], study.rig_sha256);
    EXPECT_EQ(json["image"]["width_px"], 1360);
    EXPECT_EQ(json["image"]["height_px"], 1024);
    EXPECT_EQ(json["versions"]["aphotic"], "1.2.3");
    EXPECT_EQ(json["versions"]["povray"], "3.7.0.10");
    EXPECT_EQ(json["cores"], 2);
    EXPECT_EQ(json["quick"], false);
    EXPECT_EQ(json["tolerance"], 1e-3);
    EXPECT_EQ(json["reference"]["wavelengths"], 398);
    EXPECT_EQ(json["reference"]["time_s"], 54.25);
    EXPECT_EQ(json["recommended"], "fitted-3");
    const auto time_s = [&](std::string_view name) {
        return find_measure(study.measures, name)->total_s();
    };
    EXPECT_EQ(json["time_ratios"]["bands-36 / fitted-3"], time_s("bands-36") / time_s("fitted-3"));
    EXPECT_EQ(json["time_ratios"]["bands-36-mono / fitted-3"],
              time_s("bands-36-mono") / time_s("fitted-3"));
    ASSERT_EQ(json["measures"].size(), study.measures.size());
    const std::vector<bool> front = pareto_front(study.measures);
    for (std::size_t i = 0; i < front.size(); ++i) {
        const Json& entry = json["measures"][i];
        const StudyMeasure& m = study.measures[i];
        EXPECT_EQ(entry["name"], m.setting.name);
        EXPECT_EQ(entry["setting"]["filter"], m.setting.filter);
        EXPECT_EQ(entry["setting"]["one_soft_lamp"], m.setting.one_soft_lamp);
        EXPECT_EQ(entry["frames"], m.frames);
        EXPECT_EQ(entry["promise"].is_null(), !m.promise_applies());
        EXPECT_EQ(entry["time_s"]["render"], m.render_s);
        EXPECT_EQ(entry["time_s"]["integrate"], m.integrate_s);
        EXPECT_EQ(entry["time_s"]["total"], m.total_s());
        EXPECT_EQ(entry["time_ratio"], m.total_s() / time_s("fitted-3"));
        EXPECT_EQ(entry["on_front"], static_cast<bool>(front[i]));
        EXPECT_EQ(entry["max_error"], m.max_error());
        EXPECT_EQ(entry["percentile_999"], m.percentile_999());
        EXPECT_EQ(entry["rms_error"], m.rms_error());
        EXPECT_EQ(entry["max_error_on_edges"], m.max_error_on_edges());
        EXPECT_EQ(entry["channels"][1]["name"], "G");
        EXPECT_EQ(entry["channels"][1]["max_error"], m.channels[1].max_error);
    }
}

TEST(StudyJson, WritesNullForWhatIsNotThere) {
    Study study = small_study();
    study.tolerance = 1e-9;
    study.measures.resize(2);
    study.measures[1].channels[1].not_finite = 1;
    const Json json = Json::parse(written(study, "study.json"));
    EXPECT_TRUE(json["recommended"].is_null());
    EXPECT_TRUE(json["time_ratios"]["bands-36 / fitted-3"].is_null());
    EXPECT_TRUE(json["measures"][1]["max_error"].is_null());
    EXPECT_EQ(json["measures"][1]["channels"][1]["not_finite"], 1);
}

TEST(StudyJson, ReadsBackAnyTitle) {
    Study study = small_study();
    study.rig_title = "\"quoted\" \\ <b>\n\x01 深海";
    EXPECT_EQ(Json::parse(written(study, "study.json"))["rig"]["title"], study.rig_title);
    study.rig_title = "not UTF-8: \xff";
    EXPECT_EQ(Json::parse(written(study, "study.json"))["rig"]["title"], "not UTF-8: �");
}

TEST(Study, ThatCannotBeWrittenIsARunErrorThatNamesTheFile) {
    const TempFolder folder;
    try {
        write_study(small_study(), folder.path() / "missing");
        FAIL() << "no error";
    } catch (const RunError& error) {
        EXPECT_TRUE(contains(error.what(), (folder.path() / "missing" / "study").string()))
            << error.what();
    }
}

// study.html

constexpr const char* kTimes = "\xC2\xA0×\xC2\xA0";  // between blanks that do not break

TEST(StudyPage, HasEveryMeasureInWordsAndNumbers) {
    const Study study = small_study();
    const std::string words = words_of(study_page(study));
    for (const StudyMeasure& measure : study.measures)
        EXPECT_TRUE(contains(words, measure.setting.words)) << measure.setting.words;
    for (const char* part : {"HabCam, strobes of finite size",
                             "24 settings",
                             "1360 × 1024 pixels",
                             "Aphotic 1.2.3",
                             "POV-Ray 3.7.0.10",
                             "2 cores",
                             "398 wavelengths",
                             "54.2\xC2\xA0s",
                             "★ recommended",
                             "✓ front"})
        EXPECT_TRUE(contains(words, part)) << part;
}

// 3.86 s and 41.92 s: 10.86 times.
TEST(StudyPage, RecommendsInASentence) {
    const std::string words = words_of(study_page(small_study()));
    EXPECT_TRUE(contains(words,
                         "For 10⁻³ the cheapest setting is 3 fitted wavelengths: 3.86\xC2\xA0s, "
                         "largest error 5.10" +
                             std::string(kTimes) + "10⁻⁴, 10.9 times as fast as 36 equal bands."))
        << words;
    EXPECT_TRUE(contains(words,
                         "36 equal bands take 10.9 times as long as 3 fitted wavelengths, with one "
                         "wavelength a frame 25.6 times."));
}

TEST(StudyPage, SaysTheToleranceAsItWasAskedFor) {
    Study study = small_study();
    for (const auto& [tolerance, text] : {std::pair(2e-3, "For 2" + std::string(kTimes) + "10⁻³ "),
                                          std::pair(0.05, std::string("For 0.05 the cheapest")),
                                          std::pair(1e-2, std::string("For 0.01 the cheapest")),
                                          std::pair(1.0, std::string("For 1 the cheapest"))}) {
        study.tolerance = tolerance;
        EXPECT_TRUE(contains(words_of(study_page(study)), text)) << text;
    }
}

TEST(StudyPage, SaysWhenNothingIsGoodEnough) {
    Study study = small_study();
    study.tolerance = 1e-4;
    const std::string words = words_of(study_page(study));
    EXPECT_TRUE(contains(words,
                         "No setting here keeps 10⁻⁴. The closest is 3 fitted wavelengths, 16-bit "
                         "PNG: 4.16\xC2\xA0s, largest error 2.70"))
        << words;
    EXPECT_FALSE(contains(words, "★"));
}

TEST(StudyPage, NeedsNeitherScriptNorOtherFilesNorNetwork) {
    const std::string page = study_page(small_study());
    for (const char* part : {"<script", "<link", "url(", "@import", "src=", "href="})
        EXPECT_FALSE(contains(page, part)) << part;
    EXPECT_TRUE(contains(page, "default-src 'none'"));
}

TEST(StudyPage, EscapesEveryName) {
    Study study = small_study();
    const std::string evil = "</title></svg><script>alert(\"1\" & '2')</script>\x01";
    study.rig_title = evil;
    study.rig_sha256 = evil;
    study.aphotic_version = evil;
    study.povray_version = evil;
    for (StudyMeasure& measure : study.measures) {
        measure.setting.name = evil;
        measure.setting.words = evil;
        measure.setting.subject = evil;
    }
    const std::string page = study_page(study);
    EXPECT_FALSE(contains(page, "<script"));
    EXPECT_FALSE(contains(page, "\x01"));
    EXPECT_FALSE(contains(page, "\"1\" &"));
    EXPECT_EQ(first_unbalanced(page), "");
    EXPECT_TRUE(contains(page,
                         "<h1><bdi>&lt;/title&gt;&lt;/svg&gt;&lt;script&gt;alert(&quot;1&quot; "
                         "&amp; &#39;2&#39;)&lt;/script&gt;�</bdi></h1>"));
}

TEST(StudyPage, IsReproducible) {
    EXPECT_EQ(study_page(small_study()), study_page(small_study()));
}

// Extremes.

TEST(StudyPage, IsWrittenForAnyNumbers) {
    Study nothing = small_study();
    nothing.measures.clear();
    Study one = small_study();
    one.measures.resize(1);
    Study exact = small_study();
    for (StudyMeasure& m : exact.measures) m = measure_of(m.setting, 0.0, 0.0);
    Study broken = small_study();
    for (StudyMeasure& m : broken.measures) {
        m.channels[0].not_finite = 5;
        m.channels[0].mean_error = kNaN;
    }
    Study no_tolerance = small_study();
    no_tolerance.tolerance = 0.0;
    Study no_title = small_study();
    no_title.rig_title = "";
    for (const Study& study : {nothing, one, exact, broken, no_tolerance, no_title}) {
        const std::string page = study_page(study);
        EXPECT_EQ(first_unbalanced(page), "");
        EXPECT_FALSE(contains(page, "nan"));
        EXPECT_FALSE(contains(page, "inf\""));
        EXPECT_FALSE(contains(words_of(page), "inf "));
    }
    EXPECT_TRUE(contains(words_of(study_page(nothing)), "Nothing was measured."));
    EXPECT_TRUE(contains(words_of(study_page(exact)), "24 settings are not drawn"));
    EXPECT_TRUE(contains(words_of(study_page(broken)), "No setting here keeps"));
    EXPECT_TRUE(contains(words_of(study_page(no_title)), "Untitled rig"));
}

// The plot.

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

TEST(StudyPlot, HasAMarkALabelAndATitleForEveryMeasure) {
    const Study study = small_study();
    const std::string svg = study_svg(study);
    EXPECT_EQ(count_of(svg, "<path class=\"dot"), study.measures.size());
    for (const StudyMeasure& measure : study.measures) {
        const std::string label = measure.setting.name;
        EXPECT_EQ(count_of(svg, "class=\"label\">" + label + "</text>") +
                      count_of(svg, "class=\"label strong\">" + label + "</text>"),
                  1U)
            << label;
        EXPECT_TRUE(contains(svg, "<title>" + measure.setting.words + ": "));
    }
    EXPECT_EQ(count_of(svg, "class=\"ring\""), 1U);
    EXPECT_EQ(count_of(svg, "class=\"front\""), 1U);
    EXPECT_EQ(count_of(svg, "class=\"bound\""), 1U);
}

// The tick labels say where the recommended setting's ring must be. All of the measures but the
// one at (4 s, 1e-2) are there to make the axes whole decades.
TEST(StudyPlot, PutsAMarkWhereItsAxesSay) {
    Study study = small_study();
    study.measures = {plain_measure(0.12, 0.9), plain_measure(4.0, 1e-2), plain_measure(90.0, 0.8)};
    study.tolerance = 2e-2;
    const std::string svg = study_svg(study);
    const auto number = [&](const std::string& pattern) {
        std::smatch found;
        EXPECT_TRUE(std::regex_search(svg, found, std::regex(pattern))) << pattern;
        return found.empty() ? kNaN : std::stod(found[1]);
    };
    const auto x_of = [&](const std::string& tick) {
        return number(
            "<text x=\"([0-9.]+)\" y=\"[0-9.]+\" text-anchor=\"middle\" "
            "class=\"tick\">" +
            tick + "</text>");
    };
    const auto y_of = [&](const std::string& tick) {
        constexpr double kBelowItsLine = 4.0;
        return number("<text x=\"[0-9.]+\" y=\"([0-9.]+)\" text-anchor=\"end\" class=\"tick\">" +
                      tick + "</text>") -
               kBelowItsLine;
    };
    constexpr double kDecimals = 0.11;
    EXPECT_NEAR(number("<circle cx=\"([0-9.]+)\""),
                x_of("1") + (x_of("10") - x_of("1")) * std::log10(4.0),
                kDecimals);
    EXPECT_NEAR(number("<circle cx=\"[0-9.]+\" cy=\"([0-9.]+)\""), y_of("0.01"), kDecimals);
}

TEST(StudyPlot, LeavesOutWhatHasNoLogarithm) {
    Study study = small_study();
    study.measures[2] = measure_of(study.measures[2].setting, 1.0, 0.0);
    study.measures[3].channels[0].not_finite = 1;
    const std::string svg = study_svg(study);
    EXPECT_EQ(count_of(svg, "<path class=\"dot"), study.measures.size() - 2);
    EXPECT_TRUE(contains(words_of(study_page(study)), "2 settings are not drawn"));
}

}  // namespace
}  // namespace aphotic::study_test
