// SPDX-License-Identifier: BSD-3-Clause
#include "validation/channel_pairs.h"

#include "base/error.h"
#include "spectral/channel_wavelength.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

namespace aphotic {
namespace {

bool is_in(const std::vector<std::string>& channels, const std::string& name) {
    return std::ranges::find(channels, name) != channels.end();
}

bool is_about_samples(const std::string& name) {
    return name.starts_with("count.") || name.starts_with("stderr.");
}

// Of a layer too, such as beauty.A.
bool is_opacity(const std::string& name) {
    const std::string last = name.substr(name.rfind('.') + 1);
    return last == "A" || last == "alpha" || last == "Alpha";
}

// Of the same quantity and wavelength; taken out of those that are free. "" for none.
std::string taken_partner(const std::string& name, std::vector<std::string>& free) {
    const auto found = std::ranges::find_if(
        free, [&](const std::string& other) { return is_same_spectral_channel(name, other); });
    if (found == free.end()) return "";
    std::string partner = *found;
    free.erase(found);
    return partner;
}

}  // namespace

ChannelPairs pair_channels(const std::vector<std::string>& image,
                           const std::vector<std::string>& reference,
                           bool scaled) {
    ChannelPairs pairs;
    std::vector<std::string> free = reference;  // those that have no partner yet
    std::vector<std::string> partners;          // of the image's channels; "" for none
    for (const std::string& name : image) {
        partners.push_back(is_in(reference, name) ? name : "");
        std::erase(free, partners.back());
    }
    for (std::size_t i = 0; i < image.size(); ++i) {
        const std::string& name = image[i];
        if (partners[i].empty()) partners[i] = taken_partner(name, free);
        const bool is_paired = !partners[i].empty();
        const bool is_aside =
            (is_opacity(name) && !is_paired) || (is_about_samples(name) && (scaled || !is_paired));
        if (is_aside) {
            pairs.left_aside.push_back(name);
        } else if (is_paired) {
            pairs.compared.push_back({.image = name, .reference = partners[i]});
        } else {
            pairs.only_in_image.push_back(name);
        }
    }
    for (const std::string& name : free) {
        const bool is_aside = is_opacity(name) || is_about_samples(name);
        (is_aside ? pairs.left_aside : pairs.only_in_reference).push_back(name);
    }
    return pairs;
}

ChannelPairs named_channels(const std::string& names,
                            const std::vector<std::string>& image,
                            const std::vector<std::string>& reference) {
    const std::vector<ChannelPair> all = pair_channels(image, reference, false).compared;
    ChannelPairs pairs;
    std::istringstream parts(names);
    std::string name;
    for (std::string part; std::getline(parts, part, ',');) {
        name += (name.empty() ? "" : ",") + part;
        const auto is_named = [&](const ChannelPair& pair) {
            return pair.image == name || pair.reference == name ||
                   is_same_spectral_channel(pair.image, name);
        };
        const auto found = std::ranges::find_if(all, is_named);
        if (found == all.end()) continue;
        if (std::ranges::none_of(pairs.compared, is_named)) pairs.compared.push_back(*found);
        name.clear();
    }
    if (name.empty() && !pairs.compared.empty()) return pairs;
    std::vector<std::string> allowed;
    for (const ChannelPair& pair : all) allowed.push_back(pair.image);
    throw InputError(fmt::format("--channels: found {}; allowed: those of both images, {}",
                                 name.empty() ? "none" : name,
                                 fmt::join(allowed, ", ")));
}

}  // namespace aphotic
