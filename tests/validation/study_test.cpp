// SPDX-License-Identifier: BSD-3-Clause
#include "validation/study.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "rig/file/rig_reader.h"
#include "support/page.h"
#include "support/refusal.h"
#include "support/scene_rig.h"
#include "support/small_scene.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <stdexcept>

namespace aphotic::study_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Rig rig_of_size(int width_px, int height_px) {
    Rig rig = habcam();
    rig.camera.width_px = width_px;
    rig.camera.height_px = height_px;
    return rig;
}

StudyMeasure plain_measure(double time_s, double max_error) {
    return {.setting = {.name = "a", .words = "a"},
            .wavelengths = 3,
            .frames = 1,
            .promise = 1.5 * max_error,
            .render_s = 0.75 * time_s,
            .integrate_s = 0.25 * time_s,
            .max_error = max_error,
            .percentile_999 = 0.9 * max_error,
            .rms_error = 0.3 * max_error,
            .max_error_on_edges = 0.25};
}

Study small_study() {
    Study study{.rig_title = "HabCam",
                .rig_sha256 = "12ab",
                .width_px = 1360,
                .height_px = 1024,
                .aphotic_version = "1.2.3",
                .povray_version = "3.7.0.10",
                .cores = 2,
                .grid_size = 398,
                .trace_s = 54.25};
    study.measures = {plain_measure(4.0, 5e-4), plain_measure(2.0, 0.1), plain_measure(3.0, 0.2)};
    study.measures[0].setting = {.name = "fitted-3", .words = "3 fitted wavelengths"};
    study.measures[1].setting = {.name = "bands-6", .words = "6 bands", .equal_bands = true};
    study.measures[2].setting = {.name = "bands-9", .words = "9 bands", .equal_bands = true};
    return study;
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
    const Rig rig = scene_rig("one-lamp.toml");
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

// Errors.

constexpr int kWidth_px = 5;
constexpr std::size_t kPixels = 20;

CameraImage even_image(float r, float g, float b) {
    CameraImage image{.width_px = kWidth_px, .height_px = 4, .samples = {}};
    for (const float value : {r, g, b}) image.samples.insert(image.samples.end(), kPixels, value);
    return image;
}

StudyMeasure errors_of(const CameraImage& image,
                       const CameraImage& reference,
                       std::span<const unsigned char> on_edge = {}) {
    StudyMeasure measure;
    measure_errors(image, reference, on_edge, measure);
    return measure;
}

// Of 20 pixels, one off by a quarter: rms 0.25 / sqrt(20).
TEST(MeasureErrors, AreTheWorstChannels) {
    const CameraImage reference = even_image(1.0F, 2.0F, 4.0F);
    EXPECT_EQ(errors_of(reference, reference).max_error, 0.0);
    CameraImage image = reference;
    image.samples[kPixels + 13] *= 1.25F;
    image.samples[2] *= 1.125F;
    const StudyMeasure found = errors_of(image, reference);
    EXPECT_EQ(found.max_error, 0.25);
    EXPECT_EQ(found.percentile_999, 0.25);
    EXPECT_NEAR(found.rms_error, 0.25 / std::sqrt(20.0), 1e-15);
}

TEST(MeasureErrors, SetEdgesApart) {
    const CameraImage reference = even_image(1.0F, 2.0F, 4.0F);
    CameraImage image = reference;
    image.samples[2 * kPixels + 6] *= 1.5F;
    std::vector<unsigned char> on_edge(kPixels, 0);
    on_edge[6] = 1;
    const StudyMeasure found = errors_of(image, reference, on_edge);
    EXPECT_EQ(found.max_error, 0.0);
    EXPECT_EQ(found.max_error_on_edges, 0.5);
}

// Black is 1e-8 of the brightest, 4: a difference of 4e-9 beside nothing is a tenth of it.
TEST(MeasureErrors, MeasureBlackAgainstTheBrightest) {
    CameraImage reference = even_image(1.0F, 1.0F, 4.0F);
    reference.samples[2 * kPixels] = 0.0F;
    CameraImage image = reference;
    image.samples[2 * kPixels] = 4e-9F;
    EXPECT_NEAR(errors_of(image, reference).max_error, 0.1, 1e-7);
}

// No error was found, but nothing was looked at either.
TEST(MeasureErrors, OfNothingAreInfinite) {
    const CameraImage reference = even_image(1.0F, 1.0F, 1.0F);
    CameraImage not_finite = reference;
    not_finite.samples[25] = kNaN;
    const std::vector<unsigned char> all(kPixels, 1);
    for (const StudyMeasure& measure :
         {errors_of(not_finite, reference), errors_of(reference, reference, all)}) {
        EXPECT_EQ(measure.max_error, kInfinity);
        EXPECT_EQ(pareto_front({&measure, 1}), std::vector<bool>{false});
    }
}

TEST(MeasureErrors, OfDifferentSizesAreOurMistake) {
    const CameraImage reference = even_image(1.0F, 1.0F, 1.0F);
    CameraImage turned = reference;
    std::swap(turned.width_px, turned.height_px);
    EXPECT_THROW((void)errors_of(turned, reference), std::logic_error);
    CameraImage cut = reference;
    cut.samples.pop_back();
    EXPECT_THROW((void)errors_of(cut, reference), std::logic_error);
    const std::vector<unsigned char> on_edge(kPixels - 1, 0);
    EXPECT_THROW((void)errors_of(reference, reference, on_edge), std::logic_error);
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
            const auto at = least_by_time.try_emplace(m.total_s(), m.max_error).first;
            at->second = std::min(at->second, m.max_error);
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
            const std::pair point(measures[i].total_s(), measures[i].max_error);
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

// The files.

std::string written(const Study& study, const std::string& name) {
    const TempFolder folder;
    write_study(study, folder.path());
    return read_text_file(folder.path() / name);
}

TEST(StudyCsv, HasARowAMeasureAndEveryNumber) {
    Study study = small_study();
    study.measures.resize(2);
    study.measures[1].max_error = kInfinity;
    EXPECT_EQ(written(study, "study.csv"),
              "name,words,equal_bands,wavelengths,frames,time_s,on_front,promise,render_s,"
              "integrate_s,max_error,percentile_999,rms_error,max_error_on_edges\n"
              "fitted-3,3 fitted wavelengths,false,3,1,4.0,true,0.00075,3.0,1.0,0.0005,"
              "0.00045000000000000004,0.00015,0.25\n"
              "bands-6,6 bands,true,3,1,2.0,false,0.15000000000000002,1.5,0.5,inf,"
              "0.09000000000000001,0.03,0.25\n");
}

TEST(StudyJson, IsOfTheStudyAndReadsBack) {
    Study study = small_study();
    study.rig_title = "\"quoted\" <b> not UTF-8: \xff";
    study.measures[2].max_error = kInfinity;
    const Json json = Json::parse(study_json(study));
    EXPECT_EQ(json["rig"]["sha256"], "12ab");
    EXPECT_EQ(json["image"]["width_px"], 1360);
    EXPECT_EQ(json["reference"]["wavelengths"], 398);
    EXPECT_EQ(json["reference"]["time_s"], 54.25);
    ASSERT_EQ(json["measures"].size(), 3U);
    EXPECT_EQ(json["measures"][0]["time_s"], 4.0);
    EXPECT_EQ(json["measures"][1]["on_front"], true);
    EXPECT_TRUE(json["measures"][2]["max_error"].is_null());

    study.rig_title = "HabCam";
    const std::vector<StudyMeasure> back = measures_in(study_json(study), study);
    ASSERT_EQ(back.size(), 3U);
    for (std::size_t i = 0; i < back.size(); ++i) {
        EXPECT_EQ(back[i].setting.name, study.measures[i].setting.name);
        EXPECT_EQ(back[i].setting.words, study.measures[i].setting.words);
        EXPECT_EQ(back[i].setting.equal_bands, study.measures[i].setting.equal_bands);
        EXPECT_EQ(back[i].wavelengths, 3U);
        EXPECT_EQ(back[i].frames, 1U);
        EXPECT_EQ(back[i].promise, study.measures[i].promise);
        EXPECT_EQ(back[i].render_s, study.measures[i].render_s);
        EXPECT_EQ(back[i].integrate_s, study.measures[i].integrate_s);
        EXPECT_EQ(back[i].max_error, study.measures[i].max_error);
        EXPECT_EQ(back[i].percentile_999, study.measures[i].percentile_999);
        EXPECT_EQ(back[i].rms_error, study.measures[i].rms_error);
        EXPECT_EQ(back[i].max_error_on_edges, 0.25);
    }
}

TEST(StudyJson, OfAnotherStudyHasNoMeasures) {
    const std::string text = study_json(small_study());
    const std::vector<void (*)(Study&)> changes{[](Study& s) { s.rig_title = "x"; },
                                                [](Study& s) { s.rig_sha256 = "x"; },
                                                [](Study& s) { s.width_px = 1; },
                                                [](Study& s) { s.height_px = 1; },
                                                [](Study& s) { s.aphotic_version = "x"; },
                                                [](Study& s) { s.povray_version = "x"; },
                                                [](Study& s) { s.cores = 3; }};
    for (const auto change : changes) {
        Study other = small_study();
        change(other);
        EXPECT_TRUE(measures_in(text, other).empty());
    }
}

TEST(StudyJson, ThatIsNotAsWeWroteItHasNoMeasures) {
    const std::string text = study_json(small_study());
    for (std::size_t size = 0; size + 2 < text.size(); size += 7)
        EXPECT_TRUE(measures_in(text.substr(0, size), small_study()).empty()) << size;
    const Json whole = Json::parse(text);
    for (const auto& [name, value] : whole["measures"][0].items()) {
        if (name == "time_s" || name == "on_front") continue;  // for readers, not for us
        Json less = whole;
        less["measures"][0].erase(name);
        EXPECT_TRUE(measures_in(less.dump(), small_study()).empty()) << "no " << name;
        for (const Json& wrong : {Json::object(), Json::array({1})}) {
            Json odd = whole;
            odd["measures"][0][name] = wrong;
            EXPECT_TRUE(measures_in(odd.dump(), small_study()).empty()) << name;
        }
    }
    Json negative = whole;
    negative["measures"][0]["frames"] = -1;
    EXPECT_TRUE(measures_in(negative.dump(), small_study()).empty());
}

TEST(StudyPage, HasEveryMeasureInWordsAndNumbers) {
    const std::string page = written(small_study(), "study.html");
    const std::string words = words_of(page);
    EXPECT_EQ(first_unbalanced(page), "");
    for (const char* part : {"HabCam",
                             "3 settings of 1360 × 1024 pixels",
                             "POV-Ray 3.7.0.10 on 2 cores",
                             "398 wavelengths",
                             "54.2 s",
                             "3 fitted wavelengths",
                             "6 bands",
                             "SHA-256 12ab"})
        EXPECT_TRUE(contains(words, part)) << part;
    EXPECT_TRUE(contains(page, "<td>4.00</td><td>1.00</td>")) << "time, over the first's";
    EXPECT_TRUE(contains(page, "<td>2.00</td><td>0.50</td>"));
    EXPECT_TRUE(contains(page, "<svg")) << "the plot";
}

TEST(StudyPage, HoldsAnyNumbersAndNames) {
    Study study = small_study();
    study.rig_title = "</title><script>alert(1)</script>";
    for (StudyMeasure& measure : study.measures) measure.max_error = kInfinity;
    study.measures[0].setting.words = "<b>";
    const std::string page = written(study, "study.html");
    EXPECT_EQ(first_unbalanced(page), "");
    EXPECT_FALSE(contains(page, "<script"));
    EXPECT_FALSE(contains(page, "<b>"));
    EXPECT_FALSE(contains(page, "id=\"time-plot\"")) << "nothing to draw";
    study.measures.clear();
    EXPECT_TRUE(contains(words_of(written(study, "study.html")), "0 settings"));
}

TEST(Study, ThatCannotBeWrittenIsARunErrorThatNamesTheFile) {
    const TempFolder folder;
    fs::create_directory(folder.path() / "study.csv");
    const std::string said = run_error_of([&] { write_study(small_study(), folder.path()); });
    EXPECT_TRUE(contains(said, (folder.path() / "study.csv").string())) << said;
}

}  // namespace
}  // namespace aphotic::study_test
