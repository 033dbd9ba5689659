// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud_scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace vmap::test {
namespace {

using Imath::V3f;

/// Uniform numbers from a fixed seed; the same on every platform, unlike the standard distributions.
class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    float between(float low, float high) {
        return low + (high - low) * static_cast<float>(engine_()) / static_cast<float>(std::mt19937::max());
    }
    V3f in_cube() { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }
    V3f direction() {
        const float z = between(-1, 1);
        const float angle = between(0, 2 * std::numbers::pi_v<float>);
        const float r = std::sqrt(std::max(0.0F, 1 - z * z));
        return {r * std::cos(angle), r * std::sin(angle), z};
    }

private:
    std::mt19937 engine_;
};

void add_point(PointCloud& cloud, const V3f& position, const V3f& normal, float area) {
    cloud.positions.push_back(position);
    cloud.normals.push_back(normal);
    cloud.areas.push_back(area);
    cloud.albedo.emplace_back(0.5F, 0.5F, 0.5F);
}

/// Points on a grid over a parallelogram; the normal is u x v.
void add_sheet(PointCloud& cloud, const V3f& corner, const V3f& u, const V3f& v, float spacing) {
    const int columns = std::max(1, static_cast<int>(std::lround(u.length() / spacing)));
    const int rows = std::max(1, static_cast<int>(std::lround(v.length() / spacing)));
    const V3f cross = u.cross(v);
    const float area = cross.length() / static_cast<float>(columns * rows);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const float s = (static_cast<float>(column) + 0.5F) / static_cast<float>(columns);
            const float t = (static_cast<float>(row) + 0.5F) / static_cast<float>(rows);
            add_point(cloud, corner + u * s + v * t, cross.normalized(), area);
        }
}

/// All six sides of a parallelepiped, normals outwards (for right-handed edges) or inwards.
void add_box(PointCloud& cloud, const V3f& corner, const V3f& x, const V3f& y, const V3f& z, float spacing,
             bool inwards = false) {
    const auto side = [&](const V3f& at, const V3f& u, const V3f& v) {
        inwards ? add_sheet(cloud, at, v, u, spacing) : add_sheet(cloud, at, u, v, spacing);
    };
    side(corner, z, y);
    side(corner + x, y, z);
    side(corner, x, z);
    side(corner + y, z, x);
    side(corner, y, x);
    side(corner + z, x, y);
}

void add_sphere(PointCloud& cloud, const V3f& center, float radius, float spacing, bool inwards = false) {
    const float area = 4 * std::numbers::pi_v<float> * radius * radius;
    const int count = std::max(12, static_cast<int>(area / (spacing * spacing)));
    for (int i = 0; i < count; ++i) {  // Fibonacci lattice
        const float z = 1 - (2 * static_cast<float>(i) + 1) / static_cast<float>(count);
        const float r = std::sqrt(std::max(0.0F, 1 - z * z));
        const float angle = static_cast<float>(i) * 2.39996323F;
        const V3f normal(r * std::cos(angle), r * std::sin(angle), z);
        add_point(cloud, center + normal * radius, inwards ? -normal : normal, area / static_cast<float>(count));
    }
}

float spacing_for(float area, int points) {
    return std::sqrt(area / static_cast<float>(points));
}

PointCloud room_with(int points, float extra_area, auto&& add_things) {
    const float spacing = spacing_for(6 + extra_area, points);
    PointCloud cloud;
    add_box(cloud, V3f(0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, spacing, true);
    add_things(cloud, spacing);
    return cloud;
}

PointCloud thin_wall_room(int points, float thickness) {
    return room_with(points, 1, [&](PointCloud& cloud, float spacing) {
        add_box(cloud, {0.5F, 0, 0.2F}, {thickness, 0, 0}, {0, 0.7F, 0}, {0, 0, 0.6F}, spacing);
    });
}

PointCloud random_discs(int points) {
    Random random(3);
    PointCloud cloud;
    while (static_cast<int>(cloud.size()) < points) {
        const V3f center = random.in_cube();
        const V3f normal = random.direction();
        const V3f u = normal.cross(random.direction()).normalized();
        const float size = random.between(0.05F, 0.4F);
        add_sheet(cloud, center, u * size, normal.cross(u) * size, spacing_for(size * size, 40));
    }
    return cloud;
}

PointCloud nested_spheres(int points) {
    PointCloud cloud;
    const float spacing = spacing_for(4 * std::numbers::pi_v<float> * 1.5F, points);
    add_sphere(cloud, V3f(0), 1, spacing, true);
    add_sphere(cloud, V3f(0.1F, 0, 0), 0.6F, spacing);
    add_sphere(cloud, V3f(0.1F, 0, 0), 0.5F, spacing, true);
    return cloud;
}

PointCloud corner(int points) {
    PointCloud cloud;
    const float spacing = spacing_for(3, points);
    add_sheet(cloud, V3f(0), {0, 1, 0}, {0, 0, 1}, spacing);
    add_sheet(cloud, V3f(0), {0, 0, 1}, {1, 0, 0}, spacing);
    add_sheet(cloud, V3f(0), {1, 0, 0}, {0, 1, 0}, spacing);
    return cloud;
}

PointCloud coplanar_sheets(int points) {
    PointCloud cloud;
    const float spacing = spacing_for(3.2F, points);
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            const auto x = static_cast<float>(i) * 0.4F;
            const auto z = static_cast<float>(j) * 0.4F;
            add_sheet(cloud, {x, 0, z}, {0, 0, 0.3F}, {0.3F, 0, 0}, spacing);
            if ((i + j) % 2 == 0) add_sheet(cloud, {x, 0.8F, z}, {0.3F, 0, 0}, {0, 0, 0.3F}, spacing);
        }
    add_sheet(cloud, {0.3F, 0.4F, 0.3F}, {0, 0, 0.8F}, {0.8F, 0, 0}, spacing);
    add_sheet(cloud, {0.3F, 0.4F, 0.3F}, {0.8F, 0, 0}, {0, 0, 0.8F}, spacing);
    return cloud;
}

PointCloud keyhole(int points) {
    const float spacing = spacing_for(11, points);
    PointCloud cloud;
    add_box(cloud, V3f(0), {2, 0, 0}, {0, 1, 0}, {0, 0, 1}, spacing, true);
    const auto wall = [&](float y0, float y1, float z0, float z1) {
        const V3f u(0, y1 - y0, 0);
        const V3f v(0, 0, z1 - z0);
        add_sheet(cloud, {0.98F, y0, z0}, v, u, spacing);
        add_sheet(cloud, {1.02F, y0, z0}, u, v, spacing);
    };
    wall(0, 1, 0, 0.4F);
    wall(0, 1, 0.6F, 1);
    wall(0, 0.4F, 0.4F, 0.6F);
    wall(0.6F, 1, 0.4F, 0.6F);
    return cloud;
}

PointCloud lamp_under_ceiling(int points, float gap) {
    return room_with(points, 0.5F, [&](PointCloud& cloud, float spacing) {
        add_sheet(cloud, {0.35F, 1 - gap, 0.35F}, {0.3F, 0, 0}, {0, 0, 0.3F}, spacing);
        add_box(cloud, {0.3F, 0.3F, 0.3F}, {0.3F, 0, 0}, {0, 0.02F, 0}, {0, 0, 0.3F}, spacing);
    });
}

PointCloud coincident_sheets(int points) {
    PointCloud cloud = room_with(points, 2, [&](PointCloud& c, float spacing) {
        add_sheet(c, {0.5F, 0.1F, 0.1F}, {0, 0.8F, 0}, {0, 0, 0.8F}, spacing);
        add_sheet(c, {0.5F, 0.1F, 0.1F}, {0, 0, 0.8F}, {0, 0.8F, 0}, spacing);
        add_box(c, {0.2F, 0, 0.2F}, {0.2F, 0, 0}, {0, 0.2F, 0}, {0, 0, 0.2F}, spacing);
    });
    return cloud;
}

PointCloud with_noise(PointCloud cloud, float position_noise, float normal_noise) {
    Random random(5);
    for (V3f& p : cloud.positions) p += random.in_cube() * position_noise;
    for (V3f& n : cloud.normals) n = (n + random.in_cube() * normal_noise).normalized();
    return cloud;
}

PointCloud stairs(int points) {
    PointCloud cloud;
    const float spacing = spacing_for(3, points);
    for (int i = 0; i < 10; ++i) {
        const float x = static_cast<float>(i) * 0.1F;
        add_sheet(cloud, {x, x, 0}, {0, 0, 1}, {0.1F, 0, 0}, spacing);
        add_sheet(cloud, {x + 0.1F, x, 0}, {0, 0, 1}, {0, 0.1F, 0}, spacing);
    }
    add_sheet(cloud, {0, 1.5F, 0}, {1, 0, 0}, {0, 0, 1}, spacing);
    return cloud;
}

PointCloud slats(int points) {
    return room_with(points, 3, [&](PointCloud& cloud, float spacing) {
        for (int i = 0; i < 12; ++i) {
            const float y = 0.1F + static_cast<float>(i) * 0.07F;
            const V3f across(0.05F, 0.03F, 0);
            add_sheet(cloud, {0.5F, y, 0.1F}, {0, 0, 0.8F}, across, spacing);
            add_sheet(cloud, {0.5F, y, 0.1F}, across, {0, 0, 0.8F}, spacing);
        }
    });
}

PointCloud torus(int points) {
    Random random(9);
    PointCloud cloud;
    for (int i = 0; i < points; ++i) {
        const float a = random.between(0, 2 * std::numbers::pi_v<float>);
        const float b = random.between(0, 2 * std::numbers::pi_v<float>);
        const V3f out(std::cos(a), 0, std::sin(a));
        const V3f normal = out * std::cos(b) + V3f(0, std::sin(b), 0);
        add_point(cloud, out + normal * 0.35F, normal, 13.8F / static_cast<float>(points));
    }
    return cloud;
}

PointCloud gas(int points) {
    Random random(11);
    PointCloud cloud;
    for (int i = 0; i < points; ++i) add_point(cloud, random.in_cube(), random.direction(), 1e-3F);
    return cloud;
}

PointCloud uneven_density(int points) {
    PointCloud cloud = empty_room(points / 2);
    add_sphere(cloud, V3f(0.5F, 0.3F, 0.5F), 0.05F, spacing_for(0.0314F, points / 2));
    return cloud;
}

PointCloud turned_room(int points) {
    PointCloud cloud = packed_room(points);
    const float c = std::cos(std::numbers::pi_v<float> / 4);
    const auto turn = [c](V3f& v) { v = {c * v.x + c * v.z, v.y, c * v.z - c * v.x}; };
    std::ranges::for_each(cloud.positions, turn);
    std::ranges::for_each(cloud.normals, turn);
    return cloud;
}

PointCloud room_with_sphere(int points) {
    return room_with(points, 1.2F, [](PointCloud& cloud, float spacing) {
        add_sphere(cloud, V3f(0.5F, 0.35F, 0.5F), 0.3F, spacing);
    });
}

PointCloud copies(const V3f& position, const V3f& normal, int count) {
    PointCloud cloud;
    for (int i = 0; i < count; ++i) add_point(cloud, position, normal, 1);
    return cloud;
}

PointCloud transformed(PointCloud cloud, float scale, const V3f& offset) {
    transform(cloud, scale, offset);
    return cloud;
}

}  // namespace

PointCloud empty_room(int points) {
    return room_with(points, 0, [](PointCloud&, float) {});
}

PointCloud packed_room(int points) {
    return room_with(points, 1.5F, [](PointCloud& cloud, float spacing) {
        add_box(cloud, {0.15F, 0, 0.55F}, {0.3F, 0, 0}, {0, 0.6F, 0}, {0, 0, 0.25F}, spacing);
        add_box(cloud, {0.6F, 0, 0.3F}, {0.2F, 0, 0.1F}, {0, 0.3F, 0}, {-0.1F, 0, 0.2F}, spacing);
        add_box(cloud, {0.1F, 0, 0.1F}, {0.2F, 0, 0}, {0, 0.2F, 0}, {0, 0, 0.2F}, spacing);
    });
}

void transform(PointCloud& cloud, float scale, const V3f& offset) {
    for (V3f& p : cloud.positions) p = p * scale + offset;
    for (float& area : cloud.areas) area *= scale * scale;
}

std::vector<NamedCloud> ordinary_clouds(int points) {
    return {
        {"empty room", empty_room(points)},
        {"packed room", packed_room(points)},
        {"packed room turned by 45 degrees", turned_room(points)},
        {"room with sphere", room_with_sphere(points)},
        {"random discs", random_discs(points)},
        {"nested spheres", nested_spheres(points)},
        {"thin wall", thin_wall_room(points, 0.01F)},
        {"very thin wall", thin_wall_room(points, 1e-4F)},
        {"corner", corner(points)},
        {"coplanar sheets", coplanar_sheets(points)},
        {"keyhole", keyhole(points)},
        {"lamp 0.001 under a ceiling", lamp_under_ceiling(points, 0.001F)},
        {"lamp flush with a ceiling", lamp_under_ceiling(points, 0)},
        {"coincident opposite sheets", coincident_sheets(points)},
        {"slightly noisy room", with_noise(packed_room(points), 0.002F, 0.05F)},
        {"very noisy room", with_noise(packed_room(points), 0.02F, 0.5F)},
        {"stairs", stairs(points)},
        {"slats", slats(points)},
        {"torus", torus(points)},
        {"gas", gas(points)},
        {"uneven density", uneven_density(points)},
    };
}

std::vector<NamedCloud> degenerate_clouds() {
    PointCloud two = copies({0, 0, 0}, {0, 1, 0}, 1);
    add_point(two, {0, 1, 0}, {0, -1, 0}, 1);

    PointCloud line;
    for (int i = 0; i < 300; ++i) add_point(line, {static_cast<float>(i), 0, 0}, {0, i % 2 ? 1.0F : -1.0F, 0}, 1);

    PointCloud plane;
    add_sheet(plane, V3f(0), {0, 0, 1}, {1, 0, 0}, 0.05F);

    PointCloud twice = packed_room(600);
    const PointCloud once = twice;
    for (std::size_t i = 0; i < once.size(); ++i) add_point(twice, once.positions[i], once.normals[i], once.areas[i]);

    PointCloud bare = packed_room(600);
    bare.areas.clear();

    PointCloud flat_normals = packed_room(600);
    for (V3f& normal : flat_normals.normals) normal = V3f(0);

    PointCloud survey = packed_room(800);
    survey.origin = {4.5e6, 120, 5.4e6};

    return {
        {"one point", copies({1, 2, 3}, {0, 1, 0}, 1)},
        {"two points that face each other", two},
        {"all points equal", copies({1, 2, 3}, {0, 1, 0}, 500)},
        {"points on a line", line},
        {"points on a plane", plane},
        {"every point twice", twice},
        {"no areas", bare},
        {"normals of length zero", flat_normals},
        {"survey coordinates in the origin", survey},
        {"survey coordinates in the floats", transformed(packed_room(800), 100, {4.5e6F, 120, 5.4e6F})},
        {"1e-6 units", transformed(packed_room(800), 1e-6F, V3f(0))},
        {"1e6 units", transformed(packed_room(800), 1e6F, V3f(0))},
        {"1e30 units", transformed(packed_room(400), 1e30F, V3f(0))},
        {"denormal units", transformed(packed_room(400), 1e-40F, V3f(0))},
    };
}

std::vector<NamedCloud> all_clouds(int points) {
    std::vector<NamedCloud> clouds = ordinary_clouds(points);
    std::ranges::move(degenerate_clouds(), std::back_inserter(clouds));
    return clouds;
}

}  // namespace vmap::test
