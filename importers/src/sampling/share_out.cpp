// SPDX-License-Identifier: GPL-3.0-or-later
#include "share_out.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vmap {

std::vector<std::size_t> share_out_nearest(std::span<const double> areas, std::size_t total) {
    // Parts that deserve less than one point get theirs first; the others share the rest.
    std::vector<std::size_t> order(areas.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return areas[i]; });
    double area_left = std::accumulate(areas.begin(), areas.end(), 0.0);
    std::size_t left = total;
    std::vector<std::size_t> counts(areas.size(), 0);
    std::size_t first = 0;
    if (total >= areas.size()) {
        for (; first < order.size(); ++first) {
            const std::size_t i = order[first];
            if (areas[i] / area_left * static_cast<double>(left) >= 1) break;
            counts[i] = 1;
            area_left -= areas[i];
            --left;
        }
    }
    if (first == order.size()) {
        // Rounding left no part with a whole point: the largest takes what remains.
        if (!order.empty()) counts[order.back()] += left;
        return counts;
    }

    std::vector<double> remainders(areas.size(), -1);
    std::size_t given = 0;
    for (std::size_t k = first; k < order.size(); ++k) {
        const std::size_t i = order[k];
        const double exact = areas[i] / area_left * static_cast<double>(left);
        counts[i] = static_cast<std::size_t>(exact);
        remainders[i] = exact - std::floor(exact);
        given += counts[i];
    }
    std::ranges::sort(order);
    std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t i) { return remainders[i]; });
    for (std::size_t k = 0; given < left; k = (k + 1) % order.size()) {
        if (remainders[order[k]] < 0) continue;
        ++counts[order[k]];
        ++given;
    }
    return counts;
}

std::vector<std::size_t> share_out_in_order(std::span<const double> areas, std::size_t total, double offset) {
    const double sum = std::accumulate(areas.begin(), areas.end(), 0.0);
    std::vector<std::size_t> counts(areas.size());
    double area = 0;
    std::size_t given = 0;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        area += areas[i];
        const double exact = std::min(area / sum, 1.0) * static_cast<double>(total) + offset;
        std::size_t upto = std::min(static_cast<std::size_t>(exact), total);
        if (i + 1 == areas.size()) upto = total;
        counts[i] = upto - given;
        given = upto;
    }
    return counts;
}

}  // namespace vmap
