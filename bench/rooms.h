// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The seven rooms of the seed's table, as meshes and as points.
#pragma once

#include <vmap/point_cloud.h>
#include <vmap/scene.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace vmap::bench {

/// A row of the seed's table (2007 hardware).
struct SeedRow {
    std::string name;
    std::string what;
    double points = 0;     ///< millions
    double n_squared = 0;  ///< millions of pairs of leaves
    double links = 0;      ///< millions
    double decrease = 0;   ///< per cent
    double n_squared_mb = 0;
    double vmap_mb = 0;
    double seconds = 0;
};

/// The table, top to bottom.
[[nodiscard]] const std::vector<SeedRow>& seed_rows();

struct Room {
    Scene scene;
    PointCloud cloud;

    /// Mean distance of neighbouring points, world units.
    [[nodiscard]] double spacing() const;
};

/// Makes the room of a row: the Cornell box of the bundled scenes, empty, packed with boxes, or with a model in it.
/// GAN and GOD, whose scans are not public, hold an armadillo and a bust.
///
/// - points: 0 for as many as the row says
/// - returns nothing, and says so on standard error, when the model's file is absent
[[nodiscard]] std::optional<Room> make_room(const SeedRow& row, std::size_t points = 0);

}  // namespace vmap::bench
