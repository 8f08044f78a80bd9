// SPDX-License-Identifier: BSD-3-Clause
//
// A table of what tasks answered, by answers written here.
#include "sweep/collection.h"

#include "base/json_text.h"
#include "support/small_sweep.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace aphotic::sweep_collection_test {
namespace {

void answer(const Sweep& sweep, std::size_t number, const nlohmann::json& with) {
    write_text_file(task_folder(sweep, number) / "answer.json", json_text(with));
    write_text_file(task_folder(sweep, number) / "result.json",
                    json_text({{"digest", sweep.digests[number - 1]},
                               {"exit_status", 0},
                               {"seconds", 1.0},
                               {"error", ""}}));
}

TEST(Collection, HasAFitsNumbersByTheirKeys) {
    const SmallSweep small;
    const Sweep sweep =
        write_sweep(small.write("trace", kThreeWaters), small.folder() / "out", "/usr/bin/aphotic");
    answer(sweep,
           2,
           {{"numbers",
             {{{"key", "water.multiple"}, {"value", 1.25}, {"error", 0.5}},
              {{"key", "strobe.fore.power"}, {"value", 0.75}, {"error", 0.125}}}},
            {"shares", {1, 2, 3, 4}}});
    const std::string csv = results_csv(sweep, standings_of(sweep));
    EXPECT_NE(csv.find(",numbers.water.multiple.error,numbers.water.multiple.value,"
                       "numbers.strobe.fore.power.error,numbers.strobe.fore.power.value\n"),
              std::string::npos)
        << csv;
    EXPECT_NE(csv.find(",0.5,1.25,0.125,0.75\n"), std::string::npos) << csv;
    EXPECT_EQ(csv.find("shares"), std::string::npos);  // a curve is no number
}

}  // namespace
}  // namespace aphotic::sweep_collection_test
