// SPDX-License-Identifier: GPL-3.0-or-later
#include "closed_parts.h"

#include "lit_sides.h"
#include "welded_mesh.h"

#include <vmap/surface_shading.h>

#include <Imath/ImathBox.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace vmap {
namespace {

using Imath::V3d;

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Faces that hang together.
struct Part {
    std::vector<std::uint32_t> faces;
    Imath::Box3d box;
    bool is_closed = true;
    double volume = 0;          ///< six times what its faces enclose, by their orientation in the part
    std::uint32_t lamp = none;  ///< its largest face that emits
    double lamp_area = 0;
};

class PartFinder {
public:
    PartFinder(const Scene& scene, const V3d& origin) : scene_(scene), origin_(origin), first_(first_faces(scene)) {}

    void run() {
        link_faces();
        part_of_.assign(first_.back(), none);
        is_turned_.assign(first_.back(), false);
        for (std::uint32_t face = 0; face < part_of_.size(); ++face)
            if (part_of_[face] == none) grow(face);
    }

    [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
    [[nodiscard]] bool is_turned(std::uint32_t face) const { return is_turned_[face]; }

    [[nodiscard]] std::array<V3d, 3> corners(std::uint32_t face) const {
        const std::size_t instance = instance_of(face);
        std::array<V3d, 3> result = world_triangle(scene_, instance, face - first_[instance]);
        for (V3d& corner : result) corner -= origin_;
        if (is_mirrored(scene_.instances[instance])) std::swap(result[1], result[2]);
        return result;
    }

private:
    [[nodiscard]] std::size_t instance_of(std::uint32_t face) const {
        return std::ranges::upper_bound(first_, face) - first_.begin() - 1;
    }
    [[nodiscard]] const Material& material_of(std::uint32_t face) const {
        return scene_.materials[scene_.meshes[scene_.instances[instance_of(face)].mesh].material];
    }

    /// A neighbour over one edge; `turned` when the two run through the edge the same way.
    struct Link {
        std::uint32_t face = none;
        bool is_turned = false;
        bool is_open = false;  ///< an odd number of faces meets here
    };

    void link_faces() {
        const WeldedVertices vertices(scene_, origin_);
        std::vector<TriangleEdge> edges(3 * first_.back());
        tbb::parallel_for(std::size_t{0}, scene_.instances.size(), [&](std::size_t i) {
            const bool mirrored = is_mirrored(scene_.instances[i]);
            for (std::size_t face = first_[i]; face < first_[i + 1]; ++face) {
                auto numbers = vertices.of(i, face - first_[i]);
                if (mirrored) std::swap(numbers[1], numbers[2]);
                for (int k = 0; k < 3; ++k)
                    edges[3 * face + k] =
                        triangle_edge(static_cast<std::uint32_t>(face), k, numbers[k], numbers[(k + 1) % 3]);
            }
        });
        tbb::parallel_sort(edges);

        links_.resize(edges.size());
        for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
            for (end = begin; end < edges.size() && edges[end].vertices == edges[begin].vertices;) ++end;
            const std::size_t count = end - begin;
            const bool is_point = edges[begin].vertices >> 32 == (edges[begin].vertices & none);
            for (std::size_t k = begin; k < end; ++k) {
                Link& link = links_[3 * std::size_t{edges[k].triangle} + edges[k].corner];
                link.is_open = count % 2 == 1 && !is_point;
                if (count != 2 || is_point) continue;
                const TriangleEdge& other = edges[k == begin ? begin + 1 : begin];
                link.face = other.triangle;
                link.is_turned = other.is_ascending == edges[k].is_ascending;
            }
        }
    }

    void grow(std::uint32_t first_face) {
        const auto number = static_cast<std::uint32_t>(parts_.size());
        Part part;
        part_of_[first_face] = number;
        part.faces.push_back(first_face);
        for (std::size_t next = 0; next < part.faces.size(); ++next) {
            const std::uint32_t face = part.faces[next];
            for (int k = 0; k < 3; ++k) {
                const Link& link = links_[3 * std::size_t{face} + k];
                if (link.is_open) part.is_closed = false;
                if (link.face == none) continue;
                const bool turned = is_turned_[face] != link.is_turned;
                if (part_of_[link.face] == none) {
                    part_of_[link.face] = number;
                    is_turned_[link.face] = turned;
                    part.faces.push_back(link.face);
                } else if (is_turned_[link.face] != turned) {
                    part.is_closed = false;  // one-sided like a Klein bottle
                }
            }
        }
        measure(part);
        parts_.push_back(std::move(part));
    }

    void measure(Part& part) const {
        const V3d middle = corners(part.faces[0])[0];
        double area = 0;
        for (const std::uint32_t face : part.faces) {
            auto [a, b, c] = corners(face);
            for (const V3d& corner : {a, b, c}) part.box.extendBy(corner);
            const double six_volumes = (a - middle).dot((b - middle).cross(c - middle));
            part.volume += is_turned_[face] ? -six_volumes : six_volumes;
            const double face_area = (b - a).cross(c - a).length();
            area += face_area;
            const Material& material = material_of(face);
            if (material.alpha_mode == AlphaMode::mask) part.is_closed = false;
            if (material.emits() && face_area > part.lamp_area) {
                part.lamp = face;
                part.lamp_area = face_area;
            }
        }
        // A sheet closed onto itself has no inside.
        if (!(std::abs(part.volume) > 1e-9 * area * std::sqrt(area))) part.is_closed = false;
    }

    const Scene& scene_;
    V3d origin_;
    std::vector<std::size_t> first_;
    std::vector<Link> links_;  ///< three per face
    std::vector<std::uint32_t> part_of_;
    std::vector<bool> is_turned_;  ///< against the first face of its part
    std::vector<Part> parts_;
};

/// Something that makes an inside worth lighting.
struct Occupant {
    V3d position;
    std::uint32_t part = none;  ///< that it belongs to
};

std::vector<Occupant> find_occupants(const Scene& scene, const V3d& origin, const PartFinder& finder) {
    std::vector<Occupant> found;
    for (const LightSource& light : scene.lights)
        if (light.kind != LightKind::sun) found.push_back({.position = light.position - origin});
    for (const Camera& camera : scene.cameras) {
        const Imath::M44d& m = camera.world_from_camera;
        found.push_back({.position = V3d(m[3][0], m[3][1], m[3][2]) - origin});
    }
    for (std::uint32_t i = 0; i < finder.parts().size(); ++i) {
        const Part& part = finder.parts()[i];
        if (part.lamp == none) continue;
        const auto [a, b, c] = finder.corners(part.lamp);
        found.push_back({.position = (a + b + c) / 3, .part = i});
    }
    std::ranges::stable_sort(found, {}, [](const Occupant& occupant) { return occupant.position.x; });
    return found;
}

/// Solid angle of a triangle, positive where it is seen from its back.
double solid_angle(const V3d& a, const V3d& b, const V3d& c) {
    const double la = a.length();
    const double lb = b.length();
    const double lc = c.length();
    const double over = a.dot(b.cross(c));
    const double under = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    return 2 * std::atan2(over, under);
}

bool is_inside(const V3d& position, const Part& part, const PartFinder& finder) {
    double sum = 0;
    for (const std::uint32_t face : part.faces) {
        const auto [a, b, c] = finder.corners(face);
        const double angle = solid_angle(a - position, b - position, c - position);
        sum += finder.is_turned(face) ? -angle : angle;
    }
    return std::abs(sum) > 2 * std::numbers::pi;
}

bool is_occupied(std::uint32_t number, const PartFinder& finder, const std::vector<Occupant>& occupants) {
    const Part& part = finder.parts()[number];
    const auto x_of = [](const Occupant& occupant) { return occupant.position.x; };
    const auto begin = std::ranges::lower_bound(occupants, part.box.min.x, {}, x_of);
    const auto end = std::ranges::upper_bound(occupants, part.box.max.x, {}, x_of);
    return std::any_of(begin, end, [&](const Occupant& occupant) {
        return occupant.part != number && part.box.intersects(occupant.position) &&
               is_inside(occupant.position, part, finder);
    });
}

}  // namespace

void leave_out_insides(const Scene& scene, const V3d& origin, std::vector<std::uint8_t>& lit) {
    PartFinder finder(scene, origin);
    finder.run();
    const std::vector<Occupant> occupants = find_occupants(scene, origin, finder);
    const std::vector<Part>& parts = finder.parts();
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
        const Part& part = parts[i];
        const auto is_both = [&](std::uint32_t face) { return lit[face] == (front_side | back_side); };
        if (!part.is_closed || std::ranges::none_of(part.faces, is_both)) return;
        if (is_occupied(static_cast<std::uint32_t>(i), finder, occupants)) return;
        for (const std::uint32_t face : part.faces)
            if (is_both(face)) lit[face] = (part.volume > 0) != finder.is_turned(face) ? front_side : back_side;
    });
}

}  // namespace vmap
