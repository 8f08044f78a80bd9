// SPDX-License-Identifier: BSD-3-Clause
#include "validation/image_comparison.h"

#include "base/error.h"
#include "image/any_image.h"
#include "spectral/channel_wavelength.h"
#include "validation/scaling.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

// Pairs of channels.

struct ChannelPair {
    std::string image;  // name in the image
    std::string reference;
};

struct ChannelPairs {
    std::vector<ChannelPair> compared;
    std::vector<std::string> only_in_image;
    std::vector<std::string> only_in_reference;
    std::vector<std::string> left_aside;
};

bool is_in(const std::vector<std::string>& channels, const std::string& name) {
    return std::ranges::find(channels, name) != channels.end();
}

bool is_about_samples(const std::string& name) {
    return name.starts_with("count.") || name.starts_with("stderr.");
}

// Whether a channel is opacity, also of a layer, such as beauty.A.
bool is_opacity(const std::string& name) {
    const std::string last = name.substr(name.rfind('.') + 1);
    return last == "A" || last == "alpha" || last == "Alpha";
}

// The free channel of the same quantity and wavelength, which is then no longer free. "" if there
// is none.
std::string taken_partner(const std::string& name, std::vector<std::string>& free) {
    const auto found = std::ranges::find_if(
        free, [&](const std::string& other) { return is_same_spectral_channel(name, other); });
    if (found == free.end()) return "";
    std::string partner = *found;
    free.erase(found);
    return partner;
}

// scaled: one factor cannot scale counts and standard errors as well, so these are ignored.
ChannelPairs pair_channels(const std::vector<std::string>& image,
                           const std::vector<std::string>& reference,
                           bool scaled) {
    ChannelPairs pairs;
    std::vector<std::string> free = reference;  // those without a partner so far
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

// The channels that the user names, by either image's names, separated by commas. A name may
// contain commas, such as S0.550,000000nm. Throws InputError if one is missing in either image, or
// none is named.
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
    throw InputError("--channels: found {}; allowed: those of both images, {}",
                     name.empty() ? "none" : name,
                     fmt::join(allowed, ", "));
}

// The comparison.

ChannelPairs channels_of(const AnyImage& a, const AnyImage& b, const ComparisonRequest& request) {
    ChannelPairs pairs =
        request.channels
            ? named_channels(*request.channels, a.channels, b.channels)
            : pair_channels(a.channels, b.channels, request.scale != ComparedScale::None);
    if (!pairs.compared.empty()) return pairs;
    throw InputError(fmt::format("{} has the channels {}, {} has {}: none in common",
                                 request.image,
                                 names_of(a.channels),
                                 request.reference,
                                 names_of(b.channels)));
}

std::vector<float> samples_of(const AnyImage& image, const std::string& channel) {
    const auto found = std::ranges::find(image.channels, channel);
    return image.samples(static_cast<std::size_t>(found - image.channels.begin()));
}

// Marks samples that either image records as never observed.
std::vector<unsigned char> unobserved_in(const AnyImage& a,
                                         const AnyImage& b,
                                         const ChannelPair& channel) {
    std::vector<unsigned char> marks;
    for (const auto& [image, name] :
         {std::pair(&a, channel.image), std::pair(&b, channel.reference)}) {
        const std::string count = "count." + name;
        if (!is_in(image->channels, count)) continue;
        const std::vector<float> counts = samples_of(*image, count);
        marks.resize(counts.size(), 0);
        for (std::size_t i = 0; i < counts.size(); ++i) {
            if (counts[i] == 0.0F) marks[i] = kUnobserved;
        }
    }
    return marks;
}

// The scale of every channel: one for all, or one for each.
std::vector<double> scales_of(const AnyImage& a,
                              const AnyImage& b,
                              const std::vector<ChannelPair>& channels,
                              const ComparisonRequest& request) {
    if (request.scale == ComparedScale::None) return std::vector<double>(channels.size(), 1.0);
    std::vector<Scaling> scalings(request.scale == ComparedScale::OfImage ? 1 : channels.size());
    for (std::size_t c = 0; c < channels.size(); ++c) {
        scalings[std::min(c, scalings.size() - 1)].add(samples_of(a, channels[c].image),
                                                       samples_of(b, channels[c].reference),
                                                       unobserved_in(a, b, channels[c]));
    }
    std::vector<double> scales;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        scales.push_back(scalings[std::min(c, scalings.size() - 1)].scale());
        if (!(scales.back() > 0.0)) {
            throw InputError(
                "{}: channel {} is {:.3g} times that of {}; --scale "
                "needs a positive factor",
                request.image,
                channels[c].image,
                scales.back(),
                request.reference);
        }
    }
    return scales;
}

ComparedChannel compare_channel(const AnyImage& a,
                                const AnyImage& b,
                                const ChannelPair& pair,
                                double scale,
                                const ComparisonRequest& request) {
    ComparedChannel channel{.comparison = {},
                            .scale = scale,
                            .image = samples_of(a, pair.image),
                            .reference = samples_of(b, pair.reference),
                            .marks = unobserved_in(a, b, pair)};
    if (scale != 1.0) {
        for (float& sample : channel.image) sample = static_cast<float>(sample / scale);
    }
    float brightest = 0.0F;
    for (const float sample : channel.reference) {
        if (std::isfinite(sample)) brightest = std::max(brightest, std::abs(sample));
    }
    channel.black = request.black * brightest;
    channel.comparison =
        compare_planes(pair.image,
                       channel.image,
                       std::vector<double>(channel.reference.begin(), channel.reference.end()),
                       a.width_px,
                       channel.marks,
                       channel.black,
                       request.bound);
    return channel;
}

}  // namespace

ComparedImages compare_images(const ComparisonRequest& request) {
    const AnyImage a = open_any_image(request.image);
    const AnyImage b = open_any_image(request.reference);
    if (a.width_px != b.width_px || a.height_px != b.height_px) {
        throw InputError("{}: found {} x {} pixels; allowed: {} x {}, as in {}",
                         request.image,
                         a.width_px,
                         a.height_px,
                         b.width_px,
                         b.height_px,
                         request.reference);
    }
    const ChannelPairs pairs = channels_of(a, b, request);
    const std::vector<ChannelPair>& channels = pairs.compared;
    const std::vector<double> scales = scales_of(a, b, channels, request);
    ComparedImages images{.image = request.image,
                          .reference = request.reference,
                          .width_px = a.width_px,
                          .height_px = a.height_px,
                          .black = request.black,
                          .scaled = request.scale != ComparedScale::None,
                          .channels = {},
                          .only_in_image = pairs.only_in_image,
                          .only_in_reference = pairs.only_in_reference,
                          .left_aside = pairs.left_aside};
    for (std::size_t c = 0; c < channels.size(); ++c) {
        ComparedChannel channel = compare_channel(a, b, channels[c], scales[c], request);
        if (!request.keep_samples) {
            channel.image = {};
            channel.reference = {};
            channel.marks = {};
        }
        images.channels.push_back(std::move(channel));
    }
    return images;
}

}  // namespace aphotic
