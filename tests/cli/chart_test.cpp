// SPDX-License-Identifier: BSD-3-Clause
//
// The 24 patches of scenes/user/chart, in air, against their own integration by hand: the signal of
// a patch is int Phi rho Q dlambda times what the geometry makes of a white one.
#include "image/output_images.h"
#include "rig/file/rig_reader.h"
#include "spectral/curve_loader.h"
#include "spectral/manifest.h"
#include "support/closed_form.h"
#include "support/command_test.h"
#include "support/scene_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>

namespace aphotic::chart_test {
namespace {

namespace fs = std::filesystem;

constexpr int kColumns = 6;
constexpr int kRows = 4;
constexpr int kPatch_px = 12;  // each way
// A half float's rounding, 4.9e-4 at most, averages out over a patch's 144 pixels; the rest is the
// plan's own error.
constexpr double kChartError = 1e-4;

std::string rig_text() {
    return with(scene_text("habcam.toml"),
                {{"altitude_m", "1.0"},
                 {"pitch_deg", "0.0"},
                 {"multiple", "0.0"},
                 {"resolution", fmt::format("[{}, {}]", kColumns * kPatch_px, kRows * kPatch_px)},
                 {"pixel_pitch_um", "100.0"}});
}

std::vector<std::string> patches() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(scene_file("user/chart/patches"))) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

// Pixels of 0.1 mm behind 12 mm: at 1 m each is 1/120 m, and a patch twelve of them.
std::string scene_text(const std::vector<std::string>& names) {
    constexpr double kSize_m = kPatch_px * 0.1 / 12.0;
    std::string scene = "#version 3.7;\n#include \"aphotic.inc\"\nAphotic_Rig ()\n";
    for (int i = 0; i < static_cast<int>(names.size()); ++i) {
        const double left_m = (i % kColumns - 0.5 * kColumns) * kSize_m;
        const double top_m = (0.5 * kRows - i / kColumns) * kSize_m;
        scene += fmt::format(
            "box {{ <{}, {}, 1>, <{}, {}, 1.1> pigment {{ Aphotic_Pigment (\"{}\") }} "
            "finish {{ Aphotic_Finish (0, 40) }} }}\n",
            left_m,
            top_m - kSize_m,
            left_m + kSize_m,
            top_m,
            names[static_cast<std::size_t>(i)]);
    }
    return scene;
}

// Midpoints of steps far finer than the tables' knots.
std::array<double, 3> integrated_by_hand(const Spectrum& reflectance) {
    constexpr double kStep_nm = 0.05;
    constexpr int kSteps = 6400;  // 400 to 720 nm
    const Spectrum flash = load_curve("xenon-flash", CurveRole::LampSpectrum, {});
    const auto response = load_curves("nikon-d5100", CurveRole::SensorResponse, {});
    std::array<double, 3> sum{};
    for (int i = 0; i < kSteps; ++i) {
        const double nm = 400.0 + (i + 0.5) * kStep_nm;
        for (std::size_t c = 0; c < sum.size(); ++c) {
            sum[c] += flash.at(nm) * reflectance.at(nm) * response[c].at(nm) * kStep_nm;
        }
    }
    return sum;
}

class Chart : public CommandTest {
  protected:
    Chart() {
        for (const std::string& name : names_) {
            fs::copy_file(scene_file("user/chart/patches/" + name), path(name));
        }
        write_file(path("chart.pov"), scene_text(names_));
    }

    std::vector<std::string> names_ = patches();
};

TEST_F(Chart, InAirIsItsSpectraIntegratedByHand) {
    ASSERT_EQ(names_.size(), 24U);
    write_file(path("rig.toml"), rig_text());
    done("render rig.toml --scene chart.pov -o out --fitted 27");
    // As many wavelengths as kinds of light, and two: the plan's own error is nothing.
    for (const RuleQuality& quality : read_manifest(path("out")).quality) {
        EXPECT_LT(quality.error, 1e-9);
    }

    Rig rig = read_rig(path("rig.toml"));
    rig.seafloor.reflectance = {"white", {300.0, 900.0}, {1.0, 1.0}};
    const double some_nm = 550.0;
    const double flux = rig.strobes[0].spectrum.at(some_nm);
    const CameraImage image = read_signals(path("out/image.exr"));
    const auto pixels = static_cast<std::size_t>(image.width_px * image.height_px);
    for (int i = 0; i < static_cast<int>(names_.size()); ++i) {
        const std::string& name = names_[static_cast<std::size_t>(i)];
        const auto by_hand =
            integrated_by_hand(load_curve(name, CurveRole::Reflectance, folder_.path()));
        std::array<double, 3> ratio{};
        for (int k = 0; k < kPatch_px * kPatch_px; ++k) {
            const int column = i % kColumns * kPatch_px + k % kPatch_px;
            const int row = i / kColumns * kPatch_px + k / kPatch_px;
            const double white = closed_form::radiance(rig, column, row, some_nm).radiance / flux;
            for (std::size_t c = 0; c < ratio.size(); ++c) {
                const double signal =
                    image.samples[c * pixels +
                                  static_cast<std::size_t>(row * image.width_px + column)];
                ratio[c] += signal / (white * by_hand[c]) / (kPatch_px * kPatch_px);
            }
        }
        for (std::size_t c = 0; c < ratio.size(); ++c) {
            EXPECT_NEAR(ratio[c], 1.0, kChartError) << name << ", channel " << c;
        }
    }
}

// The same boxes as objects of a rig, 1 m below it, for the reference.
std::string objects_text(const std::vector<std::string>& names) {
    constexpr double kSize_m = kPatch_px * 0.1 / 12.0;
    std::string objects;
    for (int i = 0; i < static_cast<int>(names.size()); ++i) {
        const double port_m = (i % kColumns - 0.5 * kColumns) * kSize_m;
        const double fore_m = (0.5 * kRows - i / kColumns) * kSize_m;
        const std::string& name = names[static_cast<std::size_t>(i)];
        objects += fmt::format(
            "\n[[object]]\nname = \"{}\"\nshape = \"box\"\nfrom_m = [{}, {}, 1.0]\n"
            "to_m = [{}, {}, 1.1]\nreflectance = \"{}\"\n",
            name,
            fore_m - kSize_m,
            port_m,
            fore_m,
            port_m + kSize_m,
            name);
    }
    return objects;
}

TEST_F(Chart, InWaterIsWhatTheReferenceTraces) {
    write_file(
        path("rig.toml"),
        with(rig_text(), {{"multiple", "1.0"}, {"altitude_m", "2.0"}}) + objects_text(names_));
    done("validate rig.toml --scene chart.pov -o out");
    // One patch of another colour is another chart.
    write_file(path("chart.pov"), replaced(text_of("chart.pov"), "08-purplish-blue", "13-blue"));
    done("validate rig.toml --scene chart.pov -o out", "", kAnswerIsNo);
}

}  // namespace
}  // namespace aphotic::chart_test
