// SPDX-License-Identifier: BSD-3-Clause
//
// The page of a comparison in a real browser: nothing on its console, every picture shown, every
// colour scale there, nothing cut off or wider than the page.
#include "support/browser.h"
#include "validation/comparison_page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace aphotic::comparison_browser_test {
namespace {

constexpr int kWidth_px = 48;
constexpr int kHeight_px = 32;

// A bright middle, and an image that is off by a wave of up to 1e-3 and in one pixel by 0.02.
ComparedChannel channel_of(const std::string& name, std::size_t worst) {
    ComparedChannel channel{
        .comparison = {}, .black = 1e-6, .image = {}, .reference = {}, .marks = {}};
    for (int row = 0; row < kHeight_px; ++row) {
        for (int column = 0; column < kWidth_px; ++column) {
            const double level = std::exp(-std::hypot(column - 24, row - 16) / 20.0);
            channel.reference.push_back(static_cast<float>(level));
            channel.image.push_back(
                static_cast<float>(level * (1.0 + 1e-3 * std::sin(column / 5.0))));
        }
    }
    channel.image[worst] *= 1.02F;
    channel.comparison =
        compare_planes(name,
                       channel.image,
                       std::vector<double>(channel.reference.begin(), channel.reference.end()),
                       kWidth_px,
                       {},
                       channel.black,
                       6e-4);
    return channel;
}

ComparedImages two_channels() {
    return {.image = "mine/<script>document.title = 'owned'</script>.exr",
            .reference = "theirs.exr",
            .width_px = kWidth_px,
            .height_px = kHeight_px,
            .black = 1e-6,
            .channels = {channel_of("R", 100), channel_of("S0.550,000000nm", 1000)},
            .only_in_image = {"S0.470,000000nm"},
            .left_aside = {"A"}};
}

// A copy of the page that measures itself.
std::string measuring(const std::string& page) {
    return with_script(page, R"(
addEventListener('load', () => {
  const images = [...document.images];
  const shown = images.filter(i => i.complete && i.naturalWidth > 0 && i.clientWidth > 0);
  const within = (inner, outer) => inner.left > outer.left - 1 && inner.right < outer.right + 1 &&
                                   inner.top > outer.top - 1 && inner.bottom < outer.bottom + 1;
  const box = e => e.getBoundingClientRect();
  const cut = [...document.querySelectorAll('svg text')].filter(
    text => !within(box(text), box(text.ownerSVGElement)));
  const bars = [...document.querySelectorAll('[id^=colour-bar]')].filter(b => box(b).width > 40);
  const rings = [...document.querySelectorAll('.worst')].filter(
    ring => within(box(ring), box(ring.closest('.map'))));
  const ids = [...document.querySelectorAll('[id]')].map(e => e.id);
  const root = document.documentElement;
  document.title = `images ${shown.length}/${images.length}, cut ${cut.length}` +
    cut.map(text => ' [' + text.textContent + ']').join('') +
    `, bars ${bars.length}, rings ${rings.length}` +
    `, ids twice ${ids.length - new Set(ids).size}` +
    `, too wide ${root.scrollWidth - root.clientWidth}`;
});
)");
}

class ComparisonInABrowser : public testing::Test {
  protected:
    void SetUp() override {
        if (!browser()) GTEST_SKIP() << "no chromium on the PATH";
    }
};

TEST_F(ComparisonInABrowser, LeavesTheConsoleEmptyAndNamesAsText) {
    const Seen seen = seen_by(*browser(), comparison_html(two_channels()));
    EXPECT_EQ(seen.console, "");
    EXPECT_TRUE(title_in(seen.page).starts_with("Comparison of mine/&lt;script&gt;"))
        << title_in(seen.page);
}

// Of each channel the image, the reference and the map of errors.
TEST_F(ComparisonInABrowser, ShowsEveryPictureWithItsScaleAndRing) {
    const Seen seen = seen_by(*browser(), measuring(comparison_html(two_channels())));
    EXPECT_EQ(title_in(seen.page), "images 6/6, cut 0, bars 2, rings 2, ids twice 0, too wide 0");
    EXPECT_EQ(seen.console, "");
}

// That the check above can fail.
TEST_F(ComparisonInABrowser, IsFoundOutWhenItIsBroken) {
    const std::string page =
        replaced(measuring(comparison_html(two_channels())), "base64,", "base64,AAAA");
    EXPECT_TRUE(title_in(seen_by(*browser(), page).page).starts_with("images 5/6"));
}

}  // namespace
}  // namespace aphotic::comparison_browser_test
