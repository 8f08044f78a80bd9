// SPDX-License-Identifier: BSD-3-Clause
#include "rig/file/rig_reader.h"

#include "base/atomic_file.h"
#include "base/degrees.h"
#include "base/error.h"
#include "base/offered.h"
#include "base/printable.h"
#include "image/image_size.h"
#include "rig/beam/photometric_file.h"
#include "rig/camera/calibration_file.h"
#include "rig/camera/lens.h"
#include "rig/file/key_depth.h"
#include "rig/file/mesh_reader.h"
#include "rig/file/rig_files.h"
#include "rig/file/section.h"
#include "rig/file/water_reader.h"
#include "rig/geometry.h"
#include "rig/solid.h"
#include "spectral/curve_loader.h"
#include "spectral/lamp_flux.h"
#include "spectral/refractive_index.h"
#include "spectral/table.h"

#include <fmt/format.h>
#include <toml++/toml.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>

namespace aphotic {
namespace {

namespace fs = std::filesystem;

constexpr double kMetresPerMillimetre = 1e-3;
constexpr double kMetresPerMicrometre = 1e-6;

// A rig with a thousand strobes, each in full, has a fiftieth of this size.
constexpr std::size_t kMostRigBytes = 8 * kMebibyte;

// For all strobes together: POV-Ray's limit in clear water (pov_scene.cpp).
constexpr std::size_t kMostCones = 100'000;

// Limits of a rig. Wide enough for any sled, narrow enough to catch a wrong unit.
constexpr Bounds kAltitudeM{kLeastAltitude_m, kMostAltitude_m};
constexpr Bounds kTiltDeg{-kMostTilt_deg, kMostTilt_deg};
constexpr Bounds kResolutionPx{1.0, kLargestImagePx};
constexpr Bounds kPixelPitchUm{0.01, 10000.0};
constexpr Bounds kFocalLengthMm{0.01, 100000.0};
constexpr Bounds kFovDeg{0.01, 175.0};
constexpr Bounds kVignettingTerm{-1e3, 1e3};
constexpr Bounds kScale{kLeastScale, 1.0};
constexpr Bounds kVignettingCosine{0.0, 50.0};
constexpr Bounds kLevelDn{0.0, 1e9};
constexpr Bounds kExposureMs{1e-4, 1e6};
constexpr Bounds kIso{0.1, 1e7};
constexpr Bounds kFNumber{0.1, 1000.0};
constexpr Bounds kGainDnPerE{1e-6, 1e6};
constexpr Bounds kReadNoiseE{0.0, 1e6};
constexpr Bounds kSaturationE{1.0, 1e9};
constexpr Bounds kWavelengthNm{100.0, 10000.0};
constexpr Bounds kPortDistanceMm{1.0, 10000.0};
constexpr Bounds kPortThicknessMm{1.0, 1000.0};
constexpr Bounds kDomeCentreMm{-10000.0, 10000.0};
constexpr double kMostPortTiltDeg = 60.0;
constexpr Bounds kPhong{0.0, 1e6};
constexpr Bounds kPhongSize{0.0, 1e6};
constexpr Bounds kHalfAngleDeg{0.001, 90.0};
constexpr Bounds kEdgeDeg{0.0, 90.0};
constexpr Bounds kConeWeight{0.0, 1e12};
constexpr Bounds kConeExponent{0.0, 1000.0};
constexpr Bounds kFwhmDeg{1.0, 179.9};
constexpr Bounds kTurnDeg{-360.0, 360.0};
constexpr Bounds kOpticsMm{0.01, 100000.0};
// Closer to 0, the light through a lens varies so steeply that its flux is not integrated to 1e-4.
constexpr Bounds kOpticsLengthMm{0.05, 100000.0};
constexpr Bounds kWindowIndex{1.0, 3.0};
constexpr Bounds kFlux{0.0, 1e12};
constexpr Bounds kPositionM{-1000.0, 1000.0};
constexpr Bounds kDirection{-1e6, 1e6};
constexpr Bounds kAimTiltDeg{0.0, 180.0};
constexpr Bounds kPower{0.0, 1e12};
constexpr Bounds kEmitterMm{0.0, 10000.0};
// An object's size: POV-Ray ignores objects within a millimetre of the surface that they shade.
constexpr Bounds kRadiusM{0.001, 1000.0};
constexpr double kLeastSideM = 0.001;

// The direction in which navigation measures altitude.
void read_altitude_meaning(Section& sled, Mounting& mounting) {
    mounting.altitude_offset_m = sled.number_or("altitude_offset_m", kPositionM, 0.0);
    if (!sled.has("altitude_is")) return;
    const std::string word =
        sled.word("altitude_is", {kAltitudeWords.begin(), kAltitudeWords.end()});
    mounting.altitude_is =
        static_cast<AltitudeIs>(std::ranges::find(kAltitudeWords, word) - kAltitudeWords.begin());
}

Sled read_sled(Section section, Mounting& mounting) {
    // Before altitude_m, since they would otherwise be taken as its misspellings.
    read_altitude_meaning(section, mounting);
    const Sled sled{.altitude_m = section.number("altitude_m", kAltitudeM),
                    .pitch_rad = section.number_or("pitch_deg", kTiltDeg, 0.0) * kRadiansPerDegree,
                    .roll_rad = section.number_or("roll_deg", kTiltDeg, 0.0) * kRadiansPerDegree};
    section.refuse_unknown_keys();
    return sled;
}

Glass read_glass(Section& port) {
    const std::string name = port.text("glass", "a built-in glass");
    return port.at_key("glass", [&] { return builtin_glass(name); });
}

// A dome's own keys, besides those of all ports.
Dome read_dome(Section& section) {
    Dome dome{.radius_m = section.number("radius_mm", kPortDistanceMm) * kMetresPerMillimetre};
    dome.centre_m = section.vector_or("centre_mm", kDomeCentreMm) * kMetresPerMillimetre;
    if (dome.centre_m.norm() >= dome.radius_m)
        section.found_but("centre_mm", "the pupil, [0, 0, 0], within radius_mm of the centre");
    return dome;
}

Eigen::Vector3d read_port_normal(Section& section) {
    const Eigen::Vector3d normal =
        section.vector_or("normal", kDirection, Eigen::Vector3d::UnitZ());
    if (normal.z() < std::cos(kMostPortTiltDeg * kRadiansPerDegree) * normal.norm() ||
        normal.norm() == 0.0) {
        section.found_but("normal",
                          fmt::format("a direction within {} degrees of the camera's axis, "
                                      "[0, 0, 1]",
                                      kMostPortTiltDeg));
    }
    return normal.normalized();
}

PortWindow read_port(Section section) {
    const bool is_dome = section.word("shape", {"flat", "dome"}) == "dome";
    PortWindow port{.glass = read_glass(section)};
    if (is_dome) {
        port.dome = read_dome(section);
    } else {
        port.distance_m = section.number("distance_mm", kPortDistanceMm) * kMetresPerMillimetre;
        port.normal = read_port_normal(section);
    }
    port.thickness_m = section.number("thickness_mm", kPortThicknessMm) * kMetresPerMillimetre;
    section.refuse_unknown_keys();
    return port;
}

// Everything except the glass comes from the calibration.
PortWindow read_calibrated_port(Section section, const CalibratedPort& calibrated) {
    for (const std::string_view key :
         {"shape", "distance_mm", "thickness_mm", "normal", "radius_mm", "centre_mm"}) {
        if (section.has(key))
            section.fail_at(
                key,
                "found together with a calibration that describes the port; allowed: glass alone");
    }
    const auto& [distance_m, thickness_m, normal, dome] = calibrated;
    PortWindow port{.distance_m = distance_m,
                    .thickness_m = thickness_m,
                    .glass = read_glass(section),
                    .normal = normal,
                    .dome = dome};
    section.refuse_unknown_keys();
    return port;
}

Sensor read_response_table(Section response, RigFiles& files) {
    if (response.has("table")) {
        std::vector<Spectrum> channels = files.curves(response, "table", CurveRole::SensorResponse);
        const bool energy = response.word("kind", {"energy", "quantum"}) == "energy";
        response.refuse_unknown_keys();
        return {std::move(channels), energy ? ResponseKind::Energy : ResponseKind::Quantum};
    }
    const bool is_mono = response.has("quantum_efficiency") && !response.has("filters");
    std::vector<Spectrum> filters;
    if (!is_mono) filters = files.curves(response, "filters", CurveRole::FilterTransmittance);
    std::vector<Spectrum> efficiency =
        files.curves(response, "quantum_efficiency", CurveRole::QuantumEfficiency);
    response.refuse_unknown_keys();
    if (is_mono) return Sensor::mono(efficiency.front());
    return Sensor::filtered(std::move(filters), std::move(efficiency.front()));
}

Sensor read_response(Section& camera, RigFiles& files) {
    const std::string allowed =
        "a built-in response's name, { table = \"rgb.csv\", kind = \"energy\" } (or \"quantum\"), "
        "or { filters = \"rgb.csv\", quantum_efficiency = \"ccd.csv\" }, for a mono camera without "
        "filters";
    if (camera.required("response", allowed).is_table()) {
        return read_response_table(camera.section("response", allowed), files);
    }
    const std::string name = camera.text("response", allowed);
    // A file does not state whether its response is per energy or per photon, so its name alone is
    // not enough.
    if (names_a_file(name)) camera.found_but("response", allowed);
    return camera.at_key("response", [&] { return builtin_sensor(name); });
}

std::optional<CameraCalibration> read_calibration(Section& section, RigFiles& files) {
    section.refuse_both({"focal_length_mm", "fov_deg", "calibration"});
    if (!section.has("calibration")) return std::nullopt;
    const std::string name =
        section.text("calibration", "the name of a camera calibration beside the rig");
    return section.at_key("calibration", [&] {
        const std::string text = files.read(name, kMostCalibrationBytes);
        CameraCalibration calibration = parse_calibration(name, text);
        naming(name, [&] {
            require_to_hold(calibration.lens, calibration.width_px, calibration.height_px);
        });
        return std::optional(std::move(calibration));
    });
}

std::array<int, 2> read_size(Section& section,
                             const std::optional<CameraCalibration>& calibration) {
    if (calibration && !section.has("resolution"))
        return {calibration->width_px, calibration->height_px};
    const auto resolution = section.numbers<2>("resolution", kResolutionPx);
    for (const double size : resolution) {
        if (size != std::floor(size))
            section.found_but("resolution", "two whole numbers, width and height");
    }
    const std::array size{static_cast<int>(resolution[0]), static_cast<int>(resolution[1])};
    if (calibration && size != std::array{calibration->width_px, calibration->height_px}) {
        section.found_but(
            "resolution",
            fmt::format(
                "[{}, {}], the calibration's", calibration->width_px, calibration->height_px));
    }
    return size;
}

// One of: pitch and focal length, a field of view, a calibration. For the latter two, only the
// ratio of focal length and pitch matters.
void read_lens(Section& section,
               const std::optional<CameraCalibration>& calibration,
               Camera& camera) {
    if (!calibration && !section.has("fov_deg")) {
        camera.pixel_pitch_m =
            section.number("pixel_pitch_um", kPixelPitchUm) * kMetresPerMicrometre;
        camera.focal_length_m =
            section.number("focal_length_mm", kFocalLengthMm) * kMetresPerMillimetre;
        return;
    }
    constexpr double kAnyPitchUm = 1.0;
    camera.pixel_pitch_m =
        section.number_or("pixel_pitch_um", kPixelPitchUm, kAnyPitchUm) * kMetresPerMicrometre;
    if (!calibration) {
        const double fov_rad = section.number("fov_deg", kFovDeg) * kRadiansPerDegree;
        camera.focal_length_m =
            0.5 * camera.width_px * camera.pixel_pitch_m / std::tan(0.5 * fov_rad);
        return;
    }
    camera.focal_length_m = calibration->lens.focal_px.x() * camera.pixel_pitch_m;
    if (!is_pinhole(calibration->lens, camera.width_px, camera.height_px))
        camera.lens = calibration->lens;
}

TabulatedVignetting read_vignetting_table(Section& section, RigFiles& files) {
    const std::string name = section.text("table", "the name of a .csv file beside the rig");
    return section.at_key("table", [&] {
        const std::string text = files.read(name, kMostTableBytes);
        return parse_vignetting_csv(name, text);
    });
}

void read_vignetting(Section& camera_section, RigFiles& files, Camera& camera) {
    const std::string allowed =
        "\"natural\" (cos^4), { cosine = 3.5 }, { radial = [a1, a2, a3] } or "
        "{ table = \"vignetting.csv\" }";
    if (!camera_section.required("vignetting", allowed).is_table()) {
        if (camera_section.text("vignetting", allowed) != "natural")
            camera_section.found_but("vignetting", allowed);
        camera.vignetting = NaturalVignetting{};
        return;
    }
    Section section = camera_section.section("vignetting", allowed);
    section.refuse_both({"cosine", "radial", "table"});
    if (section.has("cosine")) {
        camera.vignetting = NaturalVignetting{section.number("cosine", kVignettingCosine)};
    } else if (section.has("radial")) {
        camera.vignetting = RadialVignetting{section.numbers<3>("radial", kVignettingTerm)};
    } else {
        camera.vignetting = read_vignetting_table(section, files);
    }
    section.refuse_unknown_keys();
    camera_section.at_key("vignetting", [&] { require_bright(camera); });
}

// The camera's position on the vehicle.
void read_place(Section& camera, Mounting& mounting) {
    mounting.position_m = camera.vector_or("position_m", kPositionM);
    mounting.roll_pitch_yaw_rad = camera.vector_or("orientation_deg", kTurnDeg) * kRadiansPerDegree;
}

// Keys used by surveys, not by renders.
Readout read_readout(Section& camera, bool is_mono) {
    const auto optional = [&](std::string_view key, Bounds bounds) {
        return camera.has(key) ? std::optional(camera.number(key, bounds)) : std::nullopt;
    };
    Readout readout{.black_level_dn = optional("black_level_dn", kLevelDn),
                    .white_level_dn = optional("white_level_dn", kLevelDn),
                    .exposure_ms = optional("exposure_ms", kExposureMs),
                    .iso = optional("iso", kIso),
                    .f_number = optional("f_number", kFNumber),
                    .gain_dn_per_e = optional("gain_dn_per_e", kGainDnPerE),
                    .read_noise_e = optional("read_noise_e", kReadNoiseE),
                    .saturation_e = optional("saturation_e", kSaturationE)};
    if (readout.white_level_dn && *readout.white_level_dn <= readout.black_level_dn.value_or(0.0))
        camera.found_but("white_level_dn", "a number over black_level_dn");
    if (is_mono) readout.bayer = "mono";
    if (!camera.has("bayer")) return readout;
    readout.bayer = camera.word("bayer", {"RGGB", "BGGR", "GRBG", "GBRG", "mono"});
    if ((readout.bayer == "mono") != is_mono) {
        camera.found_but("bayer",
                         is_mono ? "\"mono\", since the response has one channel"
                                 : "a colour pattern, since the response has three channels");
    }
    return readout;
}

Camera read_camera(Section section, RigFiles& files, Mounting& mounting) {
    section.refuse_keys_but(
        "name, resolution, pixel_pitch_um, focal_length_mm, fov_deg, calibration, vignetting, "
        "range_nm, "
        "response, port, black_level_dn, white_level_dn, bayer, exposure_ms, iso, f_number, "
        "gain_dn_per_e, read_noise_e, saturation_e, position_m, orientation_deg, scale");
    const std::optional<CameraCalibration> calibration = read_calibration(section, files);
    const auto [width_px, height_px] = read_size(section, calibration);
    Sensor sensor = read_response(section, files);
    WavelengthRange range = sensor.range();
    if (section.has("range_nm")) {
        const auto [first_nm, last_nm] = section.numbers<2>("range_nm", kWavelengthNm);
        if (first_nm >= last_nm)
            section.found_but("range_nm", "two wavelengths, the shorter one first");
        range = {first_nm, last_nm};
    }
    Camera camera{.width_px = width_px,
                  .height_px = height_px,
                  .range = range,
                  .sensor = std::move(sensor),
                  .port = std::nullopt};
    read_lens(section, calibration, camera);
    if (section.has("vignetting")) read_vignetting(section, files, camera);
    camera.readout = read_readout(section, camera.sensor.is_mono());
    if (calibration && calibration->port) {
        camera.port = read_calibrated_port(
            section.section("port", "a table with the glass of the calibration's port"),
            *calibration->port);
    } else if (section.has("port")) {
        camera.port = read_port(section.section("port", "a table"));
    }
    read_place(section, mounting);
    (void)section.text_or("name", "a string in quotes", "");  // chooses it (rig_cameras.h)
    if (section.has("scale")) {
        const double columns = std::round(section.number("scale", kScale) * camera.width_px);
        scale_to_width(camera, static_cast<int>(std::max(1.0, columns)));
    }
    return camera;
}

Seafloor read_seafloor(Section section, RigFiles& files) {
    Seafloor floor{
        .reflectance = files.curve(section, "reflectance", CurveRole::Reflectance, "sand"),
        .phong = section.number_or("phong", kPhong, 0.0),
        .phong_size = section.number_or("phong_size", kPhongSize, 40.0)};
    section.refuse_unknown_keys();
    return floor;
}

std::vector<Spectrum> read_materials(Section& top, RigFiles& files) {
    std::vector<Spectrum> materials;
    if (!top.has("materials")) return materials;
    const std::string allowed =
        "an array of built-in reflectances (aphotic data) or .csv files beside the rig";
    for (const std::string& name : top.texts("materials", allowed)) {
        materials.push_back(
            files.curves_named(top, "materials", name, CurveRole::Reflectance).front());
    }
    return materials;
}

Cone read_cone(Section& section) {
    Cone cone{.part = section.text("part", "a name in quotes"),
              .half_angle_rad = section.number("half_angle_deg", kHalfAngleDeg) * kRadiansPerDegree,
              .weight = section.number("weight", kConeWeight),
              .exponent = section.number_or("exponent", kConeExponent, 1.0),
              .edge_rad = section.number_or("edge_deg", kEdgeDeg, 0.0) * kRadiansPerDegree};
    if (cone.edge_rad > cone.half_angle_rad) {
        section.found_but("edge_deg", "up to half_angle_deg, where the cone ends");
    }
    // No cosine distinguishes such an edge from a sharp one.
    if (std::cos(cone.half_angle_rad - cone.edge_rad) == std::cos(cone.half_angle_rad))
        cone.edge_rad = 0.0;
    section.refuse_unknown_keys();
    return cone;
}

BeamOptics read_optics(Section& section) {
    const auto [along_mm, across_mm] = section.numbers<2>("diffuser_mm", kOpticsMm);
    const auto metres = [&](std::string_view key, const Bounds& bounds) {
        return section.number(key, bounds) * kMetresPerMillimetre;
    };
    return {.along_m = along_mm * kMetresPerMillimetre,
            .across_m = across_mm * kMetresPerMillimetre,
            .focal_length_m = metres("focal_length_mm", kOpticsLengthMm),
            .distance_m = metres("distance_mm", kOpticsLengthMm),
            .aperture_m = metres("aperture_mm", kOpticsMm)};
}

BeamTable read_beam_table(Section& section, RigFiles& files) {
    const std::string allowed =
        fmt::format("the name of a {} file beside the rig", kPhotometricEndings);
    const std::string name = section.text("table", allowed);
    if (!is_photometric_file_name(name)) section.found_but("table", allowed);
    return section.at_key("table", [&] {
        return normalised(
            parse_photometric_file(name, files.read(name, kMostPhotometricBytes)).table);
    });
}

BeamWindow read_window(Section& section, const Water& water) {
    const std::string allowed = fmt::format(
        "a built-in glass or its index, {} to {}", kWindowIndex.least, kWindowIndex.most);
    const toml::node& node = section.required("window", allowed);
    if (!node.is_string() && !node.is_number()) section.found_but("window", allowed);
    const double glass_index =
        node.is_number() ? section.number("window", kWindowIndex) : section.at_key("window", [&] {
            return builtin_glass(section.text("window", allowed)).index(kWindowIndex_nm);
        });
    return {.glass_index = glass_index, .water_index = water.refractive_index(kWindowIndex_nm)};
}

Beam read_beam(Section section, RigFiles& files, std::string name, const Water& water) {
    section.refuse_keys_but(
        "weights, cones, fwhm_deg, table, diffuser_mm, focal_length_mm, distance_mm, aperture_mm, "
        "turn_deg, measured_in, window");
    const auto refuse_beside = [&](const std::vector<std::string>& keys, const std::string& why) {
        for (const std::string& key : keys) {
            if (section.has(key)) section.fail_at(key, why);
        }
    };
    Beam beam{.name = std::move(name), .weights = ConeWeights::Flux, .cones = {}};
    const std::string_view kind =
        section.refuse_both({"table", "diffuser_mm", "fwhm_deg", "cones"});
    if (kind != "diffuser_mm") {
        refuse_beside({"focal_length_mm", "distance_mm", "aperture_mm"},
                      "found for a beam without a lens; allowed: with diffuser_mm");
    }
    if (kind == "table") {
        beam.pattern = read_beam_table(section, files);
        if (largest_intensity(std::get<BeamTable>(beam.pattern)) == 0.0) {
            section.found_but("table", "one with light in it");
        }
    } else if (kind == "diffuser_mm") {
        beam.pattern = read_optics(section);
    } else if (kind == "fwhm_deg") {
        const double half_rad = 0.5 * section.number("fwhm_deg", kFwhmDeg) * kRadiansPerDegree;
        beam.cones = {{.part = "fwhm",
                       .half_angle_rad = 0.5 * std::numbers::pi,
                       .weight = 1.0,
                       .exponent = std::log(0.5) / std::log(std::cos(half_rad))}};
    } else {
        if (section.has("weights") && section.word("weights", {"flux", "literal"}) == "literal") {
            beam.weights = ConeWeights::Literal;
        }
        const std::string allowed = "an array of { part, half_angle_deg, weight }";
        for (Section& cone : section.sections("cones", allowed)) {
            beam.cones.push_back(read_cone(cone));
        }
    }
    if (kind != "cones") {
        refuse_beside({"weights"}, "found for a beam without cones; allowed: with cones");
    }
    if (beam.cones.empty()) {
        beam.turn_rad = section.number_or("turn_deg", kTurnDeg, 0.0) * kRadiansPerDegree;
    } else {
        refuse_beside({"turn_deg"}, "found for a round beam; allowed: with table or diffuser_mm");
    }
    if (section.has("measured_in") && section.word("measured_in", {"water", "air"}) == "air") {
        beam.window = read_window(section, water);
    } else {
        refuse_beside({"window"}, "found for a beam in water; allowed: with measured_in = \"air\"");
    }
    return scaled_to_flux(std::move(beam));
}

Eigen::Vector3d axis_from_aim(Section aim, const Eigen::Vector3d& position_m) {
    aim.refuse_keys_but("tilt_deg, toward");
    const double tilt_rad = aim.number("tilt_deg", kAimTiltDeg) * kRadiansPerDegree;
    (void)aim.word("toward", {"axis"});
    const Eigen::Vector3d inward(-position_m.x(), -position_m.y(), 0.0);
    if (inward.norm() == 0.0) {
        if (tilt_rad == 0.0) return Eigen::Vector3d::UnitZ();
        aim.found_but(
            "toward",
            "direction = [x, y, z] instead of aim, since this strobe is on the camera's axis");
    }
    return std::cos(tilt_rad) * Eigen::Vector3d::UnitZ() + std::sin(tilt_rad) * inward.normalized();
}

Eigen::Vector3d read_axis(Section& strobe, const Eigen::Vector3d& position_m) {
    const std::string allowed =
        "either aim = { tilt_deg = 26.0, toward = \"axis\" } or direction = [x, y, z]";
    const bool has_direction = strobe.has("direction");
    if (strobe.has("aim") && has_direction) strobe.found_but("direction", allowed);
    if (!has_direction) return axis_from_aim(strobe.section("aim", allowed), position_m);
    const auto [x, y, z] = strobe.numbers<3>("direction", kDirection);
    const Eigen::Vector3d direction(x, y, z);
    if (direction.norm() == 0.0) strobe.found_but("direction", "a vector that is not zero");
    return direction.normalized();
}

Emitter read_emitter(Section& strobe) {
    const auto [across_mm, along_mm] = strobe.numbers<2>("emitter_mm", kEmitterMm);
    return {.across_m = across_mm * kMetresPerMillimetre,
            .along_m = along_mm * kMetresPerMillimetre};
}

// Phi(lambda) = power S(lambda) of the table S: for a lamp of known flux, power is that over the
// integral of S, for lumens 683 lm/W times that of S V with the CIE's V(lambda).
double read_power(Section& strobe, const Spectrum& spectrum) {
    const std::string_view kind =
        strobe.refuse_both({"power", "luminous_flux_lm", "radiant_flux_w", "energy_j"});
    if (kind.empty()) return 1.0;
    const double value = strobe.number(kind, kind == "power" ? kPower : kFlux);
    if (kind == "power") return value;
    const bool is_luminous = kind == "luminous_flux_lm";
    const double of_table = is_luminous ? luminous_flux_lm(spectrum) : radiant_flux_w(spectrum);
    if (!(of_table > 0.0)) {
        strobe.fail_at(kind,
                       fmt::format("found with a spectrum that has {}; allowed: one that has some",
                                   is_luminous ? "no visible light" : "no light"));
    }
    return value / of_table;
}

Strobe read_strobe(Section section,
                   RigFiles& files,
                   const std::vector<Beam>& beams,
                   const Sled& sled) {
    const auto [x, y, z] = section.numbers<3>("position_m", kPositionM);
    if (height_above(floor_plane(sled), {x, y, z}) < kLeastDistance_m) {
        section.found_but(
            "position_m",
            fmt::format("a point at least {} m above the sea floor", kLeastDistance_m));
    }
    Strobe strobe{
        .name = section.text("name", "a name in quotes"),
        .position_m = {x, y, z},
        .axis = read_axis(section, {x, y, z}),
        .beam = {},
        .spectrum = files.curve(section, "spectrum", CurveRole::LampSpectrum, "xenon-flash"),
        .power = 1.0,
        .emitter = std::nullopt};
    strobe.power = read_power(section, strobe.spectrum);
    strobe.is_absolute =
        section.has("luminous_flux_lm") || section.has("radiant_flux_w") || section.has("energy_j");
    if (section.has("emitter_mm")) strobe.emitter = read_emitter(section);

    std::vector<std::string> names;
    for (const Beam& beam : beams) names.push_back(beam.name);
    const std::string wanted = section.word("beam", names);
    strobe.beam = *std::find_if(
        beams.begin(), beams.end(), [&](const Beam& beam) { return beam.name == wanted; });
    section.refuse_unknown_keys();
    return strobe;
}

Box read_box(Section& object) {
    const auto from_m = object.numbers<3>("from_m", kPositionM);
    const auto to_m = object.numbers<3>("to_m", kPositionM);
    const Eigen::Vector3d a(from_m.data());
    const Eigen::Vector3d b(to_m.data());
    if ((a - b).cwiseAbs().minCoeff() < kLeastSideM) {
        object.found_but(
            "to_m",
            fmt::format("a corner at least {} m from from_m along every axis", kLeastSideM));
    }
    return {.least_m = a.cwiseMin(b), .most_m = a.cwiseMax(b)};
}

Mesh read_mesh_of(Section& object, RigFiles& files) {
    const std::string allowed = "the name of a Wavefront .obj file beside the rig";
    const std::string name = object.text("file", allowed);
    if (!name.ends_with(".obj")) object.found_but("file", allowed);
    const Eigen::Vector3d position_m = object.vector_or("position_m", kPositionM);
    return object.at_key("file", [&] {
        const fs::path file = files.path_of(name);
        const std::string obj = files.read(name, kMostMeshBytes);
        return parse_mesh(file.string(), obj, position_m);
    });
}

// The key gives the object's place, and so the place for messages about it.
constexpr std::string_view place_key(const std::string_view shape) {
    if (shape == "sphere") return "centre_m";
    return shape == "box" ? "from_m" : "file";
}

Shape read_shape(Section& object, RigFiles& files, std::string_view key) {
    if (key == place_key("box")) return read_box(object);
    if (key == place_key("mesh")) return read_mesh_of(object, files);
    const auto centre_m = object.numbers<3>("centre_m", kPositionM);
    return Sphere{.centre_m = Eigen::Vector3d(centre_m.data()),
                  .radius_m = object.number("radius_m", kRadiusM)};
}

void require_place(const Shape& shape, const std::vector<Strobe>& strobes) {
    if (holds(shape, Eigen::Vector3d::Zero())) {
        throw InputError("found the camera's pupil inside the object; allowed: outside");
    }
    for (const Strobe& strobe : strobes) {
        const double away_m = distance_m(shape, strobe.position_m);
        if (away_m >= kLeastDistance_m && !holds(shape, strobe.position_m)) continue;
        throw InputError(fmt::format(
            "found strobe '{}' inside the object or {} m from it; allowed: at least {} m",
            strobe.name,
            at_most(away_m),
            kLeastDistance_m));
    }
}

Object read_object(Section section, RigFiles& files, const std::vector<Strobe>& strobes) {
    std::string name = section.text("name", "a name in quotes");
    const std::string_view key = place_key(section.word("shape", {"sphere", "box", "mesh"}));
    Object object{
        .name = std::move(name),
        .shape = read_shape(section, files, key),
        .reflectance = files.curves(section, "reflectance", CurveRole::Reflectance).front(),
        .phong = section.number_or("phong", kPhong, 0.0),
        .phong_size = section.number_or("phong_size", kPhongSize, 40.0)};
    section.refuse_unknown_keys();
    section.at_key(key, [&] { require_place(object.shape, strobes); });
    return object;
}

std::vector<Object> read_objects(Section& top,
                                 RigFiles& files,
                                 const std::vector<Strobe>& strobes) {
    std::vector<Object> objects;
    std::set<std::string> names;
    if (!top.has("object")) return objects;
    for (Section& section : top.sections("object", "one or more tables [[object]]")) {
        objects.push_back(read_object(section, files, strobes));
        if (!names.insert(objects.back().name).second) section.found_but("name", "a unique name");
    }
    return objects;
}

// A refractive index is listed as a straight line over its range, since only the range matters.
Spectrum range_of_index(const std::string& what, WavelengthRange range) {
    return {
        fmt::format("refractive index of {}", what), {range.first_nm, range.last_nm}, {1.0, 1.0}};
}

// Every curve that the images need, over their range of integration.
void require_tables_to_cover_the_range(const Rig& rig) {
    std::vector<const Spectrum*> curves = rig.camera.sensor.curves();
    curves.push_back(&rig.seafloor.reflectance);
    for (const Spectrum& material : rig.materials) curves.push_back(&material);
    for (const Object& object : rig.objects) curves.push_back(&object.reflectance);
    std::ranges::copy(rig.water.curves(), std::back_inserter(curves));
    for (const Strobe& strobe : rig.strobes) curves.push_back(&strobe.spectrum);
    std::vector<Spectrum> indices;
    if (rig.camera.port) {
        const Glass& glass = rig.camera.port->glass;
        indices.push_back(range_of_index(fmt::format("'{}'", glass.name()), glass.range()));
        indices.push_back(range_of_index("seawater", kSeawaterIndexRange));
    }
    for (const Spectrum& index : indices) curves.push_back(&index);
    require_cover(curves, rig.camera.range);
}

std::vector<Beam> read_beams(Section& top, RigFiles& files, const Water& water) {
    Section sections = top.section("beam", "a table [beam.NAME]");
    const std::vector<std::string> names = sections.keys();
    if (names.empty()) top.found_but("beam", "at least one table [beam.NAME]");
    top.require_few("beam", names.size());
    std::vector<Beam> beams;
    for (const std::string& name : names) {
        sections.require_one_line(sections.required(name, ""), name, name);
        beams.push_back(read_beam(sections.section(name, "a table"), files, name, water));
    }
    return beams;
}

std::vector<Strobe> read_strobes(Section& top,
                                 RigFiles& files,
                                 const std::vector<Beam>& beams,
                                 const Sled& sled,
                                 const Water& water) {
    std::vector<Strobe> strobes;
    std::set<std::string> names;
    std::size_t cones = 0;
    for (Section& section : top.sections("strobe", "one or more tables [[strobe]]")) {
        strobes.push_back(read_strobe(section, files, beams, sled));
        if (!names.insert(strobes.back().name).second) section.found_but("name", "a unique name");
        if (water.scatters() && strobes.back().position_m.norm() < kLeastDistance_m) {
            section.found_but("position_m",
                              fmt::format("in water that scatters, a point at least {} m from the "
                                          "camera's pupil, since the veil is infinite there",
                                          kLeastDistance_m));
        }
        cones += strobes.back().beam.cones.size();
        if (cones <= kMostCones) continue;
        section.found_but("beam",
                          fmt::format("up to {} cones in all strobes together", kMostCones));
    }
    return strobes;
}

// Several are a rig for each (rig_cameras.h).
void require_one_camera(Section& top) {
    const toml::array* cameras = top.required("camera", "a table [camera]").as_array();
    if (cameras == nullptr) return;
    std::vector<std::string> names;
    for (const toml::node& camera : *cameras) {
        const toml::table* table = camera.as_table();
        if (table != nullptr) names.push_back((*table)["name"].value_or(std::string("?")));
    }
    top.fail_at("camera",
                fmt::format("found {} cameras; allowed: one of them, by --camera {}",
                            names.size(),
                            fmt::join(names, " or ")));
}

Rig read_all(Section top, RigFiles files, std::string toml) {
    std::string title = top.text_or("title", "a string in quotes", "");
    Mounting mounting;
    const Sled sled = read_sled(top.section("sled", "a table [sled]"), mounting);
    require_one_camera(top);
    Camera camera = read_camera(top.section("camera", "a table [camera]"), files, mounting);
    Water water = read_water(top.section("water", "a table [water]"), files);
    Seafloor seafloor = read_seafloor(top.section("seafloor", "a table [seafloor]"), files);

    const std::vector<Beam> beams = read_beams(top, files, water);
    std::vector<Strobe> strobes = read_strobes(top, files, beams, sled, water);
    std::vector<Spectrum> materials = read_materials(top, files);
    std::vector<Object> objects = read_objects(top, files, strobes);
    fs::path scene;
    if (top.has("scene")) {
        const std::string name = top.text("scene", "a POV-Ray scene beside the rig");
        scene = top.at_key("scene", [&] { return files.path_of(name); });
    }
    top.refuse_unknown_keys();

    std::string digest = files.digest(toml);
    Rig rig{.title = std::move(title),
            .sled = sled,
            .mounting = mounting,
            .camera = std::move(camera),
            .water = std::move(water),
            .seafloor = std::move(seafloor),
            .strobes = std::move(strobes),
            .materials = std::move(materials),
            .objects = std::move(objects),
            .scene = std::move(scene),
            .digest = std::move(digest),
            .toml = std::move(toml),
            .files = files.all()};
    const Section camera_section = top.section("camera", "a table [camera]");
    camera_section.at_key("range_nm", [&] { require_tables_to_cover_the_range(rig); });
    return rig;
}

}  // namespace

Rig parse_rig(std::string_view toml, const std::string& file_name, const fs::path& folder) {
    require_shallow_keys(toml, file_name);
    toml::table table;
    try {
        table = toml::parse(toml, file_name);
    } catch (const toml::parse_error& error) {
        throw InputError(
            "{}:{}: {}", file_name, error.source().begin.line, printable(error.description()));
    }
    Rig rig = read_all(Section(table, "", file_name), RigFiles(folder), std::string(toml));
    if (rig.title.empty()) rig.title = fs::path(file_name).stem().string();
    return rig;
}

Rig read_rig(const fs::path& file) {
    return parse_rig(read_text_file(file, kMostRigBytes), file.string(), file.parent_path());
}

}  // namespace aphotic
