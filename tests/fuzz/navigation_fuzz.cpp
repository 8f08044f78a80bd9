// SPDX-License-Identifier: BSD-3-Clause
//
// A navigation file from any text, by images' names and by their times, and the pose of an image
// that may be in it.
#include "fuzz.h"
#include "survey/navigation/navigation_file.h"

namespace {

void read(const std::string& text, const aphotic::NavigationOptions& options) {
    const std::vector<aphotic::ImageFile> files{
        {.source = "201207.0001.20240309_120000.tif", .name = "a"},
        {.source = "201207.0001.20240309_120001.tif", .name = "b"}};
    aphotic::expect_result_or_placed_error("survey.csv", [&] {
        const aphotic::Navigation navigation =
            aphotic::parse_navigation(text, options, files, nullptr);
        static_cast<void>(aphotic::words_of(*navigation.notes()));
        for (const char* image : {"201207.0001.tif", "201207.0001.20240309_120000.tif"}) {
            try {
                static_cast<void>(navigation.pose_of(image));
            } catch (const aphotic::InputError&) {
                // Of one image, whose name its caller puts before it.
            }
        }
    });
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text = aphotic::text_of(data, size);
    aphotic::NavigationOptions options{.source = "survey.csv"};
    read(text, options);
    options.time_mask = "xxxxxxxxxxxxYYYYMMDDxhhmmss";
    read(text, options);
    options.columns = {{"altitude_m", "alt2"}, {"time", "t"}};
    options.angles_in = aphotic::AngleUnit::Radians;
    options.altitude_is = aphotic::AltitudeIs::Plumb;
    options.altitude_offset_m = 0.5;
    read(text, options);
    return 0;
}
