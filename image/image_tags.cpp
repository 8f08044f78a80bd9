// SPDX-License-Identifier: BSD-3-Clause
#include "image/image_tags.h"

#include "base/error.h"
#include "image/any_image_part.h"

namespace aphotic {

SharedTags read_image_tags(const std::filesystem::path& file) {
    using Read = void (*)(const std::filesystem::path&, SharedTags&);
    SharedTags tags;
    from_part<Read>("aphotic_read_image_tags")(file, tags);
    return tags;
}

void add_image_tags(const std::filesystem::path& file,
                    std::vector<unsigned char>& image,
                    const SharedTags& tags,
                    bool is_srgb) {
    using Add = void (*)(std::vector<unsigned char>&, const ImageTags*, bool, std::string&);
    std::string fault;
    from_part<Add>("aphotic_add_image_tags")(image, tags.get(), is_srgb, fault);
    if (!fault.empty()) throw RunError("{}: its tags cannot be written: {}", file.string(), fault);
}

std::vector<std::pair<std::string, std::string>> words_of(const ImageTags& tags) {
    using Words = void (*)(const ImageTags&, std::vector<std::pair<std::string, std::string>>&);
    std::vector<std::pair<std::string, std::string>> words;
    from_part<Words>("aphotic_words_of_tags")(tags, words);
    return words;
}

ShotExposure exposure_of(const ImageTags& tags) {
    using Exposure = void (*)(const ImageTags&, ShotExposure&);
    ShotExposure exposure;
    from_part<Exposure>("aphotic_exposure_of_tags")(tags, exposure);
    return exposure;
}

SharedTags tags_of(const ShotExposure& exposure, const std::string& taken_at) {
    using Tags = void (*)(const ShotExposure&, const std::string&, SharedTags&);
    SharedTags tags;
    if (exposure.time_s || exposure.iso || exposure.f_number || !taken_at.empty())
        from_part<Tags>("aphotic_tags_of_shot")(exposure, taken_at, tags);
    return tags;
}

}  // namespace aphotic
