// SPDX-License-Identifier: BSD-3-Clause
#include "base/sha256.h"

#include "base/error.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cstddef>
#include <fstream>
#include <memory>

namespace aphotic {
namespace {

class Sha256 {
  public:
    Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
        check(context_ != nullptr && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
    }

    void add(std::string_view bytes) {
        check(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
    }

    [[nodiscard]] std::string hex() {
        std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
        unsigned int size = 0;
        check(EVP_DigestFinal_ex(context_.get(), bytes.data(), &size) == 1);
        std::string text;
        for (unsigned int i = 0; i < size; ++i) text += fmt::format("{:02x}", bytes[i]);
        return text;
    }

  private:
    static void check(bool succeeded) {
        if (!succeeded) throw RunError("SHA-256 failed in the system's crypto library");
    }

    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string sha256_of_text(std::string_view text) {
    Sha256 digest;
    digest.add(text);
    return digest.hex();
}

std::string sha256_of_floats(std::span<const float> samples) {
    const std::span<const std::byte> bytes = std::as_bytes(samples);
    return sha256_of_text({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::string sha256_of_file(const std::filesystem::path& file) {
    // Opening a pipe would block, and a device has no end.
    const bool is_regular = std::filesystem::is_regular_file(file);
    std::ifstream in(is_regular ? file : std::filesystem::path(), std::ios::binary);
    if (!in) throw RunError("{}: cannot be read", file.string());
    Sha256 digest;
    std::array<char, 1 << 16> block{};
    while (in) {
        in.read(block.data(), block.size());
        digest.add({block.data(), static_cast<std::size_t>(in.gcount())});
    }
    if (in.bad()) throw RunError("{}: read error", file.string());
    return digest.hex();
}

}  // namespace aphotic
