// SPDX-License-Identifier: BSD-3-Clause
#include "image/png_pixels.h"

#include "base/error.h"
#include "image/decoded_size.h"

#include <png.h>

#include <array>
#include <bit>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <utility>

namespace aphotic {
namespace {

[[noreturn]] void leave(png_structp png, png_const_charp why) {
    *static_cast<std::string*>(png_get_error_ptr(png)) = why;
    png_longjmp(png, 1);
}

// libpng drops a metadata chunk that unpacks to more than this, and reads the file without it;
// other readers have other limits.
void pass_over(png_structp png, png_const_charp warning) {
    for (const char* limit : {"chunk cache", "insufficient memory", "too large"}) {
        if (std::strstr(warning, limit) != nullptr) leave(png, warning);
    }
}

struct Library {
    Library() {
        png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &fault, leave, pass_over);
        if (png != nullptr) info = png_create_info_struct(png);
    }
    ~Library() { png_destroy_read_struct(&png, &info, nullptr); }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;

    // libpng exits by longjmp, which skips destructors, so work owns nothing.
    template <typename Work>
    void guarded(const Work& work) {
        if (setjmp(png_jmpbuf(png)) != 0) throw InputError("{}", fault);
        work();
    }

    std::string fault;
    png_structp png = nullptr;
    png_infop info = nullptr;
};

class PngReader {
  public:
    explicit PngReader(const std::filesystem::path& file) : file_(std::fopen(file.c_str(), "rb")) {
        constexpr png_alloc_size_t kMostOfAChunk_bytes = 4 * kMebi;
        constexpr png_uint_32 kMostChunks = 64;
        if (!file_) throw InputError("it cannot be opened");
        if (lib_.info == nullptr) throw std::bad_alloc();
        lib_.guarded([this] {
            png_set_chunk_malloc_max(lib_.png, kMostOfAChunk_bytes);
            png_set_chunk_cache_max(lib_.png, kMostChunks);
            png_init_io(lib_.png, file_.get());
            png_read_info(lib_.png, lib_.info);
        });
        require_sides(width(), height());
        lib_.guarded([this] {
            png_set_expand(lib_.png);
            if (std::endian::native == std::endian::little) png_set_swap(lib_.png);
            passes_ = png_set_interlace_handling(lib_.png);
            png_read_update_info(lib_.png, lib_.info);
        });
    }

    [[nodiscard]] std::uint32_t width() const { return png_get_image_width(lib_.png, lib_.info); }
    [[nodiscard]] std::uint32_t height() const { return png_get_image_height(lib_.png, lib_.info); }
    [[nodiscard]] int channels() const { return png_get_channels(lib_.png, lib_.info); }
    [[nodiscard]] bool has_16_bits() const { return png_get_bit_depth(lib_.png, lib_.info) == 16; }

    // Calls use(row, its bytes) from the top. An interlaced image is held completely, since its
    // rows arrive in passes.
    template <typename Use>
    void rows(const Use& use) {
        const std::size_t row_bytes = png_get_rowbytes(lib_.png, lib_.info);
        std::vector<png_byte> held(row_bytes * (passes_ > 1 ? height() : 1));
        for (int pass = 0; pass < passes_; ++pass) {
            for (std::uint32_t row = 0; row < height(); ++row) {
                png_byte* const at = held.data() + (passes_ > 1 ? row * row_bytes : 0);
                lib_.guarded([this, at] { png_read_row(lib_.png, at, nullptr); });
                if (pass + 1 == passes_) use(row, at);
            }
        }
        lib_.guarded([this] { png_read_end(lib_.png, nullptr); });
    }

  private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };

    std::unique_ptr<std::FILE, Close> file_;
    Library lib_;
    int passes_ = 1;
};

template <typename Sample>
void take_row(const png_byte* bytes, const PngPart& part, float* to) {
    constexpr float kStep = 1.0F / static_cast<float>(std::numeric_limits<Sample>::max());
    const auto* from = reinterpret_cast<const Sample*>(bytes);
    for (int i = 0; i < part.width_px; ++i, from += part.channels) {
        for (int c = part.first; c < part.end; ++c) {
            *to++ = static_cast<float>(from[c]) * kStep;
        }
    }
}

}  // namespace

bool is_png(const std::filesystem::path& file) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"),
                                                             std::fclose);
    std::array<png_byte, 8> mark{};
    return in && std::fread(mark.data(), 1, mark.size(), in.get()) == mark.size() &&
           png_sig_cmp(mark.data(), 0, mark.size()) == 0;
}

void require_sound_png_header(const std::filesystem::path& file) {
    const PngReader header(file);
}

std::vector<float> png_pixels(const std::filesystem::path& file, const PngPart& part) {
    PngReader png(file);
    if (std::cmp_not_equal(png.width(), part.width_px) ||
        std::cmp_not_equal(png.height(), part.height_px) || png.channels() != part.channels) {
        throw InputError("it changed while being read");
    }
    const std::size_t row_samples = size_of(part.width_px) * size_of(part.end - part.first);
    std::vector<float> pixels(row_samples * size_of(part.height_px));
    const bool has_16_bits = png.has_16_bits();
    png.rows([&](std::uint32_t row, const png_byte* bytes) {
        float* const to = pixels.data() + row * row_samples;
        if (has_16_bits) {
            take_row<std::uint16_t>(bytes, part, to);
        } else {
            take_row<std::uint8_t>(bytes, part, to);
        }
    });
    return pixels;
}

}  // namespace aphotic
