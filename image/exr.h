// SPDX-License-Identifier: BSD-3-Clause
//
// OpenEXR images in blocks of rows, so that memory does not grow with their number or height.
//
// Samples are 32-bit floats, planar: all rows of the first named channel, then all rows of the
// second. A file's half floats are widened exactly. Nothing is cached by name: a rewritten file is
// read again.
//
// A file that is missing or cannot be opened, read or written is a RunError that names it. So is
// one whose data window differs from its display window (exr_header.h): only whole images are read.
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
    [[nodiscard]] std::vector<std::string> channels() const;  // in the file's order, sorted

    // A text attribute of the header, empty if there is none of that name.
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

// Runs read() on the reader of a file that the user named: a failure to read it is then an
// InputError.
template <typename Read>
auto from_named_exr(const std::filesystem::path& file, const Read& read) {
    try {
        ExrReader reader(file);
        return read(reader);
    } catch (const RunError& error) {
        throw InputError("{}", error.what());
    }
}

// The attribute by which images of the reference tracer say so: compared with the reference, they
// would be compared with themselves.
inline constexpr const char* kRendererAttribute = "aphotic:renderer";
inline constexpr const char* kReferenceTracer = "reference tracer";

// False if there is no such file or it cannot be read, which others report.
[[nodiscard]] bool is_traced(const std::filesystem::path& image);

using ExrAttributes = std::vector<std::pair<std::string, std::string>>;

// Float samples, ZIP or ZIPS (row_blocks.h). The file appears under its name when finish() has
// written it completely.
class ExrWriter {
  public:
    // The samples of most files have 11 significant bits, and the fastest level compresses the
    // zeros; higher levels take several times longer for a few per cent.
    static constexpr int kFastestZip = 1;

    // zip_level: 1 to 9, or 0 for no compression.
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

// A whole image at once. planes.size() == channels * width_px * height_px
void write_exr(const std::filesystem::path& file,
               int width_px,
               int height_px,
               std::vector<std::string> channels,
               std::span<const float> planes,
               const ExrAttributes& attributes = {},
               int zip_level = ExrWriter::kFastestZip);

// Threads for compression and decompression in the whole process. Pixels do not depend on it.
void set_exr_threads(int threads);

}  // namespace aphotic
