// SPDX-License-Identifier: BSD-3-Clause
//
// A rig file as text whose keys can be set, to search for a better rig or to make many variants.
// Keys are paths in the user's terms, a strobe, material or object by its name or number:
//
//   water.multiple      sled.altitude_m      strobe.fore.power      strobe.1.position_m
//   beam.fresnel.cones  camera.vignetting.radial
//
// A value is replaced in place; a new key follows the last of its table. Everything else, including
// comments and layout, is unchanged. Numbers have the fewest digits that read back to the same
// number.
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
    // Empty if the key is missing or of another kind.
    [[nodiscard]] std::optional<double> number(std::string_view key) const;
    [[nodiscard]] std::optional<std::string> word(std::string_view key) const;

    // Creates the tables on the way to it. An InputError if there is no such strobe or object, or
    // if a value stands where a table is needed.
    void set(std::string_view key, double value);
    void set(std::string_view key, const std::string& value);
    void set(std::string_view key, const std::vector<double>& values);
    // As in TOML: 2.5, "xenon-flash", [0.5, 0, 0], true. A word without quotes is a string.
    void set_toml(std::string_view key, std::string_view value);
    // Including its line, if nothing else is on it. A table is removed with all its contents.
    void erase(std::string_view key);
    // Copies a table from another rig to the path `place`; a table there is removed.
    void copy(const RigText& rig, std::string_view table, std::string_view place);

    // The folder of the files named in the text.
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    [[nodiscard]] const std::string& text() const { return text_; }
    // Copies these files to another folder, unless they exist there.
    void copy_files(const std::filesystem::path& folder) const;
    // The rig as rig/file/rig_reader.h reads it.
    [[nodiscard]] Rig rig() const;

  private:
    void put(std::string_view key, const std::string& value);

    std::string text_;
    std::string name_;
    std::filesystem::path folder_;
};

}  // namespace aphotic
