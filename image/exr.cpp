// SPDX-License-Identifier: BSD-3-Clause
#include "image/exr.h"

#include "base/error.h"
#include "image/row_blocks.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include <array>
#include <cassert>
#include <cstdint>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

// A frame buffer over planar rows, of which the first is first_row of the file.
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

// --- Whether a header is as long as its file, looked at before OpenEXR reads it, which takes a
// size there at its word and asks for gigabytes on a damaged one:
//
//   magic, version                      4 bytes each, little-endian as all numbers
//   name \0 type \0 size value ...      attributes, size is 4 bytes, the value as many as it says
//   \0                                  ends a header; files of several parts end with two

constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kIsOfSeveralParts = 0x1000;
constexpr const char* kDamaged = "its header is damaged";
constexpr std::size_t kLongestName = 255;  // by the format

std::uint32_t number(std::istream& in) {
    std::array<char, 4> bytes{};
    in.read(bytes.data(), bytes.size());
    std::uint32_t value = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) {
        value = value << 8U | static_cast<unsigned char>(bytes[i]);
    }
    return value;
}

std::string name(std::istream& in) {
    std::string text;
    for (char c = 0; in.get(c) && c != '\0' && text.size() <= kLongestName;) text += c;
    if (!in || text.size() > kLongestName) throw std::runtime_error(kDamaged);
    return text;
}

// OpenEXR reads so many bytes of these, whatever their size says.
std::optional<std::streamoff> size_of(const std::string& type) {
    constexpr std::array<std::pair<std::streamoff, std::string_view>, 13> kTypes{
        {{1, " compression deepImageState envmap lineOrder "},
         {4, " float int "},
         {8, " double rational timecode v2f v2i "},
         {9, " tiledesc "},
         {12, " v3f v3i "},
         {16, " box2f box2i v2d "},
         {24, " v3d "},
         {28, " keycode "},
         {32, " chromaticities "},
         {36, " m33f "},
         {64, " m44f "},
         {72, " m33d "},
         {128, " m44d "}}};
    for (const auto& [size, types] : kTypes) {
        if (types.find(" " + type + " ") != std::string_view::npos) return size;
    }
    return std::nullopt;
}

// A list that ends with an empty name, whatever its size says.
void pass_over_channels(std::istream& in) {
    constexpr std::streamoff kBytesOfAChannel = 16;
    while (!name(in).empty()) in.seekg(kBytesOfAChannel, std::ios::cur);
}

// Throws std::runtime_error that says what is wrong.
void require_sound_exr_header(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    const std::streamoff length = in.tellg();
    in.seekg(0);
    if (number(in) != kMagic || !in) throw std::runtime_error("it does not begin as one");
    const bool has_parts = (number(in) & kIsOfSeveralParts) != 0;
    for (bool at_start = true;;) {
        if (name(in).empty()) {
            if (at_start || !has_parts) return;
            at_start = true;
            continue;
        }
        at_start = false;
        const std::string type = name(in);
        const std::streamoff size = number(in);
        const std::streamoff end = in.tellg() + size;
        if (!in || end > length) throw std::runtime_error(kDamaged);
        if (size != size_of(type).value_or(size)) throw std::runtime_error(kDamaged);
        if (type == "chlist") pass_over_channels(in);
        if (type == "chlist" && in.tellg() != end) throw std::runtime_error(kDamaged);
        in.seekg(end);
    }
}

// Far beyond any camera's; OpenEXR sets up tables of this many rows before it reads the first.
constexpr int kMostSide_px = 65536;

const char* sound_header(const fs::path& path) {
    require_sound_exr_header(path);
    Imf::Header::setMaxImageSize(kMostSide_px, kMostSide_px);
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
        throw InputError("{}: cannot be read: No such file or directory", file.string());
    try {
        file_ = std::make_unique<File>(file);
    } catch (const std::exception& error) {
        fail(path_, "is no readable OpenEXR image", error);
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
    std::vector<float> samples(channels.size() * static_cast<std::size_t>(width_px()) *
                               static_cast<std::size_t>(height_px()));
    read_rows(0, height_px(), channels, samples);
    return samples;
}

struct ExrWriter::File {
    File(const fs::path& path, const Imf::Header& header) : out(path.c_str(), header) {}

    Imf::OutputFile out;
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
    for (const auto& [name, text] : attributes) header.insert(name, Imf::StringAttribute(text));
    try {
        file_ = std::make_unique<File>(destination_.temporary(), header);
    } catch (const std::exception& error) {
        fail(file, "cannot be written", error);
    }
}

ExrWriter::~ExrWriter() = default;

void ExrWriter::write_rows(int rows, std::span<const float> samples) {
    assert(samples.size() ==
           channels_.size() * static_cast<std::size_t>(rows) * static_cast<std::size_t>(width_px_));
    try {
        // OpenEXR takes a mutable pointer for reading and writing alike.
        auto* bytes = const_cast<char*>(reinterpret_cast<const char*>(samples.data()));
        file_->out.setFrameBuffer(planar_rows(channels_, width_px_, 0, next_row_, rows, bytes));
        file_->out.writePixels(rows);
    } catch (const std::exception& error) {
        fail(destination_.final_path(), "cannot be written", error);
    }
    next_row_ += rows;
}

void ExrWriter::finish() {
    assert(next_row_ == height_px_);
    // Closing writes the table of where each block stands, and says nothing when that fails, as
    // on a full disk: look whether it is there.
    file_.reset();
    try {
        if (!Imf::InputFile(destination_.temporary().c_str()).isComplete()) {
            throw std::runtime_error("the file is not whole; is the disk full?");
        }
    } catch (const std::exception& error) {
        fail(destination_.final_path(), "cannot be written", error);
    }
    destination_.commit();
}

void set_exr_threads(int threads) {
    Imf::setGlobalThreadCount(threads);
}

}  // namespace aphotic
