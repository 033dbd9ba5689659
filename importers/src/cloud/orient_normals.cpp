// SPDX-License-Identifier: GPL-3.0-or-later
#include "orient_normals.h"

#include <Imath/ImathBox.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace vmap {
namespace {

using Imath::V3d;
using Imath::V3f;

/// Neighbours that the spanning tree may run to.
constexpr std::size_t tree_neighbours = 12;

struct Edge {
    float weight = 0;  ///< 0: normals surely agree but for their signs, 1: nothing is known
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    bool opposed = false;  ///< one of the two normals is to be turned
};

/// The normal at one end, mirrored in the plane between the ends, is the other end's on any circular arc through both:
/// over flat surface, around creases of either kind, and across thin walls.
Edge edge_between(std::span<const V3f> positions, std::span<const V3f> normals, std::uint32_t from, std::uint32_t to) {
    const V3d step = V3d(positions[to]) - V3d(positions[from]);
    const V3d along = step / step.length();
    const V3d normal(normals[from]);
    const V3d mirrored = normal - along * (2 * along.dot(normal));
    const double agreement = mirrored.dot(V3d(normals[to]));
    return {static_cast<float>(1 - std::min(std::abs(agreement), 1.0)), from, to, agreement < 0};
}

/// Sets of points, each with the turn that its normal needs against the set's first.
class TurnedSets {
public:
    explicit TurnedSets(std::size_t count) : parent_(count), turned_(count), size_(count, 1) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    struct Root {
        std::uint32_t point = 0;
        bool turned = false;
    };

    Root find(std::uint32_t point) {
        Root root{point, false};
        while (parent_[root.point] != root.point) {
            root.turned = root.turned != turned_[root.point];
            root.point = parent_[root.point];
        }
        // The path is tied to the root, so that the next search is short.
        bool turned = root.turned;
        while (parent_[point] != point) {
            const std::uint32_t next = parent_[point];
            const bool step = turned_[point];
            parent_[point] = root.point;
            turned_[point] = turned;
            turned = turned != step;
            point = next;
        }
        return root;
    }

    void join(const Edge& edge) {
        Root a = find(edge.from);
        Root b = find(edge.to);
        if (a.point == b.point) return;
        if (size_[a.point] < size_[b.point]) std::swap(a, b);
        parent_[b.point] = a.point;
        turned_[b.point] = (a.turned != b.turned) != edge.opposed;
        size_[a.point] += size_[b.point];
    }

    [[nodiscard]] std::size_t size(std::uint32_t root) const { return size_[root]; }

private:
    std::vector<std::uint32_t> parent_;
    std::vector<bool> turned_;
    std::vector<std::uint32_t> size_;
};

std::vector<Edge> edges_to_neighbours(std::span<const V3f> positions, const Neighbours& neighbours,
                                      std::span<const V3f> normals) {
    std::vector<Edge> edges;
    edges.reserve(positions.size() * std::min(tree_neighbours, neighbours.per_point()));
    for (std::uint32_t i = 0; i < positions.size(); ++i)
        for (const std::uint32_t j : neighbours.of(i, tree_neighbours))
            edges.push_back(edge_between(positions, normals, i, j));
    return edges;
}

/// Where two sets touch: what the edges between them say of the turn of one against the other.
struct Contact {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    double votes = 0;   ///< negative: one of the two is to be turned
    double voters = 0;  ///< sum of what each edge may say at most
};

std::vector<Contact> find_contacts(const std::vector<Edge>& edges, TurnedSets& sets) {
    std::vector<Contact> single;
    for (const Edge& edge : edges) {
        const TurnedSets::Root from = sets.find(edge.from);
        const TurnedSets::Root to = sets.find(edge.to);
        if (from.point == to.point) continue;
        const bool opposed = (from.turned != to.turned) != edge.opposed;
        const double voice = 1 - static_cast<double>(edge.weight);
        single.push_back(
            {std::min(from.point, to.point), std::max(from.point, to.point), opposed ? -voice : voice, voice});
    }
    const auto pair_of = [](const Contact& contact) { return std::pair(contact.a, contact.b); };
    std::stable_sort(single.begin(), single.end(),
                     [&](const Contact& x, const Contact& y) { return pair_of(x) < pair_of(y); });
    std::vector<Contact> contacts;
    for (const Contact& contact : single) {
        if (contacts.empty() || pair_of(contacts.back()) != pair_of(contact)) {
            contacts.push_back(contact);
            continue;
        }
        contacts.back().votes += contact.votes;
        contacts.back().voters += contact.voters;
    }
    std::sort(contacts.begin(), contacts.end(), [&](const Contact& x, const Contact& y) {
        return std::tuple(-std::abs(x.votes), x.a, x.b) < std::tuple(-std::abs(y.votes), y.a, y.b);
    });
    return contacts;
}

/// Smooth surface: the least certain edges last, as far as normals turn little from point to point.
void join_smooth_patches(std::vector<Edge>& edges, std::span<const V3f> normals, TurnedSets& sets) {
    constexpr double smooth = 0.7;  // cosine between the normals of neighbours
    tbb::parallel_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return std::tie(a.weight, a.from, a.to) < std::tie(b.weight, b.from, b.to);
    });
    for (const Edge& edge : edges)
        if (std::abs(V3d(normals[edge.from]).dot(V3d(normals[edge.to]))) > smooth) sets.join(edge);
}

/// Patches that meet in creases: those whose edges agree. Where a block stands on a floor that goes on beneath it, the
/// floor's two parts say the opposite of each other, and block and floor remain two pieces. Scraps, such as a few bad
/// normals along a crease, follow the majority.
void join_patches(const std::vector<Edge>& edges, TurnedSets& sets) {
    constexpr double agreement = 0.5;
    constexpr std::size_t scrap = 30;
    for (bool joined = true; joined;) {
        joined = false;
        for (const Contact& contact : find_contacts(edges, sets)) {
            const TurnedSets::Root a = sets.find(contact.a);
            const TurnedSets::Root b = sets.find(contact.b);
            if (a.point == b.point) continue;
            const bool is_scrap = std::min(sets.size(a.point), sets.size(b.point)) < scrap;
            if (!is_scrap && std::abs(contact.votes) < agreement * contact.voters) continue;
            sets.join({.from = contact.a, .to = contact.b, .opposed = contact.votes < 0});
            joined = true;
        }
    }
}

/// What decides the side of one piece.
struct PieceShape {
    std::size_t points = 0;
    V3d center{0, 0, 0};
    Imath::Box3d box;
    double outward = 0;  ///< sum of normal times place from the center: positive where normals face away from it
    double reach = 0;    ///< the most that this could be
    double away = 0;     ///< the same from the middle of the cloud
    V3d top{0, 0, 0};
    float top_normal_y = 0;
};

std::vector<PieceShape> shapes_of(std::span<const V3f> positions, const CloudPieces& pieces,
                                  std::span<const V3f> normals, const V3d& middle) {
    std::vector<PieceShape> shapes(pieces.count);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        PieceShape& shape = shapes[pieces.piece_of[i]];
        const V3d position(positions[i]);
        if (shape.points == 0 || position.y > shape.top.y) {
            shape.top = position;
            shape.top_normal_y = normals[i].y;
        }
        ++shape.points;
        shape.center += position;
        shape.box.extendBy(position);
    }
    for (PieceShape& shape : shapes) shape.center /= static_cast<double>(std::max<std::size_t>(shape.points, 1));
    for (std::size_t i = 0; i < positions.size(); ++i) {
        PieceShape& shape = shapes[pieces.piece_of[i]];
        const V3d from_center = V3d(positions[i]) - shape.center;
        shape.outward += from_center.dot(V3d(normals[i]));
        shape.reach += from_center.length();
        shape.away += (V3d(positions[i]) - middle).dot(V3d(normals[i]));
    }
    return shapes;
}

/// Whether the piece is to be turned around to face the side.
bool faces_wrongly(const PieceShape& piece, CloudSide side, const Imath::Box3d& whole) {
    constexpr double flat = 0.1;  // a piece that encloses so little is a sheet, such as a wall scanned by itself
    constexpr double most = 0.5;  // share of the cloud's extent from which on a piece may be the room itself
    if (side == CloudSide::topmost) return piece.top_normal_y < 0;
    const bool is_sheet = std::abs(piece.outward) < flat * piece.reach;
    const bool is_room = piece.box.size().length() > most * whole.size().length();
    const bool inward = side == CloudSide::inward && (is_sheet || is_room);
    const double outward = is_sheet ? piece.away : piece.outward;
    return (outward > 0) == inward;
}

}  // namespace

CloudPieces make_normals_agree(std::span<const V3f> positions, const Neighbours& neighbours, std::span<V3f> normals) {
    TurnedSets sets(positions.size());
    std::vector<Edge> edges = edges_to_neighbours(positions, neighbours, normals);
    join_smooth_patches(edges, normals, sets);
    join_patches(edges, sets);

    CloudPieces pieces{.piece_of = std::vector<std::uint32_t>(positions.size()), .count = 0};
    constexpr std::uint32_t unnumbered = 0xFFFFFFFF;
    std::vector<std::uint32_t> number_of_root(positions.size(), unnumbered);
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        const TurnedSets::Root root = sets.find(i);
        if (root.turned) normals[i] = -normals[i];
        std::uint32_t& number = number_of_root[root.point];
        if (number == unnumbered) number = static_cast<std::uint32_t>(pieces.count++);
        pieces.piece_of[i] = number;
    }
    return pieces;
}

void turn_pieces(std::span<const V3f> positions, const CloudPieces& pieces, CloudSide side, std::span<V3f> normals) {
    Imath::Box3d whole;
    for (const V3f& position : positions) whole.extendBy(V3d(position));
    const std::vector<PieceShape> shapes = shapes_of(positions, pieces, normals, whole.center());
    std::vector<bool> turn(pieces.count);
    for (std::size_t p = 0; p < pieces.count; ++p) turn[p] = faces_wrongly(shapes[p], side, whole);
    for (std::size_t i = 0; i < positions.size(); ++i)
        if (turn[pieces.piece_of[i]]) normals[i] = -normals[i];
}

void turn_to_viewpoint(std::span<const V3f> positions, const V3d& viewpoint, std::span<V3f> normals) {
    for (std::size_t i = 0; i < positions.size(); ++i)
        if ((viewpoint - V3d(positions[i])).dot(V3d(normals[i])) < 0) normals[i] = -normals[i];
}

}  // namespace vmap
