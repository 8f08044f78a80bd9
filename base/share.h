// SPDX-License-Identifier: BSD-3-Clause
//
// A share of much work, for one machine of several: 2/4 is of each four pieces the second.
// Neighbours, such as the images of a dive, take alike long, and so do
// shares of this kind.
//
// What a share makes goes to a folder of its own, DIR/share-2-of-4, which no other task writes to.
// The same work without a share takes it from there.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct WorkShare {
    std::size_t number = 1;  // from 1
    std::size_t of = 1;

    [[nodiscard]] bool is_whole() const { return of == 1; }
    // piece: counted from 0.
    [[nodiscard]] bool has(std::size_t piece) const { return piece % of == number - 1; }
};

inline constexpr std::size_t kMostShares = 100000;

// Of "2/4". Throws InputError.
[[nodiscard]] WorkShare parse_share(std::string_view text);

template <typename Piece>
[[nodiscard]] std::vector<Piece> share_of(const std::vector<Piece>& all, WorkShare share) {
    std::vector<Piece> own;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (share.has(i)) own.push_back(all[i]);
    }
    return own;
}

// The folder itself, of all the work.
[[nodiscard]] std::filesystem::path share_folder(const std::filesystem::path& folder,
                                                 WorkShare share);

// Those that are there, of whatever shares, sorted by name.
[[nodiscard]] std::vector<std::filesystem::path> share_folders(const std::filesystem::path& folder);

// Removes these files of a share's folder, and then it and all folders in it that are empty.
void remove_joined(const std::filesystem::path& share,
                   const std::vector<std::filesystem::path>& files);

}  // namespace aphotic
