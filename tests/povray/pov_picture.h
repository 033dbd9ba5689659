// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Scenes of squares, and what POV-Ray shows of them.
#pragma once

#include <vmap/exporters/picture.h>
#include <vmap/exporters/pov_scene.h>
#include <vmap/scene.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace vmap {

/// A ray from the camera, world frame.
struct Ray {
    Imath::V3d origin;
    Imath::V3d direction;

    /// Where it meets the plane through a point.
    [[nodiscard]] Imath::V3d meets(const Imath::V3d& point, const Imath::V3d& normal) const {
        return origin + direction * ((point - origin).dot(normal) / direction.dot(normal));
    }
};

/// Through the middle of a pixel, by glTF's definition of a camera.
[[nodiscard]] Ray ray_through(const Camera& camera, int x, int y, int width, int height);

/// Looks at the square [-1, 1]^2 of the plane z = 0 from above (+z), exactly filling a square picture.
[[nodiscard]] Camera camera_over_square();

/// Adds the square [-1, 1]^2 in the plane z = 0 that faces +z, of two triangles, with texture coordinates (0, 0) at the
/// upper left and (1, 1) at the lower right in set 0. Returns the index of the mesh.
std::size_t add_square(Scene& scene, std::size_t material);

/// Places a mesh.
void add_instance(Scene& scene, std::size_t mesh, const Imath::M44d& world_from_mesh = Imath::M44d());

[[nodiscard]] Imath::M44d scaled(const Imath::V3d& scale);
[[nodiscard]] Imath::M44d moved(const Imath::V3d& translation);

/// A sun that shines straight down (-z) with E = pi: a surface below it shows its albedo.
[[nodiscard]] LightSource sun_from_above();

/// One white square under that sun, with the camera above.
[[nodiscard]] Scene square_under_sun();

/// A folder that goes away with the test, which is skipped where povray is missing.
class PovRayTest : public testing::Test {
protected:
    PovRayTest();
    ~PovRayTest() override;
    void SetUp() override;

    [[nodiscard]] std::string path(const std::string& name) const { return (folder / name).string(); }
    [[nodiscard]] std::string content(const std::string& name) const;
    [[nodiscard]] std::size_t file_count() const;

    /// Exports without radiosity unless the configuration asks for it, and renders.
    [[nodiscard]] Picture render(const Scene& scene, PovConfig config = {}, const OutputInfo& info = {}) const;

    /// Runs povray on a file of the folder.
    [[nodiscard]] Picture render_file(const std::string& name, int width, int height) const;

    std::filesystem::path folder;
};

}  // namespace vmap
