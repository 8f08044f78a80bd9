// SPDX-License-Identifier: BSD-3-Clause
//
// A survey of a few small images of floats, of a floor that reflects alike under light that falls
// off to the right, at 2 m but for the last, which is higher and darker.
#pragma once

#include "image/exr.h"
#include "support/temp_folder.h"
#include "survey/survey.h"

#include <filesystem>
#include <string>
#include <vector>

namespace aphotic {

class RawSurvey {
  public:
    static constexpr int kWidth_px = 8;
    static constexpr int kHeight_px = 6;
    static constexpr std::size_t kPixels_of_plane = kWidth_px * kHeight_px;

    RawSurvey() {
        std::filesystem::create_directories(path("raw"));
        write("a", 0.5F);
        write("b", 1.0F);
        write("c", 3.0F);
        write("high", 0.1F);
    }

    [[nodiscard]] std::filesystem::path path(const std::string& name) const {
        return temp_.path() / name;
    }

    // Of 1 on average; a little more in blue.
    static std::vector<float> light() {
        std::vector<float> planes;
        for (std::size_t c = 0; c < kChannels; ++c) {
            for (std::size_t i = 0; i < kPixels_of_plane; ++i) {
                const float x = static_cast<float>(i % kWidth_px) + 0.5F;
                planes.push_back(1.5F + 0.1F * static_cast<float>(c) - x / kWidth_px);
            }
        }
        return planes;
    }

    // The light times a factor.
    void write(const std::string& name, float factor) const {
        std::vector<float> samples = light();
        for (float& sample : samples) sample *= factor;
        ExrWriter exr(path("raw/" + name + ".exr"), kWidth_px, kHeight_px, {"R", "G", "B"}, {});
        exr.write_rows(kHeight_px, samples);
        exr.finish();
    }

    [[nodiscard]] Survey survey() const {
        Survey survey;
        survey.files = image_files({path("raw").string()}, path("out"));
        survey.navigation = Navigation("track",
                                       {{.image = "a", .sled = {1.9, 0.1, 0.0}},
                                        {.image = "b", .sled = {2.0, 0.2, 0.0}},
                                        {.image = "c", .sled = {2.1, 0.6, 0.0}},
                                        {.image = "high", .sled = {3.5, 0.0, 0.0}}});
        return survey;
    }

    static std::vector<float> samples_of(const std::filesystem::path& file,
                                         const std::vector<std::string>& channels) {
        ExrReader exr(file);
        std::vector<float> samples(channels.size() * kPixels_of_plane);
        exr.read_rows(0, kHeight_px, channels, samples);
        return samples;
    }

  private:
    TempFolder temp_;
};

}  // namespace aphotic
