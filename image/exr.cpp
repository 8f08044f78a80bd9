// SPDX-License-Identifier: BSD-3-Clause
#include "image/exr.h"

#include "image/exr_header.h"
#include "image/row_blocks.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <fstream>
#include <new>
#include <optional>
#include <string_view>
#include <system_error>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

// A frame buffer over planar rows that start at first_row of the file.
Imf::FrameBuffer planar_rows(std::span<const std::string> channels,
                             int width_px,
                             int first_column,
                             int first_row,
                             int rows,
                             char* samples) {
    const auto x_stride = static_cast<std::ptrdiff_t>(sizeof(float));
    const std::ptrdiff_t y_stride = x_stride * width_px;
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        char* plane = samples + static_cast<std::ptrdiff_t>(c) * y_stride * rows;
        // OpenEXR addresses from pixel (0, 0) of the file.
        char* origin = plane - first_row * y_stride - first_column * x_stride;
        buffer.insert(channels[c],
                      Imf::Slice(Imf::FLOAT,
                                 origin,
                                 static_cast<std::size_t>(x_stride),
                                 static_cast<std::size_t>(y_stride)));
    }
    return buffer;
}

[[noreturn]] void fail(const fs::path& path, std::string_view what, const std::exception& why) {
    throw RunError("{}: {}: {}", path.string(), what, why.what());
}

const char* sound_header(const fs::path& path) {
    require_sound_exr_header(path);
    return path.c_str();
}

}  // namespace

struct ExrReader::File {
    explicit File(const fs::path& path)
        : in(sound_header(path)), window(in.header().dataWindow()) {}

    Imf::InputFile in;
    Imath::Box2i window;
};

ExrReader::ExrReader(const fs::path& file) : path_(file) {
    std::error_code ignored;
    if (!fs::exists(file, ignored))
        throw RunError("{}: cannot be read: No such file or directory", file.string());
    try {
        file_ = std::make_unique<File>(file);
    } catch (const std::exception& error) {
        fail(path_, "not a readable OpenEXR image", error);
    }
}

ExrReader::~ExrReader() = default;

int ExrReader::width_px() const {
    return file_->window.max.x - file_->window.min.x + 1;
}

int ExrReader::height_px() const {
    return file_->window.max.y - file_->window.min.y + 1;
}

std::vector<std::string> ExrReader::channels() const {
    std::vector<std::string> names;
    const Imf::ChannelList& list = file_->in.header().channels();
    for (auto channel = list.begin(); channel != list.end(); ++channel) {
        names.emplace_back(channel.name());
    }
    return names;
}

std::string ExrReader::attribute(const std::string& name) const {
    const auto* text = file_->in.header().findTypedAttribute<Imf::StringAttribute>(name);
    return text == nullptr ? "" : text->value();
}

void ExrReader::read_rows(int first_row,
                          int rows,
                          std::span<const std::string> channels,
                          std::span<float> samples) {
    assert(samples.size() ==
           channels.size() * static_cast<std::size_t>(rows) * static_cast<std::size_t>(width_px()));
    for (const std::string& name : channels) {
        if (file_->in.header().channels().findChannel(name) == nullptr) {
            throw RunError("{}: has no channel {}", path_.string(), name);
        }
    }
    const int first = file_->window.min.y + first_row;
    try {
        file_->in.setFrameBuffer(planar_rows(channels,
                                             width_px(),
                                             file_->window.min.x,
                                             first,
                                             rows,
                                             reinterpret_cast<char*>(samples.data())));
        file_->in.readPixels(first, first + rows - 1);
    } catch (const std::exception& error) {
        fail(path_, "cannot be read", error);
    }
}

std::vector<float> ExrReader::planes(std::span<const std::string> channels) {
    try {
        std::vector<float> samples(channels.size() * static_cast<std::size_t>(width_px()) *
                                   static_cast<std::size_t>(height_px()));
        read_rows(0, height_px(), channels, samples);
        return samples;
    } catch (const std::bad_alloc&) {
        throw RunError("{}: cannot be read: out of memory", path_.string());
    }
}

bool is_traced(const fs::path& image) {
    try {
        return ExrReader(image).attribute(kRendererAttribute) == kReferenceTracer;
    } catch (const RunError&) {
        return false;
    }
}

struct ExrWriter::File {
    File(const fs::path& file, const fs::path& called)
        : disk(file, std::ios::binary), stream(disk, called.c_str()) {}

    // The system's message comes before OpenEXR's.
    [[noreturn]] void fail(const fs::path& called, const char* why) const {
        throw RunError("{}: cannot be written: {}",
                       called.string(),
                       disk ? std::string(why) : std::generic_category().message(errno));
    }

    std::ofstream disk;
    Imf::StdOFStream stream;
    std::optional<Imf::OutputFile> out{};
};

ExrWriter::ExrWriter(const fs::path& file,
                     int width_px,
                     int height_px,
                     std::vector<std::string> channels,
                     const ExrAttributes& attributes,
                     int zip_level)
    : destination_(file),
      channels_(std::move(channels)),
      width_px_(width_px),
      height_px_(height_px) {
    Imf::Header header(width_px, height_px);
    header.compression() = rows_compressed_together(width_px, channels_.size()) == kRowsOfZip
                               ? Imf::ZIP_COMPRESSION
                               : Imf::ZIPS_COMPRESSION;
    if (zip_level == 0) {
        header.compression() = Imf::NO_COMPRESSION;
    } else {
        header.zipCompressionLevel() = zip_level;
    }
    for (const std::string& name : channels_)
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    // Linear, as always in OpenEXR. A camera's red, green and blue channels have no primaries;
    // programs that read primaries receive those that they would assume.
    if (std::ranges::find(channels_, "R") != channels_.end())
        Imf::addChromaticities(header, Imf::Chromaticities());
    header.insert("software", Imf::StringAttribute("Aphotic " APHOTIC_VERSION));
    for (const auto& [name, text] : attributes) header.insert(name, Imf::StringAttribute(text));
    file_ = std::make_unique<File>(destination_.temporary(), file);
    if (!file_->disk) file_->fail(file, "");
    try {
        file_->out.emplace(file_->stream, header);
    } catch (const std::exception& error) {
        file_->fail(file, error.what());
    }
}

ExrWriter::~ExrWriter() = default;

void ExrWriter::write_rows(int rows, std::span<const float> samples) {
    assert(samples.size() ==
           channels_.size() * static_cast<std::size_t>(rows) * static_cast<std::size_t>(width_px_));
    try {
        // OpenEXR takes a mutable pointer for reading and writing alike.
        auto* bytes = const_cast<char*>(reinterpret_cast<const char*>(samples.data()));
        file_->out->setFrameBuffer(planar_rows(channels_, width_px_, 0, next_row_, rows, bytes));
        file_->out->writePixels(rows);
    } catch (const std::exception& error) {
        file_->fail(destination_.final_path(), error.what());
    }
    next_row_ += rows;
}

void ExrWriter::finish() {
    assert(next_row_ == height_px_);
    // Closing writes the table of block offsets, and OpenEXR does not report its failure, as on a
    // full disk.
    file_->out.reset();
    file_->disk.close();
    if (!file_->disk) file_->fail(destination_.final_path(), "");
    file_.reset();
    destination_.commit();
}

void write_exr(const fs::path& file,
               int width_px,
               int height_px,
               std::vector<std::string> channels,
               std::span<const float> planes,
               const ExrAttributes& attributes,
               int zip_level) {
    ExrWriter writer(file, width_px, height_px, std::move(channels), attributes, zip_level);
    writer.write_rows(height_px, planes);
    writer.finish();
}

void set_exr_threads(int threads) {
    Imf::setGlobalThreadCount(threads);
}

}  // namespace aphotic
