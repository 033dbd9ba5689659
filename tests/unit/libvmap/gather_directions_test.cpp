// SPDX-License-Identifier: GPL-3.0-or-later
#include "gather_directions.h"

#include <gtest/gtest.h>

#include <set>

namespace vmap {
namespace {

/// Cells of a grid over the square that cosine-distributed directions are the image of.
std::set<int> cells_of(const DirectionSet& set, int rows, int columns) {
    std::set<int> cells;
    for (std::size_t i = 0; i < set.size(); ++i) {
        const float u = 1 - set.z[i] * set.z[i];
        float v = std::atan2(set.y[i], set.x[i]) / 6.2831853F;
        if (v < 0) v += 1;
        cells.insert(std::min(static_cast<int>(u * static_cast<float>(rows)), rows - 1) * columns +
                     std::min(static_cast<int>(v * static_cast<float>(columns)), columns - 1));
    }
    return cells;
}

TEST(GatherDirections, EverySetPutsOneDirectionInEachCellOfAGrid) {
    const GatherDirections directions(64, 7);
    for (std::uint32_t i = 0; i < GatherDirections::set_count; ++i) {
        EXPECT_GE(cells_of(directions.set(i), 8, 8).size(), 62U);  // all but what rounding moves over a border
        EXPECT_GE(cells_of(directions.set(i), 4, 16).size(), 62U);
    }
}

TEST(GatherDirections, AllSetsTogetherPutOneDirectionInEachCellOfAFinerGrid) {
    const GatherDirections directions(16, 3);
    std::set<int> cells;
    for (std::uint32_t i = 0; i < GatherDirections::set_count; ++i) cells.merge(cells_of(directions.set(i), 16, 16));
    EXPECT_GE(cells.size(), 250U);
}

TEST(GatherDirections, AreUnitVectorsOverTheHorizonThatDependOnTheSeed) {
    const GatherDirections a(32, 1);
    const GatherDirections b(32, 2);
    bool same = true;
    for (std::size_t k = 0; k < 32; ++k) {
        EXPECT_NEAR(a.set(0)[k].length(), 1, 1e-5F);
        EXPECT_GT(a.set(0)[k].z, 0);
        same = same && a.set(0)[k] == b.set(0)[k];
    }
    EXPECT_FALSE(same);
}

}  // namespace
}  // namespace vmap
