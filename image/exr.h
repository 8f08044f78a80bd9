// SPDX-License-Identifier: BSD-3-Clause
//
// OpenEXR images by blocks of rows, so that memory does not grow with their number or height.
//
// Samples come and go as 32-bit floats, planar: all rows of the first channel named, then all
// rows of the second. Half floats of a file are widened exactly. Nothing is cached by name: a
// file that was written again is read again.
//
// A file that cannot be opened, read or written, or is gone, is a RunError that names it. So is one
// whose data window is not its display window (exr_header.h): what is read here is the image, no
// part of it.
#pragma once

#include "base/atomic_file.h"
#include "base/error.h"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace aphotic {

class ExrReader {
  public:
    explicit ExrReader(const std::filesystem::path& file);
    ~ExrReader();
    ExrReader(const ExrReader&) = delete;
    ExrReader& operator=(const ExrReader&) = delete;

    [[nodiscard]] int width_px() const;
    [[nodiscard]] int height_px() const;
    [[nodiscard]] std::vector<std::string> channels() const;  // in the file's order: sorted

    // A text attribute of the header, empty when there is none of that name.
    [[nodiscard]] std::string attribute(const std::string& name) const;

    // samples.size() == channels.size() * rows * width_px()
    void read_rows(int first_row,
                   int rows,
                   std::span<const std::string> channels,
                   std::span<float> samples);

    // All rows.
    [[nodiscard]] std::vector<float> planes(std::span<const std::string> channels);

  private:
    struct File;
    std::unique_ptr<File> file_;
    std::filesystem::path path_;
};

// What read() makes of the reader of a file that the user named: that it cannot be read is an
// InputError then.
template <typename Read>
auto from_named_exr(const std::filesystem::path& file, const Read& read) {
    try {
        ExrReader reader(file);
        return read(reader);
    } catch (const RunError& error) {
        throw InputError("{}", error.what());
    }
}

using ExrAttributes = std::vector<std::pair<std::string, std::string>>;

// Float samples, ZIP or ZIPS (row_blocks.h). The file appears under its name when finish() has
// written it whole.
class ExrWriter {
  public:
    // Of most files the samples carry 11 significant bits, so a quick look finds the zeros; higher
    // levels take several times longer for a few per cent.
    static constexpr int kFastestZip = 1;

    // zip_level: 1 to 9, or 0: not compressed.
    ExrWriter(const std::filesystem::path& file,
              int width_px,
              int height_px,
              std::vector<std::string> channels,
              const ExrAttributes& attributes,
              int zip_level = kFastestZip);
    ~ExrWriter();
    ExrWriter(const ExrWriter&) = delete;
    ExrWriter& operator=(const ExrWriter&) = delete;

    // The next rows. samples.size() == channels * rows * width_px
    void write_rows(int rows, std::span<const float> samples);

    // Exactly height_px rows must have been written.
    void finish();

  private:
    struct File;
    AtomicFile destination_;
    std::vector<std::string> channels_;
    int width_px_;
    int height_px_;
    int next_row_ = 0;
    std::unique_ptr<File> file_;
};

// Threads that compress and decompress, for the whole process. Pixels do not depend on it.
void set_exr_threads(int threads);

}  // namespace aphotic
