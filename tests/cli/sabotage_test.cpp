// SPDX-License-Identifier: BSD-3-Clause
//
// `aphotic validate` must be able to say no. Each entry spoils a render in one way that leaves a
// plausible picture; the command must end with status 1 and name the worst wavelength or channel.
#include "base/sha256.h"
#include "image/exr.h"
#include "light/veil.h"
#include "rig/file/rig_reader.h"
#include "scene_gen/veil_planes.h"
#include "spectral/manifest.h"
#include "support/command_test.h"
#include "support/scene_text.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <regex>
#include <set>

namespace aphotic::sabotage_test {
namespace {

// A floor and lamps without symmetry, few pixels; each entry changes one line of it.
const Arguments kWavelengths("--wavelengths 470,550,620");

// What the command must name as the worst. What the water takes is most where it absorbs most.
// Tables of the sensor touch no radiance. Geometry and weights of cones have no wavelength of their
// own: whatever is the worst, nothing may hold.
const std::string kAnyWavelength = "470 nm|550 nm|620 nm";
const std::string kMostAbsorbed = "620 nm";
const std::string kAnyChannel = "R|G|B";
const std::string kAllOfThem = kAnyWavelength + "|" + kAnyChannel;

std::string honest_rig() {
    return with(scene_text("habcam.toml"),
                {{"resolution", "[34, 26]"}, {"pixel_pitch_um", "258.0"}, {"roll_deg", "3.0"}});
}

std::string rig_behind_a_port() {
    return replaced(honest_rig(),
                    "[water]",
                    "[camera.port]\nshape = \"flat\"\ndistance_mm = 50.0\nthickness_mm = 12.0\n"
                    "glass = \"bk7\"\n\n[water]");
}

std::string rig_with_emitters() {
    return replaced(
        honest_rig(), "beam       = \"fresnel\"", "beam = \"fresnel\"\nemitter_mm = [63.5, 30.2]");
}

std::string rig_with_beam(const std::string& lines) {
    const std::string honest = honest_rig();
    const std::size_t first = honest.find("weights = \"flux\"");
    const std::size_t last = honest.find("[[strobe]]");
    return honest.substr(0, first) + lines + "\n\n" + honest.substr(last);
}

// Angles that types B and C both allow; what they mean by them differs.
std::string ies_of_type(int type) {
    return "IESNA:LM-63-2002\n[TEST] made\n[TESTLAB] none\n[ISSUEDATE] none\n[MANUFAC] none\n"
           "TILT=NONE\n1 1000 1 4 3 " +
           std::to_string(type) +
           " 2 0 0 0\n1 1 10\n0 30 60 90\n0 45 90\n"
           "900 700 200 0\n800 500 100 0\n600 300 50 0\n";
}

constexpr double kScattering_per_m = 0.3;

std::string rig_in_scattering_water() {
    return replaced(honest_rig(),
                    "multiple   = 1.0",
                    "scattering = \"b.csv\"\nphase = { henyey_greenstein = 0.8 }");
}

// Of the edges that an emitter softens: many times any bound.
constexpr double kFarOut = 0.01;

// Sharp cones in water that scatters are far from what light of all orders does. Both renderers
// have the same model.
const Arguments kAnyModel("--model-tolerance 1");

class Sabotage : public CommandTest {
  protected:
    void expect_no(const std::string& worst, const CommandResult& run) {
        done(run, "DISAGREE", kAnswerIsNo);
        const std::regex named("worst against its bound: (" + worst + ") at column");
        EXPECT_TRUE(std::regex_search(run.out, named)) << "not " << worst << ": " << run.out;
        const auto json = json_in("out/validation.json");
        EXPECT_FALSE(json.at("holds").get<bool>());
        for (const char* list : {"wavelengths", "channels"}) {
            for (const auto& one : json.at(list)) {
                if (worst == kAllOfThem) {
                    EXPECT_FALSE(one.at("holds").get<bool>()) << one.dump();
                }
                if (worst == kAnyChannel && list == std::string("wavelengths")) {
                    EXPECT_TRUE(one.at("holds").get<bool>()) << one.dump();
                }
            }
        }
    }

    double worst_error() {
        return json_in("out/validation.json").at("worst").at("max_error").get<double>();
    }

    CommandResult validate(const Arguments& more,
                           const std::map<std::string, std::string>& environment = {}) {
        return aphotic("validate rig.toml -o out" + kAnyModel + more, environment);
    }

    // Several tests spoil the same rig, whose honest render need pass but once.
    static bool is_first(const std::string& command, const std::string& rig) {
        static std::set<std::pair<std::string, std::string>> seen;
        return seen.emplace(command, rig).second;
    }

    // Scenes are changed on their way into POV-Ray, by a POV-Ray that edits them with sed.
    void expect_no_when_scenes_are(const std::string& worst,
                                   const std::string& sed_program,
                                   const std::string& rig = honest_rig()) {
        write_file(path("rig.toml"), rig);
        if (is_first("validate", rig)) {
            done(validate(kWavelengths));  // the honest render must pass
            std::filesystem::remove_all(path("out"));
        }
        // The first of several at once edits, the others wait.
        write_script(path("povray"),
                     "if [ -f aphotic.inc ]; then\n"
                     "  if mkdir editing 2>/dev/null; then\n"
                     "    cat *.pov *.inc > before && sed -i '" +
                         sed_program +
                         "' *.pov *.inc\n"
                         "    cat *.pov *.inc | cmp -s - before && exit 9\n"
                         "    touch edited\n"
                         "  fi\n"
                         "  while [ ! -f edited ]; do sleep 0.05; done\n"
                         "fi\n"
                         "exec povray \"$@\"\n");
        expect_no(worst, validate(kWavelengths, {{"APHOTIC_POVRAY", path("povray").string()}}));
    }

    // The render is of another rig than the one it is held against.
    void expect_no_when_rendered_from(const std::string& worst,
                                      const std::string& spoilt,
                                      const std::string& honest,
                                      const Arguments& wavelengths = kWavelengths) {
        write_file(path("rig.toml"), honest);
        write_file(path("spoilt.toml"), spoilt);
        if (is_first("render", honest)) {
            render("rig.toml", "honest", wavelengths);
            done(validate("--rendered honest"));  // the honest render must pass
        }
        render("spoilt.toml", "spoilt", wavelengths);
        expect_no(worst, validate("--rendered spoilt"));
    }

    void render(const std::string& rig, const std::string& to, const Arguments& wavelengths) {
        done(fmt::format("render {} -o {}", rig, to) + kAnyModel + wavelengths);
    }

    // The frames are right, the manifest by which they are put together is not.
    void expect_no_when_integrated_with(const std::string& worst,
                                        const std::function<void(Manifest&)>& spoil) {
        write_file(path("rig.toml"), honest_rig());
        render("rig.toml", "spoilt", kWavelengths);
        done(validate("--rendered spoilt"));  // the honest render must pass
        Manifest manifest = read_manifest(path("spoilt"));
        spoil(manifest);
        write_manifest(path("spoilt"), manifest);
        done("integrate spoilt");
        expect_no(worst, validate("--rendered spoilt"));
    }

    // The frames are right; the veil beside them is another. redo: the honest veil, made anew by
    // what spoils it, must pass.
    using VeilMaker = std::function<std::optional<ManifestVeil>(
        const std::filesystem::path& folder, const Rig& rig, const Manifest& manifest)>;
    static std::optional<ManifestVeil> honest_veil(const std::filesystem::path& folder,
                                                   const Rig& rig,
                                                   const Manifest& manifest) {
        return write_veil(folder, rig, manifest, 1);
    }
    void expect_no_when_the_veil_is(const VeilMaker& spoil, const VeilMaker& redo = honest_veil) {
        write_file(path("b.csv"), "wavelength_nm,scattering_per_m\n400,0.3\n720,0.3\n");
        write_file(path("rig.toml"), rig_in_scattering_water());
        render("rig.toml", "spoilt", kWavelengths);
        take_veil(redo);
        done(validate("--rendered spoilt"));  // the honest render must pass
        take_veil(spoil);
        expect_no(kAllOfThem, validate("--rendered spoilt"));
    }

    void take_veil(const VeilMaker& make) {
        const std::filesystem::path folder = path("spoilt");
        Manifest manifest = read_manifest(folder);
        manifest.veil = make(folder, read_rig(path("rig.toml")), manifest);
        write_manifest(folder, manifest);
        done("integrate spoilt");
    }

    // The veil of another rig.
    static VeilMaker veil_of(const std::function<void(Rig&)>& spoil) {
        return [spoil](const std::filesystem::path& folder, Rig rig, const Manifest& manifest) {
            spoil(rig);
            return honest_veil(folder, rig, manifest);
        };
    }

    // scenes/objects.toml, in a folder that has its mesh.
    std::string rig_with_objects() {
        put_small_scene("objects.toml", home_);
        return text_of("rig.toml");
    }
};

TEST_F(Sabotage, WaterAsAContainersMedia) {
    expect_no_when_scenes_are(
        kMostAbsorbed,
        "s/^ *media {\\(.*\\)}$/sphere { 0, 100 hollow pigment { rgbt 1 } interior { media {\\1} } "
        "}/");
}

TEST_F(Sabotage, MediaAttenuationLeftOff) {
    expect_no_when_scenes_are(kMostAbsorbed, "s/media_attenuation on//");
}

TEST_F(Sabotage, ShadowlessLamps) {
    expect_no_when_scenes_are(kMostAbsorbed,
                              "s/media_attenuation on/media_attenuation on shadowless/");
}

// Two metres of altitude: a fade distance of 0.2 m.
TEST_F(Sabotage, FadeDistanceATenthOfTheRange) {
    expect_no_when_scenes_are(
        kAllOfThem,
        "s/#declare Aphotic_Fade_Distance = .*;$/#declare Aphotic_Fade_Distance = 0.2;/");
}

TEST_F(Sabotage, HollowHousing) {
    expect_no_when_scenes_are(kMostAbsorbed, "s/no_shadow/no_shadow hollow/", rig_behind_a_port());
}

TEST_F(Sabotage, RightWithTheWrongSign) {
    expect_no_when_scenes_are(kAllOfThem, "s/right x/right -x/");
}

TEST_F(Sabotage, PitchWithTheWrongSign) {
    const std::string honest = honest_rig();
    expect_no_when_rendered_from(
        kAllOfThem, replaced(honest, "pitch_deg  = 5.0", "pitch_deg  = -5.0"), honest);
}

TEST_F(Sabotage, LiteralForFluxWeights) {
    const std::string honest = honest_rig();
    expect_no_when_rendered_from(
        kAllOfThem, replaced(honest, "weights = \"flux\"", "weights = \"literal\""), honest);
}

TEST_F(Sabotage, OneStrobeMissing) {
    const std::string honest = honest_rig();
    expect_no_when_rendered_from(kAllOfThem, honest.substr(0, honest.rfind("[[strobe]]")), honest);
}

TEST_F(Sabotage, HalfTheEmitter) {
    const std::string honest = rig_with_emitters();
    expect_no_when_rendered_from(
        kAllOfThem, replaced(honest, "[63.5, 30.2]", "[31.75, 30.2]"), honest);
    EXPECT_GT(worst_error(), kFarOut);
}

TEST_F(Sabotage, EmitterTurnedBy90Degrees) {
    const std::string honest = rig_with_emitters();
    expect_no_when_rendered_from(
        kAllOfThem, replaced(honest, "[63.5, 30.2]", "[30.2, 63.5]"), honest);
    EXPECT_GT(worst_error(), kFarOut);
}

// A whole number is the centre of OpenCV's pixels, and the edge of COLMAP's.
TEST_F(Sabotage, LensHalfAPixelOff) {
    write_file(path("cameras.txt"), "1 OPENCV 34 26 47 46 17.5 12.5 -0.2 0.05 0.002 -0.001\n");
    write_file(path("half.txt"), "1 OPENCV 34 26 47 46 17 12 -0.2 0.05 0.002 -0.001\n");
    const std::string honest =
        replaced(honest_rig(), "focal_length_mm = 12.0", "calibration = \"cameras.txt\"");
    expect_no_when_rendered_from(kAllOfThem, replaced(honest, "cameras", "half"), honest);
}

TEST_F(Sabotage, TangentialTermsSwapped) {
    write_file(path("cameras.txt"), "1 OPENCV 34 26 47 46 17.5 12.5 -0.2 0.05 0.002 -0.001\n");
    write_file(path("swapped.txt"), "1 OPENCV 34 26 47 46 17.5 12.5 -0.2 0.05 -0.001 0.002\n");
    const std::string honest =
        replaced(honest_rig(), "focal_length_mm = 12.0", "calibration = \"cameras.txt\"");
    expect_no_when_rendered_from(kAllOfThem, replaced(honest, "cameras", "swapped"), honest);
}

TEST_F(Sabotage, VignettingLeftOut) {
    const std::string honest = replaced(
        honest_rig(), "focal_length_mm = 12.0", "focal_length_mm = 12.0\nvignetting = \"natural\"");
    expect_no_when_rendered_from(kAllOfThem, honest_rig(), honest);
}

TEST_F(Sabotage, PortThatIsNotTilted) {
    const std::string honest = replaced(
        rig_behind_a_port(), "shape = \"flat\"", "shape = \"flat\"\nnormal = [0.05, -0.03, 1]");
    expect_no_when_rendered_from(kAllOfThem, rig_behind_a_port(), honest);
}

TEST_F(Sabotage, DomeAMillimetreOffItsPlace) {
    const std::string honest =
        replaced(rig_behind_a_port(),
                 "shape = \"flat\"\ndistance_mm = 50.0",
                 "shape = \"dome\"\nradius_mm = 50.0\ncentre_mm = [2, -1, 3]");
    expect_no_when_rendered_from(kAllOfThem, replaced(honest, "[2, -1, 3]", "[2, 0, 3]"), honest);
}

// The tables are the built-in ones, given as the user's own.
TEST_F(Sabotage, QuantumEfficiencyTakenForEnergyResponse) {
    write_file(path("rgb.csv"), aphotic("data nikon-d5100 --csv").out);
    const std::string honest =
        replaced(honest_rig(), "\"nikon-d5100\"", "{ table = \"rgb.csv\", kind = \"quantum\" }");
    expect_no_when_rendered_from(
        kAnyChannel, replaced(honest, "\"quantum\"", "\"energy\""), honest, "--bands 36");
}

TEST_F(Sabotage, TableShiftedByOneKnot) {
    const std::string csv = aphotic("data pope-fry-1997 --csv").out;
    // Every value one row later than its wavelength; the first stands twice.
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    std::string shifted = line + "\n";
    std::string before;
    while (std::getline(lines, line)) {
        const auto comma = line.find(',');
        const std::string value = line.substr(comma);
        shifted += line.substr(0, comma) + (before.empty() ? value : before) + "\n";
        before = value;
    }
    // From one knot to the next the absorption differs most in the red.
    write_file(path("water.csv"), csv);
    write_file(path("shifted.csv"), shifted);
    const std::string honest = replaced(honest_rig(), "\"pope-fry-1997\"", "\"water.csv\"");
    expect_no_when_rendered_from("620 nm|R", replaced(honest, "water.csv", "shifted.csv"), honest);
}

TEST_F(Sabotage, ObjectsWithoutShadows) {
    expect_no_when_scenes_are(
        kAnyWavelength, "s/^   pigment/   no_shadow pigment/", rig_with_objects());
}

TEST_F(Sabotage, AnObjectMovedByACentimetre) {
    const std::string honest = rig_with_objects();
    expect_no_when_rendered_from(
        kAnyWavelength, replaced(honest, "[-0.2, 0.05, 1.86]", "[-0.19, 0.05, 1.86]"), honest);
}

TEST_F(Sabotage, AnObjectOfAnotherMaterial) {
    const std::string honest = rig_with_objects();
    expect_no_when_rendered_from(
        kAnyWavelength, replaced(honest, "brown-algae", "red-algae"), honest);
}

TEST_F(Sabotage, ExposuresNotTakenOut) {
    expect_no_when_integrated_with(kAnyWavelength, [](Manifest& manifest) {
        for (PlannedWavelength& w : manifest.wavelengths) w.exposure_log2 = 0;
    });
}

TEST_F(Sabotage, TwoWavelengthsOfAFrameSwapped) {
    expect_no_when_integrated_with("470 nm|550 nm", [](Manifest& manifest) {
        std::swap(manifest.wavelengths[0].channel, manifest.wavelengths[1].channel);
        std::swap(manifest.wavelengths[0].exposure_log2, manifest.wavelengths[1].exposure_log2);
    });
}

TEST_F(Sabotage, AWindowWithoutTheSquareOfTheIndex) {
    expect_no_when_scenes_are(
        kAllOfThem,
        "s/w \\* w \\* e/e/",
        rig_with_beam("fwhm_deg = 100\nmeasured_in = \"air\"\nwindow = \"pmma\""));
}

TEST_F(Sabotage, AShellTooSmall) {
    write_file(path("lamp.csv"), "theta_deg,intensity\n0,4\n20,3\n50,1\n90,0\n");
    expect_no_when_scenes_are(kAllOfThem,
                              "s/Aphotic_Shell_Radius = 0.0011/Aphotic_Shell_Radius = 0.0005/",
                              rig_with_beam("table = \"lamp.csv\""));
}

TEST_F(Sabotage, APatternOverOne) {
    write_file(path("lamp.csv"), "theta_deg,intensity\n0,4\n20,3\n50,1\n90,0\n");
    expect_no_when_scenes_are(
        kAllOfThem,
        "s/min(1, max(0, Intensity \\(.*\\) . Most))/1.5 * Intensity \\1 \\/ Most/",
        rig_with_beam("table = \"lamp.csv\""));
}

TEST_F(Sabotage, ATableTurnedTheOtherWay) {
    write_file(path("lamp.ies"), ies_of_type(2));
    const std::string honest = rig_with_beam("table = \"lamp.ies\"\nturn_deg = 30");
    expect_no_when_rendered_from(
        kAllOfThem, replaced(honest, "turn_deg = 30", "turn_deg = -30"), honest);
}

TEST_F(Sabotage, TypeBReadAsC) {
    write_file(path("b.ies"), ies_of_type(2));
    write_file(path("c.ies"), ies_of_type(1));
    const std::string honest = rig_with_beam("table = \"b.ies\"");
    expect_no_when_rendered_from(kAllOfThem, replaced(honest, "b.ies", "c.ies"), honest);
}

ManifestVeil put_veil(const std::filesystem::path& folder,
                      const Manifest& manifest,
                      std::span<const float> planes) {
    const std::filesystem::path file = veil_path(folder);
    ExrWriter writer(file, manifest.width_px, manifest.height_px, veil_channels(manifest), {});
    writer.write_rows(manifest.height_px, planes);
    writer.finish();
    return {.sha256 = sha256_of_file(file)};
}

// Point by point along each pixel's ray, the channels by a rule of 1 nm; lamp_leg: the share of the
// way from the lamp that is lost on.
ManifestVeil veil_by_points(const std::filesystem::path& folder,
                            const Rig& rig,
                            const Manifest& manifest,
                            double lamp_leg) {
    const Veil veil(rig);
    std::vector<double> lambda_nm;
    for (double nm = rig.camera.range.first_nm + 0.5; nm < rig.camera.range.last_nm; nm += 1.0)
        lambda_nm.push_back(nm);
    const std::size_t first_plane = lambda_nm.size();
    for (const PlannedWavelength& w : manifest.wavelengths) lambda_nm.push_back(w.lambda_nm);
    const auto pixels =
        static_cast<std::size_t>(manifest.width_px) * static_cast<std::size_t>(manifest.height_px);
    std::vector<float> planes(veil_channels(manifest).size() * pixels);
    VeilNodes nodes;
    for (std::size_t i = 0; i < pixels; ++i) {
        const auto width = static_cast<std::size_t>(manifest.width_px);
        const auto [ray, length_m] = sight_of(rig,
                                              static_cast<double>(i % width) + 0.5,
                                              static_cast<double>(i / width) + 0.5,
                                              lambda_nm.front());
        std::vector<double> radiance(lambda_nm.size());
        for (std::size_t part = 0; part < veil.strobe_of_part().size(); ++part) {
            const Strobe& strobe = rig.strobes[veil.strobe_of_part()[part]];
            veil.nodes(part, ray, length_m, nodes);
            const Eigen::Vector3d lamp = strobe.position_m - ray.origin_m;
            std::vector<double> lost_m;
            for (const double path_m : nodes.path_m) {
                // t of t + d, where d^2 = |lamp|^2 - 2 t u.lamp + t^2
                const double t = (path_m * path_m - lamp.squaredNorm()) /
                                 (2.0 * (path_m - ray.direction.dot(lamp)));
                lost_m.push_back(t + lamp_leg * (path_m - t));
            }
            for (std::size_t j = 0; j < lambda_nm.size(); ++j) {
                const double loss_per_m = rig.water.attenuation_per_m(lambda_nm[j]);
                double sum = 0.0;
                for (std::size_t n = 0; n < lost_m.size(); ++n)
                    sum += nodes.weight[0][n] * std::exp(-loss_per_m * lost_m[n]);
                radiance[j] += strobe.power * strobe.spectrum.at(lambda_nm[j]) *
                               rig.water.scattering_per_m(0, lambda_nm[j]) * sum;
            }
        }
        for (std::size_t c = 0; c < kChannels; ++c) {
            double signal = 0.0;
            for (std::size_t j = 0; j < first_plane; ++j) {
                signal +=
                    radiance[j] * rig.camera.sensor.response(static_cast<int>(c), lambda_nm[j]);
            }
            planes[c * pixels + i] = static_cast<float>(signal);
        }
        for (std::size_t j = first_plane; j < radiance.size(); ++j) {
            planes[(kChannels + j - first_plane) * pixels + i] = static_cast<float>(radiance[j]);
        }
    }
    return put_veil(folder, manifest, planes);
}

TEST_F(Sabotage, FourPiDroppedFromThePhaseFunction) {
    expect_no_when_the_veil_is(
        [](const std::filesystem::path& folder, const Rig&, const Manifest& manifest) {
            std::vector<float> planes =
                ExrReader(veil_path(folder)).planes(veil_channels(manifest));
            for (float& sample : planes) sample *= 4.0F * std::numbers::pi_v<float>;
            return put_veil(folder, manifest, planes);
        });
}

TEST_F(Sabotage, TheSignOfG) {
    expect_no_when_the_veil_is(veil_of([](Rig& rig) {
        auto& phase = std::get<HenyeyGreenstein>(rig.water.scatterers.front().phase.kind);
        phase.g = -phase.g;
    }));
}

// c for K: what is turned by less than the cut is taken for lost, too.
TEST_F(Sabotage, TheVeilLosesAllOfC) {
    expect_no_when_the_veil_is(veil_of([](Rig& rig) {
        const double share = rig.water.scatterers.front().phase.share_within(kLossCut);
        const Spectrum& a = rig.water.absorption_per_m;
        std::vector<double> values(a.values().begin(), a.values().end());
        for (double& value : values) value += kScattering_per_m * share;
        rig.water.absorption_per_m = {
            a.name(), {a.lambda_nm().begin(), a.lambda_nm().end()}, std::move(values)};
    }));
}

TEST_F(Sabotage, TheLampsLegOfTheVeilIsNotLost) {
    const auto with_leg = [](double lamp_leg) {
        return [lamp_leg](
                   const std::filesystem::path& folder, const Rig& rig, const Manifest& manifest) {
            return veil_by_points(folder, rig, manifest, lamp_leg);
        };
    };
    expect_no_when_the_veil_is(with_leg(0.0), with_leg(1.0));
}

// As bright on the axis, and without an end.
TEST_F(Sabotage, ConesAreNotCutInTheVeil) {
    expect_no_when_the_veil_is(veil_of([](Rig& rig) {
        for (Strobe& strobe : rig.strobes) {
            strobe.beam.weights = ConeWeights::Literal;
            for (Cone& cone : strobe.beam.cones) {
                const double sine = std::sin(cone.half_angle_rad);
                cone.weight /= std::numbers::pi * sine * sine;
                cone.half_angle_rad = 0.5 * std::numbers::pi;
            }
        }
    }));
}

TEST_F(Sabotage, TheVeilGoesOnBehindTheFloor) {
    expect_no_when_the_veil_is(veil_of([](Rig& rig) { rig.sled.altitude_m *= 100.0; }));
}

// Jerlov's K_d of type 3C (1976), as a user's absorption, for the type. Both renderers take the
// rig's word for it, so nothing but another rig can tell; what calls itself K_d is refused by the
// reader (CurvesOf.RefusesDaylightsAttenuation).
TEST_F(Sabotage, DaylightsAttenuationTakenForAbsorption) {
    write_file(path("kd.csv"),
               "wavelength_nm,absorption_per_m\n400,0.78\n425,0.54\n450,0.39\n475,0.29\n500,0.22\n"
               "525,0.2\n550,0.19\n575,0.21\n600,0.33\n625,0.4\n650,0.46\n675,0.56\n700,0.71\n");
    const std::string range = replaced(honest_rig(), "[400, 720]", "[400, 700]");
    const std::string honest =
        replaced(replaced(range, "absorption = \"pope-fry-1997\"", "type = \"jerlov-3C\""),
                 "multiple   = 1.0",
                 "");
    expect_no_when_rendered_from(
        kAllOfThem, replaced(range, "\"pope-fry-1997\"", "\"kd.csv\""), honest);
}

}  // namespace
}  // namespace aphotic::sabotage_test
