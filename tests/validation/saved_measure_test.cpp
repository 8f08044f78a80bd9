// SPDX-License-Identifier: BSD-3-Clause
#include "validation/saved_measure.h"

#include "base/atomic_file.h"
#include "rig/rig_reader.h"
#include "support/small_study.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>

namespace aphotic::saved_measure_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct SavedMeasure : testing::Test {
    TempFolder folder;
    fs::path file = folder.path() / "fitted-3.json";
    StudySetting setting =
        study_settings(read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml"), false, 2)
            .front();
};

// Thirds, which no short decimal holds.
StudyMeasure odd_measure(const StudySetting& setting) {
    StudyMeasure measure = measure_of(setting, 1.0 / 3.0, 1e-3 / 3.0);
    measure.frames = 17;
    measure.channels[1].not_finite = 3;
    measure.channels[2].max_error = 0.0;
    return measure;
}

void expect_equal(const Comparison& a, const Comparison& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.max_error, b.max_error);
    EXPECT_EQ(a.column, b.column);
    EXPECT_EQ(a.row, b.row);
    EXPECT_EQ(a.percentile_999, b.percentile_999);
    EXPECT_EQ(a.rms_error, b.rms_error);
    EXPECT_EQ(a.mean_error, b.mean_error);
    EXPECT_EQ(a.compared, b.compared);
    EXPECT_EQ(a.on_edges, b.on_edges);
    EXPECT_EQ(a.max_error_on_edges, b.max_error_on_edges);
    EXPECT_EQ(a.not_finite, b.not_finite);
}

TEST_F(SavedMeasure, ComesBackToTheLastBit) {
    const StudyMeasure measure = odd_measure(setting);
    save_measure(measure, "key", file);
    const auto back = saved_measure(setting, "key", file);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->setting.name, setting.name);
    EXPECT_EQ(content_of(back->setting), content_of(setting));
    EXPECT_EQ(back->wavelengths, measure.wavelengths);
    EXPECT_EQ(back->frames, measure.frames);
    EXPECT_EQ(back->promise, measure.promise);
    EXPECT_EQ(back->render_s, measure.render_s);
    EXPECT_EQ(back->integrate_s, measure.integrate_s);
    for (std::size_t c = 0; c < measure.channels.size(); ++c)
        expect_equal(back->channels[c], measure.channels[c]);
}

TEST_F(SavedMeasure, KeepsAnInfiniteError) {
    StudyMeasure measure = odd_measure(setting);
    measure.channels[1].max_error = kInfinity;
    save_measure(measure, "key", file);
    const auto back = saved_measure(setting, "key", file);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->channels[1].max_error, kInfinity);
}

TEST_F(SavedMeasure, OfAnotherKeyIsNothing) {
    save_measure(odd_measure(setting), "key", file);
    EXPECT_FALSE(saved_measure(setting, "Key", file));
    EXPECT_FALSE(saved_measure(setting, "", file));
    EXPECT_FALSE(saved_measure(setting, "key", folder.path() / "no-such-file"));
}

// Cut off anywhere, the file is nothing; what is left off is its last bracket at least.
TEST_F(SavedMeasure, ThatIsNotWholeIsNothing) {
    save_measure(odd_measure(setting), "key", file);
    const std::string text = read_text_file(file);
    const std::size_t last_bracket = text.rfind('}');
    for (std::size_t left_off = 0; left_off <= last_bracket; left_off += 17) {
        const std::size_t size = last_bracket - left_off;
        write_file(file, text.substr(0, size));
        EXPECT_FALSE(saved_measure(setting, "key", file)) << text.substr(0, size);
    }
}

TEST_F(SavedMeasure, ThatIsSomethingElseIsNothing) {
    save_measure(odd_measure(setting), "key", file);
    const Json whole = Json::parse(read_text_file(file));
    for (const auto& [name, value] : whole.items()) {
        if (name == "name") continue;  // for people
        for (const Json& wrong : {Json(), Json(Json::array({1, 2})), Json("text")}) {
            if (name == "promise" && wrong.is_null()) continue;  // infinite
            Json json = whole;
            json[name] = wrong;
            write_file(file, json.dump());
            EXPECT_FALSE(saved_measure(setting, "key", file)) << name << ": " << wrong;
        }
        Json json = whole;
        json.erase(name);
        write_file(file, json.dump());
        EXPECT_FALSE(saved_measure(setting, "key", file)) << "no " << name;
    }
    for (const char* count : {"wavelengths", "frames"}) {
        Json json = whole;
        json[count] = 1e99;
        write_file(file, json.dump());
        EXPECT_FALSE(saved_measure(setting, "key", file)) << count;
    }
    Json four = whole;
    four["channels"].push_back(four["channels"][0]);
    for (const std::string& text : {std::string("[]"), std::string("\"key\""), four.dump()}) {
        write_file(file, text);
        EXPECT_FALSE(saved_measure(setting, "key", file)) << text;
    }
}

}  // namespace
}  // namespace aphotic::saved_measure_test
