// SPDX-License-Identifier: BSD-3-Clause
//
// A rig file as text whose keys can be set, for whoever looks for a better rig or makes many of
// one. Keys are paths as a user would say them, a strobe, material or object by its name or number:
//
//   water.multiple      sled.altitude_m      strobe.fore.power      strobe.1.position_m
//   beam.fresnel.cones  camera.vignetting.radial
//
// A value is replaced where it stands; a new key follows the last of its table. All else, comments
// and layout included, stays as its author wrote it. Numbers have the fewest digits that give the
// same number back.
#pragma once

#include "rig/rig.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

class RigText {
  public:
    explicit RigText(const std::filesystem::path& file);
    RigText(std::string_view toml, std::string name, std::filesystem::path folder);

    [[nodiscard]] bool has(std::string_view key) const;
    // None where the key is not there or of another kind.
    [[nodiscard]] std::optional<double> number(std::string_view key) const;
    [[nodiscard]] std::optional<std::string> word(std::string_view key) const;

    // Makes the tables on the way to it. An InputError where there is no such strobe or object, or
    // what should be a table is none.
    void set(std::string_view key, double value);
    void set(std::string_view key, const std::string& value);
    void set(std::string_view key, const std::vector<double>& values);
    // As TOML has it: 2.5, "xenon-flash", [0.5, 0, 0], true. A word without quotes is a text.
    void set_toml(std::string_view key, std::string_view value);
    // With its line, where nothing else stands there. A table goes with all that it holds.
    void erase(std::string_view key);
    // A table of a rig's, whose place is another here; what stood in that place goes.
    void copy(const RigText& rig, std::string_view table, std::string_view place);

    // Files that the text names are found here.
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    [[nodiscard]] const std::string& text() const { return text_; }
    // Copies these below another folder, where they are not there themselves.
    void copy_files(const std::filesystem::path& folder) const;
    // As rig/file/rig_reader.h reads it.
    [[nodiscard]] Rig rig() const;

  private:
    void put(std::string_view key, const std::string& value);

    std::string text_;
    std::string name_;
    std::filesystem::path folder_;
};

}  // namespace aphotic
