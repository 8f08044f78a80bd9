// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/integrator.h"

#include "base/error.h"
#include "base/sha256.h"
#include "image/exr.h"
#include "support/refusal.h"
#include "tests/support/temp_folder.h"

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <regex>
#include <utility>

namespace aphotic::integrator_test {
namespace {

namespace fs = std::filesystem;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

// What a frame holds at (channel, row, column).
using Content = std::function<float(int, int, int)>;

// As POV-Ray writes them: half floats, channels R, G, B, ZIP. Written with OpenEXR itself, not
// with what is under test.
void write_frame(const fs::path& file, int width_px, int height_px, const Content& content) {
    Imf::Header header(width_px, height_px);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer buffer;
    const char* names[] = {"R", "G", "B"};
    std::vector<Imf::Array2D<half>> planes(3);
    for (int c = 0; c < 3; ++c) {
        auto& plane = planes[static_cast<std::size_t>(c)];
        plane.resizeErase(height_px, width_px);
        for (int row = 0; row < height_px; ++row) {
            for (int x = 0; x < width_px; ++x) plane[row][x] = half(content(c, row, x));
        }
        header.channels().insert(names[c], Imf::Channel(Imf::HALF));
        buffer.insert(
            names[c],
            Imf::Slice::Make(Imf::HALF, &plane[0][0], Imath::V2i(0), width_px, height_px));
    }
    Imf::OutputFile out(file.c_str(), header);
    out.setFrameBuffer(buffer);
    out.writePixels(height_px);
}

std::size_t channel_named(std::string_view name) {
    return static_cast<std::size_t>(std::ranges::find(kChannelNames, name) - kChannelNames.begin());
}

// A folder with frames and their manifest.
class Render {
  public:
    Render(int width_px, int height_px) {
        fs::create_directories(folder_.path() / "povray" / "frames");
        manifest_.aphotic_version = "0.1.0";
        manifest_.rig_title = "title";
        manifest_.rig_sha256 = "digest";
        manifest_.width_px = width_px;
        manifest_.height_px = height_px;
    }

    void add_frame(const std::string& name, const Content& content) {
        manifest_.frames.push_back({.name = name, .scene_sha256 = "", .image_sha256 = ""});
        write_frame(image(name), manifest_.width_px, manifest_.height_px, content);
        manifest_.frames.back().image_sha256 = sha256_of_file(image(name));
    }

    void add_wavelength(double lambda_nm,
                        std::array<double, kChannels> weight,
                        std::size_t frame,
                        std::string_view channel,
                        int exposure_log2) {
        manifest_.wavelengths.push_back({.lambda_nm = lambda_nm,
                                         .weight = weight,
                                         .frame = frame,
                                         .channel = channel_named(channel),
                                         .exposure_log2 = exposure_log2});
    }

    [[nodiscard]] const fs::path& folder() const { return folder_.path(); }
    [[nodiscard]] fs::path image(const std::string& name) const {
        return folder() / "povray" / "frames" / (name + ".exr");
    }
    [[nodiscard]] Manifest& manifest() { return manifest_; }

    CameraImage integrate() { return aphotic::integrate(folder(), manifest_); }

    // The message of the RunError that integrating ends in.
    std::string error() {
        return run_error_of([&] { integrate(); });
    }

    [[nodiscard]] std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder())) {
            names.push_back(entry.path().filename().string());
        }
        std::sort(names.begin(), names.end());
        return names;
    }

  private:
    TempFolder folder_;
    Manifest manifest_;
};

std::size_t index_of(int width_px, int row, int column) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_px) +
           static_cast<std::size_t>(column);
}

std::vector<float> plane_of(const fs::path& file, const std::string& channel) {
    ExrReader in(file);
    std::vector<float> samples(index_of(in.width_px(), in.height_px(), 0));
    in.read_rows(0, in.height_px(), std::span(&channel, 1), samples);
    return samples;
}

// Whole numbers up to 2048 stand exactly in half floats, so every sum below is exact.
float ramp(int channel, int row, int column) {
    return static_cast<float>(1 + channel + 3 * (column + 2 * row));
}

// Three wavelengths in two frames, all weights and exposures powers of two.
void fill(Render& render) {
    render.add_frame("band_450_550nm", ramp);
    render.add_frame("band_650nm", [](int c, int row, int x) { return 2.0F * ramp(c, row, x); });
    render.add_wavelength(450.0, {1.0, 0.5, 0.0}, 0, "R", 3);
    render.add_wavelength(550.0, {2.0, -1.0, 0.0}, 0, "G", -2);
    render.add_wavelength(650.125, {0.25, 0.0, 4.0}, 1, "B", 10);
}

// L of the three wavelengths of fill(), by hand: frame times 2^-exposure.
std::array<double, 3> radiance_by_hand(int row, int x) {
    return {ramp(0, row, x) / 8.0, ramp(1, row, x) * 4.0, 2.0 * ramp(2, row, x) / 1024.0};
}

TEST(Integrator, SumsWeightTimesRadianceExactly) {
    Render render(5, 3);
    fill(render);
    const CameraImage image = render.integrate();
    EXPECT_EQ(image.width_px, 5);
    EXPECT_EQ(image.height_px, 3);
    ASSERT_EQ(image.samples.size(), 45U);
    for (int row = 0; row < 3; ++row) {
        for (int x = 0; x < 5; ++x) {
            const auto L = radiance_by_hand(row, x);
            const auto at = index_of(5, row, x);
            EXPECT_EQ(image.samples[at], 1.0 * L[0] + 2.0 * L[1] + 0.25 * L[2]) << row << ' ' << x;
            EXPECT_EQ(image.samples[15 + at], 0.5 * L[0] - L[1]) << row << ' ' << x;
            EXPECT_EQ(image.samples[30 + at], 4.0 * L[2]) << row << ' ' << x;
        }
    }
}

TEST(Integrator, WritesWhatItReturns) {
    Render render(5, 3);
    fill(render);
    const CameraImage image = render.integrate();
    EXPECT_EQ(render.files(), (std::vector<std::string>{"image.exr", "povray", "spectral.exr"}));
    for (const char* file : {"image.exr", "spectral.exr"}) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            const auto part = std::span(image.samples).subspan(15 * c, 15);
            EXPECT_EQ(plane_of(render.folder() / file, std::string(kChannelNames[c])),
                      std::vector<float>(part.begin(), part.end()))
                << file << ' ' << kChannelNames[c];
        }
    }
}

TEST(Integrator, WritesTheRadianceOfEachWavelength) {
    Render render(5, 3);
    fill(render);
    render.integrate();
    const std::vector<std::string> channels{
        "S0.450,000000nm", "S0.550,000000nm", "S0.650,125000nm"};
    for (std::size_t j = 0; j < channels.size(); ++j) {
        const auto plane = plane_of(render.folder() / "spectral.exr", channels[j]);
        for (int row = 0; row < 3; ++row) {
            for (int x = 0; x < 5; ++x) {
                EXPECT_EQ(plane[index_of(5, row, x)], radiance_by_hand(row, x)[j]) << channels[j];
            }
        }
    }
}

// The pattern by which the reference reader of Fichet, Pacanowski and Wilkie (JCGT 2021) knows
// spectral channels.
TEST(Integrator, NamesSpectralChannelsAsThePublishedLayoutDoes) {
    const std::regex layout(
        R"(^((S([0-3]))|T)\.(\d*,?\d*([Ee][+-]?\d+)?)(Y|Z|E|P|T|G|M|k|h|da|d|c|m|u|n|p)?(m|Hz)$)");
    EXPECT_EQ(spectral_channel(550.0), "S0.550,000000nm");
    EXPECT_EQ(spectral_channel(1000.0625), "S0.1000,062500nm");
    for (const double lambda_nm : {99.0, 380.0, 454.123456, 10000.0}) {
        EXPECT_TRUE(std::regex_match(spectral_channel(lambda_nm), layout))
            << spectral_channel(lambda_nm);
    }
    Render render(2, 2);
    fill(render);
    render.integrate();
    int spectral = 0;
    for (const std::string& name : ExrReader(render.folder() / "spectral.exr").channels()) {
        if (name == "R" || name == "G" || name == "B") continue;
        EXPECT_TRUE(std::regex_match(name, layout)) << name;
        ++spectral;
    }
    EXPECT_EQ(spectral, 3);
}

TEST(Integrator, LabelsItsFiles) {
    Render render(2, 2);
    fill(render);
    render.integrate();
    const ExrReader image(render.folder() / "image.exr");
    const ExrReader spectral(render.folder() / "spectral.exr");
    EXPECT_EQ(image.channels(), (std::vector<std::string>{"B", "G", "R"}));
    EXPECT_EQ(spectral.attribute("spectralLayoutVersion"), "1.0");
    EXPECT_EQ(spectral.attribute("emissiveUnits"), "W.m^-2.sr^-1");
    EXPECT_EQ(image.attribute("emissiveUnits"), "") << "signals are no radiance";
    for (const ExrReader* file : {&image, &spectral}) {
        EXPECT_EQ(file->attribute("aphotic:rig_title"), "title");
        EXPECT_EQ(file->attribute("aphotic:rig_sha256"), "digest");
        EXPECT_EQ(file->attribute("aphotic:version"), "0.1.0");
        EXPECT_EQ(file->attribute("aphotic:wavelengths_nm"), "450 550 650.125");
    }
}

// Blocks hold at most 64 rows, so every image here but the first is read in several, and the
// last of them ends in the middle of ZIP's 16 rows.
TEST(Integrator, KeepsEveryRowOfTallImages) {
    for (const int height_px : {64, 65, 80, 150}) {
        Render render(3, height_px);
        fill(render);
        const CameraImage image = render.integrate();
        const auto radiance = plane_of(render.folder() / "spectral.exr", "S0.650,125000nm");
        for (int row = 0; row < height_px; ++row) {
            for (int x = 0; x < 3; ++x) {
                const auto L = radiance_by_hand(row, x);
                const auto at = index_of(3, row, x);
                ASSERT_EQ(image.samples[at], L[0] + 2.0 * L[1] + 0.25 * L[2])
                    << "row " << row << " of " << height_px;
                ASSERT_EQ(radiance[at], L[2]) << "row " << row << " of " << height_px;
            }
        }
    }
}

// A sum that floats would lose: 2^24 + 1 - 2^24.
TEST(Integrator, SumsInDouble) {
    Render render(1, 1);
    render.add_frame("f", [](int, int, int) { return 1.0F; });
    render.add_wavelength(450.0, {0x1p24, 0.0, 0.0}, 0, "R", 0);
    render.add_wavelength(550.0, {1.0, 0.0, 0.0}, 0, "G", 0);
    render.add_wavelength(650.0, {-0x1p24, 0.0, 0.0}, 0, "B", 0);
    EXPECT_EQ(render.integrate().samples[0], 1.0F);
}

// Weights of both signs that all but cancel, 1 part left of 1.5e8: right to the rounding of
// doubles, 1.5e8 times 1.1e-16, and of the image's floats, 6e-8.
TEST(Integrator, KeepsWhatIsLeftOfACancellation) {
    constexpr double kLeft = 1e-7;
    Render render(1, 1);
    render.add_frame("a", [](int channel, int, int) { return channel == 0 ? 1.5F : 1.25F; });
    render.add_wavelength(500.0, {1e8, 0.0, 0.0}, 0, "R", 0);
    render.add_wavelength(600.0, {-1.2e8 + 0.8, 0.0, 0.0}, 0, "G", 0);
    // 1.5e8 - 1.25 * 1.2e8 + 1.25 * 0.8
    EXPECT_NEAR(render.integrate().samples[0], 1.0, kLeft);
}

TEST(Integrator, TakesOutLargeExposuresExactly) {
    Render render(1, 1);
    render.add_frame("f", [](int, int, int) { return 3.0F; });
    render.add_wavelength(450.0, {1.0, 0.0, 0.0}, 0, "R", 120);
    render.add_wavelength(550.0, {0.0, 1.0, 0.0}, 0, "G", -100);
    const CameraImage image = render.integrate();
    EXPECT_EQ(image.samples[0], 0x3p-120F);
    EXPECT_EQ(image.samples[1], 0x3p100F);
}

TEST(Integrator, NamesTheFrameAndThePixelOfABadSample) {
    struct Bad {
        float value;
        const char* words;
    };
    for (const Bad& bad : {Bad{kNan, "nan"}, {kInf, "inf"}, {-0.5F, "-0.5"}, {65504.0F, "65504"}}) {
        Render render(3, 70);
        fill(render);
        render.manifest().frames.pop_back();
        render.manifest().wavelengths.pop_back();
        render.add_frame("bad", [&](int c, int row, int x) {
            return c == 2 && row == 66 && x == 1 ? bad.value : 1.0F;
        });
        render.add_wavelength(650.0, {1.0, 1.0, 1.0}, 1, "B", 0);
        EXPECT_EQ(render.error(),
                  render.image("bad").string() + ": channel B is " + bad.words +
                      " at column 1, row 66; allowed: 0 to below 65504");
        EXPECT_EQ(render.files(), std::vector<std::string>{"povray"}) << "left behind";
    }
}

TEST(Integrator, RefusesWhatNoFloatHolds) {
    Render signal(3, 2);
    signal.add_frame("f", [](int, int row, int x) { return row == 1 && x == 2 ? 4.0F : 1.0F; });
    signal.add_wavelength(450.0, {1.0, 0x1p125, 1.0}, 0, "R", 0);
    EXPECT_EQ(signal.error(), kAccepted);
    signal.manifest().wavelengths[0].weight[1] = 0x1p126;
    EXPECT_EQ(
        signal.error(),
        (signal.folder() / "manifest.json").string() +
            ": G is inf at column 2, row 1; allowed: weights and exposures that keep it finite");

    Render radiance(1, 1);
    radiance.add_frame("f", [](int, int, int) { return 1.0F; });
    radiance.add_wavelength(450.0, {0x1p-10, 0x1p-10, 0x1p-10}, 0, "R", -130);
    EXPECT_NE(radiance.error().find(": R is inf at column 0, row 0"), std::string::npos);
}

TEST(Integrator, RefusesAFrameThatIsNotWhatItShouldBe) {
    struct Case {
        std::function<void(const fs::path&)> spoil;
        bool is_noted;
        std::string message;  // how it begins, after the frame's name
    };
    const auto dark = [](int, int, int) { return 1.0F; };
    for (const Case& each : {
             Case{[](const fs::path& f) { fs::remove(f); },
                  false,
                  ": the frame is missing; render it first"},
             {[](const fs::path& f) { write_frame(f, 3, 40, ramp); },
              true,
              ": found 3 x 40 pixels; allowed: 4 x 40"},
             {[&](const fs::path& f) { write_frame(f, 4, 40, dark); },
              false,
              ": is not the image recorded in the manifest"},
             {[](const fs::path& f) { fs::resize_file(f, fs::file_size(f) - 20); }, true, ": "},
             {[](const fs::path& f) { write_file(f, "no image"); },
              true,
              ": not a readable OpenEXR image: "},
         }) {
        Render render(4, 40);
        fill(render);
        const fs::path frame = render.image("band_650nm");
        each.spoil(frame);
        if (each.is_noted) render.manifest().frames[1].image_sha256 = sha256_of_file(frame);
        const std::string found = render.error();
        EXPECT_TRUE(found.starts_with(frame.string() + each.message)) << found;
        EXPECT_EQ(render.files(), std::vector<std::string>{"povray"}) << "left behind";
    }
}

// Frames may be rendered elsewhere: nobody has noted a checksum then.
TEST(Integrator, TakesFramesWithoutANotedChecksum) {
    Render render(4, 3);
    fill(render);
    for (ManifestFrame& frame : render.manifest().frames) frame.image_sha256.clear();
    EXPECT_EQ(render.error(), kAccepted);
}

TEST(Integrator, AFailureLeavesTheImagesOfBefore) {
    Render render(4, 3);
    fill(render);
    render.integrate();
    const std::string before = sha256_of_file(render.folder() / "image.exr");
    fs::remove(render.image("band_650nm"));
    EXPECT_NE(render.error(), kAccepted);
    EXPECT_EQ(render.files(), (std::vector<std::string>{"image.exr", "povray", "spectral.exr"}));
    EXPECT_EQ(sha256_of_file(render.folder() / "image.exr"), before);
}

TEST(Integrator, ReportsProgressUpToOne) {
    Render render(2, 130);
    fill(render);
    std::vector<double> shares;
    integrate(render.folder(), render.manifest(), [&](double share) { shares.push_back(share); });
    ASSERT_GE(shares.size(), 2U);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_GT(shares.front(), 0.0);
    EXPECT_EQ(shares.back(), 1.0);
}

// "Pixels do not depend on it": the files, to the last byte.
TEST(Integrator, DoesNotDependOnThreads) {
    Render render(40, 100);
    fill(render);
    std::vector<std::string> digests;
    for (const int threads : {0, 1, 3}) {
        set_exr_threads(threads);
        render.integrate();
        digests.push_back(sha256_of_file(render.folder() / "spectral.exr"));
    }
    EXPECT_EQ(digests[0], digests[1]);
    EXPECT_EQ(digests[0], digests[2]);
}

}  // namespace
// Of two rows of two pixels, one wavelength that R sees twice.
void add_veil(Render& render, const std::vector<float>& planes) {
    const fs::path file = veil_path(render.folder());
    ExrWriter writer(file, 2, 2, veil_channels(render.manifest()), {});
    writer.write_rows(2, planes);
    writer.finish();
    render.manifest().veil = ManifestVeil{.sha256 = sha256_of_file(file)};
}

const std::vector<float> kVeilPlanes{
    1.0F,
    2.0F,
    3.0F,
    4.0F,  // R
    0.5F,
    0.5F,
    0.5F,
    0.5F,  // G
    0.0F,
    0.0F,
    0.0F,
    0.0F,  // B
    10.0F,
    20.0F,
    30.0F,
    40.0F,  // the wavelength
};

TEST(Integrator, TheVeilIsAddedToSignalsAndRadiance) {
    Render render(2, 2);
    render.add_frame("a", [](int, int row, int x) { return static_cast<float>(1 + x + 2 * row); });
    render.add_wavelength(500.0, {2.0, 1.0, 0.0}, 0, "R", 0);
    add_veil(render, kVeilPlanes);
    render.manifest().model = ManifestModel{.error = {0.5, 0.25, 0.125}};
    const CameraImage image = render.integrate();
    ExrReader signals(render.folder() / "image.exr");
    EXPECT_EQ(signals.attribute("aphotic:model_error"), "0.5 0.25 0.125");
    EXPECT_EQ(signals.planes(std::vector<std::string>{"R"}),
              (std::vector<float>{3.0F, 6.0F, 9.0F, 12.0F}));
    EXPECT_EQ(signals.planes(std::vector<std::string>{"G"}),
              (std::vector<float>{1.5F, 2.5F, 3.5F, 4.5F}));
    EXPECT_EQ(signals.planes(std::vector<std::string>{"B"}),
              (std::vector<float>{0.0F, 0.0F, 0.0F, 0.0F}));
    ExrReader radiance(render.folder() / "spectral.exr");
    const auto names = radiance.channels();
    const auto plane = std::ranges::find_if(
        names, [](const std::string& name) { return name.find("500") != std::string::npos; });
    ASSERT_NE(plane, names.end());
    EXPECT_EQ(radiance.planes(std::vector<std::string>{*plane}),
              (std::vector<float>{11.0F, 22.0F, 33.0F, 44.0F}));
}

TEST(Integrator, AVeilThatIsMissingOrAnotherIsARunError) {
    Render render(2, 2);
    render.add_frame("a", [](int, int, int) { return 1.0F; });
    render.add_wavelength(500.0, {2.0, 1.0, 0.0}, 0, "R", 0);
    add_veil(render, kVeilPlanes);
    const fs::path file = veil_path(render.folder());
    render.manifest().veil->sha256 = "another";
    EXPECT_EQ(render.error(), file.string() + ": is not the veil recorded in the manifest");
    fs::remove(file);
    EXPECT_EQ(render.error(),
              file.string() + ": the veil is missing; `aphotic render` makes it from its frames");
}

}  // namespace aphotic::integrator_test
