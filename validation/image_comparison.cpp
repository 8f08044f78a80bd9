// SPDX-License-Identifier: BSD-3-Clause
#include "validation/image_comparison.h"

#include "base/error.h"
#include "image/any_image.h"
#include "validation/channel_pairs.h"
#include "validation/scaling.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

bool has_channel(const AnyImage& image, const std::string& channel) {
    return std::ranges::find(image.channels, channel) != image.channels.end();
}

ChannelPairs channels_of(const AnyImage& a, const AnyImage& b, const ComparisonRequest& request) {
    ChannelPairs pairs =
        request.channels
            ? named_channels(*request.channels, a.channels, b.channels)
            : pair_channels(a.channels, b.channels, request.scale != ComparedScale::None);
    if (!pairs.compared.empty()) return pairs;
    throw InputError(fmt::format("{} has the channels {}, {} has {}: none in common",
                                 request.image,
                                 fmt::join(a.channels, ", "),
                                 request.reference,
                                 fmt::join(b.channels, ", ")));
}

std::vector<float> samples_of(const AnyImage& image, const std::string& channel) {
    const auto found = std::ranges::find(image.channels, channel);
    return image.samples(static_cast<std::size_t>(found - image.channels.begin()));
}

// Marks what either image says that it never observed.
std::vector<unsigned char> unobserved_in(const AnyImage& a,
                                         const AnyImage& b,
                                         const ChannelPair& channel) {
    std::vector<unsigned char> marks;
    for (const auto& [image, name] :
         {std::pair(&a, channel.image), std::pair(&b, channel.reference)}) {
        const std::string count = "count." + name;
        if (!has_channel(*image, count)) continue;
        const std::vector<float> counts = samples_of(*image, count);
        marks.resize(counts.size(), 0);
        for (std::size_t i = 0; i < counts.size(); ++i) {
            if (counts[i] == 0.0F) marks[i] = kUnobserved;
        }
    }
    return marks;
}

// Of every channel, the same or each its own.
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
                fmt::format("{}: channel {} is {:.3g} times that of {}; --scale "
                            "needs a positive factor",
                            request.image,
                            channels[c].image,
                            scales.back(),
                            request.reference));
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
        throw InputError(fmt::format("{}: found {} x {} pixels; allowed: {} x {}, as in {}",
                                     request.image,
                                     a.width_px,
                                     a.height_px,
                                     b.width_px,
                                     b.height_px,
                                     request.reference));
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
