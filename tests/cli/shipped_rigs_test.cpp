// SPDX-License-Identifier: BSD-3-Clause
#include "support/run_command.h"
#include "support/small_scene.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

namespace aphotic::shipped_rigs_test {
namespace {

// Scenes of the users' own are in scene_test.cpp.
TEST(ShippedRigs, AllHaveAPlan) {
    const TempFolder folder;
    ASSERT_FALSE(all_scenes().empty());
    for (const std::filesystem::path& scene : all_scenes()) {
        const CommandResult plan = run_aphotic(folder.path(), {"plan", scene.string()});
        EXPECT_EQ(plan.status, 0) << plan.err;
    }
}

}  // namespace
}  // namespace aphotic::shipped_rigs_test
