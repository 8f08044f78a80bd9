// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation/ifdo.h"

#include "base/error.h"
#include "support/has.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <string>

namespace aphotic::ifdo_test {
namespace {

// As the specification's example files are laid out.
constexpr const char* kYaml = R"(image-set-header:
  image-set-name: "SO268 SO268-1_21-1_OFOS SO_CAM-1_Photo_OFOS"
  image-set-uuid: f840644a-fe4a-46a7-9791-e32c211bcbf5
  image-set-ifdo-version: v2.1.0
  image-altitude-meters: -4129.6
  image-datetime: 2019-03-04 08:06:34.000
  image-creators: &people
    - {name: A. Person, uri: 'https://orcid.org/0000-0000-0000-0001'}
  image-pi: {name: 'no', uri: ''}
image-set-items:
  a.jpg:
    - image-meters-above-ground: 2.5
      image-acquisition-settings: {ISO: 200, note: "007", dive: 007}
  b.jpg:
    image-meters-above-ground: 3
    image-creators: *people
    image-license: null
)";

std::string fault_of(const std::string& text) {
    return refusal_of([&] { return parse_ifdo("set.yaml", text); });
}

TEST(Ifdo, OfYamlHasTheTypesOfItsScalars) {
    ASSERT_TRUE(is_ifdo(kYaml));
    const Ifdo ifdo = parse_ifdo("set.yaml", kYaml);
    EXPECT_TRUE(ifdo.is_yaml);
    EXPECT_EQ(ifdo.header()["image-altitude-meters"], -4129.6);
    EXPECT_EQ(ifdo.header()["image-datetime"], "2019-03-04 08:06:34.000");
    EXPECT_EQ(ifdo.header()["image-pi"]["name"], "no");
    EXPECT_EQ(ifdo.items()["b.jpg"]["image-creators"], ifdo.header()["image-creators"]);
    EXPECT_TRUE(ifdo.items()["b.jpg"]["image-license"].is_null());
    const nlohmann::json* a = still_image(ifdo.items()["a.jpg"]);
    ASSERT_NE(a, nullptr);
    const nlohmann::json& settings = (*a)["image-acquisition-settings"];
    EXPECT_TRUE(settings["ISO"].is_number_integer());
    EXPECT_EQ(settings["note"], "007");
    EXPECT_EQ(settings["dive"], "007") << "octal to some, a name to others: as it stands";
}

TEST(Ifdo, TakesFieldsOfTheImageBeforeThoseOfAll) {
    const Ifdo ifdo = parse_ifdo("set.yaml", kYaml);
    const nlohmann::json& b = ifdo.items()["b.jpg"];
    EXPECT_EQ(ifdo.field(b, "image-meters-above-ground"), 3);
    EXPECT_EQ(ifdo.field(b, "image-altitude-meters"), -4129.6);
    EXPECT_TRUE(ifdo.field(b, "image-license").is_null());
}

TEST(Ifdo, IsTheSameReadAgain) {
    const Ifdo yaml = parse_ifdo("set.yaml", kYaml);
    const std::string again = ifdo_text(yaml);
    EXPECT_EQ(parse_ifdo("again.yaml", again).set, yaml.set) << again;
    const Ifdo json = parse_ifdo("set.json", yaml.set.dump());
    EXPECT_FALSE(json.is_yaml);
    EXPECT_EQ(json.set, yaml.set);
    EXPECT_EQ(nlohmann::json::parse(ifdo_text(json)), yaml.set);
}

TEST(Ifdo, KnowsStillImages) {
    using Json = nlohmann::json;
    EXPECT_NE(still_image(Json{{"a", 1}}), nullptr);
    EXPECT_NE(still_image(Json::array({Json{{"a", 1}}})), nullptr);
    EXPECT_EQ(still_image(Json::array({Json{{"a", 1}}, Json{{"a", 2}}})), nullptr);
    EXPECT_EQ(still_image(Json::array()), nullptr);
    EXPECT_EQ(still_image(Json("a")), nullptr);
    EXPECT_FALSE(is_ifdo("image,altitude_m\na,2\n"));
}

TEST(Ifdo, RefusesWhatIsNone) {
    EXPECT_EQ(
        fault_of("a: 1"),
        "set.yaml: image-set-header: found none; allowed: an object, as in an iFDO of version "
        "2");
    EXPECT_EQ(
        fault_of("image-set-header: {}\nimage-set-items: []\n"),
        "set.yaml: image-set-items: found array; allowed: an object, as in an iFDO of version "
        "2");
    EXPECT_EQ(fault_of("image-set-header: {}\nimage-set-items: {}\n"), kAccepted);
    EXPECT_EQ(fault_of("").find("set.yaml: image-set-header: found none"), 0U);
    EXPECT_EQ(fault_of("a: [1\nb: 2").find("set.yaml:"), 0U);
    EXPECT_EQ(fault_of("{\"image-set-header\": ").find("set.yaml"), 0U);
    EXPECT_EQ(fault_of("image-set-header: {a: \xff}\nimage-set-items: {}\n"),
              "set.yaml: found bytes that are not UTF-8");
    EXPECT_EQ(fault_of("image-set-header: {}\nimage-set-items:\n  a.jpg: {}\n  a.jpg: {}\n"),
              "set.yaml:4: duplicate key 'a.jpg'");
    const auto of_version = [](const std::string& version) {
        return fault_of("image-set-header: {image-set-ifdo-version: " + version +
                        "}\nimage-set-items: {}\n");
    };
    EXPECT_EQ(of_version("v2.2.1"), kAccepted);
    EXPECT_EQ(
        of_version("v1.1.0"),
        "set.yaml: image-set-ifdo-version: found v1.1.0; allowed: v2.0.0 and later, below v3");
    EXPECT_EQ(fault_of("? {a: 1}\n: 2\n"), "set.yaml:1: a key is not a string");
}

// Ten levels of ten aliases each are ten thousand million values of 400 letters.
TEST(Ifdo, RefusesAliasesThatStandForTooMuch) {
    std::string bomb = "image-set-header:\n  a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
    for (int i = 1; i < 10; ++i) {
        const std::string before = "*a" + std::to_string(i - 1);
        bomb += "  a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + before;
        for (int k = 1; k < 10; ++k) bomb += ", " + before;
        bomb += "]\n";
    }
    const std::string fault = fault_of(bomb + "image-set-items: {}\n");
    EXPECT_EQ(fault.find("set.yaml:"), 0U);
    EXPECT_TRUE(has(fault, "its aliases expand to more than the file could hold"));
    EXPECT_NE(fault_of("image-set-header: &a {b: *a}\nimage-set-items: {}\n"), kAccepted)
        << "itself";
}

// A text of 110 MB took 8.5 GB.
TEST(Ifdo, RefusesMoreYamlThanMemoryHolds) {
    std::string text = "image-set-header: {}\nimage-set-items:\n a: [";
    for (std::size_t i = 0; i < kMostYamlValues; ++i) text += "0,";
    EXPECT_EQ(fault_of(text + "0]\n"),
              "set.yaml: found 800005 lines and values of YAML; allowed: up to 800000; an iFDO in "
              "JSON may have more");
}

TEST(Ifdo, RefusesDepth) {
    const std::string yaml = "image-set-header: " + std::string(100, '[') + std::string(100, ']');
    EXPECT_EQ(fault_of(yaml), "set.yaml:1: it is nested too deeply");
    EXPECT_EQ(fault_of("a: " + std::string(100000, '[')).find("set.yaml:"), 0U);
    EXPECT_EQ(fault_of("{\"a\": " + std::string(100000, '[')).find("set.yaml"), 0U);
}

}  // namespace
}  // namespace aphotic::ifdo_test
