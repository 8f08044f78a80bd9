// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_file.h"
#include "base/degrees.h"
#include "base/error.h"
#include "python/bindings.h"
#include "rig/file/rig_cameras.h"
#include "spectral/curve_loader.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <optional>

namespace aphotic::python {
namespace {

namespace fs = std::filesystem;

void set_key(RigText& text, const std::string& key, nb::handle value) {
    std::vector<double> numbers;
    if (value.is_none()) {
        text.erase(key);
    } else if (nb::isinstance<nb::str>(value)) {
        text.set(key, nb::cast<std::string>(value));
    } else if (double number = 0.0; nb::try_cast(value, number)) {
        text.set(key, number);
    } else if (nb::try_cast(value, numbers)) {
        text.set(key, numbers);
    } else {
        throw InputError("{}: found {}; allowed: a number, a string, a list of numbers, or None",
                         key,
                         nb::cast<std::string>(nb::repr(value)));
    }
}

TextRig replaced(const TextRig& rig, const nb::kwargs& keys) {
    RigText text = rig.text;
    for (const auto [key, value] : keys) set_key(text, nb::cast<std::string>(key), value);
    return TextRig(std::move(text));
}

double number_of(const TextRig& rig, const std::string& key) {
    const std::optional<double> number = rig.text.number(key);
    if (!number) throw nb::key_error(key.c_str());
    return *number;
}

void save(const TextRig& rig, const fs::path& file) {
    rig.text.copy_files(fs::absolute(file).parent_path());
    write_text_file(file, rig.text.text());
}

std::vector<std::string> strobe_names(const TextRig& rig) {
    std::vector<std::string> names;
    for (const Strobe& strobe : rig.rig.strobes) names.push_back(strobe.name);
    return names;
}

std::map<std::string, Table> builtin_spectra() {
    std::map<std::string, Table> all;
    for (const BuiltinTable& table : builtin_tables())
        all.emplace(table.name, builtin_table(table.name));
    return all;
}

Array<double, 2> values_of(const Table& table) {
    std::vector<double> values;
    for (const TableRow& row : table.rows)
        values.insert(values.end(), row.fields.begin(), row.fields.end());
    return table_of(std::move(values), table.columns.size());
}

}  // namespace

void bind_rig(nb::module_& module) {
    nb::class_<TextRig>(
        module, "Rig", "A sled, its camera, strobes, water and floor (docs/reference/rig.md).")
        .def_static(
            "load",
            [](const fs::path& file, const std::optional<std::string>& camera) {
                return TextRig(camera ? rig_of_camera(file, *camera) : RigText(file));
            },
            nb::arg("file"),
            nb::arg("camera") = nb::none(),
            "Read a rig file (TOML), as one of its cameras sees it if it has several.")
        .def_static(
            "parse",
            [](const std::string& toml, const fs::path& folder) {
                return TextRig(RigText(toml, "rig", folder));
            },
            nb::arg("toml"),
            nb::arg("folder") = fs::path("."),
            "Read a rig from text; files that it names are looked up in the folder.")
        .def("replace",
             replaced,
             nb::arg("keys"),
             "The rig with these keys set: rig.replace(**{\"sled.altitude_m\": 2.5}). None removes "
             "a key.")
        .def("__getitem__", number_of, nb::arg("key"), "The number of a key of the rig's text.")
        .def("save", save, nb::arg("file"), "Write the rig, and beside it the files that it names.")
        .def_prop_ro("text", [](const TextRig& rig) { return rig.text.text(); })
        .def_prop_ro("title", [](const TextRig& rig) { return rig.rig.title; })
        .def_prop_ro(
            "digest",
            [](const TextRig& rig) { return rig.rig.digest; },
            "Its SHA-256, tables included.")
        .def_prop_ro("strobes", strobe_names)
        .def_prop_ro("width_px", [](const TextRig& rig) { return rig.rig.camera.width_px; })
        .def_prop_ro("height_px", [](const TextRig& rig) { return rig.rig.camera.height_px; })
        .def_prop_ro("altitude_m", [](const TextRig& rig) { return rig.rig.sled.altitude_m; })
        .def_prop_ro("pitch_deg",
                     [](const TextRig& rig) { return rig.rig.sled.pitch_rad * kDegreesPerRadian; })
        .def_prop_ro("roll_deg",
                     [](const TextRig& rig) { return rig.rig.sled.roll_rad * kDegreesPerRadian; })
        .def("__repr__",
             [](const TextRig& rig) { return "<aphotic.Rig '" + rig.rig.title + "'>"; });

    nb::class_<Table>(module, "Table", "Numbers over wavelengths, with their source.")
        .def_ro("name", &Table::name)
        .def_ro("columns", &Table::columns)
        .def_ro("metadata", &Table::metadata)
        .def_prop_ro(
            "values", values_of, kOwn, "Rows by columns, the first of them wavelengths in nm.");
    module.def(
        "spectra", builtin_spectra, "The built-in tables by name, as `aphotic data` lists them.");
}

}  // namespace aphotic::python
