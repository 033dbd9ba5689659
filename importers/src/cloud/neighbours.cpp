// SPDX-License-Identifier: GPL-3.0-or-later
#include "neighbours.h"

#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <utility>

namespace vmap {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Site = std::pair<Kernel::Point_3, std::uint32_t>;  // place and number of a point
using Traits = CGAL::Search_traits_adapter<Site, CGAL::First_of_pair_property_map<Site>, CGAL::Search_traits_3<Kernel>>;
using Search = CGAL::Orthogonal_k_neighbor_search<Traits>;

}  // namespace

Neighbours find_neighbours(std::span<const Imath::V3f> positions, std::size_t per_point, const Watch& watch) {
    const std::size_t count = positions.size();
    per_point = count > 0 ? std::min(per_point, count - 1) : 0;
    std::vector<std::uint32_t> indices(count * per_point);
    if (per_point == 0) return {std::move(indices), per_point};

    std::vector<Site> sites;
    sites.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i)
        sites.emplace_back(Kernel::Point_3(positions[i].x, positions[i].y, positions[i].z), i);
    // The tree is built before many threads ask it at once.
    Search::Tree tree(sites.begin(), sites.end());
    tree.build();

    for_each_point(count, watch, [&](std::size_t i) {
        Search found(tree, sites[i].first, static_cast<unsigned>(per_point + 1));
        std::uint32_t* const row = indices.data() + i * per_point;
        std::size_t filled = 0;
        for (const auto& [site, squared_distance] : found)
            if (site.second != i && filled < per_point) row[filled++] = site.second;
    });
    return {std::move(indices), per_point};
}

double local_spacing(const Neighbours& neighbours, std::span<const Imath::V3f> positions, std::size_t point) {
    constexpr std::size_t nearest = 6;
    const std::span<const std::uint32_t> around = neighbours.of(point, nearest);
    double sum = 0;
    for (const std::uint32_t j : around) sum += (Imath::V3d(positions[j]) - Imath::V3d(positions[point])).length();
    return around.empty() ? 0 : sum / static_cast<double>(around.size());
}

}  // namespace vmap
