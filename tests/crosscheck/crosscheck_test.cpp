// SPDX-License-Identifier: GPL-3.0-or-later
#include <crosscheck/cases.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace vmap::crosscheck {
namespace {

bool has_povray() {
    return std::system("command -v povray >/dev/null 2>&1") == 0;
}

class CrosscheckCase : public testing::TestWithParam<Case> {};

TEST_P(CrosscheckCase, StaysWithinItsLimits) {
    if (!has_povray()) GTEST_SKIP() << "povray is not installed: NOTHING WAS COMPARED";
    Case item = GetParam();
    const std::optional<Scene> scene = scene_of(item, VMAP_SCENES, VMAP_SHARED "/models");
    if (!scene) GTEST_SKIP() << "the model of " << item.name << " is not there: NOTHING WAS COMPARED";
    item.config.cache = VMAP_CROSSCHECK_CACHE;
    const Crosscheck check = cross_check(*scene, item.config);
    EXPECT_GT(check.pixels.size(), 1000U);
    ASSERT_FALSE(item.limits.empty());
    const std::map<std::string, DifferenceFigures> figures = figures_of(check);
    for (const auto& [name, limits] : item.limits) {
        EXPECT_GT(figures.at(name).count, 200U) << name;
        EXPECT_LE(figures.at(name).median, limits.median) << name;
        EXPECT_LE(figures.at(name).p95, limits.p95) << name;
    }
}

INSTANTIATE_TEST_SUITE_P(Cases, CrosscheckCase, testing::ValuesIn(read_cases(VMAP_CASES)),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace vmap::crosscheck
