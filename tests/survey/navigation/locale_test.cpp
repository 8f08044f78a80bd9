// SPDX-License-Identifier: BSD-3-Clause
//
// A host of the libraries, such as a notebook, may write numbers with decimal commas. What the
// libraries read and write is to the byte what it is in any other host.
#include "base/atomic_file.h"
#include "base/json_text.h"
#include "lightmap/design_space.h"
#include "report/html.h"
#include "rig/beam/photometric_file.h"
#include "rig/camera/calibration_file.h"
#include "support/comma_locale.h"
#include "support/design_rig.h"
#include "survey/fit/fitted_rig.h"
#include "survey/navigation/ifdo.h"
#include "survey/navigation/navigation_file.h"
#include "survey/simulate/flight.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <map>

namespace aphotic::locale_test {
namespace {

namespace fs = std::filesystem;

using Texts = std::map<std::string, std::string>;  // by what they are of

void add_rigs(Texts& texts) {
    for (const char* name : {"habcam.toml", "habcam-optics.toml", "port.toml"}) {
        RigText rig(fs::path(APHOTIC_SOURCE_DIR) / "scenes" / name);
        rig.set("sled.altitude_m", 12.5);
        rig.set("strobe.0.position_m", std::vector<double>{0.125, 1234567.5, -0.5});
        texts[name] = rig.text() + fmt::format("{}", rig.number("sled.altitude_m").value());
    }
    const RigText habcam(fs::path(APHOTIC_SOURCE_DIR) / "scenes/habcam.toml");
    for (const Strobe& strobe : habcam.rig().strobes)
        texts["a strobe's place"] += fmt::format("{} ", strobe.position_m.x());
}

void add_fitted(Texts& texts) {
    const TempFolder folder;
    const RigText rig(fs::path(APHOTIC_SOURCE_DIR) / "scenes/habcam.toml");
    FitResult result;
    result.state =
        fit_problem(rig, {.beam = FitBeamKind::Cosine, .has_beam_each = true}, 1.0, 0.02).start;
    for (double& power : result.state.power) power *= 1.125 + power;
    write_fitted_rig(rig, result, folder.path());
    texts["a fitted rig"] = read_text_file(folder.path() / kFittedRig);
}

void add_design(Texts& texts) {
    const Rig rig = design_rig(two_strobes());
    const DesignSpace space(text_of(rig), {.keys = {"strobe.*.power"}}, {rig.sled});
    std::vector<double> place = space.start();
    for (double& one : place) one += 0.125;
    texts["a design"] = space.text_at(place).text();
}

void add_beams(Texts& texts) {
    const fs::path folder = fs::path(APHOTIC_SOURCE_DIR) / "tests/rig/beam/photometric";
    for (const char* name : {"beam.csv", "eulumdat-absolute.ldt", "lm63-1995-type-a.ies"}) {
        const PhotometricFile read = read_photometric_file(folder / name);
        texts[name] = photometric_text(read, "beam.ies");
    }
}

std::vector<CameraCalibration> calibrations() {
    return {parse_calibration("cameras.txt", "1 SIMPLE_RADIAL 640 480 512.25 320.5 240.5 0.125\n"),
            parse_calibration("camera.xml",
                              "<?xml version=\"1.0\"?>\n<opencv_storage>\n"
                              "<image_width>800</image_width>\n<image_height>600</image_height>\n"
                              "<camera_matrix type_id=\"opencv-matrix\">\n<rows>3</rows>\n"
                              "<cols>3</cols>\n<dt>d</dt>\n<data>700.5 0. 405.25 0. 690.5 290.5 "
                              "0. 0. 1.</data></camera_matrix>\n"
                              "<distortion_coefficients type_id=\"opencv-matrix\">\n"
                              "<rows>4</rows>\n<cols>1</cols>\n<dt>d</dt>\n"
                              "<data>-0.1 0.02 0.001 -0.002</data></distortion_coefficients>\n"
                              "</opencv_storage>\n"),
            parse_calibration("camera.yaml",
                              "%YAML:1.0\n---\nimage_width: 800\nimage_height: 600\n"
                              "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
                              "   data: [ 700.5, 0., 405.25, 0., 690.5, 290.5, 0., 0., 1. ]\n"
                              "distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n"
                              "   dt: d\n   data: [ -0.1, 0.02, 0.001, -0.002, 0. ]\n")};
}

void add_navigation(Texts& texts) {
    const std::vector<ImageFile> none;
    const auto altitudes = [](const Navigation& navigation) {
        std::string all;
        for (const Leg& leg : flight_of(navigation))
            all += fmt::format("{} {} ", leg.sled.altitude_m, leg.sled.pitch_rad);
        return all;
    };
    texts["a table"] =
        altitudes(parse_navigation("image,altitude_m,pitch_deg,roll_deg\na.tif,12.5,0.5,-1.25\n",
                                   {.source = "nav.csv"},
                                   none,
                                   nullptr));
    texts["what a survey writes"] = navigation_text(flight({}, 1, 3), ".tif");
    const Ifdo ifdo = parse_ifdo("set.yaml",
                                 "image-set-header:\n  image-set-ifdo-version: v2.1.0\n"
                                 "  image-altitude-meters: 1234567.5\nimage-set-items:\n"
                                 "  a.jpg:\n    image-altitude-meters: 12.5\n");
    texts["an iFDO"] = ifdo_text(ifdo) + ifdo.header().dump();
}

Texts all_texts() {
    Texts texts;
    add_rigs(texts);
    add_fitted(texts);
    add_design(texts);
    add_beams(texts);
    add_navigation(texts);
    texts["JSON"] = json_text(parse_json(R"({"a": 12.5, "b": 1234567, "c": 1e-3})", "text"));
    texts["a page"] = plain(1234567.5) + scientific(12.5) + power_label(2.5, 3) + grouped(1234567);
    return texts;
}

TEST(Locale, OfTheHostChangesNoByte) {
    const Texts expected = all_texts();
    const std::vector<CameraCalibration> expected_calibrations = calibrations();
    const CommaLocale commas;
    const Texts found = all_texts();
    EXPECT_EQ(calibrations(), expected_calibrations);
    for (const auto& [name, text] : expected) EXPECT_EQ(found.at(name), text) << name;
    if (!commas.has_c()) GTEST_SKIP() << "no locale with commas for the C library";
}

}  // namespace
}  // namespace aphotic::locale_test
