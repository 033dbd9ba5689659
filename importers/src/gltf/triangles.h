// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Primitives as triangle meshes at one pose.
#pragma once

#include "buffers.h"
#include "document.h"

#include <vmap/scene.h>

#include <Imath/ImathMatrix.h>

#include <optional>
#include <vector>

namespace vmap::gltf {

/// How a node shows its mesh.
struct Pose {
    std::vector<double> weights;      ///< of the morph targets; one for each
    std::vector<Imath::M44d> joints;  ///< world_from_bind of each joint; empty: the mesh is not skinned
};

/// The matrix of each joint of a skin, of nodes that are placed in the world.
///
/// - throws BrokenContent when an inverse bind matrix is not finite
[[nodiscard]] std::vector<Imath::M44d> joint_matrices(const Document& document, const SkinInfo& skin, Buffers& buffers);

/// Reads a primitive. With joints the mesh is in the world's frame, else in its own.
///
/// - returns nothing for lines and points and where there is no whole triangle
/// - throws BrokenContent when its data break the specification
[[nodiscard]] std::optional<Mesh> read_triangles(const Document& document, const Primitive& primitive, const Pose& pose,
                                                 Buffers& buffers, Warnings& warnings);

}  // namespace vmap::gltf
