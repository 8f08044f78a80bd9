// SPDX-License-Identifier: BSD-3-Clause
#include "support/command_test.h"
#include "support/small_scene.h"

#include <gtest/gtest.h>

namespace aphotic::shipped_rigs_test {
namespace {

using ShippedRigs = CommandTest;

// Scenes of the users' own are in scene_test.cpp.
TEST_F(ShippedRigs, AllHaveAPlan) {
    ASSERT_FALSE(all_scenes().empty());
    for (const std::filesystem::path& scene : all_scenes()) {
        done({"plan", scene.string()});
    }
}

}  // namespace
}  // namespace aphotic::shipped_rigs_test
