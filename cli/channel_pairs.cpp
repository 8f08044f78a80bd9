// SPDX-License-Identifier: BSD-3-Clause
#include "cli/channel_pairs.h"

#include "spectral/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

namespace aphotic::cli {
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

}  // namespace

ChannelPairs pair_channels(const std::vector<std::string>& image,
                           const std::vector<std::string>& reference,
                           bool scaled) {
    ChannelPairs pairs;
    for (const std::string& name : image) {
        if (!is_in(reference, name)) {
            const bool is_aside = is_opacity(name) || is_about_samples(name);
            (is_aside ? pairs.left_aside : pairs.only_in_image).push_back(name);
        } else {
            const bool is_aside = scaled && is_about_samples(name);
            (is_aside ? pairs.left_aside : pairs.compared).push_back(name);
        }
    }
    for (const std::string& name : reference) {
        if (is_in(image, name)) continue;
        const bool is_aside = is_opacity(name) || is_about_samples(name);
        (is_aside ? pairs.left_aside : pairs.only_in_reference).push_back(name);
    }
    return pairs;
}

ChannelPairs named_channels(const std::string& names,
                            const std::vector<std::string>& image,
                            const std::vector<std::string>& reference) {
    ChannelPairs pairs;
    std::istringstream parts(names);
    std::string name;
    for (std::string part; std::getline(parts, part, ',');) {
        name += (name.empty() ? "" : ",") + part;
        if (!is_in(image, name) || !is_in(reference, name)) continue;
        if (!is_in(pairs.compared, name)) pairs.compared.push_back(name);
        name.clear();
    }
    if (name.empty() && !pairs.compared.empty()) return pairs;
    throw InputError(fmt::format("--channels: found {}; allowed: those of both images, {}",
                                 name.empty() ? "none" : name,
                                 fmt::join(pair_channels(image, reference, false).compared, ", ")));
}

}  // namespace aphotic::cli
